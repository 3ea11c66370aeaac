//! The wear that is faster than fatigue: a column that loses as much in each load cycle is gone before it
//! fails.

use ndarray::{Array3, Axis};
use serde::{Deserialize, Serialize};

use super::maps::logarithmic;
use crate::grid::Field;
use crate::motion::{Body, State};
use crate::units::{Dimension, Metre, format, format_number};
use crate::with::views::{Line, Map, percent};
use crate::with::wear::WEAR;
use asperity_base::record::{columns, known_or_none};

/// Name of the state of a body that wears: its wear of the last load cycle.
pub(super) const OF_CYCLE: &str = "wear_of_pass";

/// Part of the largest critical wear from which on a column counts as one that needs much.
const MUCH: f64 = 0.1;

columns! {
    /// The critical wear of a body: columns of `fatigue.csv`; unknown of a body below layers, which does not wear.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct Critical {
        /// Largest wear of a pass or cycle below which a column fails; unknown of a body below layers.
        #[serde(deserialize_with = "known_or_none")]
        pub critical_wear: Option<Metre>,
        /// Share of the columns that fail unless they wear by more than a tenth of this; unknown of a body below layers.
        #[serde(deserialize_with = "known_or_none")]
        pub critical_share: Option<f64>,
        /// Share of the columns that are among these and wear by less than they need; unknown without wear.
        #[serde(deserialize_with = "known_or_none")]
        pub unsaved_share: Option<f64>,
    }
}

/// Returns the depth that a column must lose in a load cycle for it not to pit, m: ∫ d dz, from the damage of
/// a cycle at ascending `depths`. The damage at the first depth reaches to the surface.
///
/// # Panics
/// If there is not a damage for each depth.
pub fn critical_depth(depths: &[Metre], damage: &[f64]) -> Metre {
    assert_eq!(depths.len(), damage.len(), "a damage for each depth");
    let Some((first, most)) = depths.first().zip(damage.first()) else { return 0.0 };
    let below = depths.windows(2).zip(damage.windows(2));
    first * most + below.map(|(z, d)| 0.5 * (z[1] - z[0]) * (d[0] + d[1])).sum::<f64>()
}

/// Returns the [`critical_depth`] of each column, from the damage of a load cycle at ascending `depths`,
/// `[iz, ix, iy]`.
///
/// # Panics
/// If there is not a damage for each depth.
pub fn critical_depths(depths: &[Metre], damage: &Array3<f64>) -> Field {
    damage.map_axis(Axis(0), |column| critical_depth(depths, &column.to_vec()))
}

/// Adds the state of a body that wears, if it is missing.
pub(super) fn prepare(body: &mut Body) {
    if body.state.contains_key(WEAR) {
        let state = State { unit: "m".to_owned(), values: Field::zeros(body.heights.raw_dim()) };
        body.state.entry(OF_CYCLE.to_owned()).or_insert(state);
    }
}

/// Returns the columns of a body that needs these depths of its columns, and the names and values of its
/// fields.
pub(super) fn of_body(body: &Body, needed: Field) -> (Critical, Vec<(&'static str, Field)>) {
    let most = needed.iter().copied().fold(0.0, f64::max);
    let is_much = |needed: f64| needed > MUCH * most;
    let share = |count: usize| count as f64 / needed.len() as f64;
    let worn = body.state.get(OF_CYCLE).map(|worn| &worn.values);
    let unsaved = worn.map(|worn| {
        let columns = needed.iter().zip(worn);
        share(columns.filter(|(needed, worn)| is_much(**needed) && worn < needed).count())
    });
    let much = share(needed.iter().filter(|needed| is_much(**needed)).count());
    let columns = Critical {
        critical_wear: Some(most),
        critical_share: Some(if most > 0.0 { much } else { 0.0 }),
        unsaved_share: unsaved,
    };
    let lacking = worn.map(|worn| ("lacking_wear", (&needed - worn).mapv(|lacking| lacking.max(0.0))));
    (columns, lacking.into_iter().chain([("critical_wear", needed)]).collect())
}

const NEEDED: &str = "A column fails unless it loses more than this in each load cycle.";
const LACKING: &str = "Where a column wears by less than it needs in order not to fail, and by how much. Where nothing is lacking, wear is faster than fatigue.";
const QUANTITY: &str = "wear of a load cycle";

/// The map of the depths that the columns of a body must lose, 0 the lower or 1 the upper one.
pub(super) const fn needed<R>(body: usize) -> Map<R> {
    const NAMES: [[&str; 2]; 2] = [
        ["critical_wear_lower", "wear of a load cycle that saves the lower body"],
        ["critical_wear_upper", "wear of a load cycle that saves the upper body"],
    ];
    logarithmic(NAMES[body][0], NAMES[body][1], NEEDED, QUANTITY, |_| "m")
}

/// The map of the depths by which the columns of a body lose less than they must.
pub(super) const fn lacking<R>(body: usize) -> Map<R> {
    const NAMES: [[&str; 2]; 2] = [
        ["lacking_wear_lower", "wear of a load cycle that the lower body lacks"],
        ["lacking_wear_upper", "wear of a load cycle that the upper body lacks"],
    ];
    logarithmic(NAMES[body][0], NAMES[body][1], LACKING, QUANTITY, |_| "m")
}

impl Critical {
    /// Says from which pass or `cycle` of a life on the body fails, and what saves it.
    pub(super) fn outlook(&self, life: f64, cycle: &str) -> String {
        let life = format_number(life.max(1.0).round());
        let Some(wear) = self.critical_wear else { return format!("it fails in {cycle} {life}.") };
        let wear = format(wear, Dimension::Length);
        let saved = match self.unsaved_share {
            Some(0.0) => " Everywhere it wears faster.".to_owned(),
            Some(share) => format!(" On {} of the surface it is.", percent(share)),
            None => String::new(),
        };
        format!("it fails from {cycle} {life} on where wear is below {wear} a {cycle}.{saved}")
    }

    /// Returns the line of a body, whose wear is that of a pass or a `cycle`; `None` below layers.
    pub(super) fn line(&self, body: &str, cycle: &str) -> Option<Line> {
        let (wear, share) = self.critical_wear.zip(self.critical_share)?;
        Some(Line::new(
            format!("wear that saves it, {body}"),
            format!(
                "{} a {cycle}; {} of the area needs a tenth of it or more{}",
                format(wear, Dimension::Length),
                percent(share),
                self.unsaved_share
                    .map_or(String::new(), |share| format!(", {} has less than it needs", percent(share)))
            ),
        ))
    }
}

//! A sequence of loads in `[contact]`, or of creepages in `[friction]`.

use serde::Serialize;

use super::cursor::Table;
use super::prescribed::Prescribed;
use super::schema::loading::contact;
use crate::error::Result;
use crate::units::{Metre, Newton, Pascal};

/// Sequence of prescribed values of a static contact, at least one, each on virgin bodies.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Sweep {
    /// Total normal forces, > 0.
    Loads(Vec<Newton>),
    /// Loads over the apparent area, > 0.
    MeanPressures(Vec<Pascal>),
    /// Approaches relative to the prepared heights; positive or negative.
    Approaches(Vec<Metre>),
}

impl Sweep {
    /// Iterates over the points in order.
    pub fn prescribed(&self) -> impl Iterator<Item = Prescribed> + '_ {
        let (values, point): (_, fn(f64) -> Prescribed) = match self {
            Self::Loads(loads) => (loads, Prescribed::Load),
            Self::MeanPressures(pressures) => (pressures, Prescribed::MeanPressure),
            Self::Approaches(approaches) => (approaches, Prescribed::Approach),
        };
        values.iter().copied().map(point)
    }

    /// The largest of the values.
    pub fn largest(&self) -> Prescribed {
        let value = |prescribed: &Prescribed| match *prescribed {
            Prescribed::Load(value) | Prescribed::MeanPressure(value) | Prescribed::Approach(value) => value,
        };
        self.prescribed().max_by(|a, b| value(a).total_cmp(&value(b))).expect("a sweep has a point")
    }
}

/// Keys of a sweep in `[contact]`.
pub(super) const KEYS: [&str; 3] = ["loads", "mean_pressures", "approaches"];

/// Reads the sweep of a table, if it has one.
pub(super) fn sweep(table: &Table<'_>) -> Result<Option<Sweep>> {
    let loads = contact::LOADS.of(table)?.map(Sweep::Loads);
    let pressures = contact::MEAN_PRESSURES.of(table)?.map(Sweep::MeanPressures);
    let approaches = contact::APPROACHES.of(table)?.map(Sweep::Approaches);
    Ok(loads.or(pressures).or(approaches))
}

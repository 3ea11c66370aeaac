//! The columns of fatigue.

use serde::{Deserialize, Serialize};

use super::critical::Critical;
use crate::error::Error;
use crate::units::{Joule, Metre, Pascal};
use crate::with::Row;
use asperity_base::choice::choice;
use asperity_base::record::{Column, Record, columns};

/// One of the two bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum OnBody {
    /// The lower body.
    Lower,
    /// The upper body.
    Upper,
}

choice!(OnBody: "lower" => Lower, "upper" => Upper);

columns! {
    /// Fatigue below the surface of a body in a pass or a cycle, a row of `fatigue.csv`; in `summary.json` of
    /// the last one.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct FatigueRecord {
        /// Pass, from 1; left out of the cycles of a loading.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub pass: Option<usize>,
        /// Stage of the loading, from 1; left out of passes.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub stage: Option<usize>,
        /// Cycles of all stages that are done after this one, with those that it stands for; left out of
        /// passes.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub cycle: Option<usize>,
        /// Position of the pass, or increment of the loading, up to which the stresses count: the last one of
        /// the pass or cycle.
        pub step: usize,
        /// The body: `lower` or `upper`.
        pub body: OnBody,
        /// Mean load of the pass or cycle over the mean overlap.
        pub mean_pressure: Pascal,
        /// Largest f over its limit b: where it is below 1, nothing fails in the end.
        pub over_limit: f64,
        /// x of the place of the largest f, from the corner of the body.
        pub x: Metre,
        /// y of this place.
        pub y: Metre,
        /// Depth of this place.
        pub depth: Metre,
        /// Cells from this place to the nearest free edge of the body; unknown without one.
        pub edge_cells: Option<usize>,
        /// Largest damage that this pass or cycle does, which adds up to 1 at failure; 0 below the limit with
        /// an endurance limit.
        pub damage_of_pass: f64,
        /// Largest damage after the pass or cycle and its extrapolation, less what has worn away or broken
        /// out.
        #[over_motion(State)]
        pub damage: f64,
        /// Pass of the motion, or cycle of the loading, in which a point first fails if all go on like this
        /// one and nothing is removed; unknown without damage.
        #[over_motion(State)]
        pub life: Option<f64>,
        /// The removal that is faster.
        #[serde(flatten)]
        pub critical: Critical,
        /// Share of the columns that have broken out so far; unknown without `pit_depth`.
        #[over_motion(State)]
        pub pitted_share: Option<f64>,
        /// Life over that of the bodies without their roughness, by the risk of Ioannides and Harris; unknown
        /// without `risk`, and for flat bodies.
        pub life_ratio: Option<f64>,
        /// Plastic work below the surface of the body in the pass: f is that of shakedown, where it is 0;
        /// unknown for other than elasto-plastic bodies.
        pub plastic_work: Option<Joule>,
        /// Distance between two positions whose stress is computed, over the width of the widest spot of
        /// contact; left out of the cycles of a loading.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub stride: Option<f64>,
    }
}

impl Record for FatigueRecord {
    const COLUMNS: &'static [Column] = Self::COLUMNS;

    fn error_at(&self, error: Error) -> Error {
        error.if_of_step(|source| match self.pass {
            Some(pass) => Error::AtPass { pass, source },
            None => Error::AtIncrement { increment: self.step, source },
        })
    }
}

impl Row for FatigueRecord {
    const GROUPS: &'static [(&'static str, &'static [Column])] = &[("FatigueRecord", Self::COLUMNS)];

    fn pass(&self) -> Option<usize> {
        self.pass
    }

    fn cycle(&self) -> Option<[usize; 2]> {
        Some([self.step, self.cycle?])
    }

    fn mean_pressure(&self) -> Pascal {
        self.mean_pressure
    }
}

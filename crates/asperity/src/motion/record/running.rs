//! What wear, films and the heat of friction add to the rows of a motion.

use serde::{Deserialize, Serialize};

use super::columns::columns;
use super::number::number_or_none;
use crate::units::{Joule, Kelvin, Metre, Second, Watt};

columns! {
    /// The heat of friction at a position: further columns of `steps.csv`.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct HeatRecord {
        /// Power of friction.
        pub friction_power: Watt,
        /// Largest temperature of the surfaces, absolute.
        pub max_flash_temperature: Kelvin,
    }
}

columns! {
    /// A pass of bodies that wear or grow films, which may stand for many: further columns of `passes.csv`.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct RunningRecord {
        /// Passes of the motion that this computed pass represents, ≥ 1; plastic volumes are those of one pass.
        pub represents: usize,
        /// Time since the beginning, at the end of these passes; unknown without a speed.
        #[serde(deserialize_with = "number_or_none")]
        pub time: Second,
        /// Distance that the bodies have slid over each other since the beginning.
        pub distance: Metre,
        /// Deepest wear of a cell of the lower body in these passes.
        pub max_wear_lower: Metre,
        /// Deepest wear of a cell of the upper body in these passes.
        pub max_wear_upper: Metre,
        /// Mean thickness of the film on the lower body after these passes; 0 without one.
        pub mean_film_lower: Metre,
        /// Mean thickness of the film on the upper body after these passes; 0 without one.
        pub mean_film_upper: Metre,
        /// Energy that friction took in these passes.
        pub friction_work: Joule,
        /// Largest temperature of the surfaces in the computed pass, absolute; that of the warmer body where the flash temperature is
        /// not computed, unknown where that is not given.
        #[serde(deserialize_with = "number_or_none")]
        pub max_flash_temperature: Kelvin,
        /// Estimate of the error of the heights from not computing every pass; the sum over the rows bounds the whole.
        pub error_estimate: Metre,
    }
}

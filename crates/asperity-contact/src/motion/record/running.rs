//! Wear, films and frictional heat: further columns of the rows of a motion.

use serde::{Deserialize, Serialize};

use crate::units::{Joule, Kelvin, Metre, Second, Watt};
use asperity_base::record::columns;
use asperity_base::record::number_or_none;

/// Name of the law of wear, and of the body state that stores the depth worn since the beginning, m.
pub const WEAR: &str = "wear";
/// Name of the law of films, and of the body state that stores the thickness of the film, m.
pub const FILM: &str = "film";

columns! {
    /// Frictional heat at a position: further columns of `steps.csv`.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    pub struct HeatRecord {
        /// Frictional power.
        pub friction_power: Watt,
        /// Largest absolute temperature of the surfaces.
        pub max_flash_temperature: Kelvin,
    }
}

columns! {
    /// A computed pass of bodies with wear or films, with its extrapolation: further columns of `passes.csv`.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    pub struct RunningRecord {
        /// Number of passes covered by this computed pass and its extrapolation, ≥ 1; plastic volumes refer to one pass.
        pub represents: usize,
        /// Time from the start to the end of these passes; unknown without a speed.
        #[serde(deserialize_with = "number_or_none")]
        pub time: Second,
        /// Sliding distance since the start.
        pub distance: Metre,
        /// Deepest wear of a cell of the lower body in these passes.
        pub max_wear_lower: Metre,
        /// Deepest wear of a cell of the upper body in these passes.
        pub max_wear_upper: Metre,
        /// Mean thickness of the film on the lower body after these passes; 0 without one.
        pub mean_film_lower: Metre,
        /// Mean thickness of the film on the upper body after these passes; 0 without one.
        pub mean_film_upper: Metre,
        /// Energy dissipated by friction in these passes.
        pub friction_work: Joule,
        /// Largest absolute temperature of the surfaces in the computed pass. Without a flash temperature it is the temperature of the
        /// warmer body, or unknown.
        #[serde(deserialize_with = "number_or_none")]
        pub max_flash_temperature: Kelvin,
        /// Estimated error of the heights due to the extrapolation; the sum over the rows bounds the total error.
        pub error_estimate: Metre,
    }
}

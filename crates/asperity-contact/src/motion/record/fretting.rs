//! Bodies that wear and grow films during a loading.

use serde::{Deserialize, Serialize};

use crate::units::{CubicMetre, Joule, Metre};
use asperity_base::record::columns;

columns! {
    /// Wear and films of bodies that slip a little during a loading: further columns of an increment.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
    pub struct FrettingRecord {
        /// Cycles done at the end of the increment, with those that were not computed.
        pub cycles: usize,
        /// Volume that the lower body has worn off so far.
        pub worn_volume_lower: CubicMetre,
        /// Volume that the upper body has worn off so far.
        pub worn_volume_upper: CubicMetre,
        /// Deepest wear of a cell of the lower body so far.
        pub max_wear_lower: Metre,
        /// Deepest wear of a cell of the upper body so far.
        pub max_wear_upper: Metre,
        /// Thickest film on a cell of the lower body; 0 without a film.
        pub max_film_lower: Metre,
        /// Thickest film on a cell of the upper body; 0 without a film.
        pub max_film_upper: Metre,
        /// Energy dissipated by friction so far, with the cycles that were not computed.
        pub friction_work: Joule,
        /// Estimate of the error of the heights by cycles that were not computed.
        pub wear_error: Metre,
    }
}

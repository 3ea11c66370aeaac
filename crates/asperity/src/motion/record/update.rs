//! An update of a contact that wears in place.

use serde::{Deserialize, Serialize};

use super::columns::columns;
use super::lost_volumes::{self, LostVolume};
use super::number::number_or_none;
use crate::units::{CubicMetre, Joule, Kelvin, Metre, Newton, Pascal, Second, SquareMetre, Watt};

columns! {
    /// One update of a contact that slides in place: a row of `updates.csv`, the first of which is the contact before it slides.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct UpdateRecord {
        /// Update, from 1; 0 before the first.
        pub update: usize,
        /// Distance that the bodies have slid at its end.
        pub distance: Metre,
        /// Time since the beginning; unknown without a speed.
        #[serde(deserialize_with = "number_or_none")]
        pub time: Second,
        /// Normal force W.
        pub load: Newton,
        /// Rigid-body approach δ.
        pub approach: Metre,
        /// Friction force along x of the upper body on the lower one.
        pub tangential_force: Newton,
        /// Area of the cells with p > 0.
        pub contact_area: SquareMetre,
        /// Cells across the largest contact spot: of the spot with the most cells, its columns or its rows, the fewer.
        pub largest_spot_cells: usize,
        /// Largest pressure.
        pub max_pressure: Pascal,
        /// Number of cells at the hardness.
        pub plastic_cells: usize,
        /// Volumes that each law has taken from the bodies so far: of wear the columns `wear_volume_lower`, `wear_volume_upper`.
        #[serde(flatten, with = "lost_volumes::whole")]
        pub lost: Vec<LostVolume>,
        /// Deepest wear of a cell of the lower body so far.
        pub max_wear_lower: Metre,
        /// Deepest wear of a cell of the upper body so far.
        pub max_wear_upper: Metre,
        /// Mean thickness of the film on the cells of the lower body that are in contact; 0 without one.
        pub mean_film_lower: Metre,
        /// Mean thickness of the film on the cells of the upper body that are in contact; 0 without one.
        pub mean_film_upper: Metre,
        /// Power of friction; unknown without a speed.
        #[serde(deserialize_with = "number_or_none")]
        pub friction_power: Watt,
        /// Energy that friction took so far.
        pub friction_work: Joule,
        /// Largest temperature of the surfaces, absolute; that of the warmer body where the flash temperature is not computed, unknown
        /// where it has none.
        #[serde(deserialize_with = "number_or_none")]
        pub max_temperature: Kelvin,
        /// Contacts solved, until the coefficients of wear under the films were found.
        pub solutions: usize,
        /// Iterations of the solver.
        pub iterations: usize,
        /// Convolutions.
        pub convolutions: f64,
        /// Scale-free complementarity residual η.
        pub residual: f64,
    }
}

impl UpdateRecord {
    /// Volumes that the lower and the upper body have lost to the law of that name so far; 0 where there is no such law.
    pub fn lost(&self, law: &str) -> [CubicMetre; 2] {
        self.lost.iter().find(|lost| lost.law == law).map_or([0.0; 2], |lost| lost.whole)
    }
}

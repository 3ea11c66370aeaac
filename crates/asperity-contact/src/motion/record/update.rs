//! An update of a contact that slides in place.

use serde::{Deserialize, Serialize};

use super::laws::LawsInUpdate;
use super::lost_volumes::{self, LostVolume};
use crate::solver::InterfaceRecord;
use crate::units::{CubicMetre, Joule, Kelvin, Metre, Newton, Pascal, Second, SquareMetre, Watt};
use asperity_base::record::columns;
use asperity_base::record::number_or_none;

columns! {
    /// One update of a contact that slides in place: a row of `updates.csv`. The first row is the contact
    /// before sliding.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct UpdateRecord {
        /// Update, from 1; 0 is the contact before sliding.
        pub update: usize,
        /// Sliding distance at the end of the update.
        pub distance: Metre,
        /// Time since the start; unknown without a speed.
        #[serde(deserialize_with = "number_or_none")]
        pub time: Second,
        /// Normal force W.
        pub load: Newton,
        /// Rigid-body approach δ.
        pub approach: Metre,
        /// Friction force of the upper body on the lower one along x.
        pub tangential_force: Newton,
        /// Area of the cells with p > 0.
        pub contact_area: SquareMetre,
        /// Width of the contact spot with the most cells, in cells: the smaller of its columns and rows.
        pub largest_spot_cells: usize,
        /// Largest pressure.
        pub max_pressure: Pascal,
        /// Number of cells at the hardness.
        pub plastic_cells: usize,
        /// Volumes that the bodies have lost to each law so far, in the columns `NAME_volume_lower` and
        /// `NAME_volume_upper`.
        #[serde(flatten, with = "lost_volumes::whole")]
        pub lost: Vec<LostVolume>,
        /// Columns of the laws.
        #[serde(flatten)]
        pub laws: LawsInUpdate,
        /// Frictional power; unknown without a speed.
        #[serde(deserialize_with = "number_or_none")]
        pub friction_power: Watt,
        /// Energy dissipated by friction so far.
        pub friction_work: Joule,
        /// Largest absolute temperature of the surfaces. Without a flash temperature it is the temperature of
        /// the warmer body, or unknown.
        #[serde(deserialize_with = "number_or_none")]
        pub max_temperature: Kelvin,
        /// Number of contacts solved to find the rates of removal under the films.
        pub solutions: usize,
        /// Iterations of the solver.
        pub iterations: usize,
        /// Convolutions.
        pub convolutions: f64,
        /// Scale-free complementarity residual η.
        pub residual: f64,
        /// Tension across the gap; none between hard walls.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub interface: Option<InterfaceRecord>,
    }
}

impl UpdateRecord {
    /// Volumes that the lower and the upper body have lost to the law of that name so far; 0 without such a
    /// law.
    pub fn lost(&self, law: &str) -> [CubicMetre; 2] {
        self.lost.iter().find(|lost| lost.law == law).map_or([0.0; 2], |lost| lost.whole)
    }
}

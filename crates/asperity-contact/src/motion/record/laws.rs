//! Columns of the laws in the rows of a motion: the list of what the laws show. Each law fills its own
//! ([`Law`](crate::motion::Law)).

use serde::{Deserialize, Serialize};

use crate::units::{CubicMetre, Joule, Kelvin, Metre, Second};
use asperity_base::record::columns;
use asperity_base::record::number_or_none;

/// Name of the column, and of the number of a state, that estimates the error of the heights by cycles that
/// were not computed.
pub(in crate::motion) const HEIGHT_ERROR: &str = "wear_error";

columns! {
    /// A computed pass of bodies that laws change, with its extrapolation: further columns of `passes.csv`.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    pub struct RunningRecord {
        /// Number of passes covered by this computed pass and its extrapolation, ≥ 1; plastic volumes refer
        /// to one pass.
        #[over_motion(Sum)]
        pub represents: usize,
        /// Time from the start to the end of these passes; unknown without a speed.
        #[over_motion(State)]
        #[serde(deserialize_with = "number_or_none")]
        pub time: Second,
        /// Sliding distance since the start.
        #[over_motion(State)]
        pub distance: Metre,
        /// Columns of the laws.
        #[serde(flatten)]
        pub laws: LawsInPass,
        /// Energy dissipated by friction in these passes.
        #[over_motion(Sum)]
        pub friction_work: Joule,
        /// Largest absolute temperature of the surfaces in the computed pass. Without a flash temperature it
        /// is the temperature of the warmer body, or unknown.
        #[serde(deserialize_with = "number_or_none")]
        pub max_flash_temperature: Kelvin,
        /// Estimated error of the heights due to the extrapolation; the sum over the rows bounds the total
        /// error.
        #[over_motion(Sum)]
        pub error_estimate: Metre,
    }
}

columns! {
    /// Columns of the laws in a computed pass with its extrapolation.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
    pub struct LawsInPass {
        /// Deepest wear of a cell of the lower body in these passes.
        #[over_motion(MeanOfPass)]
        pub max_wear_lower: Metre,
        /// Deepest wear of a cell of the upper body in these passes.
        #[over_motion(MeanOfPass)]
        pub max_wear_upper: Metre,
        /// Deepest wear of a cell of the lower body since the beginning.
        #[over_motion(State)]
        #[serde(default)]
        pub deepest_wear_lower: Metre,
        /// Deepest wear of a cell of the upper body since the beginning; of a fresh one in its pass.
        #[over_motion(State)]
        #[serde(default)]
        pub deepest_wear_upper: Metre,
        /// Mean thickness of the film on the lower body after these passes; 0 without one.
        #[over_motion(State)]
        pub mean_film_lower: Metre,
        /// Mean thickness of the film on the upper body after these passes; 0 without one.
        #[over_motion(State)]
        pub mean_film_upper: Metre,
    }
}

columns! {
    /// Columns of the laws in an update of a contact that slides in place.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
    pub struct LawsInUpdate {
        /// Deepest wear of a cell of the lower body so far.
        pub max_wear_lower: Metre,
        /// Deepest wear of a cell of the upper body so far.
        pub max_wear_upper: Metre,
        /// Mean thickness of the film on the cells in contact of the lower body; 0 without a film.
        pub mean_film_lower: Metre,
        /// Mean thickness of the film on the cells in contact of the upper body; 0 without a film.
        pub mean_film_upper: Metre,
    }
}

columns! {
    /// Bodies that laws change where they slip during a loading, or whose cycles count: further columns of an
    /// increment.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
    pub struct FrettingRecord {
        /// Cycles done at the end of the increment, with those that were not computed.
        pub cycles: usize,
        /// Columns of the laws.
        #[serde(flatten)]
        pub laws: LawsInCycles,
        /// Energy dissipated by friction so far, with the cycles that were not computed.
        pub friction_work: Joule,
        /// Estimate of the error of the heights by cycles that were not computed.
        pub wear_error: Metre,
    }
}

columns! {
    /// Columns of the laws in an increment of a loading.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
    pub struct LawsInCycles {
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
    }
}

impl FrettingRecord {
    /// Creates the record of bodies after so many cycles, with this friction work and this estimate of the
    /// error of the heights.
    pub(in crate::motion) fn new(
        cycles: usize,
        laws: LawsInCycles,
        friction_work: Joule,
        height_error: Metre,
    ) -> Self {
        Self { cycles, laws, friction_work, wear_error: height_error }
    }
}

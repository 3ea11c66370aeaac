//! A pass.

use serde::{Deserialize, Serialize};

use super::columns::columns;
use super::flow::PassFlowRecord;
use super::lost_volumes::{self, LostVolume};
use super::number::number_or_none;
use super::running::RunningRecord;
use crate::units::{CubicMetre, Metre, Newton, Pascal, Second, SquareMetre};

columns! {
    /// One pass: a row of `passes.csv`.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct PassRecord {
        /// Pass, from 1.
        pub pass: usize,
        /// Rigid-body approach δ of the pass; its mean over the positions where the load of each is prescribed.
        pub approach: Metre,
        /// Mean load over the positions.
        pub mean_load: Newton,
        /// Mean friction force over the positions, along x of the upper body on the lower one.
        pub mean_tangential_force: Newton,
        /// Magnitude of the mean friction force over the mean load; unknown where nothing touches.
        #[serde(deserialize_with = "number_or_none")]
        pub friction_coefficient: f64,
        /// Smallest load at a position of the pass.
        pub min_load: Newton,
        /// Largest load at a position of the pass.
        pub max_load: Newton,
        /// Mean load over the mean area of the overlap, which of equal bodies is half a body.
        pub mean_pressure: Pascal,
        /// Mean real contact area over the positions.
        pub mean_contact_area: SquareMetre,
        /// Mean real contact area over the positions, of the cells that are in the interior of both bodies.
        pub mean_contact_area_interior: SquareMetre,
        /// Cells across the largest contact spot met: of the spot with the most cells at a position, its columns or its rows, the fewer.
        pub largest_spot_cells: usize,
        /// Largest pressure at any position.
        pub max_pressure: Pascal,
        /// Volumes that each law took from the bodies in this pass: of the plastic flow the columns `plastic_volume_lower`,
        /// `plastic_volume_upper`, `plastic_volume_lower_interior`, `plastic_volume_upper_interior`.
        #[serde(flatten, with = "lost_volumes")]
        pub lost: Vec<LostVolume>,
        /// Wear, films and heat; none without wear and films.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub running: Option<RunningRecord>,
        /// Plastic flow below the surfaces; none of bodies that do not flow.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub flow: Option<PassFlowRecord>,
        /// Rms height of the lower surface about its mean after the pass.
        pub sq_lower: Metre,
        /// Rms height of the upper surface about its mean after the pass.
        pub sq_upper: Metre,
        /// Rms height of the interior of the lower surface about the mean of the interior after the pass.
        pub sq_lower_interior: Metre,
        /// Rms height of the interior of the upper surface about the mean of the interior after the pass.
        pub sq_upper_interior: Metre,
        /// Number of approaches tried.
        pub outer_iterations: usize,
        /// Convolutions of the pass.
        pub convolutions: f64,
        /// Time that the pass took.
        pub wall_time_s: Second,
    }
}

impl PassRecord {
    /// Passes of the motion that this computed one stands for, ≥ 1.
    pub fn represents(&self) -> usize {
        self.running.map_or(1, |running| running.represents)
    }

    /// Volumes that the lower and the upper body lost in this pass to the law of that name; 0 where there is no such law.
    pub fn lost(&self, law: &str) -> [CubicMetre; 2] {
        self.of(law).map_or([0.0; 2], |lost| lost.whole)
    }

    /// Volumes that the interiors of the lower and of the upper body lost in this pass to the law of that name.
    pub fn lost_inside(&self, law: &str) -> [CubicMetre; 2] {
        self.of(law).map_or([0.0; 2], |lost| lost.interior)
    }

    /// The volumes of the law of that name.
    fn of(&self, law: &str) -> Option<&LostVolume> {
        self.lost.iter().find(|lost| lost.law == law)
    }
}

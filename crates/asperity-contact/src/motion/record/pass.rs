//! A pass.

use serde::{Deserialize, Serialize};

use super::creep::PassDragRecord;
use super::laws::RunningRecord;
use super::lost_volumes::{self, LostVolume};
use super::lubrication::FilmRecord;
use super::plastic::PassPlasticRecord;
use crate::solver::InterfacePassRecord;
use crate::units::{CubicMetre, Metre, Newton, Pascal, Second, SquareMetre};
use asperity_base::record::columns;
use asperity_base::record::number_or_none;

columns! {
    /// One pass: a row of `passes.csv`.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct PassRecord {
        /// Pass, from 1.
        #[over_motion(State)]
        pub pass: usize,
        /// Rigid-body approach δ of the pass; its mean over the positions if the load of each position is
        /// prescribed.
        pub approach: Metre,
        /// Mean load over the positions.
        pub mean_load: Newton,
        /// Mean friction force of the upper body on the lower one along x, over the positions.
        pub mean_tangential_force: Newton,
        /// Magnitude of the mean friction force over the mean load; unknown without contact.
        #[serde(deserialize_with = "number_or_none")]
        pub friction_coefficient: f64,
        /// Smallest load at a position of the pass.
        pub min_load: Newton,
        /// Largest load at a position of the pass.
        pub max_load: Newton,
        /// Mean load over the mean area of the overlap, which is half a body for equal bodies.
        pub mean_pressure: Pascal,
        /// Mean real contact area over the positions.
        pub mean_contact_area: SquareMetre,
        /// Mean real contact area over the positions, in the interior of both bodies.
        pub mean_contact_area_interior: SquareMetre,
        /// Width of the largest contact spot in the pass, in cells: the spot has the most cells at a
        /// position, its width is the smaller of its columns and rows.
        pub largest_spot_cells: usize,
        /// Largest pressure at any position.
        pub max_pressure: Pascal,
        /// Volumes that the bodies lost to each law in this pass. Plastic flow has the columns
        /// `plastic_volume_lower`, `plastic_volume_upper`, `plastic_volume_lower_interior`,
        /// `plastic_volume_upper_interior`.
        #[serde(flatten, with = "lost_volumes")]
        pub lost: Vec<LostVolume>,
        /// Changes by laws, and heat; none of bodies that only yield.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub running: Option<RunningRecord>,
        /// Tension across the gap; none between hard walls.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub interface: Option<InterfacePassRecord>,
        /// Plastic flow below the surfaces; none without elasto-plastic bodies.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub plastic: Option<PassPlasticRecord>,
        /// The film of lubricated bodies: means over the positions, and the least film; none of others.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub film: Option<FilmRecord>,
        /// Drag of viscoelastic bodies; none of others.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub drag: Option<PassDragRecord>,
        /// Rms height of the lower surface about its mean after the pass.
        #[over_motion(State)]
        pub sq_lower: Metre,
        /// Rms height of the upper surface about its mean after the pass.
        #[over_motion(State)]
        pub sq_upper: Metre,
        /// Rms height of the interior of the lower surface about the mean of the interior after the pass.
        #[over_motion(State)]
        pub sq_lower_interior: Metre,
        /// Rms height of the interior of the upper surface about the mean of the interior after the pass.
        #[over_motion(State)]
        pub sq_upper_interior: Metre,
        /// Number of approaches tried.
        #[over_motion(Sum)]
        pub outer_iterations: usize,
        /// Convolutions of the pass.
        #[over_motion(Sum)]
        pub convolutions: f64,
        /// Wall time of the pass.
        pub wall_time_s: Second,
    }
}

impl PassRecord {
    /// Number of passes of the motion covered by this computed pass and its extrapolation, ≥ 1.
    pub fn represents(&self) -> usize {
        self.running.map_or(1, |running| running.represents)
    }

    /// Volumes that the lower and the upper body lost in this pass to the law of that name; 0 without such a
    /// law.
    pub fn lost(&self, law: &str) -> [CubicMetre; 2] {
        self.of(law).map_or([0.0; 2], |lost| lost.whole)
    }

    /// Volumes that the interiors of the lower and of the upper body lost in this pass to the law of that
    /// name.
    pub fn lost_inside(&self, law: &str) -> [CubicMetre; 2] {
        self.of(law).map_or([0.0; 2], |lost| lost.interior)
    }

    /// Returns the volumes of the law of that name.
    fn of(&self, law: &str) -> Option<&LostVolume> {
        self.lost.iter().find(|lost| lost.law == law)
    }
}

//! A position of a pass.

use serde::{Deserialize, Serialize};

use super::creep::DragRecord;
use super::heat::HeatRecord;
use super::lubrication::FilmRecord;
use super::plastic::PlasticStepRecord;
use crate::solver::InterfaceRecord;
use crate::units::{CubicMetre, Metre, Newton, Pascal, SquareMetre};
use asperity_base::record::columns;

columns! {
    /// One position of one pass: a row of `steps.csv`.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct StepRecord {
        /// Pass, from 1.
        pub pass: usize,
        /// Position in the pass, from 1.
        pub step: usize,
        /// Distance of the left edge of the upper body to the right of the left edge of the lower body.
        pub offset: Metre,
        /// Cyclic displacement of the upper body along y; left out if it is the same in all passes.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub offset_y: Option<Metre>,
        /// Columns of the overlap.
        pub overlap_columns: usize,
        /// Rigid-body approach δ.
        pub approach: Metre,
        /// Normal force W at this position.
        pub load: Newton,
        /// Friction force of the upper body on the lower one along x; 0 without friction.
        pub tangential_force: Newton,
        /// Area of the cells in contact: with p > 0, or with p > −σ(0) where the bodies attract each other.
        pub contact_area: SquareMetre,
        /// Area of the cells in contact in the interior of both bodies.
        pub contact_area_interior: SquareMetre,
        /// Width of the contact spot with the most cells, in cells: the smaller of its columns and rows.
        pub largest_spot_cells: usize,
        /// Largest pressure.
        pub max_pressure: Pascal,
        /// Number of cells at the hardness, or at their caps under shear.
        pub plastic_cells: usize,
        /// Plastic volume ΔA Σ w at this position, with w the remaining interference of the cells at the
        /// hardness.
        pub plastic_volume: CubicMetre,
        /// Plastic volume over the cells in the interior of both bodies.
        pub plastic_volume_interior: CubicMetre,
        /// Iterations of the solver at the accepted approach.
        pub iterations: usize,
        /// Convolutions over all approaches tried.
        pub convolutions: f64,
        /// Scale-free complementarity residual η.
        pub residual: f64,
        /// Frictional heat; none without a flash temperature.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub heat: Option<HeatRecord>,
        /// Tension across the gap; none between hard walls.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub interface: Option<InterfaceRecord>,
        /// Plastic flow below the surfaces; none without elasto-plastic bodies.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub plastic: Option<PlasticStepRecord>,
        /// The film of lubricated bodies; none of others.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub film: Option<FilmRecord>,
        /// Drag of viscoelastic bodies; none of others.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub drag: Option<DragRecord>,
    }
}

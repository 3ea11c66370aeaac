//! A position of a pass.

use serde::{Deserialize, Serialize};

use super::columns::columns;
use super::flow::FlowStepRecord;
use super::running::HeatRecord;
use crate::units::{CubicMetre, Metre, Newton, Pascal, SquareMetre};

columns! {
    /// One position of one pass: a row of `steps.csv`.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct StepRecord {
        /// Pass, from 1.
        pub pass: usize,
        /// Position in the pass, from 1.
        pub step: usize,
        /// How far the upper body's left edge lies to the right of the lower body's.
        pub offset: Metre,
        /// How far the upper body is displaced along y, cyclically; left out where all passes lie at one place.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub offset_y: Option<Metre>,
        /// Columns of cells that face each other.
        pub overlap_columns: usize,
        /// Rigid-body approach δ.
        pub approach: Metre,
        /// Normal force W at this position.
        pub load: Newton,
        /// Friction force along x of the upper body on the lower one; 0 without friction.
        pub tangential_force: Newton,
        /// Area of the cells with p > 0.
        pub contact_area: SquareMetre,
        /// Area of the cells with p > 0 that are in the interior of both bodies.
        pub contact_area_interior: SquareMetre,
        /// Cells across the largest contact spot: of the spot with the most cells, its columns or its rows, the fewer.
        pub largest_spot_cells: usize,
        /// Largest pressure.
        pub max_pressure: Pascal,
        /// Number of cells at the hardness, under shear at their caps.
        pub plastic_cells: usize,
        /// Plastic volume ΔA Σ w at this position, w the interference left at the cells at the hardness.
        pub plastic_volume: CubicMetre,
        /// Plastic volume over the cells that are in the interior of both bodies.
        pub plastic_volume_interior: CubicMetre,
        /// Iterations of the solver at the approach that was accepted.
        pub iterations: usize,
        /// Convolutions over all approaches tried.
        pub convolutions: f64,
        /// Scale-free complementarity residual η.
        pub residual: f64,
        /// The heat of friction; none where the flash temperature is not computed.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub heat: Option<HeatRecord>,
        /// Plastic flow below the surfaces; none of bodies that do not flow.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub flow: Option<FlowStepRecord>,
    }
}

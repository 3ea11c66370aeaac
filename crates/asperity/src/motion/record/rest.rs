//! A static contact.

use serde::{Deserialize, Serialize};

use super::columns::columns;
use super::flow::FlowRecord;
use crate::units::{CubicMetre, Joule, Metre, Newton, NewtonMetre, Pascal, PerMetre, SquareMetre};

columns! {
    /// A static contact in numbers: `static` in `summary.json`.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct StaticRecord {
        /// Total normal force W.
        pub load: Newton,
        /// Rigid-body approach δ.
        pub approach: Metre,
        /// Area of the cells with p > 0.
        pub contact_area: SquareMetre,
        /// Area of the whole grid.
        pub apparent_area: SquareMetre,
        /// Largest pressure.
        pub max_pressure: Pascal,
        /// Mean deformed gap.
        pub mean_gap: Metre,
        /// Elastic energy ½ ΔA Σ p u, with friction ½ ΔA Σ (p u + q·uₜ).
        pub elastic_energy: Joule,
        /// Number of cells at the hardness, under shear at their caps.
        pub plastic_cells: usize,
        /// Plastic volume ΔA Σ w, w the plastic interference that the cells have taken up in the course of the loading.
        pub plastic_volume: CubicMetre,
        /// Iterations of the solver.
        pub iterations: usize,
        /// Convolutions; those on coarser grids count by their share of cells.
        pub convolutions: f64,
        /// Scale-free complementarity residual η.
        pub residual: f64,
        /// Tangential quantities; none without friction.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub shear: Option<ShearRecord>,
        /// Plastic flow below the surfaces; none of bodies that do not flow.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub flow: Option<FlowRecord>,
    }
}

columns! {
    /// Tangential quantities of a static contact with friction.
    ///
    /// The energies of a rolling contact are those of [`RollingSolution`](crate::solver::RollingSolution).
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct ShearRecord {
        /// Force of the upper body on the lower one, along x and y.
        pub tangential_force: [Newton; 2],
        /// Magnitude of the tangential force over the load; 0 without load.
        pub force_ratio: f64,
        /// Force ratio where no cell sticks, the friction coefficient of the contact as a whole; unknown elsewhere.
        pub friction_coefficient: Option<f64>,
        /// Rigid-body displacement of the upper body against the lower one, along x and y; 0 in sliding.
        pub tangential_displacement: [Metre; 2],
        /// Area of the cells that stick in the last increment.
        pub stick_area: SquareMetre,
        /// Largest shear traction.
        pub max_shear: Pascal,
        /// Energy that friction took; in rolling, while the contact moves on by a cell, from the work of force, moment and pressure; 0 in
        /// sliding, whose slip has no bound.
        pub dissipation: Joule,
        /// In rolling, work of the shear on the slip of the cells while the contact moves on by a cell, ΔA Σ q·Δs. It comes to
        /// `dissipation` as the cells become small.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub slip_work: Option<Joule>,
        /// In rolling, velocity of the upper body against the lower one over the rolling velocity, along x and y.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub creepage: Option<[f64; 2]>,
        /// In rolling, angular velocity of the upper body against the lower one over the rolling velocity, about z through the middle of
        /// the grid.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub spin: Option<PerMetre>,
        /// In rolling, moment of the upper body on the lower one about the same axis.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub moment: Option<NewtonMetre>,
    }
}

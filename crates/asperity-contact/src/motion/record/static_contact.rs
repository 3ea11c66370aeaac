//! A static contact.

use serde::{Deserialize, Serialize};

use super::heat::HeatRecord;
use super::laws::FrettingRecord;
use super::plastic::PlasticRecord;
use crate::solver::InterfaceRecord;
use crate::units::{CubicMetre, Joule, Metre, Newton, NewtonMetre, Pascal, PerMetre, SquareMetre};
use asperity_base::record::columns;

columns! {
    /// A static contact in numbers: `static` in `summary.json`.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct StaticRecord {
        /// Total normal force W.
        pub load: Newton,
        /// Rigid-body approach δ.
        pub approach: Metre,
        /// Area of the cells in contact: with p > 0, or with p > −σ(0) where the bodies attract each other.
        pub contact_area: SquareMetre,
        /// Area of the whole grid.
        pub apparent_area: SquareMetre,
        /// Largest pressure.
        pub max_pressure: Pascal,
        /// Mean deformed gap.
        pub mean_gap: Metre,
        /// Elastic energy ½ ΔA Σ p u, with friction ½ ΔA Σ (p u + q·uₜ).
        pub elastic_energy: Joule,
        /// Number of cells at the hardness, or at their caps under shear.
        pub plastic_cells: usize,
        /// Plastic volume ΔA Σ w, with w the plastic interference of the cells over the whole loading.
        pub plastic_volume: CubicMetre,
        /// Iterations of the solver.
        pub iterations: usize,
        /// Convolutions; a convolution on a coarser grid counts by its fraction of cells.
        pub convolutions: f64,
        /// Scale-free complementarity residual η.
        pub residual: f64,
        /// Tangential quantities; none without friction.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub shear: Option<ShearRecord>,
        /// Tension across the gap; none between hard walls.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub interface: Option<InterfaceRecord>,
        /// Plastic flow below the surfaces; none without elasto-plastic bodies.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub plastic: Option<PlasticRecord>,
        /// Cycles of a loading, and changes by slip; none of bodies that neither change nor count their
        /// cycles.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub fretting: Option<FrettingRecord>,
        /// Heat of friction in the last computed cycle; none without a flash temperature.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub heat: Option<HeatRecord>,
    }
}

columns! {
    /// Tangential quantities of a static contact with friction.
    ///
    /// The energies of a rolling contact are defined in [`RollingSolution`](crate::solver::RollingSolution).
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct ShearRecord {
        /// Force of the upper body on the lower one, along x and y.
        pub tangential_force: [Newton; 2],
        /// Magnitude of the tangential force over the load; 0 unless the load is above 0.
        pub force_ratio: f64,
        /// Force ratio if no cell sticks, that is the friction coefficient of the whole contact; otherwise
        /// unknown.
        pub friction_coefficient: Option<f64>,
        /// Rigid-body displacement of the upper body relative to the lower one, along x and y; 0 in sliding.
        pub tangential_displacement: [Metre; 2],
        /// Area of the cells that stick in the last increment.
        pub stick_area: SquareMetre,
        /// Largest shear traction.
        pub max_shear: Pascal,
        /// Energy dissipated by friction. In rolling it is the dissipation while the contact moves by one
        /// cell, from the work of force, moment and pressure. In sliding it is 0, because the slip has no
        /// limit.
        pub dissipation: Joule,
        /// In rolling, work of the shear on the slip of the cells while the contact moves by one cell, ΔA Σ
        /// q·Δs. It converges to `dissipation` with smaller cells.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub slip_work: Option<Joule>,
        /// In rolling, velocity of the upper body relative to the lower one, over the rolling velocity, along
        /// x and y.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub creepage: Option<[f64; 2]>,
        /// In rolling, angular velocity of the upper body relative to the lower one, over the rolling
        /// velocity, about z through the middle of the grid.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub spin: Option<PerMetre>,
        /// In rolling, moment of the upper body on the lower one about the same axis.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub moment: Option<NewtonMetre>,
    }
}

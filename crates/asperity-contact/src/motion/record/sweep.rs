//! A point of a sweep.

use serde::{Deserialize, Serialize};

use super::lubrication::LubricationRecord;
use super::plastic::PlasticStepRecord;
use super::steady::SteadyRecord;
use crate::solver::InterfaceRecord;
use crate::units::{CubicMetre, Joule, Metre, MetrePerSecond, Newton, NewtonPerMetre, Pascal, SquareMetre};
use asperity_base::record::columns;

columns! {
    /// One point of a sweep: a row of `sweep.csv`.
    ///
    /// [`normal_stiffness`](crate::solver::normal_stiffness) computes the stiffness.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct SweepRecord {
        /// Point, from 1, in the order given.
        pub point: usize,
        /// Normal force W.
        pub load: Newton,
        /// Load over the area of the whole grid.
        pub mean_pressure: Pascal,
        /// Rigid-body approach δ.
        pub approach: Metre,
        /// Mean deformed gap.
        pub mean_gap: Metre,
        /// Area of the cells in contact: with p > 0, or with p > −σ(0) where the bodies attract each other.
        pub contact_area: SquareMetre,
        /// Area of contact, corrected for the cells at the edges of spots, which bear on a part of their area.
        pub contact_area_corrected: SquareMetre,
        /// Area of contact over the area of the whole grid, 0 to 1.
        pub contact_fraction: f64,
        /// Width of the contact spot with the most cells, in cells: the smaller of its columns and rows.
        pub largest_spot_cells: usize,
        /// Largest pressure.
        pub max_pressure: Pascal,
        /// Area of the cells at the hardness, or at their caps under shear.
        pub plastic_area: SquareMetre,
        /// Plastic volume ΔA Σ w, with w the plastic interference of the cells.
        pub plastic_volume: CubicMetre,
        /// Elastic energy ½ ΔA Σ p u; in rolling also the energy of the shear. For viscoelastic bodies it is
        /// no stored energy.
        pub elastic_energy: Joule,
        /// Normal stiffness dW/dδ; unknown for bodies that attract each other, in steady sliding, and in full
        /// elastic contact of a periodic surface, where it is infinite.
        pub stiffness: Option<NewtonPerMetre>,
        /// Creepage along x; without rolling, the columns from here to `slip_work` are 0.
        pub creepage_x: f64,
        /// Creepage along y.
        pub creepage_y: f64,
        /// Force of the upper body on the lower one along x.
        pub tangential_force_x: Newton,
        /// Force of the upper body on the lower one along y.
        pub tangential_force_y: Newton,
        /// Area of the cells that stick.
        pub stick_area: SquareMetre,
        /// Largest shear traction.
        pub max_shear: Pascal,
        /// Energy dissipated by friction while the contact moves by one cell, from the work of force, moment
        /// and pressure.
        pub dissipation: Joule,
        /// Work of the shear on the slip of the cells meanwhile: the dissipation without the discretisation
        /// error of a step by one cell.
        pub slip_work: Joule,
        /// Iterations of the solver.
        pub iterations: usize,
        /// Convolutions, including those of the stiffness.
        pub convolutions: f64,
        /// Scale-free residual η.
        pub residual: f64,
        /// Tension across the gap; none between hard walls.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub interface: Option<InterfaceRecord>,
        /// Speed of bodies that slide steadily: that of the contact over the viscoelastic body that is smooth along
        /// x, or the mean speed of both surfaces of lubricated bodies, along x. None for others.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub speed: Option<MetrePerSecond>,
        /// Steady sliding of viscoelastic bodies; none for others.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub steady: Option<SteadyRecord>,
        /// The film between lubricated bodies; none between others.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub lubrication: Option<LubricationRecord>,
        /// Plastic flow below the surfaces up to the load of the point; none for other than elasto-plastic
        /// bodies.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub plastic: Option<PlasticStepRecord>,
    }
}

impl SweepRecord {
    /// Tangential force over the load, along x and along y; `None` unless the load is above 0, as under a
    /// load that pulls at bodies that attract each other.
    pub fn traction(&self) -> Option<[f64; 2]> {
        let force = [self.tangential_force_x, self.tangential_force_y];
        (self.load > 0.0).then(|| force.map(|force| force / self.load))
    }
}

//! An increment of a loading.

use serde::{Deserialize, Serialize};

use super::creep::CreepRecord;
use super::heat::HeatRecord;
use super::laws::FrettingRecord;
use super::plastic::PlasticStepRecord;
use crate::solver::InterfaceRecord;
use crate::units::{CubicMetre, Joule, Metre, Newton, Pascal, SquareMetre};
use asperity_base::record::columns;
use asperity_base::record::number_or_none;

columns! {
    /// One increment of the loading of a static contact: a row of `increments.csv`.
    #[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
    pub struct IncrementRecord {
        /// Increment, from 1.
        pub increment: usize,
        /// Stage of the loading, from 1.
        pub stage: usize,
        /// Normal force W.
        pub load: Newton,
        /// Rigid-body approach δ; unknown for separated elasto-plastic bodies.
        #[serde(deserialize_with = "number_or_none")]
        pub approach: Metre,
        /// Force of the upper body on the lower one along x.
        pub tangential_force_x: Newton,
        /// Force of the upper body on the lower one along y.
        pub tangential_force_y: Newton,
        /// Rigid-body displacement of the upper body relative to the lower one along x; 0 in sliding.
        pub tangential_displacement_x: Metre,
        /// Rigid-body displacement of the upper body relative to the lower one along y; 0 in sliding.
        pub tangential_displacement_y: Metre,
        /// Area of the cells in contact: with p > 0, or with p > −σ(0) where the bodies attract each other.
        pub contact_area: SquareMetre,
        /// Area of the cells that stick in this increment; 0 without friction.
        pub stick_area: SquareMetre,
        /// Largest pressure.
        pub max_pressure: Pascal,
        /// Largest shear traction.
        pub max_shear: Pascal,
        /// Plastic volume that both bodies have lost so far.
        pub plastic_volume: CubicMetre,
        /// Elastic energy ½ ΔA Σ (p u + q·uₜ).
        pub elastic_energy: Joule,
        /// Energy dissipated by friction in this increment.
        pub dissipation: Joule,
        /// Iterations of the solver.
        pub iterations: usize,
        /// Convolutions of the increment.
        pub convolutions: f64,
        /// Scale-free residual η, the larger of the normal and the tangential one.
        pub residual: f64,
        /// Tension across the gap; none between hard walls.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub interface: Option<InterfaceRecord>,
        /// Plastic flow below the surfaces; none without elasto-plastic bodies.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub plastic: Option<PlasticStepRecord>,
        /// Cycles, and changes by laws; none of bodies that neither change nor count their cycles.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub fretting: Option<FrettingRecord>,
        /// Heat of friction in the last computed cycle; none without a flash temperature.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub heat: Option<HeatRecord>,
        /// Time of viscoelastic bodies; none of others.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub creep: Option<CreepRecord>,
    }
}

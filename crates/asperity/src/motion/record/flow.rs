//! Plastic flow below the surfaces.

use serde::{Deserialize, Serialize};

use super::columns::columns;
use crate::units::{CubicMetre, Joule, Metre, Pascal};

columns! {
    /// Plastic flow of both bodies: of a static contact under its last load, of a motion after its last pass.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct FlowRecord {
        /// Largest accumulated plastic strain.
        pub max_plastic_strain: f64,
        /// Place of the largest plastic strain: x and y from the corner of the body, z from its surface.
        pub max_plastic_strain_position: [Metre; 3],
        /// Volume of all cells with plastic strain.
        pub yielded_volume: CubicMetre,
        /// Plastic work ∫ σ : dε.
        pub plastic_work: Joule,
        /// Energy stored in the residual stress, −½ ∫ ε : Kε.
        pub stored_energy: Joule,
        /// Volume ΔA Σ max(r, 0) by which the surfaces have been displaced inward; r is the inward displacement by the plastic strain.
        pub displaced_volume: CubicMetre,
        /// Largest principal stress of the residual stress, in tension.
        pub max_residual_tension: Pascal,
        /// Range of the inward displacement r of a surface: its largest less its least value.
        pub residual_displacement: Metre,
        /// Applications of the operator of the residual stress, over all increments.
        pub products: usize,
        /// Largest return-mapping residual over the yield stress at the end of an increment.
        pub mismatch: f64,
        /// Response of the bodies to repeated loading, as a word.
        pub regime: Regime,
        /// Growth of the largest plastic strain in a pass, of bodies that ratchet.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub strain_per_pass: Option<f64>,
        /// Displacement of the surface along x in a pass, of bodies that ratchet; that of the body where it is larger.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub shift_per_pass: Option<Metre>,
        /// The plastic flow once the load is taken off; none where it is not taken off.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub residual: Option<ResidualRecord>,
    }
}

columns! {
    /// Plastic flow of both bodies of a static contact once its load is taken off.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct ResidualRecord {
        /// `max_plastic_strain` without the load.
        pub residual_max_plastic_strain: f64,
        /// `yielded_volume` without the load.
        pub residual_yielded_volume: CubicMetre,
        /// `plastic_work` without the load.
        pub residual_plastic_work: Joule,
        /// `stored_energy` without the load.
        pub residual_stored_energy: Joule,
        /// `displaced_volume` without the load.
        pub residual_displaced_volume: CubicMetre,
        /// `max_residual_tension` without the load.
        pub residual_max_residual_tension: Pascal,
        /// `residual_displacement` without the load.
        pub residual_residual_displacement: Metre,
    }
}

impl FlowRecord {
    /// The record of bodies whose load has been taken off.
    pub(in crate::motion) fn into_residual(self) -> ResidualRecord {
        ResidualRecord {
            residual_max_plastic_strain: self.max_plastic_strain,
            residual_yielded_volume: self.yielded_volume,
            residual_plastic_work: self.plastic_work,
            residual_stored_energy: self.stored_energy,
            residual_displaced_volume: self.displaced_volume,
            residual_max_residual_tension: self.max_residual_tension,
            residual_residual_displacement: self.residual_displacement,
        }
    }
}

columns! {
    /// Plastic flow in a pass: further columns of its row. 0 for an elastic body.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct PassFlowRecord {
        /// Largest accumulated plastic strain of the lower body after the pass.
        pub max_plastic_strain_lower: f64,
        /// Largest accumulated plastic strain of the upper body after the pass.
        pub max_plastic_strain_upper: f64,
        /// Plastic work in the lower body in the pass.
        pub plastic_work_lower: Joule,
        /// Plastic work in the upper body in the pass.
        pub plastic_work_upper: Joule,
        /// Part of the plastic work under the two columns at either end of the overlap; 0 where the boundary is periodic along x.
        pub plastic_work_rim: Joule,
        /// Displacement of the surface of the lower body along +x against its depths in the pass, in the mean over it.
        pub surface_shift_lower: Metre,
        /// Displacement of the surface of the upper body along +x against its depths in the pass, in the mean over it.
        pub surface_shift_upper: Metre,
        /// Range of the inward displacement r of the lower surface by the plastic strain after the pass.
        pub residual_displacement_lower: Metre,
        /// Range of the inward displacement r of the upper surface by the plastic strain after the pass.
        pub residual_displacement_upper: Metre,
        /// Net strain of the lower body in the pass over what has accumulated in it, ∫ √(⅔ Δε:Δε) over ∫ Δp̄: 1 where each cell flows one
        /// way, 0 where flow comes and goes.
        pub net_strain_lower: f64,
        /// Net strain of the upper body in the pass over what has accumulated in it.
        pub net_strain_upper: f64,
    }
}

columns! {
    /// Plastic flow in a step or an increment: further columns of its row.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct FlowStepRecord {
        /// Cells in all layers of both bodies that have yielded in the step or increment.
        pub yielded_cells: usize,
        /// Largest accumulated plastic strain at the end of it.
        pub max_plastic_strain: f64,
        /// Plastic work in the step or increment.
        pub plastic_work: Joule,
        /// Applications of the operator of the residual stress.
        pub products: usize,
        /// Return-mapping residual over the yield stress.
        pub mismatch: f64,
    }
}

/// Response of elasto-plastic bodies to repeated loading.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Regime {
    /// The bodies have stayed elastic.
    Elastic,
    /// The bodies of a contact at rest have yielded.
    Yields,
    /// The bodies shake down: the plastic work of a pass is below 10⁻³ of the first's, and falls.
    ShakesDown,
    /// The same flow comes and goes in each pass: its net strain is below 5 % of what accumulates.
    Cyclic,
    /// Strain accumulates in each pass alike.
    Ratchets,
    /// More passes are needed to tell.
    Undecided,
}

impl std::fmt::Display for Regime {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Elastic => "elastic",
            Self::Yields => "yields",
            Self::ShakesDown => "shakes down",
            Self::Cyclic => "cyclic",
            Self::Ratchets => "ratchets",
            Self::Undecided => "undecided: more passes",
        })
    }
}

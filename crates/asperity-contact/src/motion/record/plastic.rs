//! Plastic flow below the surfaces.

use serde::{Deserialize, Serialize};

use crate::units::{CubicMetre, Joule, Metre, Pascal};
use asperity_base::record::columns;

columns! {
    /// Plastic flow of both bodies, under the last load of a static contact or after the last pass of a
    /// motion.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct PlasticRecord {
        /// Largest accumulated plastic strain.
        pub max_plastic_strain: f64,
        /// Position of the largest plastic strain: x and y from the corner of the body, z from its surface.
        pub max_plastic_strain_position: [Metre; 3],
        /// Volume of all cells with plastic strain.
        pub yielded_volume: CubicMetre,
        /// Plastic work ∫ σ : dε.
        pub plastic_work: Joule,
        /// Energy stored in the residual stress, −½ ∫ ε : Kε.
        pub stored_energy: Joule,
        /// Volume ΔA Σ max(r, 0) by which the surfaces have been displaced inward; r is the inward
        /// displacement by the plastic strain.
        pub displaced_volume: CubicMetre,
        /// Largest principal residual stress, in tension.
        pub max_residual_tension: Pascal,
        /// Range of the inward displacement r of a surface: its largest minus its smallest value.
        pub residual_displacement: Metre,
        /// Applications of the operator of the residual stress, over all increments.
        pub products: usize,
        /// Largest return-mapping residual over the yield stress at the end of an increment.
        pub mismatch: f64,
        /// Response of the bodies to repeated loading, as a word.
        pub regime: Regime,
        /// Growth of the largest plastic strain per pass, if the bodies ratchet.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub strain_per_pass: Option<f64>,
        /// Displacement of the surface along x per pass, if the bodies ratchet; the larger one of the two
        /// bodies.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub shift_per_pass: Option<Metre>,
        /// The plastic flow after unloading; none without unloading.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub residual: Option<ResidualRecord>,
    }
}

columns! {
    /// Plastic flow of both bodies of a static contact after unloading.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct ResidualRecord {
        /// `max_plastic_strain` after unloading.
        pub residual_max_plastic_strain: f64,
        /// `yielded_volume` after unloading.
        pub residual_yielded_volume: CubicMetre,
        /// `plastic_work` after unloading.
        pub residual_plastic_work: Joule,
        /// `stored_energy` after unloading.
        pub residual_stored_energy: Joule,
        /// `displaced_volume` after unloading.
        pub residual_displaced_volume: CubicMetre,
        /// `max_residual_tension` after unloading.
        pub residual_max_residual_tension: Pascal,
        /// `residual_displacement` after unloading.
        pub residual_residual_displacement: Metre,
    }
}

impl PlasticRecord {
    /// Returns the record of unloaded bodies.
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
    pub struct PassPlasticRecord {
        /// Largest accumulated plastic strain of the lower body after the pass.
        #[over_motion(State)]
        pub max_plastic_strain_lower: f64,
        /// Largest accumulated plastic strain of the upper body after the pass.
        #[over_motion(State)]
        pub max_plastic_strain_upper: f64,
        /// Plastic work in the lower body in the pass.
        #[over_motion(Sum)]
        pub plastic_work_lower: Joule,
        /// Plastic work in the upper body in the pass.
        #[over_motion(Sum)]
        pub plastic_work_upper: Joule,
        /// Plastic work below the two columns at either end of the overlap, a part of the plastic work; 0 if
        /// the boundary is periodic along x.
        #[over_motion(Sum)]
        pub plastic_work_rim: Joule,
        /// Displacement of the surface of the lower body along +x relative to its depths in the pass,
        /// averaged over the surface.
        #[over_motion(Sum)]
        pub surface_shift_lower: Metre,
        /// Displacement of the surface of the upper body along +x relative to its depths in the pass,
        /// averaged over the surface.
        #[over_motion(Sum)]
        pub surface_shift_upper: Metre,
        /// Range of the inward displacement r of the lower surface by the plastic strain after the pass.
        #[over_motion(State)]
        pub residual_displacement_lower: Metre,
        /// Range of the inward displacement r of the upper surface by the plastic strain after the pass.
        #[over_motion(State)]
        pub residual_displacement_upper: Metre,
        /// Net strain of the lower body in the pass over the accumulated strain, ∫ √(⅔ Δε:Δε) over ∫ Δp̄: 1
        /// if each cell flows in one direction, 0 if the flow reverses completely.
        pub net_strain_lower: f64,
        /// Net strain of the upper body in the pass over the accumulated strain.
        pub net_strain_upper: f64,
    }
}

columns! {
    /// Plastic flow in a step or an increment, or up to a point of a sweep: further columns of its row.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct PlasticStepRecord {
        /// Cells in all layers of both bodies that have yielded in the step or increment; of a point, in the
        /// increment with the most.
        pub yielded_cells: usize,
        /// Largest accumulated plastic strain at the end.
        pub max_plastic_strain: f64,
        /// Plastic work.
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
    /// The bodies of a static contact have yielded.
    Yields,
    /// The bodies shake down: the plastic work per pass is below 10⁻³ of the first pass, and decreases.
    ShakesDown,
    /// The flow reverses within each pass: its net strain is below 5 % of the accumulated strain.
    Cyclic,
    /// Strain accumulates equally in each pass.
    Ratchets,
    /// More passes are needed to decide.
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

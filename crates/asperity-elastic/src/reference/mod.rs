//! Closed forms: contacts with a known solution, to verify computations.
//!
//! A contact is a struct of its data (geometry, composite modulus E*, load), with its results as methods.
//! Lengths, moduli and loads are positive unless stated otherwise. An invalid value gives NaN or infinity,
//! never a panic. Displacements u are composite, positive where they open the gap, and u = 0 far away.

pub mod adhesion;
pub mod carter;
pub mod cattaneo;
pub mod cell;
pub mod cone;
pub mod elliptic;
pub mod hamilton;
pub mod heat;
pub mod hertz;
pub mod inclusion;
pub mod line;
pub mod punch;
pub mod rough;
pub mod spence;
pub mod sticking;
pub mod viscoelastic;
pub mod westergaard;

pub use adhesion::{AdhesiveWave, DmtSphere, JkrSphere, KendallPunch, MaugisSphere};
pub use carter::Carter;
pub use cattaneo::{CattaneoMindlin, MindlinDeresiewicz};
pub use cone::Cone;
pub use elliptic::HertzEllipse;
pub use hamilton::SlidingSphere;
pub use heat::{BandSource, HeatedDisc, HertzianFlux, SquareSource};
pub use hertz::HertzSphere;
pub use inclusion::Inclusion;
pub use line::HertzLine;
pub use punch::FlatPunch;
pub use sticking::{StickingPunch, StickingSphere};
pub use viscoelastic::{CylinderOnFoundation, ViscoelasticCylinder};
pub use westergaard::Westergaard;

#[cfg(test)]
mod quadrature;

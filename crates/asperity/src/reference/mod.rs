//! Closed forms: contacts whose answer is known, to judge a computation by.
//!
//! A contact is a struct of its data (geometry, composite modulus E*, load), its answers are methods. Lengths,
//! moduli and loads are positive where nothing else is said; a value without meaning gives a NaN or an infinity,
//! never a panic. Displacements u are the composite ones, positive where they open the gap, u = 0 far away.

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
pub mod westergaard;

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
pub use westergaard::Westergaard;

#[cfg(test)]
mod quadrature;

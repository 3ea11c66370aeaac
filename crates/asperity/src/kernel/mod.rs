//! Influence coefficients: what a unit pressure on one cell does to another.

pub mod normal;
pub mod spectral;
pub mod subsurface;

pub use normal::{influence_matrix, influence_table, normal_displacement};
pub use subsurface::{Traction, cell_stress, harmonic_stress, stress_table};

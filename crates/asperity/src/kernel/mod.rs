//! Influence coefficients: what a unit pressure on one cell does to another.

pub mod normal;
pub mod spectral;

pub use normal::{influence_matrix, influence_table, normal_displacement};

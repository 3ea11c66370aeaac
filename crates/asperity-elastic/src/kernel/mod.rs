//! Influence coefficients: displacement of a cell per unit traction on another.

mod cell;
mod coefficients;
pub mod coupled;
mod half_spaces;
mod layered;
mod layering;
pub mod line;
pub mod normal;
mod remainder;
mod response;
mod smooth_line;
pub mod spectral;
mod stack;
mod stress_cells;
pub mod subsurface;

pub use coefficients::Coefficients;
pub use coupled::{CoupledTable, coupled_displacement, coupled_matrix};
pub use half_spaces::HalfSpaces;
pub use layered::{LayeredBody, response};
pub use layering::Layering;
pub use line::Line;
pub use normal::{influence_matrix, influence_table, normal_displacement, normal_displacements_across};
pub use response::{CoupledInfluence, CoupledResponse, Influence, Response, SharedResponse};
pub use stack::{Modulus, Stack, Wave, WaveStress, potential_compliance};
pub use stress_cells::{LayerCells, LayerStrip};
pub use subsurface::{Traction, cell_stress, harmonic_stress, stress_table};

//! Linear viscoelastic bodies: relaxation and creep, steady sliding, memory in time.

mod operator;
mod panels;
mod series;
mod steady;
mod table;
#[cfg(test)]
mod tests;

pub use operator::SteadySliding;
pub use series::{Creep, CreepTerm, Relaxation, RelaxationTerm};
pub use steady::{SteadyContact, solve_steady};

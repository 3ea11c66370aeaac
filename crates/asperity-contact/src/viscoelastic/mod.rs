//! Linear viscoelastic bodies: relaxation and creep, steady sliding, memory in time.

mod layers;
mod master_curve;
pub(crate) mod memory;
mod operator;
mod panels;
mod series;
mod steady;
mod table;
#[cfg(test)]
mod tests;

pub use layers::{BodyRelaxation, SlidingBodies, ViscoelasticStack};
pub use master_curve::{MasterFit, MasterPoint, fit_master_curve};
pub use memory::{CreepMemory, solve_in_time};
pub use operator::SteadySliding;
pub use series::{Creep, CreepTerm, Relaxation, RelaxationTerm};
pub use steady::{SteadyContact, solve_steady};

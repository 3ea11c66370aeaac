//! Linear viscoelastic bodies: relaxation and creep, steady sliding, memory in time.

mod series;

pub use series::{Creep, CreepTerm, Relaxation, RelaxationTerm};

//! Operators: traction in, displacement out.

mod boundary;
mod compliant;
mod coupled;
mod direct_sum;
mod family;
mod free_fft;
mod periodic_fft;
mod shared;
mod slab_fft;

pub use boundary::{Boundary, Edge};
pub use compliant::Compliant;
pub use coupled::{CoupledFft, CoupledOperator, CoupledSum};
pub use direct_sum::DirectSum;
pub use family::Operators;
pub use free_fft::{FreeFamily, FreeFft};
pub use periodic_fft::{PeriodicFft, PeriodicKernel};
pub use slab_fft::SlabFft;

use crate::grid::{CellValues, Field, Grid, SingleField};
use crate::ranks::Slab;

/// The composite normal displacement of a pair of bodies under pressure: `u = C p`.
///
/// An operator owns its scratch; its answer never depends on it.
pub trait Operator: Send {
    /// The grid that it acts on.
    fn grid(&self) -> &Grid;

    /// The slab that [`Operator::grid`] is of a grid divided among ranks, which then apply it all together: the whole grid
    /// where there are none. Boundary, influence and harmonics are those of the whole.
    fn slab(&self) -> Slab {
        Slab::whole(*self.grid())
    }

    /// What lies beyond the edges of the grid.
    fn boundary(&self) -> Boundary;

    /// Whether no pressure displaces the cells in the mean: nothing then tells a uniform pressure from another.
    fn leaves_mean_free(&self) -> bool {
        self.boundary().leaves_mean_free()
    }

    /// Displacement per unit pressure of the harmonic of angular wavenumber `(qx, qy)` ≠ 0, m/Pa, > 0: what the solvers
    /// precondition with. It need not be exact.
    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64;

    /// Displacement of a cell per unit pressure on the one `i` and `j` cells away, m/Pa; `[i, j]` inside the grid.
    fn influence(&self, i: usize, j: usize) -> f64;

    /// Displacement of each cell per unit pressure on itself, m/Pa, > 0: that of [`Operator::influence`], which is the mean where
    /// cells differ in it.
    fn self_influence(&self) -> CellValues {
        CellValues::Uniform(self.influence(0, 0))
    }

    /// Writes the displacement under `pressure` into `displacement`. Both have the grid's shape.
    fn apply(&mut self, pressure: &Field, displacement: &mut Field);

    /// The displacement as of [`Operator::apply`], in single precision: to about 3e-7 of the largest displacement, in
    /// half the time where
    /// the operator has its own.
    fn apply_single(&mut self, pressure: &SingleField, displacement: &mut SingleField) {
        let mut double = Field::zeros(pressure.raw_dim());
        self.apply(&pressure.mapv(f64::from), &mut double);
        displacement.zip_mut_with(&double, |single, double| *single = *double as f32);
    }

    /// Gives back the room that convolutions work in, if there is any: the next one makes it anew.
    fn release(&mut self) {}

    /// An operator of the same bodies on a grid of about half as many cells along each axis.
    fn coarse(&self) -> Box<dyn Operator>;
}

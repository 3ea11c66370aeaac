//! Operators: displacement under traction.

mod boundary;
mod compliant;
mod coupled;
mod deferred;
mod definition;
mod direct_sum;
mod family;
mod free_fft;
mod periodic_fft;
mod shared;

pub use boundary::{Boundary, Edge};
pub use compliant::Compliant;
pub use coupled::{CoupledFft, CoupledOperator, CoupledSum};
pub use deferred::Deferred;
pub use definition::Definition;
pub use direct_sum::DirectSum;
pub use family::Operators;
pub use free_fft::{FreeFamily, FreeFft};
pub use periodic_fft::{PeriodicFft, PeriodicKernel};

use crate::grid::{CellValues, Field, Grid, SingleField};
use crate::ranks::Slab;

/// The composite normal displacement of a pair of bodies under pressure: `u = C p`.
///
/// An operator owns its scratch memory. Its result never depends on it.
pub trait Operator: Send {
    /// Returns the grid of the operator.
    fn grid(&self) -> &Grid;

    /// Returns the slab of this rank if the grid is divided among ranks, which then apply the operator
    /// together; otherwise the whole grid. Boundary, influence and harmonics refer to the whole grid.
    fn slab(&self) -> Slab {
        Slab::whole(*self.grid())
    }

    /// Returns the boundary of the grid.
    fn boundary(&self) -> Boundary;

    /// Whether no pressure causes a mean displacement. A uniform pressure is then undetermined.
    fn leaves_mean_free(&self) -> bool {
        self.boundary().leaves_mean_free()
    }

    /// Returns the displacement per unit pressure of the harmonic of angular wavenumber `(qx, qy)` ≠ 0, m/Pa, >
    /// 0. It serves the preconditioner of the solvers, and need not be exact.
    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64;

    /// Returns the displacement of a cell per unit pressure on the cell at a distance of `i` and `j` cells,
    /// m/Pa; `[i, j]` is inside the grid.
    fn influence(&self, i: usize, j: usize) -> f64;

    /// Returns the displacement of each cell per unit pressure on itself, m/Pa, > 0. If cells differ,
    /// [`Operator::influence`] is its mean.
    fn self_influence(&self) -> CellValues {
        CellValues::Uniform(self.influence(0, 0))
    }

    /// Computes the `displacement` under `pressure`. Both have the shape of the grid.
    fn apply(&mut self, pressure: &Field, displacement: &mut Field);

    /// Computes the displacement like [`Operator::apply`], but in single precision. The error is about 3e-7
    /// of the largest displacement. Operators with their own implementation take half the time.
    fn apply_single(&mut self, pressure: &SingleField, displacement: &mut SingleField) {
        let mut double = Field::zeros(pressure.raw_dim());
        self.apply(&pressure.mapv(f64::from), &mut double);
        displacement.zip_mut_with(&double, |single, double| *single = *double as f32);
    }

    /// Whether [`Operator::apply_near`] takes only a fraction of the time of [`Operator::apply_single`]. The
    /// active set then convolves its search directions with the near copy, and only corrects by the operator
    /// itself.
    fn has_near_copy(&self) -> bool {
        false
    }

    /// Computes the displacement by a near copy of the operator: symmetric, and within about a tenth of the
    /// operator in the energy norm.
    fn apply_near(&mut self, pressure: &SingleField, displacement: &mut SingleField) {
        self.apply_single(pressure, displacement);
    }

    /// Releases the scratch memory of convolutions. The next convolution allocates it again.
    fn release(&mut self) {}

    /// Returns what the operator is made of, from which a device computes it; none if only the processor
    /// does.
    fn definition(&self) -> Option<Definition> {
        None
    }

    /// Returns an operator of the same bodies on a grid of about half as many cells along each axis.
    fn coarse(&self) -> Box<dyn Operator>;
}

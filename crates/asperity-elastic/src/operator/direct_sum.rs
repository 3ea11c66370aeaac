//! Sum over all pairs of cells, without transforms.

use crate::grid::{Field, Grid};
use crate::kernel::SharedResponse;
use crate::operator::{Boundary, Definition, Operator};

/// Free boundary by direct summation of the influence coefficients: O(n²) for n cells, exact to round-off.
///
/// It is the reference of the transforms, and the fastest operator for a few cells.
pub struct DirectSum {
    grid: Grid,
    response: SharedResponse,
    table: Field,
}

impl DirectSum {
    /// Creates the operator on `grid` for bodies with this `response`, such as the composite modulus E* of
    /// two half-spaces.
    pub fn new(grid: Grid, response: impl Into<SharedResponse>) -> Self {
        let response = response.into();
        let table = response.influence(grid.pitch).table(grid.shape, grid.pitch);
        Self { grid, response, table }
    }
}

impl Operator for DirectSum {
    fn grid(&self) -> &Grid {
        &self.grid
    }

    fn boundary(&self) -> Boundary {
        Boundary::FREE
    }

    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64 {
        self.response.harmonic_displacement(qx, qy)
    }

    fn influence(&self, i: usize, j: usize) -> f64 {
        self.table[[i, j]]
    }

    fn apply(&mut self, pressure: &Field, displacement: &mut Field) {
        displacement.fill(0.0);
        for ((i, j), &p) in pressure.indexed_iter().filter(|(_, p)| **p != 0.0) {
            for (k, mut row) in displacement.outer_iter_mut().enumerate() {
                let coefficients = self.table.row(k.abs_diff(i));
                for (l, u) in row.iter_mut().enumerate() {
                    *u += coefficients[l.abs_diff(j)] * p;
                }
            }
        }
    }

    fn definition(&self) -> Option<Definition> {
        let response = self.response.clone();
        Some(Definition { grid: self.grid, boundary: Boundary::FREE, response, datum: 0.0 })
    }

    fn coarse(&self) -> Box<dyn Operator> {
        Box::new(Self::new(Boundary::FREE.coarse(&self.grid), self.response.clone()))
    }
}

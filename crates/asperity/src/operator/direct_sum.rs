//! The sum over all pairs of cells, without any transform.

use crate::grid::{Field, Grid};
use crate::kernel::influence_table;
use crate::operator::{Boundary, Operator};
use crate::units::Pascal;

/// The free boundary by direct summation of the influence coefficients: O(n²) for n cells, exact to round-off.
///
/// What the transforms are measured against, and the fastest for a handful of cells.
pub struct DirectSum {
    grid: Grid,
    modulus: Pascal,
    table: Field,
}

impl DirectSum {
    /// The operator on `grid` for the composite `modulus`.
    pub fn new(grid: Grid, modulus: Pascal) -> Self {
        Self { grid, modulus, table: influence_table(grid.shape, grid.pitch, modulus) }
    }
}

impl Operator for DirectSum {
    fn grid(&self) -> &Grid {
        &self.grid
    }

    fn modulus(&self) -> Pascal {
        self.modulus
    }

    fn boundary(&self) -> Boundary {
        Boundary::FREE
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

    fn coarse(&self) -> Box<dyn Operator> {
        Box::new(Self::new(Boundary::FREE.coarse(&self.grid), self.modulus))
    }
}

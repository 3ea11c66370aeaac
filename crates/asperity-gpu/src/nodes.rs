//! Coarse nodes of the preconditioner, and the stiffness of the waves between them.
//!
//! The preconditioner is that of the processor's solver, `z = A (I − T) S (I − T)ᵀ A r + A P D B D Pᵀ A r` on
//! the free cells A: S is a sparse approximate inverse, P interpolates bilinearly from the nodes, B is the
//! stiffness of the waves that nodes bear, D = 1/(θ + 0.2) with the fraction θ of free cells around a node,
//! and T = P D Pᵀ.

use asperity_base::math::SparseInverse;

use crate::problem::{Compliance, Harmonics, Level};

/// Number of cells between two nodes along each axis, rounded so that nodes divide the transforms equally.
const COARSENING: f64 = 16.0;
/// Fraction of free cells added in the weight D, so that it stays finite.
pub(crate) const MIN_COVER: f64 = 0.2;

/// Nodes at equal distances over the padded cells of a contact, cyclic.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Nodes {
    /// Number of nodes along x and y.
    pub(crate) shape: [usize; 2],
    /// Number of cells between two nodes along x and y.
    pub(crate) spacing: [f64; 2],
    /// Stiffness of the longest wave, Pa/m.
    longest: f64,
    /// Whether the mean displacement is 0, along two periodic axes.
    leaves_mean_free: bool,
}

impl Nodes {
    pub(crate) fn new(level: &Level) -> Self {
        let shape = level.padded.map(|n| ((n as f64 / COARSENING).round() as usize).max(1));
        let longest = match &level.harmonics {
            Harmonics::HalfSpaces(modulus) => {
                let [x, y] = level.wavenumbers();
                0.5 * modulus * x.min(y)
            }
            Harmonics::Table(table) => {
                let along = |cell: [usize; 2]| table.get(cell).copied().unwrap_or(0.0);
                1.0 / table[[0, 0]].max(along([1, 0])).max(along([0, 1]))
            }
        };
        Self {
            shape,
            spacing: [0, 1].map(|axis| level.padded[axis] as f64 / shape[axis] as f64),
            longest,
            leaves_mean_free: matches!(level.compliance, Compliance::Harmonic),
        }
    }

    /// Number of cells for each node.
    pub(crate) fn cells(&self) -> f64 {
        self.spacing[0] * self.spacing[1]
    }

    /// Returns the node before a cell along an axis, the node after it, and the fraction of the distance
    /// between them.
    pub(crate) fn around(&self, axis: usize, cell: usize) -> (usize, usize, f64) {
        let count = self.shape[axis];
        let position = (cell as f64 + 0.5) / self.spacing[axis] - 0.5;
        let before = position.floor();
        let node = (before as isize).rem_euclid(count as isize) as usize;
        (node, (node + 1) % count, position - before)
    }

    /// Returns the stiffness of a uniform pressure if so many `free` ones of all `cells` bear it, Pa/m.
    ///
    /// The mean of a periodic surface has no stiffness of its own. A uniform pressure around open valleys
    /// displaces them by their width, and the mean by their fraction of this. The stiffness of the mean
    /// then is that of the longest wave over the square of this fraction. At free edges it is about half of
    /// the stiffness of the longest wave.
    pub(crate) fn stiffness_of_mean(&self, free: f64, cells: f64) -> f64 {
        if !self.leaves_mean_free {
            return 0.5 * self.longest;
        }
        let open = 1.0 - (free - 1.0) / cells;
        self.longest / (open * open)
    }
}

impl Level {
    /// Returns whether the cells of a contact beyond its ends along each axis are those at its other end.
    pub(crate) fn wraps(&self, shape: [usize; 2]) -> [bool; 2] {
        [0, 1].map(|axis| shape[axis] == self.padded[axis] && shape[axis] >= SparseInverse::MIN_PERIOD)
    }

    /// Creates the sparse inverse S on a contact of this shape from the displacement `influence(i, j)` of a
    /// cell by the pressure of another.
    pub(crate) fn sparse_inverse(
        &self,
        shape: [usize; 2],
        influence: impl Fn(usize, usize) -> f64,
    ) -> SparseInverse {
        // The coefficients of a periodic surface are relative to the far field.
        let far = match self.compliance {
            Compliance::Harmonic => influence(self.padded[0] / 2, self.padded[1] / 2),
            Compliance::Influence(_) => 0.0,
        };
        SparseInverse::new(shape, self.wraps(shape), |i, j| match [i, j] {
            [0, 0] => self.self_influence(influence(0, 0)) - far,
            _ => influence(i, j) - far,
        })
    }
}

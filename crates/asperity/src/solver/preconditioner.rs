//! An approximate inverse of the influence matrix restricted to the free cells; it costs no fine convolution.

use std::sync::Arc;

use crate::grid::Field;
use crate::math::{Convolution, Kernel, fft::angular_frequency};
use crate::operator::Operator;

/// Fine cells per coarse cell of the correction, along each axis.
const COARSENING: usize = 16;
/// Keeps the weight of sparsely covered coarse cells finite; see [`CoarseCorrection`].
const SPARSE: f64 = 0.2;

/// `z = A (I − T) S (I − T)ᵀ A r + A P D B D Pᵀ A r`, symmetric and positive definite on the free cells A.
///
/// S is a factorised sparse approximate inverse adapted to the free set, which deals with what is local; P
/// interpolates bilinearly from a grid with a sixteenth of the cells along each axis, T = P D Pᵀ smooths, and B is
/// the stiffness E*|q|/2 of the coarse harmonics, which deals with what is wide. D makes up for the cells of a
/// coarse one that are not free: a mean over the free ones.
pub(super) struct Preconditioner {
    sparse: SparseInverse,
    coarse: CoarseCorrection,
    smooth: Vec<f64>,
    inverse: Vec<f64>,
}

impl Preconditioner {
    pub(super) fn new(operator: &dyn Operator) -> Self {
        Self {
            sparse: SparseInverse::new(operator),
            coarse: CoarseCorrection::new(operator),
            smooth: Vec::new(),
            inverse: Vec::new(),
        }
    }

    /// Adapts to the free cells: `free` holds their flat indices in increasing order, `is_free` tells for each cell.
    pub(super) fn adapt(&mut self, free: &[u32], is_free: impl Fn(usize) -> bool) {
        self.sparse.adapt(free, is_free);
        self.coarse.adapt(free);
        self.smooth.resize(free.len(), 0.0);
        self.inverse.resize(free.len(), 0.0);
    }

    /// `z = M r` at the free cells, both given in the order of the free cells.
    pub(super) fn apply(&mut self, r: &[f64], z: &mut [f64]) {
        let Self { sparse, coarse, smooth, inverse } = self;
        coarse.restrict(r);
        coarse.interpolate_restricted(smooth);
        smooth.iter_mut().zip(r).for_each(|(s, r)| *s = r - *s);
        coarse.solve();
        coarse.interpolate_solved(z);
        sparse.apply(smooth, inverse);
        coarse.restrict(&*inverse);
        coarse.interpolate_restricted(smooth);
        for ((z, i), s) in z.iter_mut().zip(inverse).zip(smooth) {
            *z += *i - *s;
        }
    }
}

/// GᵀG ≈ C⁻¹ on the free cells: row i of G solves `C_JJ y = e_i` on the free ones J among the cell and its
/// causal neighbours, divided by √y_i. Kolotilina and Yeremin, SIAM J. Matrix Anal. Appl. 14, 45 (1993).
///
/// A row depends on nothing but which of the neighbours are free: there are 64.
struct SparseInverse {
    shape: [usize; 2],
    rows: [[f64; MEMBERS]; 1 << NEIGHBOURS],
    /// For each free cell: its row of the table, and where its neighbours stand among the free cells.
    cells: Vec<(u8, [u32; NEIGHBOURS])>,
    /// Where each cell of the grid stands among the free ones.
    place: Vec<u32>,
}

const NEIGHBOURS: usize = 6;
/// The neighbours and the cell itself, which is the last.
const MEMBERS: usize = NEIGHBOURS + 1;
/// The nearest neighbours that come before a cell in memory.
const CAUSAL: [(isize, isize); NEIGHBOURS] = [(-1, -1), (-1, 0), (-1, 1), (0, -1), (-2, 0), (0, -2)];

impl SparseInverse {
    fn new(operator: &dyn Operator) -> Self {
        let shape = operator.grid().shape;
        // Neighbours that the grid is too small for never occur; periodic coefficients count from the far field.
        let far = if operator.periodic() { operator.influence(shape[0] / 2, shape[1] / 2) } else { 0.0 };
        let coefficient = |i: usize, j: usize| {
            if i < shape[0] && j < shape[1] { operator.influence(i, j) - far } else { 0.0 }
        };
        let rows = std::array::from_fn(|pattern| {
            let members: Vec<usize> =
                (0..NEIGHBOURS).filter(|k| pattern >> k & 1 == 1).chain([NEIGHBOURS]).collect();
            let offset = |k: usize| if k == NEIGHBOURS { (0, 0) } else { CAUSAL[k] };
            let mut matrix = [[0.0; MEMBERS]; MEMBERS];
            for (a, &k) in members.iter().enumerate() {
                for (b, &l) in members.iter().enumerate() {
                    let (p, q) = (offset(k), offset(l));
                    matrix[a][b] = coefficient(p.0.abs_diff(q.0), p.1.abs_diff(q.1));
                }
            }
            let solved = last_column_of_inverse(&mut matrix, members.len());
            let scale = 1.0 / solved[members.len() - 1].sqrt();
            let mut row = [0.0; MEMBERS];
            members.iter().zip(solved).for_each(|(&k, y)| row[k] = y * scale);
            row
        });
        Self { shape, rows, cells: Vec::new(), place: vec![0; shape[0] * shape[1]] }
    }

    fn adapt(&mut self, free: &[u32], is_free: impl Fn(usize) -> bool) {
        let [nx, ny] = self.shape;
        free.iter().enumerate().for_each(|(k, &cell)| self.place[cell as usize] = k as u32);
        self.cells.clear();
        self.cells.extend(free.iter().map(|&cell| {
            let (ix, iy) = ((cell as usize / ny) as isize, (cell as usize % ny) as isize);
            let (mut pattern, mut neighbours) = (0u8, [0u32; NEIGHBOURS]);
            for (k, (di, dj)) in CAUSAL.into_iter().enumerate() {
                let (i, j) = (ix + di, iy + dj);
                if i < 0 || j < 0 || i >= nx as isize || j >= ny as isize {
                    continue;
                }
                let index = i as usize * ny + j as usize;
                if is_free(index) {
                    pattern |= 1 << k;
                    neighbours[k] = self.place[index];
                }
            }
            (pattern, neighbours)
        }));
    }

    fn apply(&self, r: &[f64], z: &mut [f64]) {
        z.fill(0.0);
        for (index, (pattern, neighbours)) in self.cells.iter().enumerate() {
            let row = &self.rows[*pattern as usize];
            let mut product = row[NEIGHBOURS] * r[index];
            for k in 0..NEIGHBOURS {
                // Absent neighbours have the coefficient 0 and point at the first cell.
                product += row[k] * r[neighbours[k] as usize];
            }
            z[index] += row[NEIGHBOURS] * product;
            for k in 0..NEIGHBOURS {
                z[neighbours[k] as usize] += row[k] * product;
            }
        }
    }
}

/// The last column of the inverse of the leading `n` × `n` block, by Gaussian elimination of a positive definite
/// matrix.
fn last_column_of_inverse(matrix: &mut [[f64; MEMBERS]; MEMBERS], n: usize) -> [f64; MEMBERS] {
    for pivot in 0..n {
        for row in pivot + 1..n {
            let factor = matrix[row][pivot] / matrix[pivot][pivot];
            let (above, below) = matrix.split_at_mut(row);
            below[0][pivot..n].iter_mut().zip(&above[pivot][pivot..n]).for_each(|(b, a)| *b -= factor * a);
        }
    }
    // The right-hand side e_n is untouched by the elimination.
    let mut solution = [0.0; MEMBERS];
    for row in (0..n).rev() {
        let right = if row == n - 1 { 1.0 } else { 0.0 };
        let known: f64 = (row + 1..n).map(|k| matrix[row][k] * solution[k]).sum();
        solution[row] = (right - known) / matrix[row][row];
    }
    solution
}

/// The stiffness of the wide harmonics on a grid with a sixteenth of the cells along each axis.
///
/// A pressure that is uniform over the free cells of a coarse cell, a share θ of it, has θ of the mean pressure; a
/// displacement that is uniform there has θ of the sum. Dividing by θ on the way there and back makes both right:
/// D = 1/(θ + 0.2), finite where a few cells are free, for which the uniform pressure is a bad guess anyway.
struct CoarseCorrection {
    shape: [usize; 2],
    fine: [usize; 2],
    /// E*|q|/2 of the coarse harmonics, divided by the fine cells in a coarse one.
    stiffness: Convolution,
    /// Fine cells in a coarse one.
    cells: f64,
    /// For each row (column) of cells: the two nodes between which it lies, and the weight of the second.
    along: [Vec<(u32, u32, f64)>; 2],
    /// Row and column of each free cell.
    free: Vec<(u32, u32)>,
    /// D at each node.
    weight: Field,
    /// D Pᵀ A r, and B of it.
    restricted: Field,
    solved: Field,
}

impl CoarseCorrection {
    fn new(operator: &dyn Operator) -> Self {
        let grid = *operator.grid();
        let shape = grid.shape.map(|n| ((n + COARSENING / 2) / COARSENING).max(1));
        let factor = [0, 1].map(|axis| grid.shape[axis] as f64 / shape[axis] as f64);
        let cells = factor[0] * factor[1];
        let longest = grid.extent()[0].max(grid.extent()[1]);
        let stiffness = Kernel::from_transform(shape, |k, l| {
            let qx = angular_frequency(k, shape[0], grid.pitch[0] * factor[0]);
            let qy = angular_frequency(l, shape[1], grid.pitch[1] * factor[1]);
            let wide = match (k, l) {
                // The mean of a periodic surface is softer than any wave; it counts under approach control alone.
                (0, 0) if operator.periodic() => std::f64::consts::PI / longest,
                // A uniform pressure on a free square of side L sinks it by 0.95 L p/E* in the mean.
                (0, 0) => 1.0 / (0.95 * grid.area().sqrt()),
                _ => 0.5 * qx.hypot(qy),
            };
            operator.modulus() * wide / cells
        });
        Self {
            shape,
            fine: grid.shape,
            stiffness: Convolution::new(Arc::new(stiffness), shape),
            cells,
            along: [0, 1].map(|axis| nodes(grid.shape[axis], shape[axis])),
            free: Vec::new(),
            weight: Field::zeros(shape),
            restricted: Field::zeros(shape),
            solved: Field::zeros(shape),
        }
    }

    fn adapt(&mut self, free: &[u32]) {
        let ny = self.fine[1] as u32;
        self.free.clear();
        self.free.extend(free.iter().map(|cell| (cell / ny, cell % ny)));
        self.weight.fill(1.0);
        self.restrict(std::iter::repeat_n(&1.0, free.len()));
        self.weight.zip_mut_with(&self.restricted, |d, count| *d = 1.0 / (count / self.cells + SPARSE));
    }

    /// The bilinear weights of a cell on the four nodes around it.
    #[inline]
    fn weights(&self, (ix, iy): (u32, u32)) -> [(usize, f64); 4] {
        let (i0, i1, s) = self.along[0][ix as usize];
        let (j0, j1, t) = self.along[1][iy as usize];
        let at = |i: u32, j: u32| i as usize * self.shape[1] + j as usize;
        [
            (at(i0, j0), (1.0 - s) * (1.0 - t)),
            (at(i0, j1), (1.0 - s) * t),
            (at(i1, j0), s * (1.0 - t)),
            (at(i1, j1), s * t),
        ]
    }

    /// D Pᵀ A r.
    fn restrict<'r>(&mut self, r: impl IntoIterator<Item = &'r f64>) {
        let mut restricted = std::mem::take(&mut self.restricted);
        restricted.fill(0.0);
        let nodes = restricted.as_slice_mut().expect("standard layout");
        for (cell, r) in self.free.iter().zip(r) {
            for (node, weight) in self.weights(*cell) {
                nodes[node] += weight * r;
            }
        }
        restricted *= &self.weight;
        self.restricted = restricted;
    }

    /// D B of what was restricted.
    fn solve(&mut self) {
        self.stiffness.apply(&self.restricted, &mut self.solved);
        self.solved *= &self.weight;
    }

    /// A P of what was restricted, divided by the fine cells in a coarse one: a smoothing.
    fn interpolate_restricted(&self, out: &mut [f64]) {
        self.interpolate(&self.restricted, 1.0 / self.cells, out);
    }

    /// A P of what was solved.
    fn interpolate_solved(&self, out: &mut [f64]) {
        self.interpolate(&self.solved, 1.0, out);
    }

    fn interpolate(&self, nodes: &Field, scale: f64, out: &mut [f64]) {
        let nodes = nodes.as_slice().expect("standard layout");
        for (cell, out) in self.free.iter().zip(out) {
            let sum: f64 = self.weights(*cell).iter().map(|(node, weight)| weight * nodes[*node]).sum();
            *out = scale * sum;
        }
    }
}

/// For each of `fine` cells the two of `coarse` nodes (cyclic) between which it lies, and the second one's weight.
fn nodes(fine: usize, coarse: usize) -> Vec<(u32, u32, f64)> {
    let factor = fine as f64 / coarse as f64;
    (0..fine)
        .map(|i| {
            let position = (i as f64 + 0.5) / factor - 0.5;
            let node = position.floor();
            let cyclic = |k: f64| (k as isize).rem_euclid(coarse as isize) as u32;
            (cyclic(node), cyclic(node + 1.0), position - node)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use crate::operator::{DirectSum, PeriodicFft};

    /// A ring of free cells and a few scattered ones.
    fn scattered(shape: [usize; 2]) -> Vec<u32> {
        (0..shape[0] * shape[1]).filter(|k| (k * 7 + k / shape[1] * 3) % 11 < 5).map(|k| k as u32).collect()
    }

    #[test]
    fn it_is_symmetric_and_positive_definite_on_any_free_set() {
        for periodic in [false, true] {
            let grid = Grid::new([13, 18], [1.0, 0.8]).unwrap();
            let operator: Box<dyn Operator> = if periodic {
                Box::new(PeriodicFft::new(grid, 1.0))
            } else {
                Box::new(DirectSum::new(grid, 1.0))
            };
            let free = scattered(grid.shape);
            let mut preconditioner = Preconditioner::new(operator.as_ref());
            preconditioner.adapt(&free, |cell| free.contains(&(cell as u32)));
            let n = free.len();
            let columns: Vec<Vec<f64>> = (0..n)
                .map(|k| {
                    let unit: Vec<f64> = (0..n).map(|i| if i == k { 1.0 } else { 0.0 }).collect();
                    let mut z = vec![0.0; n];
                    preconditioner.apply(&unit, &mut z);
                    z
                })
                .collect();
            let matrix = faer::Mat::from_fn(n, n, |i, j| columns[j][i]);
            let asymmetry = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
            let asymmetry =
                asymmetry.fold(0.0f64, |m, (i, j)| m.max((matrix[(i, j)] - matrix[(j, i)]).abs()));
            assert!(asymmetry < 1e-13, "asymmetry {asymmetry:e}");
            let values = matrix.self_adjoint_eigenvalues(faer::Side::Lower).unwrap();
            assert!(values[0] > 1e-6, "least eigenvalue {:e}", values[0]);
        }
    }

    #[test]
    fn the_sparse_inverse_is_exact_where_the_free_cells_are_isolated_pairs() {
        let grid = Grid::new([1, 2], [1.0, 1.0]).unwrap();
        let operator = DirectSum::new(grid, 1.0);
        let mut sparse = SparseInverse::new(&operator);
        sparse.adapt(&[0, 1], |_| true);
        let (c, d) = (operator.influence(0, 0), operator.influence(0, 1));
        let mut z = [0.0; 2];
        sparse.apply(&[1.0, 0.0], &mut z);
        let determinant = c * c - d * d;
        assert!((z[0] - c / determinant).abs() < 1e-12 && (z[1] + d / determinant).abs() < 1e-12);
    }
}

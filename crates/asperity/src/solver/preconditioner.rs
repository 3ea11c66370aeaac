//! The two-level preconditioner: an approximate inverse of the influence matrix on the free cells, at no fine convolution.

use crate::grid::CellValues;
use crate::math::SparseInverse;
use crate::operator::Operator;
use crate::solver::coarse_correction::CoarseCorrection;
use crate::solver::sets::Sets;

/// The preconditioner `z = A (I − T) S (I − T)ᵀ A r + A P D B D Pᵀ A r`, symmetric and positive definite on the free
/// cells A.
///
/// Where cells differ in the displacement cᵢ by their own pressure, z = D M D r with the M of their mean c and D = √(c/cᵢ):
/// exact where it is all the displacement there is.
///
/// S is the [`SparseInverse`] on the free cells, for the local part of the residual, B the stiffness of the long waves, for its
/// smooth part; see [`CoarseCorrection`] for P, D and T.
pub(super) struct Preconditioner {
    sparse: SparseInverse,
    coarse: CoarseCorrection,
    /// The local part (I − T) A r of the residual.
    local: Vec<f32>,
    /// The scales √(c/cᵢ) of the cells, and the scaled residual; none where cells do not differ.
    scaled: Option<(Vec<f32>, Vec<f32>)>,
}

impl Preconditioner {
    pub(super) fn new(operator: &dyn Operator) -> Self {
        Self {
            sparse: sparse_inverse(operator),
            coarse: CoarseCorrection::new(operator),
            local: vec![0.0; operator.grid().cells()],
            scaled: scales(operator).map(|scales| {
                let residual = vec![0.0; scales.len()];
                (scales, residual)
            }),
        }
    }

    /// Adapts to the free cells of `sets`.
    pub(super) fn adapt(&mut self, sets: &Sets) {
        self.sparse.adapt(sets.free(), |cell| sets.is_free(cell));
        self.coarse.adapt(sets);
        self.local.fill(0.0);
    }

    /// Computes the preconditioned residual `z = M r`: fields on the grid that are zero where it is not free.
    pub(super) fn apply(&mut self, sets: &Sets, r: &[f32], z: &mut [f32]) {
        let Some((scales, mut scaled)) = self.scaled.take() else { return self.apply_alike(sets, r, z) };
        scaled.iter_mut().zip(r).zip(&scales).for_each(|((scaled, r), scale)| *scaled = scale * r);
        self.apply_alike(sets, &scaled, z);
        z.iter_mut().zip(&scales).for_each(|(z, scale)| *z *= scale);
        self.scaled = Some((scales, scaled));
    }

    /// As [`Self::apply`] where cells do not differ.
    fn apply_alike(&mut self, sets: &Sets, r: &[f32], z: &mut [f32]) {
        z.fill(0.0);
        self.coarse.split(sets, r, &mut self.local);
        self.sparse.add(sets.free(), &self.local, z);
        self.coarse.join(sets, z);
    }
}

/// The square roots of the mean displacement of a cell by its own pressure over that of each; none where cells do not differ.
fn scales(operator: &dyn Operator) -> Option<Vec<f32>> {
    match operator.self_influence() {
        CellValues::Uniform(_) => None,
        CellValues::Field(own) => {
            let mean = operator.influence(0, 0);
            Some(own.iter().map(|own| (mean / own).sqrt() as f32).collect())
        }
    }
}

/// The sparse inverse of the operator's influence matrix; periodic coefficients count from the far field.
fn sparse_inverse(operator: &dyn Operator) -> SparseInverse {
    let shape = operator.grid().shape;
    let periodic = operator.boundary().leaves_mean_free();
    let far = if periodic { operator.influence(shape[0] / 2, shape[1] / 2) } else { 0.0 };
    SparseInverse::new(shape, |i, j| operator.influence(i, j) - far)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Field, Grid};
    use crate::math::Cholesky;
    use crate::operator::{DirectSum, PeriodicFft};

    /// The sets with `free` cells on a grid of `shape`.
    fn sets(shape: [usize; 2], free: impl Fn(usize) -> bool) -> Sets {
        let mut sets = Sets::new(shape);
        sets.free_where((0..shape[0] * shape[1]).map(free));
        sets
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
            // A ring of free cells and a few scattered ones.
            let sets = sets(grid.shape, |k| (k * 7 + k / grid.shape[1] * 3) % 11 < 5);
            let mut preconditioner = Preconditioner::new(operator.as_ref());
            preconditioner.adapt(&sets);
            let columns: Vec<Vec<f32>> = sets
                .free()
                .map(|cell| {
                    let (mut unit, mut z) = (vec![0.0; grid.cells()], vec![0.0; grid.cells()]);
                    unit[cell] = 1.0;
                    preconditioner.apply(&sets, &unit, &mut z);
                    assert!((0..grid.cells()).all(|cell| sets.is_free(cell) || z[cell] == 0.0));
                    sets.free().map(|cell| z[cell]).collect()
                })
                .collect();
            let n = columns.len();
            let matrix = Field::from_shape_fn([n, n], |(i, j)| f64::from(columns[j][i]));
            let asymmetry = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
            let asymmetry =
                asymmetry.fold(0.0f64, |m, (i, j)| m.max((matrix[[i, j]] - matrix[[j, i]]).abs()));
            assert!(asymmetry < 1e-6, "asymmetry {asymmetry:e}");
            assert!(
                Cholesky::new(matrix - Field::eye(n) * 1e-5).is_some(),
                "an eigenvalue is not above 1e-5"
            );
        }
    }

    #[test]
    fn the_sparse_inverse_is_exact_where_the_free_cells_are_isolated_pairs() {
        let grid = Grid::new([1, 2], [1.0, 1.0]).unwrap();
        let operator = DirectSum::new(grid, 1.0);
        let sets = sets(grid.shape, |_| true);
        let mut sparse = sparse_inverse(&operator);
        sparse.adapt(sets.free(), |cell| sets.is_free(cell));
        let (c, d) = (operator.influence(0, 0), operator.influence(0, 1));
        let mut z = [0.0; 2];
        sparse.add(sets.free(), &[1.0, 0.0], &mut z);
        let determinant = c * c - d * d;
        let error = [f64::from(z[0]) - c / determinant, f64::from(z[1]) + d / determinant];
        assert!(error.iter().all(|e| e.abs() < 1e-6), "{error:?}");
    }
}

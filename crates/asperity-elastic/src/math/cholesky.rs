//! Factorisation of a dense symmetric positive definite matrix.

use ndarray::linalg::general_mat_mul;
use ndarray::{Array2, ArrayView2, ArrayViewMut2, Axis, s};

/// Columns of a block. Larger blocks read the columns to their left less often.
const BLOCK: usize = 128;

/// Columns that are factorised row by row, too few for a product of matrices.
const LEAF: usize = 8;

/// A = L Lᵀ.
pub struct Cholesky {
    /// L; the values of A remain above its diagonal.
    lower: Array2<f64>,
}

impl Cholesky {
    /// Factorises A in place, block column by block column from the left (Golub and Van Loan, Matrix
    /// Computations, §4.2). Only the lower triangle of A is read. Returns `None` if A is not positive
    /// definite to round-off.
    ///
    /// # Panics
    /// If A is not square.
    pub fn new(mut matrix: Array2<f64>) -> Option<Self> {
        assert!(matrix.is_square(), "{:?} is not square", matrix.dim());
        for first in (0..matrix.nrows()).step_by(BLOCK) {
            let size = BLOCK.min(matrix.nrows() - first);
            let below = matrix.slice_mut(s![first.., ..first + size]);
            let (done, mut column) = below.split_at(Axis(1), first);
            general_mat_mul(-1.0, &done, &done.slice(s![..size, ..]).t(), 1.0, &mut column);
            factorise(column)?;
        }
        Some(Self { lower: matrix })
    }

    /// Computes A⁻¹ b.
    ///
    /// # Panics
    /// If the length of b differs from the size of A.
    pub fn solve(&self, right: &[f64]) -> Vec<f64> {
        assert_eq!(right.len(), self.lower.nrows(), "of another size than the matrix");
        let mut x = right.to_vec();
        for (i, row) in self.lower.rows().into_iter().enumerate() {
            let row = row.to_slice().expect("rows are contiguous");
            x[i] = (x[i] - dot(&row[..i], &x[..i])) / row[i];
        }
        for (i, row) in self.lower.rows().into_iter().enumerate().rev() {
            x[i] /= row[i];
            let known = x[i];
            x[..i].iter_mut().zip(row).for_each(|(x, l)| *x -= l * known);
        }
        x
    }
}

/// Factorises a block column from its diagonal down: its left half, then its right half after subtraction of
/// the left.
fn factorise(mut column: ArrayViewMut2<f64>) -> Option<()> {
    let size = column.ncols();
    if size <= LEAF {
        let (mut diagonal, rest) = column.split_at(Axis(0), size);
        factorise_rows(&mut diagonal)?;
        divide(rest, diagonal.view());
        return Some(());
    }
    let half = size / 2;
    factorise(column.slice_mut(s![.., ..half]))?;
    let below = column.slice_mut(s![half.., ..]);
    let (done, mut right) = below.split_at(Axis(1), half);
    general_mat_mul(-1.0, &done, &done.slice(s![..size - half, ..]).t(), 1.0, &mut right);
    factorise(right)
}

/// Factorises a square block, row after row.
fn factorise_rows(block: &mut ArrayViewMut2<f64>) -> Option<()> {
    for i in 0..block.nrows() {
        let (above, mut rest) = block.view_mut().split_at(Axis(0), i);
        let mut row = rest.row_mut(0);
        let row = row.as_slice_mut().expect("rows are contiguous");
        divide_row(&mut row[..i], above.view());
        let square = row[i] - dot(&row[..i], &row[..i]);
        if square.is_nan() || square <= 0.0 {
            return None;
        }
        row[i] = square.sqrt();
    }
    Some(())
}

/// Computes `rows` L⁻ᵀ in place.
fn divide(mut rows: ArrayViewMut2<f64>, lower: ArrayView2<f64>) {
    for mut row in rows.rows_mut() {
        divide_row(row.as_slice_mut().expect("rows are contiguous"), lower);
    }
}

fn divide_row(row: &mut [f64], lower: ArrayView2<f64>) {
    for (j, l) in lower.rows().into_iter().enumerate() {
        let l = l.to_slice().expect("rows are contiguous");
        row[j] = (row[j] - dot(&row[..j], &l[..j])) / l[j];
    }
}

/// Computes eight sums at a time, which fit into registers.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (eights, rest) = a.as_chunks::<8>();
    let (other_eights, other_rest) = b.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (a, b) in eights.iter().zip(other_eights) {
        for k in 0..8 {
            sums[k] += a[k] * b[k];
        }
    }
    let rest: f64 = rest.iter().zip(other_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// Creates B Bᵀ + `shift`, whose smallest eigenvalue is at least `shift`.
    fn random(n: usize, shift: f64, seed: u64) -> Array2<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let b = Array2::from_shape_simple_fn([n, n], || random.random_range(-1.0..1.0));
        b.dot(&b.t()) + Array2::<f64>::eye(n) * shift
    }

    fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
        values.into_iter().fold(0.0, |m, x| m.max(x.abs()))
    }

    #[test]
    fn the_factors_multiply_to_the_matrix_at_every_size_about_a_block() {
        for n in [0, 1, 2, 7, 8, 9, BLOCK - 1, BLOCK, BLOCK + 1, 2 * BLOCK, 3 * BLOCK + 17] {
            let matrix = random(n, 0.1, n as u64);
            let lower = Cholesky::new(matrix.clone()).unwrap().lower;
            let lower = Array2::from_shape_fn([n, n], |(i, j)| if j > i { 0.0 } else { lower[[i, j]] });
            let error = largest(lower.dot(&lower.t()) - &matrix);
            assert!(error <= 1e-14 * largest(matrix), "{n}: {error:e}");
        }
    }

    #[test]
    fn a_solution_satisfies_its_equations() {
        let mut numbers = ChaCha8Rng::seed_from_u64(3);
        for n in [1, 5, BLOCK, 200] {
            let matrix = random(n, 1.0, 7);
            let x: Vec<f64> = (0..n).map(|_| numbers.random_range(-1.0..1.0)).collect();
            let right = matrix.dot(&ndarray::aview1(&x));
            let solved = Cholesky::new(matrix).unwrap().solve(right.as_slice().unwrap());
            let error = largest(x.iter().zip(&solved).map(|(x, y)| x - y));
            assert!(error < 1e-11, "{n}: {error:e}");
        }
    }

    #[test]
    fn only_the_lower_triangle_is_read() {
        let matrix = random(100, 0.5, 1);
        let right = vec![1.0; 100];
        let expected = Cholesky::new(matrix.clone()).unwrap().solve(&right);
        let half = Array2::from_shape_fn([100, 100], |(i, j)| if j > i { f64::NAN } else { matrix[[i, j]] });
        assert_eq!(Cholesky::new(half).unwrap().solve(&right), expected);
    }

    #[test]
    fn what_is_not_positive_definite_has_no_factors() {
        for at in [0, BLOCK - 1, BLOCK, 150] {
            let mut matrix = random(151, 0.0, 2);
            matrix[[at, at]] = -1e-3;
            assert!(Cholesky::new(matrix).is_none(), "{at}");
        }
        assert!(Cholesky::new(Array2::from_elem([2, 2], 1.0)).is_none(), "singular");
        assert!(Cholesky::new(Array2::from_elem([1, 1], f64::NAN)).is_none());
    }
}

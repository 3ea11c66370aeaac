//! The generalised method of minimal residuals.

use asperity_transforms::Precision;
use asperity_transforms::num_traits::FromPrimitive;

use crate::math::sum::sums;
use crate::math::{Bands, parallel};

/// Result of [`gmres`].
pub struct Gmres<T> {
    /// The solution x.
    pub solution: Vec<T>,
    /// Number of products `A v`.
    pub products: usize,
    /// Whether an even number of the real Ritz values is below 0. False if A has one negative eigenvalue, and
    /// the products suffice to show it.
    pub(crate) is_positive: bool,
}

/// Computes an approximate solution x of A x = b with the smallest residual in a Krylov space, for any matrix
/// A with the product `A v`. It stops when the residual is the fraction `reduction` of b, or after
/// `max_products` products. In single precision it reduces the residual to about 10⁻⁶ of b.
///
/// Saad and Schultz, SIAM J. Sci. Stat. Comput. 7, 856 (1986).
pub fn gmres<T: Precision + Into<f64>>(
    mut product: impl FnMut(&[T]) -> Vec<T>,
    right: Vec<T>,
    reduction: f64,
    max_products: usize,
) -> Gmres<T> {
    let size = norm(&right);
    if size == 0.0 {
        return Gmres { solution: right, products: 0, is_positive: true };
    }
    let mut is_positive = true;
    let mut basis = vec![times(1.0 / size, right)];
    // The Hessenberg matrix, rotated to an upper triangle, column by column, and the rotated right-hand side.
    let (mut triangle, mut rotations): (Vec<Vec<f64>>, Vec<[f64; 2]>) = (Vec::new(), Vec::new());
    let mut turned = vec![size];
    while triangle.len() < max_products && turned[triangle.len()].abs() > reduction * size {
        let mut next = product(&basis[triangle.len()]);
        let mut column = vec![dot(&basis[0], &next)];
        for pair in basis.windows(2) {
            let along = column[column.len() - 1];
            column.push(subtract(&mut next, along, &pair[0], Some(&pair[1])));
        }
        let last = column.len() - 1;
        let left = subtract(&mut next, column[last], &basis[last], None).sqrt();
        for (n, [c, s]) in rotations.iter().enumerate() {
            let (upper, lower) = (column[n], column[n + 1]);
            (column[n], column[n + 1]) = (c * upper + s * lower, c * lower - s * upper);
        }
        let rest = column[last];
        let length = rest.hypot(left);
        if !(length > 0.0 && length.is_finite()) {
            break;
        }
        // The determinant of the square Hessenberg matrix has the sign of this entry.
        is_positive = rest >= 0.0;
        let [c, s] = [rest / length, left / length];
        column[last] = length;
        turned.push(-s * turned[last]);
        turned[last] *= c;
        rotations.push([c, s]);
        triangle.push(column);
        if left == 0.0 {
            break;
        }
        basis.push(times(1.0 / left, next));
    }
    let products = triangle.len();
    for n in (0..products).rev() {
        let known: f64 = (n + 1..products).map(|m| triangle[m][n] * turned[m]).sum();
        turned[n] = (turned[n] - known) / triangle[n][n];
    }
    let weights: Vec<T> = turned[..products].iter().copied().map(number).collect();
    let mut solution = vec![T::zero(); basis[0].len()];
    let bands = Bands::new([solution.len(), 1]);
    parallel::map(bands.cut_mut(&mut solution).enumerate(), |(band, solution)| {
        for (v, y) in basis.iter().zip(&weights) {
            let v = &v[bands.first(band)..];
            solution.iter_mut().zip(v).for_each(|(x, v)| *x = *x + *y * *v);
        }
    });
    Gmres { solution, products, is_positive }
}

/// Subtracts a multiple of the vector `v` from the vector `next`. Returns the scalar product of the result
/// with another vector, or with itself.
fn subtract<T: Precision + Into<f64>>(next: &mut [T], multiple: f64, v: &[T], other: Option<&[T]>) -> f64 {
    let multiple = number::<T>(multiple);
    let bands = Bands::new([next.len(), 1]);
    let parts = bands.cut_mut(next).zip(bands.cut(v)).enumerate();
    let sums = parallel::map(parts, |(band, (next, v))| {
        next.iter_mut().zip(v).for_each(|(next, v)| *next = *next - multiple * *v);
        let first = bands.first(band);
        match other {
            Some(other) => dot_in_band(next, &other[first..first + next.len()]),
            None => dot_in_band(next, next),
        }
    });
    sums.iter().sum()
}

/// Returns the scalar product of two vectors.
fn dot<T: Precision + Into<f64>>(a: &[T], b: &[T]) -> f64 {
    let bands = Bands::new([a.len(), 1]);
    parallel::map(bands.cut(a).zip(bands.cut(b)), |(a, b)| dot_in_band(a, b)).iter().sum()
}

fn dot_in_band<T: Copy + Into<f64>>(a: &[T], b: &[T]) -> f64 {
    let [sum] = sums(a, |k, a| [a.into() * b[k].into()]);
    sum
}

fn norm<T: Precision + Into<f64>>(a: &[T]) -> f64 {
    dot(a, a).sqrt()
}

fn times<T: Precision>(factor: f64, mut a: Vec<T>) -> Vec<T> {
    let factor = number::<T>(factor);
    let bands = Bands::new([a.len(), 1]);
    parallel::map(bands.cut_mut(&mut a), |a| a.iter_mut().for_each(|a| *a = factor * *a));
    a
}

fn number<T: FromPrimitive>(value: f64) -> T {
    T::from_f64(value).expect("a real number")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A nonsymmetric matrix, whose skew part is as large as its symmetric part.
    fn product(v: &[f64]) -> Vec<f64> {
        let n = v.len();
        (0..n)
            .map(|i| {
                let entry = |j: usize| if i == j { 2.0 } else { 1.0 / (i as f64 - j as f64 + 0.5) };
                (0..n).map(|j| entry(j) * v[j]).sum()
            })
            .collect()
    }

    #[test]
    fn it_solves_what_is_not_symmetric_to_the_residual_asked_for() {
        let b: Vec<f64> = (0..40).map(|k| (1.3 * f64::from(k)).sin()).collect();
        for reduction in [1e-1, 1e-4, 1e-12] {
            let Gmres { solution: x, products, is_positive } = gmres(product, b.clone(), reduction, 40);
            let left: Vec<f64> = product(&x).iter().zip(&b).map(|(a, b)| b - a).collect();
            assert!(norm(&left) < 1.001 * reduction * norm(&b) + 1e-14, "{:e} of {reduction:e}", norm(&left));
            assert!(products <= 40 && is_positive);
        }
    }

    #[test]
    fn single_precision_is_enough_for_a_residual_of_a_millionth() {
        let b: Vec<f32> = (0..40).map(|k| (1.3 * k as f32).sin()).collect();
        let product = |v: &[f32]| -> Vec<f32> {
            product(&v.iter().map(|v| f64::from(*v)).collect::<Vec<_>>()).iter().map(|v| *v as f32).collect()
        };
        for reduction in [1e-2, 1e-4, 2e-6] {
            let Gmres { solution: x, products, .. } = gmres(product, b.clone(), reduction, 40);
            let left: Vec<f32> = product(&x).iter().zip(&b).map(|(a, b)| b - a).collect();
            assert!(norm(&left) < 1.1 * reduction * norm(&b), "{:e} of {reduction:e}", norm(&left));
            assert!(products < 40);
        }
    }

    #[test]
    fn it_ends_where_nothing_is_asked_or_all_is_found() {
        let none = gmres(product, vec![0.0; 5], 1e-9, 5);
        assert_eq!((none.solution, none.products), (vec![0.0; 5], 0));
        let Gmres { solution: x, products, .. } =
            gmres(|v| times(2.0, v.to_vec()), vec![3.0f64, -4.0], 1e-9, 2);
        assert!(products == 1 && (x[0] - 1.5).abs() < 1e-15 && (x[1] + 2.0).abs() < 1e-15, "{x:?}");
        let none = gmres(|v| times(0.0, v.to_vec()), vec![3.0f64], 1e-9, 9);
        assert_eq!((none.solution, none.products), (vec![0.0], 0));
    }

    #[test]
    fn it_sees_a_negative_eigenvalue() {
        for first in [0.3, -0.3] {
            let scaled = |v: &[f64]| -> Vec<f64> {
                let entry = |k: usize| if k == 0 { first } else { 1.0 + 0.02 * k as f64 };
                v.iter().enumerate().map(|(k, v)| entry(k) * v).collect()
            };
            let found = gmres(scaled, vec![1.0; 40], 1e-3, 40);
            assert_eq!(found.is_positive, first > 0.0, "in {} products", found.products);
        }
    }
}

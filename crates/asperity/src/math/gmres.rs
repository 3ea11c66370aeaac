//! The generalised method of minimal residuals.

/// Result of [`gmres`].
pub(crate) struct Gmres {
    pub(crate) solution: Vec<f64>,
    pub(crate) products: usize,
    /// Whether an even number of the real Ritz values is below 0. False if A has one negative eigenvalue, and the products suffice to
    /// show it.
    pub(crate) is_positive: bool,
}

/// Computes an approximate solution x of A x = b with the smallest residual in a Krylov space, for any matrix A with
/// the product `A v`. It stops when the residual is the fraction `reduction` of b, or after `max_products` products.
///
/// Saad and Schultz, SIAM J. Sci. Stat. Comput. 7, 856 (1986).
pub(crate) fn gmres(
    mut product: impl FnMut(&[f64]) -> Vec<f64>,
    right: Vec<f64>,
    reduction: f64,
    max_products: usize,
) -> Gmres {
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
        let mut column: Vec<f64> = basis
            .iter()
            .map(|v| {
                let along = dot(v, &next);
                next.iter_mut().zip(v).for_each(|(next, v)| *next -= along * v);
                along
            })
            .collect();
        for (n, [c, s]) in rotations.iter().enumerate() {
            let (upper, lower) = (column[n], column[n + 1]);
            (column[n], column[n + 1]) = (c * upper + s * lower, c * lower - s * upper);
        }
        let last = column.len() - 1;
        let (left, rest) = (norm(&next), column[last]);
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
    let mut solution = vec![0.0; basis[0].len()];
    for (v, y) in basis.iter().zip(&turned[..products]) {
        solution.iter_mut().zip(v).for_each(|(x, v)| *x += y * v);
    }
    Gmres { solution, products, is_positive }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

fn times(factor: f64, mut a: Vec<f64>) -> Vec<f64> {
    a.iter_mut().for_each(|a| *a *= factor);
    a
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
    fn it_ends_where_nothing_is_asked_or_all_is_found() {
        let none = gmres(product, vec![0.0; 5], 1e-9, 5);
        assert_eq!((none.solution, none.products), (vec![0.0; 5], 0));
        let Gmres { solution: x, products, .. } = gmres(|v| times(2.0, v.to_vec()), vec![3.0, -4.0], 1e-9, 2);
        assert!(products == 1 && (x[0] - 1.5).abs() < 1e-15 && (x[1] + 2.0).abs() < 1e-15, "{x:?}");
        let none = gmres(|v| times(0.0, v.to_vec()), vec![3.0], 1e-9, 9);
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

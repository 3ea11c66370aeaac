//! Removal of the mean form.

use serde::{Deserialize, Serialize};

use crate::grid::Grid;
use crate::surface::Topography;

/// What is subtracted from the heights: the least-squares fit of a polynomial in x and y to the defined
/// samples.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Level {
    /// Nothing.
    #[default]
    None,
    /// The mean height.
    Mean,
    /// A plane: 1, x, y.
    Plane,
    /// A full polynomial of the second order: 1, x, y, x², xy, y².
    Quadratic,
}

impl Level {
    /// Number of monomials in the fit.
    fn terms(self) -> usize {
        match self {
            Self::None => 0,
            Self::Mean => 1,
            Self::Plane => 3,
            Self::Quadratic => 6,
        }
    }
}

/// Number of monomials up to the second order.
const TERMS: usize = 6;

impl Topography {
    /// Levelled: the least-squares fit that `level` names is subtracted. Undefined samples stay so.
    ///
    /// A term that the samples do not determine (x on a single column, say) is left out of the fit.
    pub fn level(mut self, level: Level) -> Self {
        let terms = level.terms();
        if terms == 0 || self.defined() == 0 {
            return self;
        }
        // Once the mean is gone, a small roughness on a large height loses no digits in the sums below.
        let mean = self.mean();
        self.heights_mut().mapv_inplace(|z| z - mean);
        let fit = self.fit(terms);
        let grid = *self.grid();
        for ((ix, iy), z) in self.heights_mut().indexed_iter_mut() {
            *z -= dot(&fit, &monomials(&grid, ix, iy));
        }
        self
    }

    /// Coefficients of the first `terms` monomials in the least-squares fit, by the normal equations.
    fn fit(&self, terms: usize) -> [f64; TERMS] {
        let mut matrix = [[0.0; TERMS]; TERMS];
        let mut right = [0.0; TERMS];
        for ((ix, iy), z) in self.heights().indexed_iter().filter(|(_, z)| !z.is_nan()) {
            let basis = monomials(self.grid(), ix, iy);
            for row in 0..terms {
                right[row] += basis[row] * z;
                for column in 0..=row {
                    matrix[row][column] += basis[row] * basis[column];
                }
            }
        }
        solve(matrix, right, terms)
    }
}

/// 1, ξ, η, ξ², ξη, η² with ξ, η from −1 to 1 over the grid, so that the normal equations are well
/// conditioned.
fn monomials(grid: &Grid, ix: usize, iy: usize) -> [f64; TERMS] {
    let scaled = |axis: usize, index: usize| (2.0 * index as f64 + 1.0) / grid.shape[axis] as f64 - 1.0;
    let (x, y) = (scaled(0, ix), scaled(1, iy));
    [1.0, x, y, x * x, x * y, y * y]
}

fn dot(a: &[f64; TERMS], b: &[f64; TERMS]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Solution of a positive semi-definite system by L D Lᵀ (lower triangle of `matrix` given); an unknown whose
/// pivot vanishes is 0.
fn solve(mut matrix: [[f64; TERMS]; TERMS], mut x: [f64; TERMS], n: usize) -> [f64; TERMS] {
    let mut pivot = [0.0; TERMS];
    for j in 0..n {
        let left: f64 = matrix[j][j] - (0..j).map(|k| matrix[j][k].powi(2) * pivot[k]).sum::<f64>();
        pivot[j] = if left > 1e-12 * matrix[j][j] { left } else { 0.0 };
        for i in j + 1..n {
            let left = matrix[i][j] - (0..j).map(|k| matrix[i][k] * matrix[j][k] * pivot[k]).sum::<f64>();
            matrix[i][j] = if pivot[j] > 0.0 { left / pivot[j] } else { 0.0 };
        }
    }
    for i in 0..n {
        x[i] -= (0..i).map(|k| matrix[i][k] * x[k]).sum::<f64>();
    }
    for i in (0..n).rev() {
        let above: f64 = (i + 1..n).map(|k| matrix[k][i] * x[k]).sum();
        x[i] = if pivot[i] > 0.0 { x[i] / pivot[i] - above } else { 0.0 };
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Field;

    fn with_heights(height: impl Fn(f64, f64) -> f64) -> Topography {
        let grid = Grid::new([40, 25], [1e-6, 3e-6]).unwrap();
        let heights = Field::from_shape_fn(grid.shape, |(i, j)| {
            height(grid.centre(0, i) * 1e6, grid.centre(1, j) * 1e6)
        });
        Topography::new(grid, heights).unwrap()
    }

    fn largest(topography: &Topography) -> f64 {
        topography.heights().iter().filter(|z| !z.is_nan()).fold(0.0, |m, z| z.abs().max(m))
    }

    #[test]
    fn a_polynomial_is_removed_to_round_off_by_the_level_of_its_order() {
        let constant = with_heights(|_, _| 3.0);
        assert!(largest(&constant.level(Level::Mean)) < 1e-15);
        let plane = with_heights(|x, y| 3.0 + 0.2 * x - 0.1 * y);
        assert!(largest(&plane.clone().level(Level::Mean)) > 1.0);
        assert!(largest(&plane.level(Level::Plane)) < 1e-13);
        let quadratic = with_heights(|x, y| 3.0 + 0.2 * x - 0.1 * y + 0.01 * (x * x - x * y + 2.0 * y * y));
        assert!(largest(&quadratic.clone().level(Level::Plane)) > 1.0);
        assert!(largest(&quadratic.level(Level::Quadratic)) < 1e-12);
    }

    #[test]
    fn holes_do_not_tilt_the_fit() {
        let mut plane = with_heights(|x, y| 3.0 + 0.2 * x - 0.1 * y);
        (5..20).for_each(|i| (2..9).for_each(|j| plane.heights_mut()[[i, j]] = f64::NAN));
        let levelled = plane.level(Level::Quadratic);
        assert_eq!(levelled.undefined(), 15 * 7);
        assert!(largest(&levelled) < 1e-12);
    }

    #[test]
    fn what_is_left_is_orthogonal_to_what_was_removed() {
        let rough = with_heights(|x, y| (3.0 * x).sin() * (2.0 * y).cos() + 0.3 * x);
        let left = rough.level(Level::Quadratic);
        for term in 0..TERMS {
            let product: f64 =
                left.heights().indexed_iter().map(|((i, j), z)| z * monomials(left.grid(), i, j)[term]).sum();
            assert!(product.abs() < 1e-11, "term {term}: {product:e}");
        }
    }

    #[test]
    fn a_nanometre_on_a_millimetre_keeps_its_digits() {
        let ripple = |x: f64, y: f64| 1e-9 * (x * 0.7).sin() * (y * 0.3).cos();
        let low = with_heights(ripple).level(Level::Plane);
        let high = with_heights(|x, y| 1e-3 + 1e-5 * x + ripple(x, y)).level(Level::Plane);
        let difference = (low.heights() - high.heights()).iter().fold(0.0, |m: f64, d| d.abs().max(m));
        assert!(difference < 1e-18 * 1e3, "{difference:e}");
    }

    #[test]
    fn what_the_samples_do_not_determine_is_left_alone() {
        let grid = Grid::new([1, 5], [1.0, 1.0]).unwrap();
        let heights = Field::from_shape_fn([1, 5], |(_, j)| 1.0 + 2.0 * j as f64);
        let levelled = Topography::new(grid, heights).unwrap().level(Level::Quadratic);
        assert!(largest(&levelled) < 1e-14);
        let nothing = Topography::new(grid, Field::from_elem([1, 5], f64::NAN)).unwrap();
        assert_eq!(nothing.level(Level::Plane).undefined(), 5);
    }
}

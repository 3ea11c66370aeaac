//! Normal equations of a linear least-squares fit.

/// JᵀJ of a fit with its factors L D Lᵀ. An unknown that depends on the others is left out of the fit.
pub(super) struct NormalEquations {
    lower: Vec<Vec<f64>>,
    pivots: Vec<f64>,
}

/// Fraction of a diagonal entry below which its pivot is round-off.
const VANISHED: f64 = 1e-12;

impl NormalEquations {
    /// Creates the equations from the lower triangle of JᵀJ, row by row, which is positive semi-definite.
    pub(super) fn new(mut lower: Vec<Vec<f64>>) -> Self {
        let n = lower.len();
        let mut pivots = vec![0.0; n];
        for j in 0..n {
            let left = lower[j][j] - (0..j).map(|k| lower[j][k].powi(2) * pivots[k]).sum::<f64>();
            pivots[j] = if left > VANISHED * lower[j][j] { left } else { 0.0 };
            for i in j + 1..n {
                let left = lower[i][j] - (0..j).map(|k| lower[i][k] * lower[j][k] * pivots[k]).sum::<f64>();
                lower[i][j] = if pivots[j] > 0.0 { left / pivots[j] } else { 0.0 };
            }
        }
        Self { lower, pivots }
    }

    /// Returns the coefficients for the right side Jᵀz; 0 for an unknown that is left out.
    pub(super) fn solve(&self, mut x: Vec<f64>) -> Vec<f64> {
        let n = x.len();
        for i in 0..n {
            x[i] -= (0..i).map(|k| self.lower[i][k] * x[k]).sum::<f64>();
        }
        for i in (0..n).rev() {
            let above: f64 = (i + 1..n).map(|k| self.lower[k][i] * x[k]).sum();
            x[i] = if self.pivots[i] > 0.0 { x[i] / self.pivots[i] - above } else { 0.0 };
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_that_others_determine_is_left_out_and_the_rest_is_exact() {
        // Columns (1, 1, 1), (0, 1, 2), and their sum.
        let normal = || vec![vec![3.0], vec![3.0, 5.0], vec![6.0, 8.0, 14.0]];
        let x = NormalEquations::new(normal()).solve(vec![9.0, 13.0, 22.0]); // of (1, 3, 5) = 1 + 2 x
        assert!(x.iter().zip([1.0, 2.0, 0.0]).all(|(x, exact)| (x - exact).abs() < 1e-14), "{x:?}");
    }
}

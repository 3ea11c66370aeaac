//! Anderson acceleration of a fixed-point iteration.

use std::collections::VecDeque;

use crate::math::sum::sums;

/// Number of stored differences.
const DIFFERENCES: usize = 5;
/// A difference that depends on the others to this relative accuracy is ignored.
const NEGLIGIBLE: f64 = 1e-10;

/// History of a fixed-point iteration y ↦ y + f(y).
///
/// The next y is y + f − Σ γ (Δy + Δf). The γ minimise the mean square of f − Σ γ Δf over the entries that
/// count. Anderson, J. ACM 12, 547 (1965).
#[derive(Debug, Default)]
pub(super) struct Anderson {
    last: Option<(Vec<f64>, Vec<f64>)>,
    /// Differences of y and of f, latest first.
    differences: VecDeque<(Vec<f64>, Vec<f64>)>,
}

impl Anderson {
    /// Returns the next y after `y` with the residual `f`. The mean square is over the entries in `counts`.
    pub(super) fn next(&mut self, y: Vec<f64>, f: Vec<f64>, counts: &[usize]) -> Vec<f64> {
        if let Some((last_y, last_f)) = self.last.take() {
            let minus = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect();
            self.differences.push_front((minus(&y, &last_y), minus(&f, &last_f)));
            self.differences.truncate(DIFFERENCES);
        }
        let mut next: Vec<f64> = y.iter().zip(&f).map(|(y, f)| y + f).collect();
        for (gamma, (dy, df)) in self.least(&f, counts).into_iter().zip(&self.differences) {
            next.iter_mut().zip(dy).zip(df).for_each(|((next, dy), df)| *next -= gamma * (dy + df));
        }
        self.last = Some((y, f));
        next
    }

    /// The last y and its residual.
    pub(super) fn last(&self) -> Option<(&[f64], &[f64])> {
        self.last.as_ref().map(|(y, f)| (y.as_slice(), f.as_slice()))
    }

    /// Clears all but the last y.
    pub(super) fn begin_again(&mut self) {
        self.differences.clear();
    }

    /// Computes the weights γ of the differences through an orthogonal basis.
    fn least(&self, f: &[f64], counts: &[usize]) -> Vec<f64> {
        let of = |values: &[f64]| -> Vec<f64> { counts.iter().map(|&entry| values[entry]).collect() };
        let mut left = of(f);
        // Orthonormal vectors, each with its combination of differences.
        let mut basis: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
        let mut gamma = vec![0.0; self.differences.len()];
        for (n, (_, df)) in self.differences.iter().enumerate() {
            let mut vector = of(df);
            let mut combination = vec![0.0; self.differences.len()];
            combination[n] = 1.0;
            let whole = dot(&vector, &vector);
            // Twice, to remove round-off.
            for _ in 0..2 {
                for (other, its) in &basis {
                    let share = dot(&vector, other);
                    take(&mut vector, share, other);
                    take(&mut combination, share, its);
                }
            }
            let rest = dot(&vector, &vector);
            if rest.is_nan() || rest <= NEGLIGIBLE * NEGLIGIBLE * whole {
                continue;
            }
            let scale = 1.0 / rest.sqrt();
            vector.iter_mut().chain(&mut combination).for_each(|value| *value *= scale);
            let share = dot(&left, &vector);
            take(&mut left, share, &vector);
            take(&mut gamma, -share, &combination);
            basis.push((vector, combination));
        }
        gamma
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    let [sum] = sums(a, |n, a| [a * b[n]]);
    sum
}

fn take(from: &mut [f64], share: f64, what: &[f64]) {
    from.iter_mut().zip(what).for_each(|(from, what)| *from -= share * what);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// y ↦ y + f(y) with f = b − A y, for a matrix whose plain iteration does not converge.
    fn f(y: &[f64]) -> Vec<f64> {
        let a = [[2.5, 0.3, 0.0, 0.1], [0.3, 0.7, -0.2, 0.0], [0.0, -0.2, 1.9, 0.4], [0.1, 0.0, 0.4, 0.2]];
        (0..4).map(|i| 1.0 + i as f64 - (0..4).map(|j| a[i][j] * y[j]).sum::<f64>()).collect()
    }

    #[test]
    fn a_linear_map_of_four_is_solved_in_five_steps() {
        let mut anderson = Anderson::default();
        let mut y = vec![0.0; 4];
        for _ in 0..5 {
            let wrong = f(&y);
            y = anderson.next(y, wrong, &[0, 1, 2, 3]);
        }
        let wrong = f(&y);
        assert!(wrong.iter().all(|f| f.abs() < 1e-10), "{wrong:?}");
    }

    #[test]
    fn without_differences_a_step_is_plain_and_the_same_step_twice_teaches_nothing() {
        let mut anderson = Anderson::default();
        let y = vec![1.0, 2.0, 3.0, 4.0];
        let plain: Vec<f64> = y.iter().zip(f(&y)).map(|(y, f)| y + f).collect();
        assert_eq!(anderson.next(y.clone(), f(&y), &[0, 1, 2, 3]), plain);
        assert_eq!(anderson.next(y.clone(), f(&y), &[0, 1, 2, 3]), plain);
        assert_eq!(anderson.next(y.clone(), f(&y), &[]), plain);
    }
}

//! Thermal memory of a half-space as a sum of exponentials.

use crate::grid::Field;
use crate::math::Cholesky;

/// Returns rates s and weights w with 1/√(πτ) ≈ Σ w e^(−sτ) for 1 ≤ τ ≤ `last`, accurate to 2e-4; τ and 1/s
/// are in steps.
///
/// There are 4 + ⌈ln `last`⌉ rates (11 for 1000 steps), in geometric sequence from 0.3/`last` to 4. The
/// weights minimise the mean square of the relative error over ln τ.
pub(super) fn exponentials(last: f64) -> Vec<(f64, f64)> {
    let last = last.max(SHORTEST);
    let terms = 4 + last.ln().ceil() as usize;
    let (slowest, fastest) = (0.3 / last, 4.0f64);
    let rate = |m: usize| slowest * (fastest / slowest).powf(m as f64 / (terms - 1) as f64);
    let share = |tau: f64, m: usize| (-rate(m) * tau).exp() * (std::f64::consts::PI * tau).sqrt();
    let times: Vec<f64> = (0..SAMPLES).map(|k| last.powf(k as f64 / (SAMPLES - 1) as f64)).collect();
    let normal =
        Field::from_shape_fn([terms; 2], |(m, n)| times.iter().map(|&t| share(t, m) * share(t, n)).sum());
    let right: Vec<f64> = (0..terms).map(|m| times.iter().map(|&t| share(t, m)).sum()).collect();
    let weights = Cholesky::new(normal).expect("rates that differ").solve(&right);
    (0..terms).map(rate).zip(weights).collect()
}

/// Largest rate, for the shortest memory approximated.
const SHORTEST: f64 = 4.0;
/// Number of times at which the sum is fitted.
const SAMPLES: usize = 400;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_right_to_2e_4_over_any_number_of_steps() {
        for last in [1.0, 2.0, 5.0, 17.0, 127.0, 1000.0, 30_000.0, 1e6] {
            let terms = exponentials(last);
            let error = (0..3000).map(|k| last.powf(f64::from(k) / 2999.0)).fold(0.0f64, |worst, tau| {
                let sum: f64 = terms.iter().map(|(s, w)| w * (-s * tau).exp()).sum();
                worst.max((sum * (std::f64::consts::PI * tau).sqrt() - 1.0).abs())
            });
            assert!(error < 2e-4, "{last}: {} terms, error {error:e}", terms.len());
        }
        assert_eq!(exponentials(1000.0).len(), 11);
    }
}

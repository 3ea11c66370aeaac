//! Integrals of smooth functions times an exponential over panels.

use crate::math::gauss_legendre;
use crate::units::Metre;

/// Number of points of a panel.
const POINTS: usize = 16;
/// Number of points of an interval on which the weights are integrated.
const FINE: usize = 20;
/// Length of the first interval of the weights, in lengths of the exponential's decay.
const FIRST: f64 = 0.5;
/// Reach of an exponential, in lengths of its decay: further away nothing of it is left.
pub(super) const REACH: f64 = 45.0;

/// An interval 0 ≤ begin < end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Panel {
    pub(super) begin: Metre,
    pub(super) end: Metre,
}

/// Returns the points t of a panel, each with the weights of the values there in `(1/λ) ∫ e^(−t/λ) f(t) dt`
/// for each of the `decays`, whose second number is λ. They are exact for polynomials, whatever λ.
pub(super) fn lagrange_weights(panel: Panel, decays: &[[f64; 2]]) -> Vec<(Metre, Vec<f64>)> {
    let Panel { begin, end } = panel;
    let half = 0.5 * (end - begin);
    let points: Vec<f64> = gauss_legendre(POINTS).iter().map(|(x, _)| *x).collect();
    let fine = gauss_legendre(FINE);
    // Barycentric weights of Lagrange's polynomials.
    let barycentric: Vec<f64> = points
        .iter()
        .map(|x| 1.0 / points.iter().filter(|y| *y != x).map(|y| 2.0 * (x - y)).product::<f64>())
        .collect();
    let mut found: Vec<(Metre, Vec<f64>)> =
        points.iter().map(|x| (begin + half * (1.0 + x), Vec::with_capacity(decays.len()))).collect();
    for [_, decay] in decays {
        let mut weights = [0.0; POINTS];
        let last = (end - begin).min(REACH * decay);
        let (mut from, mut length) = (0.0, FIRST * decay);
        while from < last {
            let to = (from + length).min(last);
            let (middle, radius) = (0.5 * (from + to), 0.5 * (to - from));
            for (x, weight) in &fine {
                let t = middle + radius * x;
                let share = weight * radius / decay * (-(begin + t) / decay).exp();
                let place = t / half - 1.0;
                let terms: Vec<f64> = points.iter().zip(&barycentric).map(|(y, b)| b / (place - y)).collect();
                match terms.iter().position(|term| !term.is_finite()) {
                    Some(at) => weights[at] += share,
                    None => {
                        let sum: f64 = terms.iter().sum();
                        weights
                            .iter_mut()
                            .zip(&terms)
                            .for_each(|(weight, term)| *weight += share * term / sum);
                    }
                }
            }
            (from, length) = (to, 2.0 * length);
        }
        found.iter_mut().zip(weights).for_each(|((_, of), weight)| of.push(weight));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_integrated_exactly_for_every_decay() {
        let panel = Panel { begin: 0.3, end: 1.1 };
        for decay in [1e-4, 0.01, 0.3, 2.0, 1e5] {
            let weights = lagrange_weights(panel, &[[1.0, decay]]);
            // ∫ e^(−t/λ) dt/λ and ∫ t e^(−t/λ) dt/λ.
            let e = |t: f64| (-t / decay).exp();
            let zeroth = e(0.3) * -(-(1.1 - 0.3) / decay).exp_m1();
            let first = (0.3 + decay) * e(0.3) - (1.1 + decay) * e(1.1);
            let sum = |power: i32| weights.iter().map(|(t, w)| t.powi(power) * w[0]).sum::<f64>();
            assert!((sum(0) - zeroth).abs() <= 1e-13 * zeroth.max(1e-300), "{decay}");
            if decay < 1e3 {
                assert!((sum(1) - first).abs() <= 1e-12 * first.max(1e-300), "{decay}");
            }
        }
    }
}

//! Integrals over an interval.

use std::f64::consts::PI;

/// Computes ∫ f over `lo … hi` by the five-point Gauss–Legendre rule on 64 panels. f is never evaluated at
/// the ends.
pub fn integrate(lo: f64, hi: f64, f: impl Fn(f64) -> f64) -> f64 {
    /// Nodes and weights of one half of the symmetric rule.
    const NODES: [(f64, f64); 3] = [
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
        (0.906_179_845_938_664, 0.236_926_885_056_189_08),
    ];
    /// Panels of equal width.
    const PANELS: usize = 64;
    let half = 0.5 * (hi - lo) / PANELS as f64;
    let sum = |centre: f64| -> f64 {
        let pair = |(x, w): (f64, f64)| w * (f(centre - half * x) + f(centre + half * x));
        NODES[0].1 * f(centre) + pair(NODES[1]) + pair(NODES[2])
    };
    half * (0..PANELS).map(|i| sum(lo + half * (2 * i + 1) as f64)).sum::<f64>()
}

/// Computes nodes and weights of the Gauss–Legendre rule of `n` points on −1 … 1.
pub fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let node = |k: usize| {
        let mut x = (PI * (k as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 1.0;
        // Newton steps on Pₙ from a guess with some correct digits.
        for _ in 0..6 {
            let (mut before, mut value) = (1.0, x);
            for order in 2..=n {
                let l = order as f64;
                (before, value) = (value, ((2.0 * l - 1.0) * x * value - (l - 1.0) * before) / l);
            }
            slope = n as f64 * (before - x * value) / (1.0 - x * x);
            x -= value / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(node).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn n_points_are_exact_for_polynomials_of_order_2n_less_1() {
        for n in [2, 5, 16] {
            for order in 0..2 * n {
                let sum: f64 = gauss_legendre(n).iter().map(|(x, w)| w * x.powi(order as i32)).sum();
                let exact = if order % 2 == 0 { 2.0 / (order + 1) as f64 } else { 0.0 };
                assert!((sum - exact).abs() < 1e-14, "{n}, {order}: {sum}");
            }
        }
    }
}

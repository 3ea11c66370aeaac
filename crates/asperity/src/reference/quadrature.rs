//! Integrals for the tests of this module.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::math::elliptic::CompleteElliptic;
use crate::units::{Metre, Newton, Pascal};

/// ∫ f over `lo … hi` by five-point Gauss–Legendre on 64 panels; never evaluated at the ends.
pub(super) fn integrate(lo: f64, hi: f64, f: impl Fn(f64) -> f64) -> f64 {
    const NODES: [(f64, f64); 3] = [
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
        (0.906_179_845_938_664, 0.236_926_885_056_189_08),
    ];
    const PANELS: usize = 64;
    let half = 0.5 * (hi - lo) / PANELS as f64;
    let sum = |centre: f64| -> f64 {
        let pair = |(x, w): (f64, f64)| w * (f(centre - half * x) + f(centre + half * x));
        NODES[0].1 * f(centre) + pair(NODES[1]) + pair(NODES[2])
    };
    half * (0..PANELS).map(|i| sum(lo + half * (2 * i + 1) as f64)).sum::<f64>()
}

/// ∫ f(s) over `0 … a`, where f may have a logarithm at 0 and a square root, even an inverse one, at a.
pub(super) fn integrate_to_edge(a: Metre, f: impl Fn(f64) -> f64) -> f64 {
    integrate(0.0, 1.0, |t| {
        let (sin, cos) = (FRAC_PI_2 * t.powi(3)).sin_cos();
        f(a * sin) * a * cos * 3.0 * FRAC_PI_2 * t.powi(2)
    })
}

/// Load of an axisymmetric pressure on `r < a`.
pub(super) fn axisymmetric_load(a: Metre, pressure: impl Fn(Metre) -> Pascal) -> Newton {
    integrate_to_edge(a, |s| 2.0 * PI * s * pressure(s))
}

/// Boussinesq's displacement at `r > a` of an axisymmetric pressure on `s < a`.
pub(super) fn axisymmetric_displacement(
    a: Metre,
    modulus: Pascal,
    r: Metre,
    pressure: impl Fn(Metre) -> Pascal,
) -> Metre {
    let ring = |s: f64| 4.0 * s / (r + s) * CompleteElliptic::of_complement((r - s) / (r + s)).first;
    integrate_to_edge(a, |s| pressure(s) * ring(s)) / (PI * modulus)
}

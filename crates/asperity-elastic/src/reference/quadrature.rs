//! Integrals for the tests of this module.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::math::elliptic::CompleteElliptic;
pub(super) use crate::math::integrate;
use crate::units::{Metre, Newton, Pascal};

/// ∫ f(s) over `0 … a`, where f may have a logarithm at 0 and a square root, possibly inverse, at a.
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

/// Boussinesq's displacement at `r > a` under an axisymmetric pressure on `s < a`.
pub(super) fn axisymmetric_displacement(
    a: Metre,
    modulus: Pascal,
    r: Metre,
    pressure: impl Fn(Metre) -> Pascal,
) -> Metre {
    let ring = |s: f64| 4.0 * s / (r + s) * CompleteElliptic::of_complement((r - s) / (r + s)).first;
    integrate_to_edge(a, |s| pressure(s) * ring(s)) / (PI * modulus)
}

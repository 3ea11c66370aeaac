//! Hertz: bodies of two different relative radii.

use std::f64::consts::PI;

use crate::math::elliptic::CompleteElliptic;
use crate::units::{Joule, Metre, Newton, Pascal, SquareMetre};

/// Frictionless contact over an ellipse, h = x²/2Rx + y²/2Ry.
///
/// With the ratio κ of the minor semi-axis to the major one a, the elliptic integrals K and D = (K − E)/(1 −
/// κ²) of k′ = κ, and the larger radius R, which lies along the major axis:
///
/// ```text
/// R/R′ = (K − D)/(κ² D)      R′ the smaller radius; solved for κ to round-off
/// a³ = 3 W R D/(π E*)        δ = 3 W K/(2π a E*)        p₀ = 3 W/(2π κ a²)
/// ```
/// Hertz (1882); Johnson (1985), eqs. 4.25–4.32. Relative accuracy 1e-13 for ratios of the radii up to 1e6.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HertzEllipse {
    /// Normal load W.
    pub load: Newton,
    /// Semi-axes of the contact along x and y.
    pub semi_axes: [Metre; 2],
    /// Rigid-body approach δ.
    pub approach: Metre,
    /// Pressure p₀ at the centre.
    pub peak_pressure: Pascal,
}

impl HertzEllipse {
    /// Creates the contact with relative radii `[Rx, Ry]`, positive and finite, composite modulus E* and load
    /// W > 0.
    pub fn new(radii: [Metre; 2], modulus: Pascal, load: Newton) -> Self {
        let [rx, ry] = radii;
        let (large, small) = if rx >= ry { (rx, ry) } else { (ry, rx) };
        let axis_ratio = axis_ratio(large / small);
        let integrals = CompleteElliptic::of_complement(axis_ratio);
        let major = (3.0 * load * large * integrals.difference / (PI * modulus)).cbrt();
        let minor = axis_ratio * major;
        Self {
            load,
            semi_axes: if rx >= ry { [major, minor] } else { [minor, major] },
            approach: 1.5 * load * integrals.first / (PI * major * modulus),
            peak_pressure: 1.5 * load / (PI * major * minor),
        }
    }

    /// Pressure p₀ √(1 − x²/a² − y²/b²) at `(x, y)` from the centre; 0 outside the contact.
    pub fn pressure(&self, x: Metre, y: Metre) -> Pascal {
        let [a, b] = self.semi_axes;
        let inside = 1.0 - (x / a).powi(2) - (y / b).powi(2);
        if inside > 0.0 { self.peak_pressure * inside.sqrt() } else { 0.0 }
    }

    /// Area π a b of the contact.
    pub fn contact_area(&self) -> SquareMetre {
        PI * self.semi_axes[0] * self.semi_axes[1]
    }

    /// Elastic energy stored in both bodies, ⅖ W δ.
    pub fn elastic_energy(&self) -> Joule {
        0.4 * self.load * self.approach
    }
}

/// Returns the ratio κ ≤ 1 of the semi-axes for the ratio R/R′ ≥ 1 of the radii, by bisection of ln κ between
/// 1/(R/R′) and 1.
fn axis_ratio(radius_ratio: f64) -> f64 {
    let excess = |log_ratio: f64| {
        let axis_ratio = log_ratio.exp();
        let CompleteElliptic { first, difference, .. } = CompleteElliptic::of_complement(axis_ratio);
        (first - difference) / (axis_ratio * axis_ratio * difference) - radius_ratio
    };
    let (mut low, mut high) = (-radius_ratio.ln(), 0.0);
    loop {
        let middle = 0.5 * (low + high);
        if !(low < middle && middle < high) || high - low < 1e-16 {
            return middle.exp();
        }
        if excess(middle) > 0.0 { low = middle } else { high = middle }
    }
}

#[cfg(test)]
mod tests {
    use super::super::HertzSphere;
    use super::super::quadrature::{integrate, integrate_to_edge};
    use super::*;
    use approx::assert_relative_eq;

    const RADII: [[f64; 2]; 5] = [[4.0, 4.0], [4.0, 3.999], [4.0, 0.5], [0.3, 4.0], [1e4, 1.0]];

    /// Displacement at a point of the contact: each chord through it, at angle θ, contributes p₀ π (s² of the
    /// chord)/8.
    fn displacement(contact: &HertzEllipse, modulus: f64, [x, y]: [f64; 2]) -> f64 {
        let [a, b] = contact.semi_axes;
        let chord = |theta: f64| {
            // θ is the angle on the scaled circle, which keeps thin ellipses smooth.
            let (dx, dy) = (a * theta.cos(), b * theta.sin());
            let length = dx.hypot(dy);
            let slope = x * dx / (a * a) + y * dy / (b * b);
            let depth = 1.0 - (x / a).powi(2) - (y / b).powi(2);
            0.5 * PI * (slope * slope + depth) * (a * b / length)
        };
        // Four quarters, each graded towards the major axis, where a thin ellipse has a peak.
        let quarter = |from: f64, sign: f64| {
            integrate(0.0, 1.0, |t| {
                let theta = 0.5 * PI * t.powi(4);
                chord(from + sign * theta) * 2.0 * PI * t.powi(3)
            })
        };
        let start = if a >= b { 0.5 * PI } else { 0.0 };
        contact.peak_pressure * (quarter(start, 1.0) + quarter(start, -1.0)) / (PI * modulus)
    }

    #[test]
    fn the_displacement_of_the_pressure_fills_the_interference() {
        for radii in &RADII[..4] {
            let contact = HertzEllipse::new(*radii, 5.0, 7.0);
            let [a, b] = contact.semi_axes;
            for [x, y] in [[0.0, 0.0], [0.5 * a, 0.0], [0.0, 0.8 * b], [0.6 * a, -0.7 * b]] {
                let interference = contact.approach - 0.5 * (x * x / radii[0] + y * y / radii[1]);
                let u = displacement(&contact, 5.0, [x, y]);
                assert_relative_eq!(u, interference, max_relative = 1e-9);
            }
        }
    }

    #[test]
    fn equal_radii_give_the_sphere() {
        let sphere = HertzSphere { radius: 4.0, modulus: 5.0, load: 7.0 };
        let contact = HertzEllipse::new([4.0, 4.0], 5.0, 7.0);
        assert_relative_eq!(contact.semi_axes[0], sphere.contact_radius(), max_relative = 1e-14);
        assert_relative_eq!(contact.semi_axes[1], sphere.contact_radius(), max_relative = 1e-14);
        assert_relative_eq!(contact.approach, sphere.approach(), max_relative = 1e-14);
        assert_relative_eq!(contact.peak_pressure, sphere.peak_pressure(), max_relative = 1e-14);
        assert_relative_eq!(contact.elastic_energy(), sphere.elastic_energy(), max_relative = 1e-14);
    }

    #[test]
    fn nearly_equal_radii_tend_to_the_sphere_at_first_order() {
        // a/b = (Rx/Ry)^{2/3} and the geometric mean hold to first order. Johnson (1985), section 4.2(c).
        for step in [1e-2, 1e-4, 1e-6] {
            let contact = HertzEllipse::new([4.0 * (1.0 + step), 4.0], 5.0, 7.0);
            let sphere = HertzSphere { radius: 4.0 * (1.0 + step).sqrt(), modulus: 5.0, load: 7.0 };
            let [a, b] = contact.semi_axes;
            assert_relative_eq!(a / b, (1.0 + step).powf(2.0 / 3.0), max_relative = step * step + 1e-14);
            assert_relative_eq!((a * b).sqrt(), sphere.contact_radius(), max_relative = step * step + 1e-14);
            assert_relative_eq!(contact.approach, sphere.approach(), max_relative = step * step + 1e-14);
        }
    }

    #[test]
    fn the_pressure_carries_the_load() {
        for radii in RADII {
            let contact = HertzEllipse::new(radii, 5.0, 7.0);
            let [a, b] = contact.semi_axes;
            let strip =
                |x: f64| integrate_to_edge(b * (1.0 - (x / a).powi(2)).sqrt(), |y| contact.pressure(x, y));
            assert_relative_eq!(4.0 * integrate_to_edge(a, strip), 7.0, max_relative = 1e-10);
        }
    }

    #[test]
    fn thin_ellipses_agree_with_thirty_digits() {
        // mpmath 1.3.0, 30 digits: semi-axes, approach, peak pressure.
        let cases = [
            (
                [4.0, 0.5],
                [
                    2.136_221_276_801_008_5,
                    0.546_833_597_361_958_6,
                    0.869_457_151_135_987,
                    2.861_132_696_036_612,
                ],
            ),
            (
                [1e6, 1.0],
                [
                    223.541_150_805_773_07,
                    0.077_334_069_715_908_94,
                    0.027_975_602_221_197_22,
                    0.193_335_265_172_703_3,
                ],
            ),
        ];
        for (radii, [a, b, approach, peak]) in cases {
            let contact = HertzEllipse::new(radii, 5.0, 7.0);
            assert_relative_eq!(contact.semi_axes[0], a, max_relative = 1e-13);
            assert_relative_eq!(contact.semi_axes[1], b, max_relative = 1e-13);
            assert_relative_eq!(contact.approach, approach, max_relative = 1e-13);
            assert_relative_eq!(contact.peak_pressure, peak, max_relative = 1e-13);
        }
    }

    #[test]
    fn turning_the_bodies_turns_the_ellipse() {
        let (one, other) = (HertzEllipse::new([4.0, 0.5], 5.0, 7.0), HertzEllipse::new([0.5, 4.0], 5.0, 7.0));
        assert_eq!(one.semi_axes[0], other.semi_axes[1]);
        assert_eq!((one.approach, one.pressure(0.1, 0.2)), (other.approach, other.pressure(0.2, 0.1)));
        assert!(one.semi_axes[0] > one.semi_axes[1]);
    }
}

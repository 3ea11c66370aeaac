//! Hertz: a line contact of cylinders.

use std::f64::consts::PI;

use crate::stress::Stress;
use crate::units::{Metre, Pascal};

/// Frictionless contact of two parallel elastic cylinders in plane strain, approximated by parabolas.
///
/// h = x²/2R,  a² = 4P′R/πE*,  p = p₀ √(1 − x²/a²),  p₀ = 2P′/πa. The approach of a half-plane is unbounded
/// and depends on where it is measured. Johnson (1985), eqs. 4.43–4.45.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HertzLine {
    /// Relative radius R: 1/R = 1/R₁ + 1/R₂.
    pub radius: Metre,
    /// Composite modulus E*.
    pub modulus: Pascal,
    /// Load P′ ≥ 0 per length of the line, N/m.
    pub load_per_length: f64,
}

impl HertzLine {
    /// Half width a of the contact.
    pub fn half_width(&self) -> Metre {
        (4.0 * self.load_per_length * self.radius / (PI * self.modulus)).sqrt()
    }

    /// Pressure p₀ on the centre line, aE*/2R.
    pub fn peak_pressure(&self) -> Pascal {
        0.5 * self.half_width() * self.modulus / self.radius
    }

    /// Pressure at distance `x` from the centre line; 0 outside the contact.
    pub fn pressure(&self, x: Metre) -> Pascal {
        let a = self.half_width();
        if x.abs() < a { self.peak_pressure() * ((1.0 - x / a) * (1.0 + x / a)).sqrt() } else { 0.0 }
    }

    /// Approach of the bodies relative to the distance r₀ = `datum` ≥ a, where the displacement under a unit
    /// line force, −(2/πE*) ln(r/r₀), is 0:
    ///
    /// ```text
    /// δ = (2P′/πE*) [ln(2r₀/a) + ½]
    /// ```
    pub fn approach(&self, datum: Metre) -> Metre {
        let line = 2.0 * self.load_per_length / (PI * self.modulus);
        line * ((2.0 * datum / self.half_width()).ln() + 0.5)
    }

    /// Stress at distance `x` from the centre line and at `depth` ≥ 0, in plane strain, with the shear
    /// traction `friction` times the pressure along +x on the body. McEwen (1949); Johnson (1985), eqs. 4.49,
    /// 7.8; y lies along the line.
    pub fn stress(&self, x: Metre, depth: Metre, poisson: f64, friction: f64) -> Stress {
        let a = self.half_width();
        let (x, z) = (x / a, depth.max(f64::MIN_POSITIVE) / a);
        let sum = 1.0 - x * x + z * z;
        let root = sum.hypot(2.0 * x * z);
        let m = (0.5 * (root + sum)).max(0.0).sqrt();
        let n = (0.5 * (root - sum)).max(0.0).sqrt().copysign(x);
        let squares = (m * m + n * n).max(f64::MIN_POSITIVE);
        let inside = -(m * (1.0 + (z * z + n * n) / squares) - 2.0 * z);
        let shear = -n * (m * m - z * z) / squares;
        let along = n * (2.0 - (z * z - m * m) / squares) - 2.0 * x;
        let normal = -m * (1.0 - (z * z + n * n) / squares);
        let p = self.peak_pressure();
        let (xx, zz) = (p * (inside + friction * along), p * (normal + friction * shear));
        let xz = p * (shear + friction * inside);
        Stress { xx, yy: poisson * (xx + zz), zz, yz: 0.0, xz, xy: 0.0 }
    }

    /// Deformed gap at distance `x` from the centre line; 0 in the contact.
    ///
    /// g = [x √(x² − a²) − a² acosh(x/a)]/2R for x > a, the integral of g′ = √(x² − a²)/R. Near the edge it
    /// vanishes as (x − a)^{3/2} and is exact to about 1e-16 a²/R.
    pub fn gap(&self, x: Metre) -> Metre {
        let (a, x) = (self.half_width(), x.abs());
        if x <= a {
            return 0.0;
        }
        let bend = if a > 0.0 { a * a * libm::acosh(x / a) } else { 0.0 };
        0.5 * (x * ((x - a) * (x + a)).sqrt() - bend) / self.radius
    }
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::{integrate, integrate_to_edge};
    use super::*;
    use approx::assert_relative_eq;

    const LINE: HertzLine = HertzLine { radius: 3.0, modulus: 2.0, load_per_length: 0.7 };

    #[test]
    fn the_pressure_carries_the_load() {
        let load = 2.0 * integrate_to_edge(LINE.half_width(), |x| LINE.pressure(x));
        assert_relative_eq!(load, LINE.load_per_length, max_relative = 1e-12);
        assert_relative_eq!(
            LINE.peak_pressure(),
            2.0 * LINE.load_per_length / (PI * LINE.half_width()),
            max_relative = 1e-15
        );
    }

    #[test]
    fn the_gap_opens_as_flamants_solution_says() {
        // u′ = −(2/πE*) ∫ p(s)/(x − s) ds on a half-plane, h′ = x/R.
        let a = LINE.half_width();
        let slope = |x: f64| {
            let flamant = integrate_to_edge(a, |s| LINE.pressure(s) * 2.0 * x / ((x - s) * (x + s)));
            x / LINE.radius - 2.0 / (PI * LINE.modulus) * flamant
        };
        for (near, far) in [(1.5 * a, 2.0 * a), (2.0 * a, 6.0 * a)] {
            assert_relative_eq!(
                LINE.gap(far) - LINE.gap(near),
                integrate(near, far, slope),
                max_relative = 1e-10
            );
        }
    }

    #[test]
    fn the_approach_is_the_displacement_on_the_centre_line() {
        let datum = 7.0;
        let force = integrate_to_edge(LINE.half_width(), |s| -LINE.pressure(s) * (s / datum).ln());
        let displacement = 2.0 * 2.0 / (PI * LINE.modulus) * force;
        // The quadrature does not treat the logarithm in the middle.
        assert_relative_eq!(LINE.approach(datum), displacement, max_relative = 1e-8);
    }

    #[test]
    fn the_gap_closes_smoothly_at_the_edge() {
        let a = LINE.half_width();
        assert_eq!(LINE.gap(a), 0.0);
        for step in [1e-3, 1e-4] {
            let edge = (2.0 * a).sqrt() * (step * a).powf(1.5) / (1.5 * LINE.radius);
            assert_relative_eq!(LINE.gap((1.0 + step) * a), edge, max_relative = step);
        }
    }

    #[test]
    fn no_load_leaves_the_parabola() {
        let idle = HertzLine { load_per_length: 0.0, ..LINE };
        assert_relative_eq!(idle.gap(0.6), 0.06, max_relative = 1e-15);
        assert_eq!(idle.pressure(0.0), 0.0);
    }
}

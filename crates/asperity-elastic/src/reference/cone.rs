//! Sneddon: a cone.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::units::{Joule, Metre, Newton, Pascal};

/// Frictionless indentation by a blunt cone, h = r tan θ, θ the angle between its flank and the plane (90°
/// less the semi-apical angle).
///
/// δ = ½π a tan θ,  W = ½π a² E* tan θ,  p = ½E* tan θ acosh(a/r). The half-space theory requires tan θ ≪ 1.
/// Love (1939); Sneddon, Int. J. Eng. Sci. 3, 47 (1965).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    /// Slope tan θ > 0 of the flank.
    pub slope: f64,
    /// Composite modulus E*.
    pub modulus: Pascal,
    /// Normal load W ≥ 0.
    pub load: Newton,
}

impl Cone {
    /// Creates the cone at approach δ ≥ 0: W = 2E*δ²/(π tan θ).
    pub fn from_approach(slope: f64, modulus: Pascal, approach: Metre) -> Self {
        Self { slope, modulus, load: 2.0 * modulus * approach * approach / (PI * slope) }
    }

    /// Contact radius a.
    pub fn contact_radius(&self) -> Metre {
        (2.0 * self.load / (PI * self.modulus * self.slope)).sqrt()
    }

    /// Rigid-body approach δ.
    pub fn approach(&self) -> Metre {
        FRAC_PI_2 * self.contact_radius() * self.slope
    }

    /// Mean pressure over the contact, ½E* tan θ at any load.
    pub fn mean_pressure(&self) -> Pascal {
        0.5 * self.modulus * self.slope
    }

    /// Pressure at distance `r` from the axis: infinite at the tip, 0 outside the contact.
    pub fn pressure(&self, r: Metre) -> Pascal {
        let (a, r) = (self.contact_radius(), r.abs());
        if r < a { self.mean_pressure() * libm::acosh(a / r) } else { 0.0 }
    }

    /// Surface displacement u at distance `r` from the axis.
    ///
    /// u = δ − r tan θ for r ≤ a,  u = tan θ [a asin(a/r) + √(r² − a²) − r] for r > a.
    pub fn displacement(&self, r: Metre) -> Metre {
        let (a, r) = (self.contact_radius(), r.abs());
        if r <= a {
            return self.approach() - r * self.slope;
        }
        let root = ((r - a) * (r + a)).sqrt();
        self.slope * a * (a.atan2(root) - a / (root + r)) // √(r² − a²) − r = −a²/(√(r² − a²) + r)
    }

    /// Elastic energy stored in both bodies, ⅓ W δ.
    pub fn elastic_energy(&self) -> Joule {
        self.load * self.approach() / 3.0
    }
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::{axisymmetric_displacement, axisymmetric_load, integrate};
    use super::*;
    use approx::assert_relative_eq;

    const CONE: Cone = Cone { slope: 0.1, modulus: 5.0, load: 0.3 };

    #[test]
    fn the_pressure_carries_the_load() {
        let a = CONE.contact_radius();
        let load = axisymmetric_load(a, |r| CONE.pressure(r));
        assert_relative_eq!(load, CONE.load, max_relative = 1e-10);
        assert_relative_eq!(CONE.mean_pressure() * PI * a * a, CONE.load, max_relative = 1e-14);
    }

    #[test]
    fn the_displacement_is_the_pressures() {
        let a = CONE.contact_radius();
        for r in [1.2 * a, 2.0 * a, 10.0 * a] {
            let u = axisymmetric_displacement(a, CONE.modulus, r, |s| CONE.pressure(s));
            assert_relative_eq!(CONE.displacement(r), u, max_relative = 1e-10);
        }
    }

    #[test]
    fn the_displacement_is_continuous_at_the_edge() {
        let a = CONE.contact_radius();
        assert_relative_eq!(CONE.displacement(a), CONE.displacement(a * (1.0 + 1e-14)), max_relative = 1e-12);
    }

    #[test]
    fn the_energy_is_the_work_of_the_load() {
        let load = |approach| Cone::from_approach(CONE.slope, CONE.modulus, approach).load;
        let work = integrate(0.0, CONE.approach(), load);
        assert_relative_eq!(work, CONE.elastic_energy(), max_relative = 1e-13);
        assert_relative_eq!(load(CONE.approach()), CONE.load, max_relative = 1e-14);
    }
}

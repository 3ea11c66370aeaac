//! A flat circular punch.

use std::f64::consts::PI;

use crate::units::{Joule, Metre, Newton, Pascal};

/// Frictionless indentation by a rigid flat-ended cylinder.
///
/// W = 2aE*δ,  p = W/(2πa²) (1 − r²/a²)^{−1/2}. Boussinesq (1885); Johnson (1985), eqs. 3.34–3.37.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlatPunch {
    /// Radius a of the punch.
    pub radius: Metre,
    /// Composite modulus E*.
    pub modulus: Pascal,
    /// Normal load W ≥ 0.
    pub load: Newton,
}

impl FlatPunch {
    /// Creates the punch at approach δ ≥ 0.
    pub fn from_approach(radius: Metre, modulus: Pascal, approach: Metre) -> Self {
        Self { radius, modulus, load: 2.0 * radius * modulus * approach }
    }

    /// Rigid-body approach δ.
    pub fn approach(&self) -> Metre {
        0.5 * self.load / (self.radius * self.modulus)
    }

    /// Pressure at distance `r` from the axis: infinite at the edge, 0 outside.
    pub fn pressure(&self, r: Metre) -> Pascal {
        let (a, r) = (self.radius, r.abs());
        if r <= a { self.load / (2.0 * PI * a * ((a - r) * (a + r)).sqrt()) } else { 0.0 }
    }

    /// Surface displacement u at distance `r` from the axis: δ under the punch, (2δ/π) asin(a/r) outside.
    pub fn displacement(&self, r: Metre) -> Metre {
        let (a, r) = (self.radius, r.abs());
        if r <= a {
            return self.approach();
        }
        let root = ((r - a) * (r + a)).sqrt(); // asin(a/r) = atan2(a, root), sharp at the edge
        2.0 / PI * self.approach() * a.atan2(root)
    }

    /// Elastic energy stored, ½ W δ.
    pub fn elastic_energy(&self) -> Joule {
        0.5 * self.load * self.approach()
    }
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::{axisymmetric_displacement, axisymmetric_load, integrate};
    use super::*;
    use approx::assert_relative_eq;

    const PUNCH: FlatPunch = FlatPunch { radius: 1.5, modulus: 5.0, load: 7.0 };

    #[test]
    fn the_pressure_carries_the_load() {
        let load = axisymmetric_load(PUNCH.radius, |r| PUNCH.pressure(r));
        assert_relative_eq!(load, PUNCH.load, max_relative = 1e-10);
    }

    #[test]
    fn the_displacement_is_the_pressures() {
        for r in [2.0, 3.0, 10.0] {
            let u = axisymmetric_displacement(PUNCH.radius, PUNCH.modulus, r, |s| PUNCH.pressure(s));
            assert_relative_eq!(PUNCH.displacement(r), u, max_relative = 1e-10);
        }
    }

    #[test]
    fn the_displacement_is_continuous_at_the_edge() {
        let outside = PUNCH.displacement(PUNCH.radius * (1.0 + 1e-12));
        assert_relative_eq!(PUNCH.approach(), outside, max_relative = 2e-6); // (2/π) √(2 · 1e-12)
        assert_eq!(PUNCH.pressure(PUNCH.radius), f64::INFINITY);
    }

    #[test]
    fn the_energy_is_the_work_of_the_load() {
        let load = |approach| FlatPunch::from_approach(PUNCH.radius, PUNCH.modulus, approach).load;
        let work = integrate(0.0, PUNCH.approach(), load);
        assert_relative_eq!(work, PUNCH.elastic_energy(), max_relative = 1e-13);
    }
}

//! Indentation without slip, for infinite friction.
//!
//! Without friction, dissimilar bodies pressed together would slide over each other; here they stick as soon as they touch.
//! The solution depends on Dundurs' β = E*/G*, |β| ≤ ½, with 1/G* = (1 + ν₁)(1 − 2ν₁)/2E₁ − (1 + ν₂)(1 − 2ν₂)/2E₂. Its
//! sign, which is that of the shear, does not affect the load. β = 0 is the frictionless contact.

use std::f64::consts::{LN_2, PI};

use crate::units::{Metre, Newton, Pascal};

/// A rigid flat-ended cylinder, or a circle in full stick.
///
/// W = 2aE*δ (atanh β)/β;  on a body with Poisson's ratio ν the factor is (1 − ν) ln(3 − 4ν)/(1 − 2ν).
/// Mossakovskii (1954); Spence, Proc. R. Soc. A 305, 55 (1968).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StickingPunch {
    /// Radius a of the punch.
    pub radius: Metre,
    /// Composite modulus E*.
    pub modulus: Pascal,
    /// Dundurs' β.
    pub dundurs: f64,
    /// Normal load W ≥ 0.
    pub load: Newton,
}

impl StickingPunch {
    /// Creates the punch at approach δ ≥ 0.
    pub fn from_approach(radius: Metre, modulus: Pascal, dundurs: f64, approach: Metre) -> Self {
        Self { radius, modulus, dundurs, load: 2.0 * radius * modulus * stiffening(dundurs) * approach }
    }

    /// Rigid-body approach δ.
    pub fn approach(&self) -> Metre {
        0.5 * self.load / (self.radius * self.modulus * stiffening(self.dundurs))
    }
}

/// A sphere on a plane, or two spheres, under a load that has increased from 0.
///
/// ```text
/// W = (4E*a³/3R) (atanh β)/βJ        δ = a²/RJ
/// J = 2 ∫₀¹ t cos(ε ln((1 + t)/(1 − t))) dt,  ε = (atanh β)/π
/// ```
/// compared with J = 1 without friction. The load at a given a increases more than that at a given δ: at β =
/// ½ by factors of 1.196 and 1.053. Exact for the paraboloid. Mossakovskii (1963); Spence (1968); Borodich &
/// Keer, Proc. R. Soc. A 460, 507 (2004).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StickingSphere {
    /// Relative radius R: 1/R = 1/R₁ + 1/R₂.
    pub radius: Metre,
    /// Composite modulus E*.
    pub modulus: Pascal,
    /// Dundurs' β.
    pub dundurs: f64,
    /// Normal load W ≥ 0.
    pub load: Newton,
}

impl StickingSphere {
    /// Creates the contact at approach δ ≥ 0.
    pub fn from_approach(radius: Metre, modulus: Pascal, dundurs: f64, approach: Metre) -> Self {
        let frictionless = 4.0 / 3.0 * modulus * (radius * approach).sqrt() * approach;
        Self { radius, modulus, dundurs, load: frictionless * stiffening(dundurs) * integral(dundurs).sqrt() }
    }

    /// Contact radius a.
    pub fn contact_radius(&self) -> Metre {
        let factor = integral(self.dundurs) / stiffening(self.dundurs);
        (0.75 * self.load * self.radius / self.modulus * factor).cbrt()
    }

    /// Rigid-body approach δ.
    pub fn approach(&self) -> Metre {
        self.contact_radius().powi(2) / (self.radius * integral(self.dundurs))
    }
}

/// (atanh β)/β: the relative stiffness of a circle without slip.
fn stiffening(dundurs: f64) -> f64 {
    if dundurs == 0.0 { 1.0 } else { dundurs.atanh() / dundurs }
}

/// J = 1 − 4ε² Σ (−1)ᵏ η(2k + 1) ε²ᵏ, with Dirichlet's η; to 1e-13 for |β| ≤ ½.
fn integral(dundurs: f64) -> f64 {
    /// Values η(1), η(3), … of Dirichlet's function.
    const ETA: [f64; 8] = [
        LN_2,
        0.901_542_677_369_695_7,
        0.972_119_770_446_909_3,
        0.992_593_819_922_830_3,
        0.998_094_297_541_605_3,
        0.999_517_143_498_060_8,
        0.999_878_542_763_265_1,
        0.999_969_551_213_099_2,
    ];
    let square = (dundurs.atanh() / PI).powi(2);
    1.0 - 4.0 * square * ETA.iter().rev().fold(0.0, |sum, eta| eta - square * sum)
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::integrate;
    use super::super::{FlatPunch, HertzSphere};
    use super::*;
    use approx::assert_relative_eq;

    const SPHERE: StickingSphere = StickingSphere { radius: 4.0, modulus: 5.0, dundurs: 0.4, load: 7.0 };

    #[test]
    fn without_contrast_friction_changes_nothing() {
        let punch = StickingPunch { radius: 1.5, modulus: 5.0, dundurs: 0.0, load: 7.0 };
        assert_eq!(punch.approach(), FlatPunch { radius: 1.5, modulus: 5.0, load: 7.0 }.approach());
        let hertz = HertzSphere { radius: 4.0, modulus: 5.0, load: 7.0 };
        let alike = StickingSphere { dundurs: 0.0, ..SPHERE };
        assert_relative_eq!(alike.contact_radius(), hertz.contact_radius(), max_relative = 1e-15);
        assert_relative_eq!(alike.approach(), hertz.approach(), max_relative = 1e-15);
    }

    #[test]
    fn on_a_body_of_poissons_ratio_zero_the_punch_is_stiffer_by_the_logarithm_of_three() {
        for (poisson, factor) in [(0.0, 3_f64.ln()), (0.3, 0.7 * 1.8_f64.ln() / 0.4)] {
            let dundurs = (1.0 - 2.0 * poisson) / (2.0 * (1.0 - poisson));
            let punch = StickingPunch::from_approach(1.5, 5.0, dundurs, 0.2);
            assert_relative_eq!(punch.load, 2.0 * 1.5 * 5.0 * 0.2 * factor, max_relative = 1e-14);
            assert_relative_eq!(punch.approach(), 0.2, max_relative = 1e-15);
        }
    }

    #[test]
    fn the_punch_carries_the_load_of_its_density() {
        // W = 2π ∫ φ dt with φ = (E*δ/π)(1 − β²)^{−½} cos(2ε atanh(t/a)); t = a tanh y.
        let dundurs = 0.4_f64;
        let epsilon = dundurs.atanh() / PI;
        let sum = integrate(0.0, 20.0, |y| (2.0 * epsilon * y).cos() / y.cosh().powi(2));
        let load = 2.0 * 1.5 * 5.0 * 0.2 * sum / (1.0 - dundurs * dundurs).sqrt();
        let punch = StickingPunch::from_approach(1.5, 5.0, dundurs, 0.2);
        assert_relative_eq!(punch.load, load, max_relative = 1e-10);
    }

    #[test]
    fn the_series_is_the_integral() {
        for dundurs in [0.1_f64, 0.3, 0.5] {
            let epsilon = dundurs.atanh() / PI;
            let sum = integrate(0.0, 20.0, |y| 2.0 * y.tanh() / y.cosh().powi(2) * (2.0 * epsilon * y).cos());
            assert_relative_eq!(integral(dundurs), sum, max_relative = 1e-10);
            assert_eq!(integral(dundurs), integral(-dundurs));
        }
    }

    #[test]
    fn the_sphere_grows_as_a_punch_that_widens() {
        // dW/dδ = 2aE* (atanh β)/β: each increment is that of a sticking circle.
        let grown = |approach| StickingSphere::from_approach(4.0, 5.0, 0.4, approach);
        let end = SPHERE.approach();
        let load = integrate(0.0, 1.0, |t| {
            let approach = t * t * end;
            let punch =
                StickingPunch::from_approach(grown(approach).contact_radius(), 5.0, 0.4, 2.0 * t * end);
            punch.load
        });
        assert_relative_eq!(load, SPHERE.load, max_relative = 1e-12);
        assert_relative_eq!(grown(end).load, SPHERE.load, max_relative = 1e-14);
    }

    #[test]
    fn the_sphere_sinks_as_a_program_of_rings_finds() {
        // δR/a² from the displacement outside a sticking punch, by 200 rings of constant pressure and linear
        // shear.
        for (dundurs, computed) in [(0.3, 1.027_302), (0.5, 1.088_732)] {
            let sphere = StickingSphere { dundurs, ..SPHERE };
            let ratio = sphere.approach() * sphere.radius / sphere.contact_radius().powi(2);
            assert_relative_eq!(ratio, computed, max_relative = 3e-6);
        }
    }

    #[test]
    fn friction_makes_the_sphere_stiffer_by_what_is_documented() {
        let hertz = |load| HertzSphere { radius: 4.0, modulus: 5.0, load };
        let stuck = StickingSphere { dundurs: 0.5, ..SPHERE };
        let at_radius = (stuck.contact_radius() / hertz(stuck.load).contact_radius()).powi(-3);
        assert_relative_eq!(at_radius, 1.196, max_relative = 1e-3);
        let at_approach = stuck.load / HertzSphere::from_approach(4.0, 5.0, stuck.approach()).load;
        assert_relative_eq!(at_approach, 1.053, max_relative = 1e-3);
    }
}

//! Cattaneo and Mindlin: a Hertzian contact that is pushed sideways.

use crate::material::Material;
use crate::reference::HertzSphere;
use crate::units::{Metre, Newton, Pascal};

/// Partial slip of a sphere under a constant normal load and a tangential one that has grown from 0.
///
/// ```text
/// c = a (1 − Q/μW)^{1/3}                                      stick radius
/// q = μ p₀ [√(1 − r²/a²) − (c/a) √(1 − r²/c²)₊]               shear traction, along Q
/// δₜ = (3μW/4aGₜ) [1 − (1 − Q/μW)^{2/3}]                      tangential displacement of the bodies
/// ```
/// Exact for identical materials but for the slip's direction, which it takes along Q.
/// Cattaneo (1938); Mindlin, J. Appl. Mech. 16, 259 (1949); Johnson (1985), eqs. 7.39–7.42.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CattaneoMindlin {
    /// The normal contact.
    pub normal: HertzSphere,
    /// Composite tangential modulus Gₜ, see [`tangential_modulus`].
    pub tangential_modulus: Pascal,
    /// Coefficient of friction μ > 0.
    pub friction: f64,
    /// Tangential load Q, 0 ≤ Q ≤ μW.
    pub tangential_load: Newton,
}

impl CattaneoMindlin {
    /// 1 − Q/μW, from 1 (all sticks) to 0 (all slips).
    fn reserve(&self) -> f64 {
        1.0 - self.tangential_load / (self.friction * self.normal.load)
    }

    /// Radius c of the circle that sticks.
    pub fn stick_radius(&self) -> Metre {
        self.normal.contact_radius() * self.reserve().cbrt()
    }

    /// Shear traction q at distance `r` from the axis, in the direction of Q.
    pub fn shear(&self, r: Metre) -> Pascal {
        let stick = HertzSphere { load: self.normal.load * self.reserve(), ..self.normal };
        self.friction * (self.normal.pressure(r) - stick.pressure(r))
    }

    /// Tangential displacement δₜ of the bodies against each other.
    pub fn displacement(&self) -> Metre {
        let full_slip = 0.75 * self.friction * self.normal.load
            / (self.normal.contact_radius() * self.tangential_modulus);
        full_slip * (1.0 - self.reserve().cbrt().powi(2))
    }
}

/// Composite tangential modulus: 1/Gₜ = (2 − ν₁)(1 + ν₁)/2E₁ + (2 − ν₂)(1 + ν₂)/2E₂, so that the stiffness of a
/// circle that sticks is 2aGₜ. Infinite if both bodies are rigid. Mindlin (1949).
pub fn tangential_modulus(lower: &Material, upper: &Material) -> Pascal {
    let compliance = |m: &Material| (2.0 - m.poisson) * (1.0 + m.poisson) / (2.0 * m.young);
    1.0 / (compliance(lower) + compliance(upper))
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::{axisymmetric_load, integrate};
    use super::*;
    use approx::assert_relative_eq;

    fn pushed(share: f64) -> CattaneoMindlin {
        let normal = HertzSphere { radius: 4.0, modulus: 5.0, load: 7.0 };
        CattaneoMindlin {
            normal,
            tangential_modulus: 4.0,
            friction: 0.3,
            tangential_load: share * 0.3 * normal.load,
        }
    }

    #[test]
    fn the_shear_carries_the_tangential_load() {
        let contact = pushed(0.6);
        let (a, c) = (contact.normal.contact_radius(), contact.stick_radius());
        let whole = axisymmetric_load(a, |r| contact.friction * contact.normal.pressure(r));
        let less = axisymmetric_load(c, |r| contact.friction * contact.normal.pressure(r) - contact.shear(r));
        assert_relative_eq!(whole - less, contact.tangential_load, max_relative = 1e-11);
    }

    #[test]
    fn the_ring_that_slips_bears_all_the_friction_it_can() {
        let contact = pushed(0.6);
        let (a, c) = (contact.normal.contact_radius(), contact.stick_radius());
        assert!(contact.shear(0.9 * c) < contact.friction * contact.normal.pressure(0.9 * c));
        assert_eq!(contact.shear(0.5 * (a + c)), contact.friction * contact.normal.pressure(0.5 * (a + c)));
    }

    #[test]
    fn a_small_push_meets_mindlins_stiffness() {
        for share in [1e-3, 1e-5] {
            let contact = pushed(share);
            let stiffness = 2.0 * contact.normal.contact_radius() * contact.tangential_modulus;
            assert_relative_eq!(
                contact.tangential_load / contact.displacement(),
                stiffness,
                max_relative = share
            );
        }
    }

    #[test]
    fn the_stiffness_is_that_of_the_circle_that_sticks() {
        // dQ/dδₜ = 2 c Gₜ: Mindlin's incremental argument.
        let to = pushed(0.8);
        let travel = integrate(0.0, 0.8, |share| {
            let contact = pushed(share);
            0.3 * 7.0 / (2.0 * contact.stick_radius() * contact.tangential_modulus)
        });
        assert_relative_eq!(travel, to.displacement(), max_relative = 1e-10);
        assert_eq!(pushed(1.0).stick_radius(), 0.0);
    }

    #[test]
    fn rubber_is_two_thirds_as_stiff_sideways() {
        let rubber = Material::elastic(3.0, 0.5).unwrap();
        let normal = crate::material::composite_modulus(&rubber, &rubber).unwrap();
        assert_relative_eq!(tangential_modulus(&rubber, &rubber), normal * 2.0 / 3.0, max_relative = 1e-15);
    }
}

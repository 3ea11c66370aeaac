//! Cattaneo and Mindlin: a Hertzian contact under a tangential load.

use crate::material::Material;
use crate::reference::HertzSphere;
use crate::units::{Joule, Metre, Newton, Pascal};

/// Partial slip of a sphere under a constant normal load and a tangential load that has increased from 0.
///
/// ```text
/// c = a (1 − Q/μW)^{1/3}                                      stick radius
/// q = μ p₀ [√(1 − r²/a²) − (c/a) √(1 − r²/c²)₊]               shear traction, along Q
/// δₜ = (3μW/4aGₜ) [1 − (1 − Q/μW)^{2/3}]                      tangential displacement of the bodies
/// ```
/// Exact for identical materials, except for the direction of slip, which is assumed along Q. Cattaneo
/// (1938); Mindlin, J. Appl. Mech. 16, 259 (1949); Johnson (1985), eqs. 7.39–7.42.
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
    /// 1 − Q/μW, from 1 (full stick) to 0 (full slip).
    fn reserve(&self) -> f64 {
        1.0 - self.tangential_load / (self.friction * self.normal.load)
    }

    /// Radius c of the stick circle.
    pub fn stick_radius(&self) -> Metre {
        self.normal.contact_radius() * self.reserve().cbrt()
    }

    /// Shear traction q at distance `r` from the axis, in the direction of Q.
    pub fn shear(&self, r: Metre) -> Pascal {
        let stick = HertzSphere { load: self.normal.load * self.reserve(), ..self.normal };
        self.friction * (self.normal.pressure(r) - stick.pressure(r))
    }

    /// Relative tangential displacement δₜ of the bodies.
    pub fn displacement(&self) -> Metre {
        let full_slip = 0.75 * self.friction * self.normal.load
            / (self.normal.contact_radius() * self.tangential_modulus);
        full_slip * (1.0 - self.reserve().cbrt().powi(2))
    }

    /// Frictional energy of a closed cycle of the tangential load between Q and −Q.
    ///
    /// (18μ²W²/5aGₜ) {1 − s⁵ − ⅚ (Q/μW)(1 + s²)},  s = c/a;  Q³/9aGₜμW for small Q, where about 3 log₁₀(μW/Q)
    /// digits are lost. Mindlin & Deresiewicz (1953); Johnson (1985), section 7.4.
    pub fn cycle_loss(&self) -> Joule {
        let (reserve, limit) = (self.reserve(), self.friction * self.normal.load);
        let square = reserve.cbrt().powi(2);
        let shape = 1.0 - reserve * square - 5.0 / 6.0 * (1.0 - reserve) * (1.0 + square);
        3.6 * limit * limit / (self.normal.contact_radius() * self.tangential_modulus) * shape
    }
}

/// Unloading in partial slip: the tangential load has increased to Q* and decreased to Q.
///
/// Twice the solution for half the change is subtracted from the solution at Q*, because slip starts anew in
/// the opposite direction, against twice the friction:
///
/// ```text
/// c = a (1 − (Q* − Q)/2μW)^{1/3}                              radius of the circle without reverse slip
/// q = q*(r) − 2 q(r; (Q* − Q)/2)                              shear traction: −μp for r > c
/// δₜ = (3μW/4aGₜ) [2 (1 − (Q* − Q)/2μW)^{2/3} − (1 − Q*/μW)^{2/3} − 1]
/// ```
/// At Q = −Q* the state is that after a first load to −Q*. Reloading is the same solution with the signs of
/// Q, q and δₜ changed. Mindlin & Deresiewicz, J. Appl. Mech. 20, 327 (1953); Johnson (1985), section 7.4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MindlinDeresiewicz {
    /// The contact at the reversal of the tangential load, at Q*.
    pub turn: CattaneoMindlin,
    /// Tangential load Q, −Q* ≤ Q ≤ Q*.
    pub tangential_load: Newton,
}

impl MindlinDeresiewicz {
    /// The contact under half of the decrease of the load.
    fn half_back(&self) -> CattaneoMindlin {
        let tangential_load = 0.5 * (self.turn.tangential_load - self.tangential_load);
        CattaneoMindlin { tangential_load, ..self.turn }
    }

    /// Radius c of the circle without reverse slip.
    pub fn stick_radius(&self) -> Metre {
        self.half_back().stick_radius()
    }

    /// Shear traction q at distance `r` from the axis, positive along Q*.
    pub fn shear(&self, r: Metre) -> Pascal {
        self.turn.shear(r) - 2.0 * self.half_back().shear(r)
    }

    /// Relative tangential displacement δₜ of the bodies, positive along Q*.
    pub fn displacement(&self) -> Metre {
        self.turn.displacement() - 2.0 * self.half_back().displacement()
    }
}

/// Composite tangential modulus: 1/Gₜ = (2 − ν₁)(1 + ν₁)/2E₁ + (2 − ν₂)(1 + ν₂)/2E₂, so that the stiffness of
/// a sticking circle is 2aGₜ. Infinite if both bodies are rigid. Mindlin (1949).
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

    fn taken_back(share: f64, to: f64) -> MindlinDeresiewicz {
        let turn = pushed(share);
        MindlinDeresiewicz { turn, tangential_load: to * turn.tangential_load }
    }

    #[test]
    fn the_shear_carries_what_is_left_of_the_load() {
        for to in [0.7, 0.0, -0.5] {
            let back = taken_back(0.8, to);
            let (a, c, inner) =
                (back.turn.normal.contact_radius(), back.stick_radius(), back.turn.stick_radius());
            let slip = |r| back.turn.friction * back.turn.normal.pressure(r);
            // Decomposed at the two radii where the shear has a kink: −μp, 2μp, −μp from the outside.
            let whole = axisymmetric_load(a, slip);
            let ring = axisymmetric_load(c, |r| back.half_back().shear(r) - slip(r));
            let core = axisymmetric_load(inner, |r| back.turn.shear(r) - slip(r));
            assert_relative_eq!(-whole - 2.0 * ring + core, back.tangential_load, epsilon = 1e-11);
        }
    }

    #[test]
    fn the_edge_slips_back_at_once() {
        let back = taken_back(0.8, 0.9);
        let (a, c) = (back.turn.normal.contact_radius(), back.stick_radius());
        let friction = |r| back.turn.friction * back.turn.normal.pressure(r);
        assert_relative_eq!(back.shear(0.5 * (a + c)), -friction(0.5 * (a + c)), max_relative = 1e-15);
        assert!(back.turn.stick_radius() < c);
        assert!(back.shear(0.99 * c).abs() < friction(0.99 * c));
    }

    #[test]
    fn the_way_back_starts_at_the_turn_with_the_stiffness_of_full_stick() {
        let turn = pushed(0.8);
        assert_eq!(taken_back(0.8, 1.0).displacement(), turn.displacement());
        for change in [1e-3, 1e-5] {
            let travel = turn.displacement() - taken_back(0.8, 1.0 - change).displacement();
            let stiffness = 2.0 * turn.normal.contact_radius() * turn.tangential_modulus;
            assert_relative_eq!(change * turn.tangential_load / travel, stiffness, max_relative = change);
        }
    }

    #[test]
    fn the_full_way_back_is_a_push_the_other_way() {
        let (turn, back) = (pushed(0.8), taken_back(0.8, -1.0));
        assert_relative_eq!(back.displacement(), -turn.displacement(), max_relative = 1e-15);
        for r in [0.0, 0.5, 1.0, 1.5] {
            assert_relative_eq!(back.shear(r), -turn.shear(r), max_relative = 1e-14);
        }
    }

    #[test]
    fn the_cycle_costs_the_area_of_its_loop() {
        for share in [0.1, 0.8, 1.0] {
            // Reloading is unloading with the signs changed, so the loop is ∫ [δ(Q) + δ(−Q)] dQ over −Q* …
            // Q*.
            let width =
                |to: f64| taken_back(share, to).displacement() + taken_back(share, -to).displacement();
            let area = pushed(share).tangential_load * 2.0 * integrate(0.0, 1.0, width);
            assert_relative_eq!(pushed(share).cycle_loss(), area, max_relative = 1e-6);
        }
        let small = pushed(1e-2);
        let cube = small.tangential_load.powi(3) / (0.3 * 7.0);
        let stiffness = 9.0 * small.normal.contact_radius() * small.tangential_modulus;
        assert_relative_eq!(small.cycle_loss(), cube / stiffness, max_relative = 2e-2);
    }

    #[test]
    fn rubber_is_two_thirds_as_stiff_sideways() {
        let rubber = Material::elastic(3.0, 0.5).unwrap();
        let normal = crate::material::composite_modulus(&rubber, &rubber).unwrap();
        assert_relative_eq!(tangential_modulus(&rubber, &rubber), normal * 2.0 / 3.0, max_relative = 1e-15);
    }
}

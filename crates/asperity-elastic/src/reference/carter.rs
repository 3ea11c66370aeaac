//! Carter: a driven wheel.

use crate::reference::HertzLine;
use crate::units::{Metre, Pascal};

/// Steady tractive rolling of elastically identical parallel cylinders in plane strain.
///
/// The surfaces enter the contact at x = a, stick at first, and slip towards the trailing edge x = −a. With
/// the normal and the tangential load per length, P′ and Q′:
///
/// ```text
/// c = a √(1 − Q′/μP′),  d = a − c                                half width and centre of the stick zone
/// q = μ p₀ [√(1 − x²/a²) − (c/a) √(1 − (x − d)²/c²)₊]            shear traction, along Q′
/// ξ = μ d/R                                                      creepage
/// ```
/// Relative to the other body, the one on which Q′ acts along x moves along −x, at ξ times the rolling speed.
/// Carter, Proc. R. Soc. A 112, 151 (1926); Johnson (1985), section 8.3.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Carter {
    /// The normal contact.
    pub normal: HertzLine,
    /// Coefficient of friction μ > 0.
    pub friction: f64,
    /// Tangential load Q′ per length of the line, 0 ≤ Q′ ≤ μP′, N/m.
    pub tangential_load_per_length: f64,
}

impl Carter {
    /// Creates the contact at creepage ξ ≥ 0: Q′ = μP′ [1 − (1 − ξR/μa)₊²]. The whole contact slips from ξ =
    /// μa/R on.
    pub fn from_creepage(normal: HertzLine, friction: f64, creepage: f64) -> Self {
        let stick = (1.0 - creepage * normal.radius / (friction * normal.half_width())).max(0.0);
        let load = friction * normal.load_per_length * (1.0 - stick) * (1.0 + stick);
        Self { normal, friction, tangential_load_per_length: load }
    }

    /// Half width c of the stick zone.
    pub fn stick_half_width(&self) -> Metre {
        let reserve = 1.0 - self.tangential_load_per_length / (self.friction * self.normal.load_per_length);
        self.normal.half_width() * reserve.sqrt()
    }

    /// Centre d = a − c of the stick zone, which extends from a − 2c to the leading edge a.
    pub fn stick_centre(&self) -> Metre {
        self.normal.half_width() - self.stick_half_width()
    }

    /// Creepage ξ: difference of the circumferential speeds over the rolling speed, at most μa/R.
    pub fn creepage(&self) -> f64 {
        self.friction * self.stick_centre() / self.normal.radius
    }

    /// Shear traction q at `x`, in the direction of Q′; 0 outside the contact.
    pub fn shear(&self, x: Metre) -> Pascal {
        let (a, c) = (self.normal.half_width(), self.stick_half_width());
        // The pressure of a cylinder with half width c is (c/a) √(1 − x²/c²) p₀.
        let stick =
            HertzLine { load_per_length: self.normal.load_per_length * (c / a).powi(2), ..self.normal };
        self.friction * (self.normal.pressure(x) - stick.pressure(x - self.stick_centre()))
    }
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::integrate_to_edge;
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::PI;

    const LINE: HertzLine = HertzLine { radius: 3.0, modulus: 2.0, load_per_length: 0.7 };

    fn driven(share: f64) -> Carter {
        Carter { normal: LINE, friction: 0.3, tangential_load_per_length: share * 0.3 * LINE.load_per_length }
    }

    /// ∫ f over the contact, with square roots at the edges of the contact and of the stick zone.
    fn over_contact(contact: &Carter, f: impl Fn(f64) -> f64) -> f64 {
        let a = contact.normal.half_width();
        let edge = a - 2.0 * contact.stick_half_width();
        let piece = |lo: f64, hi: f64| {
            let (middle, half) = (0.5 * (lo + hi), 0.5 * (hi - lo));
            integrate_to_edge(half, |s| f(middle - s) + f(middle + s))
        };
        piece(-a, edge) + piece(edge, a)
    }

    /// du/dx = −(2/πE*) ∫ q(s)/(x − s) ds, regularised with q(x): Flamant's solution for a half-plane.
    fn strain(contact: &Carter, x: f64) -> f64 {
        let (a, here) = (contact.normal.half_width(), contact.shear(x));
        let regular = over_contact(contact, |s| (contact.shear(s) - here) / (x - s));
        -2.0 / (PI * contact.normal.modulus) * (regular + here * ((a + x) / (a - x)).ln())
    }

    #[test]
    fn the_shear_carries_the_tangential_load() {
        for share in [0.1, 0.6, 0.99] {
            let contact = driven(share);
            let load = over_contact(&contact, |x| contact.shear(x));
            assert_relative_eq!(load, contact.tangential_load_per_length, max_relative = 1e-10);
        }
    }

    #[test]
    fn what_sticks_is_strained_by_the_creepage() {
        let contact = driven(0.6);
        let (c, d) = (contact.stick_half_width(), contact.stick_centre());
        for x in [d - 0.9 * c, d, d + 0.4 * c, d + 0.95 * c] {
            assert_relative_eq!(strain(&contact, x), -contact.creepage(), max_relative = 1e-5);
        }
    }

    #[test]
    fn what_slips_moves_against_the_shear() {
        // Rolling along x at speed V transports the surface along −x: slip/V = −ξ − du/dx.
        let contact = driven(0.6);
        let (a, c) = (contact.normal.half_width(), contact.stick_half_width());
        let mut last = 0.0;
        for share in [0.2, 0.5, 0.9] {
            let x = a - 2.0 * c - share * 2.0 * (a - c);
            let slip = -contact.creepage() - strain(&contact, x);
            assert_eq!(contact.shear(x), contact.friction * contact.normal.pressure(x));
            assert!(slip < last, "slip {slip} after {last}");
            last = slip;
        }
    }

    #[test]
    fn the_creepage_and_the_load_are_each_others_inverse() {
        for share in [1e-6, 0.3, 0.9, 1.0] {
            let contact = driven(share);
            let again = Carter::from_creepage(LINE, 0.3, contact.creepage());
            assert_relative_eq!(
                again.tangential_load_per_length,
                contact.tangential_load_per_length,
                max_relative = 1e-9
            );
        }
    }

    #[test]
    fn a_large_creepage_is_full_slip() {
        let a = LINE.half_width();
        let sliding = Carter::from_creepage(LINE, 0.3, 1.7 * 0.3 * a / LINE.radius);
        assert_eq!(sliding.tangential_load_per_length, 0.3 * LINE.load_per_length);
        assert_eq!(sliding.shear(0.9 * a), 0.3 * LINE.pressure(0.9 * a));
        assert_eq!(sliding.creepage(), 0.3 * a / LINE.radius);
    }

    #[test]
    fn a_small_creepage_meets_the_stiffness_of_full_stick() {
        // Q′ = (π/2) a E* ξ, Johnson (1985), section 8.3, without μ.
        for creepage in [1e-3, 1e-5] {
            let contact = Carter::from_creepage(LINE, 0.3, creepage);
            let stiffness = contact.tangential_load_per_length / creepage;
            let slack = creepage * LINE.radius / (0.3 * LINE.half_width());
            assert_relative_eq!(stiffness, 0.5 * PI * LINE.half_width() * LINE.modulus, max_relative = slack);
        }
    }

    #[test]
    fn the_stick_ends_at_the_leading_edge() {
        let contact = driven(0.6);
        assert_eq!(contact.stick_centre() + contact.stick_half_width(), LINE.half_width());
        assert!(contact.shear(0.9 * LINE.half_width()) < 0.3 * LINE.pressure(0.9 * LINE.half_width()));
    }
}

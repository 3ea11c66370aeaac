//! Spence: the stick area in an indentation.
//!
//! Dissimilar bodies pressed together under a growing load stick in the middle and slip in an annulus at the
//! edge. The stick ratio s = c/a depends on the friction μ and Dundurs' β = E*/G* alone. It is the same for a
//! flat punch and for any power-law indenter. With 1/G* = (1 + ν₁)(1 − 2ν₁)/2E₁ − (1 + ν₂)(1 − 2ν₂)/2E₂, a
//! lower body with β > 0 moves inward in the annulus, and the shear on it acts outward. β < 0 reverses both.
//!
//! The formulas are Goodman's, without the effect of the shear on the pressure. They overestimate the stick
//! ratio by at most 0.44 β² for small β and 0.49 β² at β = ½. The friction required for a given s is
//! underestimated by 0.5–0.7 β² of it for s ≤ 0.5, and by 0.8–1.2 β² at s = 0.9. [`COUPLED`] contains fully
//! coupled solutions; the program that computed them also gave these bounds.
//!
//! Goodman, J. Appl. Mech. 29, 515 (1962); Spence, Proc. R. Soc. A 305, 55 (1968); J. Elasticity 5, 297
//! (1975).

use crate::math::elliptic::CompleteElliptic;

/// Stick ratio s of a round contact, 0 ≤ s ≤ 1, for μ ≥ 0 and |β| < 1.
///
/// (1/2s) ln((1 + s)/(1 − s)) = (μ/|β|) K(√(1 − s²)).  s → 4 exp(−|β|/μ) for small μ/|β|, 1 − s → 2
/// exp(−πμ/|β|) for large; s = 1 if β = 0. Solved to round-off; values below 1e-130 count as 0.
pub fn stick_ratio(friction: f64, dundurs: f64) -> f64 {
    solve(friction, dundurs, |s, rest| libm::asinh(s / rest) / (s * CompleteElliptic::of_complement(s).first))
}

/// Stick ratio s of a long contact in plane strain, like [`stick_ratio`].
///
/// K(s)/K(√(1 − s²)) = μ/|β|.  s → 4 exp(−π|β|/2μ) for small μ/|β|, 1 − s → 8 exp(−πμ/|β|) for large.
pub fn stick_ratio_plane(friction: f64, dundurs: f64) -> f64 {
    solve(friction, dundurs, |s, rest| {
        CompleteElliptic::of_complement(rest).first / CompleteElliptic::of_complement(s).first
    })
}

/// A flat circular punch with slip at its edge, including the effect of the shear on the pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoupledPunch {
    /// Dundurs' β.
    pub dundurs: f64,
    /// Coefficient of friction μ.
    pub friction: f64,
    /// Stick ratio c/a, to 2e-6.
    pub stick_ratio: f64,
    /// Load over that without friction at the same approach, W/2aE*δ, to 5e-6.
    pub stiffening: f64,
}

/// Stick ratio and load of the flat punch with full coupling, computed by an independent axisymmetric
/// program.
///
/// The program expresses p and q by densities φ and ψ on 0 … a, their Abel transforms, and solves the pair of
/// singular equations on graded meshes of 200 to 800 elements. 400 rings of constant pressure agree to one
/// ring.
pub const COUPLED: [CoupledPunch; 16] = [
    CoupledPunch { dundurs: 0.1, friction: 0.05, stick_ratio: 0.480_825, stiffening: 1.001_786 },
    CoupledPunch { dundurs: 0.1, friction: 0.1, stick_ratio: 0.901_006, stiffening: 1.002_874 },
    CoupledPunch { dundurs: 0.1, friction: 0.2, stick_ratio: 0.995_764, stiffening: 1.003_318 },
    CoupledPunch { dundurs: 0.2, friction: 0.05, stick_ratio: 0.067_685, stiffening: 1.003_631 },
    CoupledPunch { dundurs: 0.2, friction: 0.1, stick_ratio: 0.467_743, stiffening: 1.007_145 },
    CoupledPunch { dundurs: 0.2, friction: 0.2, stick_ratio: 0.892_371, stiffening: 1.011_564 },
    CoupledPunch { dundurs: 0.2, friction: 0.4, stick_ratio: 0.994_137, stiffening: 1.013_466 },
    CoupledPunch { dundurs: 0.3, friction: 0.1, stick_ratio: 0.170_936, stiffening: 1.010_870 },
    CoupledPunch { dundurs: 0.3, friction: 0.2, stick_ratio: 0.661_616, stiffening: 1.020_503 },
    CoupledPunch { dundurs: 0.3, friction: 0.4, stick_ratio: 0.951_657, stiffening: 1.029_071 },
    CoupledPunch { dundurs: 0.4, friction: 0.1, stick_ratio: 0.052_396, stiffening: 1.014_490 },
    CoupledPunch { dundurs: 0.4, friction: 0.2, stick_ratio: 0.412_811, stiffening: 1.028_545 },
    CoupledPunch { dundurs: 0.4, friction: 0.4, stick_ratio: 0.851_337, stiffening: 1.047_258 },
    CoupledPunch { dundurs: 0.5, friction: 0.1, stick_ratio: 0.013_417, stiffening: 1.018_098 },
    CoupledPunch { dundurs: 0.5, friction: 0.2, stick_ratio: 0.220_856, stiffening: 1.035_950 },
    CoupledPunch { dundurs: 0.5, friction: 0.4, stick_ratio: 0.698_178, stiffening: 1.065_465 },
];

/// Returns the s at which `ratio(s, √(1 − s²))`, which increases with s from 0 to infinity, is μ/|β|, by
/// bisection of ln s/√(1 − s²).
fn solve(friction: f64, dundurs: f64, ratio: impl Fn(f64, f64) -> f64) -> f64 {
    let wanted = friction / dundurs.abs();
    if dundurs == 0.0 || friction == 0.0 {
        return if dundurs == 0.0 { 1.0 } else { 0.0 };
    }
    let of = |log: f64| (1.0 / (1.0 + (-2.0 * log).exp()).sqrt(), 1.0 / (1.0 + (2.0 * log).exp()).sqrt());
    let (mut low, mut high) = (-300.0, 300.0);
    loop {
        let middle = 0.5 * (low + high);
        let (s, rest) = of(middle);
        if !(low < middle && middle < high) {
            return if low == -300.0 { 0.0 } else { s };
        }
        if ratio(s, rest) < wanted { low = middle } else { high = middle }
    }
}

#[cfg(test)]
mod tests {
    use super::super::StickingPunch;
    use super::super::quadrature::{integrate, integrate_to_edge};
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::{FRAC_PI_2, PI};

    const PAIRS: [(f64, f64); 3] = [(0.1, 0.3), (0.2, 0.3), (0.3, 0.2)];

    /// Shear under a punch with a = 1, p = 1/√(1 − r²), that slips from `s` on. It is μp, minus the part that
    /// compensates the slip in the stick zone, −(2/πr) ∫ (μD(√(1 − t²)) − β/(1 − t²)) t dt/√(t² − r²) over r
    /// … s.
    fn shear(friction: f64, dundurs: f64, s: f64, r: f64) -> f64 {
        let slope = |square: f64| {
            let difference = CompleteElliptic::of_complement(square.sqrt()).difference;
            friction * difference - dundurs / (1.0 - square)
        };
        let slip = friction / ((1.0 - r) * (1.0 + r)).sqrt();
        if r >= s {
            return slip;
        }
        let end = ((s - r) * (s + r)).sqrt();
        slip + 2.0 / (PI * r) * integrate(0.0, end, |v| slope(r * r + v * v))
    }

    /// ½E*u_r at `r`: (∫ q(t) t ∫ J₁(kr) J₁(kt) dk dt) − (β/r) ∫ p t dt over 0 … r.
    fn sideways(friction: f64, dundurs: f64, s: f64, r: f64) -> f64 {
        let ring = |t: f64| {
            let (near, far) = (r.min(t), r.max(t));
            let complement = ((far - near) * (far + near)).sqrt() / far;
            2.0 / PI * near / (far * far) * CompleteElliptic::of_complement(complement).difference
        };
        let push = |t: f64| shear(friction, dundurs, s, t) * t * ring(t);
        let piece = |lo: f64, hi: f64| {
            let (middle, half) = (0.5 * (lo + hi), 0.5 * (hi - lo));
            integrate_to_edge(half, |x| push(middle - x) + push(middle + x))
        };
        let parts = [0.0, r.min(s), r.max(s), 1.0];
        let sheared: f64 = parts.windows(2).map(|w| piece(w[0], w[1])).sum();
        sheared - dundurs / r * (1.0 - ((1.0 - r) * (1.0 + r)).sqrt())
    }

    #[test]
    fn what_sticks_stays_and_what_slips_goes_against_the_shear() {
        for (friction, dundurs) in PAIRS {
            let s = stick_ratio(friction, dundurs);
            let free = dundurs * (1.0 - (1.0 - s * s).sqrt()) / s;
            for share in [0.2, 0.6, 0.95] {
                assert_relative_eq!(sideways(friction, dundurs, s, share * s), 0.0, epsilon = 1e-5 * free);
            }
            let mut last = 0.0;
            for share in [0.2, 0.5, 0.9] {
                let slip = sideways(friction, dundurs, s, s + share * (1.0 - s));
                assert!(slip < last, "slip {slip} after {last}");
                last = slip;
            }
        }
    }

    #[test]
    fn the_stick_bears_less_than_the_friction_and_as_much_at_its_edge() {
        for (friction, dundurs) in PAIRS {
            let s = stick_ratio(friction, dundurs);
            let share = |r: f64| shear(friction, dundurs, s, r) * (1.0 - r * r).sqrt() / friction;
            assert!(share(0.5 * s) < share(0.9 * s) && share(0.9 * s) < 1.0);
            assert_relative_eq!(share(s * (1.0 - 1e-8)), 1.0, max_relative = 1e-3);
        }
    }

    #[test]
    fn the_strip_meets_carlemans_condition() {
        // Bounded at the edge of the stick zone: ∫ [β − (2μ/π) acosh(1/x)]/√((1 − x²)(s² − x²)) dx = 0 over 0
        // … s.
        for (friction, dundurs) in PAIRS {
            let s = stick_ratio_plane(friction, dundurs);
            let sum = integrate_to_edge(s, |x| {
                let excess = dundurs - friction / FRAC_PI_2 * libm::acosh(1.0 / x);
                excess / ((1.0 - x * x) * (s - x) * (s + x)).sqrt()
            });
            assert_relative_eq!(sum, 0.0, epsilon = 1e-7 * dundurs);
        }
    }

    #[test]
    fn little_friction_lets_almost_all_slip() {
        for ratio in [0.2_f64, 0.1] {
            let s = stick_ratio(0.3 * ratio, 0.3);
            assert_relative_eq!(s, 4.0 * (-1.0 / ratio).exp(), max_relative = 2.0 * s * s / ratio);
            let s = stick_ratio_plane(0.3 * ratio, -0.3);
            assert_relative_eq!(s, 4.0 * (-FRAC_PI_2 / ratio).exp(), max_relative = 2.0 * s * s / ratio);
        }
        assert_eq!(
            (stick_ratio(0.0, 0.3), stick_ratio(1e-4, 0.3), stick_ratio_plane(1e-4, 0.3)),
            (0.0, 0.0, 0.0)
        );
    }

    #[test]
    fn much_friction_lets_almost_nothing_slip() {
        for ratio in [3.0, 5.0] {
            let decay = (-PI * ratio).exp();
            let slack = 20.0 * ratio * decay;
            assert_relative_eq!(1.0 - stick_ratio(0.1 * ratio, 0.1), 2.0 * decay, max_relative = slack);
            assert_relative_eq!(1.0 - stick_ratio_plane(0.1 * ratio, 0.1), 8.0 * decay, max_relative = slack);
        }
        assert_eq!((stick_ratio(0.3, 0.0), stick_ratio_plane(0.0, 0.0)), (1.0, 1.0));
    }

    #[test]
    fn goodman_lets_a_little_too_much_stick() {
        for punch in COUPLED {
            let excess = stick_ratio(punch.friction, punch.dundurs) - punch.stick_ratio;
            let bound = 0.5 * punch.dundurs * punch.dundurs;
            assert!(0.0 < excess && excess < bound, "{punch:?}: {excess:e}, bound {bound:e}");
        }
    }

    #[test]
    fn the_punch_stiffens_with_friction_up_to_full_stick() {
        for pair in COUPLED.windows(2).filter(|pair| pair[0].dundurs == pair[1].dundurs) {
            let stuck = StickingPunch::from_approach(1.0, 0.5, pair[1].dundurs, 1.0).load;
            assert!(1.0 < pair[0].stiffening && pair[0].stiffening < pair[1].stiffening, "{pair:?}");
            assert!(pair[0].stick_ratio < pair[1].stick_ratio && pair[1].stiffening < stuck, "{pair:?}");
        }
    }
}

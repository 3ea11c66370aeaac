//! Growth of the yield stress with plastic strain.

use crate::error::{Result, check, check_in};
use crate::units::{Dimension, Pascal};

/// Yield stress in tension as a function of the accumulated plastic strain: linear between points, then
/// constant or with a given slope.
#[derive(Debug, Clone, PartialEq)]
pub struct Hardening {
    /// Accumulated plastic strain, increasing from 0; yield stress, not decreasing.
    points: Vec<(f64, Pascal)>,
    /// Slope beyond the last point.
    slope: Pascal,
}

impl Hardening {
    /// Creates a constant yield stress.
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] if it is not positive and finite.
    pub fn perfect(yield_stress: Pascal) -> Result<Self> {
        Self::linear(yield_stress, 0.0)
    }

    /// Creates a yield stress with the slope `modulus` dσY/dp̄ ≥ 0, which is E·Et/(E − Et) for a tangent
    /// modulus Et.
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] if the yield stress is not positive, the modulus negative, or one of them
    /// not finite.
    pub fn linear(yield_stress: Pascal, modulus: Pascal) -> Result<Self> {
        check_yield_stress(yield_stress)?;
        let good = modulus >= 0.0 && modulus.is_finite();
        check_in(Dimension::Pressure, "hardening", modulus, good, "a finite modulus of at least 0")?;
        Ok(Self { points: vec![(0.0, yield_stress)], slope: modulus })
    }

    /// Creates a measured `curve` of accumulated plastic strain, from 0, and stress; constant beyond the last
    /// point.
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] if there is no point, if the strain does not begin at 0 and increase, or
    /// if the stress is not positive or decreases.
    pub fn curve(curve: &[(f64, Pascal)]) -> Result<Self> {
        check("points of the curve", curve.len() as f64, !curve.is_empty(), "at least one point")?;
        check(
            "first plastic strain",
            curve[0].0,
            curve[0].0 == 0.0,
            "a curve that begins with plastic strain 0",
        )?;
        check_yield_stress(curve[0].1)?;
        for pair in curve.windows(2) {
            let [(e0, s0), (e1, s1)] = [pair[0], pair[1]];
            check(
                "plastic strain",
                e1,
                e1 > e0 && e1.is_finite(),
                "a plastic strain above the one before it",
            )?;
            let good = s1 >= s0 && s1.is_finite();
            check_in(Dimension::Pressure, "stress", s1, good, "a stress not below the one before it")?;
        }
        Ok(Self { points: curve.to_vec(), slope: 0.0 })
    }

    /// Yield stress of virgin material.
    pub fn initial(&self) -> Pascal {
        self.points[0].1
    }

    /// Yield stress at an accumulated plastic strain ≥ 0.
    pub fn yield_stress(&self, accumulated: f64) -> Pascal {
        let (from, slope, _) = self.piece(accumulated);
        from.1 + slope * (accumulated - from.0)
    }

    /// Returns the start point, slope and end of the linear piece that contains `accumulated`.
    fn piece(&self, accumulated: f64) -> ((f64, Pascal), Pascal, f64) {
        let next = self.points.partition_point(|(strain, _)| *strain <= accumulated).max(1);
        let from = self.points[next - 1];
        match self.points.get(next) {
            Some(to) => (from, (to.1 - from.1) / (to.0 - from.0), to.0),
            None => (from, self.slope, f64::INFINITY),
        }
    }

    /// Returns the Δp̄ ≥ 0 for which `excess` − `stiffness` Δp̄ equals the growth of the yield stress from
    /// the `accumulated` strain: excess = ξe − σY(p̄₀) > 0.
    pub(super) fn flow(&self, accumulated: f64, excess: Pascal, stiffness: Pascal) -> f64 {
        let (mut from, mut left) = (accumulated, excess);
        loop {
            let (_, slope, end) = self.piece(from);
            let step = left / (stiffness + slope);
            if from + step <= end {
                return from - accumulated + step;
            }
            left -= (stiffness + slope) * (end - from);
            from = end;
        }
    }

    /// Slope of the yield stress at an accumulated plastic strain, to its right.
    pub(super) fn slope(&self, accumulated: f64) -> Pascal {
        self.piece(accumulated).1
    }
}

fn check_yield_stress(yield_stress: Pascal) -> Result<()> {
    let good = yield_stress > 0.0 && yield_stress.is_finite();
    check_in(Dimension::Pressure, "yield_stress", yield_stress, good, "a finite yield stress above 0")
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_curve_is_straight_between_its_points_and_level_beyond_the_last() {
        let curve = Hardening::curve(&[(0.0, 100.0), (0.01, 120.0), (0.05, 130.0)]).unwrap();
        for (strain, stress) in
            [(0.0, 100.0), (0.005, 110.0), (0.01, 120.0), (0.03, 125.0), (0.05, 130.0), (9.0, 130.0)]
        {
            assert_relative_eq!(curve.yield_stress(strain), stress, max_relative = 1e-15);
        }
        assert_eq!(Hardening::linear(3.0, 5.0).unwrap().yield_stress(2.0), 13.0);
    }

    #[test]
    fn flow_ends_where_the_yield_stress_has_caught_up_whatever_pieces_lie_between() {
        let curve = Hardening::curve(&[(0.0, 100.0), (0.01, 120.0), (0.05, 120.0), (0.06, 150.0)]).unwrap();
        for accumulated in [0.0, 0.004, 0.01, 0.02, 0.055, 0.06, 1.0] {
            for excess in [1e-9, 1.0, 30.0, 200.0] {
                let stiffness = 700.0;
                let flow = curve.flow(accumulated, excess, stiffness);
                let grown = curve.yield_stress(accumulated + flow) - curve.yield_stress(accumulated);
                assert!(flow > 0.0);
                assert_relative_eq!(excess - stiffness * flow, grown, epsilon = 1e-12 * (excess + 100.0));
            }
        }
    }

    #[test]
    fn curves_without_meaning_are_refused() {
        for curve in [
            &[][..],
            &[(0.1, 1.0)],
            &[(0.0, 0.0)],
            &[(0.0, 1.0), (0.0, 2.0)],
            &[(0.0, 2.0), (0.1, 1.0)],
            &[(0.0, 1.0), (f64::NAN, 1.0)],
            &[(0.0, 1.0), (0.1, f64::INFINITY)],
        ] {
            assert!(Hardening::curve(curve).is_err(), "{curve:?}");
        }
        assert!(Hardening::linear(1.0, -1.0).is_err() && Hardening::perfect(f64::NAN).is_err());
    }
}

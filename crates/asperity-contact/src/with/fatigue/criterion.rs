//! Dang Van's criterion of fatigue.

use super::ball::Point;
use crate::error::{Result, check_in};
use crate::units::{Dimension, Pascal};

/// Limits of a material under alternating loads, above which it fails in the end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DangVan {
    torsion: Pascal,
    tension: Pascal,
}

impl DangVan {
    /// Creates the criterion of a material from its limits of alternating `torsion` and `tension`:
    /// amplitudes.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) unless both are above 0 and the tension is at most
    /// twice the torsion.
    pub fn new(torsion: Pascal, tension: Pascal) -> Result<Self> {
        let is_limit = torsion > 0.0 && torsion.is_finite();
        check_in(Dimension::Pressure, "torsion", torsion, is_limit, "a limit above 0")?;
        let is_limit = tension > 0.0 && tension <= 2.0 * torsion;
        check_in(
            Dimension::Pressure,
            "tension",
            tension,
            is_limit,
            "above 0, and at most twice the limit in torsion",
        )?;
        Ok(Self { torsion, tension })
    }

    /// Weight a of the hydrostatic stress: 3τ₋₁/σ₋₁ − 3/2, ≥ 0.
    pub fn weight(&self) -> f64 {
        3.0 * self.torsion / self.tension - 1.5
    }

    /// The limit b of f: that in torsion.
    pub fn limit(&self) -> Pascal {
        self.torsion
    }
}

/// Returns half the difference of the extreme principal values of a deviator.
pub(super) fn max_shear(deviator: &Point) -> Pascal {
    const ROOT: f64 = std::f64::consts::SQRT_2;
    let zz = deviator[1] / 1.5f64.sqrt();
    let (xx, yy) = (deviator[0] / ROOT - 0.5 * zz, -deviator[0] / ROOT - 0.5 * zz);
    let [xy, yz, xz] = [deviator[2] / ROOT, deviator[3] / ROOT, deviator[4] / ROOT];
    let j2 = 0.5 * deviator.iter().map(|s| s * s).sum::<f64>();
    let radius = (j2 / 3.0).sqrt();
    if radius == 0.0 {
        return 0.0;
    }
    let det = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    // Principal values are 2r cos θ, and that with θ less and more by a third of a turn.
    let theta = (0.5 * det / radius.powi(3)).clamp(-1.0, 1.0).acos() / 3.0;
    // Half of the largest less the least: √3 r sin(θ + π/3).
    3f64.sqrt() * radius * (theta + std::f64::consts::FRAC_PI_3).sin()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::Stress;

    #[test]
    fn the_largest_shear_of_a_deviator_is_that_of_its_principal_stresses() {
        for components in [
            [3.0, -1.0, 2.0, 0.5, -0.7, 1.1],
            [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 2.0, 0.0],
            [-1.0, -1.0, 5.0, 0.0, 0.0, 0.0],
            [2.0; 6],
        ] {
            let stress = Stress::from_components(components);
            let (deviator, mean) = stress.split();
            // Where two principal values coincide, the angle has half of the digits.
            assert!((max_shear(&deviator) - stress.max_shear()).abs() < 1e-8, "{components:?}");
            assert!((mean - components[..3].iter().sum::<f64>() / 3.0).abs() < 1e-15);
            let square: f64 = deviator.iter().map(|s| s * s).sum();
            assert!((square - 2.0 / 3.0 * stress.von_mises().powi(2)).abs() < 1e-12);
        }
    }

    #[test]
    fn limits_that_no_material_has_are_refused() {
        let steel = DangVan::new(350e6, 600e6).unwrap();
        assert!((steel.weight() - 0.25).abs() < 1e-12 && steel.limit() == 350e6);
        assert!(DangVan::new(350e6, 701e6).is_err() && DangVan::new(0.0, 1.0).is_err());
        assert_eq!(DangVan::new(350e6, 700e6).unwrap().weight(), 0.0);
    }
}

//! Height parameters, which describe the distribution of the heights.

use super::row::family;
use crate::Topography;

family! {
    /// Height parameters of ISO 25178-2:2021, 4.2, over the defined samples, with heights relative to their
    /// mean.
    ///
    /// NaN without a defined sample; `ssk` and `sku` also for a plane.
    HeightParameters: "height" {
        /// Arithmetical mean height, ⟨|z|⟩.
        sa: Length as "Sa",
        /// Root mean square height, √⟨z²⟩.
        sq: Length as "Sq",
        /// Skewness, ⟨z³⟩/Sq³; 0 for Gaussian heights.
        ssk: Number as "Ssk",
        /// Kurtosis, ⟨z⁴⟩/Sq⁴; 3 for Gaussian heights.
        sku: Number as "Sku",
        /// Maximum height, Sp + Sv.
        sz: Length as "Sz",
        /// Height of the highest peak above the mean.
        sp: Length as "Sp",
        /// Depth of the deepest pit below the mean, positive.
        sv: Length as "Sv",
    }
}

impl HeightParameters {
    /// Computes the height parameters of `topography`.
    pub fn new(topography: &Topography) -> Self {
        Self::from_samples(topography.heights())
    }

    /// Computes the height parameters of `samples`, NaN if undefined.
    pub(crate) fn from_samples<'a>(samples: impl IntoIterator<Item = &'a f64, IntoIter: Clone>) -> Self {
        let defined = samples.into_iter().filter(|z| !z.is_nan());
        let count = defined.clone().count() as f64;
        let mean = defined.clone().sum::<f64>() / count;
        let [mut absolute, mut second, mut third, mut fourth] = [0.0; 4];
        let (mut lowest, mut highest) = (f64::NAN, f64::NAN);
        for z in defined.map(|z| z - mean) {
            absolute += z.abs();
            second += z * z;
            third += z * z * z;
            fourth += z * z * z * z;
            lowest = z.min(lowest);
            highest = z.max(highest);
        }
        let sq = (second / count).sqrt();
        Self {
            sa: absolute / count,
            sq,
            ssk: third / count / sq.powi(3),
            sku: fourth / count / sq.powi(4),
            sz: highest - lowest,
            sp: highest,
            // For a plane 0, not −0.
            sv: 0.0 - lowest,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use approx::assert_relative_eq;

    use super::*;

    #[test]
    fn a_plane_is_as_deep_as_it_is_high() {
        let plane = HeightParameters::from_samples(&[3e-6; 4]);
        assert_eq!((plane.sp, plane.sv, plane.sz), (0.0, 0.0, 0.0));
        assert!(plane.sv.is_sign_positive());
    }
    use crate::Form;
    use asperity_base::grid::Grid;

    #[test]
    fn a_sinusoid_has_its_textbook_heights() {
        let grid = Grid::new([200, 20], [0.1, 0.1]).unwrap();
        let form = Form::Sinusoid { amplitude: 2.0, wavelength: [4.0, f64::INFINITY] };
        let parameters = HeightParameters::new(&form.on(&grid).unwrap());
        // The sum over the n = 40 samples of a wave replaces the integral of |cos|: relative error π²/3n².
        assert_relative_eq!(parameters.sa, 4.0 / PI, max_relative = (PI / 40.0).powi(2));
        assert_relative_eq!(parameters.sq, 2.0 / 2f64.sqrt(), max_relative = 1e-13);
        assert!(parameters.ssk.abs() < 1e-12);
        assert_relative_eq!(parameters.sku, 1.5, max_relative = 1e-12);
        assert_relative_eq!(parameters.sz, 4.0, max_relative = (PI / 40.0).powi(2));
        assert_relative_eq!(parameters.sp + parameters.sv, parameters.sz, max_relative = 1e-14);
    }

    #[test]
    fn a_hemispherical_cap_is_skewed_downwards() {
        // z = −(x² + y²)/2R over a square of side 2a: the variance of x² is 4a⁴/45, so Sq² = 2 (4/45) a⁴/4R².
        let grid = Grid::new([400, 400], [0.005, 0.005]).unwrap();
        let parameters = HeightParameters::new(&Form::Sphere { radius: 1.0 }.on(&grid).unwrap());
        assert_relative_eq!(parameters.sq, (2.0 * 4.0 / 45.0 / 4.0f64).sqrt(), max_relative = 1e-4);
        assert!(parameters.ssk < 0.0 && parameters.sp < parameters.sv);
    }
}

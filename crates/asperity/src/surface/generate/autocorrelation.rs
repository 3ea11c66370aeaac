//! White noise filtered to a prescribed autocorrelation.

use serde::{Deserialize, Serialize};

use super::noise::{filtered_noise, shape_with_margin};
use super::{check_sq, one_or_two};
use crate::error::{Result, check};
use crate::grid::{Field, Grid};
use crate::math::RealFft2;
use crate::surface::Topography;
use crate::units::Metre;

/// Heights of exponential autocorrelation, R(x, y) = Sq² exp(−ln 10 √((x/βx)² + (y/βy)²)).
///
/// It falls to 10 % at the correlation lengths βx and βy: the definition of Hu & Tonder, Int. J. Mach. Tools
/// Manuf. 32, 83 (1992), whose exp(−2.3 …) this is; the length to 1/e is β/ln 10. The filter's response is
/// the square root of the wanted spectrum, the transform of R.
///
/// The noise field is three correlation lengths longer than the surface, which is cut out of it, so that it
/// is not periodic and its opposite edges are correlated by less than 10⁻³. Sq is exact for every surface; R
/// is so for the mean over seeds, up to the mean height and Sq of each surface, which are set: of the order
/// of βxβy/area.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Autocorrelation {
    /// Rms height, > 0.
    pub sq: Metre,
    /// Lengths βx and βy where the autocorrelation falls to 10 %, from a pitch to the length of the surface;
    /// read from one or two.
    #[serde(deserialize_with = "one_or_two")]
    pub correlation_length: [Metre; 2],
}

impl Autocorrelation {
    /// A topography on `grid`.
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] if a parameter has no meaning on this grid.
    pub fn generate(&self, grid: &Grid, seed: u64) -> Result<Topography> {
        check_sq(self.sq)?;
        for axis in 0..2 {
            let length = self.correlation_length[axis];
            // Lengths that differ from a limit by round-off alone are meant to equal it.
            let good =
                length >= grid.pitch[axis] * (1.0 - 1e-9) && length <= grid.extent()[axis] * (1.0 + 1e-9);
            check("correlation_length", length, good, "a length from one pitch to that of the surface")?;
        }
        let shape = shape_with_margin(grid, self.correlation_length.map(|length| 3.0 * length));
        let spectrum = self.spectrum(shape, grid.pitch);
        filtered_noise(grid, shape, seed, self.sq, |k, l| spectrum[[k, l]].sqrt())
    }

    /// Spectrum of the autocorrelation, of variance 1, on a period of `shape` samples.
    ///
    /// Where the period is short, its ends meet in a kink and give the spectrum slightly negative values: 0
    /// here.
    fn spectrum(&self, shape: [usize; 2], pitch: [Metre; 2]) -> Field {
        let distance = |axis: usize, index: usize| {
            index.min(shape[axis] - index) as f64 * pitch[axis] / self.correlation_length[axis]
        };
        let autocorrelation = Field::from_shape_fn(shape, |(i, j)| {
            (-std::f64::consts::LN_10 * distance(0, i).hypot(distance(1, j))).exp()
        });
        RealFft2::new(shape).forward(&autocorrelation).mapv(|value| value.re.max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::super::noise::tests::covariance;
    use super::*;
    use crate::surface::HeightParameters;

    #[test]
    fn it_falls_to_a_tenth_at_the_correlation_length_of_each_direction() {
        let grid = Grid::new([400, 600], [0.5, 0.25]).unwrap();
        let method = Autocorrelation { sq: 1.0, correlation_length: [6.0, 3.0] };
        let seeds = 12;
        let fields: Vec<Field> =
            (0..seeds).map(|seed| method.generate(&grid, seed).unwrap().into_heights()).collect();
        // Correlated area ∫ R² = 2π βx βy/(2 ln 10)² per independent spot.
        let spots = 200.0 * 150.0 * seeds as f64 * 4.605f64.powi(2) / (std::f64::consts::TAU * 6.0 * 3.0);
        for (lag, expected) in [
            ([12, 0], 0.1),
            ([0, 12], 0.1),
            ([6, 0], 0.1f64.sqrt()),
            ([0, 6], 0.1f64.sqrt()),
            ([1, 0], 0.1f64.powf(1.0 / 12.0)),
            ([9, 9], 0.1f64.powf(0.75 * 2f64.sqrt())),
            ([40, 0], 0.0),
        ] {
            let measured = fields.iter().map(|z| covariance(z, lag)).sum::<f64>() / seeds as f64;
            let tolerance = 4.0 / spots.sqrt() + 2.0 * seeds as f64 / spots;
            assert!((measured - expected).abs() < tolerance, "{lag:?}: {measured:.4}, not {expected:.4}");
        }
    }

    #[test]
    fn the_spectrum_holds_the_variance_asked_for() {
        // Its negative values, left out, are few even where the surface is no longer than the correlation.
        for (shape, limit) in [([256, 256], 2e-4), ([64, 64], 0.02)] {
            let method = Autocorrelation { sq: 1.0, correlation_length: [16.0, 16.0] };
            let half = method.spectrum(shape, [1.0; 2]);
            let weight = |l: usize| if l == 0 || 2 * l == shape[1] { 1.0 } else { 2.0 };
            let variance: f64 = half.indexed_iter().map(|((_, l), s)| weight(l) * s).sum();
            let excess = variance / (shape[0] * shape[1]) as f64 - 1.0;
            assert!((-1e-12..limit).contains(&excess), "{excess:e}");
        }
    }

    #[test]
    fn heights_are_gaussian() {
        let grid = Grid::new([512, 512], [1.0; 2]).unwrap();
        let method = Autocorrelation { sq: 1.0, correlation_length: [6.0; 2] };
        // Standard errors √6 and √24 per independent spot, 2πβ²/(2 ln 10)² and less for higher powers of R.
        let spots = 512.0 * 512.0 * 4.605f64.powi(2) / (std::f64::consts::TAU * 36.0);
        for seed in 0..4 {
            let parameters = HeightParameters::of(&method.generate(&grid, seed).unwrap());
            assert!(parameters.ssk.abs() < 4.0 * (6.0 / spots).sqrt(), "{}", parameters.ssk);
            assert!((parameters.sku - 3.0).abs() < 4.0 * (24.0 / spots).sqrt(), "{}", parameters.sku);
        }
    }
}

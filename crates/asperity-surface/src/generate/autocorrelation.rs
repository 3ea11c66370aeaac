//! White noise filtered to a prescribed autocorrelation.

use serde::Serialize;

use super::noise::{shape_with_margin, stationary};
use super::{HeightDistribution, check_sq};
use crate::Topography;
use asperity_base::choice::choice;
use asperity_base::error::{Result, check_in};
use asperity_base::exists;
use asperity_base::grid::{Field, Grid};
use asperity_base::math::fft::symmetric_transform;
use asperity_base::units::{Dimension, Metre};
use asperity_derive::Part;

/// Heights with a prescribed autocorrelation, Sq² R(s), which decreases to 10 % at the correlation lengths:
///
/// s = √((x/βx)² + (y/βy)²), R = exp(−ln 10 s) or exp(−ln 10 s²).
///
/// A lay rotates the axes of the ellipse s = 1 by its angle. A ground surface, for example, has a long
/// correlation along the lay and a short one across.
///
/// The lengths are defined as by Hu & Tonder, Int. J. Mach. Tools Manuf. 32, 83 (1992), whose exp(−2.3 …) the
/// exponential is. The length to 1/e is β/ln 10 for the exponential, β/√ln 10 for the Gaussian. The response
/// of the filter is the square root of the prescribed spectrum, which is the transform of R.
///
/// The noise field is three correlation lengths longer than the surface cut out of it. The surface is
/// therefore not periodic, and its opposite edges are correlated by less than 10⁻³. Sq is exact for every
/// surface. R is exact as the mean over seeds, apart from the effect of setting the mean height and Sq of
/// each surface, of the order of βxβy/area.
#[derive(Part, Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Autocorrelation {
    /// Rms height, exact.
    #[key(quantity = Length, range = AboveZero, example = "\"0.2 um\"", exists = exists::ROUGHNESS)]
    pub sq: Metre,
    /// Length over which the autocorrelation decays to 10 %, one value or two (along and across the lay),
    /// from one pitch to the length of the surface.
    ///
    /// Without a lay along x and y. The ellipse with these semi-axes extends beyond the neighbouring samples,
    /// but not beyond the length of the surface.
    #[key(quantity = Length, range = AboveZero, pair, example = "\"8 um\"", exists = exists::WAVE)]
    pub correlation_length: [Metre; 2],
    /// Decay of the autocorrelation: `"exponential"`, rough down to the smallest scale, or `"gaussian"`,
    /// smooth.
    #[key(choice, default = Decay::Exponential, example = "\"gaussian\"")]
    #[serde(skip_serializing_if = "Decay::is_exponential")]
    pub decay: Decay,
    /// Angle of the grooves, or of the first correlation length, from x towards y.
    #[key(quantity = Angle, default = 0.0, written = "0", example = "\"90 deg\"", exists = exists::ANGLE)]
    #[serde(skip_serializing_if = "is_along_x")]
    pub lay: f64,
    /// Skewness and kurtosis of the heights.
    #[key(part)]
    #[serde(flatten)]
    pub heights: HeightDistribution,
}

/// Shape of an autocorrelation over the distance.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Decay {
    /// R = exp(−ln 10 s): a surface with edges down to the smallest scale, such as a ground one (Whitehouse &
    /// Archard, Proc. R. Soc. A 316, 97 (1970)).
    #[default]
    Exponential,
    /// R = exp(−ln 10 s²): a smooth surface.
    Gaussian,
}

choice!(Decay: "exponential" => Exponential, "gaussian" => Gaussian);

impl Decay {
    fn is_exponential(&self) -> bool {
        *self == Self::Exponential
    }
}

fn is_along_x(lay: &f64) -> bool {
    *lay == 0.0
}

impl Autocorrelation {
    /// Creates Gaussian heights with an exponential autocorrelation and lengths along x and y.
    pub const fn new(sq: Metre, correlation_length: [Metre; 2]) -> Self {
        let heights = HeightDistribution::GAUSSIAN;
        Self { sq, correlation_length, decay: Decay::Exponential, lay: 0.0, heights }
    }

    /// Generates a topography on `grid`.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] if a parameter is invalid on this grid.
    pub fn generate(&self, grid: &Grid, seed: u64) -> Result<Topography> {
        let shape = self.shape(grid)?;
        stationary(grid, shape, seed, self.sq, self.heights, || self.spectrum(shape, grid.pitch))
    }

    /// Returns the shape of the noise that is filtered to a topography on `grid`, if every parameter is valid
    /// there.
    pub fn shape(&self, grid: &Grid) -> Result<[usize; 2]> {
        check_sq(self.sq)?;
        check_in(Dimension::Angle, "lay", self.lay, self.lay.is_finite(), "an angle")?;
        let (distance, reach) = (self.distance(), self.reach());
        let neighbours = [[grid.pitch[0], 0.0], [0.0, grid.pitch[1]]];
        for length in self.correlation_length {
            let good = length > 0.0 && length.is_finite();
            check_in(Dimension::Length, "correlation_length", length, good, "a length above 0")?;
        }
        for axis in 0..2 {
            // Lengths that differ from a limit only by round-off count as equal to it.
            let good =
                distance(neighbours[axis]) <= 1.0 + 1e-9 && reach[axis] <= grid.extent()[axis] * (1.0 + 1e-9);
            let length = self.correlation_length[axis];
            check_in(
                Dimension::Length,
                "correlation_length",
                length,
                good,
                "a length from one pitch to that of the surface",
            )?;
        }
        Ok(shape_with_margin(grid, reach.map(|length| 3.0 * length)))
    }

    /// Returns the spectrum of the autocorrelation, with variance 1, on a period of `shape` samples, in the
    /// layout of [`symmetric_transform`].
    ///
    /// On a short period the ends meet in a kink, which gives the spectrum slightly negative values; they are
    /// set to 0.
    fn spectrum(&self, shape @ [nx, ny]: [usize; 2], pitch: [Metre; 2]) -> Field {
        let covariance = self.covariance(shape, pitch);
        let half = Field::from_shape_fn([nx / 2 + 1, ny], |(i, j)| covariance(i, j));
        symmetric_transform(&half, shape).mapv_into(|value| value.max(0.0))
    }

    /// Returns the autocorrelation, with variance 1, of samples `[i, j]` apart on a period of `shape`, i at
    /// most half of it.
    pub fn covariance(&self, [_, ny]: [usize; 2], pitch: [Metre; 2]) -> impl Fn(usize, usize) -> f64 {
        let (distance, decay) = (self.distance(), self.decay);
        move |i, j| {
            let j = if 2 * j > ny { j as f64 - ny as f64 } else { j as f64 };
            let s = distance([i as f64 * pitch[0], j * pitch[1]]);
            let exponent = match decay {
                Decay::Exponential => s,
                Decay::Gaussian => s * s,
            };
            // Below round-off from here on.
            if exponent > 20.0 { 0.0 } else { (-std::f64::consts::LN_10 * exponent).exp() }
        }
    }

    /// Returns s for a step along x and y.
    fn distance(&self) -> impl Fn([Metre; 2]) -> f64 {
        let [along, across] = self.correlation_length;
        let (sin, cos) = self.lay.sin_cos();
        move |[x, y]| {
            let [a, b] = [(x * cos + y * sin) / along, (y * cos - x * sin) / across];
            (a * a + b * b).sqrt()
        }
    }

    /// Extent of the ellipse s = 1 along x and y.
    pub(super) fn reach(&self) -> [Metre; 2] {
        let [along, across] = self.correlation_length;
        let (sin, cos) = self.lay.sin_cos();
        [(along * cos).hypot(across * sin), (along * sin).hypot(across * cos)]
    }
}

#[cfg(test)]
mod tests {
    use super::super::noise::tests::covariance;
    use super::*;
    use crate::HeightParameters;

    #[test]
    fn it_falls_to_a_tenth_at_the_correlation_length_of_each_direction() {
        let grid = Grid::new([400, 600], [0.5, 0.25]).unwrap();
        let method = Autocorrelation::new(1.0, [6.0, 3.0]);
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
        // The omitted negative values are few even if the surface is no longer than the correlation.
        for (shape, limit) in [([256, 256], 2e-4), ([64, 64], 0.02)] {
            let method = Autocorrelation::new(1.0, [16.0; 2]);
            let half = method.spectrum(shape, [1.0; 2]);
            let weight = |l: usize| if l == 0 || 2 * l == shape[1] { 1.0 } else { 2.0 };
            let variance: f64 = half.indexed_iter().map(|((l, _), s)| weight(l) * s).sum();
            let excess = variance / (shape[0] * shape[1]) as f64 - 1.0;
            assert!((-1e-12..limit).contains(&excess), "{excess:e}");
        }
    }

    #[test]
    fn heights_are_gaussian() {
        let grid = Grid::new([512, 512], [1.0; 2]).unwrap();
        let method = Autocorrelation::new(1.0, [6.0; 2]);
        // Standard errors √6 and √24 per independent spot, 2πβ²/(2 ln 10)² and less for higher powers of R.
        let spots = 512.0 * 512.0 * 4.605f64.powi(2) / (std::f64::consts::TAU * 36.0);
        for seed in 0..4 {
            let parameters = HeightParameters::new(&method.generate(&grid, seed).unwrap());
            assert!(parameters.ssk.abs() < 4.0 * (6.0 / spots).sqrt(), "{}", parameters.ssk);
            assert!((parameters.sku - 3.0).abs() < 4.0 * (24.0 / spots).sqrt(), "{}", parameters.sku);
        }
    }
}

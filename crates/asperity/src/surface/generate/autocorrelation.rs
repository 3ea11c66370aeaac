//! White noise filtered to a prescribed autocorrelation.

use serde::Serialize;

use super::noise::{shape_with_margin, stationary};
use super::{HeightDistribution, check_sq};
use crate::choice::choice;
use crate::error::{Result, check_in};
use crate::grid::{Field, Grid};
use crate::math::fft::symmetric_transform;
use crate::surface::Topography;
use crate::units::{Dimension, Metre};

/// Heights of a prescribed autocorrelation, Sq² R(s), which falls to 10 % at the correlation lengths:
///
/// s = √((x/βx)² + (y/βy)²), R = exp(−ln 10 s) or exp(−ln 10 s²).
///
/// With a lay, the axes of the ellipse s = 1 are turned by its angle: so is a ground surface, with a long
/// correlation along the lay and a short one across.
///
/// The definition of the lengths is that of Hu & Tonder, Int. J. Mach. Tools Manuf. 32, 83 (1992), whose exp(−2.3 …)
/// the exponential is; its length to 1/e is β/ln 10, that of the Gaussian β/√ln 10. The filter's response is the
/// square root of the wanted spectrum, the transform of R.
///
/// The noise field is three correlation lengths longer than the surface, which is cut out of it, so that it
/// is not periodic and its opposite edges are correlated by less than 10⁻³. Sq is exact for every surface; R
/// is so for the mean over seeds, up to the mean height and Sq of each surface, which are set: of the order
/// of βxβy/area.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Autocorrelation {
    /// Rms height, > 0.
    pub sq: Metre,
    /// Lengths where the autocorrelation falls to 10 %, along and across the lay, which is along x and y without one;
    /// read from one or two. The ellipse of these semi-axes reaches beyond the neighbouring samples, but not beyond
    /// the length of the surface.
    pub correlation_length: [Metre; 2],
    /// How it falls.
    #[serde(skip_serializing_if = "Decay::is_exponential")]
    pub decay: Decay,
    /// Angle of the first length's direction against x, towards y, in radians.
    #[serde(skip_serializing_if = "is_along_x")]
    pub lay: f64,
    /// Skewness and kurtosis of the heights.
    #[serde(flatten)]
    pub heights: HeightDistribution,
}

/// How an autocorrelation falls with the distance.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Decay {
    /// R = exp(−ln 10 s): a surface with edges on the smallest scale, as of grinding (Whitehouse & Archard, Proc. R.
    /// Soc. A 316, 97 (1970)).
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
    /// Gaussian heights, an exponential autocorrelation, its lengths along x and y.
    pub const fn new(sq: Metre, correlation_length: [Metre; 2]) -> Self {
        let heights = HeightDistribution::GAUSSIAN;
        Self { sq, correlation_length, decay: Decay::Exponential, lay: 0.0, heights }
    }

    /// A topography on `grid`.
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] if a parameter has no meaning on this grid.
    pub fn generate(&self, grid: &Grid, seed: u64) -> Result<Topography> {
        let shape = self.shape(grid)?;
        stationary(grid, shape, seed, self.sq, self.heights, || self.spectrum(shape, grid.pitch))
    }

    /// The shape of the noise that is filtered to a topography on `grid`, if every parameter has a meaning there.
    pub(super) fn shape(&self, grid: &Grid) -> Result<[usize; 2]> {
        check_sq(self.sq)?;
        check_in(Dimension::Angle, "lay", self.lay, self.lay.is_finite(), "an angle")?;
        let (distance, reach) = (self.distance(), self.reach());
        let neighbours = [[grid.pitch[0], 0.0], [0.0, grid.pitch[1]]];
        for length in self.correlation_length {
            let good = length > 0.0 && length.is_finite();
            check_in(Dimension::Length, "correlation_length", length, good, "a length above 0")?;
        }
        for axis in 0..2 {
            // Lengths that differ from a limit by round-off alone are meant to equal it.
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

    /// Spectrum of the autocorrelation, of variance 1, on a period of `shape` samples, as [`symmetric_transform`] has
    /// it.
    ///
    /// Where the period is short, its ends meet in a kink and give the spectrum slightly negative values: 0
    /// here.
    fn spectrum(&self, shape @ [nx, ny]: [usize; 2], pitch: [Metre; 2]) -> Field {
        let covariance = self.covariance(shape, pitch);
        let half = Field::from_shape_fn([nx / 2 + 1, ny], |(i, j)| covariance(i, j));
        symmetric_transform(&half, shape).mapv_into(|value| value.max(0.0))
    }

    /// The autocorrelation, of variance 1, of samples `[i, j]` apart on a period of `shape`, i no more than half of it.
    pub(super) fn covariance(&self, [_, ny]: [usize; 2], pitch: [Metre; 2]) -> impl Fn(usize, usize) -> f64 {
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

    /// s of a step along x and y.
    fn distance(&self) -> impl Fn([Metre; 2]) -> f64 {
        let [along, across] = self.correlation_length;
        let (sin, cos) = self.lay.sin_cos();
        move |[x, y]| {
            let [a, b] = [(x * cos + y * sin) / along, (y * cos - x * sin) / across];
            (a * a + b * b).sqrt()
        }
    }

    /// How far the ellipse s = 1 extends along x and y.
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
    use crate::surface::HeightParameters;

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
        // Its negative values, left out, are few even where the surface is no longer than the correlation.
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
            let parameters = HeightParameters::of(&method.generate(&grid, seed).unwrap());
            assert!(parameters.ssk.abs() < 4.0 * (6.0 / spots).sqrt(), "{}", parameters.ssk);
            assert!((parameters.sku - 3.0).abs() < 4.0 * (24.0 / spots).sqrt(), "{}", parameters.sku);
        }
    }
}

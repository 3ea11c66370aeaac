//! White noise with a low-pass filter.

use std::ops::Range;

use serde::Serialize;

use super::noise::{shape_with_margin, stationary};
use super::{HeightDistribution, check_sq};
use crate::Topography;
use asperity_base::choice::choice;
use asperity_base::error::{Result, check_in};
use asperity_base::exists;
use asperity_base::grid::{Field, Grid};
use asperity_base::math::fft::angular_frequency;
use asperity_base::units::{Dimension, Metre};
use asperity_derive::Part;

/// White noise without the waves shorter than a cut-off: a constant spectrum inside the band, zero outside.
///
/// The circular filter of Hu & Tonder, Int. J. Mach. Tools Manuf. 32, 83 (1992), in samples:
///
/// h(k, l) = ωc J₁(ωc ρ)/2πρ, h(0, 0) = ωc²/4π, ρ = √(k² + l²), ωc = 2πΔx/λc
///
/// Its response is 1 for √(ωx² + ωy²) < ωc, else 0. It decreases only as ρ^(−3/2): truncated at n wavelengths
/// it loses the fraction 1/π²n of the variance and passes short waves. Here the whole filter is applied, by
/// its response, to a noise field four wavelengths longer than the surface. The surface is then cut out of it
/// and is not periodic: the correlation of its opposite edges, 2 J₁(8π)/8π, is below 0.013.
///
/// Non-Gaussian heights also contain waves shorter than the cut-off, because no curve preserves a sharp edge
/// of the spectrum. The measured fraction of the variance beyond the edge, and the increase of the slopes,
/// are 0.6 % and 1 % for Ssk = −0.5, Sku = 3.5. They are 2 %, 3 % for −1, 4.5, and 9 %, 14 % for −2, 8, and
/// 0.7 %, 1.5 % for 0, 2.2.
#[derive(Part, Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LowPass {
    /// Rms height, exact.
    #[key(quantity = Length, range = AboveZero, example = "\"0.2 um\"", exists = exists::ROUGHNESS)]
    pub sq: Metre,
    /// Shortest wavelength, from two pitches to the length of the surface.
    ///
    /// λx and λy.
    #[key(quantity = Length, range = AboveZero, pair, example = "\"8 um\"", exists = exists::WAVE)]
    pub cutoff: [Metre; 2],
    /// Shape of the pass band; `"elliptic"` is circular for one cut-off.
    #[key(choice, default = Band::Elliptic, example = "\"rectangular\"")]
    #[serde(skip_serializing_if = "Band::is_elliptic")]
    pub band: Band,
    /// Skewness and kurtosis of the heights.
    #[key(part)]
    #[serde(flatten)]
    pub heights: HeightDistribution,
}

/// Pass band of the waves, λ = (2π/ωx, 2π/ωy).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Band {
    /// (λx ωx)² + (λy ωy)² < 4π²: a circle for two equal cut-offs. The autocorrelation is 2 J₁(s)/s,
    /// s = 2π √((x/λx)² + (y/λy)²).
    #[default]
    Elliptic,
    /// λx |ωx| < 2π and λy |ωy| < 2π. The autocorrelation is sin s sin t/s t, s = 2πx/λx, t = 2πy/λy.
    Rectangular,
}

choice!(Band: "elliptic" => Elliptic, "rectangular" => Rectangular);

impl Band {
    fn is_elliptic(&self) -> bool {
        *self == Self::Elliptic
    }
}

impl LowPass {
    /// Creates Gaussian heights with an elliptic band, which is circular if both cut-offs are equal.
    pub const fn new(sq: Metre, cutoff: [Metre; 2]) -> Self {
        Self { sq, cutoff, band: Band::Elliptic, heights: HeightDistribution::GAUSSIAN }
    }

    /// Generates a topography on `grid`.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] if a parameter is invalid on this grid.
    pub fn generate(&self, grid: &Grid, seed: u64) -> Result<Topography> {
        let shape = self.shape(grid)?;
        let spectrum = || self.spectrum(shape, grid.pitch, 0..shape[1] / 2 + 1);
        stationary(grid, shape, seed, self.sq, self.heights, spectrum)
    }

    /// Returns the shape of the noise that is filtered to a topography on `grid`, if every parameter is valid
    /// there.
    pub fn shape(&self, grid: &Grid) -> Result<[usize; 2]> {
        check_sq(self.sq)?;
        for axis in 0..2 {
            let length = self.cutoff[axis];
            // Lengths that differ from a limit only by round-off count as equal to it.
            let good = length >= 2.0 * grid.pitch[axis] * (1.0 - 1e-9)
                && length <= grid.extent()[axis] * (1.0 + 1e-9);
            check_in(
                Dimension::Length,
                "cutoff",
                length,
                good,
                "a wavelength from two pitches to the length of the surface",
            )?;
        }
        Ok(shape_with_margin(grid, self.cutoff.map(|length| 4.0 * length)))
    }

    /// Returns the coefficients h(k, l) of the filter, −`reach` ≤ k, l ≤ `reach`, at
    /// `[k + reach, l + reach]`, dimensionless.
    ///
    /// They belong to the exact band, without the margins of a finite grid. They illustrate the filter;
    /// [`Self::generate`] applies its response instead. The scale of the heights is [`Self::sq`], independent
    /// of them.
    pub fn coefficients(&self, pitch: [Metre; 2], reach: [usize; 2]) -> Field {
        use std::f64::consts::{PI, TAU};
        let edge: [f64; 2] = std::array::from_fn(|axis| TAU * pitch[axis] / self.cutoff[axis]);
        let sinc = |s: f64| if s == 0.0 { 1.0 } else { s.sin() / s };
        Field::from_shape_fn(reach.map(|reach| 2 * reach + 1), |(i, j)| {
            let s = [i.abs_diff(reach[0]) as f64 * edge[0], j.abs_diff(reach[1]) as f64 * edge[1]];
            let rho = s[0].hypot(s[1]);
            match self.band {
                Band::Elliptic if rho == 0.0 => edge[0] * edge[1] / (4.0 * PI),
                Band::Elliptic => edge[0] * edge[1] * libm::j1(rho) / (TAU * rho),
                Band::Rectangular => edge[0] * edge[1] / (PI * PI) * sinc(s[0]) * sinc(s[1]),
            }
        })
    }

    /// Returns the spectrum of the filter at some frequencies l, `[l, k]` of a transform of `shape`: its
    /// squared response.
    pub fn spectrum(&self, shape: [usize; 2], pitch: [Metre; 2], l: Range<usize>) -> Field {
        let [x, y] = std::array::from_fn(|axis| {
            let part = |bin| {
                let frequency = angular_frequency(bin, shape[axis], pitch[axis]);
                let part = frequency * self.cutoff[axis] / std::f64::consts::TAU;
                match self.band {
                    Band::Elliptic => part * part,
                    // Fraction of the bin inside the band, because the edge may lie between two bins.
                    Band::Rectangular => {
                        let bins = shape[axis] as f64 * pitch[axis] / self.cutoff[axis];
                        (0.5 + (1.0 - part.abs()) * bins).clamp(0.0, 1.0)
                    }
                }
            };
            (0..shape[axis]).map(part).collect::<Vec<f64>>()
        });
        Field::from_shape_fn([l.len(), shape[0]], |(row, k)| match (self.band, y[l.start + row]) {
            (Band::Elliptic, y) if x[k] + y < 1.0 => 1.0,
            (Band::Elliptic, _) => 0.0,
            (Band::Rectangular, y) => x[k] * y,
        })
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::super::noise::tests::covariance;
    use super::*;
    use asperity_base::grid::Field;
    use asperity_base::math::{RealFft2, fft::symmetric_transform};

    #[test]
    fn the_response_is_the_transform_of_the_filter_of_hu_and_tonder() {
        // On n² samples the transform sums the filter over all periods: the lattice points in a circle
        // instead of its area, accurate to n^(−1/2) of the height at the origin.
        let n = 512;
        for band in [Band::Elliptic, Band::Rectangular] {
            let filter = LowPass { band, ..LowPass::new(1.0, [16.0, 12.0]) };
            let h = symmetric_transform(&filter.spectrum([n, n], [1.0; 2], 0..n / 2 + 1), [n, n])
                / (n * n) as f64;
            let coefficients = filter.coefficients([1.0; 2], [40, 30]);
            let origin = coefficients[[40, 30]];
            assert!(coefficients.iter().all(|coefficient| *coefficient <= origin));
            for ((i, j), expected) in coefficients.indexed_iter() {
                let (k, l) = (i.abs_diff(40), j.abs_diff(30));
                assert!((h[[k, l]] - expected).abs() < 0.01 * origin, "({k}, {l}): {} {expected}", h[[k, l]]);
            }
        }
    }

    #[test]
    fn no_wave_is_shorter_than_the_cut_off() {
        let grid = Grid::new([300, 500], [1.0, 0.5]).unwrap();
        let cutoff = [12.0, 8.0];
        let heights = LowPass::new(1.0, cutoff).generate(&grid, 5).unwrap().into_heights();
        // The window (Blackman's) leaks less than 1e-7 of the variance beyond four bins.
        let window = |i: usize, n: usize| {
            let t = TAU * (i as f64 + 0.5) / n as f64;
            0.42 - 0.5 * t.cos() + 0.08 * (2.0 * t).cos()
        };
        let windowed =
            Field::from_shape_fn(grid.shape, |(i, j)| heights[[i, j]] * window(i, 300) * window(j, 500));
        let spectrum = RealFft2::new(grid.shape).forward(&windowed);
        let (mut inside, mut outside) = (0.0, 0.0);
        for ((k, l), value) in spectrum.indexed_iter() {
            let x = angular_frequency(k, 300, 1.0) / TAU;
            let y = angular_frequency(l, 500, 0.5) / TAU;
            let beyond = |bins: f64| {
                let shrink = |f: f64, extent: f64| (f.abs() - bins / extent).max(0.0);
                (shrink(x, 300.0) * cutoff[0]).hypot(shrink(y, 250.0) * cutoff[1]) > 1.0
            };
            *(if beyond(4.0) { &mut outside } else { &mut inside }) += value.norm_sqr();
        }
        assert!(outside < 1e-7 * inside, "{:e}", outside / inside);
    }

    #[test]
    fn the_autocorrelation_is_the_bessel_function_of_the_cut_off() {
        // Over seeds, with about N = area/(wavelength²/π) independent spots on each surface.
        let grid = Grid::new([256, 512], [1.0, 0.5]).unwrap();
        let cutoff = [16.0, 8.0];
        for lag in [[4usize, 0], [10, 0], [0, 10], [16, 8], [20, 0]] {
            let seeds = 12;
            let measured: f64 = (0..seeds)
                .map(|seed| {
                    let z = LowPass::new(1.0, cutoff).generate(&grid, seed).unwrap().into_heights();
                    covariance(&z, lag)
                })
                .sum::<f64>()
                / seeds as f64;
            let s = TAU * (lag[0] as f64 / cutoff[0]).hypot(0.5 * lag[1] as f64 / cutoff[1]);
            let expected = 2.0 * libm::j1(s) / s;
            let spots = PI * 256.0 * 256.0 / (cutoff[0] * cutoff[1]) * seeds as f64;
            assert!((measured - expected).abs() < 4.0 / spots.sqrt(), "{lag:?}: {measured} for {expected}");
        }
    }

    #[test]
    fn opposite_edges_do_not_fit_together() {
        let grid = Grid::new([128, 128], [1.0; 2]).unwrap();
        let z = LowPass::new(1.0, [32.0; 2]).generate(&grid, 2).unwrap().into_heights();
        let step = |a: usize, b: usize| (0..128).map(|j| (z[[a, j]] - z[[b, j]]).powi(2)).sum::<f64>().sqrt();
        assert!(step(127, 0) > 3.0 * step(64, 65));
    }
}

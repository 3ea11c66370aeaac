//! White noise, filtered and translated.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::HeightDistribution;
use crate::Topography;
use asperity_base::error::{Result, check};
use asperity_base::grid::{Field, Grid};
use asperity_base::math::{RealFft2, good_size};
use asperity_base::units::Metre;

/// Independent Gaussian numbers with mean 0 and variance 1: the ChaCha8 stream for `seed`.
pub fn white_noise(seed: u64) -> impl Iterator<Item = f64> {
    StandardNormal.sample_iter(ChaCha8Rng::seed_from_u64(seed))
}

/// Returns a shape for fast transforms that is longer than the grid by at least `margin`.
///
/// Filtering noise of this shape by the Fourier transform gives a periodic surface. The part of it on the
/// grid is not periodic, and its opposite edges are at least `margin` apart.
pub(super) fn shape_with_margin(grid: &Grid, margin: [Metre; 2]) -> [usize; 2] {
    std::array::from_fn(|axis| {
        good_size(grid.shape[axis] + (margin[axis] / grid.pitch[axis]).ceil() as usize)
    })
}

/// Generates white noise of `shape`, filters it to a spectrum, translates it to a distribution of `heights`,
/// cuts it to the grid, removes its mean, and scales it to the rms height `sq`.
///
/// `spectrum`, ≥ 0 with any variance, is that of the heights. It is indexed `[l, k]` by the periods along y,
/// l = 0 … ny/2, and along x, k in the order of the transform, with negative ones last.
pub(super) fn stationary(
    grid: &Grid,
    shape: [usize; 2],
    seed: u64,
    sq: Metre,
    heights: HeightDistribution,
    spectrum: impl FnOnce() -> Field,
) -> Result<Topography> {
    check_cells(grid)?;
    let translation = heights.translation()?;
    let mut spectrum = spectrum();
    if let Some(translation) = &translation {
        spectrum = translation.underlying(spectrum, shape);
    }
    spectrum.mapv_inplace(f64::sqrt);
    let mut noise = white_noise(seed);
    let row = |values: &mut [f64]| values.iter_mut().zip(&mut noise).for_each(|(value, n)| *value = n);
    let mut heights = RealFft2::new(shape).filter(row, &spectrum, grid.shape);
    if let Some(translation) = &translation {
        heights.mapv_inplace(|g| translation.height(g));
    }
    let cells = grid.cells() as f64;
    let mean = heights.sum() / cells;
    heights -= mean;
    let rms = (heights.iter().map(|z| z * z).sum::<f64>() / cells).sqrt();
    heights *= sq / rms;
    Topography::new(*grid, heights)
}

/// Returns an error for a grid of a single cell, whose heights cannot differ.
pub fn check_cells(grid: &Grid) -> Result<()> {
    check("shape", grid.cells() as f64, grid.cells() > 1, "at least two cells, for heights to differ")
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Returns the mean product of heights `[i, j]` samples apart.
    pub(crate) fn covariance(z: &Field, [i, j]: [usize; 2]) -> f64 {
        let pairs = [z.nrows() - i, z.ncols() - j];
        let products = Field::from_shape_fn(pairs, |(k, l)| z[[k, l]] * z[[k + i, l + j]]);
        products.mean().expect("lags below the shape leave pairs")
    }

    #[test]
    fn noise_has_the_moments_of_a_gaussian_and_no_correlation() {
        let noise = Field::from_shape_vec([512, 512], white_noise(1).take(512 * 512).collect()).unwrap();
        let n = noise.len() as f64;
        let moment = |p: i32| noise.iter().map(|z| z.powi(p)).sum::<f64>() / n;
        // Standard errors of the sample moments of Gaussian numbers: √(1, 2, 15, 96)/√n.
        for (p, expected, variance) in [(1, 0.0, 1.0), (2, 1.0, 2.0), (3, 0.0, 15.0), (4, 3.0, 96.0)] {
            let error = (moment(p) - expected).abs() / (variance / n).sqrt();
            assert!(error < 4.0, "moment {p} is off by {error:.1} standard errors");
        }
        assert!(covariance(&noise, [1, 0]).abs() < 4.0 / n.sqrt());
    }

    #[test]
    fn the_margin_is_kept_in_both_directions() {
        let grid = Grid::new([100, 50], [1.0, 0.5]).unwrap();
        let shape = shape_with_margin(&grid, [10.0, 20.0]);
        assert!(shape[0] >= 110 && shape[1] >= 90);
    }
}

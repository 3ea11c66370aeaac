//! White noise and its filtering.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::error::{Result, check};
use crate::grid::{Field, Grid};
use crate::math::{RealFft2, good_size};
use crate::surface::Topography;
use crate::units::Metre;

/// Independent Gaussian numbers of mean 0 and variance 1: the stream of ChaCha8 for `seed`, in the order of
/// memory.
pub(super) fn white_noise(shape: [usize; 2], seed: u64) -> Field {
    let mut stream = ChaCha8Rng::seed_from_u64(seed);
    Field::from_shape_simple_fn(shape, || StandardNormal.sample(&mut stream))
}

/// A shape of fast transforms that is longer than the grid by `margin` or more.
///
/// A filter applied to noise of this shape by the Fourier transform gives a periodic surface; of it, the part
/// on the grid is not periodic, and its opposite edges are as far from each other as `margin`.
pub(super) fn shape_with_margin(grid: &Grid, margin: [Metre; 2]) -> [usize; 2] {
    std::array::from_fn(|axis| {
        good_size(grid.shape[axis] + (margin[axis] / grid.pitch[axis]).ceil() as usize)
    })
}

/// White noise of `shape`, filtered, cut to the grid, its mean removed, and scaled to the rms height `sq`.
///
/// `response(k, l)` is the filter's, at the wave of k periods along x and l ≤ n/2 along y, k ≤ n counted
/// upwards through the negative ones as the transform counts them.
pub(super) fn filtered_noise(
    grid: &Grid,
    shape: [usize; 2],
    seed: u64,
    sq: Metre,
    response: impl Fn(usize, usize) -> f64,
) -> Result<Topography> {
    check("shape", grid.cells() as f64, grid.cells() > 1, "at least two cells, for heights to differ")?;
    let fft = RealFft2::new(shape);
    let mut spectrum = fft.forward(&white_noise(shape, seed));
    spectrum.indexed_iter_mut().for_each(|((k, l), value)| *value *= response(k, l));
    let periodic = fft.inverse(&spectrum);
    let mut heights = Field::from_shape_fn(grid.shape, |at| periodic[at]);
    let cells = grid.cells() as f64;
    let mean = heights.sum() / cells;
    heights -= mean;
    let rms = (heights.iter().map(|z| z * z).sum::<f64>() / cells).sqrt();
    heights *= sq / rms;
    Topography::new(*grid, heights)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Mean product of the heights `[i, j]` samples apart.
    pub(crate) fn covariance(z: &Field, [i, j]: [usize; 2]) -> f64 {
        let pairs = [z.nrows() - i, z.ncols() - j];
        let products = Field::from_shape_fn(pairs, |(k, l)| z[[k, l]] * z[[k + i, l + j]]);
        products.mean().expect("lags below the shape leave pairs")
    }

    #[test]
    fn noise_has_the_moments_of_a_gaussian_and_no_correlation() {
        let noise = white_noise([512, 512], 1);
        let n = noise.len() as f64;
        let moment = |p: i32| noise.iter().map(|z| z.powi(p)).sum::<f64>() / n;
        // Standard errors of the sample moments of a Gaussian: √(1, 2, 15, 96)/√n.
        for (p, expected, variance) in [(1, 0.0, 1.0), (2, 1.0, 2.0), (3, 0.0, 15.0), (4, 3.0, 96.0)] {
            let error = (moment(p) - expected).abs() / (variance / n as f64).sqrt();
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

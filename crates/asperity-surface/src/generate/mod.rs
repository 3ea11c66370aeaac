//! Random topographies with prescribed statistics, reproducible from a seed.

mod autocorrelation;
mod heights;
mod johnson;
mod low_pass;
mod noise;
mod self_affine;
#[cfg(test)]
mod statistics;

pub use autocorrelation::{Autocorrelation, Decay};
pub use heights::HeightDistribution;
pub use low_pass::{Band, LowPass};
pub use noise::{check_cells, white_noise};
pub use self_affine::{Amplitude, SelfAffine};

use serde::Serialize;

use crate::Topography;
use asperity_base::error::{Result, check_in};
use asperity_base::grid::Grid;
use asperity_base::units::{Dimension, Metre};
use asperity_derive::Part;

/// A method with its parameters; a case file selects it by `generate = "low-pass"` and so on.
#[derive(Part, Debug, Clone, Copy, PartialEq, Serialize)]
#[part(key = "generate", example = "\"low-pass\"", meaning = "method")]
#[serde(tag = "generate", rename_all = "kebab-case")]
pub enum Generator {
    /// White noise without short waves; not periodic.
    LowPass(LowPass),
    /// Prescribed autocorrelation, with or without a lay; not periodic.
    Autocorrelation(Autocorrelation),
    /// Power-law spectrum; periodic.
    SelfAffine(SelfAffine),
}

impl Generator {
    /// Generates a topography on `grid` with the mean height 0. It is the same for the same `seed` on every
    /// machine, up to the round-off of the Fourier transform.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] if a parameter is invalid, in general or on this grid.
    pub fn generate(&self, grid: &Grid, seed: u64) -> Result<Topography> {
        match self {
            Self::LowPass(method) => method.generate(grid, seed),
            Self::Autocorrelation(method) => method.generate(grid, seed),
            Self::SelfAffine(method) => method.generate(grid, seed),
        }
    }

    /// Number of cells of the transforms for a topography on `grid`, with margins if its heights are not
    /// periodic.
    pub fn cells(&self, grid: &Grid) -> f64 {
        let margin = match self {
            Self::LowPass(method) => method.cutoff.map(|length| 4.0 * length),
            Self::Autocorrelation(method) => method.reach().map(|length| 3.0 * length),
            Self::SelfAffine(_) => [0.0; 2],
        };
        let along = |axis: usize| {
            // A length beyond the surface is rejected before anything is generated.
            let [all, margin] = [grid.shape[axis] as f64, margin[axis] / grid.pitch[axis]];
            all + margin.min(4.0 * all)
        };
        along(0) * along(1)
    }
}

fn check_sq(sq: Metre) -> Result<()> {
    check_in(Dimension::Length, "sq", sq, sq > 0.0 && sq.is_finite(), "an rms height above 0")
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    fn generators() -> [Generator; 3] {
        [
            Generator::LowPass(LowPass::new(2e-7, [4e-6, 4e-6])),
            Generator::Autocorrelation(Autocorrelation::new(2e-7, [2e-6, 4e-6])),
            Generator::SelfAffine(SelfAffine {
                hurst: 0.8,
                rolloff: Some(8e-6),
                shortest: None,
                amplitude: Amplitude::Sq(2e-7),
            }),
        ]
    }

    #[test]
    fn the_rms_height_is_the_one_asked_for_and_the_mean_is_zero() {
        let grid = Grid::new([48, 35], [0.5e-6, 1e-6]).unwrap();
        for generator in generators() {
            let topography = generator.generate(&grid, 3).unwrap();
            assert_relative_eq!(topography.sq(), 2e-7, max_relative = 1e-12);
            assert!(topography.mean().abs() < 1e-20, "{generator:?}: {:e}", topography.mean());
        }
    }

    #[test]
    fn a_seed_always_gives_the_same_heights_and_another_seed_others() {
        // Our own frozen values: a change breaks the reproducibility of users' cases.
        let frozen = [
            [-8.016637787053289e-8, -3.7990750787169114e-9, -7.5365344888137e-8],
            [-1.5730841531794905e-7, -1.221280411051481e-7, 3.7842618046314174e-8],
            [-3.0951783408855834e-8, 7.667141310831664e-8, 7.166614547974371e-8],
        ];
        let grid = Grid::new([32, 24], [0.5e-6, 0.5e-6]).unwrap();
        for (generator, expected) in generators().iter().zip(frozen) {
            let heights = generator.generate(&grid, 7).unwrap().into_heights();
            let first = [heights[[0, 0]], heights[[0, 1]], heights[[1, 0]]];
            for (z, expected) in first.iter().zip(expected) {
                assert!((z - expected).abs() < 1e-17, "{generator:?}: {first:?}");
            }
            assert_ne!(heights, generator.generate(&grid, 8).unwrap().into_heights());
        }
    }

    #[test]
    fn parameters_without_meaning_are_refused_by_their_keys() {
        let grid = Grid::new([64, 32], [1e-6, 1e-6]).unwrap();
        let low_pass = |sq, cutoff| Generator::LowPass(LowPass::new(sq, cutoff));
        let exponential = |length| Generator::Autocorrelation(Autocorrelation::new(1e-7, length));
        let self_affine = |hurst, rolloff, shortest, amplitude| {
            Generator::SelfAffine(SelfAffine { hurst, rolloff, shortest, amplitude })
        };
        let sq = Amplitude::Sq(1e-7);
        let bad = [
            (low_pass(0.0, [8e-6; 2]), "sq is 0 m"),
            (low_pass(f64::NAN, [8e-6; 2]), "sq is NaN"),
            (low_pass(1e-7, [8e-6, 1.9e-6]), "cutoff is 1.9 µm"),
            (low_pass(1e-7, [8e-6, 33e-6]), "cutoff is 33 µm"),
            (exponential([0.5e-6, 8e-6]), "correlation_length is 500 nm"),
            (exponential([8e-6, f64::INFINITY]), "correlation_length is inf"),
            (self_affine(1.1, None, None, sq), "hurst is 1.1"),
            (self_affine(0.8, None, Some(1e-6), sq), "shortest is 1 µm"),
            (self_affine(0.8, None, Some(70e-6), sq), "shortest is 70 µm"),
            (self_affine(0.8, Some(3e-6), Some(4e-6), sq), "rolloff is 3 µm"),
            (self_affine(0.8, None, None, Amplitude::Sdq(-0.1)), "sdq is -0.1"),
            (self_affine(0.8, None, None, Amplitude::Sq(-0.1)), "sq is -100 mm"),
        ];
        for (generator, message) in bad {
            let error = generator.generate(&grid, 0).unwrap_err().to_string();
            assert!(error.starts_with(message), "{error}");
        }
        let cell = Grid::new([1, 1], [1e-6, 1e-6]).unwrap();
        assert!(exponential([1e-6; 2]).generate(&cell, 0).is_err());
    }
}

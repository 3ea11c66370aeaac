//! Power spectral density.

mod angular;
mod radial;
mod window;

pub use radial::Bins;
pub use window::Window;

use asperity_transforms::num_complex::Complex64;
use ndarray::Array2;
use serde::Serialize;

use crate::{Axis, Fill, Topography};
use asperity_base::grid::{Field, Grid, flat};
use asperity_base::math::RealFft2;
use asperity_base::math::fft::angular_frequency;
use asperity_base::math::sum::sums;
use asperity_base::units::{RadianPerMetre, SquareMetre};

/// Power spectral density of a topography at the wave vectors resolved by its grid, m⁴:
///
/// C(q) = |z̃(q)|²/A,  z̃(q) = ΔA Σ w z exp(−iq·x),  ∫ C d²q/(2π)² = (1/A) Σ C = ⟨w² z²⟩ = Sq² without a
/// window
///
/// over wave vectors of both signs: the convention of Jacobs, Junge & Pastewka, Surf. Topogr.: Metrol. Prop.
/// 5, 013001 (2017). The heights z are relative to their mean with the window, Σwz/Σw, so that C(0) = 0. A
/// tilt or a form is not removed: apply [`Topography::level`] first.
///
/// Undefined samples are filled by a membrane ([`Fill::Harmonic`]). Zero weights would spread their share of
/// the variance over all waves, and hide the steep decrease of the spectra of real surfaces. The membrane
/// only lacks the waves shorter than the holes, where C is too small by the undefined fraction. Without a
/// defined sample all values are NaN.
#[derive(Debug, Clone)]
pub struct Spectrum {
    grid: Grid,
    density: Field,
}

/// A point of a spectrum over one wave number.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SpectralPoint {
    /// Wave number q = 2π/wavelength, rad/m.
    pub wave_number: RadianPerMetre,
    /// Density: m⁴ for a mean of C(q), m³ for an integral along the other direction.
    pub density: f64,
    /// Number of contributing wave vectors, with q and −q counted as two. On a random surface the relative
    /// scatter of each density is 1. A mean over directions has a relative standard error of √(2/waves), or
    /// up to twice that with a window.
    pub waves: usize,
}

impl Spectrum {
    /// Computes the spectrum of `topography` with `window`.
    pub fn new(topography: &Topography, window: Window) -> Self {
        let grid = *topography.grid();
        let mut heights = match topography.clone().fill(Fill::Harmonic) {
            Ok(filled) => filled.into_heights(),
            Err(_) => topography.heights().clone(),
        };
        // Heights are first taken relative to one of them: equal heights then give exactly 0, without the
        // round-off of their mean.
        let first = heights[[0, 0]];
        heights -= first;
        let weights = window.weights(grid.shape);
        let weight = flat(&weights);
        let [weighted] = sums(flat(&heights), |cell, z| [z * weight[cell]]);
        let mean = weighted / weights.sum();
        heights.zip_mut_with(&weights, |z, w| *z = (*z - mean) * w);
        // Neither is needed any more, and each is as large as the topography.
        drop(weights);
        let transform: Array2<Complex64> = RealFft2::new(grid.shape).forward_transposed(&heights);
        drop(heights);
        let scale = grid.cell_area() / grid.cells() as f64;
        let density = transform.mapv(|z| scale * z.norm_sqr());
        drop(transform);
        Self { grid, density: density.t().as_standard_layout().into_owned() }
    }

    /// C(q), m⁴, at the wave vectors [`Spectrum::wave_vector`]. Those with a negative qy are omitted, because
    /// C(−q) = C(q). Shape `[nx, ny/2 + 1]`.
    pub fn density(&self) -> &Field {
        &self.density
    }

    /// Returns C(q), m⁴, at the wave vector of k periods along x and l along y, also negative ones; periodic
    /// beyond the Nyquist wave number.
    pub fn density_at(&self, [k, l]: [isize; 2]) -> f64 {
        let [nx, ny] = self.grid.shape.map(|n| n as isize);
        let l = l.rem_euclid(ny);
        let [k, l] = if 2 * l > ny { [-k, ny - l] } else { [k, l] };
        self.density[[k.rem_euclid(nx) as usize, l as usize]]
    }

    /// Wave vector of entry `[k, l]`, rad/m.
    pub fn wave_vector(&self, [k, l]: [usize; 2]) -> [RadianPerMetre; 2] {
        let Grid { shape, pitch } = self.grid;
        [angular_frequency(k, shape[0], pitch[0]), angular_frequency(l, shape[1], pitch[1])]
    }

    /// Largest wave number up to which the grid resolves waves in all directions, π/pitch with the larger
    /// pitch. A direction with a single sample is ignored; 0 for a single sample.
    pub fn nyquist(&self) -> RadianPerMetre {
        let Grid { shape, pitch } = self.grid;
        let several = (0..2).filter(|&axis| shape[axis] > 1);
        several.map(|axis| std::f64::consts::PI / pitch[axis]).reduce(f64::min).unwrap_or(0.0)
    }

    /// Variance of the heights, ∫ C d²q/(2π)².
    pub fn variance(&self) -> SquareMetre {
        self.sum(|_| 1.0)
    }

    /// Computes the spectrum of the profiles along `axis`, as the mean over them, m³:
    ///
    /// C¹ᴰ(qx) = ∫ C(qx, qy) dqy/2π,  ∫ C¹ᴰ dqx/2π = Sq² over both signs
    ///
    /// at the wave numbers from 0 to the Nyquist wave number of this direction.
    pub fn along(&self, axis: Axis) -> Vec<SpectralPoint> {
        let (along, across) = match axis {
            Axis::X => (0, 1),
            Axis::Y => (1, 0),
        };
        let Grid { shape, pitch } = self.grid;
        let scale = 1.0 / self.grid.extent()[across];
        let points = (0..=shape[along] / 2).map(|m| {
            let at = |other: usize| match axis {
                Axis::X => self.density_at([m as isize, other as isize]),
                Axis::Y => self.density_at([other as isize, m as isize]),
            };
            let sum: f64 = (0..shape[across]).map(at).sum();
            let wave_number = angular_frequency(m, shape[along], pitch[along]);
            SpectralPoint { wave_number, density: scale * sum, waves: shape[across] }
        });
        points.collect()
    }

    /// Computes (1/A) Σ f(q) C(q), the integral ∫ f C d²q/(2π)², for an even f.
    pub(super) fn sum(&self, f: impl Fn([RadianPerMetre; 2]) -> f64) -> f64 {
        let mut sum = 0.0;
        self.for_each_wave(|q, density, signs| sum += signs * density * f(q));
        sum / self.grid.area()
    }

    /// Calls `f(q, C(q), signs)` for each wave, with `signs` 2 if it represents q and −q.
    fn for_each_wave(&self, mut f: impl FnMut([RadianPerMetre; 2], f64, f64)) {
        let along_y: Vec<_> = (0..self.density.ncols()).map(|l| self.wave_vector([0, l])[1]).collect();
        for (k, row) in self.density.outer_iter().enumerate() {
            let qx = self.wave_vector([k, 0])[0];
            for (l, density) in row.iter().enumerate() {
                f([qx, along_y[l]], *density, self.signs(l));
            }
        }
    }

    /// Returns 1 if the entries of column `l` contain both q and −q, else 2.
    fn signs(&self, l: usize) -> f64 {
        if l == 0 || 2 * l == self.grid.shape[1] { 1.0 } else { 2.0 }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use approx::assert_relative_eq;

    use super::*;
    use crate::Form;

    /// White Gaussian noise with variance 1.
    pub(super) fn noise(shape: [usize; 2], pitch: [f64; 2], seed: u64) -> Topography {
        use rand::SeedableRng;
        use rand_distr::{Distribution, StandardNormal};
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let heights = Field::from_shape_simple_fn(shape, || StandardNormal.sample(&mut random));
        Topography::new(Grid::new(shape, pitch).unwrap(), heights).unwrap()
    }

    const WINDOWS: [Window; 4] = [Window::None, Window::Hann, Window::RadialHann, Window::Welch];

    #[test]
    fn a_sinusoid_is_four_lines_of_its_amplitude() {
        let grid = Grid::new([60, 80], [0.5, 0.25]).unwrap();
        let form = Form::Sinusoid { amplitude: 3.0, wavelength: [5.0, 4.0] };
        let spectrum = Spectrum::new(&form.on(&grid).unwrap(), Window::None);
        // cos·cos is four waves of amplitude A/4: |z̃| = A/4 × area, each C = A²/16 × area.
        let line = 9.0 / 16.0 * grid.area();
        for ((k, l), density) in spectrum.density().indexed_iter() {
            let expected = if (k == 6 || k == 54) && l == 5 { line } else { 0.0 };
            assert!((density - expected).abs() < 1e-12 * line, "[{k}, {l}]: {density}");
        }
        assert_relative_eq!(spectrum.density_at([-6, 5]), line, max_relative = 1e-12);
        assert_relative_eq!(spectrum.density_at([-6, -5]), line, max_relative = 1e-12);
        let [qx, qy] = spectrum.wave_vector([54, 5]);
        assert_relative_eq!(qx, -TAU / 5.0, max_relative = 1e-14);
        assert_relative_eq!(qy, TAU / 4.0, max_relative = 1e-14);
    }

    #[test]
    fn the_density_holds_the_variance_under_every_window() {
        for shape in [[31, 24], [24, 31], [1, 16], [16, 1]] {
            let topography = noise(shape, [0.5, 2.0], 1);
            for window in WINDOWS {
                let spectrum = Spectrum::new(&topography, window);
                let weights = window.weights(shape);
                let z = topography.heights();
                let mean = (z * &weights).sum() / weights.sum();
                let variance = (&weights * &z.mapv(|z| z - mean)).mapv(|z| z * z).mean().unwrap();
                assert_relative_eq!(spectrum.variance(), variance, max_relative = 1e-12);
                for axis in [Axis::X, Axis::Y] {
                    let (n, pitch) = match axis {
                        Axis::X => (shape[0], 0.5),
                        Axis::Y => (shape[1], 2.0),
                    };
                    let signs = |m: usize| if m == 0 || 2 * m == n { 1.0 } else { 2.0 };
                    let profiles = spectrum.along(axis);
                    let sum: f64 = profiles.iter().enumerate().map(|(m, p)| signs(m) * p.density).sum();
                    assert_relative_eq!(sum / (n as f64 * pitch), variance, max_relative = 1e-12);
                }
            }
        }
    }

    #[test]
    fn white_noise_has_the_density_of_one_cell_under_every_window() {
        // ΔA times the variance. A window couples neighbouring waves: with Hann's, 35/18 waves count as one
        // independent wave along each axis, with the others fewer.
        let spectra = WINDOWS.map(|window| Spectrum::new(&noise([256, 200], [0.5, 0.25], 3), window));
        for spectrum in spectra {
            let (mut sum, mut waves) = (0.0, 0.0);
            spectrum.for_each_wave(|[qx, qy], density, signs| {
                if qx.hypot(qy) < 0.5 * spectrum.nyquist() {
                    sum += signs * density;
                    waves += signs;
                }
            });
            let error = 35.0 / 18.0 * (2.0f64 / waves).sqrt();
            assert_relative_eq!(sum / waves, 0.5 * 0.25, max_relative = 4.0 * error);
        }
    }

    #[test]
    fn the_spectrum_along_an_axis_is_the_mean_of_the_spectra_of_the_profiles() {
        let topography = noise([24, 5], [0.5, 2.0], 8);
        let spectrum = Spectrum::new(&topography, Window::None);
        let mean = topography.mean();
        for point in spectrum.along(Axis::X) {
            let of_line = |iy: usize| {
                let sum: Complex64 = (0..24)
                    .map(|ix| {
                        let phase = -point.wave_number * 0.5 * ix as f64;
                        Complex64::cis(phase) * (topography.heights()[[ix, iy]] - mean)
                    })
                    .sum();
                (0.5 * sum).norm_sqr() / 12.0
            };
            let expected = (0..5).map(of_line).sum::<f64>() / 5.0;
            assert_relative_eq!(point.density, expected, max_relative = 1e-10, epsilon = 1e-14);
        }
    }

    #[test]
    fn a_hole_is_spanned_and_costs_the_waves_within_it_only() {
        // A long wave with a hole of a tenth of its length: the membrane misses it by about q²a²/2 of the
        // height.
        let grid = Grid::new([128, 96], [1.0, 1.0]).unwrap();
        let whole = Form::Sinusoid { amplitude: 1.0, wavelength: [64.0, f64::INFINITY] }.on(&grid).unwrap();
        let mut holed = whole.clone();
        (60..67).for_each(|ix| (40..47).for_each(|iy| holed.heights_mut()[[ix, iy]] = f64::NAN));
        let [expected, found] = [whole, holed].map(|z| Spectrum::new(&z, Window::None));
        let line = expected.density()[[2, 0]];
        assert_relative_eq!(found.density()[[2, 0]], line, max_relative = 2.0 * 49.0 / grid.cells() as f64);
        let rest = found.density().sum() - found.density()[[2, 0]] - found.density()[[126, 0]];
        assert!(rest < 1e-4 * line, "{:e}", rest / line);
    }

    #[test]
    fn without_a_sample_nothing_is_a_number() {
        let grid = Grid::new([4, 4], [1.0, 1.0]).unwrap();
        let nothing = Topography::new(grid, Field::from_elem([4, 4], f64::NAN)).unwrap();
        assert!(Spectrum::new(&nothing, Window::Hann).variance().is_nan());
    }
}

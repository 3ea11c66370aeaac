//! Self-affine roughness: a power-law spectrum with random phases.

use std::f64::consts::TAU;
use std::ops::Range;

use asperity_transforms::num_complex::Complex64;
use ndarray::{Array2, Axis};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use super::check_sq;
use crate::Topography;
use asperity_base::error::{Error, Result, check, check_in};
use asperity_base::grid::Grid;
use asperity_base::math::RealFft2;
use asperity_base::math::fft::angular_frequency;
use asperity_base::math::parallel;
use asperity_base::table::{Source, require};
use asperity_base::units::{Dimension, Metre};
use asperity_base::{beside, exists};
use asperity_derive::Part;

/// Periodic heights with the spectrum |ẑ(q)|² ∝ q^(−2−2H) from the roll-off to the shortest wave, constant
/// for longer waves and zero for shorter ones. The phases are random, the magnitudes are not.
///
/// Jacobs, Junge & Pastewka, Surf. Topogr.: Metrol. Prop. 5, 013001 (2017); the same form as in the Contact
/// Mechanics Challenge, Müser et al., Tribol. Lett. 65, 118 (2017).
///
/// A wave has the same phase on every grid of the same extent. With `shortest` given, a finer grid shows the
/// same surface in more detail, as convergence studies require.
#[derive(Part, Debug, Clone, Copy, PartialEq, Serialize)]
#[part(check = shorter)]
pub struct SelfAffine {
    /// Rms height or rms slope.
    #[key(part)]
    #[serde(flatten)]
    pub amplitude: Amplitude,
    /// The Hurst exponent H.
    ///
    /// The fractal dimension is 3 − H.
    #[key(
        number = "a number",
        range = Between { least: 0.0, most: 1.0, open: [true, false] },
        example = "0.8"
    )]
    pub hurst: f64,
    /// Wavelength above which the spectrum is flat, above `shortest`.
    #[key(
        quantity = Length,
        range = AboveZero,
        absent = "none: the law holds up to the longest wave",
        example = "\"32 um\"",
        exists = exists::LENGTH,
        beside = [beside::LONG]
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rolloff: Option<Metre>,
    /// Shortest wavelength, at least twice the larger pitch.
    ///
    /// Waves of exactly two pitches have no phase on the grid and are omitted.
    #[key(
        quantity = Length,
        range = AboveZero,
        absent = "twice the larger pitch",
        example = "\"8 um\"",
        exists = exists::LENGTH
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shortest: Option<Metre>,
}

/// Quantity that determines the amplitude of a self-affine surface. Both are exact for every surface.
#[derive(Part, Debug, Clone, Copy, PartialEq, Serialize)]
#[part(
    absent = "exactly one of `sq` and `sdq`",
    hint = "'sq' is the rms height, a length; 'sdq' the rms slope, a number"
)]
#[serde(rename_all = "lowercase")]
pub enum Amplitude {
    /// Rms height, exact.
    #[key(quantity = Length, range = AboveZero, example = "\"0.2 um\"", exists = exists::ROUGHNESS)]
    Sq(Metre),
    /// Rms slope, exact (as the sum of waves).
    ///
    /// √⟨|∇z|²⟩ = √(Σ q² |ẑ|²). The finite differences of [`crate::HybridParameters::sdq`] give less if there
    /// are waves shorter than about four pitches.
    #[key(number = "a number", range = AboveZero, example = "0.1", exists = exists::SLOPE)]
    Sdq(f64),
}

fn shorter(read: &SelfAffine, source: &dyn Source) -> Result<()> {
    let is_longer = read.rolloff.zip(read.shortest).is_some_and(|(longest, shortest)| shortest >= longest);
    require(source, "shortest", !is_longer, "a wavelength below that of 'rolloff'", None)
}

impl SelfAffine {
    /// Generates a topography on `grid`.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a parameter is invalid on this grid.
    pub fn generate(&self, grid: &Grid, seed: u64) -> Result<Topography> {
        let (mut spectrum, squares) = self.spectrum(grid, seed, 0..grid.shape[1] / 2 + 1)?;
        let scale = self.scale(grid, squares)?;
        spectrum.mapv_inplace(|value| value * scale);
        Topography::new(*grid, RealFft2::new(grid.shape).inverse_transposed(spectrum, grid.shape))
    }

    /// Returns the unscaled transform `[l, k]` of a topography at the frequencies `among` along y, and the
    /// contributions of these waves to the squares of height and slope. [`Self::scale`] gives the factor.
    pub fn spectrum(
        &self,
        grid: &Grid,
        seed: u64,
        among: Range<usize>,
    ) -> Result<(Array2<Complex64>, [f64; 2])> {
        let shortest = self.check(grid)?;
        let [nx, _] = grid.shape;
        let numbers = |axis: usize| {
            let number = |bin| angular_frequency(bin, grid.shape[axis], grid.pitch[axis]);
            (0..grid.shape[axis]).map(number).collect::<Vec<f64>>()
        };
        let (along_x, along_y) = (numbers(0), numbers(1));
        let mut spectrum = Array2::<Complex64>::zeros([among.len(), nx]);
        let (mut height, mut slope) = (0.0, 0.0);
        // The squares are added wave by wave, in the same order for any number of threads.
        for (number, mut some) in spectrum.axis_chunks_iter_mut(Axis(0), AT_ONCE).enumerate() {
            let first = among.start + number * AT_ONCE;
            let squares = parallel::map(some.outer_iter_mut().enumerate(), |(n, mut spectrum)| {
                let l = first + n;
                let mut squares = Vec::with_capacity(nx);
                for_each_wave(grid.shape, seed, l, |k, phase| {
                    let wave = [along_x[k], along_y[l]];
                    let q = wave[0].hypot(wave[1]);
                    // A wave at the limit belongs to the surface, whatever the round-off.
                    if q * shortest > TAU * (1.0 + 1e-9) {
                        return;
                    }
                    let magnitude = self.magnitude(q);
                    // The phase is that at the grid's corner, half a cell before the first centre.
                    let to_centre = 0.5 * (wave[0] * grid.pitch[0] + wave[1] * grid.pitch[1]);
                    spectrum[k] = Complex64::from_polar(magnitude, phase + to_centre);
                    if l == 0 {
                        spectrum[nx - k] = spectrum[k].conj();
                    }
                    squares.push([2.0 * magnitude * magnitude, 2.0 * (q * magnitude).powi(2)]);
                });
                squares
            });
            for [of_height, of_slope] in squares.into_iter().flatten() {
                height += of_height;
                slope += of_slope;
            }
        }
        Ok((spectrum, [height, slope]))
    }

    /// Returns the scale of a transform whose waves contribute these squares of height and slope.
    pub fn scale(&self, grid: &Grid, [height, slope]: [f64; 2]) -> Result<f64> {
        if height == 0.0 {
            return Err(Error::OutOfRange {
                quantity: "shortest",
                dimension: Some(Dimension::Length),
                value: self.check(grid)?,
                expected: "a wavelength that fits into the surface".into(),
            });
        }
        // Parseval: ⟨z²⟩ = Σ |ẑ|²/n² for n cells.
        let amplitude = match self.amplitude {
            Amplitude::Sq(sq) => sq / height.sqrt(),
            Amplitude::Sdq(sdq) => sdq / slope.sqrt(),
        };
        Ok(grid.cells() as f64 * amplitude)
    }

    /// |ẑ(q)| up to a constant factor.
    fn magnitude(&self, q: f64) -> f64 {
        q.max(self.rolloff.map_or(0.0, |length| TAU / length)).powf(-1.0 - self.hurst)
    }

    /// Returns the shortest wavelength on `grid`, if every parameter is valid there.
    fn check(&self, grid: &Grid) -> Result<Metre> {
        check("hurst", self.hurst, (0.0..=1.0).contains(&self.hurst), "a Hurst exponent from 0 to 1")?;
        match self.amplitude {
            Amplitude::Sq(sq) => check_sq(sq)?,
            Amplitude::Sdq(sdq) => check("sdq", sdq, sdq > 0.0 && sdq.is_finite(), "an rms slope above 0")?,
        }
        let limit = 2.0 * grid.pitch[0].max(grid.pitch[1]);
        let shortest = self.shortest.unwrap_or(limit);
        let good = shortest >= limit * (1.0 - 1e-9) && shortest.is_finite();
        check_in(Dimension::Length, "shortest", shortest, good, "a wavelength of at least two pitches")?;
        if let Some(rolloff) = self.rolloff {
            check_in(
                Dimension::Length,
                "rolloff",
                rolloff,
                rolloff >= shortest,
                "a wavelength not below the shortest",
            )?;
        }
        Ok(shortest)
    }
}

/// Number of frequencies along y processed in parallel.
const AT_ONCE: usize = 16;

/// Calls `f(k, phase)` for one wave of each pair ±q resolved by the grid: l periods along y, k along x, with
/// negative ones counted down from nx.
///
/// The phases for one l are a separate stream of the generator, in the order k = 0, 1, −1, 2, −2, …. They
/// therefore depend on the seed and the wave, not on the shape.
fn for_each_wave([nx, ny]: [usize; 2], seed: u64, l: usize, mut f: impl FnMut(usize, f64)) {
    if 2 * l >= ny {
        return;
    }
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(l as u64);
    random.set_word_pos(0);
    for number in 0..2 * nx.div_ceil(2) - 1 {
        let phase = TAU * random.random::<f64>();
        let periods = number.div_ceil(2);
        let positive = number % 2 == 1;
        if l > 0 || positive {
            f(if positive || number == 0 { periods } else { nx - periods }, phase);
        }
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;
    use crate::HeightParameters;

    fn surface(shape: [usize; 2], pitch: [f64; 2], method: SelfAffine, seed: u64) -> Topography {
        method.generate(&Grid::new(shape, pitch).unwrap(), seed).unwrap()
    }

    fn method() -> SelfAffine {
        SelfAffine { hurst: 0.8, rolloff: Some(16.0), shortest: Some(4.0), amplitude: Amplitude::Sq(0.3) }
    }

    #[test]
    fn the_spectrum_is_the_power_law_between_its_limits() {
        let (nx, ny, pitch) = (60, 90, [1.0, 0.5]);
        let z = surface([nx, ny], pitch, method(), 4);
        let spectrum = RealFft2::new([nx, ny]).forward(z.heights());
        let reference = spectrum[[1, 0]].norm();
        for ((k, l), value) in spectrum.indexed_iter().filter(|(at, _)| *at != (0, 0)) {
            let wavelength =
                TAU / angular_frequency(k, nx, pitch[0]).hypot(angular_frequency(l, ny, pitch[1]));
            let expected =
                if wavelength < 4.0 * (1.0 - 1e-9) { 0.0 } else { (wavelength / 16.0).min(1.0).powf(1.8) };
            assert!((value.norm() / reference - expected).abs() < 1e-12, "wavelength {wavelength}");
        }
        assert!(spectrum[[0, 0]].norm() < 1e-12 * reference);
    }

    #[test]
    fn every_shape_gets_its_rms_height() {
        for shape in [[16, 16], [15, 17], [16, 1], [1, 16], [9, 32]] {
            let method = SelfAffine { rolloff: None, shortest: None, ..method() };
            assert_relative_eq!(surface(shape, [1.0, 1.0], method, 1).sq(), 0.3, max_relative = 1e-12);
        }
    }

    #[test]
    fn the_rms_slope_is_the_one_asked_for() {
        let method = SelfAffine { amplitude: Amplitude::Sdq(0.1), ..method() };
        let exact = surface([128, 128], [1.0, 0.5], method, 2);
        // By the spectrum, as in contact theory …
        let spectrum = RealFft2::new([128, 128]).forward(exact.heights());
        let squared: f64 = spectrum
            .indexed_iter()
            .map(|((k, l), value)| {
                let q = angular_frequency(k, 128, 1.0).hypot(angular_frequency(l, 128, 0.5));
                let weight = if l == 0 { 1.0 } else { 2.0 };
                weight * q * q * value.norm_sqr()
            })
            .sum();
        assert_relative_eq!(squared.sqrt() / (128.0 * 128.0), 0.1, max_relative = 1e-12);
        // … and by finite differences, once the shortest wave has 16 cells.
        let fine = surface([512, 512], [0.25, 0.25], method, 2);
        assert_relative_eq!(fine.sdq(), 0.1, max_relative = 0.02);
    }

    #[test]
    fn a_finer_grid_shows_the_same_surface() {
        let coarse = surface([32, 40], [1.0, 1.0], method(), 9);
        let fine = surface([96, 120], [1.0 / 3.0, 1.0 / 3.0], method(), 9);
        for ((i, j), z) in coarse.heights().indexed_iter() {
            // The centre of a cell is that of the middle one of its 3 × 3 cells.
            assert!((z - fine.heights()[[3 * i + 1, 3 * j + 1]]).abs() < 1e-12, "[{i}, {j}]");
        }
    }

    #[test]
    fn heights_are_gaussian_over_a_hundred_seeds() {
        let (seeds, mut skewness, mut kurtosis) = (100, 0.0, 0.0);
        for seed in 0..seeds {
            let parameters = HeightParameters::new(&surface([128, 128], [1.0, 1.0], method(), seed));
            skewness += parameters.ssk / seeds as f64;
            kurtosis += parameters.sku / seeds as f64;
        }
        // Independent spots: half the number of waves, with the effective number (Σ|ẑ|²)²/Σ|ẑ|⁴.
        let waves = TAU / 2.0 * (128.0f64 / 16.0).powi(2);
        let spots = waves * seeds as f64;
        assert!(skewness.abs() < 4.0 * (6.0 / spots).sqrt(), "{skewness}");
        // Fixed magnitudes lower the kurtosis by the order of 1/waves.
        assert!((kurtosis - 3.0).abs() < 4.0 * (24.0 / spots).sqrt() + 3.0 / waves, "{kurtosis}");
    }
}

//! Self-affine law fitted to a spectrum or to heights.

use serde::Serialize;

use crate::moments::mean_square;
use crate::{Axis, SpectralPoint, Topography};
use asperity_base::error::{Result, check};
use asperity_base::units::{Metre, RadianPerMetre, SquareMetre};

/// A surface that is statistically the same at every scale, if heights are scaled by the length to the power
/// of H:
///
/// C^iso(q) ∝ q^(−2−2H),  ⟨(z(x + τ) − z(x))²⟩ ∝ τ^(2H)
///
/// The fit is the least-squares line through the logarithms, with equal weights. Mandelbrot, *The Fractal
/// Geometry of Nature* (1982); Jacobs, Junge & Pastewka, Surf. Topogr.: Metrol. Prop. 5, 013001 (2017).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SelfAffinity {
    /// Hurst exponent H; a self-affine surface has 0 < H < 1.
    pub hurst: f64,
    /// Standard error of H, from the scatter of the points about the law. The scatter may differ from point
    /// to point, and is larger for points of few waves. MacKinnon & White, J. Econometrics 29, 305 (1985),
    /// HC3.
    pub hurst_error: f64,
    /// First and last abscissa fitted: wave numbers in rad/m, or lags in metres.
    pub range: [f64; 2],
    /// Number of points fitted.
    pub points: usize,
}

impl SelfAffinity {
    /// Fits the law to the points of a mean over all directions ([`crate::Spectrum::radial`], best in
    /// logarithmic rings) with wave numbers within `range`.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] if there are fewer than three.
    pub fn of_spectrum(radial: &[SpectralPoint], range: [RadianPerMetre; 2]) -> Result<Self> {
        let points = radial.iter().map(|point| (point.wave_number, point.density));
        Ok(Self::of_densities(&Line::within(range, points)?))
    }

    /// Fits the law to the longest range of wave numbers, without roll-off and cut-off. In the range, no
    /// point deviates from the fit by more than a tenth plus three standard errors √(2/waves), in the
    /// logarithm. Points of fewer than a hundred waves, which would fit any law, are left out. On a measured
    /// surface the instrument may determine the law in this range; an H beyond 0 … 1 indicates it.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] if there is no such range of three points.
    pub fn of_longest_range(radial: &[SpectralPoint]) -> Result<Self> {
        let certain = radial.iter().filter(|point| point.waves >= 100 && point.density > 0.0);
        let (points, tolerances): (Vec<_>, Vec<_>) = certain
            .map(|p| ((p.wave_number.ln(), p.density.ln()), 0.1 + 3.0 * (2.0 / p.waves as f64).sqrt()))
            .unzip();
        let mut best: Option<Line> = None;
        for first in 0..points.len() {
            for last in first + 2..points.len() {
                let length = points[last].0 - points[first].0;
                if best.as_ref().is_some_and(|best| length <= best.length()) {
                    continue;
                }
                let line = Line::through(&points[first..=last]);
                let residuals = points[first..=last].iter().map(|point| line.residual(*point).abs());
                if residuals.zip(&tolerances[first..]).all(|(residual, bound)| residual <= *bound) {
                    best = Some(line);
                }
            }
        }
        let found = best.as_ref().map_or(0, |line| line.points) as f64;
        check("points on a power law", found, best.is_some(), "at least three in a row")?;
        Ok(Self::of_densities(&best.expect("checked")))
    }

    /// Fits the law to the mean square differences of height ([`Topography::height_differences`]) with lags
    /// within `range`.
    ///
    /// A limited range of waves bends the curve beyond its ends. A lag should be at least ten times the
    /// shortest wavelength and at most a tenth of the longest. The spectrum is more reliable.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] if there are fewer than three.
    pub fn of_height_differences(differences: &[(Metre, SquareMetre)], range: [Metre; 2]) -> Result<Self> {
        let line = Line::within(range, differences.iter().copied())?;
        Ok(Self::of_line(&line, 0.5 * line.slope))
    }

    /// Decades of wave numbers, or of lags, in the fitted range.
    pub fn decades(&self) -> f64 {
        (self.range[1] / self.range[0]).log10()
    }

    /// Returns the reason, if any, why the exponent is only a slope of the spectrum and not a law of the
    /// surface. Either H is outside 0 … 1, which no self-affine surface has, or the range is less than a
    /// decade, over which any smooth curve is nearly straight.
    pub fn doubt(&self) -> Option<String> {
        /// Rounding tolerance of a range of wavelengths.
        const CRUMB: f64 = 1e-9;
        if !(0.0..=1.0).contains(&self.hurst) {
            return Some(format!(
                "{:.2} is outside 0 … 1: a slope of the spectrum, not a law; look for form, noise or a filter",
                self.hurst
            ));
        }
        (self.decades() < 1.0 - CRUMB).then(|| {
            format!(
                "from {:.2} of a decade: a slope of the spectrum, not a law; measure a wider field or finer",
                self.decades()
            )
        })
    }

    /// Fractal dimension D = 3 − H of the surface; profiles have 2 − H.
    pub fn fractal_dimension(&self) -> f64 {
        3.0 - self.hurst
    }

    fn of_densities(line: &Line) -> Self {
        Self::of_line(line, -1.0 - 0.5 * line.slope)
    }

    fn of_line(line: &Line, hurst: f64) -> Self {
        let range = line.ends.map(f64::exp);
        Self { hurst, hurst_error: 0.5 * line.slope_error, range, points: line.points }
    }
}

impl Topography {
    /// Computes the mean square difference of heights separated by a lag along `axis`, ⟨(z(x + τ) − z(x))²⟩.
    /// This is the structure function, twice the variogram; 2 Sq² (1 − R(τ)/R(0)) for a stationary surface.
    /// The mean is over the pairs of defined samples.
    ///
    /// The lags are 1, 2, … samples, growing by about √2 to half the topography, each in metres. Lags without
    /// a pair are left out. Sayles & Thomas, Wear 42, 263 (1977).
    pub fn height_differences(&self, axis: Axis) -> Vec<(Metre, SquareMetre)> {
        let axis = match axis {
            Axis::X => 0,
            Axis::Y => 1,
        };
        let mut lags: Vec<usize> = (0..)
            .map(|n| 2f64.powf(0.5 * f64::from(n)).round() as usize)
            .take_while(|lag| 2 * lag <= self.grid().shape[axis])
            .collect();
        lags.dedup();
        let n = self.grid().shape[axis];
        let samples =
            |range: std::ops::Range<usize>| self.heights().slice_axis(ndarray::Axis(axis), range.into());
        let differences = |lag: usize| {
            let (here, there) = (samples(0..n - lag), samples(lag..n));
            mean_square(here.iter().zip(&there).map(|(a, b)| b - a))
        };
        let points = lags.into_iter().map(|lag| (lag as f64 * self.grid().pitch[axis], differences(lag)));
        points.filter(|(_, square)| !square.is_nan()).collect()
    }
}

/// Least-squares line through points.
struct Line {
    centre: (f64, f64),
    slope: f64,
    slope_error: f64,
    /// First and last abscissa.
    ends: [f64; 2],
    points: usize,
}

impl Line {
    /// Fits the logarithms of points with positive values and an abscissa in `range`.
    fn within(range: [f64; 2], points: impl Iterator<Item = (f64, f64)>) -> Result<Self> {
        let inside: Vec<_> = points
            .filter(|(x, y)| (range[0]..=range[1]).contains(x) && *x > 0.0 && *y > 0.0)
            .map(|(x, y)| (x.ln(), y.ln()))
            .collect();
        let count = inside.len();
        check("points in the range", count as f64, count >= 3, "at least three to fit a law to")?;
        Ok(Self::through(&inside))
    }

    /// Fits `points` in the order of their abscissae, at least three.
    fn through(points: &[(f64, f64)]) -> Self {
        let count = points.len() as f64;
        let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), (s, t)| (x + s / count, y + t / count));
        let (product, square) =
            points.iter().fold((0.0, 0.0), |(a, b), (s, t)| (a + (s - x) * (t - y), b + (s - x) * (s - x)));
        let mut line = Self {
            centre: (x, y),
            slope: product / square,
            slope_error: 0.0,
            ends: [points[0].0, points[points.len() - 1].0],
            points: points.len(),
        };
        let share = |(s, _): &(f64, f64)| 1.0 / count + (s - x).powi(2) / square;
        let scatter = |point: &(f64, f64)| (point.0 - x) * line.residual(*point) / (1.0 - share(point));
        line.slope_error = points.iter().map(|point| scatter(point).powi(2)).sum::<f64>().sqrt() / square;
        line
    }

    /// Height of a point above the line.
    fn residual(&self, (x, y): (f64, f64)) -> f64 {
        y - self.centre.1 - self.slope * (x - self.centre.0)
    }

    fn length(&self) -> f64 {
        self.ends[1] - self.ends[0]
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use approx::assert_relative_eq;

    use super::*;
    use crate::{Amplitude, Bins, SelfAffine, Spectrum, Window};
    use asperity_base::grid::{Field, Grid};

    fn self_affine(n: usize, hurst: f64, waves: [Option<f64>; 2], seed: u64) -> Topography {
        let grid = Grid::new([n, n], [1.0; 2]).unwrap();
        let [rolloff, shortest] = waves;
        SelfAffine { hurst, rolloff, shortest, amplitude: Amplitude::Sq(1.0) }.generate(&grid, seed).unwrap()
    }

    #[test]
    fn the_hurst_exponent_is_found_on_a_part_of_a_surface() {
        // Cut out of a larger surface, so that it is not periodic and its densities scatter.
        for hurst in [0.3, 0.5, 0.8] {
            let seeds = 4;
            let (mut mean, mut variance) = (0.0, 0.0);
            for seed in 0..seeds {
                let part = self_affine(512, hurst, [None; 2], seed).window([0, 0, 256, 256]).unwrap();
                let radial = Spectrum::new(&part, Window::Hann).radial(Bins::Logarithmic { per_decade: 10 });
                let fit = SelfAffinity::of_spectrum(&radial, [TAU / 32.0, TAU / 2.5]).unwrap();
                mean += fit.hurst / seeds as f64;
                variance += fit.hurst_error.powi(2) / (seeds * seeds) as f64;
            }
            // The window smears the power law p over a step of 1/8 of its lowest wave number: p² (1/8)²/2
            // there, and less elsewhere. The slope over a decade changes by the fraction 1/ln 10 of it.
            let smearing = 0.5 * (2.0 + 2.0 * hurst).powi(2) / 64.0 / 2.0 / std::f64::consts::LN_10;
            assert!(
                (mean - hurst).abs() < 4.0 * variance.sqrt() + smearing,
                "{mean}, not {hurst}: {}",
                variance.sqrt()
            );
        }
    }

    #[test]
    fn the_longest_range_leaves_out_roll_off_and_cut_off() {
        let (rolloff, shortest) = (40.0, 4.0);
        let surface = self_affine(512, 0.6, [Some(rolloff), Some(shortest)], 2);
        let radial = Spectrum::new(&surface, Window::None).radial(Bins::Logarithmic { per_decade: 20 });
        let fit = SelfAffinity::of_longest_range(&radial).unwrap();
        // The magnitudes are exact. Only the ends may be a ring, 12 %, too far out or in.
        assert_relative_eq!(fit.range[0], TAU / rolloff, max_relative = 0.25);
        assert_relative_eq!(fit.range[1], TAU / shortest, max_relative = 0.25);
        assert!((fit.hurst - 0.6).abs() < 0.03 && fit.hurst_error < 0.02, "{fit:?}");
        assert_relative_eq!(fit.fractal_dimension(), 2.4, max_relative = 0.02);
    }

    #[test]
    fn an_exact_power_law_is_fitted_without_error() {
        let point = |n: i32| {
            let wave_number = 10f64.powf(0.1 * f64::from(n));
            SpectralPoint { wave_number, density: 3.0 * wave_number.powf(-3.4), waves: 1000 }
        };
        let points: Vec<_> = (0..20).map(point).collect();
        let fit = SelfAffinity::of_spectrum(&points, [1.5, 50.0]).unwrap();
        assert_relative_eq!(fit.hurst, 0.7, max_relative = 1e-12);
        assert!(fit.hurst_error < 1e-12 && fit.points == 15, "{fit:?}");
        let message = SelfAffinity::of_spectrum(&points, [1.0, 1.3]).unwrap_err().to_string();
        assert!(message.starts_with("points in the range is 2,"), "{message}");
        assert!(SelfAffinity::of_longest_range(&points[..2]).is_err());
    }

    #[test]
    fn a_slope_is_told_from_a_law() {
        let fit = |hurst, range| SelfAffinity { hurst, hurst_error: 0.01, range, points: 9 };
        assert_eq!(fit(0.8, [1e3, 1e4]).doubt(), None);
        let doubt = |hurst, range| fit(hurst, range).doubt().unwrap();
        assert!(
            doubt(1.63, [1e3, 1e6]).starts_with("1.63 is outside 0 … 1: a slope of the spectrum, not a law")
        );
        assert!(doubt(-0.2, [1e3, 1e6]).contains("-0.20 is outside"));
        assert!(
            doubt(0.8, [1e3, 2e3]).starts_with("from 0.30 of a decade: a slope of the spectrum, not a law")
        );
    }

    #[test]
    fn the_height_differences_of_random_walks_grow_as_the_lag() {
        use rand::{RngExt, SeedableRng};
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let (n, lines) = (512, 200);
        let mut heights = Field::zeros([n, lines]);
        for iy in 0..lines {
            for ix in 1..n {
                heights[[ix, iy]] = heights[[ix - 1, iy]] + if random.random::<bool>() { 1.0 } else { -1.0 };
            }
        }
        heights[[100, 3]] = f64::NAN;
        let walks = Topography::new(Grid::new([n, lines], [0.5, 1.0]).unwrap(), heights).unwrap();
        let differences = walks.height_differences(Axis::X);
        assert_eq!(differences[0], (0.5, 1.0));
        for &(lag, square) in &differences {
            // Squares of Gaussian steps scatter by √2; each line has n/steps independent ones.
            let steps = 2.0 * lag;
            let error = (2.0 * steps / (n as f64 - steps) / lines as f64).sqrt();
            assert_relative_eq!(square, steps, max_relative = 4.0 * error);
        }
        let fit = SelfAffinity::of_height_differences(&differences, [0.5, 32.0]).unwrap();
        let longest = (2.0 * 64.0 / 512.0 / lines as f64).sqrt();
        assert!((fit.hurst - 0.5).abs() < 4.0 * longest / 2.0, "{fit:?}");
    }
}

//! Statistics over 100 seeds: moments, autocorrelation and spectrum of every method, compared with the
//! prescribed ones.
//!
//! The surfaces are independent, so that the standard error of a mean over them is their scatter over √100;
//! the tolerance is four of these. Setting the mean height and Sq of every surface adds a bias of the order
//! of 1/n for a surface of n independent spots.

use std::f64::consts::{FRAC_PI_4, LN_10, TAU};
use std::sync::LazyLock;

use super::noise::tests::covariance;
use super::*;
use crate::HeightParameters;
use asperity_base::grid::Field;
use asperity_base::math::{RealFft2, fft::angular_frequency, fft::symmetric_transform};

const SEEDS: u64 = 100;

const SHAPE: [usize; 2] = [96, 80];

/// A method, with the prescribed autocorrelation of its heights at a distance in x and y, and its moments.
struct PrescribedStatistics {
    name: &'static str,
    generator: Generator,
    autocorrelation: fn([f64; 2]) -> f64,
    ssk: f64,
    sku: f64,
    /// Tolerance of the autocorrelation.
    off: f64,
}

fn prescribed_statistics() -> [PrescribedStatistics; 9] {
    let low_pass = LowPass::new(1.0, [8.0; 2]);
    let rectangular = LowPass { band: Band::Rectangular, ..LowPass::new(1.0, [8.0, 6.0]) };
    let autocorrelation = Autocorrelation::new(1.0, [8.0, 5.0]);
    let ground = Autocorrelation { lay: FRAC_PI_4, ..Autocorrelation::new(1.0, [16.0, 4.0]) };
    let smooth = Autocorrelation { decay: Decay::Gaussian, ..autocorrelation };
    let case = |name, generator, autocorrelation| PrescribedStatistics {
        name,
        generator,
        autocorrelation,
        ssk: 0.0,
        sku: 3.0,
        off: 0.0,
    };
    let circle = |[x, y]: [f64; 2]| match TAU / 8.0 * x.hypot(y) {
        0.0 => 1.0,
        s => 2.0 * libm::j1(s) / s,
    };
    let rectangle = |[x, y]: [f64; 2]| {
        let sinc = |s: f64| if s == 0.0 { 1.0 } else { s.sin() / s };
        sinc(TAU * x / 8.0) * sinc(TAU * y / 6.0)
    };
    let exponential = |[x, y]: [f64; 2]| (-LN_10 * (x / 8.0).hypot(y / 5.0)).exp();
    let gaussian = |[x, y]: [f64; 2]| (-LN_10 * ((x / 8.0).powi(2) + (y / 5.0).powi(2))).exp();
    let lay = |[x, y]: [f64; 2]| (-LN_10 * ((x + y) / 16.0).hypot((y - x) / 4.0) / 2f64.sqrt()).exp();
    let shaped = |ssk, sku| HeightDistribution { ssk, sku };
    [
        case("circular", Generator::LowPass(low_pass), circle),
        case("rectangular", Generator::LowPass(rectangular), rectangle),
        case("exponential", Generator::Autocorrelation(autocorrelation), exponential),
        case("gaussian", Generator::Autocorrelation(smooth), gaussian),
        case("ground", Generator::Autocorrelation(ground), lay),
        PrescribedStatistics {
            ssk: -1.0,
            sku: 4.5,
            ..case(
                "exponential, skewed",
                Generator::Autocorrelation(Autocorrelation { heights: shaped(-1.0, 4.5), ..autocorrelation }),
                exponential,
            )
        },
        PrescribedStatistics {
            ssk: -0.8,
            sku: 3.6,
            ..case(
                "ground, skewed",
                Generator::Autocorrelation(Autocorrelation { heights: shaped(-0.8, 3.6), ..ground }),
                lay,
            )
        },
        PrescribedStatistics {
            sku: 2.0,
            off: 2e-3,
            ..case(
                "gaussian, flat",
                Generator::Autocorrelation(Autocorrelation { heights: shaped(0.0, 2.0), ..smooth }),
                gaussian,
            )
        },
        PrescribedStatistics {
            ssk: 1.0,
            sku: 4.5,
            off: 0.02,
            ..case(
                "circular, skewed",
                Generator::LowPass(LowPass { heights: shaped(1.0, 4.5), ..low_pass }),
                circle,
            )
        },
    ]
}

/// Surfaces of every case, generated once for all tests.
static SURFACES: LazyLock<Vec<Vec<Topography>>> = LazyLock::new(|| {
    let grid = Grid::new(SHAPE, [1.0; 2]).unwrap();
    let surface = |case: &PrescribedStatistics, seed| case.generator.generate(&grid, seed).unwrap();
    prescribed_statistics().iter().map(|case| (0..SEEDS).map(|seed| surface(case, seed)).collect()).collect()
});

fn cases() -> impl Iterator<Item = (PrescribedStatistics, &'static [Topography])> {
    prescribed_statistics().into_iter().zip(SURFACES.iter().map(Vec::as_slice))
}

impl PrescribedStatistics {
    /// Area over ∫ R²: the number of independent spots of a surface.
    fn spots(&self) -> f64 {
        let half = |n: usize| -(n as i32 / 2)..n as i32 / 2;
        let squares = half(SHAPE[0]).flat_map(|i| half(SHAPE[1]).map(move |j| [f64::from(i), f64::from(j)]));
        (SHAPE[0] * SHAPE[1]) as f64 / squares.map(|at| (self.autocorrelation)(at).powi(2)).sum::<f64>()
    }
}

#[test]
fn skewness_and_kurtosis_are_those_asked_for_over_a_hundred_seeds() {
    for (case, surfaces) in cases() {
        let [mut skewness, mut kurtosis] = [Sample::default(), Sample::default()];
        for surface in surfaces {
            let parameters = HeightParameters::new(surface);
            assert!((parameters.sq - 1.0).abs() < 1e-12 && surface.mean().abs() < 1e-13, "{}", case.name);
            skewness.add(parameters.ssk);
            kurtosis.add(parameters.sku);
        }
        let spots = case.spots();
        // Bias of the sample moments: up to 10 or so terms of order 1, each over the number of spots.
        skewness.check(case.ssk, 3.0 / spots, || format!("{}: Ssk", case.name));
        kurtosis.check(case.sku, 12.0 / spots, || format!("{}: Sku", case.name));
        // Gaussian heights scatter as in theory: √(6/n), √(24/n), with n for R³ and R⁴ larger than that for
        // R².
        if case.sku == 3.0 {
            assert!(skewness.deviation() < 1.3 * (6.0 / spots).sqrt(), "{}", case.name);
            assert!(kurtosis.deviation() < 1.3 * (24.0 / spots).sqrt(), "{}", case.name);
        }
    }
}

#[test]
fn the_autocorrelation_is_the_one_asked_for_over_a_hundred_seeds() {
    const LAGS: [[i32; 2]; 10] =
        [[1, 0], [0, 1], [4, 0], [0, 4], [8, 0], [0, 10], [3, 3], [3, -3], [6, 5], [20, -12]];
    for (case, surfaces) in cases() {
        let mut samples = LAGS.map(|_| Sample::default());
        for surface in surfaces {
            let mut mirrored = surface.heights().clone();
            mirrored.invert_axis(ndarray::Axis(1));
            for (sample, [i, j]) in samples.iter_mut().zip(LAGS) {
                let field = if j < 0 { &mirrored } else { surface.heights() };
                sample.add(covariance(field, [i as usize, j.unsigned_abs() as usize]));
            }
        }
        for (sample, lag) in samples.iter().zip(LAGS) {
            let expected = (case.autocorrelation)(lag.map(f64::from));
            sample.check(expected, case.off + 4.0 / case.spots(), || format!("{}: R{lag:?}", case.name));
        }
    }
}

#[test]
fn the_spectrum_is_the_one_asked_for_over_a_hundred_seeds() {
    const RINGS: usize = 10;
    let [nx, ny] = SHAPE;
    // Waves along x + y and along x − y are separated, to show a lay at 45°.
    let bin = |k: usize, l: usize| {
        let q = [angular_frequency(k, nx, 1.0), angular_frequency(l, ny, 1.0)];
        let ring = (q[0].hypot(q[1]) / (0.5 * TAU) * RINGS as f64) as usize;
        let sector = usize::from(q[0] * q[1] < 0.0);
        (ring < RINGS && (k, l) != (0, 0)).then_some([ring, sector])
    };
    for (case, surfaces) in cases() {
        // The mean periodogram of a nonperiodic surface: the transform of R times the number of pairs at each
        // lag.
        let pairs = |i: usize, n: usize| [(i as f64, (n - i) as f64), (i as f64 - n as f64, i as f64)];
        let half = Field::from_shape_fn([nx / 2 + 1, ny], |(i, j)| {
            let mut sum = 0.0;
            for (x, along_x) in pairs(i, nx) {
                for (y, along_y) in pairs(j, ny) {
                    sum += along_x * along_y * (case.autocorrelation)([x, y]);
                }
            }
            sum / (nx * ny) as f64
        });
        let expected = symmetric_transform(&half, SHAPE);
        let mut rings = [[0.0; 2]; RINGS];
        for k in 0..nx {
            for l in 0..=ny / 2 {
                if let Some([ring, sector]) = bin(k, l) {
                    rings[ring][sector] += expected[[l, k]];
                }
            }
        }
        let total: f64 = rings.iter().flatten().sum();
        let fft = RealFft2::new(SHAPE);
        let mut samples = [0; RINGS].map(|_| [Sample::default(), Sample::default()]);
        for surface in surfaces {
            let mut power = [[0.0; 2]; RINGS];
            for ((k, l), value) in fft.forward(surface.heights()).indexed_iter() {
                if let Some([ring, sector]) = bin(k, l) {
                    power[ring][sector] += value.norm_sqr() / (nx * ny) as f64;
                }
            }
            for (samples, power) in samples.iter_mut().zip(power) {
                samples.iter_mut().zip(power).for_each(|(sample, power)| sample.add(power / total));
            }
        }
        for ring in 0..RINGS {
            for sector in 0..2 {
                let share = rings[ring][sector] / total;
                let bias = case.off + 4.0 * share / case.spots() + 1e-12;
                let sample = &samples[ring][sector];
                sample.check(share, bias, || format!("{}: ring {ring}, sector {sector}", case.name));
            }
        }
    }
}

/// Results over the seeds.
#[derive(Default)]
struct Sample {
    values: Vec<f64>,
}

impl Sample {
    fn add(&mut self, value: f64) {
        self.values.push(value);
    }

    fn mean(&self) -> f64 {
        self.values.iter().sum::<f64>() / self.values.len() as f64
    }

    fn deviation(&self) -> f64 {
        let mean = self.mean();
        let squares: f64 = self.values.iter().map(|value| (value - mean).powi(2)).sum();
        (squares / (self.values.len() - 1) as f64).sqrt()
    }

    /// Checks a value to four standard errors plus a bias.
    fn check(&self, expected: f64, bias: f64, what: impl Fn() -> String) {
        let (mean, error) = (self.mean(), self.deviation() / (self.values.len() as f64).sqrt());
        let tolerance = 4.0 * error + bias;
        assert!(
            (mean - expected).abs() < tolerance,
            "{}: {mean:.5}, not {expected:.5} ± {tolerance:.5}",
            what()
        );
    }
}

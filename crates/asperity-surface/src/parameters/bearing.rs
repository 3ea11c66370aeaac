//! The material ratio curve, also bearing or Abbott–Firestone curve.

use rayon::prelude::*;

use crate::Topography;
use asperity_base::error::{Error, Result};
use asperity_base::units::Metre;

/// Height above which a given fraction of the samples lies, relative to the mean of the samples.
///
/// The `n` defined samples, in descending order, lie at the centres of their fractions of the ratio, z(p = (i
/// − ½)/n) = zᵢ. Between them the curve is linear. Before the first and after the last it is constant. Its
/// integral is therefore the sum of the samples, and a sampled ramp gives a ramp.
///
/// ISO 25178-2:2021, 4.5, and ISO 21920-2:2021 define the functions: Smr(c) = [`ratio`](Self::ratio)`(c)`,
/// Smc(p) = [`height`](Self::height)`(p)`, Sdc(p, q) = Smc(p) − Smc(q), Vm(p) =
/// [`material_volume`](Self::material_volume)`(p)`, Vv(p) = [`void_volume`](Self::void_volume)`(p)`. A ratio
/// outside 0 … 1 is clamped.
#[derive(Debug, Clone, PartialEq)]
pub struct BearingCurve {
    /// Descending, relative to the mean.
    heights: Vec<Metre>,
    /// Sum of the heights before each [`BLOCK`] of them.
    sums: Vec<Metre>,
}

/// Number of heights whose sum is not kept.
const BLOCK: usize = 1 << 10;

impl BearingCurve {
    /// Creates the curve of `samples`, NaN if undefined.
    ///
    /// # Errors
    /// [`Error::NothingDefined`] if all are undefined.
    pub fn new<'a>(samples: impl IntoIterator<Item = &'a f64>) -> Result<Self> {
        let mut heights: Vec<f64> = samples.into_iter().copied().collect();
        let all = heights.len();
        heights.retain(|z| !z.is_nan());
        if heights.is_empty() {
            return Err(Error::NothingDefined { samples: all });
        }
        let mean = heights.iter().sum::<f64>() / heights.len() as f64;
        heights.iter_mut().for_each(|z| *z -= mean);
        heights.par_sort_unstable_by(|a, b| b.total_cmp(a));
        let mut sum = 0.0;
        let sums = heights.chunks(BLOCK).map(|block| {
            let before = sum;
            sum = block.iter().fold(before, |sum, z| sum + z);
            before
        });
        let sums = sums.collect();
        Ok(Self { heights, sums })
    }

    /// Returns Smc, the height at a material ratio from 0 (the highest sample) to 1 (the lowest), relative to
    /// the mean.
    pub fn height(&self, ratio: f64) -> Metre {
        let Place { index, beyond, step } = self.place(ratio);
        self.heights[index] + beyond * step
    }

    /// Returns Smr, the material ratio at a height relative to the mean: the largest at which the curve has
    /// this height.
    pub fn ratio(&self, height: Metre) -> f64 {
        let (n, above) = (self.heights.len(), self.heights.partition_point(|&z| z >= height));
        if above == 0 || above == n {
            return above as f64 / n as f64;
        }
        let (over, under) = (self.heights[above - 1], self.heights[above]);
        (above as f64 - 0.5 + (over - height) / (over - under)) / n as f64
    }

    /// Returns Vm, the material above the height at `ratio`, ∫₀ᵖ (z(q) − z(p)) dq, in m³/m².
    pub fn material_volume(&self, ratio: f64) -> Metre {
        let ratio = ratio.clamp(0.0, 1.0);
        self.integral(ratio) - ratio * self.height(ratio)
    }

    /// Returns Vv, the void below the height at `ratio`, ∫ₚ¹ (z(p) − z(q)) dq, in m³/m².
    pub fn void_volume(&self, ratio: f64) -> Metre {
        let ratio = ratio.clamp(0.0, 1.0);
        (1.0 - ratio) * self.height(ratio) - (self.integral(1.0) - self.integral(ratio))
    }

    /// Returns the curve at `n` ratios from 0 to 1, for plotting: `[ratio, height]`.
    pub fn sampled(&self, n: usize) -> Vec<[f64; 2]> {
        let ratio = |i: usize| i as f64 / n.saturating_sub(1).max(1) as f64;
        (0..n).map(|i| [ratio(i), self.height(ratio(i))]).collect()
    }

    /// Heights of the samples relative to their mean, descending.
    pub fn heights(&self) -> &[Metre] {
        &self.heights
    }

    /// ∫₀ᵖ z(q) dq.
    fn integral(&self, ratio: f64) -> Metre {
        let Place { index, beyond, step } = self.place(ratio);
        let block = index / BLOCK;
        let before = self.heights[block * BLOCK..index].iter().fold(self.sums[block], |sum, z| sum + z);
        let sum = before + self.heights[index] * (0.5 + beyond) + 0.5 * beyond * beyond * step;
        sum / self.heights.len() as f64
    }

    fn place(&self, ratio: f64) -> Place {
        let last = self.heights.len() - 1;
        let position = ratio.clamp(0.0, 1.0) * self.heights.len() as f64 - 0.5;
        let index = (position.max(0.0) as usize).min(last);
        let inside = position > 0.0 && index < last;
        let step = if inside { self.heights[index + 1] - self.heights[index] } else { 0.0 };
        Place { index, beyond: position - index as f64, step }
    }
}

/// A ratio as its distance from the sample before it, or from the first, in units of one sample.
struct Place {
    index: usize,
    beyond: f64,
    /// Height difference from the sample to the next.
    step: f64,
}

impl Topography {
    /// Computes the areal material ratio curve of the defined samples.
    ///
    /// # Errors
    /// [`Error::NothingDefined`] without a defined sample.
    pub fn bearing_curve(&self) -> Result<BearingCurve> {
        BearingCurve::new(self.heights())
    }
}

#[cfg(test)]
pub(super) mod tests {
    use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

    use approx::assert_abs_diff_eq;

    use super::*;

    #[test]
    fn the_curve_of_a_ramp_is_a_straight_line() {
        let curve = ramp();
        // 500 steps of 0.01: the range of a ramp whose samples represent their cells.
        for ratio in [0.002, 0.1, 0.3333, 0.5, 0.75, 0.998] {
            assert_abs_diff_eq!(curve.height(ratio), 5.0 * (0.5 - ratio), epsilon = 1e-12);
            assert_abs_diff_eq!(curve.ratio(5.0 * (0.5 - ratio)), ratio, epsilon = 1e-12);
            // Except for the constant ends, of half a sample: (0.01/2)(1/2·500)/2.
            assert_abs_diff_eq!(curve.material_volume(ratio), 2.5 * ratio * ratio, epsilon = 2.6e-6);
            assert_abs_diff_eq!(curve.void_volume(ratio), 2.5 * (1.0 - ratio).powi(2), epsilon = 2.6e-6);
        }
    }

    #[test]
    fn the_curve_of_a_sinusoid_is_a_cosine() {
        let (n, curve) = (20_000, wave(20_000));
        // Two flanks contain each height twice, so that the curve deviates from cos πp by up to π/2n.
        let off = 0.51 * PI / f64::from(n);
        let volume = |p: f64| (PI * p).sin() / PI - p * (PI * p).cos();
        for p in [0.01, 0.1, 0.4, 0.5, 0.8, 0.97] {
            assert_abs_diff_eq!(curve.height(p), (PI * p).cos(), epsilon = off);
            assert_abs_diff_eq!(curve.ratio((PI * p).cos()), p, epsilon = 1.0 / f64::from(n));
            assert_abs_diff_eq!(curve.material_volume(p), volume(p), epsilon = off);
            assert_abs_diff_eq!(curve.void_volume(p), volume(1.0 - p), epsilon = off);
        }
    }

    #[test]
    fn the_curve_of_gaussian_heights_is_their_quantile_function() {
        let (n, curve) = (10_000, gaussian(10_000));
        let density = |x: f64| (-0.5 * x * x).exp() / TAU.sqrt();
        let above = |x: f64| 0.5 * libm::erfc(x * FRAC_1_SQRT_2);
        // The tail beyond the first sample contains 1/2n of the heights, which there lie within 1/x₀ of it.
        let tail = 1.0 / f64::from(n);
        let volume = |x: f64| density(x) - above(x) * x;
        for p in [0.001, 0.025, 0.1, 0.5, 0.8, 0.99] {
            let x = quantile(1.0 - p);
            // Linear between samples: f″Δ²/8 with f″ = x/φ², plus a tenth for the next order.
            let curved = 1.1 * 0.125 * (tail / density(x)).powi(2) * x.abs();
            assert_abs_diff_eq!(curve.height(p), x, epsilon = curved + 1e-12);
            assert_abs_diff_eq!(curve.material_volume(p), volume(x), epsilon = tail + curved);
            assert_abs_diff_eq!(curve.void_volume(p), volume(-x), epsilon = tail + curved);
        }
    }

    #[test]
    fn turned_over_material_is_void() {
        let [up, down] = peaks_and_pits();
        for p in [0.0, 0.2, 0.77, 1.0] {
            assert_abs_diff_eq!(up.material_volume(p), down.void_volume(1.0 - p), epsilon = 1e-13);
        }
    }

    #[test]
    fn ratio_and_height_undo_each_other_and_volumes_balance() {
        arbtest::arbtest(|u| {
            // Few levels, so that there are plateaus.
            let levels: Vec<f64> = u.arbitrary_iter::<u8>()?.flatten().map(|z| f64::from(z % 16)).collect();
            let Ok(curve) = BearingCurve::new(&levels) else { return Ok(()) };
            let p = f64::from(u.arbitrary::<u16>()?) / f64::from(u16::MAX);
            let z = curve.height(p);
            // On a plateau the ratio is that of its end; round-off may move it to the start.
            let n = levels.len() as f64;
            assert!(curve.ratio(z - 1e-9) >= p - 1e-12);
            assert!(curve.ratio(z + 1e-9) <= p + 1e-9 || p < 0.5 / n);
            // With the mean at 0, the void below a height exceeds the material above it by the height.
            assert!((curve.void_volume(p) - curve.material_volume(p) - z).abs() < 1e-12);
            assert!(curve.material_volume(p) >= -1e-13 && curve.void_volume(p) >= -1e-13);
            Ok(())
        });
    }

    #[test]
    fn a_curve_needs_a_defined_sample() {
        let nothing = BearingCurve::new(&[f64::NAN; 3]);
        assert!(matches!(nothing, Err(Error::NothingDefined { samples: 3 })));
        let one = BearingCurve::new(&[f64::NAN, 4.0]).unwrap();
        assert_eq!((one.heights(), one.sampled(2)), (&[0.0][..], vec![[0.0, 0.0], [1.0, 0.0]]));
    }

    /// A ramp of height 5 in 500 steps.
    pub(in crate::parameters) fn ramp() -> BearingCurve {
        curve(500, |p| 5.0 * p)
    }

    /// One wave of amplitude 1 in `n` samples.
    pub(in crate::parameters) fn wave(n: u32) -> BearingCurve {
        curve(n, |p| (TAU * p).cos())
    }

    /// Gaussian heights of rms 1: the middle quantiles of `n` equal parts.
    pub(in crate::parameters) fn gaussian(n: u32) -> BearingCurve {
        curve(n, quantile)
    }

    /// Rare high peaks, and the same surface turned over.
    pub(in crate::parameters) fn peaks_and_pits() -> [BearingCurve; 2] {
        [1.0, -1.0].map(|sign| curve(997, |p| sign * p.powi(3)))
    }

    fn curve(n: u32, height: impl Fn(f64) -> f64) -> BearingCurve {
        let heights: Vec<f64> = (0..n).map(|i| height((f64::from(i) + 0.5) / f64::from(n))).collect();
        BearingCurve::new(&heights).unwrap()
    }

    /// Height below which the fraction `p` of Gaussian heights lies, by Newton's method.
    pub(in crate::parameters) fn quantile(p: f64) -> f64 {
        let step = |x: f64| (0.5 * libm::erfc(-x * FRAC_1_SQRT_2) - p) * TAU.sqrt() * (0.5 * x * x).exp();
        (0..40).fold(0.0, |x, _| x - step(x).clamp(-0.5, 0.5))
    }
}

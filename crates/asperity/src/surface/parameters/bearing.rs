//! The material ratio curve, also bearing or Abbott–Firestone curve.

use crate::error::{Error, Result};
use crate::surface::Topography;
use crate::units::Metre;

/// Share of the material ratio that the equivalent straight line is fitted to.
const CENTRAL_REGION: f64 = 0.4;

/// The height above which a share of the samples lies, heights taken from the mean of the samples.
///
/// The `n` defined samples in descending order stand in the middle of their shares of the ratio,
/// z(p = (i − ½)/n) = zᵢ; between them the curve is linear, and before the first and after the last of them it is
/// level. So its integral is the sum of the samples, and a sampled ramp gives a ramp.
///
/// ISO 25178-2:2021, 4.5, and ISO 21920-2:2021 name the functions: Smr(c) = [`ratio`](Self::ratio)`(c)`,
/// Smc(p) = [`height`](Self::height)`(p)`, Sdc(p, q) = Smc(p) − Smc(q),
/// Vm(p) = [`material_volume`](Self::material_volume)`(p)`, Vv(p) = [`void_volume`](Self::void_volume)`(p)`. A
/// ratio outside 0 … 1 counts as the nearer of the two.
#[derive(Debug, Clone, PartialEq)]
pub struct BearingCurve {
    /// Descending, from the mean.
    heights: Vec<Metre>,
    /// Sum of the heights before each.
    sums: Vec<Metre>,
}

impl BearingCurve {
    /// The curve of `samples`, NaN where undefined.
    ///
    /// # Errors
    /// [`Error::NothingDefined`] if all are.
    pub fn new<'a>(samples: impl IntoIterator<Item = &'a f64>) -> Result<Self> {
        let mut undefined = 0;
        let defined = samples.into_iter().copied().filter(|z| {
            undefined += usize::from(z.is_nan());
            !z.is_nan()
        });
        let mut heights: Vec<f64> = defined.collect();
        if heights.is_empty() {
            return Err(Error::NothingDefined { samples: undefined });
        }
        let mean = heights.iter().sum::<f64>() / heights.len() as f64;
        heights.iter_mut().for_each(|z| *z -= mean);
        heights.sort_unstable_by(|a, b| b.total_cmp(a));
        let sums = heights.iter().scan(0.0, |sum, z| Some(std::mem::replace(sum, *sum + z))).collect();
        Ok(Self { heights, sums })
    }

    /// Height at a material ratio from 0 (the highest sample) to 1 (the lowest), from the mean: Smc.
    pub fn height(&self, ratio: f64) -> Metre {
        let Place { index, beyond, step } = self.place(ratio);
        self.heights[index] + beyond * step
    }

    /// Material ratio at a height from the mean, the largest at which the curve is as high: Smr.
    pub fn ratio(&self, height: Metre) -> f64 {
        let (n, above) = (self.heights.len(), self.heights.partition_point(|&z| z >= height));
        if above == 0 || above == n {
            return above as f64 / n as f64;
        }
        let (over, under) = (self.heights[above - 1], self.heights[above]);
        (above as f64 - 0.5 + (over - height) / (over - under)) / n as f64
    }

    /// Material above the height at `ratio`, ∫₀ᵖ (z(q) − z(p)) dq, in m³/m²: Vm.
    pub fn material_volume(&self, ratio: f64) -> Metre {
        let ratio = ratio.clamp(0.0, 1.0);
        self.integral(ratio) - ratio * self.height(ratio)
    }

    /// Void below the height at `ratio`, ∫ₚ¹ (z(p) − z(q)) dq, in m³/m²: Vv.
    pub fn void_volume(&self, ratio: f64) -> Metre {
        let ratio = ratio.clamp(0.0, 1.0);
        (1.0 - ratio) * self.height(ratio) - (self.integral(1.0) - self.integral(ratio))
    }

    /// The parameters of stratified surfaces, Sk and its kin.
    ///
    /// The 40 % of the ratio over which the secant is least steep, the first if there are several, are fitted by
    /// a straight line, least squares of the heights. Where it meets the ratios 0 and 1 the core ends. ISO
    /// 13565-2:1996, 4.2, as ISO 25178-2 and ISO 21920-2 take it. NaN below about five samples, where 40 % hold
    /// fewer than two.
    pub fn core(&self) -> Core {
        let [upper, lower] = self.equivalent_line();
        let (mrk1, mrk2) = (self.ratio(upper), self.ratio(lower));
        let (ak1, ak2) = (self.material_volume(mrk1), self.void_volume(mrk2));
        // A triangle of that area on that base; none where nothing protrudes.
        let triangle = |area: f64, base: f64| if base > 0.0 { 2.0 * area / base } else { 0.0 };
        let core = Core {
            upper,
            lower,
            mrk1,
            mrk2,
            ak1,
            ak2,
            k: upper - lower,
            pk: triangle(ak1, mrk1),
            vk: triangle(ak2, 1.0 - mrk2),
            pkx: (self.height(0.0) - upper).max(0.0),
            vkx: (lower - self.height(1.0)).max(0.0),
        };
        if core.k.is_nan() { Core::undefined() } else { core }
    }

    /// The curve at `n` ratios from 0 to 1, to be plotted: `[ratio, height]`.
    pub fn sampled(&self, n: usize) -> Vec<[f64; 2]> {
        let ratio = |i: usize| i as f64 / n.saturating_sub(1).max(1) as f64;
        (0..n).map(|i| [ratio(i), self.height(ratio(i))]).collect()
    }

    /// The samples' heights from their mean, descending.
    pub fn heights(&self) -> &[Metre] {
        &self.heights
    }

    /// Heights at the ratios 0 and 1 of the straight line through the central region.
    fn equivalent_line(&self) -> [Metre; 2] {
        let n = self.heights.len() as f64;
        let start = self.central_region();
        // The samples within, a rounding of the ends put aside.
        let first = (start * n - 0.5 - 1e-9).ceil().max(0.0) as usize;
        let last = ((start + CENTRAL_REGION) * n - 0.5 + 1e-9).floor().clamp(0.0, n - 1.0) as usize;
        let inside = || (first..=last).map(|i| ((i as f64 + 0.5) / n, self.heights[i]));
        let count = inside().count() as f64;
        let (ratio, height) = inside().fold((0.0, 0.0), |sum, (p, z)| (sum.0 + p / count, sum.1 + z / count));
        let (products, squares) = inside().fold((0.0, 0.0), |sum, (p, z)| {
            (sum.0 + (p - ratio) * (z - height), sum.1 + (p - ratio).powi(2))
        });
        let slope = products / squares;
        [height - slope * ratio, height + slope * (1.0 - ratio)]
    }

    /// The ratio at which the flattest 40 % of the curve begin.
    ///
    /// What the curve falls over 40 % is linear in their begin between the places where either end passes a
    /// sample: one of these is the least.
    fn central_region(&self) -> f64 {
        let n = self.heights.len();
        let last = 1.0 - CENTRAL_REGION;
        let samples = (0..n).map(|i| (i as f64 + 0.5) / n as f64);
        let begins = samples.flat_map(|ratio| [ratio, ratio - CENTRAL_REGION]);
        let falls: Vec<(f64, f64)> = begins
            .filter(|begin| (0.0..=last).contains(begin))
            .chain([0.0, last])
            .map(|begin| (self.height(begin) - self.height(begin + CENTRAL_REGION), begin))
            .collect();
        // What differs by a rounding is equal.
        let rounding = 1e-12 * (self.heights[0] - self.heights[n - 1]);
        let least = falls.iter().fold(f64::INFINITY, |least, &(fall, _)| least.min(fall)) + rounding;
        let flattest = falls.iter().filter(|(fall, _)| *fall <= least).map(|(_, begin)| *begin);
        flattest.fold(last, f64::min)
    }

    /// ∫₀ᵖ z(q) dq.
    fn integral(&self, ratio: f64) -> Metre {
        let Place { index, beyond, step } = self.place(ratio);
        let sum = self.sums[index] + self.heights[index] * (0.5 + beyond) + 0.5 * beyond * beyond * step;
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

/// A ratio by its distance from the sample before it, or from the first, in shares of one sample.
struct Place {
    index: usize,
    beyond: f64,
    /// What the curve rises from the sample to the next.
    step: f64,
}

/// The core of a bearing curve, and what protrudes from it: Sk, Spk and their kin by the letters after S or R.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Core {
    /// Height of the equivalent line at the ratio 0, from the mean.
    pub upper: Metre,
    /// Height of the equivalent line at the ratio 1, from the mean.
    pub lower: Metre,
    /// Height of the core, `upper` − `lower`.
    pub k: Metre,
    /// Reduced height of what protrudes above: of a right triangle of area `ak1` on the base `mrk1`.
    pub pk: Metre,
    /// Reduced depth of what lies below: of a right triangle of area `ak2` on the base 1 − `mrk2`.
    pub vk: Metre,
    /// Height of the highest sample above the core, not reduced.
    pub pkx: Metre,
    /// Depth of the lowest sample below the core, not reduced.
    pub vkx: Metre,
    /// Material ratio at the upper end of the core.
    pub mrk1: f64,
    /// Material ratio at the lower end of the core.
    pub mrk2: f64,
    /// Material above the core, m³/m² (of a profile m²/m).
    pub ak1: Metre,
    /// Void below the core, m³/m² (of a profile m²/m).
    pub ak2: Metre,
}

impl Core {
    fn undefined() -> Self {
        const NAN: f64 = f64::NAN;
        Self {
            upper: NAN,
            lower: NAN,
            k: NAN,
            pk: NAN,
            vk: NAN,
            pkx: NAN,
            vkx: NAN,
            mrk1: NAN,
            mrk2: NAN,
            ak1: NAN,
            ak2: NAN,
        }
    }
}

impl Topography {
    /// The areal material ratio curve of the defined samples.
    ///
    /// # Errors
    /// [`Error::NothingDefined`] without a defined sample.
    pub fn bearing_curve(&self) -> Result<BearingCurve> {
        BearingCurve::new(self.heights())
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

    use approx::{assert_abs_diff_eq, assert_relative_eq};

    use super::*;
    use crate::math::integrate;

    #[test]
    fn the_curve_of_a_ramp_is_a_straight_line_and_all_core() {
        let ramp: Vec<f64> = (0..500).map(|i| 3.0 + 0.01 * f64::from(i)).collect();
        let curve = BearingCurve::new(&ramp).unwrap();
        // 500 steps of 0.01: the range of a ramp whose samples stand for their cells.
        for ratio in [0.002, 0.1, 0.3333, 0.5, 0.75, 0.998] {
            assert_abs_diff_eq!(curve.height(ratio), 5.0 * (0.5 - ratio), epsilon = 1e-12);
            assert_abs_diff_eq!(curve.ratio(5.0 * (0.5 - ratio)), ratio, epsilon = 1e-12);
            // But for the level ends, of half a sample: (0.01/2)(1/2·500)/2.
            assert_abs_diff_eq!(curve.material_volume(ratio), 2.5 * ratio * ratio, epsilon = 2.6e-6);
            assert_abs_diff_eq!(curve.void_volume(ratio), 2.5 * (1.0 - ratio).powi(2), epsilon = 2.6e-6);
        }
        let core = curve.core();
        assert_relative_eq!(core.k, 5.0, max_relative = 1e-12);
        assert_eq!((core.pk, core.vk, core.pkx, core.vkx), (0.0, 0.0, 0.0, 0.0));
        assert_eq!((core.mrk1, core.mrk2), (0.0, 1.0));
    }

    #[test]
    fn a_sinusoid_is_flattest_at_its_crests() {
        let n = 20_000;
        let wave: Vec<f64> = (0..n).map(|i| (TAU * (f64::from(i) + 0.5) / f64::from(n)).cos()).collect();
        let curve = BearingCurve::new(&wave).unwrap();
        // Two flanks give each height twice, so that the curve is up to π/2n off cos πp.
        let off = 0.51 * PI / f64::from(n);
        let volume = |p: f64| (PI * p).sin() / PI - p * (PI * p).cos();
        for p in [0.01, 0.1, 0.4, 0.5, 0.8, 0.97] {
            assert_abs_diff_eq!(curve.height(p), (PI * p).cos(), epsilon = off);
            assert_abs_diff_eq!(curve.ratio((PI * p).cos()), p, epsilon = 1.0 / f64::from(n));
            assert_abs_diff_eq!(curve.material_volume(p), volume(p), epsilon = off);
            assert_abs_diff_eq!(curve.void_volume(p), volume(1.0 - p), epsilon = off);
        }
        // The secant is as flat from 0 to 40 % as from 60 to 100 %: the first counts. Least squares of cos πp:
        let w = CENTRAL_REGION;
        let slope = 12.0 / w.powi(3) * (0.5 * w * (PI * w).sin() / PI + ((PI * w).cos() - 1.0) / PI.powi(2));
        let upper = (PI * w).sin() / (PI * w) - 0.5 * w * slope;
        let core = curve.core();
        // Of the line, samples off by δ turn the slope by at most 3δ/w.
        assert_abs_diff_eq!(core.k, -slope, epsilon = 3.0 / w * off);
        assert_abs_diff_eq!(core.upper, upper, epsilon = 4.0 * off);
        // It starts above the crests, so that nothing protrudes there; below, it ends at upper + slope.
        assert!(upper > 1.0 && core.mrk1 == 0.0 && core.pk == 0.0);
        let mrk2 = ((upper + slope).acos() / PI, volume(1.0 - (upper + slope).acos() / PI));
        assert_abs_diff_eq!(core.mrk2, mrk2.0, epsilon = 10.0 * off);
        assert_abs_diff_eq!(core.vk, 2.0 * mrk2.1 / (1.0 - mrk2.0), epsilon = 20.0 * off);
    }

    #[test]
    fn gaussian_heights_have_their_core_by_quadrature() {
        let n = 10_000;
        let quantiles: Vec<f64> = (0..n).map(|i| quantile((f64::from(i) + 0.5) / f64::from(n))).collect();
        let curve = BearingCurve::new(&quantiles).unwrap();
        let density = |x: f64| (-0.5 * x * x).exp() / TAU.sqrt();
        let above = |x: f64| 0.5 * libm::erfc(x * FRAC_1_SQRT_2);
        // The tail beyond the first sample holds 1/2n of the heights, which there is within 1/x₀ of it.
        let tail = 1.0 / f64::from(n);
        let volume = |x: f64| density(x) - above(x) * x;
        for p in [0.001, 0.025, 0.1, 0.5, 0.8, 0.99] {
            let x = quantile(1.0 - p);
            // Linear between samples: f″Δ²/8 with f″ = x/φ², and a tenth for the next order.
            let curved = 1.1 * 0.125 * (tail / density(x)).powi(2) * x.abs();
            assert_abs_diff_eq!(curve.height(p), x, epsilon = curved + 1e-12);
            assert_abs_diff_eq!(curve.material_volume(p), volume(x), epsilon = tail + curved);
            assert_abs_diff_eq!(curve.void_volume(p), volume(-x), epsilon = tail + curved);
        }
        // Least squares over the middle 40 %, dp = φ dx.
        let end = quantile(0.7);
        let moment = integrate(-end, end, |x| (0.5 - above(x)) * x * density(x));
        let sk = 12.0 / 0.4f64.powi(3) * moment;
        let core = curve.core();
        // With one sample more or less: over the width w, Sk = √2π (1 + πw²/20 …).
        assert_relative_eq!(core.k, sk, max_relative = PI / 10.0 * 0.4 * tail);
        assert_abs_diff_eq!(core.mrk1, above(0.5 * sk), epsilon = tail);
        assert_abs_diff_eq!(core.pk, 2.0 * volume(0.5 * sk) / above(0.5 * sk), epsilon = 20.0 * tail);
        assert_abs_diff_eq!(core.vk, core.pk, epsilon = 1e-9);
        assert_abs_diff_eq!(core.mrk1, 1.0 - core.mrk2, epsilon = 1e-9);
    }

    #[test]
    fn turned_over_peaks_are_pits() {
        let heights: Vec<f64> = (0..997).map(|i| ((f64::from(i) * 0.7548776662) % 1.0).powi(3)).collect();
        let turned: Vec<f64> = heights.iter().map(|z| -z).collect();
        let [up, down] = [heights, turned].map(|heights| BearingCurve::new(&heights).unwrap());
        for p in [0.0, 0.2, 0.77, 1.0] {
            assert_abs_diff_eq!(up.material_volume(p), down.void_volume(1.0 - p), epsilon = 1e-13);
        }
        let [up, down] = [up.core(), down.core()];
        assert!(up.pk > 5.0 * up.vk, "{up:?}");
        for (one, other) in [(up.k, down.k), (up.pk, down.vk), (up.vk, down.pk), (up.pkx, down.vkx)] {
            assert_abs_diff_eq!(one, other, epsilon = 1e-12);
        }
        assert_abs_diff_eq!(up.mrk1, 1.0 - down.mrk2, epsilon = 1e-12);
    }

    #[test]
    fn ratio_and_height_undo_each_other_and_volumes_balance() {
        arbtest::arbtest(|u| {
            // Few levels, so that there are plateaus.
            let levels: Vec<f64> =
                u.arbitrary_iter::<u8>()?.filter_map(|z| z.ok().map(|z| f64::from(z % 16))).collect();
            let Ok(curve) = BearingCurve::new(&levels) else { return Ok(()) };
            let p = f64::from(u.arbitrary::<u16>()?) / f64::from(u16::MAX);
            let z = curve.height(p);
            // On a plateau the ratio is that of its end; a rounding puts it at the begin.
            let n = levels.len() as f64;
            assert!(curve.ratio(z - 1e-9) >= p - 1e-12);
            assert!(curve.ratio(z + 1e-9) <= p + 1e-9 || p < 0.5 / n);
            // With the mean at 0, what lies above a height and what lies below differ by the height.
            assert!((curve.void_volume(p) - curve.material_volume(p) - z).abs() < 1e-12);
            assert!(curve.material_volume(p) >= -1e-13 && curve.void_volume(p) >= -1e-13);
            let core = curve.core();
            assert!(
                core.k.is_nan() || core.mrk1 <= core.mrk2 && core.pk >= -1e-12 && core.vk >= -1e-12,
                "{core:?}"
            );
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

    /// The height below which the part `p` of Gaussian heights lies, by Newton's method.
    fn quantile(p: f64) -> f64 {
        let step = |x: f64| (0.5 * libm::erfc(-x * FRAC_1_SQRT_2) - p) * TAU.sqrt() * (0.5 * x * x).exp();
        (0..40).fold(0.0, |x, _| x - step(x).clamp(-0.5, 0.5))
    }
}

//! Stratified surfaces: the core of a material ratio curve, its peaks and its pits.

use super::bearing::BearingCurve;
use asperity_base::units::Metre;

/// The core of a bearing curve with its peaks and pits: Sk, Spk and related parameters, by the letters after
/// S or R.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Core {
    /// Height of the equivalent line at the ratio 0, relative to the mean.
    pub upper: Metre,
    /// Height of the equivalent line at the ratio 1, relative to the mean.
    pub lower: Metre,
    /// Height of the core, `upper` − `lower`.
    pub k: Metre,
    /// Reduced height of the peaks above: of a right triangle with the area `ak1` and the base `mrk1`.
    pub pk: Metre,
    /// Reduced depth of the pits below: of a right triangle with the area `ak2` and the base 1 − `mrk2`.
    pub vk: Metre,
    /// Height of the highest sample above the core, not reduced.
    pub pkx: Metre,
    /// Depth of the lowest sample below the core, not reduced.
    pub vkx: Metre,
    /// Material ratio at the upper end of the core.
    pub mrk1: f64,
    /// Material ratio at the lower end of the core.
    pub mrk2: f64,
    /// Material above the core, m³/m² (for a profile m²/m).
    pub ak1: Metre,
    /// Void below the core, m³/m² (for a profile m²/m).
    pub ak2: Metre,
}

/// Fraction of the material ratio to which the equivalent straight line is fitted.
const CENTRAL_REGION: f64 = 0.4;

impl BearingCurve {
    /// Computes the parameters of stratified surfaces, Sk and related ones.
    ///
    /// A least-squares line of the heights is fitted to the 40 % of the ratio with the flattest secant; the
    /// first if there are several. The core ends where this line meets the ratios 0 and 1. ISO 13565-2:1996,
    /// 4.2, adopted by ISO 25178-2 and ISO 21920-2. `None` below about five samples, where 40 % contain fewer
    /// than two.
    pub fn core(&self) -> Option<Core> {
        let [upper, lower] = self.equivalent_line()?;
        let (mrk1, mrk2) = (self.ratio(upper), self.ratio(lower));
        let (ak1, ak2) = (self.material_volume(mrk1), self.void_volume(mrk2));
        // Height of a triangle with this area and base; 0 without peaks or pits.
        let triangle = |area: f64, base: f64| if base > 0.0 { 2.0 * area / base } else { 0.0 };
        Some(Core {
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
        })
    }

    /// Returns the heights at the ratios 0 and 1 of the straight line through the central region.
    fn equivalent_line(&self) -> Option<[Metre; 2]> {
        let n = self.heights().len() as f64;
        let start = self.central_region();
        // The samples within, with tolerance for round-off at the ends.
        let first = (start * n - 0.5 - 1e-9).ceil().max(0.0) as usize;
        let last = ((start + CENTRAL_REGION) * n - 0.5 + 1e-9).floor().clamp(0.0, n - 1.0) as usize;
        let inside = || (first..=last).map(|i| ((i as f64 + 0.5) / n, self.heights()[i]));
        let count = inside().count() as f64;
        let (ratio, height) = inside().fold((0.0, 0.0), |sum, (p, z)| (sum.0 + p / count, sum.1 + z / count));
        let (products, squares) = inside().fold((0.0, 0.0), |sum, (p, z)| {
            (sum.0 + (p - ratio) * (z - height), sum.1 + (p - ratio).powi(2))
        });
        let slope = products / squares;
        (last > first).then_some([height - slope * ratio, height + slope * (1.0 - ratio)])
    }

    /// Returns the ratio at which the flattest 40 % of the curve begin.
    ///
    /// The drop over 40 % is linear in their start between the places where either end passes a sample, so
    /// that one of these places is the minimum.
    fn central_region(&self) -> f64 {
        let n = self.heights().len();
        let last = 1.0 - CENTRAL_REGION;
        let samples = (0..n).map(|i| (i as f64 + 0.5) / n as f64);
        let begins = samples.flat_map(|ratio| [ratio, ratio - CENTRAL_REGION]);
        let falls: Vec<(f64, f64)> = begins
            .filter(|begin| (0.0..=last).contains(begin))
            .chain([0.0, last])
            .map(|begin| (self.height(begin) - self.height(begin + CENTRAL_REGION), begin))
            .collect();
        // Differences within round-off count as equal.
        let rounding = 1e-12 * (self.heights()[0] - self.heights()[n - 1]);
        let least = falls.iter().fold(f64::INFINITY, |least, &(fall, _)| least.min(fall)) + rounding;
        let flattest = falls.iter().filter(|(fall, _)| *fall <= least).map(|(_, begin)| *begin);
        flattest.fold(last, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

    use approx::{assert_abs_diff_eq, assert_relative_eq};

    use super::super::bearing::tests::{gaussian, peaks_and_pits, quantile, ramp, wave};
    use super::*;
    use asperity_base::math::integrate;

    #[test]
    fn a_ramp_is_all_core() {
        let core = ramp().core().unwrap();
        assert_relative_eq!(core.k, 5.0, max_relative = 1e-12);
        assert_eq!((core.pk, core.vk, core.pkx, core.vkx), (0.0, 0.0, 0.0, 0.0));
        assert_eq!((core.mrk1, core.mrk2), (0.0, 1.0));
    }

    #[test]
    fn a_sinusoid_is_flattest_at_its_crests() {
        let n = 20_000;
        let off = 0.51 * PI / f64::from(n);
        let volume = |p: f64| (PI * p).sin() / PI - p * (PI * p).cos();
        // The secant is as flat from 0 to 40 % as from 60 to 100 %: the first counts. Least squares of cos
        // πp:
        let w = CENTRAL_REGION;
        let slope = 12.0 / w.powi(3) * (0.5 * w * (PI * w).sin() / PI + ((PI * w).cos() - 1.0) / PI.powi(2));
        let upper = (PI * w).sin() / (PI * w) - 0.5 * w * slope;
        let core = wave(n).core().unwrap();
        // Samples of the line with an error δ change its slope by at most 3δ/w.
        assert_abs_diff_eq!(core.k, -slope, epsilon = 3.0 / w * off);
        assert_abs_diff_eq!(core.upper, upper, epsilon = 4.0 * off);
        // It starts above the crests, so that there are no peaks; below, it ends at upper + slope.
        assert!(upper > 1.0 && core.mrk1 == 0.0 && core.pk == 0.0);
        let mrk2 = ((upper + slope).acos() / PI, volume(1.0 - (upper + slope).acos() / PI));
        assert_abs_diff_eq!(core.mrk2, mrk2.0, epsilon = 10.0 * off);
        assert_abs_diff_eq!(core.vk, 2.0 * mrk2.1 / (1.0 - mrk2.0), epsilon = 20.0 * off);
    }

    #[test]
    fn gaussian_heights_have_their_core_by_quadrature() {
        let n = 10_000;
        let tail = 1.0 / f64::from(n);
        let density = |x: f64| (-0.5 * x * x).exp() / TAU.sqrt();
        let above = |x: f64| 0.5 * libm::erfc(x * FRAC_1_SQRT_2);
        let volume = |x: f64| density(x) - above(x) * x;
        // Least squares over the middle 40 %, dp = φ dx.
        let end = quantile(0.7);
        let moment = integrate(-end, end, |x| (0.5 - above(x)) * x * density(x));
        let sk = 12.0 / CENTRAL_REGION.powi(3) * moment;
        let core = gaussian(n).core().unwrap();
        // With one sample more or less: over the width w, Sk = √2π (1 + πw²/20 …), plus a fifth for the next
        // order.
        assert_relative_eq!(core.k, sk, max_relative = 1.2 * PI / 10.0 * CENTRAL_REGION * tail);
        assert_abs_diff_eq!(core.mrk1, above(0.5 * sk), epsilon = tail);
        assert_abs_diff_eq!(core.pk, 2.0 * volume(0.5 * sk) / above(0.5 * sk), epsilon = 20.0 * tail);
        // The 40 % begin and end at samples: symmetric to half a sample.
        assert_abs_diff_eq!(core.vk, core.pk, epsilon = tail);
        assert_abs_diff_eq!(core.mrk1, 1.0 - core.mrk2, epsilon = tail);
    }

    #[test]
    fn turned_over_peaks_are_pits() {
        let [up, down] = peaks_and_pits().map(|curve| curve.core().unwrap());
        assert!(up.pk > 5.0 * up.vk, "{up:?}");
        for (one, other) in [(up.k, down.k), (up.pk, down.vk), (up.vk, down.pk), (up.pkx, down.vkx)] {
            assert_abs_diff_eq!(one, other, epsilon = 1e-12);
        }
        assert_abs_diff_eq!(up.mrk1, 1.0 - down.mrk2, epsilon = 1e-12);
    }

    #[test]
    fn the_core_ends_in_order_and_nothing_protrudes_inwards() {
        arbtest::arbtest(|u| {
            // Few levels, so that there are plateaus.
            let levels: Vec<f64> = u.arbitrary_iter::<u8>()?.flatten().map(|z| f64::from(z % 16)).collect();
            let Ok(curve) = BearingCurve::new(&levels) else { return Ok(()) };
            let Some(core) = curve.core() else {
                assert!(levels.len() < 5);
                return Ok(());
            };
            assert!(core.mrk1 <= core.mrk2 && core.pk >= -1e-12 && core.vk >= -1e-12, "{core:?}");
            Ok(())
        });
    }
}

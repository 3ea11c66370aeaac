//! Gaussian profile filter of ISO 16610-21, with treatment of ends and holes.

use std::f64::consts::{LN_2, PI};

/// Returns the long waves of `heights`: a mean weighted by exp(−π (x/αλ)²), α = √(ln 2/π), with the cut-off λ
/// in samples.
///
/// The weights end at one cut-off, where the omitted part is 10⁻⁷ of their sum. Near an end and near
/// undefined samples, the weighted least-squares line replaces the weighted mean (ISO 16610-28 calls it
/// retaining the moments). A straight line therefore passes unchanged everywhere. Undefined samples stay
/// undefined.
pub(super) fn smooth(heights: &[f64], cutoff: f64) -> Vec<f64> {
    let reach = (cutoff.ceil() as usize).min(heights.len());
    let weights: Vec<f64> =
        (0..=reach).map(|k| (-PI * PI / LN_2 * (k as f64 / cutoff).powi(2)).exp()).collect();
    let fit = |centre: usize| {
        let window = centre.saturating_sub(reach)..heights.len().min(centre + reach + 1);
        let [mut s0, mut s1, mut s2, mut t0, mut t1] = [0.0; 5];
        for (i, z) in window.clone().zip(&heights[window]).filter(|(_, z)| !z.is_nan()) {
            let (weight, x) = (weights[centre.abs_diff(i)], i as f64 - centre as f64);
            s0 += weight;
            s1 += weight * x;
            s2 += weight * x * x;
            t0 += weight * z;
            t1 += weight * x * z;
        }
        let determinant = s0 * s2 - s1 * s1;
        if determinant > 1e-12 * s0 * s2 { (s2 * t0 - s1 * t1) / determinant } else { t0 / s0 }
    };
    heights.iter().enumerate().map(|(i, z)| if z.is_nan() { f64::NAN } else { fit(i) }).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    #[test]
    fn a_wave_at_the_cutoff_keeps_half_of_its_amplitude_and_others_as_the_filter_says() {
        let n = 1200;
        for (wavelength, cutoff) in [(80.0f64, 80.0f64), (160.0, 80.0), (50.0, 80.0), (80.0, 30.0)] {
            let heights: Vec<f64> = (0..n).map(|i| (TAU * i as f64 / wavelength).sin()).collect();
            let left = 2f64.powf(-(cutoff / wavelength).powi(2));
            let smooth = smooth(&heights, cutoff);
            let error = |i: usize| (smooth[i] - left * heights[i]).abs();
            // Beyond one cut-off from the ends; the omitted weights are erfc(√π/α) = 9.5e-8 of all.
            let worst = (81..n - 81).map(error).fold(0.0, f64::max);
            assert!(worst < 3e-7, "λ {wavelength}, λc {cutoff}: {worst:e}");
        }
    }

    #[test]
    fn a_straight_line_passes_at_ends_and_holes() {
        let mut heights: Vec<f64> = (0..90).map(|i| 3.0 - 0.25 * i as f64).collect();
        heights[30..41].fill(f64::NAN);
        let smooth = smooth(&heights, 20.0);
        for (z, s) in heights.iter().zip(&smooth) {
            assert!(z.is_nan() && s.is_nan() || (z - s).abs() < 1e-12, "{z} {s}");
        }
    }

    #[test]
    fn a_lonely_sample_stays_where_it_is() {
        let mut heights = vec![f64::NAN; 50];
        heights[20] = 7.0;
        assert_eq!(smooth(&heights, 5.0)[20], 7.0);
    }
}

//! Autocorrelation function.

use crate::{Axis, Topography};
use asperity_base::grid::Field;
use asperity_base::math::{RealFft2, good_size};
use asperity_base::units::{Metre, SquareMetre};

/// Autocorrelation function of a topography, m²:
///
/// R(τ) = ⟨z(x) z(x + τ)⟩,  R(0) = Sq²
///
/// The mean is over all pairs of defined samples τ apart, with heights relative to their mean. Pairs with an
/// undefined sample are ignored, so that holes increase the scatter but cause no bias. A lag without any pair
/// is NaN. No tilt or form is removed: level first.
///
/// Lags extend to half the topography along x and y, where a nonperiodic one still has a quarter of its
/// pairs. The autocorrelation function of ISO 25178-2 is R(τ)/R(0). It is computed by the Fourier transform
/// (Wiener–Khinchin).
#[derive(Debug, Clone)]
pub struct Correlation {
    pitch: [Metre; 2],
    /// Indexed from the most negative lags; the central entry is lag 0.
    values: Field,
}

impl Correlation {
    /// Computes the autocorrelation of a nonperiodic topography: the mean over the pairs within it.
    pub fn new(topography: &Topography) -> Self {
        // Zero-padded to the longest lag, so that no pair wraps around.
        Self::with_period(topography, topography.grid().shape.map(|n| good_size(n + n / 2)))
    }

    /// Computes the autocorrelation of a periodic topography.
    pub fn periodic(topography: &Topography) -> Self {
        Self::with_period(topography, topography.grid().shape)
    }

    fn with_period(topography: &Topography, period: [usize; 2]) -> Self {
        let shape = topography.grid().shape;
        let longest = shape.map(|n| n / 2);
        let fft = RealFft2::new(period);
        let products = |field: &Field| {
            let power = fft.forward(field).mapv(|value| value.norm_sqr().into());
            fft.inverse_leading(&power, [period[0], longest[1] + 1])
        };
        let heights = topography.heights();
        // Heights are first taken relative to one of them: equal heights then give exactly 0, without the
        // round-off of their mean.
        let first = heights.iter().copied().find(|z| !z.is_nan()).unwrap_or(0.0);
        let defined = heights.iter().filter(|z| !z.is_nan());
        let mean = first + defined.map(|z| z - first).sum::<f64>() / topography.defined() as f64;
        let sums = products(&heights.mapv(|z| if z.is_nan() { 0.0 } else { z - mean }));
        let holes = topography.undefined() > 0;
        let counted = holes.then(|| products(&heights.mapv(|z| if z.is_nan() { 0.0 } else { 1.0 })));
        let pairs = |at: [usize; 2], lag: [usize; 2]| match &counted {
            Some(counts) => counts[at].round(),
            None if period == shape => (shape[0] * shape[1]) as f64,
            None => ((shape[0] - lag[0]) * (shape[1] - lag[1])) as f64,
        };
        let values = Field::from_shape_fn(longest.map(|n| 2 * n + 1), |(i, j)| {
            // R(−τ) = R(τ): lags with negative y are those with positive y and both signs changed.
            let i = if j < longest[1] { 2 * longest[0] - i } else { i };
            let lag = [i.abs_diff(longest[0]), j.abs_diff(longest[1])];
            let at = [if i < longest[0] { period[0] - lag[0] } else { lag[0] }, lag[1]];
            let pairs = pairs(at, lag);
            if pairs > 0.0 { sums[at] / pairs } else { f64::NAN }
        });
        Self { pitch: topography.grid().pitch, values }
    }

    /// R at all lags, m², of shape `[2 mx + 1, 2 my + 1]`, with m half the number of samples. The entry
    /// `[mx + i, my + j]` belongs to the lag of i samples along x and j along y.
    pub fn values(&self) -> &Field {
        &self.values
    }

    /// R(0) = Sq².
    pub fn variance(&self) -> SquareMetre {
        self.values[self.longest()]
    }

    /// Returns the lags along `axis`, from 0, and R at each.
    pub fn along(&self, axis: Axis) -> Vec<(Metre, SquareMetre)> {
        let [x, y] = self.longest();
        let (line, pitch) = match axis {
            Axis::X => (self.values.column(y), self.pitch[0]),
            Axis::Y => (self.values.row(x), self.pitch[1]),
        };
        line.iter().skip(line.len() / 2).enumerate().map(|(n, r)| (n as f64 * pitch, *r)).collect()
    }

    /// Averages R over all directions. The rings are |τ| = n Δ, with Δ the larger pitch, as far as they lie
    /// within the lags. Returns the mean |τ| of each ring and the mean R. Lags without a pair are left out.
    pub fn radial(&self) -> Vec<(Metre, SquareMetre)> {
        // A direction with a single sample is ignored.
        let several = |axis: &usize| self.values.shape()[*axis] > 1;
        let width = (0..2).filter(several).map(|axis| self.pitch[axis]).fold(0.0, f64::max);
        let reach = |axis: usize| self.longest()[axis] as f64 * self.pitch[axis];
        let limit = (0..2).filter(several).map(reach).fold(f64::INFINITY, f64::min);
        if width == 0.0 {
            return vec![(0.0, self.variance())];
        }
        let mut rings = vec![[0.0; 3]; 1 + (limit / width).round() as usize];
        for ((i, j), r) in self.values.indexed_iter().filter(|(_, r)| !r.is_nan()) {
            let lag =
                |index: usize, axis: usize| index.abs_diff(self.longest()[axis]) as f64 * self.pitch[axis];
            let distance = lag(i, 0).hypot(lag(j, 1));
            if let Some(sums) = rings.get_mut((distance / width).round() as usize) {
                *sums = [sums[0] + distance, sums[1] + r, sums[2] + 1.0];
            }
        }
        let filled = rings.iter().filter(|[_, _, count]| *count > 0.0);
        filled.map(|[distance, sum, count]| (distance / count, sum / count)).collect()
    }

    /// Returns the lag at which R(τ)/R(0) first falls to `level`, < 1, in the direction `angle` from the x
    /// axis towards the y axis, in radians; NaN if it does not within the lags.
    ///
    /// Between the samples R is interpolated by cubic convolution (Keys, IEEE Trans. Acoust. Speech Signal
    /// Process. 29, 1153, 1981), which is of third order.
    pub fn decay_length(&self, angle: f64, level: f64) -> Metre {
        if self.variance() == 0.0 {
            return f64::NAN;
        }
        let (sin, cos) = angle.sin_cos();
        // Step to the next sample along x or y, whichever is closer.
        let step = 1.0 / (cos.abs() / self.pitch[0]).max(sin.abs() / self.pitch[1]);
        let target = level * self.variance();
        let above = |distance: f64| {
            self.between([distance * cos / self.pitch[0], distance * sin / self.pitch[1]]).map(|r| r - target)
        };
        let mut inside = 0.0;
        loop {
            let outside = inside + step;
            match above(outside) {
                Some(excess) if excess > 0.0 => inside = outside,
                Some(excess) if excess <= 0.0 => {
                    return crossing(inside, outside, |d| above(d).unwrap_or(excess));
                }
                _ => return f64::NAN,
            }
        }
    }

    /// Returns the shortest and the longest [`Correlation::decay_length`] to `level` over all directions:
    /// those of fastest and of slowest decay. The first is NaN if R falls to the level in no direction within
    /// the lags, the second if R does not in some direction.
    pub fn decay_lengths(&self, level: f64) -> [Metre; 2] {
        // Enough directions that they are about a sample apart at the longest lag, both axes included.
        let [mx, my] = self.longest();
        let directions = ((std::f64::consts::PI * mx.max(my) as f64) as usize).next_multiple_of(2).max(2);
        let angle = |k: usize| std::f64::consts::PI * k as f64 / directions as f64;
        let lengths: Vec<_> = (0..directions).map(|k| self.decay_length(angle(k), level)).collect();
        let fastest = lengths.iter().copied().fold(f64::NAN, f64::min);
        let slowest = lengths.iter().copied().fold(f64::NAN, f64::max);
        [fastest, if lengths.iter().any(|length| length.is_nan()) { f64::NAN } else { slowest }]
    }

    /// Number of samples to the longest lag along x and y, which is the index of lag 0.
    fn longest(&self) -> [usize; 2] {
        [self.values.nrows() / 2, self.values.ncols() / 2]
    }

    /// Returns R at a lag in samples, which need not be whole; `None` beyond the longest lag.
    fn between(&self, lag: [f64; 2]) -> Option<SquareMetre> {
        let longest = self.longest();
        // A lag at the limit counts, whatever the round-off.
        if (0..2).any(|axis| lag[axis].abs() > longest[axis] as f64 + 1e-9) {
            return None;
        }
        let [along_x, along_y] =
            [0, 1].map(|axis| cubic_weights(lag[axis] + longest[axis] as f64, 2 * longest[axis]));
        let line =
            |ix: usize| -> f64 { along_y.iter().map(|&(iy, weight)| weight * self.values[[ix, iy]]).sum() };
        Some(along_x.iter().map(|&(ix, weight)| weight * line(ix)).sum())
    }
}

/// Returns the samples, from 0 to `last`, used for the value at `position` by cubic convolution, and their
/// weights. Beyond the ends the outermost sample repeats.
fn cubic_weights(position: f64, last: usize) -> [(usize, f64); 4] {
    let below = position.floor();
    let t = position - below;
    let weights = [
        ((2.0 - t) * t - 1.0) * t / 2.0,
        ((3.0 * t - 5.0) * t * t + 2.0) / 2.0,
        ((4.0 - 3.0 * t) * t + 1.0) * t / 2.0,
        (t - 1.0) * t * t / 2.0,
    ];
    std::array::from_fn(|n| ((below + n as f64 - 1.0).clamp(0.0, last as f64) as usize, weights[n]))
}

/// Finds by bisection where `f`, positive at `inside` and not at `outside`, changes its sign.
fn crossing(mut inside: f64, mut outside: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..40 {
        let middle = 0.5 * (inside + outside);
        *(if f(middle) > 0.0 { &mut inside } else { &mut outside }) = middle;
    }
    0.5 * (inside + outside)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_6, TAU};

    use approx::assert_relative_eq;

    use super::*;
    use crate::{Autocorrelation, Form, Spectrum, Window};
    use asperity_base::grid::Grid;

    fn rough(shape: [usize; 2], pitch: [f64; 2], length: [f64; 2], seed: u64) -> Topography {
        let method = Autocorrelation::new(1.0, length);
        method.generate(&Grid::new(shape, pitch).unwrap(), seed).unwrap()
    }

    fn with_holes(mut topography: Topography, one_in: usize) -> Topography {
        // A fixed scatter of holes: multiplicative hashing of the index.
        let scatter = |n: usize| (n.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40).is_multiple_of(one_in);
        topography
            .heights_mut()
            .iter_mut()
            .enumerate()
            .filter(|(n, _)| scatter(*n))
            .for_each(|(_, z)| *z = f64::NAN);
        topography
    }

    /// A prescribed autocorrelation function.
    fn given(longest: [usize; 2], pitch: [f64; 2], r: impl Fn(f64, f64) -> f64) -> Correlation {
        let values = Field::from_shape_fn(longest.map(|n| 2 * n + 1), |(i, j)| {
            r((i as f64 - longest[0] as f64) * pitch[0], (j as f64 - longest[1] as f64) * pitch[1])
        });
        Correlation { pitch, values }
    }

    #[test]
    fn it_is_the_mean_over_the_pairs_around_holes_too() {
        for (shape, one_in) in
            [([9, 14], usize::MAX), ([9, 14], 4), ([10, 7], 3), ([1, 12], usize::MAX), ([8, 1], 5)]
        {
            let topography = with_holes(rough([16, 16], [1.0; 2], [3.0; 2], 1), one_in);
            let topography = topography.window([2, 0, shape[0], shape[1]]).unwrap();
            let (mean, z) = (topography.mean(), topography.heights());
            let [n, m] = shape.map(|n| n as isize);
            for (correlation, periodic) in
                [(Correlation::new(&topography), false), (Correlation::periodic(&topography), true)]
            {
                for ((i, j), r) in correlation.values().indexed_iter() {
                    let lag = [i as isize - n / 2, j as isize - m / 2];
                    let (mut sum, mut pairs) = (0.0, 0.0);
                    for ((ix, iy), z0) in z.indexed_iter() {
                        let other = [ix as isize + lag[0], iy as isize + lag[1]];
                        let wrapped = [other[0].rem_euclid(n), other[1].rem_euclid(m)];
                        let z1 = z[wrapped.map(|index| index as usize)];
                        if (periodic || wrapped == other) && !(z0 * z1).is_nan() {
                            sum += (z0 - mean) * (z1 - mean);
                            pairs += 1.0;
                        }
                    }
                    if pairs == 0.0 {
                        assert!(r.is_nan());
                    } else {
                        assert_relative_eq!(*r, sum / pairs, epsilon = 1e-12);
                    }
                }
                assert_relative_eq!(correlation.variance(), topography.sq().powi(2), max_relative = 1e-12);
            }
        }
    }

    #[test]
    fn that_of_a_sinusoid_is_a_sinusoid_of_half_its_squared_amplitude() {
        let grid = Grid::new([60, 40], [0.5, 1.0]).unwrap();
        let form = Form::Sinusoid { amplitude: 3.0, wavelength: [10.0, f64::INFINITY] };
        let correlation = Correlation::periodic(&form.on(&grid).unwrap());
        for (lag, r) in correlation.along(Axis::X) {
            assert_relative_eq!(r, 4.5 * (TAU * lag / 10.0).cos(), epsilon = 1e-12);
        }
        assert!(correlation.along(Axis::Y).iter().all(|(_, r)| (r - 4.5).abs() < 1e-12));
    }

    #[test]
    fn it_is_the_transform_of_the_spectrum() {
        // Wiener–Khinchin: R(τ) = (1/A) Σ C(q) cos(q·τ).
        let topography = rough([24, 17], [0.5, 1.0], [3.0; 2], 2);
        let spectrum = Spectrum::new(&topography, Window::None);
        let correlation = Correlation::periodic(&topography);
        for ((i, j), r) in correlation.values().indexed_iter() {
            let lag = [(i as f64 - 12.0) * 0.5, j as f64 - 8.0];
            let transform = spectrum.sum(|q| (q[0] * lag[0] + q[1] * lag[1]).cos());
            // The transform covers both signs: the sine terms cancel.
            assert_relative_eq!(*r, transform, epsilon = 1e-12);
        }
    }

    #[test]
    fn holes_leave_it_unbiased() {
        // 20 % of the samples missing: at short lags R is as without holes, except for the missing pairs. The
        // two differ by the scatter of a mean over the pairs present in only one of them, n' = 0.36 n/(1 −
        // 0.36).
        let whole = rough([256, 256], [1.0; 2], [12.0; 2], 3);
        let holed = with_holes(whole.clone(), 5);
        assert_relative_eq!(holed.undefined() as f64, 0.2 * 65536.0, max_relative = 0.05);
        let [whole, holed] = [whole, holed].map(|z| Correlation::new(&z).radial());
        let error = (2.0 * 0.36 / 0.64 / 65536.0f64).sqrt();
        for (expected, found) in whole.iter().zip(&holed).take(24) {
            assert!((expected.1 - found.1).abs() < 4.0 * error, "{expected:?} {found:?}");
        }
    }

    #[test]
    fn the_mean_over_the_directions_falls_as_the_exponential_it_was_made_with() {
        let lengths = [10.0; 2];
        let seeds = 4;
        let radial: Vec<_> = (0..seeds)
            .map(|seed| Correlation::new(&rough([400, 300], [1.0; 2], lengths, seed)).radial())
            .collect();
        // Correlated area ∫ R² = 2π (β/2 ln 10)² per independent spot; the mean of each surface is set to 0.
        let spots = 400.0 * 300.0 * seeds as f64 / (TAU * (10.0 / 4.605f64).powi(2));
        for n in 0..30 {
            let (lag, _) = radial[0][n];
            let r = radial.iter().map(|points| points[n].1).sum::<f64>() / seeds as f64;
            let expected = 10f64.powf(-lag / 10.0);
            assert!(
                (r - expected).abs() < 4.0 / spots.sqrt() + 2.0 * seeds as f64 / spots,
                "{lag}: {r} {expected}"
            );
        }
    }

    #[test]
    fn a_gaussian_decays_to_a_fifth_at_its_length_times_the_root_of_ln_5() {
        // R = exp(−(ξ/3)² − η²), with ξ and η rotated by 30°. In the direction φ from ξ: (cos²φ/9 +
        // sin²φ)^(−1/2) √ln 5.
        let correlation = |pitch: f64| {
            let (sin, cos) = FRAC_PI_6.sin_cos();
            let r =
                |x: f64, y: f64| (-((x * cos + y * sin) / 3.0).powi(2) - (y * cos - x * sin).powi(2)).exp();
            given([(6.0 / pitch) as usize, (5.0 / pitch) as usize], [pitch, 1.25 * pitch], r)
        };
        let root = 5f64.ln().sqrt();
        let error = |pitch: f64| {
            let correlation = correlation(pitch);
            let errors = (0..40).map(|k| {
                let angle = std::f64::consts::PI * f64::from(k) / 40.0;
                let (sin, cos) = (angle - FRAC_PI_6).sin_cos();
                let exact = root / (cos / 3.0).hypot(sin);
                (correlation.decay_length(angle, 0.2) / exact - 1.0).abs()
            });
            errors.fold(0.0, f64::max)
        };
        let (coarse, fine) = (error(0.25), error(0.125));
        let order = (coarse / fine).log2();
        assert!(2.7 < order && fine < 1e-3, "error {coarse:e} → {fine:e} is order {order:.2}");
        // The extrema lie on directions π/n apart, up to half of that away, where the squared length differs
        // by (3² − 1) (π/2n)².
        for pitch in [0.25, 0.125] {
            let [fastest, slowest] = correlation(pitch).decay_lengths(0.2);
            let beside = 0.5 * 8.0 * (0.5 * pitch / 6.0).powi(2);
            assert_relative_eq!(fastest, root, max_relative = beside + error(pitch));
            assert_relative_eq!(slowest, 3.0 * root, max_relative = beside + error(pitch));
        }
    }

    #[test]
    fn a_decay_beyond_the_lags_is_no_length() {
        let ridge = given([20, 30], [1.0, 1.0], |x, _| (-x.abs() / 4.0).exp());
        let [fastest, slowest] = ridge.decay_lengths(0.2);
        // Third order would be h³ of a wavelength. The only kink is at lag 0, away from the crossing.
        assert_relative_eq!(fastest, 4.0 * 5f64.ln(), max_relative = 1e-3);
        assert!(slowest.is_nan() && ridge.decay_length(FRAC_PI_2, 0.2).is_nan());
        assert!(
            given([20, 30], [1.0, 1.0], |_, _| 1.0).decay_lengths(0.2).iter().all(|length| length.is_nan())
        );
        let flat = Form::Flat.on(&Grid::new([16, 16], [1.0; 2]).unwrap()).unwrap();
        assert!(Correlation::new(&flat).decay_lengths(0.2).iter().all(|length| length.is_nan()));
    }
}

//! Filters that separate short and long waves of a topography.

use std::f64::consts::{LN_2, PI};

use super::median::median;
use crate::Topography;
use asperity_base::choice::choice;
use asperity_base::error::{Result, check_in};
use asperity_base::grid::{Field, Grid};
use asperity_base::math::good_size;
use asperity_base::math::parallel::{self, Pool};
use asperity_base::units::{Dimension, Metre};
use asperity_transforms::num_complex::Complex64;
use asperity_transforms::{Fft, Precision};

/// Method to compute the smooth surface of a filter.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Filter {
    /// The mean of the neighbouring heights weighted by the areal Gaussian of ISO 16610-61: w = exp(−π
    /// r²/(αλ)²)/(αλ)², α = √(ln 2/π). A wave of length Λ keeps the fraction exp(−π(αλ/Λ)²), which is half at
    /// Λ = λ.
    #[default]
    Gaussian,
    /// The weighted mean of the neighbouring heights, with weights that also decrease with the distance r
    /// from the smooth surface, as in ISO 16610-71. Deep scratches and high peaks then do not distort it. The
    /// additional weight is Tukey's biweight, (1 − (r/c)²)² for |r| < c and 0 beyond. c is 4.4478 times the
    /// median of |r|, iterated until c converges to 10⁻³. The regression is of order 0, that of the standard
    /// of order 2.
    Robust,
}

choice!(Filter: "gaussian" => Gaussian, "robust" => Robust);

impl Topography {
    /// Removes the waves shorter than the nesting index: the S-filter of ISO 25178-2, a low-pass filter.
    ///
    /// The mean is over the defined samples of the grid, so that a constant height is preserved and holes
    /// have no influence. On a slope the smooth surface is distorted within half a cut-off of the boundary.
    /// Undefined samples stay undefined.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] if the nesting index is below two pitches.
    pub fn s_filter(mut self, nesting_index: Metre, filter: Filter) -> Result<Self> {
        let smooth = smooth(&self, "s_filter", nesting_index, filter)?;
        *self.heights_mut() = smooth;
        Ok(self)
    }

    /// Removes the waves longer than the nesting index: the L-filter of ISO 25178-2, a high-pass filter. It
    /// subtracts the result of the S-filter with the same index.
    ///
    /// # Errors
    /// The errors of [`Topography::s_filter`].
    pub fn l_filter(mut self, nesting_index: Metre, filter: Filter) -> Result<Self> {
        let smooth = smooth(&self, "l_filter", nesting_index, filter)?;
        *self.heights_mut() -= &smooth;
        Ok(self)
    }
}

/// Computes the smooth surface at the defined samples.
fn smooth(topography: &Topography, name: &'static str, length: Metre, filter: Filter) -> Result<Field> {
    let grid = topography.grid();
    let good = length.is_finite() && grid.pitch.iter().all(|pitch| length >= 2.0 * pitch);
    check_in(Dimension::Length, name, length, good, "a wavelength of at least two pitches")?;
    let mut z = topography.heights().clone();
    if topography.defined() == 0 {
        return Ok(z);
    }
    // Heights of order 1 keep their digits next to the weights in one complex number.
    let mean = topography.mean();
    let largest = z.iter().filter(|z| !z.is_nan()).fold(0.0, |m, z| (z - mean).abs().max(m));
    let scale = if largest > 0.0 { largest } else { 1.0 };
    z.mapv_inplace(|z| (z - mean) / scale);
    let gaussian = Gaussian::new(grid, length);
    let smooth = match filter {
        Filter::Gaussian => gaussian.mean(&z, |_| 1.0, None),
        Filter::Robust => robust(&gaussian, &z),
    };
    Ok(smooth.mapv(|z| mean + scale * z))
}

fn robust(gaussian: &Gaussian, z: &Field) -> Field {
    /// Constant of the standard: 3 times the ratio of standard deviation to median of |r| for Gaussian
    /// heights.
    const BIWEIGHT: f64 = 4.4478;
    /// Relative change of the scale at convergence.
    const TOLERANCE: f64 = 1e-3;
    /// Number of iterations after which the mean is accepted.
    const MAX_ITERATIONS: usize = 50;
    let mut smooth = gaussian.mean(z, |_| 1.0, None);
    let mut last = f64::INFINITY;
    for _ in 0..MAX_ITERATIONS {
        let mut distances: Vec<f64> =
            z.iter().zip(&smooth).filter(|(z, _)| !z.is_nan()).map(|(z, s)| (z - s).abs()).collect();
        let c = BIWEIGHT * median(&mut distances);
        // Most of the surface already lies on the smooth one, so that there is nothing to separate.
        if (last - c).abs() <= TOLERANCE * c || c <= f64::EPSILON {
            break;
        }
        last = c;
        let weight = |r: f64| if r.abs() < c { (1.0 - (r / c).powi(2)).powi(2) } else { 0.0 };
        smooth = gaussian.mean(z, |at| weight(z[at] - smooth[at]), Some(&smooth));
    }
    smooth
}

/// Weighted means of the samples around each one; the weight is a Gaussian of the distance along x times one
/// along y.
struct Gaussian {
    axes: [Line; 2],
}

impl Gaussian {
    fn new(grid: &Grid, length: Metre) -> Self {
        Self { axes: [0, 1].map(|axis| Line::new(grid.shape[axis], length / grid.pitch[axis])) }
    }

    /// Computes Σ w δ z/Σ w δ over the defined samples, with δ the `weight` of the sample; `before` where all
    /// weights vanish.
    fn mean(&self, z: &Field, weight: impl Fn([usize; 2]) -> f64, before: Option<&Field>) -> Field {
        /// Fraction of the full weight below which only round-off remains.
        const VANISHED: f64 = 1e-9;
        let mut sums = ndarray::Array2::from_shape_fn(z.dim(), |(ix, iy)| {
            if z[[ix, iy]].is_nan() {
                return Complex64::ZERO;
            }
            let weight = weight([ix, iy]);
            Complex64::new(weight * z[[ix, iy]], weight)
        });
        self.axes[1].apply(&mut sums);
        let mut sums = sums.reversed_axes().as_standard_layout().into_owned();
        self.axes[0].apply(&mut sums);
        Field::from_shape_fn(z.dim(), |(ix, iy)| match (sums[[iy, ix]], before) {
            _ if z[[ix, iy]].is_nan() => f64::NAN,
            (sum, Some(before)) if sum.im < VANISHED => before[[ix, iy]],
            (sum, _) => sum.re / sum.im,
        })
    }
}

/// Convolution of a line with a Gaussian, with zeros beyond its ends.
struct Line {
    forward: std::sync::Arc<dyn Fft<f64>>,
    inverse: std::sync::Arc<dyn Fft<f64>>,
    /// The spectrum of the Gaussian, over the length of the transform.
    spectrum: Vec<f64>,
}

impl Line {
    /// Creates a line filter for `n` samples and a cut-off of `length` pitches.
    fn new(n: usize, length: f64) -> Self {
        /// Reach of the Gaussian in cut-offs, where it has decreased to 10⁻¹⁶ of its sum.
        const REACH: f64 = 1.65;
        let reach = ((REACH * length).ceil() as usize).min(n - 1);
        let size = if n == 1 { 1 } else { good_size(n + reach) };
        let (forward, inverse) = (f64::plan_forward(size), f64::plan_inverse(size));
        let variance = LN_2 / PI * length * length; // (αλ)²
        let mut kernel = vec![Complex64::ZERO; size];
        for offset in 0..=reach {
            let value = (-PI * (offset * offset) as f64 / variance).exp();
            kernel[offset] = value.into();
            kernel[(size - offset) % size] = value.into();
        }
        let sum: f64 = kernel.iter().map(|value| value.re).sum::<f64>() * size as f64;
        forward.process(&mut kernel);
        Self { forward, inverse, spectrum: kernel.iter().map(|value| value.re / sum).collect() }
    }

    /// Convolves each row.
    fn apply(&self, rows: &mut ndarray::Array2<Complex64>) {
        let (n, size) = (rows.ncols(), self.spectrum.len());
        let scratch = self.forward.get_inplace_scratch_len().max(self.inverse.get_inplace_scratch_len());
        let rows = rows.as_slice_mut().expect("standard layout");
        parallel::each(
            rows.chunks_mut(n),
            1,
            &Pool::default(),
            || (vec![Complex64::ZERO; size], vec![Complex64::ZERO; scratch]),
            |(line, scratch), row| {
                line[..n].copy_from_slice(row);
                line[n..].fill(Complex64::ZERO);
                self.forward.process_with_scratch(line, scratch);
                line.iter_mut().zip(&self.spectrum).for_each(|(value, factor)| *value *= factor);
                self.inverse.process_with_scratch(line, scratch);
                row.copy_from_slice(&line[..n]);
            },
        );
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn with_heights(shape: [usize; 2], pitch: [f64; 2], height: impl Fn(f64, f64) -> f64) -> Topography {
        let grid = Grid::new(shape, pitch).unwrap();
        let heights = Field::from_shape_fn(shape, |(i, j)| height(grid.centre(0, i), grid.centre(1, j)));
        Topography::new(grid, heights).unwrap()
    }

    #[test]
    fn a_wave_keeps_the_share_that_the_standard_gives_it() {
        let cutoff = 20e-6;
        for [long_x, long_y] in
            [[20.0, 1e9], [1e9, 20.0], [40.0, 30.0], [100.0, 1e9], [10.0, 15.0], [7.0, 1e9]]
        {
            let wave = |x: f64, y: f64| 1e-7 * (TAU * (x / long_x + y / long_y) * 1e6).cos();
            let surface = with_heights([160, 120], [1e-6, 2e-6], wave);
            let smooth = surface.clone().s_filter(cutoff, Filter::Gaussian).unwrap();
            let inverse2 = (1.0 / long_x).powi(2) + (1.0 / long_y).powi(2);
            let share = (-LN_2 * (cutoff * 1e6).powi(2) * inverse2).exp();
            let rough = surface.clone().l_filter(cutoff, Filter::Gaussian).unwrap();
            // Beyond the reach of the boundary, the sum over samples has only the aliasing error exp(−ln 2
            // (λ/p − λ/Λ)²).
            for at in [[80, 60], [50, 40], [101, 77]] {
                let exact = surface.heights()[at];
                assert!((smooth.heights()[at] - share * exact).abs() < 1e-20, "{long_x} {long_y}");
                assert!((rough.heights()[at] - (1.0 - share) * exact).abs() < 1e-20, "{long_x} {long_y}");
            }
        }
    }

    #[test]
    fn half_of_a_wave_as_long_as_the_cutoff_passes() {
        let surface = with_heights([400, 3], [1e-6, 1e-6], |x, _| (TAU * x / 50e-6).sin());
        let smooth = surface.clone().s_filter(50e-6, Filter::Gaussian).unwrap();
        assert!((smooth.heights()[[212, 1]] / surface.heights()[[212, 1]] - 0.5).abs() < 1e-12);
    }

    #[test]
    fn a_constant_stays_up_to_the_rim_and_around_holes_and_a_plane_within() {
        let mut constant = with_heights([70, 50], [1.0, 1.0], |_, _| 5.0);
        (20..45).for_each(|i| (10..30).for_each(|j| constant.heights_mut()[[i, j]] = f64::NAN));
        for filter in [Filter::Gaussian, Filter::Robust] {
            let smooth = constant.clone().s_filter(8.0, filter).unwrap();
            assert_eq!(smooth.undefined(), 25 * 20);
            assert!(smooth.heights().iter().filter(|z| !z.is_nan()).all(|z| (z - 5.0).abs() < 1e-14));
        }
        let plane = with_heights([70, 50], [1.0, 1.0], |x, y| 0.3 * x - 0.2 * y);
        let smooth = plane.clone().s_filter(8.0, Filter::Gaussian).unwrap();
        for (at, z) in plane.heights().indexed_iter() {
            if (14..56).contains(&at.0) && (14..36).contains(&at.1) {
                assert!((smooth.heights()[at] - z).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_mean_by_transforms_is_the_sum_that_defines_it() {
        let mut surface = with_heights([17, 11], [1.0, 1.5], |x, y| (3.0 * x + y * y).sin());
        for (i, j) in [(3, 4), (3, 5), (4, 4), (0, 0), (16, 2)] {
            surface.heights_mut()[[i, j]] = f64::NAN;
        }
        for cutoff in [3.0, 12.0, 500.0] {
            let fast = surface.clone().s_filter(cutoff, Filter::Gaussian).unwrap();
            for ((i, j), fast) in fast.heights().indexed_iter().filter(|(_, z)| !z.is_nan()) {
                let (mut sum, mut weights) = (0.0, 0.0);
                for ((k, l), z) in surface.heights().indexed_iter().filter(|(_, z)| !z.is_nan()) {
                    let r2 = (i as f64 - k as f64).powi(2) + (1.5 * (j as f64 - l as f64)).powi(2);
                    let weight = (-PI * r2 / (LN_2 / PI * cutoff * cutoff)).exp();
                    sum += weight * z;
                    weights += weight;
                }
                assert!((fast - sum / weights).abs() < 1e-12, "{cutoff} at {i}, {j}");
            }
        }
    }

    #[test]
    fn a_scratch_bends_the_gaussian_surface_but_not_the_robust_one() {
        // Fine roughness of amplitude 1, with a scratch 40 deep and an eighth of the cut-off wide.
        let rough = |x: f64, y: f64| (2.1 * x).sin() * (1.7 * y).cos();
        let clean = with_heights([200, 40], [1.0, 1.0], rough);
        let scratched = with_heights([200, 40], [1.0, 1.0], |x, y| {
            rough(x, y) - if (100.0..105.0).contains(&x) { 40.0 } else { 0.0 }
        });
        let bent = |filter| {
            let smooth =
                |surface: &Topography| surface.clone().s_filter(40.0, filter).unwrap().into_heights();
            (smooth(&clean) - smooth(&scratched)).iter().fold(0.0, |m: f64, d| d.abs().max(m))
        };
        // By the mean of the scratch over the Gaussian: 40 · 5/(αλ), minus the second order of its width.
        assert!((bent(Filter::Gaussian) / (200.0 / (0.4697 * 40.0)) - 1.0).abs() < 0.1);
        // The robust filter loses the roughness in the scratch from its average: 5 of 19 samples.
        assert!(bent(Filter::Robust) < 0.1, "{}", bent(Filter::Robust));
    }

    #[test]
    fn a_cutoff_that_no_wave_on_the_grid_has_is_refused() {
        let surface = with_heights([8, 8], [1.0, 2.0], |x, _| x);
        for cutoff in [3.9, 0.0, -1.0, f64::NAN, f64::INFINITY] {
            let error = surface.clone().l_filter(cutoff, Filter::Gaussian).unwrap_err().to_string();
            assert!(error.starts_with("l_filter is"), "{error}");
        }
        assert!(surface.s_filter(4.0, Filter::Robust).is_ok());
    }
}

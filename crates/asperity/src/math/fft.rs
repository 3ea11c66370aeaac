//! Two-dimensional real Fourier transforms.

use std::sync::Arc;

use ndarray::Array2;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex, num_complex::Complex64};
use rustfft::{Fft, FftPlanner};

use crate::grid::Field;

/// Transform of a real field of one shape: half-complex along y, complex along x.
///
/// `forward` is unnormalised, `ẑ[k, l] = Σ z[i, j] exp(−2πi (k i/nx + l j/ny))` for `l = 0 … ny/2`;
/// `inverse` divides by `nx ny`, so that it undoes `forward`.
pub struct RealFft2 {
    shape: [usize; 2],
    along_y: Arc<dyn RealToComplex<f64>>,
    back_y: Arc<dyn ComplexToReal<f64>>,
    along_x: Arc<dyn Fft<f64>>,
    back_x: Arc<dyn Fft<f64>>,
}

impl RealFft2 {
    /// Plans for fields of `shape`.
    pub fn new(shape: [usize; 2]) -> Self {
        let mut real = RealFftPlanner::new();
        let mut complex = FftPlanner::new();
        Self {
            shape,
            along_y: real.plan_fft_forward(shape[1]),
            back_y: real.plan_fft_inverse(shape[1]),
            along_x: complex.plan_fft_forward(shape[0]),
            back_x: complex.plan_fft_inverse(shape[0]),
        }
    }

    /// Number of retained frequencies along y.
    pub fn half(&self) -> usize {
        self.shape[1] / 2 + 1
    }

    /// Shape of the fields.
    pub fn shape(&self) -> [usize; 2] {
        self.shape
    }

    /// The spectrum of `field`, shape `[nx, ny/2 + 1]`. A smaller field is continued by zeros.
    ///
    /// # Panics
    /// If `field` is larger than the plans.
    pub fn forward(&self, field: &Field) -> Array2<Complex64> {
        assert!(field.nrows() <= self.shape[0] && field.ncols() <= self.shape[1], "shape of the field");
        let mut columns = Array2::zeros([self.half(), self.shape[0]]);
        let mut row = self.along_y.make_input_vec();
        let mut spectrum = self.along_y.make_output_vec();
        for (ix, values) in field.outer_iter().enumerate() {
            row.iter_mut().zip(values).for_each(|(r, v)| *r = *v);
            row[values.len()..].fill(0.0);
            self.along_y.process(&mut row, &mut spectrum).expect("lengths come from the plan");
            columns.column_mut(ix).iter_mut().zip(&spectrum).for_each(|(c, s)| *c = *s);
        }
        self.along_x.process(columns.as_slice_mut().expect("standard layout"));
        columns.t().as_standard_layout().into_owned()
    }

    /// The field whose spectrum this is.
    ///
    /// # Panics
    /// If `spectrum` has another shape than [`RealFft2::forward`] gives.
    pub fn inverse(&self, spectrum: &Array2<Complex64>) -> Field {
        self.inverse_leading(spectrum, self.shape)
    }

    /// The first rows and columns, so many as `shape` says, of the field whose spectrum this is.
    ///
    /// # Panics
    /// If `spectrum` has another shape than [`RealFft2::forward`] gives, or `shape` is larger than the plans.
    pub fn inverse_leading(&self, spectrum: &Array2<Complex64>, shape: [usize; 2]) -> Field {
        assert!(shape[0] <= self.shape[0] && shape[1] <= self.shape[1], "shape of the field");
        assert_eq!(spectrum.dim(), (self.shape[0], self.half()), "shape of the spectrum");
        let mut columns = spectrum.t().as_standard_layout().into_owned();
        self.back_x.process(columns.as_slice_mut().expect("standard layout"));
        let mut field = Field::zeros(shape);
        let mut half = self.back_y.make_input_vec();
        let mut row = self.back_y.make_output_vec();
        let scale = 1.0 / (self.shape[0] * self.shape[1]) as f64;
        for (ix, mut values) in field.outer_iter_mut().enumerate() {
            half.iter_mut().zip(columns.column(ix)).for_each(|(h, c)| *h = *c);
            // A real field has real spectra at zero and, for even lengths, at the Nyquist frequency.
            half[0].im = 0.0;
            if self.shape[1].is_multiple_of(2) {
                half[self.shape[1] / 2].im = 0.0;
            }
            self.back_y.process(&mut half, &mut row).expect("lengths come from the plan");
            values.iter_mut().zip(&row).for_each(|(v, r)| *v = *r * scale);
        }
        field
    }
}

/// Angular frequency of bin `k` of a transform of `n` samples at `pitch`: 2π k'/(n pitch), −n/2 < k' ≤ n/2.
pub fn angular_frequency(k: usize, n: usize, pitch: f64) -> f64 {
    let signed = if 2 * k > n { k as f64 - n as f64 } else { k as f64 };
    std::f64::consts::TAU * signed / (n as f64 * pitch)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_agrees_with_the_sum_that_defines_it_and_inverts() {
        for shape in [[4, 6], [5, 7], [1, 8], [6, 1]] {
            let field = Field::from_shape_fn(shape, |(i, j)| ((7 * i + 3 * j * j) % 11) as f64 - 4.0);
            let fft = RealFft2::new(shape);
            let spectrum = fft.forward(&field);
            for ((k, l), value) in spectrum.indexed_iter() {
                let direct: Complex64 = field
                    .indexed_iter()
                    .map(|((i, j), z)| {
                        let phase = (k * i) as f64 / shape[0] as f64 + (l * j) as f64 / shape[1] as f64;
                        Complex64::cis(-std::f64::consts::TAU * phase) * z
                    })
                    .sum();
                assert!((value - direct).norm() < 1e-12, "{shape:?} at {k}, {l}");
            }
            let back = fft.inverse(&spectrum);
            assert!(back.iter().zip(&field).all(|(a, b)| (a - b).abs() < 1e-12));
        }
    }

    #[test]
    fn a_smaller_field_is_continued_by_zeros() {
        let (small, fft) =
            (Field::from_shape_fn([3, 4], |(i, j)| (1 + 5 * i + j * j) as f64), RealFft2::new([6, 7]));
        let mut padded = Field::zeros([6, 7]);
        padded.slice_mut(ndarray::s![..3, ..4]).assign(&small);
        let spectrum = fft.forward(&small);
        assert_eq!(spectrum, fft.forward(&padded));
        let whole = fft.inverse(&spectrum);
        assert_eq!(fft.inverse_leading(&spectrum, [2, 5]), whole.slice(ndarray::s![..2, ..5]));
    }
}

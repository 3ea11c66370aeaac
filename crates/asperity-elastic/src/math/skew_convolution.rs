//! Convolution with a kernel that is even only along y, by real Fourier transforms.

use std::sync::Arc;

use asperity_transforms::num_complex::Complex64;
use asperity_transforms::num_traits::Zero;
use ndarray::Array2;

use crate::grid::Field;
use crate::math::convolution::{Scratch, Transform, strips_at_once};
use crate::math::parallel::{self, Pool};
use asperity_base::math::plans::Plans;

/// A cyclic kernel that is even along y, in Fourier space, with the plans of its size.
pub struct SkewKernel {
    plans: Plans<f64>,
    /// `[ky, kx]` for `ky ≤ My/2`, divided by Mx My.
    spectrum: Array2<Complex64>,
}

impl SkewKernel {
    /// Creates the kernel with these `values` at the cyclic offsets `[i, j]`.
    pub fn from_values(values: &Field) -> Self {
        let plans = Plans::new([values.nrows(), values.ncols()]);
        let (mut transform, mut scratch) = (Transform::new(&plans, plans.shape), Scratch::new(&plans));
        let mut spectrum = Array2::from_elem([plans.half(), plans.shape[0]], Complex64::zero());
        transform.rows_forward(&plans, values, &Pool::default());
        for strip in transform.strips() {
            strip.forward(&plans, &mut scratch);
            for (ky, column) in strip.columns(&plans, &mut scratch) {
                spectrum.row_mut(ky).iter_mut().zip(column).for_each(|(s, value)| *s = *value);
            }
        }
        Self::normalised(plans, spectrum)
    }

    /// Creates the kernel on a cyclic grid of `shape` with this `transform` at the bins `(kx, ky)`, for all
    /// kx and `ky ≤ My/2`. At the Nyquist bin of an even period along x only the real part is used.
    pub fn from_transform(shape: [usize; 2], transform: impl Fn(usize, usize) -> Complex64) -> Self {
        let plans = Plans::new(shape);
        let spectrum = Array2::from_shape_fn([plans.half(), shape[0]], |(ky, kx)| {
            let value = transform(kx, ky);
            if 2 * kx == shape[0] { value.re.into() } else { value }
        });
        Self::normalised(plans, spectrum)
    }

    fn normalised(plans: Plans<f64>, mut spectrum: Array2<Complex64>) -> Self {
        let unit = 1.0 / (plans.shape[0] * plans.shape[1]) as f64;
        spectrum.mapv_inplace(|s| s * unit);
        Self { plans, spectrum }
    }
}

/// Convolution of fields of one shape with a [`SkewKernel`]; see [`super::Convolution`] for even kernels.
pub struct SkewConvolution {
    kernel: Arc<SkewKernel>,
    transform: Transform<f64>,
    scratch: Pool<Scratch<f64>>,
}

impl SkewConvolution {
    /// Creates the convolution of fields of `shape`.
    ///
    /// # Panics
    /// If the kernel is smaller than `shape`.
    pub fn new(kernel: Arc<SkewKernel>, shape: [usize; 2]) -> Self {
        Self { transform: Transform::new(&kernel.plans, shape), scratch: Pool::default(), kernel }
    }

    /// Computes the convolution `output` of `input`.
    ///
    /// # Panics
    /// If a field has another shape than the plans.
    pub fn apply(&mut self, input: &Field, output: &mut Field) {
        let Self { kernel, transform, scratch } = self;
        let plans = &kernel.plans;
        transform.rows_forward(plans, input, scratch);
        let new = || Scratch::new(plans);
        parallel::each(transform.strips(), strips_at_once(plans), scratch, new, |scratch, mut strip| {
            strip.forward(plans, scratch);
            for (ky, column) in strip.columns(plans, scratch) {
                column.iter_mut().zip(kernel.spectrum.row(ky)).for_each(|(v, k)| *v *= k);
            }
            strip.back(plans, scratch);
        });
        transform.rows_back(plans, 1.0, output, scratch);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_cyclic_sum_for_even_and_odd_sizes() {
        for shape in [[1, 1], [7, 1], [4, 6], [5, 7], [6, 9]] {
            let [nx, ny] = shape;
            let values = Field::from_shape_fn(shape, |(i, j)| {
                1.0 / (1 + 3 * i + j.min(ny - j).pow(2)) as f64 - if i > 1 { 0.2 } else { 0.0 }
            });
            let input = Field::from_shape_fn(shape, |(i, j)| ((5 * i + 3 * j * j) % 7) as f64 - 2.0);
            let mut output = Field::zeros(shape);
            SkewConvolution::new(Arc::new(SkewKernel::from_values(&values)), shape)
                .apply(&input, &mut output);
            for ((i, j), fast) in output.indexed_iter() {
                let slow: f64 = input
                    .indexed_iter()
                    .map(|((k, l), p)| p * values[[(i + nx - k) % nx, (j + ny - l) % ny]])
                    .sum();
                assert!((fast - slow).abs() < 1e-12, "{shape:?} at {i}, {j}: {fast} and {slow}");
            }
        }
    }

    #[test]
    fn a_wave_is_shifted_by_the_phase_of_its_transform() {
        let (shape, tau) = ([8, 6], std::f64::consts::TAU);
        let kernel = SkewKernel::from_transform(shape, |kx, _| {
            let signed = if kx > 4 { kx as f64 - 8.0 } else { kx as f64 };
            Complex64::cis(-signed * tau / 8.0)
        });
        let wave = |shift: f64| {
            Field::from_shape_fn(shape, |(i, j)| (tau * ((i as f64 - shift) / 8.0 + j as f64 / 6.0)).cos())
        };
        let mut output = Field::zeros(shape);
        SkewConvolution::new(Arc::new(kernel), shape).apply(&wave(0.0), &mut output);
        assert!((&output - &wave(1.0)).iter().all(|d| d.abs() < 1e-14));
    }
}

//! Convolution with an even kernel by real Fourier transforms.

use std::sync::Arc;

use ndarray::Array2;
use realfft::num_complex::Complex;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::num_traits::Zero;
use rustfft::{Fft, FftNum, FftPlanner};

use crate::grid::Field;

/// Columns that are transformed together: one or two cache lines of a row.
const STRIP: usize = 8;
/// Rows whose piece of a strip is turned into columns at a time.
const BLOCK: usize = 8;
/// Room between the columns of a strip: without it columns of a power of two share their cache lines' places.
const ROOM: usize = 8;

/// A cyclic kernel that is even along both axes, in Fourier space, with the plans of its size, for transforms in the
/// precision of `T`.
pub struct Kernel<T> {
    shape: [usize; 2],
    /// Real and even: `[ky, kx]` for `ky ≤ My/2`, `kx ≤ Mx/2`, as a share of the largest.
    spectrum: Array2<T>,
    /// The largest of the spectrum, divided by Mx My.
    unit: T,
    along_y: Arc<dyn RealToComplex<T>>,
    back_y: Arc<dyn ComplexToReal<T>>,
    along_x: Arc<dyn Fft<T>>,
    back_x: Arc<dyn Fft<T>>,
}

impl<T: FftNum> Kernel<T> {
    fn new(shape: [usize; 2], spectrum: Array2<T>, unit: T) -> Self {
        let mut real = RealFftPlanner::new();
        let mut complex = FftPlanner::new();
        let [mx, my] = shape;
        Self {
            shape,
            spectrum,
            unit,
            along_y: real.plan_fft_forward(my),
            back_y: real.plan_fft_inverse(my),
            along_x: complex.plan_fft_forward(mx),
            back_x: complex.plan_fft_inverse(mx),
        }
    }

    fn half(&self) -> usize {
        self.shape[1] / 2 + 1
    }

    /// Scratch for any of the plans.
    fn scratch(&self) -> Vec<Complex<T>> {
        let lengths = [
            self.along_y.get_scratch_len(),
            self.back_y.get_scratch_len(),
            self.along_x.get_inplace_scratch_len(),
            self.back_x.get_inplace_scratch_len(),
        ];
        vec![Complex::zero(); lengths.into_iter().max().unwrap_or(0)]
    }
}

impl Kernel<f64> {
    /// The kernel on a cyclic grid of `shape` whose transform at the bins `(kx, ky)` is `transform`, for
    /// `kx ≤ Mx/2`, `ky ≤ My/2`.
    pub fn from_transform(shape: [usize; 2], transform: impl Fn(usize, usize) -> f64) -> Self {
        let half = shape.map(|n| n / 2 + 1);
        Self::normalised(shape, Field::from_shape_fn([half[1], half[0]], |(ky, kx)| transform(kx, ky)))
    }

    /// The kernel on a cyclic grid of `shape` with the values `table[[i, j]]` at the offsets ±i, ±j, for
    /// `i ≤ Mx/2`, `j ≤ My/2`.
    pub fn from_values(shape: [usize; 2], table: &Field) -> Self {
        let [mx, my] = shape;
        let mut kernel = Self::new(shape, Field::zeros([my / 2 + 1, mx / 2 + 1]), 1.0);
        let mut scratch = kernel.scratch();
        let mut row = kernel.along_y.make_input_vec();
        let mut half = kernel.along_y.make_output_vec();
        for (ix, values) in table.outer_iter().enumerate() {
            for (iy, value) in row.iter_mut().enumerate() {
                *value = values[iy.min(my - iy)];
            }
            let forward = kernel.along_y.process_with_scratch(&mut row, &mut half, &mut scratch);
            forward.expect("lengths come from the plan");
            kernel.spectrum.column_mut(ix).iter_mut().zip(&half).for_each(|(s, h)| *s = h.re);
        }
        let mut column = vec![Complex::zero(); mx];
        for mut spectrum in kernel.spectrum.outer_iter_mut() {
            for (ix, value) in column.iter_mut().enumerate() {
                *value = Complex::from(spectrum[ix.min(mx - ix)]);
            }
            kernel.along_x.process_with_scratch(&mut column, &mut scratch);
            spectrum.iter_mut().zip(&column).for_each(|(s, c)| *s = c.re);
        }
        Self::normalised(shape, kernel.spectrum)
    }

    fn normalised(shape: [usize; 2], mut spectrum: Field) -> Self {
        let largest = spectrum.iter().fold(0.0f64, |m, s| m.max(s.abs()));
        if largest > 0.0 {
            spectrum /= largest;
        }
        Self::new(shape, spectrum, largest / (shape[0] * shape[1]) as f64)
    }

    /// The same kernel for transforms in single precision.
    pub fn to_single(&self) -> Kernel<f32> {
        Kernel::new(self.shape, self.spectrum.mapv(|s| s as f32), self.unit as f32)
    }
}

/// Convolution of fields of one shape with a [`Kernel`] of that shape or a larger one; what lies beyond the field
/// counts as zero. A kernel of at least `2n − 1` along each axis makes the cyclic convolution the free one.
///
/// Rows that are zero are not transformed, columns are transformed in strips that go forth, through the kernel and
/// back while they are in cache, and only the rows of the field come back: with a kernel of twice the size about
/// half the work of whole transforms. Nothing is allocated after construction.
pub struct Convolution<T> {
    kernel: Arc<Kernel<T>>,
    rows: Array2<Complex<T>>,
    strip: Vec<Complex<T>>,
    real: Vec<T>,
    scratch: Vec<Complex<T>>,
}

impl<T: FftNum> Convolution<T> {
    /// The convolution of fields of `shape`.
    ///
    /// # Panics
    /// If the kernel is smaller than `shape`.
    pub fn new(kernel: Arc<Kernel<T>>, shape: [usize; 2]) -> Self {
        assert!(shape[0] <= kernel.shape[0] && shape[1] <= kernel.shape[1], "kernel smaller than the field");
        Self {
            rows: Array2::from_elem([shape[0], kernel.half()], Complex::zero()),
            strip: vec![Complex::zero(); STRIP * (kernel.shape[0] + ROOM)],
            real: vec![T::zero(); kernel.shape[1]],
            scratch: kernel.scratch(),
            kernel,
        }
    }

    /// Writes the convolution of `input` into `output`.
    ///
    /// # Panics
    /// If a field has another shape than the plans.
    pub fn apply(&mut self, input: &Array2<T>, output: &mut Array2<T>) {
        assert!(input.dim() == output.dim() && input.nrows() == self.rows.nrows(), "shape of the fields");
        self.rows_forward(input);
        self.columns_through_the_kernel();
        self.rows_back(output);
    }

    fn rows_forward(&mut self, input: &Array2<T>) {
        let ny = input.ncols();
        for (values, mut half) in input.outer_iter().zip(self.rows.outer_iter_mut()) {
            if values.iter().all(T::is_zero) {
                half.fill(Complex::zero());
                continue;
            }
            self.real[..ny].iter_mut().zip(values).for_each(|(r, p)| *r = *p);
            self.real[ny..].fill(T::zero());
            let half = half.as_slice_mut().expect("rows are contiguous");
            let plan = &self.kernel.along_y;
            plan.process_with_scratch(&mut self.real, half, &mut self.scratch).expect("lengths of the plan");
        }
    }

    fn columns_through_the_kernel(&mut self) {
        let nx = self.rows.nrows();
        let mx = self.kernel.shape[0];
        let half = self.kernel.half();
        let rows = self.rows.as_slice_mut().expect("standard layout");
        for first in (0..half).step_by(STRIP) {
            let width = STRIP.min(half - first);
            for (block, rows) in rows.chunks(BLOCK * half).enumerate() {
                for (c, column) in self.strip.chunks_exact_mut(mx + ROOM).take(width).enumerate() {
                    let column = &mut column[block * BLOCK..][..rows.len() / half];
                    column.iter_mut().zip(rows.chunks_exact(half)).for_each(|(v, row)| *v = row[first + c]);
                }
            }
            for (c, column) in self.strip.chunks_exact_mut(mx + ROOM).take(width).enumerate() {
                let column = &mut column[..mx];
                column[nx..].fill(Complex::zero());
                self.kernel.along_x.process_with_scratch(column, &mut self.scratch);
                let spectrum = self.kernel.spectrum.row(first + c);
                let spectrum = spectrum.as_slice().expect("rows are contiguous");
                let (front, back) = column.split_at_mut(mx / 2 + 1);
                front.iter_mut().zip(spectrum).for_each(|(v, k)| *v = v.scale(*k));
                back.iter_mut().rev().zip(&spectrum[1..]).for_each(|(v, k)| *v = v.scale(*k));
                self.kernel.back_x.process_with_scratch(column, &mut self.scratch);
            }
            for (block, rows) in rows.chunks_mut(BLOCK * half).enumerate() {
                for (c, column) in self.strip.chunks_exact(mx + ROOM).take(width).enumerate() {
                    let column = &column[block * BLOCK..][..rows.len() / half];
                    column.iter().zip(rows.chunks_exact_mut(half)).for_each(|(v, row)| row[first + c] = *v);
                }
            }
        }
    }

    fn rows_back(&mut self, output: &mut Array2<T>) {
        let my = self.kernel.shape[1];
        let unit = self.kernel.unit;
        for (mut half, mut values) in self.rows.outer_iter_mut().zip(output.outer_iter_mut()) {
            let half = half.as_slice_mut().expect("rows are contiguous");
            // A real field has real spectra at zero and, for even lengths, at the Nyquist frequency.
            half[0].im = T::zero();
            if my.is_multiple_of(2) {
                half[my / 2].im = T::zero();
            }
            let plan = &self.kernel.back_y;
            plan.process_with_scratch(half, &mut self.real, &mut self.scratch).expect("lengths of the plan");
            values.iter_mut().zip(&self.real).for_each(|(u, r)| *u = *r * unit);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_cyclic_sum_for_even_and_odd_sizes() {
        for shape in [[1, 1], [1, 6], [7, 1], [4, 6], [5, 7], [6, 9]] {
            let [nx, ny] = shape;
            let table =
                Field::from_shape_fn([nx / 2 + 1, ny / 2 + 1], |(i, j)| 1.0 / (1 + 2 * i + j * j) as f64);
            let input = Field::from_shape_fn(shape, |(i, j)| ((5 * i + 3 * j * j) % 7) as f64 - 2.0);
            let mut output = Field::zeros(shape);
            Convolution::new(Arc::new(Kernel::from_values(shape, &table)), shape).apply(&input, &mut output);
            for ((i, j), fast) in output.indexed_iter() {
                let fold = |a: usize, b: usize, n: usize| a.abs_diff(b).min(n - a.abs_diff(b));
                let terms =
                    input.indexed_iter().map(|((k, l), p)| p * table[[fold(i, k, nx), fold(j, l, ny)]]);
                let slow: f64 = terms.sum();
                assert!((fast - slow).abs() < 1e-12, "{shape:?} at {i}, {j}: {fast} and {slow}");
            }
        }
    }
}

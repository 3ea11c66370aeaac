//! Convolution with an even kernel by real Fourier transforms.

use std::sync::Arc;

use asperity_transforms::Precision;
use asperity_transforms::num_complex::Complex;
use asperity_transforms::num_traits::Zero;
use ndarray::{Array2, ArrayViewMut2, Axis};

use crate::grid::Field;
use crate::math::parallel::{self, Pool};
use asperity_base::math::fft::SHARE;
use asperity_base::math::kernel::{Kernel, multiply};
use asperity_base::math::plans::{Plans, real};

/// Number of columns that are transformed together: one or two cache lines of a row.
const STRIP: usize = 8;
/// Padding between the columns of a strip. Without it, columns with a power of two as length would map to the
/// same cache lines.
const ROOM: usize = 8;

/// Symmetry of a kernel under a change of sign of an offset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parity {
    /// The kernel does not change.
    Even,
    /// The kernel changes its sign.
    Odd,
}

impl Parity {
    /// Returns the value at `index` of a period of `length` from the values `at` in its first half.
    pub(super) fn extend(self, index: usize, length: usize, at: impl Fn(usize) -> f64) -> f64 {
        let mirrored = length - index;
        match self {
            Self::Even => at(index.min(mirrored)),
            Self::Odd if index == 0 || index == mirrored => 0.0,
            Self::Odd if index < mirrored => at(index),
            Self::Odd => -at(mirrored),
        }
    }

    /// Returns the nonzero part of the transform of a real kernel of this parity: the real or the imaginary
    /// part.
    fn part(self, value: Complex<f64>) -> f64 {
        match self {
            Self::Even => value.re,
            Self::Odd => value.im,
        }
    }
}

/// Smallest number of strips per thread.
pub(super) fn strips_at_once<T: Precision>(plans: &Plans<T>) -> usize {
    SHARE.div_ceil(STRIP * plans.shape[0])
}

/// Computes the transform of the kernel with the values `table[[i, j]]` at the offsets i, j for `i ≤ Mx/2`,
/// `j ≤ My/2`, and with this parity along x and y. The result at `[ky, kx]`, for `ky ≤ My/2`, `kx ≤ Mx/2`, is
/// the real factor of iⁿ, with n the number of odd axes.
pub fn spectrum(plans: &Plans<f64>, table: &Field, parity: [Parity; 2]) -> Field {
    let [mx, my] = plans.shape;
    let half = plans.half();
    let scratch = Pool::default();
    // The nonzero part of the transform along y of each row of the table.
    let mut rows = Field::zeros([mx / 2 + 1, half]);
    let parts = table.outer_iter().zip(rows.outer_iter_mut());
    parallel::each(
        parts,
        plans.rows_at_once(),
        &scratch,
        || Scratch::new(plans),
        |scratch, (values, mut to)| {
            let Scratch { row, columns, plan } = scratch;
            for (iy, value) in row.iter_mut().enumerate() {
                *value = parity[1].extend(iy, my, |iy| values[iy]);
            }
            let line = &mut columns[..half];
            plans.along_y.process_with_scratch(row, line, plan).expect("lengths come from the plan");
            to.iter_mut().zip(line).for_each(|(to, value)| *to = parity[1].part(*value));
        },
    );
    let mut spectrum = Field::zeros([half, mx / 2 + 1]);
    let strips = spectrum.axis_chunks_iter_mut(Axis(0), STRIP).zip(rows.axis_chunks_iter(Axis(1), STRIP));
    parallel::each(
        strips,
        strips_at_once(plans),
        &scratch,
        || Scratch::new(plans),
        |scratch, (mut to, rows)| {
            let Scratch { columns, plan, .. } = scratch;
            for (ix, row) in rows.outer_iter().enumerate() {
                for (column, value) in columns.chunks_exact_mut(mx + ROOM).zip(row) {
                    column[ix] = Complex::from(*value);
                }
            }
            for (column, mut to) in columns.chunks_exact_mut(mx + ROOM).zip(to.outer_iter_mut()) {
                let column = &mut column[..mx];
                for ix in 0..mx {
                    column[ix] = Complex::from(parity[0].extend(ix, mx, |ix| column[ix].re));
                }
                plans.along_x.process_with_scratch(column, plan);
                to.iter_mut().zip(column).for_each(|(to, value)| *to = parity[0].part(*value));
            }
        },
    );
    spectrum
}

/// Creates the kernel on a cyclic grid of `shape` with the values `table[[i, j]]` at the offsets ±i, ±j, for
/// `i ≤ Mx/2`, `j ≤ My/2`.
pub fn kernel_of_values(shape: [usize; 2], table: &Field) -> Kernel<f64> {
    let plans = Plans::new(shape);
    let spectrum = spectrum(&plans, table, [Parity::Even; 2]);
    Kernel::new(plans, spectrum)
}

/// Convolution of fields of one shape with a [`Kernel`] of at least this shape. Values beyond the field are
/// zero. With a kernel of at least `2n − 1` along each axis the cyclic convolution equals the free one.
///
/// Rows of zeros are not transformed. Columns are transformed in strips: forward, through the kernel and back
/// while they are in cache. Only the rows of the field are transformed back. With a kernel of twice the size
/// this takes about half the work of full transforms. Rows and strips are processed in parallel. A single
/// thread allocates nothing after construction.
pub struct Convolution<T> {
    kernel: Arc<Kernel<T>>,
    transform: Transform<T>,
    scratch: Pool<Scratch<T>>,
}

impl<T: Precision> Convolution<T> {
    /// Creates the convolution of fields of `shape`.
    ///
    /// # Panics
    /// If the kernel is smaller than `shape`.
    pub fn new(kernel: Arc<Kernel<T>>, shape: [usize; 2]) -> Self {
        Self { transform: Transform::new(&kernel.plans, shape), scratch: Pool::default(), kernel }
    }

    /// Computes the convolution `output` of `input`.
    ///
    /// # Panics
    /// If a field has another shape than the plans.
    pub fn apply(&mut self, input: &Array2<T>, output: &mut Array2<T>) {
        let Self { kernel, transform, scratch } = self;
        let plans = &kernel.plans;
        transform.rows_forward(plans, input, scratch);
        parallel::each(
            transform.strips(),
            strips_at_once(plans),
            scratch,
            || Scratch::new(plans),
            |scratch, mut strip| {
                strip.forward(plans, scratch);
                for (ky, column) in strip.columns(plans, scratch) {
                    let spectrum = kernel.spectrum.row(ky);
                    let spectrum = spectrum.as_slice().expect("rows are contiguous");
                    multiply(column, spectrum);
                }
                strip.back(plans, scratch);
            },
        );
        transform.rows_back(plans, real(kernel.unit), output, scratch);
    }
}

/// Scratch of the transforms, for one thread; several fields may share it.
pub(super) struct Scratch<T> {
    /// A row of the grid.
    row: Vec<T>,
    /// The columns of a strip, one after another.
    columns: Vec<Complex<T>>,
    plan: Vec<Complex<T>>,
}

impl<T: Precision> Scratch<T> {
    pub(super) fn new(plans: &Plans<T>) -> Self {
        Self {
            row: vec![T::zero(); plans.shape[1]],
            columns: vec![Complex::zero(); (STRIP * (plans.shape[0] + ROOM)).max(plans.half())],
            plan: plans.scratch(),
        }
    }
}

/// A field between the transforms of its rows and those of its columns.
pub(super) struct Transform<T> {
    rows: Array2<Complex<T>>,
}

impl<T: Precision> Transform<T> {
    /// Creates a transform of fields of `shape`, which may be smaller than the plans.
    pub(super) fn new(plans: &Plans<T>, shape: [usize; 2]) -> Self {
        let [mx, my] = plans.shape;
        assert!(shape[0] <= mx && shape[1] <= my, "kernel smaller than the field");
        Self { rows: Array2::from_elem([shape[0], plans.half()], Complex::zero()) }
    }

    /// Transforms the rows of `input`.
    pub(super) fn rows_forward(&mut self, plans: &Plans<T>, input: &Array2<T>, scratch: &Pool<Scratch<T>>) {
        assert_eq!(input.nrows(), self.rows.nrows(), "shape of the field");
        let rows = input.outer_iter().zip(self.rows.outer_iter_mut());
        parallel::each(
            rows,
            plans.rows_at_once(),
            scratch,
            || Scratch::new(plans),
            |scratch, (values, mut half)| {
                let half = half.as_slice_mut().expect("rows are contiguous");
                plans.row_forward(values, half, &mut scratch.row, &mut scratch.plan);
            },
        );
    }

    /// Returns the strips in which columns are transformed.
    pub(super) fn strips(&mut self) -> impl ExactSizeIterator<Item = Strip<'_, T>> {
        let strips = self.rows.axis_chunks_iter_mut(Axis(1), STRIP).enumerate();
        strips.map(|(number, rows)| Strip { first: number * STRIP, rows })
    }

    /// Transforms the rows back, multiplied by `unit`.
    pub(super) fn rows_back(
        &mut self,
        plans: &Plans<T>,
        unit: T,
        output: &mut Array2<T>,
        scratch: &Pool<Scratch<T>>,
    ) {
        assert_eq!(output.nrows(), self.rows.nrows(), "shape of the field");
        let rows = self.rows.outer_iter_mut().zip(output.outer_iter_mut());
        parallel::each(
            rows,
            plans.rows_at_once(),
            scratch,
            || Scratch::new(plans),
            |scratch, (mut half, mut values)| {
                let half = half.as_slice_mut().expect("rows are contiguous");
                plans.row_back(half, unit, values.view_mut(), &mut scratch.row, &mut scratch.plan);
            },
        );
    }
}

/// Some neighbouring frequencies along y, whose columns are transformed together.
pub(super) struct Strip<'a, T> {
    first: usize,
    rows: ArrayViewMut2<'a, Complex<T>>,
}

impl<T: Precision> Strip<'_, T> {
    /// Frequency along y, and position of its column in the scratch memory.
    pub(super) fn columns<'s>(
        &self,
        plans: &Plans<T>,
        scratch: &'s mut Scratch<T>,
    ) -> impl Iterator<Item = (usize, &'s mut [Complex<T>])> + use<'s, T> {
        let (first, mx) = (self.first, plans.shape[0]);
        let columns = scratch.columns.chunks_exact_mut(mx + ROOM).take(self.rows.ncols()).enumerate();
        columns.map(move |(c, column)| (first + c, &mut column[..mx]))
    }

    /// Transforms the columns into the scratch.
    pub(super) fn forward(&self, plans: &Plans<T>, scratch: &mut Scratch<T>) {
        let [mx, _] = plans.shape;
        let nx = self.rows.nrows();
        for (ix, row) in self.rows.outer_iter().enumerate() {
            let row = row.to_slice().expect("rows are contiguous");
            let columns = scratch.columns.chunks_exact_mut(mx + ROOM);
            columns.zip(row).for_each(|(column, value)| column[ix] = *value);
        }
        for column in scratch.columns.chunks_exact_mut(mx + ROOM).take(self.rows.ncols()) {
            column[nx..mx].fill(Complex::zero());
            plans.along_x.process_with_scratch(&mut column[..mx], &mut scratch.plan);
        }
    }

    /// Transforms the columns in the scratch back.
    pub(super) fn back(&mut self, plans: &Plans<T>, scratch: &mut Scratch<T>) {
        let [mx, _] = plans.shape;
        for column in scratch.columns.chunks_exact_mut(mx + ROOM).take(self.rows.ncols()) {
            plans.back_x.process_with_scratch(&mut column[..mx], &mut scratch.plan);
        }
        for (ix, row) in self.rows.outer_iter_mut().enumerate() {
            let row = row.into_slice().expect("rows are contiguous");
            let columns = scratch.columns.chunks_exact(mx + ROOM);
            columns.zip(row).for_each(|(column, value)| *value = column[ix]);
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
            Convolution::new(Arc::new(kernel_of_values(shape, &table)), shape).apply(&input, &mut output);
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

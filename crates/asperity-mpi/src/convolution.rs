//! Convolution of fields divided among ranks.

use std::ops::Range;
use std::sync::Arc;

use asperity_transforms::Precision;
use asperity_transforms::num_complex::Complex;
use asperity_transforms::num_traits::Zero;
use ndarray::Array2;

use crate::transposition::Transposition;
use asperity_base::grid::{Field, SingleField};
use asperity_base::math::kernel::{Kernel, largest, multiply};
use asperity_base::math::mixed::{LastUsed, Mixed};
use asperity_base::math::plans::{Plans, real};
use asperity_base::ranks::{Largest, Number, Parts, Ranks, Slab};

/// Number of rows that are transposed at a time.
const BLOCK: usize = 8;

/// Convolution in either precision of fields with rows on each rank. The kernel has at least their size, and
/// values beyond the fields are zero. The result has the bits of the convolution of one process.
///
/// Each rank transforms its rows. After a transposition each rank has some columns, which it transforms,
/// multiplies by the kernel and transforms back. A second transposition returns the rows.
pub(crate) struct SlabConvolution {
    ranks: Arc<dyn Ranks>,
    rows: Parts,
    /// The kernel at the frequencies along y of this rank.
    kernel: Mixed<Kernel<f64>, Kernel<f32>>,
    latest: LastUsed<Workspace<f64>, Workspace<f32>>,
}

impl SlabConvolution {
    /// Creates the convolution of the fields of a `slab` with the kernel of `shape` and this `transform` at
    /// the bins `(kx, ky)`, for `kx ≤ Mx/2`, `ky ≤ My/2`.
    pub(crate) fn from_transform(
        slab: &Slab,
        shape: [usize; 2],
        transform: impl Fn(usize, usize) -> f64,
    ) -> Self {
        let plans = Plans::new(shape);
        let columns = columns_of(&**slab.ranks(), plans.half());
        let spectrum = Field::from_shape_fn([columns.len(), shape[0] / 2 + 1], |(ky, kx)| {
            transform(kx, columns.start + ky)
        });
        Self::new(slab, plans, spectrum)
    }

    /// Creates the convolution of the fields of a `slab` with the kernel of `shape` and the values `at(i, j)`
    /// at the offsets ±i, ±j, for `i ≤ Mx/2`, `j ≤ My/2`.
    pub(crate) fn from_values(slab: &Slab, shape: [usize; 2], at: impl Fn(usize, usize) -> f64) -> Self {
        let plans = Plans::new(shape);
        let ranks = slab.ranks();
        let (half, rows) = (plans.half(), Parts::even(shape[0] / 2 + 1, ranks.count()));
        let columns = Parts::even(half, ranks.count());
        let mut transposition = Transposition::new(Arc::clone(ranks), rows.clone(), columns);
        let mut scratch = plans.scratch();
        let (mut row, mut spectrum) = (plans.along_y.make_input_vec(), plans.along_y.make_output_vec());
        let mut values = vec![0.0; half];
        for (n, ix) in rows.of_rank(ranks.rank()).enumerate() {
            values.iter_mut().enumerate().for_each(|(iy, value)| *value = at(ix, iy));
            for (iy, value) in row.iter_mut().enumerate() {
                *value = values[iy.min(shape[1] - iy)];
            }
            let forward = plans.along_y.process_with_scratch(&mut row, &mut spectrum, &mut scratch);
            forward.expect("lengths come from the plan");
            transposition.set_rows(n, &spectrum);
        }
        transposition.make_columns();
        let mut spectrum = Field::zeros([transposition.own_columns(), shape[0] / 2 + 1]);
        let mut front = vec![Complex::zero(); shape[0] / 2 + 1];
        let mut column = vec![Complex::zero(); shape[0]];
        for (n, mut spectrum) in spectrum.outer_iter_mut().enumerate() {
            transposition.column(n, &mut front);
            for (ix, value) in column.iter_mut().enumerate() {
                *value = Complex::from(front[ix.min(shape[0] - ix)].re);
            }
            plans.along_x.process_with_scratch(&mut column, &mut scratch);
            spectrum.iter_mut().zip(&column).for_each(|(s, c)| *s = c.re);
        }
        Self::new(slab, plans, spectrum)
    }

    fn new(slab: &Slab, plans: Plans<f64>, spectrum: Field) -> Self {
        let [rows, columns] = slab.whole_grid().shape;
        assert!(rows <= plans.shape[0] && columns <= plans.shape[1], "kernel smaller than the field");
        let Largest(largest) = slab.merged(Largest(largest(&spectrum)));
        Self {
            ranks: Arc::clone(slab.ranks()),
            rows: slab.parts().clone(),
            kernel: Mixed::new(Kernel::scaled(plans, spectrum, largest)),
            latest: LastUsed::None,
        }
    }

    /// Computes the convolution `output` of `input`, to 1e-15 of the largest output.
    pub(crate) fn apply(&mut self, input: &Field, output: &mut Field) {
        let Self { ranks, rows, kernel, latest } = self;
        latest.double(|| Workspace::new(ranks, rows, kernel.double())).apply(input, output);
    }

    /// Computes the convolution `output` of `input` in half the time, to 3e-7 of the largest output.
    pub(crate) fn apply_single(&mut self, input: &SingleField, output: &mut SingleField) {
        let Self { ranks, rows, kernel, latest } = self;
        latest.single(|| Workspace::new(ranks, rows, kernel.single(Kernel::to_single))).apply(input, output);
    }

    /// Releases the scratch memory.
    pub(crate) fn release(&mut self) {
        self.latest = LastUsed::None;
    }
}

/// Returns the frequencies along y of this rank, out of their total number.
fn columns_of(ranks: &dyn Ranks, frequencies: usize) -> Range<usize> {
    Parts::even(frequencies, ranks.count()).of_rank(ranks.rank())
}

/// A field during its transforms.
struct Workspace<T> {
    kernel: Arc<Kernel<T>>,
    transposition: Transposition<T>,
    row: Vec<T>,
    /// A few transformed rows.
    block: Vec<Complex<T>>,
    column: Vec<Complex<T>>,
    plan: Vec<Complex<T>>,
}

impl<T: Precision + Number> Workspace<T> {
    fn new(ranks: &Arc<dyn Ranks>, rows: &Parts, kernel: Arc<Kernel<T>>) -> Self {
        let (plans, [mx, my]) = (&kernel.plans, kernel.plans.shape);
        let columns = Parts::even(plans.half(), ranks.count());
        Self {
            transposition: Transposition::new(Arc::clone(ranks), rows.clone(), columns),
            row: vec![T::zero(); my],
            block: vec![Complex::zero(); BLOCK * plans.half()],
            column: vec![Complex::zero(); mx],
            plan: plans.scratch(),
            kernel,
        }
    }

    fn apply(&mut self, input: &Array2<T>, output: &mut Array2<T>) {
        let Self { kernel, transposition, row, block, column, plan } = self;
        let (plans, half) = (&kernel.plans, kernel.plans.half());
        for first in (0..input.nrows()).step_by(BLOCK) {
            let count = BLOCK.min(input.nrows() - first);
            let block = &mut block[..count * half];
            for (n, half) in block.chunks_exact_mut(half).enumerate() {
                plans.row_forward(input.row(first + n), half, row, plan);
            }
            transposition.set_rows(first, block);
        }
        transposition.make_columns();
        for (n, spectrum) in kernel.spectrum.outer_iter().enumerate() {
            let rows = transposition.all_rows();
            let (field, beyond) = column.split_at_mut(rows);
            transposition.column(n, field);
            beyond.fill(Complex::zero());
            plans.along_x.process_with_scratch(column, plan);
            multiply(column, spectrum.to_slice().expect("rows are contiguous"));
            plans.back_x.process_with_scratch(column, plan);
            transposition.set_column(n, &column[..rows]);
        }
        transposition.make_rows();
        for first in (0..output.nrows()).step_by(BLOCK) {
            let count = BLOCK.min(output.nrows() - first);
            let block = &mut block[..count * half];
            transposition.rows(first, block);
            for (n, half) in block.chunks_exact_mut(half).enumerate() {
                plans.row_back(half, real(kernel.unit), output.row_mut(first + n), row, plan);
            }
        }
    }
}

//! Real Fourier transforms of fields divided among ranks.

use std::ops::Range;
use std::sync::Arc;

use asperity_transforms::num_complex::Complex64;
use asperity_transforms::num_traits::Zero;
use ndarray::{Array2, ArrayView1};

use crate::transposition::Transposition;
use asperity_base::grid::Field;
use asperity_base::math::plans::Plans;
use asperity_base::ranks::{Parts, Ranks, Slab};

/// Number of rows that are transposed at a time.
const BLOCK: usize = 8;

/// Transforms of real fields of one shape, like [`asperity_base::math::RealFft2`]. Each rank has its rows of
/// the field, and its frequencies along y of the transform.
pub(crate) struct SlabTransform {
    ranks: Arc<dyn Ranks>,
    plans: Plans<f64>,
}

impl SlabTransform {
    /// Plans the transforms of fields of `shape`.
    pub(crate) fn new(ranks: &Arc<dyn Ranks>, shape: [usize; 2]) -> Self {
        Self { ranks: Arc::clone(ranks), plans: Plans::new(shape) }
    }

    /// The rows of this rank.
    pub(crate) fn rows(&self) -> Range<usize> {
        self.row_parts().of_rank(self.ranks.rank())
    }

    /// The frequencies along y of this rank.
    pub(crate) fn frequencies(&self) -> Range<usize> {
        self.column_parts().of_rank(self.ranks.rank())
    }

    fn row_parts(&self) -> Parts {
        Parts::even(self.plans.shape[0], self.ranks.count())
    }

    fn column_parts(&self) -> Parts {
        Parts::even(self.plans.half(), self.ranks.count())
    }

    /// Computes the unnormalised transform of a field. `row` sets its rows and is called in order for the
    /// rows of this rank. Returns `[l, k]` for the frequencies l of this rank along y.
    pub(crate) fn forward(&self, mut row: impl FnMut(usize, &mut [f64])) -> Array2<Complex64> {
        let Self { ranks, plans } = self;
        let [nx, ny] = plans.shape;
        let mut transposition = Transposition::new(Arc::clone(ranks), self.row_parts(), self.column_parts());
        let mut scratch = plans.scratch();
        let (mut values, mut room) = (vec![0.0; ny], vec![0.0; ny]);
        let mut block = vec![Complex64::zero(); BLOCK * plans.half()];
        let rows: Vec<usize> = self.rows().collect();
        for (n, rows) in rows.chunks(BLOCK).enumerate() {
            let block = &mut block[..rows.len() * plans.half()];
            for (ix, half) in rows.iter().zip(block.chunks_exact_mut(plans.half())) {
                row(*ix, &mut values);
                plans.row_forward(ArrayView1::from(&values), half, &mut room, &mut scratch);
            }
            transposition.set_rows(n * BLOCK, block);
        }
        transposition.make_columns();
        let mut columns = Array2::zeros([transposition.own_columns(), nx]);
        for (n, mut column) in columns.outer_iter_mut().enumerate() {
            let column = column.as_slice_mut().expect("standard layout");
            transposition.column(n, column);
            plans.along_x.process_with_scratch(column, &mut scratch);
        }
        columns
    }

    /// Computes the rows of a `slab` of the field with the transform `columns`, cropped to its grid. If
    /// `mirrored`, the last row becomes the first.
    pub(crate) fn inverse(&self, mut columns: Array2<Complex64>, slab: &Slab, mirrored: bool) -> Field {
        let Self { ranks, plans } = self;
        let [nx, ny] = plans.shape;
        let rows = slab.parts();
        let mut transposition = Transposition::new(Arc::clone(ranks), rows.clone(), self.column_parts());
        let mut scratch = plans.scratch();
        for (n, mut column) in columns.outer_iter_mut().enumerate() {
            let column = column.as_slice_mut().expect("standard layout");
            plans.back_x.process_with_scratch(column, &mut scratch);
            let field = &mut column[..rows.lines()];
            if mirrored {
                field.reverse();
            }
            transposition.set_column(n, field);
        }
        drop(columns);
        transposition.make_rows();
        let mut field = slab.grid().zeros();
        let mut room = vec![0.0; ny];
        let mut block = vec![Complex64::zero(); BLOCK * plans.half()];
        let scale = 1.0 / (nx * ny) as f64;
        for first in (0..field.nrows()).step_by(BLOCK) {
            let count = BLOCK.min(field.nrows() - first);
            let block = &mut block[..count * plans.half()];
            transposition.rows(first, block);
            for (n, half) in block.chunks_exact_mut(plans.half()).enumerate() {
                plans.row_back(half, scale, field.row_mut(first + n), &mut room, &mut scratch);
            }
        }
        field
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_base::grid::Grid;
    use asperity_base::math::RealFft2;
    use asperity_base::ranks::threads::on_ranks;
    use ndarray::s;

    #[test]
    fn it_has_the_bits_of_one_process() {
        for (shape, cut) in [([12, 10], [12, 10]), ([15, 9], [11, 7])] {
            let field = Field::from_shape_fn(shape, |(i, j)| ((7 * i + 3 * j * j) % 11) as f64 - 4.0);
            let fft = RealFft2::new(shape);
            let spectrum = fft.forward(&field);
            let back = fft.inverse_leading(&spectrum, cut);
            for count in 1..=4 {
                on_ranks(count, |ranks| {
                    let transform = SlabTransform::new(&ranks, shape);
                    let columns = transform.forward(|ix, row| {
                        row.iter_mut().zip(field.row(ix)).for_each(|(value, z)| *value = *z);
                    });
                    assert_eq!(columns, spectrum.slice(s![.., transform.frequencies()]).t());
                    let slab = Slab::new(ranks, Grid::new(cut, [1.0; 2]).unwrap()).unwrap();
                    let rows = slab.rows();
                    assert_eq!(
                        transform.inverse(columns.clone(), &slab, false),
                        back.slice(s![rows.clone(), ..])
                    );
                    let mirrored = back.slice(s![..;-1, ..]);
                    assert_eq!(transform.inverse(columns, &slab, true), mirrored.slice(s![rows, ..]));
                });
            }
        }
    }
}

//! Real Fourier transforms of many planes of one shape, with operations on each bin of all planes.

use std::sync::Arc;

use crate::math::parallel::{self, Pool};

use asperity_transforms::num_complex::Complex64;
use asperity_transforms::{ComplexToReal, Fft, Precision, RealToComplex};

/// Padding between the columns of neighbouring planes. Without it, columns with a power of two as length would map to
/// the same cache lines.
const ROOM: usize = 4;
/// Number of rows that are transposed at a time: two cache lines of complex numbers.
const BLOCK: usize = 8;

/// Smallest amount of numbers per thread.
const WORTH_A_THREAD: usize = 8192;

/// Returns the smallest number of parts per thread, for parts with this many numbers.
pub(crate) fn together(numbers: usize) -> usize {
    (WORTH_A_THREAD / numbers.max(1)).max(1)
}

/// Plans for planes of `cells`, which are padded with zeros to the `shape` of the transforms.
///
/// The rows are transformed first, with the planes in parallel. Then the columns are transformed, with the ky in
/// parallel; here the caller has access to all planes. The inverse reverses the order. A single thread computes each
/// number.
///
/// | what | indexed |
/// |---|---|
/// | planes | `[plane, ix, iy]` |
/// | transforms of their rows | `[plane, ky, ix]`, ky = 0 … ny/2 |
/// | columns | `[ky, plane, kx]`, with [`Planes::stride`] numbers from plane to plane, of which `shape[0]` count |
///
/// Forward transforms are unnormalised. Inverse transforms are divided by the number of bins.
pub(crate) struct Planes {
    shape: [usize; 2],
    cells: [usize; 2],
    along_y: Arc<dyn RealToComplex<f64>>,
    back_y: Arc<dyn ComplexToReal<f64>>,
    along_x: Arc<dyn Fft<f64>>,
    back_x: Arc<dyn Fft<f64>>,
}

impl Planes {
    /// Creates plans for planes of `cells` in transforms of `shape`.
    ///
    /// # Panics
    /// If the planes are larger than the transforms.
    pub(crate) fn new(shape: [usize; 2], cells: [usize; 2]) -> Self {
        assert!(cells[0] <= shape[0] && cells[1] <= shape[1], "shape of the planes");
        Self {
            shape,
            cells,
            along_y: f64::plan_real_forward(shape[1]),
            back_y: f64::plan_real_inverse(shape[1]),
            along_x: f64::plan_forward(shape[0]),
            back_x: f64::plan_inverse(shape[0]),
        }
    }

    /// Shape of the transforms.
    pub(crate) fn shape(&self) -> [usize; 2] {
        self.shape
    }

    /// Shape of the planes.
    pub(crate) fn cells(&self) -> [usize; 2] {
        self.cells
    }

    /// Number of frequencies along y.
    pub(crate) fn half(&self) -> usize {
        self.shape[1] / 2 + 1
    }

    /// Numbers from column to column.
    pub(crate) fn stride(&self) -> usize {
        self.shape[0] + ROOM
    }

    /// Allocates memory for the row transforms of this number of `planes`.
    pub(crate) fn rows(&self, planes: usize) -> Vec<Complex64> {
        vec![Complex64::default(); planes * self.half() * self.cells[0]]
    }

    /// Allocates memory for the columns of this number of `planes`.
    pub(crate) fn columns(&self, planes: usize) -> Vec<Complex64> {
        vec![Complex64::default(); planes * self.half() * self.stride()]
    }

    /// Creates scratch memory for [`Planes::column_forward`] and [`Planes::column_back`].
    pub(crate) fn scratch(&self) -> Vec<Complex64> {
        let length = self.along_x.get_inplace_scratch_len().max(self.back_x.get_inplace_scratch_len());
        vec![Complex64::default(); length]
    }

    /// Transforms the rows of the contiguous `planes`. Returns which of them have nonzero values. It writes
    /// nothing for planes of zeros.
    ///
    /// # Panics
    /// If a length does not fit.
    pub(crate) fn rows_forward(&self, planes: &[&[f64]], rows: &mut [Complex64]) -> Vec<bool> {
        let [nx, ny] = self.cells;
        let half = self.half();
        assert_eq!(rows.len(), planes.len() * half * nx, "room for the rows");
        let make = || {
            (
                vec![0.0; self.shape[1]],
                vec![Complex64::default(); BLOCK * half],
                self.along_y.make_scratch_vec(),
            )
        };
        let each = |(values, block, scratch): &mut (Vec<f64>, Vec<Complex64>, Vec<Complex64>),
                    (plane, to): (&&[f64], &mut [Complex64])| {
            assert_eq!(plane.len(), nx * ny, "shape of a plane");
            if plane.iter().all(|v| *v == 0.0) {
                return false;
            }
            for first in (0..nx).step_by(BLOCK) {
                let count = BLOCK.min(nx - first);
                for (n, spectrum) in block.chunks_exact_mut(half).take(count).enumerate() {
                    let row = &plane[(first + n) * ny..][..ny];
                    values[..ny].copy_from_slice(row);
                    values[ny..].fill(0.0);
                    let forward = self.along_y.process_with_scratch(values, spectrum, scratch);
                    forward.expect("lengths come from the plan");
                }
                for (ky, column) in to.chunks_exact_mut(nx).enumerate() {
                    for (n, value) in column[first..first + count].iter_mut().enumerate() {
                        *value = block[n * half + ky];
                    }
                }
            }
            true
        };
        let planes = planes.iter().zip(rows.chunks_exact_mut(half * nx));
        parallel::each(planes, together(nx * ny), &Pool::default(), make, each)
    }

    /// Pads the result of [`Planes::rows_forward`] for a plane at `ky` with zeros, and transforms it into a `column`.
    pub(crate) fn column_forward(
        &self,
        rows: &[Complex64],
        [plane, ky]: [usize; 2],
        column: &mut [Complex64],
        scratch: &mut [Complex64],
    ) {
        let nx = self.cells[0];
        column[..nx].copy_from_slice(&rows[(plane * self.half() + ky) * nx..][..nx]);
        column[nx..].fill(Complex64::default());
        self.along_x.process_with_scratch(&mut column[..self.shape[0]], scratch);
    }

    /// Transforms a `column` back in place.
    pub(crate) fn column_back(&self, column: &mut [Complex64], scratch: &mut [Complex64]) {
        self.back_x.process_with_scratch(&mut column[..self.shape[0]], scratch);
    }

    /// Computes the planes from `columns` that have been transformed back.
    ///
    /// # Panics
    /// If a length does not fit.
    pub(crate) fn rows_back(&self, columns: &[Complex64], planes: &mut [f64]) {
        let [nx, ny] = self.cells;
        let (half, stride) = (self.half(), self.stride());
        let count = planes.len() / (nx * ny);
        assert_eq!(columns.len(), count * half * stride, "number of columns");
        let scale = 1.0 / (self.shape[0] * self.shape[1]) as f64;
        let make = || {
            (
                self.back_y.make_output_vec(),
                vec![Complex64::default(); BLOCK * half],
                self.back_y.make_scratch_vec(),
            )
        };
        let planes = planes.chunks_exact_mut(nx * ny).enumerate();
        parallel::each(
            planes,
            together(nx * ny),
            &Pool::default(),
            make,
            |(values, block, scratch), (plane, to)| {
                for (first, rows) in (0..nx).step_by(BLOCK).zip(to.chunks_mut(BLOCK * ny)) {
                    for ky in 0..half {
                        let from = &columns[(ky * count + plane) * stride..][first..];
                        for (n, value) in from.iter().take(rows.len() / ny).enumerate() {
                            block[n * half + ky] = *value;
                        }
                    }
                    for (row, spectrum) in rows.chunks_exact_mut(ny).zip(block.chunks_exact_mut(half)) {
                        spectrum[0].im = 0.0;
                        if self.shape[1].is_multiple_of(2) {
                            spectrum[half - 1].im = 0.0;
                        }
                        let back = self.back_y.process_with_scratch(spectrum, values, scratch);
                        back.expect("lengths come from the plan");
                        row.iter_mut().zip(values.iter()).for_each(|(r, v)| *r = *v * scale);
                    }
                }
            },
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Field;
    use crate::math::RealFft2;

    #[test]
    fn they_are_the_transforms_of_each_plane_and_come_back() {
        for (shape, cells) in
            [([6, 8], [6, 8]), ([12, 10], [5, 4]), ([5, 7], [5, 7]), ([20, 1], [10, 1]), ([1, 6], [1, 3])]
        {
            let field = |seed: usize| {
                Field::from_shape_fn(cells, |(i, j)| {
                    ((7 * i + 3 * j * j + seed * (i + 1) * j) % 11) as f64 - 4.0
                })
            };
            let fields = [field(0), Field::zeros(cells), field(2)];
            let planes = Planes::new(shape, cells);
            let mut rows = planes.rows(3);
            let slices: Vec<&[f64]> = fields.iter().map(|f| f.as_slice().unwrap()).collect();
            assert_eq!(planes.rows_forward(&slices, &mut rows), [true, false, true]);
            let (mut columns, mut scratch) = (planes.columns(2), planes.scratch());
            let stride = planes.stride();
            for ky in 0..planes.half() {
                for (plane, from) in [0, 2].into_iter().enumerate() {
                    let column = &mut columns[(ky * 2 + plane) * stride..][..stride];
                    planes.column_forward(&rows, [from, ky], column, &mut scratch);
                    let expected = RealFft2::new(shape).forward(&fields[from]);
                    for kx in 0..shape[0] {
                        assert!((column[kx] - expected[[kx, ky]]).norm() < 1e-12, "{shape:?} at {kx}, {ky}");
                    }
                    planes.column_back(column, &mut scratch);
                }
            }
            let mut back = vec![0.0; 2 * cells[0] * cells[1]];
            planes.rows_back(&columns, &mut back);
            let expected = fields[0].iter().chain(&fields[2]);
            assert!(back.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{shape:?}");
        }
    }
}

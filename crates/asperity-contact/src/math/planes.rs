//! Real Fourier transforms of many planes of one shape.

use std::sync::Arc;

use crate::math::parallel::{self, Pool};

use asperity_transforms::num_complex::Complex64;
use asperity_transforms::{ComplexToReal, Fft, Precision, RealToComplex};

/// Padding between the harmonics of neighbouring frequencies. Without it, those of a power of two of cells
/// would map to the same cache lines.
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
/// The rows are transformed first, with the planes in parallel. Then the columns are transformed, with the ky
/// in parallel; here the caller has access to all planes. Columns exist only for the ky of the moment, since
/// padding makes them longer than their harmonics. The inverse reverses the order. A single thread computes
/// each number.
///
/// | what | indexed |
/// |---|---|
/// | planes | `[plane, ix, iy]` |
/// | harmonics: transforms of their rows | `[plane, ky, ix]`, ky = 0 … ny/2, with some room behind each ky |
/// | a column | `[kx]`, of one plane and one ky |
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

    /// Numbers from frequency to frequency in the harmonics of a plane.
    pub(crate) fn stride(&self) -> usize {
        self.cells[0] + ROOM
    }

    /// Allocates memory for the harmonics of this number of `planes`.
    pub(crate) fn harmonics(&self, planes: usize) -> Vec<Complex64> {
        vec![Complex64::default(); planes * self.half() * self.stride()]
    }

    /// Allocates memory for a column.
    pub(crate) fn column(&self) -> Vec<Complex64> {
        vec![Complex64::default(); self.shape[0]]
    }

    /// Creates scratch memory for [`Planes::column_forward`] and [`Planes::column_back`].
    pub(crate) fn scratch(&self) -> Vec<Complex64> {
        let length = self.along_x.get_inplace_scratch_len().max(self.back_x.get_inplace_scratch_len());
        vec![Complex64::default(); length]
    }

    /// Returns the harmonics of a `plane` at `ky`, one for each cell along x.
    pub(crate) fn row<'a>(&self, harmonics: &'a [Complex64], plane: usize, ky: usize) -> &'a [Complex64] {
        &harmonics[(plane * self.half() + ky) * self.stride()..][..self.cells[0]]
    }

    /// Divides the `harmonics` by frequency: returns, for each ky, those of all planes.
    pub(crate) fn by_frequency<'a>(&self, harmonics: &'a mut [Complex64]) -> Vec<Vec<&'a mut [Complex64]>> {
        let (half, stride) = (self.half(), self.stride());
        let planes = harmonics.len() / (half * stride);
        let mut frequencies: Vec<_> = (0..half).map(|_| Vec::with_capacity(planes)).collect();
        for (n, part) in harmonics.chunks_exact_mut(stride).enumerate() {
            frequencies[n % half].push(&mut part[..self.cells[0]]);
        }
        frequencies
    }

    /// Transforms the rows of the contiguous `planes`. Returns which of them have nonzero values. It writes
    /// nothing for planes of zeros, and for those that are missing.
    ///
    /// # Panics
    /// If a length does not fit.
    pub(crate) fn rows_forward(&self, planes: &[Option<&[f64]>], harmonics: &mut [Complex64]) -> Vec<bool> {
        let [nx, ny] = self.cells;
        let (half, stride) = (self.half(), self.stride());
        assert_eq!(harmonics.len(), planes.len() * half * stride, "room for the harmonics");
        let make = || {
            (
                vec![0.0; self.shape[1]],
                vec![Complex64::default(); BLOCK * half],
                self.along_y.make_scratch_vec(),
            )
        };
        let is_zero = |values: &[f64]| values.iter().all(|v| *v == 0.0);
        let each = |(values, block, scratch): &mut (Vec<f64>, Vec<Complex64>, Vec<Complex64>),
                    (plane, to): (&Option<&[f64]>, &mut [Complex64])| {
            let Some(plane) = plane else { return false };
            assert_eq!(plane.len(), nx * ny, "shape of a plane");
            if is_zero(plane) {
                return false;
            }
            for (first, rows) in (0..nx).step_by(BLOCK).zip(plane.chunks(BLOCK * ny)) {
                for (row, spectrum) in rows.chunks_exact(ny).zip(block.chunks_exact_mut(half)) {
                    if is_zero(row) {
                        spectrum.fill(Complex64::default());
                        continue;
                    }
                    values[..ny].copy_from_slice(row);
                    values[ny..].fill(0.0);
                    let forward = self.along_y.process_with_scratch(values, spectrum, scratch);
                    forward.expect("lengths come from the plan");
                }
                let count = rows.len() / ny;
                for (ky, column) in to.chunks_exact_mut(stride).enumerate() {
                    for (n, value) in column[first..first + count].iter_mut().enumerate() {
                        *value = block[n * half + ky];
                    }
                }
            }
            true
        };
        let planes = planes.iter().zip(harmonics.chunks_exact_mut(half * stride));
        parallel::each(planes, together(nx * ny), &Pool::default(), make, each)
    }

    /// Pads the `harmonics` of a plane at one ky with zeros, and transforms them into a `column`.
    pub(crate) fn column_forward(
        &self,
        harmonics: &[Complex64],
        column: &mut [Complex64],
        scratch: &mut [Complex64],
    ) {
        let (inside, padding) = column.split_at_mut(self.cells[0]);
        inside.copy_from_slice(harmonics);
        padding.fill(Complex64::default());
        self.along_x.process_with_scratch(column, scratch);
    }

    /// Transforms a `column` back in place, and stores the `harmonics` of the plane at its ky.
    pub(crate) fn column_back(
        &self,
        column: &mut [Complex64],
        harmonics: &mut [Complex64],
        scratch: &mut [Complex64],
    ) {
        self.back_x.process_with_scratch(column, scratch);
        harmonics.copy_from_slice(&column[..self.cells[0]]);
    }

    /// Transforms one plane. Returns its columns, `[ky, kx]`.
    ///
    /// # Panics
    /// If the length does not fit.
    pub(crate) fn forward(&self, plane: &[f64]) -> Vec<Complex64> {
        let mut harmonics = self.harmonics(1);
        let mut columns = vec![Complex64::default(); self.half() * self.shape[0]];
        if self.rows_forward(&[Some(plane)], &mut harmonics) == [true] {
            parallel::each(
                columns.chunks_exact_mut(self.shape[0]).enumerate(),
                together(self.shape[0]),
                &Pool::default(),
                || self.scratch(),
                |scratch, (ky, column)| self.column_forward(self.row(&harmonics, 0, ky), column, scratch),
            );
        }
        columns
    }

    /// Computes the planes from `harmonics`. Each row is passed to `finish`, with its plane and its ix.
    ///
    /// # Panics
    /// If a length does not fit.
    pub(crate) fn rows_back(
        &self,
        harmonics: &[Complex64],
        planes: &mut [f64],
        finish: impl Fn([usize; 2], &mut [f64]) + Sync,
    ) {
        let [nx, ny] = self.cells;
        let (half, stride) = (self.half(), self.stride());
        let count = planes.len() / (nx * ny);
        assert_eq!(harmonics.len(), count * half * stride, "number of harmonics");
        let scale = 1.0 / (self.shape[0] * self.shape[1]) as f64;
        let make = || {
            (
                self.back_y.make_output_vec(),
                vec![Complex64::default(); BLOCK * half],
                self.back_y.make_scratch_vec(),
            )
        };
        let planes = planes.chunks_exact_mut(nx * ny).zip(harmonics.chunks_exact(half * stride));
        parallel::each(
            planes.enumerate(),
            together(nx * ny),
            &Pool::default(),
            make,
            |(values, block, scratch), (plane, (to, from))| {
                for (first, rows) in (0..nx).step_by(BLOCK).zip(to.chunks_mut(BLOCK * ny)) {
                    let count = rows.len() / ny;
                    for (ky, column) in from.chunks_exact(stride).enumerate() {
                        for (n, value) in column[first..first + count].iter().enumerate() {
                            block[n * half + ky] = *value;
                        }
                    }
                    let rows = rows.chunks_exact_mut(ny).zip(block.chunks_exact_mut(half));
                    for (n, (row, spectrum)) in rows.enumerate() {
                        spectrum[0].im = 0.0;
                        if self.shape[1].is_multiple_of(2) {
                            spectrum[half - 1].im = 0.0;
                        }
                        let back = self.back_y.process_with_scratch(spectrum, values, scratch);
                        back.expect("lengths come from the plan");
                        row.iter_mut().zip(values.iter()).for_each(|(r, v)| *r = *v * scale);
                        finish([plane, first + n], row);
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
                    // One row is zero.
                    if i == 3 { 0.0 } else { ((7 * i + 3 * j * j + seed * (i + 1) * j) % 11) as f64 - 4.0 }
                })
            };
            let fields = [field(0), Field::zeros(cells), field(2)];
            let planes = Planes::new(shape, cells);
            let slices: Vec<Option<&[f64]>> =
                fields.iter().map(|field| field.as_slice()).chain([None]).collect();
            let mut harmonics = planes.harmonics(4);
            assert_eq!(planes.rows_forward(&slices, &mut harmonics), [true, false, true, false]);
            let (mut column, mut scratch) = (planes.column(), planes.scratch());
            let columns = planes.forward(slices[2].unwrap());
            for (ky, mut of_planes) in planes.by_frequency(&mut harmonics).into_iter().enumerate() {
                for plane in [0, 2] {
                    planes.column_forward(of_planes[plane], &mut column, &mut scratch);
                    let expected = RealFft2::new(shape).forward(&fields[plane]);
                    for kx in 0..shape[0] {
                        assert!((column[kx] - expected[[kx, ky]]).norm() < 1e-12, "{shape:?} at {kx}, {ky}");
                    }
                    if plane == 2 {
                        assert_eq!(column, columns[ky * shape[0]..][..shape[0]]);
                    }
                    planes.column_back(&mut column, of_planes[plane], &mut scratch);
                }
            }
            let mut back = vec![0.0; 4 * cells[0] * cells[1]];
            planes.rows_back(&harmonics, &mut back, |[plane, ix], row| {
                row.iter_mut().for_each(|value| *value += (plane * ix) as f64);
            });
            for ((plane, field), back) in fields.iter().enumerate().zip(back.chunks(cells[0] * cells[1])) {
                for (((ix, _), expected), found) in field.indexed_iter().zip(back) {
                    assert!((found - expected - (plane * ix) as f64).abs() < 1e-12, "{shape:?}");
                }
            }
        }
    }
}

//! Two-dimensional real Fourier transforms.

use std::sync::Arc;

use asperity_transforms::num_complex::Complex64;
use asperity_transforms::{ComplexToReal, Fft, Precision, RealToComplex};
use ndarray::{Array2, Axis};

use crate::grid::Field;
use crate::math::parallel::{self, Pool};

/// Transform of a real field of one shape: half-complex along y, complex along x.
///
/// `forward` is unnormalised, `ẑ[k, l] = Σ z[i, j] exp(−2πi (k i/nx + l j/ny))` for `l = 0 … ny/2`;
/// `inverse` divides by `nx ny`, so that it inverts `forward`. Rows and columns are processed in parallel.
pub struct RealFft2 {
    shape: [usize; 2],
    along_y: Arc<dyn RealToComplex<f64>>,
    back_y: Arc<dyn ComplexToReal<f64>>,
    along_x: Arc<dyn Fft<f64>>,
    back_x: Arc<dyn Fft<f64>>,
}

impl RealFft2 {
    /// Creates plans for fields of `shape`.
    pub fn new(shape: [usize; 2]) -> Self {
        Self {
            shape,
            along_y: f64::plan_real_forward(shape[1]),
            back_y: f64::plan_real_inverse(shape[1]),
            along_x: f64::plan_forward(shape[0]),
            back_x: f64::plan_inverse(shape[0]),
        }
    }

    /// Returns the number of stored frequencies along y.
    pub fn half(&self) -> usize {
        self.shape[1] / 2 + 1
    }

    /// Shape of the fields.
    pub fn shape(&self) -> [usize; 2] {
        self.shape
    }

    /// Computes the spectrum of `field`, shape `[nx, ny/2 + 1]`. A smaller field is padded with zeros.
    ///
    /// # Panics
    /// If `field` is larger than the plans.
    pub fn forward(&self, field: &Field) -> Array2<Complex64> {
        self.forward_transposed(field).t().as_standard_layout().into_owned()
    }

    /// [`RealFft2::forward`] with the spectrum indexed `[l, k]`, which takes less memory.
    ///
    /// # Panics
    /// If `field` is larger than the plans.
    pub fn forward_transposed(&self, field: &Field) -> Array2<Complex64> {
        assert!(field.nrows() <= self.shape[0] && field.ncols() <= self.shape[1], "shape of the field");
        let mut columns = self.rows_forward(field.nrows(), |ix, row| {
            let values = field.row(ix);
            row.iter_mut().zip(values).for_each(|(r, v)| *r = *v);
            row[values.len()..].fill(0.0);
        });
        self.each_column(&mut columns, |_, column, scratch| {
            self.along_x.process_with_scratch(column, scratch);
        });
        columns
    }

    /// Computes the first rows and columns, of this `shape`, of the field with this spectrum.
    ///
    /// # Panics
    /// If the shape of `spectrum` differs from that of [`RealFft2::forward`], or `shape` is larger than the
    /// plans.
    pub fn inverse_leading(&self, spectrum: &Array2<Complex64>, shape: [usize; 2]) -> Field {
        assert_eq!(spectrum.dim(), (self.shape[0], self.half()), "shape of the spectrum");
        self.inverse_transposed(spectrum.t().as_standard_layout().into_owned(), shape)
    }

    /// [`RealFft2::inverse_leading`] of a spectrum `[l, k]`. Frequencies l with zero amplitudes take no time.
    ///
    /// # Panics
    /// If `columns` has another shape than `[ny/2 + 1, nx]`, or `shape` is larger than the plans.
    pub fn inverse_transposed(&self, mut columns: Array2<Complex64>, shape: [usize; 2]) -> Field {
        assert!(shape[0] <= self.shape[0] && shape[1] <= self.shape[1], "shape of the field");
        assert_eq!(columns.dim(), (self.half(), self.shape[0]), "shape of the spectrum");
        self.each_column(&mut columns, |_, column, scratch| {
            if column.iter().any(|value| *value != Complex64::default()) {
                self.back_x.process_with_scratch(column, scratch);
            }
        });
        let (mut field, half) = (Field::zeros(shape), self.half());
        let columns = columns.as_slice().expect("standard layout");
        let scale = 1.0 / (self.shape[0] * self.shape[1]) as f64;
        parallel::each(
            field.axis_chunks_iter_mut(Axis(0), BLOCK).enumerate(),
            SHARE.div_ceil(BLOCK * half),
            &Pool::default(),
            || {
                let block = vec![Complex64::default(); BLOCK * half];
                (block, self.back_y.make_output_vec(), self.back_y.make_scratch_vec())
            },
            |(block, row, scratch), (n, mut rows)| {
                let own = n * BLOCK..n * BLOCK + rows.nrows();
                for (l, column) in columns.chunks_exact(self.shape[0]).enumerate() {
                    let to = block[l..].iter_mut().step_by(half);
                    to.zip(&column[own.clone()]).for_each(|(to, from)| *to = *from);
                }
                for (mut values, half) in rows.outer_iter_mut().zip(block.chunks_exact_mut(half)) {
                    make_hermitian(half, self.shape[1]);
                    let back = self.back_y.process_with_scratch(half, row, scratch);
                    back.expect("lengths come from the plan");
                    values.iter_mut().zip(&*row).for_each(|(v, r)| *v = *r * scale);
                }
            },
        );
        field
    }

    /// Performs a `task` on each of the `columns`, with its number and scratch for the plans along x.
    fn each_column(
        &self,
        columns: &mut Array2<Complex64>,
        task: impl Fn(usize, &mut [Complex64], &mut [Complex64]) + Sync + Send,
    ) {
        let scratch = self.along_x.get_inplace_scratch_len().max(self.back_x.get_inplace_scratch_len());
        parallel::each(
            columns.outer_iter_mut().enumerate(),
            SHARE.div_ceil(self.shape[0]),
            &Pool::default(),
            || vec![Complex64::default(); scratch],
            |scratch, (number, mut column)| {
                task(number, column.as_slice_mut().expect("standard layout"), scratch);
            },
        );
    }

    /// Computes the first rows and columns, of this `shape`, of a field whose waves are multiplied by
    /// `response`, indexed `[l, k]`, l = 0 … ny/2.
    ///
    /// `row` is called for each row of the field in order and sets its values. The field itself is never in
    /// memory.
    ///
    /// # Panics
    /// If `response` has another shape than `[ny/2 + 1, nx]`, or `shape` is larger than the plans.
    pub fn filter(&self, mut row: impl FnMut(&mut [f64]), response: &Field, shape: [usize; 2]) -> Field {
        assert_eq!(response.dim(), (self.half(), self.shape[0]), "shape of the response");
        let mut columns = self.rows_forward(self.shape[0], |_, values| row(values));
        self.each_column(&mut columns, |number, column, scratch| {
            let response = response.row(number);
            if response.iter().all(|r| *r == 0.0) {
                column.fill(Complex64::default());
            } else {
                self.along_x.process_with_scratch(column, scratch);
                column.iter_mut().zip(response).for_each(|(v, r)| *v *= *r);
            }
        });
        self.inverse_transposed(columns, shape)
    }

    /// Computes the transforms along y of the first `rows` rows, indexed `[l, ix]`; the other rows are 0.
    fn rows_forward(&self, rows: usize, mut row: impl FnMut(usize, &mut [f64])) -> Array2<Complex64> {
        let mut columns = Array2::zeros([self.half(), self.shape[0]]);
        transform_rows(&*self.along_y, rows, &mut row, &mut columns);
        columns
    }
}

/// Computes the transform of a real point-symmetric field, z[−i, −j] = z[i, j]. The transform is also real
/// and point-symmetric.
///
/// `half` holds the rows i = 0 … nx/2 of the field of `shape` = [nx, ny]. The result holds the frequencies
/// `[l, k]`, l = 0 … ny/2, of the unnormalised transform. A second call with the shape reversed returns the
/// field times nx ny. It takes a quarter of the work of a complex transform.
///
/// # Panics
/// If `half` has another shape than `[nx/2 + 1, ny]`.
pub fn symmetric_transform(half: &Field, [nx, ny]: [usize; 2]) -> Field {
    assert_eq!(half.dim(), (nx / 2 + 1, ny), "shape of the half field");
    let (along_y, along_x) = (f64::plan_real_forward(ny), f64::plan_real_inverse(nx));
    let mut columns = Array2::zeros([ny / 2 + 1, nx / 2 + 1]);
    let mut row = |ix: usize, values: &mut [f64]| {
        values.iter_mut().zip(half.row(ix)).for_each(|(v, z)| *v = *z);
    };
    transform_rows(&*along_y, nx / 2 + 1, &mut row, &mut columns);
    let mut transform = Field::zeros([ny / 2 + 1, nx]);
    parallel::each(
        columns.outer_iter_mut().zip(transform.outer_iter_mut()),
        SHARE.div_ceil(nx),
        &Pool::default(),
        || along_x.make_scratch_vec(),
        |scratch, (mut column, mut values)| {
            let column = column.as_slice_mut().expect("standard layout");
            // The rows −i have the conjugate transforms of the rows i, so the inverse plan has the sign
            // of the forward one.
            column.iter_mut().for_each(|value| *value = value.conj());
            make_hermitian(column, nx);
            let values = values.as_slice_mut().expect("standard layout");
            along_x.process_with_scratch(column, values, scratch).expect("lengths come from the plan");
        },
    );
    transform
}

/// Rows transposed at a time: two cache lines of complex numbers.
const BLOCK: usize = 8;
/// Smallest amount of complex numbers per thread.
pub const SHARE: usize = 1 << 16;

/// Transforms the first `rows` rows, which `row` sets, into the first entries of the columns.
fn transform_rows(
    plan: &dyn RealToComplex<f64>,
    rows: usize,
    row: &mut dyn FnMut(usize, &mut [f64]),
    columns: &mut Array2<Complex64>,
) {
    let mut values = plan.make_input_vec();
    let mut scratch = plan.make_scratch_vec();
    let [half, length] = [columns.nrows(), columns.ncols()];
    let columns = columns.as_slice_mut().expect("standard layout");
    let mut block = vec![Complex64::default(); BLOCK * half];
    for first in (0..rows).step_by(BLOCK) {
        let own = first..rows.min(first + BLOCK);
        for (ix, spectrum) in own.clone().zip(block.chunks_exact_mut(half)) {
            row(ix, &mut values);
            plan.process_with_scratch(&mut values, spectrum, &mut scratch)
                .expect("lengths come from the plan");
        }
        for (l, column) in columns.chunks_exact_mut(length).enumerate() {
            let from = block[l..].iter().step_by(half);
            column[own.clone()].iter_mut().zip(from).for_each(|(to, from)| *to = *from);
        }
    }
}

/// The transform of `n` real numbers is real at zero and, for even n, at the Nyquist frequency.
fn make_hermitian(half: &mut [Complex64], n: usize) {
    half[0].im = 0.0;
    if n.is_multiple_of(2) {
        half[n / 2].im = 0.0;
    }
}

/// Angular frequency of bin `k` of a transform of `n` samples at `pitch`: 2π k'/(n pitch), −n/2 < k' ≤ n/2.
pub fn angular_frequency(k: usize, n: usize, pitch: f64) -> f64 {
    let signed = if 2 * k > n { k as f64 - n as f64 } else { k as f64 };
    std::f64::consts::TAU * signed / (n as f64 * pitch)
}

#[cfg(test)]
mod tests {
    use ndarray::s;

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
            let back = fft.inverse_leading(&spectrum, fft.shape);
            assert!(back.iter().zip(&field).all(|(a, b)| (a - b).abs() < 1e-12));
        }
    }

    #[test]
    fn a_smaller_field_is_continued_by_zeros() {
        let (small, fft) =
            (Field::from_shape_fn([3, 4], |(i, j)| (1 + 5 * i + j * j) as f64), RealFft2::new([6, 7]));
        let mut padded = Field::zeros([6, 7]);
        padded.slice_mut(s![..3, ..4]).assign(&small);
        let spectrum = fft.forward(&small);
        assert_eq!(spectrum, fft.forward(&padded));
        let whole = fft.inverse_leading(&spectrum, fft.shape);
        assert_eq!(fft.inverse_leading(&spectrum, [2, 5]), whole.slice(s![..2, ..5]));
    }

    #[test]
    fn a_filter_multiplies_every_wave() {
        for shape in [[6, 8], [5, 9]] {
            let fft = RealFft2::new(shape);
            let field = Field::from_shape_fn(shape, |(i, j)| ((7 * i + 3 * j * j) % 11) as f64 - 4.0);
            let response =
                |k: usize, l: usize| if l == 1 { 0.0 } else { (1 + k.min(shape[0] - k) + l) as f64 };
            let mut spectrum = fft.forward(&field);
            spectrum.indexed_iter_mut().for_each(|((k, l), value)| *value *= response(k, l));
            let expected = fft.inverse_leading(&spectrum, [3, 4]);
            let mut rows = field.outer_iter();
            let row = |values: &mut [f64]| values.copy_from_slice(rows.next().unwrap().as_slice().unwrap());
            let table = Field::from_shape_fn([fft.half(), shape[0]], |(l, k)| response(k, l));
            let filtered = fft.filter(row, &table, [3, 4]);
            assert!(filtered.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12), "{filtered}");
        }
    }

    #[test]
    fn a_symmetric_field_has_a_real_transform_which_gives_it_back() {
        for [nx, ny] in [[6, 8], [5, 9], [8, 5], [1, 4], [4, 1]] {
            let waves = [(1, 0, 0.4), (0, 1, 0.7), (1, 2, 1.0), (2, -1, -0.3)];
            let field = Field::from_shape_fn([nx, ny], |(i, j)| {
                let wave = |(k, l, height): (i32, i32, f64)| {
                    let turns = f64::from(k) * i as f64 / nx as f64 + f64::from(l) * j as f64 / ny as f64;
                    height * (std::f64::consts::TAU * turns).cos()
                };
                0.2 + waves.map(wave).iter().sum::<f64>()
            });
            let half = field.slice(s![..nx / 2 + 1, ..]).to_owned();
            let transform = symmetric_transform(&half, [nx, ny]);
            let expected = RealFft2::new([nx, ny]).forward(&field);
            for ((l, k), value) in transform.indexed_iter() {
                assert!((expected[[k, l]] - value).norm() < 1e-12, "[{nx}, {ny}] at {k}, {l}");
            }
            let back = symmetric_transform(&transform, [ny, nx]) / (nx * ny) as f64;
            assert!(back.iter().zip(&half).all(|(a, b)| (a - b).abs() < 1e-13), "[{nx}, {ny}]");
        }
    }
}

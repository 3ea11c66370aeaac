//! The free boundary by zero-padded transforms, pruned to what is not zero.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock};

use ndarray::Array2;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex, num_complex::Complex64};
use rustfft::{Fft, FftPlanner};

use crate::grid::{Field, Grid};
use crate::kernel::{influence_table, normal_displacement};
use crate::math::good_size;
use crate::operator::{Operator, coarse_free_grid};
use crate::units::{Metre, Pascal};

/// Columns that are transformed together: two cache lines of a row.
const STRIP: usize = 8;

/// All free operators of one pitch and modulus: they share the spectra of the influence coefficients.
///
/// A spectrum belongs to a padded size, and serves every grid that fits into it: the growing overlaps of a pass
/// need only a few.
pub struct FreeFamily {
    pitch: [Metre; 2],
    modulus: Pascal,
    kernels: Mutex<HashMap<[usize; 2], Arc<Kernel>>>,
    coarse: OnceLock<Arc<FreeFamily>>,
}

impl FreeFamily {
    /// The family of a cell size and composite modulus E*.
    pub fn new(pitch: [Metre; 2], modulus: Pascal) -> Arc<Self> {
        Arc::new(Self { pitch, modulus, kernels: Mutex::default(), coarse: OnceLock::new() })
    }

    /// The operator on a grid of `shape` cells.
    pub fn operator(self: &Arc<Self>, shape: [usize; 2]) -> FreeFft {
        let kernel = self.kernel(shape.map(|n| good_size(2 * n - 1)));
        FreeFft {
            grid: Grid { shape, pitch: self.pitch },
            rows: Array2::zeros([shape[0], kernel.half()]),
            strip: vec![Complex64::default(); STRIP * kernel.padded[0]],
            real: vec![0.0; kernel.padded[1]],
            scratch: kernel.scratch(),
            kernel,
            family: Arc::clone(self),
        }
    }

    fn kernel(&self, padded: [usize; 2]) -> Arc<Kernel> {
        let mut kernels = self.kernels.lock().expect("no holder panics");
        let kernel = kernels.entry(padded);
        Arc::clone(kernel.or_insert_with(|| Arc::new(Kernel::new(padded, self.pitch, self.modulus))))
    }
}

/// Influence coefficients of one padded size in Fourier space, with the plans of that size.
struct Kernel {
    padded: [usize; 2],
    /// Real and even along both axes: `[ky, kx]` for `ky ≤ My/2`, `kx ≤ Mx/2`, divided by Mx My.
    spectrum: Field,
    along_y: Arc<dyn RealToComplex<f64>>,
    back_y: Arc<dyn ComplexToReal<f64>>,
    along_x: Arc<dyn Fft<f64>>,
    back_x: Arc<dyn Fft<f64>>,
}

impl Kernel {
    fn new(padded: [usize; 2], pitch: [Metre; 2], modulus: Pascal) -> Self {
        let mut real = RealFftPlanner::new();
        let mut complex = FftPlanner::new();
        let [mx, my] = padded;
        let mut kernel = Self {
            padded,
            spectrum: Field::zeros([my / 2 + 1, mx / 2 + 1]),
            along_y: real.plan_fft_forward(my),
            back_y: real.plan_fft_inverse(my),
            along_x: complex.plan_fft_forward(mx),
            back_x: complex.plan_fft_inverse(mx),
        };
        let table = influence_table([mx / 2 + 1, my / 2 + 1], pitch, modulus);
        let mut scratch = kernel.scratch();
        let mut row = kernel.along_y.make_input_vec();
        let mut half = kernel.along_y.make_output_vec();
        for (ix, coefficients) in table.outer_iter().enumerate() {
            for (iy, value) in row.iter_mut().enumerate() {
                *value = coefficients[iy.min(my - iy)];
            }
            let forward = kernel.along_y.process_with_scratch(&mut row, &mut half, &mut scratch);
            forward.expect("lengths come from the plan");
            kernel.spectrum.column_mut(ix).iter_mut().zip(&half).for_each(|(s, h)| *s = h.re);
        }
        let scale = 1.0 / (mx * my) as f64;
        let mut column = vec![Complex64::default(); mx];
        for mut spectrum in kernel.spectrum.outer_iter_mut() {
            for (ix, value) in column.iter_mut().enumerate() {
                *value = Complex64::from(spectrum[ix.min(mx - ix)]);
            }
            kernel.along_x.process_with_scratch(&mut column, &mut scratch);
            spectrum.iter_mut().zip(&column).for_each(|(s, c)| *s = c.re * scale);
        }
        kernel
    }

    fn half(&self) -> usize {
        self.padded[1] / 2 + 1
    }

    /// Scratch for any of the plans.
    fn scratch(&self) -> Vec<Complex64> {
        let lengths = [
            self.along_y.get_scratch_len(),
            self.back_y.get_scratch_len(),
            self.along_x.get_inplace_scratch_len(),
            self.back_x.get_inplace_scratch_len(),
        ];
        vec![Complex64::default(); lengths.into_iter().max().unwrap_or(0)]
    }
}

/// A half-space pair loaded on a finite grid: the discrete convolution with Love's coefficients, exact to round-off.
///
/// Zero padding makes the circular convolution of the transforms the free one. Rows without pressure are not
/// transformed, columns are transformed in strips that go forth, through the kernel and back while they are in
/// cache, and only the rows of the grid come back: about half the work of whole transforms.
pub struct FreeFft {
    grid: Grid,
    kernel: Arc<Kernel>,
    family: Arc<FreeFamily>,
    rows: Array2<Complex64>,
    strip: Vec<Complex64>,
    real: Vec<f64>,
    scratch: Vec<Complex64>,
}

impl FreeFft {
    /// The operator on `grid` for the composite `modulus`.
    pub fn new(grid: Grid, modulus: Pascal) -> Self {
        FreeFamily::new(grid.pitch, modulus).operator(grid.shape)
    }

    fn rows_forward(&mut self, pressure: &Field) {
        let ny = self.grid.shape[1];
        for (values, mut half) in pressure.outer_iter().zip(self.rows.outer_iter_mut()) {
            if values.iter().all(|p| *p == 0.0) {
                half.fill(Complex64::default());
                continue;
            }
            self.real[..ny].iter_mut().zip(values).for_each(|(r, p)| *r = *p);
            self.real[ny..].fill(0.0);
            let half = half.as_slice_mut().expect("rows are contiguous");
            self.kernel
                .along_y
                .process_with_scratch(&mut self.real, half, &mut self.scratch)
                .expect("lengths come from the plan");
        }
    }

    fn columns_through_the_kernel(&mut self) {
        let mx = self.kernel.padded[0];
        let half = self.kernel.half();
        for first in (0..half).step_by(STRIP) {
            let width = STRIP.min(half - first);
            let strip = &mut self.strip[..width * mx];
            for (ix, row) in self.rows.outer_iter().enumerate() {
                for c in 0..width {
                    strip[c * mx + ix] = row[first + c];
                }
            }
            for column in strip.chunks_exact_mut(mx) {
                column[self.grid.shape[0]..].fill(Complex64::default());
            }
            self.kernel.along_x.process_with_scratch(strip, &mut self.scratch);
            for (c, column) in strip.chunks_exact_mut(mx).enumerate() {
                let spectrum = self.kernel.spectrum.row(first + c);
                let spectrum = spectrum.as_slice().expect("rows are contiguous");
                let (front, back) = column.split_at_mut(mx / 2 + 1);
                front.iter_mut().zip(spectrum).for_each(|(v, k)| *v *= *k);
                back.iter_mut().rev().zip(&spectrum[1..]).for_each(|(v, k)| *v *= *k);
            }
            self.kernel.back_x.process_with_scratch(strip, &mut self.scratch);
            for (ix, mut row) in self.rows.outer_iter_mut().enumerate() {
                for c in 0..width {
                    row[first + c] = strip[c * mx + ix];
                }
            }
        }
    }

    fn rows_back(&mut self, displacement: &mut Field) {
        let last = self.kernel.half() - 1;
        for (mut half, mut values) in self.rows.outer_iter_mut().zip(displacement.outer_iter_mut()) {
            let half = half.as_slice_mut().expect("rows are contiguous");
            half[0].im = 0.0;
            half[last].im = 0.0;
            self.kernel
                .back_y
                .process_with_scratch(half, &mut self.real, &mut self.scratch)
                .expect("lengths come from the plan");
            values.iter_mut().zip(&self.real).for_each(|(u, r)| *u = *r);
        }
    }
}

impl Operator for FreeFft {
    fn grid(&self) -> &Grid {
        &self.grid
    }

    fn modulus(&self) -> Pascal {
        self.family.modulus
    }

    fn periodic(&self) -> bool {
        false
    }

    fn influence(&self, i: usize, j: usize) -> f64 {
        let [dx, dy] = self.grid.pitch;
        normal_displacement(i as f64 * dx, j as f64 * dy, [dx, dy], self.family.modulus)
    }

    fn apply(&mut self, pressure: &Field, displacement: &mut Field) {
        self.rows_forward(pressure);
        self.columns_through_the_kernel();
        self.rows_back(displacement);
    }

    fn coarse(&self) -> Box<dyn Operator> {
        let grid = coarse_free_grid(&self.grid);
        let family = self.family.coarse.get_or_init(|| FreeFamily::new(grid.pitch, self.family.modulus));
        Box::new(family.operator(grid.shape))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::operator::DirectSum;

    #[test]
    fn it_is_the_direct_sum_to_round_off() {
        for (shape, pitch) in [
            ([12, 12], [1.0, 1.0]),
            ([1, 9], [1.0, 0.5]),
            ([9, 1], [1.0, 2.0]),
            ([7, 20], [0.3, 1.0]),
            ([33, 18], [1e-6, 2e-6]),
        ] {
            let grid = Grid::new(shape, pitch).unwrap();
            let pressure = Field::from_shape_fn(shape, |(i, j)| {
                if (i / 2) % 3 == 1 { 0.0 } else { ((7 * i + 3 * j * j) % 11) as f64 }
            });
            let (mut fast, mut slow) = (grid.zeros(), grid.zeros());
            FreeFft::new(grid, 115e9).apply(&pressure, &mut fast);
            DirectSum::new(grid, 115e9).apply(&pressure, &mut slow);
            let largest = slow.iter().fold(0.0f64, |m, u| m.max(*u));
            let error = fast.iter().zip(&slow).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
            assert!(error <= 1e-14 * largest, "{shape:?}: {error:e} of {largest:e}");
        }
    }

    #[test]
    fn grids_of_one_padded_size_share_their_kernel() {
        let family = FreeFamily::new([1.0, 1.0], 1.0);
        let (a, b) = (family.operator([31, 32]), family.operator([32, 32]));
        assert!(Arc::ptr_eq(&a.kernel, &b.kernel));
    }
}

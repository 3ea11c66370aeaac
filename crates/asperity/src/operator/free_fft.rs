//! The free boundary by zero-padded transforms, pruned to what is not zero.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock};

use crate::grid::{Field, Grid, SingleField};
use crate::kernel::{influence_table, normal_displacement};
use crate::math::{Kernel, MixedConvolution, MixedKernel, good_size};
use crate::operator::{Operator, coarse_free_grid};
use crate::units::{Metre, Pascal};

/// All free operators of one pitch and modulus: they share the spectra of the influence coefficients.
///
/// A spectrum belongs to a padded size, and serves every grid that fits into it: the growing overlaps of a pass
/// need only a few.
pub struct FreeFamily {
    pitch: [Metre; 2],
    modulus: Pascal,
    kernels: Mutex<HashMap<[usize; 2], Arc<MixedKernel>>>,
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
            convolution: MixedConvolution::new(kernel, shape),
            family: Arc::clone(self),
        }
    }

    fn kernel(&self, padded: [usize; 2]) -> Arc<MixedKernel> {
        let mut kernels = self.kernels.lock().expect("no holder panics");
        let kernel = kernels.entry(padded).or_insert_with(|| {
            let table = influence_table(padded.map(|n| n / 2 + 1), self.pitch, self.modulus);
            MixedKernel::new(Kernel::from_values(padded, &table))
        });
        Arc::clone(kernel)
    }
}

/// A half-space pair loaded on a finite grid: the discrete convolution with Love's coefficients, exact to round-off.
pub struct FreeFft {
    grid: Grid,
    convolution: MixedConvolution,
    family: Arc<FreeFamily>,
}

impl FreeFft {
    /// The operator on `grid` for the composite `modulus`.
    pub fn new(grid: Grid, modulus: Pascal) -> Self {
        FreeFamily::new(grid.pitch, modulus).operator(grid.shape)
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
        self.convolution.apply(pressure, displacement);
    }

    fn apply_single(&mut self, pressure: &SingleField, displacement: &mut SingleField) {
        self.convolution.apply_single(pressure, displacement);
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
        assert!(Arc::ptr_eq(a.convolution.kernel(), b.convolution.kernel()));
    }
}

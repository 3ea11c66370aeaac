//! Preconditioner of the cells in contact of bodies that attract each other.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::grid::{Field, SingleField, flat_mut};
use crate::math::{Convolution, Kernel, fft::angular_frequency, parallel};
use crate::operator::Operator;
use crate::solver::sets::{Set, Sets};

/// Stiffness of the mean, as a fraction of that of the longest wave.
const MEAN_STIFFNESS: f64 = 0.5;

/// The preconditioner z = A B A r on the free cells A, where B is the stiffness of each wave of a periodic
/// grid.
///
/// Near an instability the attraction couples all waves of the open cells to those in contact, and this
/// preconditioner takes a third of the products that the two-level one of a contact without attraction takes.
pub(super) struct WaveStiffness {
    stiffness: Convolution<f32>,
    masked: SingleField,
}

impl WaveStiffness {
    pub(super) fn new(operator: &dyn Operator) -> Self {
        let grid = operator.grid();
        let ([nx, ny], [dx, dy]) = (grid.shape, grid.pitch);
        let longest = grid.extent()[0].max(grid.extent()[1]);
        let mean = MEAN_STIFFNESS / operator.harmonic_displacement(TAU / longest, 0.0);
        let spectrum = Field::from_shape_fn([ny / 2 + 1, nx / 2 + 1], |(l, k)| match (k, l) {
            (0, 0) => mean,
            _ => {
                let (qx, qy) = (angular_frequency(k, nx, dx), angular_frequency(l, ny, dy));
                1.0 / operator.harmonic_displacement(qx, qy)
            }
        });
        let kernel = Kernel::from_spectrum(grid.shape, spectrum);
        Self {
            stiffness: Convolution::new(Arc::new(kernel.to_single()), grid.shape),
            masked: SingleField::zeros(grid.shape),
        }
    }

    /// Computes z = A B A r. The function `r` returns the residual of a free cell. The other cells have
    /// z = 0. Returns the sum of z.
    pub(super) fn apply(&mut self, sets: &Sets, r: impl Fn(usize) -> f32 + Sync, z: &mut SingleField) -> f64 {
        let bands = sets.bands();
        let parts = bands.cut_mut(flat_mut(&mut self.masked)).zip(bands.cut(sets.by_cell())).enumerate();
        parallel::map(parts, |(band, (masked, sets))| {
            let first = bands.first(band);
            let cells = masked.iter_mut().zip(sets).enumerate();
            cells.for_each(|(cell, (m, set))| *m = if *set == Set::Free { r(first + cell) } else { 0.0 });
        });
        self.stiffness.apply(&self.masked, z);
        let parts = bands.cut_mut(flat_mut(z)).zip(bands.cut(sets.by_cell()));
        let sums = parallel::map(parts, |(z, sets)| {
            let mut sum = 0.0;
            for (z, set) in z.iter_mut().zip(sets) {
                *z = if *set == Set::Free { *z } else { 0.0 };
                sum += f64::from(*z);
            }
            sum
        });
        sums.iter().sum()
    }
}

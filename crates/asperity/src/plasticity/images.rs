//! Correction of the residual stress of a free body for its periodic images.
//!
//! A free body is computed with a period of twice its size. Its images contribute 0.3 to 5 per cent of the largest residual
//! stress. This contribution is smooth. It is computed from the strain on coarse cells, as the difference between a period
//! of four times that and that period, and interpolated. The remaining error is at most 1/64 of it. The gather to coarse
//! cells is the transpose of the interpolation, so that the operator stays symmetric.

use ndarray::{ArrayView4, s};

use super::waves::Waves;
use super::{COMPONENTS, Layers, TensorField};
use crate::grid::Grid;
use crate::math::{good_size, parallel};
use crate::units::Pascal;

/// Smallest number of coarse cells along an axis, if it has more cells than that.
const COARSE_CELLS: usize = 8;

/// Number of cells per coarse cell, of coarse cells, and of coarse cells per period, along an axis of this number of
/// `cells`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Coarsening {
    factor: usize,
    cells: usize,
    period: usize,
}

impl Coarsening {
    pub(super) fn of(cells: usize) -> Self {
        let mut factor = 1;
        while cells >= 2 * COARSE_CELLS * factor {
            factor *= 2;
        }
        let coarse = cells.div_ceil(factor);
        Self { factor, cells: coarse, period: good_size(2 * coarse) }
    }

    /// Period in cells, at least twice their number.
    pub(super) fn period(self) -> usize {
        self.factor * self.period
    }
}

/// Removes the images of a free body.
pub(super) struct Images {
    coarsening: [Coarsening; 2],
    /// With the period of the body, and with four times that period.
    near: Waves,
    far: Waves,
    strain: TensorField,
    stress: [TensorField; 2],
}

impl Images {
    pub(super) fn new(grid: &Grid, layers: &Layers, young: Pascal, poisson: f64) -> Self {
        let coarsening = grid.shape.map(Coarsening::of);
        let coarse = Grid {
            shape: coarsening.map(|c| c.cells),
            pitch: [0, 1].map(|axis| grid.pitch[axis] * coarsening[axis].factor as f64),
        };
        let waves =
            |times: usize| Waves::new(&coarse, coarsening.map(|c| times * c.period), layers, young, poisson);
        let zeros = || TensorField::zeros([layers.count(), COMPONENTS, coarse.shape[0], coarse.shape[1]]);
        Self { coarsening, near: waves(1), far: waves(4), strain: zeros(), stress: [zeros(), zeros()] }
    }

    /// Stores a plastic strain.
    pub(super) fn take(&mut self, strain: ArrayView4<f64>) {
        let cells: [usize; 2] = [strain.shape()[2], strain.shape()[3]];
        let [x, y] = self.interpolations(cells);
        let share = 1.0 / self.coarsening.iter().map(|c| c.factor as f64).product::<f64>();
        let coarse = self.near.planes.cells();
        let planes =
            self.strain.as_slice_mut().expect("standard layout").chunks_exact_mut(coarse[0] * coarse[1]);
        let strain = strain.to_slice().expect("standard layout");
        parallel::tasks(planes.zip(strain.chunks_exact(cells[0] * cells[1])), |(to, strain)| {
            to.fill(0.0);
            for (x, row) in x.iter().zip(strain.chunks_exact(cells[1])) {
                for (y, value) in y.iter().zip(row).filter(|(_, value)| **value != 0.0) {
                    for (i, of_x) in x.parts() {
                        for (j, of_y) in y.parts() {
                            to[i * coarse[1] + j] += share * of_x * of_y * value;
                        }
                    }
                }
            }
        });
        for waves in [&mut self.near, &mut self.far] {
            waves.take(self.strain.as_slice().expect("standard layout"));
        }
    }

    /// Removes the images of the stored strain from a `stress`.
    pub(super) fn remove(&mut self, stress: &mut TensorField) {
        for (waves, stress) in [&mut self.near, &mut self.far].into_iter().zip(&mut self.stress) {
            let [nx, ny] = waves.planes.shape();
            let stride = waves.planes.stride();
            // Smoothed over coarse cells.
            let smooth = |k: usize, n: usize| (std::f64::consts::PI * k as f64 / n as f64).cos().powi(2);
            let along_x: Vec<f64> = (0..nx).map(|kx| smooth(kx, nx)).collect();
            waves.back(
                true,
                |_, ky, columns, _| {
                    let along_y = smooth(ky, ny);
                    for column in columns.chunks_exact_mut(stride) {
                        column.iter_mut().zip(&along_x).for_each(|(value, x)| *value *= x * along_y);
                    }
                },
                stress.as_slice_mut().expect("standard layout"),
            );
        }
        let [near, far] = &mut self.stress;
        *far -= &*near;
        let shape = [stress.shape()[2], stress.shape()[3]];
        let [x, y] = self.interpolations(shape);
        let far = &self.stress[1];
        let cells = shape[0] * shape[1];
        let planes = stress.as_slice_mut().expect("standard layout").chunks_exact_mut(cells).enumerate();
        parallel::tasks(planes, |(plane, stress)| {
            let coarse = far.slice(s![plane / COMPONENTS, plane % COMPONENTS, .., ..]);
            for (x, row) in x.iter().zip(stress.chunks_exact_mut(shape[1])) {
                for (y, value) in y.iter().zip(row) {
                    let at = |i: usize| y.parts().map(|(j, of_y)| of_y * coarse[[i, j]]).iter().sum::<f64>();
                    *value += x.parts().map(|(i, of_x)| of_x * at(i)).iter().sum::<f64>();
                }
            }
        });
    }

    fn interpolations(&self, cells: [usize; 2]) -> [Vec<Interpolation>; 2] {
        [0, 1].map(|axis| Interpolation::all(self.coarsening[axis], cells[axis]))
    }
}

/// Interpolation between the centres of two coarse cells, and beyond the outermost ones.
struct Interpolation {
    first: usize,
    second: usize,
    share: f64,
}

impl Interpolation {
    /// The two coarse cells with their weights.
    fn parts(&self) -> [(usize, f64); 2] {
        [(self.first, 1.0 - self.share), (self.second, self.share)]
    }

    fn all(coarsening: Coarsening, cells: usize) -> Vec<Self> {
        let last = coarsening.cells.saturating_sub(2);
        let at = |index: usize| {
            let at = (index as f64 + 0.5) / coarsening.factor as f64 - 0.5;
            let first = (at.max(0.0) as usize).min(last);
            let second = (first + 1).min(coarsening.cells - 1);
            Self { first, second, share: if second > first { at - first as f64 } else { 0.0 } }
        };
        (0..cells).map(at).collect()
    }
}

//! Correction of the residual stress of a free body for its periodic images.
//!
//! A free body is computed with a period of twice its size. Its images contribute 0.3 to 5 per cent of the
//! largest residual stress. This contribution is smooth. It is computed from the strain on coarse cells, as
//! the difference between a period of four times that and that period, and interpolated. The remaining error
//! is at most 1/64 of it. The gather to coarse cells is the transpose of the interpolation, so that the
//! operator stays symmetric.

use std::f64::consts::PI;

use super::waves::Waves;
use super::{COMPONENTS, INDEPENDENT, Layers, TensorField};
use crate::grid::Grid;
use crate::math::{good_size, parallel};
use crate::units::Pascal;

/// Smallest number of coarse cells along an axis, if it has more cells than that.
const COARSE_CELLS: usize = 8;
/// The long period over the period of the body.
const LONG: usize = 4;

/// Number of cells per coarse cell, of coarse cells, and of coarse cells per period, along an axis of this
/// number of `cells`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Coarsening {
    factor: usize,
    cells: usize,
    period: usize,
}

impl Coarsening {
    pub(super) fn new(cells: usize) -> Self {
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

/// Correction of a free body for its images.
pub(super) struct Images {
    coarsening: [Coarsening; 2],
    /// With the long period.
    waves: Waves,
    interpolation: [Vec<Interpolation>; 2],
    strain: TensorField,
    stress: TensorField,
    /// Correction of the stress at the coarse cells along x and the cells along y, `[plane, x, iy]`.
    correction: Vec<f64>,
}

impl Images {
    pub(super) fn new(grid: &Grid, layers: &Layers, young: Pascal, poisson: f64) -> Self {
        let coarsening = grid.shape.map(Coarsening::new);
        let coarse = Grid {
            shape: coarsening.map(|c| c.cells),
            pitch: [0, 1].map(|axis| grid.pitch[axis] * coarsening[axis].factor as f64),
        };
        let waves = Waves::new(&coarse, coarsening.map(|c| LONG * c.period), layers, young, poisson);
        let zeros = || TensorField::zeros([layers.count(), COMPONENTS, coarse.shape[0], coarse.shape[1]]);
        Self {
            coarsening,
            waves,
            interpolation: [0, 1].map(|axis| Interpolation::all(coarsening[axis], grid.shape[axis])),
            strain: zeros(),
            stress: zeros(),
            correction: vec![0.0; COMPONENTS * layers.count() * coarse.shape[0] * grid.shape[1]],
        }
    }

    /// Stores a plastic strain, `[layer, component, ix, iy]`.
    pub(super) fn take(&mut self, strain: &[f64]) {
        let [x, y] = &self.interpolation;
        let share = 1.0 / self.coarsening.iter().map(|c| c.factor as f64).product::<f64>();
        let [coarse_x, coarse_y] = self.waves.planes.cells();
        let planes =
            self.strain.as_slice_mut().expect("standard layout").chunks_exact_mut(coarse_x * coarse_y);
        parallel::tasks(
            planes.zip(strain.chunks_exact(x.len() * y.len())).enumerate(),
            |(n, (to, strain))| {
                if !INDEPENDENT.contains(&(n % COMPONENTS)) {
                    return;
                }
                let mut along_x = vec![0.0; coarse_x * y.len()];
                for (x, row) in x.iter().zip(strain.chunks_exact(y.len())) {
                    for (i, weight) in x.parts() {
                        let to = &mut along_x[i * y.len()..][..y.len()];
                        to.iter_mut().zip(row).for_each(|(to, value)| *to += share * weight * value);
                    }
                }
                to.fill(0.0);
                for (to, row) in to.chunks_exact_mut(coarse_y).zip(along_x.chunks_exact(y.len())) {
                    for (y, value) in y.iter().zip(row) {
                        y.parts().into_iter().for_each(|(j, weight)| to[j] += weight * value);
                    }
                }
            },
        );
        self.waves.take(self.strain.as_slice().expect("standard layout"));
    }

    /// Computes the correction of the stress for the stored strain.
    pub(super) fn compute(&mut self) {
        let [nx, ny] = self.waves.planes.shape();
        // Smoothed over coarse cells.
        let smooth = |k: usize, n: usize| (PI * k as f64 / n as f64).cos().powi(2);
        let along_x: Vec<f64> = (0..nx).map(|kx| smooth(kx, nx)).collect();
        let change = |[_, ky]: [usize; 2], column: &mut [_]| {
            let along_y = smooth(ky, ny);
            for (kx, (value, x)) in column.iter_mut().zip(&along_x).enumerate() {
                // The waves of the short period are one in LONG² of the long one, with as many times the
                // amplitude.
                let both = kx % LONG == 0 && ky % LONG == 0;
                let difference = if both { 1.0 - (LONG * LONG) as f64 } else { 1.0 };
                *value *= x * (along_y * difference);
            }
        };
        let stress = self.stress.as_slice_mut().expect("standard layout");
        self.waves.stress(true, change, |_, _| (), stress);
        let [_, y] = &self.interpolation;
        let coarse_y = self.waves.planes.cells()[1];
        for (to, row) in self.correction.chunks_exact_mut(y.len()).zip(stress.chunks_exact(coarse_y)) {
            for (to, y) in to.iter_mut().zip(y) {
                *to = y.between(row[y.first], row[y.second]);
            }
        }
    }

    /// Adds the computed correction to a row of the stress, given by its plane and its ix.
    pub(super) fn add(&self, [plane, ix]: [usize; 2], row: &mut [f64]) {
        let x = &self.interpolation[0][ix];
        let coarse_x = self.waves.planes.cells()[0];
        let at = |index: usize| &self.correction[(plane * coarse_x + index) * row.len()..][..row.len()];
        let (first, second) = (at(x.first), at(x.second));
        for ((value, first), second) in row.iter_mut().zip(first).zip(second) {
            *value += x.between(*first, *second);
        }
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

    /// Returns the value between those of the two coarse cells.
    #[inline]
    fn between(&self, first: f64, second: f64) -> f64 {
        (1.0 - self.share) * first + self.share * second
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

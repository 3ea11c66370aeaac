//! Boundaries with at least one free axis, by zero-padded transforms that skip zero rows.

use std::sync::Arc;

use crate::grid::{Field, Grid, SingleField};
use crate::kernel::{Influence, SharedResponse};
use crate::math::{MixedConvolution, MixedKernel, kernel_of_values};
use crate::operator::shared::Shared;
use crate::operator::{Boundary, Definition, Operator};
use crate::units::Metre;

/// All operators of one pitch, response and boundary with a free axis. They share the spectra of the
/// influence coefficients.
///
/// A spectrum belongs to a padded size, and serves every grid that fits into it. The growing overlaps of a
/// pass need only a few.
pub struct FreeFamily {
    pitch: [Metre; 2],
    response: SharedResponse,
    boundary: Boundary,
    datum: Metre,
    /// The influence of a single cell, or of lines of cells by the bits of their periods.
    influence: Shared<Option<u64>, dyn Influence>,
    /// Kernels by the size of their transforms.
    kernels: Shared<[usize; 2], MixedKernel>,
    /// Families by the bits of their coarse pitch, which depends on the number of cells along a periodic
    /// axis.
    coarse: Shared<[u64; 2], FreeFamily>,
}

impl FreeFamily {
    /// Creates the family for the cells of a `largest` grid, bodies with this `response` and this boundary.
    /// If one axis is periodic, r₀ is the length of the grid along the other.
    ///
    /// # Panics
    /// If the boundary is periodic along both axes. An operator panics if one axis is periodic and the
    /// response has no line.
    pub fn new(largest: &Grid, response: impl Into<SharedResponse>, boundary: Boundary) -> Arc<Self> {
        assert!(boundary != Boundary::PERIODIC, "a free axis");
        Self::with_datum(largest.pitch, response.into(), boundary, boundary.datum(largest))
    }

    /// Creates the operator whose displacements along a periodic axis are relative to those at `datum`.
    pub fn with_datum(
        pitch: [Metre; 2],
        response: SharedResponse,
        boundary: Boundary,
        datum: Metre,
    ) -> Arc<Self> {
        Arc::new(Self {
            pitch,
            response,
            boundary,
            datum,
            influence: Shared::default(),
            kernels: Shared::default(),
            coarse: Shared::default(),
        })
    }

    /// Returns the operator on a grid of `shape` cells.
    pub fn operator(self: &Arc<Self>, shape: [usize; 2]) -> FreeFft {
        let grid = Grid { shape, pitch: self.pitch };
        let influence = self.influence(&grid);
        let kernel = self.kernel(self.boundary.padded(shape), influence.as_ref());
        FreeFft {
            grid,
            influence,
            convolution: MixedConvolution::new(kernel, shape),
            family: Arc::clone(self),
        }
    }

    fn influence(&self, grid: &Grid) -> Arc<dyn Influence> {
        let line = self.boundary.line(grid, self.datum);
        self.influence.get(line.map(|line| line.period.to_bits()), || match line {
            None => self.response.influence(self.pitch).into(),
            Some(line) => {
                self.response.line_influence(&line, self.pitch).expect("a response that knows lines").into()
            }
        })
    }

    fn kernel(&self, padded: [usize; 2], influence: &dyn Influence) -> Arc<MixedKernel> {
        self.kernels.get(padded, || {
            let shape = padded.map(|n| n / 2 + 1);
            MixedKernel::new(kernel_of_values(padded, &influence.table(shape, self.pitch)))
        })
    }
}

/// A pair loaded on a finite grid, or on a grid that is periodic along one axis. It is the discrete
/// convolution with the influence of a cell, or of a [`crate::kernel::Line`] of cells, exact to round-off.
pub struct FreeFft {
    grid: Grid,
    influence: Arc<dyn Influence>,
    convolution: MixedConvolution,
    family: Arc<FreeFamily>,
}

impl FreeFft {
    /// Creates the operator on `grid` with free edges for bodies with this `response`, such as the composite
    /// modulus E* of two half-spaces.
    pub fn new(grid: Grid, response: impl Into<SharedResponse>) -> Self {
        FreeFamily::new(&grid, response, Boundary::FREE).operator(grid.shape)
    }
}

impl Operator for FreeFft {
    fn grid(&self) -> &Grid {
        &self.grid
    }

    fn boundary(&self) -> Boundary {
        self.family.boundary
    }

    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64 {
        self.family.response.harmonic_displacement(qx, qy)
    }

    fn influence(&self, i: usize, j: usize) -> f64 {
        let [dx, dy] = self.grid.pitch;
        self.influence.displacement(i as f64 * dx, j as f64 * dy)
    }

    fn apply(&mut self, pressure: &Field, displacement: &mut Field) {
        self.convolution.apply(pressure, displacement);
    }

    fn apply_single(&mut self, pressure: &SingleField, displacement: &mut SingleField) {
        self.convolution.apply_single(pressure, displacement);
    }

    fn has_near_copy(&self) -> bool {
        self.convolution.near_copy().is_some()
    }

    fn apply_near(&mut self, pressure: &SingleField, displacement: &mut SingleField) {
        self.convolution.apply_near(pressure, displacement);
    }

    fn release(&mut self) {
        self.convolution.release();
    }

    fn definition(&self) -> Option<Definition> {
        let FreeFamily { ref response, boundary, datum, .. } = *self.family;
        Some(Definition { grid: self.grid, boundary, response: response.clone(), datum })
    }

    fn coarse(&self) -> Box<dyn Operator> {
        let FreeFamily { ref response, boundary, datum, ref coarse, .. } = *self.family;
        let grid = boundary.coarse(&self.grid);
        let family = coarse.get(grid.pitch.map(f64::to_bits), || {
            FreeFamily::with_datum(grid.pitch, response.clone(), boundary, datum)
        });
        Box::new(family.operator(grid.shape))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Cholesky;
    use crate::operator::{DirectSum, Edge};

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
        let family = FreeFamily::new(&Grid::new([32, 32], [1.0; 2]).unwrap(), 1.0, Boundary::FREE);
        let (a, b) = (family.operator([31, 32]), family.operator([32, 32]));
        assert!(Arc::ptr_eq(&a.convolution.kernel, &b.convolution.kernel));
    }

    #[test]
    fn along_a_line_it_is_the_direct_sum_of_the_lines_coefficients() {
        for axis in [0, 1] {
            for (shape, pitch) in
                [([12, 9], [1.0, 1.0]), ([1, 8], [1.0, 0.5]), ([9, 1], [1.0, 2.0]), ([20, 7], [0.3, 1.0])]
            {
                let turned = |of: [f64; 2]| if axis == 1 { of } else { [of[1], of[0]] };
                let shape = if axis == 1 { shape } else { [shape[1], shape[0]] };
                let grid = Grid::new(shape, turned(pitch)).unwrap();
                let mut edges = [Edge::Free; 2];
                edges[axis] = Edge::Periodic;
                let mut operator = FreeFamily::new(&grid, 115e9, Boundary(edges)).operator(shape);
                let pressure = Field::from_shape_fn(shape, |(i, j)| ((7 * i + 3 * j * j) % 11) as f64);
                let (mut fast, mut single) = (grid.zeros(), SingleField::zeros(shape));
                operator.apply(&pressure, &mut fast);
                operator.apply_single(&pressure.mapv(|p| p as f32), &mut single);
                let slow = Field::from_shape_fn(shape, |(i, j)| {
                    let from = pressure.indexed_iter();
                    from.map(|((k, l), p)| p * operator.influence(i.abs_diff(k), j.abs_diff(l))).sum()
                });
                let largest = slow.iter().fold(0.0f64, |m, u| m.max(u.abs()));
                for ((fast, single), slow) in fast.iter().zip(&single).zip(&slow) {
                    assert!((fast - slow).abs() <= 1e-14 * largest, "{axis}, {shape:?}: {fast:e}, {slow:e}");
                    assert!((f64::from(*single) - slow).abs() <= 1e-6 * largest, "{axis}, {shape:?}");
                }
            }
        }
    }

    #[test]
    fn along_a_line_it_is_positive_definite_on_every_grid() {
        for (shape, pitch) in
            [([12, 9], [1.0, 1.0]), ([40, 1], [1.0, 1.0]), ([6, 8], [4.0, 0.5]), ([5, 6], [0.2, 1.0])]
        {
            let grid = Grid::new(shape, pitch).unwrap();
            let boundary = Boundary([Edge::Free, Edge::Periodic]);
            let operator = FreeFamily::new(&grid, 1.0, boundary).operator(shape);
            let place = |cell: usize| [cell / shape[1], cell % shape[1]];
            let least = 0.02 * operator.influence(0, 0);
            let shifted = Field::from_shape_fn([grid.cells(); 2], |(m, n)| {
                let ([i, j], [k, l]) = (place(m), place(n));
                operator.influence(i.abs_diff(k), j.abs_diff(l)) - if m == n { least } else { 0.0 }
            });
            assert!(Cholesky::new(shifted).is_some(), "{shape:?}: an eigenvalue is not above {least:e}");
        }
    }
}

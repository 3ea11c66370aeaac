//! The periodic boundary.

use std::sync::Arc;

use crate::grid::{Field, Grid, SingleField};
use crate::kernel::SharedResponse;
use crate::math::{Kernel, MixedConvolution, MixedKernel, fft::angular_frequency, parallel};
use crate::operator::shared::Shared;
use crate::operator::{Boundary, Definition, Operator};

/// Data shared by all operators of one periodic grid: the spectrum of the influence coefficients.
pub struct PeriodicKernel {
    grid: Grid,
    response: SharedResponse,
    kernel: Arc<MixedKernel>,
    /// Displacement per unit pressure on the cell at `[0, 0]`, up to half the period.
    influence: Field,
    coarse: Shared<(), PeriodicKernel>,
}

impl PeriodicKernel {
    /// Computes the coefficients of `grid` for bodies with this `response`.
    pub fn new(grid: Grid, response: impl Into<SharedResponse>) -> Arc<Self> {
        let response = response.into();
        let [nx, ny] = grid.shape;
        let spectrum = parallel::field([ny / 2 + 1, nx / 2 + 1], |l, k| {
            let qx = angular_frequency(k, nx, grid.pitch[0]);
            let qy = angular_frequency(l, ny, grid.pitch[1]);
            response.harmonic_displacement(qx, qy)
        });
        let kernel = MixedKernel::new(Kernel::from_spectrum(grid.shape, spectrum));
        let (mut unit, mut displacement) = (grid.zeros(), grid.zeros());
        unit[[0, 0]] = 1.0;
        MixedConvolution::new(Arc::clone(&kernel), grid.shape).apply(&unit, &mut displacement);
        let influence = displacement.slice(ndarray::s![..nx / 2 + 1, ..ny / 2 + 1]).to_owned();
        Arc::new(Self { grid, response, kernel, influence, coarse: Shared::default() })
    }

    /// Creates an operator with these coefficients.
    pub fn operator(self: &Arc<Self>) -> PeriodicFft {
        let convolution = MixedConvolution::new(Arc::clone(&self.kernel), self.grid.shape);
        PeriodicFft { shared: Arc::clone(self), convolution }
    }
}

/// A pair that is periodic along both axes; for half-spaces û(q) = 2 p̂(q)/(E*|q|).
///
/// The mean displacement is free and set to zero. Under load it is part of the approach.
pub struct PeriodicFft {
    shared: Arc<PeriodicKernel>,
    convolution: MixedConvolution,
}

impl PeriodicFft {
    /// Creates the operator on `grid` for bodies with this `response`, such as the composite modulus E* of
    /// two half-spaces.
    pub fn new(grid: Grid, response: impl Into<SharedResponse>) -> Self {
        PeriodicKernel::new(grid, response).operator()
    }
}

impl Operator for PeriodicFft {
    fn grid(&self) -> &Grid {
        &self.shared.grid
    }

    fn boundary(&self) -> Boundary {
        Boundary::PERIODIC
    }

    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64 {
        self.shared.response.harmonic_displacement(qx, qy)
    }

    fn influence(&self, i: usize, j: usize) -> f64 {
        let [nx, ny] = self.shared.grid.shape;
        self.shared.influence[[i.min(nx - i), j.min(ny - j)]]
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
        let PeriodicKernel { grid, response, .. } = self.shared.as_ref();
        let response = response.clone();
        Some(Definition { grid: *grid, boundary: Boundary::PERIODIC, response, datum: 0.0 })
    }

    fn coarse(&self) -> Box<dyn Operator> {
        let PeriodicKernel { grid, response, coarse, .. } = self.shared.as_ref();
        let coarse =
            coarse.get((), || PeriodicKernel::new(Boundary::PERIODIC.coarse(grid), response.clone()));
        Box::new(coarse.operator())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::TAU;

    #[test]
    fn a_sinusoidal_pressure_bends_the_surface_into_the_same_sinusoid() {
        let grid = Grid::new([12, 10], [0.5, 0.25]).unwrap();
        let mut operator = PeriodicFft::new(grid, 3.0);
        let [lx, ly] = grid.extent();
        let wave = Field::from_shape_fn(grid.shape, |(i, j)| {
            (TAU * (2.0 * grid.centre(0, i) / lx + grid.centre(1, j) / ly)).cos()
        });
        let mut displacement = grid.zeros();
        operator.apply(&(&wave + 5.0), &mut displacement);
        let q = (2.0 * TAU / lx).hypot(TAU / ly);
        for (u, w) in displacement.iter().zip(&wave) {
            assert_relative_eq!(*u, 2.0 * w / (3.0 * q), epsilon = 1e-14);
        }
    }

    #[test]
    fn influence_is_the_displacement_under_one_cell() {
        let grid = Grid::new([7, 6], [1.0, 1.0]).unwrap();
        let mut operator = PeriodicFft::new(grid, 1.0);
        let (mut pressure, mut displacement) = (grid.zeros(), grid.zeros());
        pressure[[0, 0]] = 1.0;
        operator.apply(&pressure, &mut displacement);
        for ((i, j), u) in displacement.indexed_iter() {
            assert_relative_eq!(*u, operator.influence(i, j), epsilon = 1e-14);
        }
    }
}

//! Flash temperature of a stationary contact with bodies moving through it.

use std::sync::Arc;

use asperity_transforms::num_complex::Complex64;

use crate::error::{Error, Result, check_in};
use crate::grid::{Field, Grid};
use crate::math::fft::angular_frequency;
use crate::math::{SkewConvolution, SkewKernel, parallel};
use crate::operator::Boundary;
use crate::temperature::flash::check_bulk;
use crate::temperature::partition::{Preconditioner, biconjugate_gradients};
use crate::temperature::source::Cell;
use crate::temperature::{FlashStep, Thermal};
use crate::units::{Dimension, Kelvin, MetrePerSecond, WattPerSquareMetre};

/// Steady temperature of the cells in contact.
///
/// A free boundary uses the coefficients of [`crate::temperature::moving_source_temperature`], a periodic one
/// those of waves, `1/(λ √(q² + iVq_x/D))`. The uniform part of a periodic contact has no steady temperature:
/// it grows without bound as 2q̄√(t/π)/β. It is omitted (0 at q = 0), so that temperatures are relative to
/// the mean of the surface, which is set to the bulk temperature.
pub struct SteadyTemperature {
    bulk: [Kelvin; 2],
    grid: Grid,
    boundary: Boundary,
    bodies: [SkewConvolution; 2],
    sum: SkewConvolution,
    /// Temperature of a cell under a unit flux into it, K m²/W.
    own: [f64; 2],
    preconditioner: Preconditioner,
    input: Field,
    output: Field,
}

impl SteadyTemperature {
    /// Creates the contact on `grid` of bodies that pass it at these `speeds` along x, positive or negative,
    /// lower one first.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if only one axis is periodic, [`Error::OutOfRange`] for an invalid speed or
    /// bulk temperature.
    pub fn new(
        grid: Grid,
        thermal: [Thermal; 2],
        boundary: Boundary,
        speeds: [MetrePerSecond; 2],
        bulk: [Kelvin; 2],
    ) -> Result<Self> {
        if boundary != Boundary::FREE && boundary != Boundary::PERIODIC {
            return Err(Error::Unsupported(
                "a steady temperature needs a boundary that is free or periodic along both axes",
            ));
        }
        let range = Dimension::Speed.range();
        for speed in speeds {
            check_in(Dimension::Speed, "speed", speed, range.holds_signed(speed), "a speed up to 1e9 m/s")?;
        }
        check_bulk(bulk)?;
        let coefficients = |thermal: &Thermal, speed| Coefficients::new(&grid, thermal, boundary, speed);
        let [one, other] = [0, 1].map(|body| coefficients(&thermal[body], speeds[body]));
        let mut sum = one.plus(&other).convolution(grid.shape);
        let mut bodies = [one, other].map(|body| body.convolution(grid.shape));
        // Part of the coefficients that is even in x; periodic ones are relative to the far field.
        let [nx, ny] = grid.shape;
        let [ahead, behind] = [[0, 0], [nx - 1, 0]].map(|cell| under_one_cell(&mut sum, &grid, cell));
        let far = if boundary == Boundary::PERIODIC { ahead[[nx / 2, ny / 2]] } else { 0.0 };
        let even = |i: usize, j: usize| 0.5 * (ahead[[i, j]] + behind[[nx - 1 - i, j]]) - far;
        Ok(Self {
            bulk,
            boundary,
            own: bodies.each_mut().map(|body| under_one_cell(body, &grid, [0, 0])[[0, 0]]),
            preconditioner: Preconditioner::new(grid.shape, even),
            bodies,
            sum,
            input: grid.zeros(),
            output: grid.zeros(),
            grid,
        })
    }

    /// Computes the temperature of these flat `cells`, which friction heats by a `flux` each.
    ///
    /// # Errors
    /// [`Error::NotConverged`]; [`Error::Unsupported`] if all cells of a periodic contact touch, because the
    /// partition of its mean flux is undetermined.
    ///
    /// # Panics
    /// If the numbers of cells and fluxes differ.
    pub fn solve(&mut self, cells: &[u32], flux: &[WattPerSquareMetre]) -> Result<FlashStep> {
        assert_eq!(cells.len(), flux.len(), "as many cells as fluxes");
        if self.boundary == Boundary::PERIODIC && cells.len() == self.grid.cells() {
            return Err(Error::Unsupported(
                "a periodic contact that touches everywhere has no steady heat partition",
            ));
        }
        let Self { bulk, bodies, sum, own, preconditioner, input, output, grid, .. } = self;
        let mut spread = |by: &mut SkewConvolution, x: &[f64], image: &mut [f64]| {
            let all = input.as_slice_mut().expect("standard layout");
            cells.iter().zip(x).for_each(|(cell, x)| all[*cell as usize] = *x);
            by.apply(input, output);
            let all = input.as_slice_mut().expect("standard layout");
            cells.iter().for_each(|cell| all[*cell as usize] = 0.0);
            let all = output.as_slice().expect("standard layout");
            cells.iter().zip(image).for_each(|(cell, image)| *image = all[*cell as usize]);
        };
        let mut right = vec![0.0; flux.len()];
        spread(&mut bodies[1], flux, &mut right);
        right.iter_mut().for_each(|t| *t += bulk[1] - bulk[0]);
        let share = own[1] / (own[0] + own[1]);
        let mut into_lower: Vec<f64> = flux.iter().map(|q| share * q).collect();
        let mut multiply = |x: &[f64], image: &mut [f64]| spread(sum, x, image);
        let iterations =
            biconjugate_gradients(&mut multiply, preconditioner, cells, &right, &mut into_lower)?;
        let into_upper = flux.iter().zip(&into_lower).map(|(q, lower)| q - lower);
        let heat = [into_lower.iter().sum::<f64>(), into_upper.sum()].map(|flux| grid.cell_area() * flux);
        let mut temperature = vec![0.0; flux.len()];
        spread(&mut bodies[0], &into_lower, &mut temperature);
        temperature.iter_mut().for_each(|t| *t += bulk[0]);
        Ok(FlashStep { temperature, heat, iterations })
    }
}

/// Returns the temperature under a unit flux into one cell.
fn under_one_cell(convolution: &mut SkewConvolution, grid: &Grid, cell: [usize; 2]) -> Field {
    let (mut unit, mut temperature) = (grid.zeros(), grid.zeros());
    unit[cell] = 1.0;
    convolution.apply(&unit, &mut temperature);
    temperature
}

/// Temperature of a body per flux on a cyclic grid, K m²/W.
enum Coefficients {
    /// At all cyclic offsets.
    Cells(Field),
    /// At the bins `[kx, ky]`, `ky ≤ My/2`.
    Waves(ndarray::Array2<Complex64>),
}

impl Coefficients {
    fn new(grid: &Grid, thermal: &Thermal, boundary: Boundary, speed: MetrePerSecond) -> Self {
        if boundary == Boundary::PERIODIC {
            let ratio = speed / thermal.diffusivity();
            return Self::Waves(ndarray::Array2::from_shape_fn(
                [grid.shape[0], grid.shape[1] / 2 + 1],
                |(kx, ky)| {
                    let [qx, qy] = [(kx, 0), (ky, 1)]
                        .map(|(bin, axis)| angular_frequency(bin, grid.shape[axis], grid.pitch[axis]));
                    let root = Complex64::new(qx * qx + qy * qy, ratio * qx).sqrt();
                    if kx == 0 && ky == 0 { 0.0.into() } else { (thermal.conductivity * root).inv() }
                },
            ));
        }
        let padded = boundary.padded(grid.shape);
        let cell = Cell::new(grid.pitch);
        let mut table = Field::zeros(padded);
        let values = table.as_slice_mut().expect("standard layout");
        parallel::tasks(values.chunks_exact_mut(padded[1]).enumerate(), |(i, row)| {
            let x = (if 2 * i > padded[0] { i as f64 - padded[0] as f64 } else { i as f64 }) * grid.pitch[0];
            for j in 0..=padded[1] / 2 {
                row[j] = cell.moving([x, j as f64 * grid.pitch[1]], thermal, speed);
                row[(padded[1] - j) % padded[1]] = row[j];
            }
        });
        Self::Cells(table)
    }

    fn plus(&self, other: &Self) -> Self {
        match (self, other) {
            (Self::Cells(one), Self::Cells(other)) => Self::Cells(one + other),
            (Self::Waves(one), Self::Waves(other)) => Self::Waves(one + other),
            _ => unreachable!("one boundary"),
        }
    }

    fn convolution(&self, shape: [usize; 2]) -> SkewConvolution {
        let kernel = match self {
            Self::Cells(table) => SkewKernel::from_values(table),
            Self::Waves(table) => SkewKernel::from_transform(shape, |kx, ky| table[[kx, ky]]),
        };
        SkewConvolution::new(Arc::new(kernel), shape)
    }
}

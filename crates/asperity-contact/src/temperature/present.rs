//! Temperature from the heat of the present step.

use std::f64::consts::PI;
use std::sync::Arc;

use ndarray::s;

use crate::grid::{Field, Grid};
use crate::math::fft::angular_frequency;
use crate::math::{Convolution, Kernel, good_size, kernel_of_values, parallel};
use crate::operator::Boundary;
use crate::temperature::Thermal;
use crate::temperature::source::Cell;
use crate::units::Second;

/// Coefficients between cells, applied by transforms, or by direct summation for few cells.
pub(super) struct Spread {
    /// Coefficients at the offsets `[i, j]`, even in both.
    pub(super) table: Field,
    /// Number of cells of the transforms.
    transformed: usize,
    convolution: Convolution<f64>,
    input: Field,
    output: Field,
}

impl Spread {
    /// Creates the coefficients of a `kernel`, of shape `padded`, between the cells of a grid of `shape`.
    pub(super) fn new(kernel: Kernel<f64>, padded: [usize; 2], shape: [usize; 2]) -> Self {
        let mut convolution = Convolution::new(Arc::new(kernel), shape);
        let (mut input, mut table) = (Field::zeros(shape), Field::zeros(shape));
        input[[0, 0]] = 1.0;
        convolution.apply(&input, &mut table);
        input[[0, 0]] = 0.0;
        let (transformed, output) = (padded[0] * padded[1], Field::zeros(shape));
        Self { table, transformed, convolution, input, output }
    }

    /// Adds to `sums` at the flat cells `to` the effect of the `values` at the flat cells `from`.
    pub(super) fn add(&mut self, from: &[u32], values: &[f64], to: &[u32], sums: &mut [f64]) {
        if self.is_direct(from.len() * to.len()) {
            let [from, to] = [from, to].map(|cells| self.places(cells));
            let between = self.between();
            for (to, sum) in to.iter().zip(sums) {
                *sum += from.iter().zip(values).map(|(from, value)| between(*from, *to) * value).sum::<f64>();
            }
            return;
        }
        let input = self.input.as_slice_mut().expect("standard layout");
        from.iter().zip(values).for_each(|(cell, value)| input[*cell as usize] = *value);
        self.convolution.apply(&self.input, &mut self.output);
        let input = self.input.as_slice_mut().expect("standard layout");
        from.iter().for_each(|cell| input[*cell as usize] = 0.0);
        let output = self.output.as_slice().expect("standard layout");
        to.iter().zip(sums).for_each(|(cell, sum)| *sum += output[*cell as usize]);
    }

    /// Returns the matrix of the coefficients between the flat `cells`, row by row, if it is cheaper than
    /// transforms.
    pub(super) fn matrix(&self, cells: &[u32]) -> Option<Vec<f64>> {
        self.is_direct(cells.len().pow(2)).then(|| {
            let places = self.places(cells);
            let between = self.between();
            let mut matrix = vec![0.0; cells.len().pow(2)];
            for (to, row) in places.iter().zip(matrix.chunks_exact_mut(cells.len().max(1))) {
                row.iter_mut().zip(&places).for_each(|(value, from)| *value = between(*from, *to));
            }
            matrix
        })
    }

    /// Whether this number of products takes less time than a convolution.
    fn is_direct(&self, products: usize) -> bool {
        products <= DIRECT * self.transformed
    }

    fn places(&self, cells: &[u32]) -> Vec<[i32; 2]> {
        let width = self.table.ncols() as u32;
        cells.iter().map(|cell| [(cell / width) as i32, (cell % width) as i32]).collect()
    }

    /// Returns the coefficient between two places, as a function.
    fn between(&self) -> impl Fn([i32; 2], [i32; 2]) -> f64 {
        let (width, table) = (self.table.ncols(), self.table.as_slice().expect("standard layout"));
        move |from, to| table[from[0].abs_diff(to[0]) as usize * width + from[1].abs_diff(to[1]) as usize]
    }
}

/// Number of products that take as long as a convolution, per cell of its transforms.
const DIRECT: usize = 12;

/// Coefficients of the temperature of a body at rest at the end of a step, K m²/W, on cells of the `grid`.
/// The first are for a flux that grows from 0 during the step, the second for one that decreases to 0.
///
/// Without a periodic axis they are those of [`Cell::ramps`]; otherwise those of waves, with x = √(Dq²t),
///
/// ```text
/// Σ of both: erf(x)/λq          falling: √t/β [erf(x)/2x³ − e^(−x²)/√π x²]
/// ```
///
/// on a cyclic grid of `padded` shape.
pub(super) fn ramps(
    grid: &Grid,
    thermal: &Thermal,
    boundary: Boundary,
    step: Second,
    padded: [usize; 2],
) -> [Ramp; 2] {
    if boundary == Boundary::FREE {
        let half = padded.map(|n| n / 2 + 1);
        let cell = Cell::new(grid.pitch);
        let mut tables = [Field::zeros(half), Field::zeros(half)];
        let [rising, falling] = tables.each_mut().map(|t| t.as_slice_mut().expect("standard layout"));
        let rows = rising.chunks_mut(half[1]).zip(falling.chunks_mut(half[1])).enumerate();
        parallel::tasks(rows, |(i, (rising, falling))| {
            for (j, (rising, falling)) in rising.iter_mut().zip(falling).enumerate() {
                let at = [i as f64 * grid.pitch[0], j as f64 * grid.pitch[1]];
                [*rising, *falling] = cell.ramps(at, thermal, step);
            }
        });
        return tables.map(|table| Ramp { padded, values: Values::Cells(table) });
    }
    let length = (thermal.diffusivity() * step).sqrt();
    let unit = step.sqrt() / thermal.effusivity();
    let waves = |of: fn(f64) -> f64| {
        let x = |bin: usize, axis: usize| length * angular_frequency(bin, padded[axis], grid.pitch[axis]);
        let half = padded.map(|n| n / 2 + 1);
        Field::from_shape_fn(half, |(kx, ky)| unit * of(x(kx, 0).hypot(x(ky, 1))))
    };
    [waves(|x| both(x) - falling(x)), waves(falling)]
        .map(|table| Ramp { padded, values: Values::Waves(table) })
}

/// Returns the cyclic grid for bodies on `grid` with at most this `diffusivity`. It is so large that the
/// wrap-around along a free edge within a step vanishes or, with waves, is erfc(3) = 2e-5 of the heat.
pub(super) fn padded(grid: &Grid, diffusivity: f64, boundary: Boundary, step: Second) -> [usize; 2] {
    let length = 2.0 * (diffusivity * step).sqrt();
    [0, 1].map(|axis| {
        let n = grid.shape[axis];
        let reach = |lengths: f64| (lengths * length / grid.pitch[axis]).min(MOST).ceil() as usize;
        match boundary {
            Boundary::FREE => good_size((2 * n - 1).min(n + 1 + reach(6.0))),
            _ if boundary.repeats(axis) => n,
            _ => good_size(n + reach(3.0)),
        }
    })
}

/// Coefficients on a cyclic grid.
pub(super) struct Ramp {
    padded: [usize; 2],
    values: Values,
}

enum Values {
    /// At the offsets `[i, j]`.
    Cells(Field),
    /// At the bins `[kx, ky]`.
    Waves(Field),
}

impl Ramp {
    /// Adds the coefficients of two bodies on the same cyclic grid.
    pub(super) fn sum([one, other]: [&Self; 2]) -> Self {
        let values = match (&one.values, &other.values) {
            (Values::Cells(one), Values::Cells(other)) => Values::Cells(one + other),
            (Values::Waves(one), Values::Waves(other)) => Values::Waves(one + other),
            _ => unreachable!("one boundary"),
        };
        Self { padded: one.padded, values }
    }

    /// Creates the operator with these coefficients between cells of a grid of `shape`.
    pub(super) fn spread(&self, shape: [usize; 2]) -> Spread {
        let kernel = match &self.values {
            Values::Cells(table) => kernel_of_values(self.padded, table),
            Values::Waves(table) => {
                let [mx, my] = self.padded.map(|n| n / 2 + 1);
                Kernel::from_spectrum(
                    self.padded,
                    table.t().slice(s![..my, ..mx]).as_standard_layout().into_owned(),
                )
            }
        };
        Spread::new(kernel, self.padded, shape)
    }
}

/// Largest padding of an edge, in cells.
const MOST: f64 = 1e5;

/// erf(x)/x.
fn both(x: f64) -> f64 {
    if x == 0.0 { 2.0 / PI.sqrt() } else { libm::erf(x) / x }
}

/// erf(x)/2x³ − e^(−x²)/√π x².
fn falling(x: f64) -> f64 {
    if x < 0.05 {
        let square = x * x;
        return (2.0 / 3.0 - square * (2.0 / 5.0 - square * (1.0 / 7.0 - square / 27.0))) / PI.sqrt();
    }
    (0.5 * libm::erf(x) / x - (-x * x).exp() / PI.sqrt()) / (x * x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_forms_of_the_falling_ramp_agree_where_they_meet() {
        let (below, above) = (falling(0.05 * (1.0 - 1e-13)), falling(0.05));
        assert!((below / above - 1.0).abs() < 1e-11, "{below} {above}");
    }

    #[test]
    fn few_and_many_cells_are_spread_alike() {
        let grid = Grid::new([12, 10], [1.0, 0.8]).unwrap();
        let thermal = Thermal::new(1.0, 1.0, 1.0).unwrap();
        for boundary in [Boundary::FREE, Boundary::PERIODIC] {
            let padded = padded(&grid, thermal.diffusivity(), boundary, 2.0);
            let [ramp, _] = ramps(&grid, &thermal, boundary, 2.0, padded);
            let mut spread = ramp.spread(grid.shape);
            let cells: Vec<u32> = (0..120).collect();
            let values: Vec<f64> = cells.iter().map(|c| f64::from(c * 7 % 11)).collect();
            let mut sums = [vec![0.0; 120], vec![0.0; 120]];
            assert!(!spread.is_direct(120 * 120) && spread.is_direct(120 * 10));
            spread.add(&cells, &values, &cells, &mut sums[0]);
            for (cells_from, values) in cells.chunks(10).zip(values.chunks(10)) {
                spread.add(cells_from, values, &cells, &mut sums[1]);
            }
            assert!(sums[0].iter().zip(&sums[1]).all(|(a, b)| (a - b).abs() < 1e-11 * a.abs()));
        }
    }
}

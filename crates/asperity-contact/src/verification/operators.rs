//! Pressure to displacement: exact except for round-off.

use std::f64::consts::{PI, TAU};

use super::{Case, Check, Expected, relative, relative_max, study};
use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::operator::{Boundary, DirectSum, Edge, FreeFamily, FreeFft, Operator, PeriodicFft};
use crate::reference::cell::{corner_displacement, mean_displacement};

const MODULUS: f64 = 115e9;

fn displacement(mut operator: impl Operator, pressure: &Field) -> Field {
    let mut displacement = operator.grid().zeros();
    operator.apply(pressure, &mut displacement);
    displacement
}

/// A rectangle of n × n cells under uniform pressure: superposition gives the displacement of every cell
/// without error. Its mean over the cell centres is the midpoint rule, of order 2 except for the logarithmic
/// slope at the edges: Δx² ln Δx.
pub(super) const LOADED_RECTANGLE: Case = Case {
    name: "Love: uniformly loaded rectangle",
    source: "Love (1929); Johnson (1985), eq. 3.25",
    checks: || {
        let sides = [1.5e-6, 1e-6];
        let pressure = 1e9;
        let midpoint = Expected::Order { order: 1.6..=2.1, finest: 1e-3 };
        let checks = [
            ("cells, direct sum", Expected::RoundOff(1e-13)),
            ("cells, free FFT", Expected::RoundOff(1e-13)),
            ("mean", midpoint),
        ];
        study("cells a side", &[4, 8, 16, 32], checks, |n| {
            let grid = Grid::new([n, n], sides.map(|side| side / n as f64))?;
            // A point divides the rectangle into four that have it as a corner.
            let exact = Field::from_shape_fn(grid.shape, |(i, j)| {
                let [x, y] = [grid.centre(0, i), grid.centre(1, j)];
                let quarter = |u, v| corner_displacement(pressure, [u, v], MODULUS);
                [x, sides[0] - x].iter().map(|&u| quarter(u, y) + quarter(u, sides[1] - y)).sum()
            });
            let loaded = grid.zeros() + pressure;
            let direct = displacement(DirectSum::new(grid, MODULUS), &loaded);
            let fast = displacement(FreeFft::new(grid, MODULUS), &loaded);
            let mean = direct.sum() / grid.cells() as f64;
            Ok([
                relative_max(&direct, &exact),
                relative_max(&fast, &exact),
                relative(mean, mean_displacement(pressure, sides, MODULUS)),
            ])
        })
    },
};

/// With zero padding the circular convolution becomes the free one, on grids of any shape.
pub(super) const FREE_TRANSFORM: Case = Case {
    name: "free FFT: the direct sum",
    source: "convolution theorem",
    checks: || {
        study("cells a side", &[5, 16, 31, 64], [("displacement", Expected::RoundOff(1e-14))], |n| {
            let grid = Grid::new([n, 2 * n / 3], [1e-6, 0.7e-6])?;
            let patchy = Field::from_shape_fn(grid.shape, |(i, j)| {
                if (i / 2 + j / 3) % 3 == 1 { 0.0 } else { 1e8 * ((7 * i + 3 * j * j) % 11) as f64 }
            });
            let exact = displacement(DirectSum::new(grid, MODULUS), &patchy);
            Ok([relative_max(&displacement(FreeFft::new(grid, MODULUS), &patchy), &exact)])
        })
    },
};

/// Each harmonic is an eigenfunction, u = 2p/(E*|q|), on the grid as on the half-space.
pub(super) const PERIODIC_TRANSFORM: Case = Case {
    name: "periodic FFT: oblique sinusoid",
    source: "Johnson (1985), eq. 13.6",
    checks: oblique_sinusoid,
};

fn oblique_sinusoid() -> Result<Vec<Check>> {
    study("cells a side", &[8, 15, 32, 64], [("displacement", Expected::RoundOff(1e-14))], |n| {
        let grid = Grid::new([n, n + 1], [1e-6, 0.7e-6])?;
        let [lx, ly] = grid.extent();
        let wave = Field::from_shape_fn(grid.shape, |(i, j)| {
            (TAU * (3.0 * grid.centre(0, i) / lx - 2.0 * grid.centre(1, j) / ly)).sin()
        });
        let q = TAU * (3.0 / lx).hypot(2.0 / ly);
        let computed = displacement(PeriodicFft::new(grid, MODULUS), &(1e9 * (1.0 + &wave)));
        Ok([relative_max(&computed, &(2e9 / (MODULUS * q) * wave))])
    })
}

/// An infinite strip under uniform pressure, made of cells repeated along it. Superposition gives the
/// displacement of every cell without error, relative to the distance r₀, the width of the grid.
pub(super) const LOADED_STRIP: Case = Case {
    name: "Flamant: uniformly loaded strip",
    source: "Flamant (1892); Johnson (1985), section 2.4",
    checks: || {
        let checks = ["strip along y", "strip along x"].map(|name| (name, Expected::RoundOff(1e-13)));
        study("cells a side", &[4, 10, 16, 32], checks, |n| {
            let errors = [1, 0].map(|axis| -> Result<f64> {
                let turned =
                    |[across, along]: [f64; 2]| if axis == 1 { [across, along] } else { [along, across] };
                let mut edges = [Edge::Free; 2];
                edges[axis] = Edge::Periodic;
                let shape = if axis == 1 { [4 * n, n] } else { [n, 4 * n] };
                let grid = Grid::new(shape, turned([1e-6, 1.7e-6]))?;
                let (width, half, pressure) = (grid.extent()[1 - axis], n as f64 * 0.5e-6, 1e9);
                let across = |i: usize, j: usize| grid.centre(1 - axis, [i, j][1 - axis]) - 0.5 * width;
                let loaded = |i, j| if across(i, j).abs() < half { pressure } else { 0.0 };
                let family = FreeFamily::new(&grid, MODULUS, Boundary(edges));
                let found =
                    displacement(family.operator(shape), &Field::from_shape_fn(shape, |(i, j)| loaded(i, j)));
                let exact = Field::from_shape_fn(shape, |(i, j)| {
                    let term = |s: f64| if s == 0.0 { 0.0 } else { s * ((s.abs() / width).ln() - 1.0) };
                    let x = across(i, j);
                    -2.0 * pressure / (PI * MODULUS) * (term(x + half) - term(x - half))
                });
                Ok(relative_max(&found, &exact))
            });
            let [along_y, along_x] = errors;
            Ok([along_y?, along_x?])
        })
    },
};

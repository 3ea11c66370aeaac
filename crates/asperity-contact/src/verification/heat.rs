//! Frictional heating.

use std::f64::consts::PI;

use super::{Case, Check, Expected, largest, relative, relative_max, study};
use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::operator::Boundary;
use crate::reference::{HeatedDisc, HertzianFlux, SquareSource};
use crate::temperature::{FlashTemperature, SteadyTemperature, Thermal};
use crate::units::{Kelvin, Metre, WattPerSquareMetre};

const BULK: Kelvin = 373.0;
const FLUX: WattPerSquareMetre = 1e9;

fn steel() -> Thermal {
    Thermal { conductivity: 46.0, heat_capacity: 460.0, density: 7850.0 }
}

/// A body with the fraction 10⁻¹² of the heat and the diffusivity of another, which is then heated alone.
fn insulating(other: &Thermal) -> Thermal {
    Thermal { conductivity: 1e-12 * other.conductivity, density: 1e-12 * other.density, ..*other }
}

/// A square at Péclet numbers from 0 to 100, with n cells per side. Superposition gives the temperature of
/// every cell without error. The largest temperature is that of the hottest cell. At rest it is in the
/// middle, and the error is of order 2. If it lies behind, between the centres of cells, it is missed by up
/// to half a cell.
pub(super) const SQUARE: Case = Case {
    name: "moving square: Pe 0, 1, 5, 10, 100",
    source: "Jaeger (1942); Carslaw and Jaeger (1959), chapter X",
    checks: square,
};

fn square() -> Result<Vec<Check>> {
    let checks = [
        ("cells", Expected::RoundOff(1e-10)),
        ("largest, Pe = 0", Expected::Order { order: 1.9..=2.1, finest: 1e-3 }),
        ("largest, Pe = 1", Expected::Counted(0.08)),
        ("largest, Pe = 5", Expected::Counted(0.08)),
        ("largest, Pe = 10", Expected::Counted(0.08)),
        ("largest, Pe = 100", Expected::Counted(0.25)),
    ];
    study("cells a side", &[8, 16, 32], checks, |n| {
        let (thermal, side) = (steel(), 1e-5);
        let grid = Grid::new([n, n], [side / n as f64; 2])?;
        let cells: Vec<u32> = (0..(n * n) as u32).collect();
        let mut worst = 0.0f64;
        let mut error = |peclet: f64| -> Result<f64> {
            let exact = square_source(peclet, side);
            let bodies = [thermal, insulating(&thermal)];
            let mut steady =
                SteadyTemperature::new(grid, bodies, Boundary::FREE, [exact.speed; 2], [BULK; 2])?;
            let found = steady.solve(&cells, &vec![FLUX; cells.len()])?;
            for (i, there) in (0..n).map(|i| (i, grid.centre(0, i) - 0.5 * side)) {
                let exact = exact.temperature(there, 0.5 * grid.pitch[1]);
                worst = worst.max(relative(found.temperature[i * n + n / 2] - BULK, exact).abs());
            }
            Ok(relative(found.max_temperature().unwrap_or(BULK) - BULK, exact.max_temperature()))
        };
        let [rest, one, five] = [error(0.0)?, error(1.0)?, error(5.0)?];
        let [ten, hundred] = [error(10.0)?, error(100.0)?];
        Ok([worst, rest, one, five, ten, hundred])
    })
}

/// A square with this side on steel that takes all of the heat.
fn square_source(peclet: f64, side: Metre) -> SquareSource {
    let thermal = steel();
    SquareSource {
        half_side: 0.5 * side,
        flux: FLUX,
        conductivity: thermal.conductivity,
        diffusivity: thermal.diffusivity(),
        speed: 4.0 * peclet * thermal.diffusivity() / side,
    }
}

/// A heated disc on equal bodies at rest, each of which takes half. The temperature of the centre after 1/4,
/// 1 and 4 times a²/D is compared with that of a disc with the area of the cells. Cells at the edge are
/// inside or outside, so that the order scatters around 2.
pub(super) const DISC: Case =
    Case { name: "heated disc: in time", source: "Carslaw and Jaeger (1959), chapter X", checks: disc };

fn disc() -> Result<Vec<Check>> {
    let order = || Expected::Order { order: 1.0..=3.0, finest: 2e-3 };
    let checks = [("Dt/a² = 1/4", order()), ("Dt/a² = 1", order()), ("Dt/a² = 4", order())];
    study("a/Δx", &[6, 12, 24], checks, |n| {
        let (thermal, radius) = (steel(), 1e-5);
        let grid = Grid::new([2 * n + 1; 2], [radius / n as f64; 2])?;
        let cells = within(&grid, n as f64);
        let area = cells.len() as f64 * grid.cell_area();
        let exact = HeatedDisc {
            radius: (area / PI).sqrt(),
            flux: FLUX,
            conductivity: thermal.conductivity,
            diffusivity: thermal.diffusivity(),
        };
        let error = |times: f64| -> Result<f64> {
            let steps = 32;
            let step = times * radius * radius / thermal.diffusivity() / steps as f64;
            let mut flash =
                FlashTemperature::new([&grid; 2], [thermal; 2], Boundary::FREE, steps, step, [BULK; 2])?;
            let fluxes = vec![2.0 * FLUX; cells.len()];
            let middle = cells.len() / 2;
            let mut centre = BULK;
            for _ in 0..steps {
                centre = flash.step([&cells, &cells], &fluxes)?.temperature[middle];
            }
            // In the first step the flux grows from 0, as if it began at its middle.
            Ok(relative(centre - BULK, exact.centre((steps as f64 - 0.5) * step)))
        };
        Ok([error(0.25)?, error(1.0)?, error(4.0)?])
    })
}

/// Flat cells with centres within `radius` cells of the middle of an odd grid.
fn within(grid: &Grid, radius: f64) -> Vec<u32> {
    let middle = grid.shape.map(|n| (n / 2) as f64);
    let inside = |(i, j): (usize, usize)| (i as f64 - middle[0]).hypot(j as f64 - middle[1]) < radius;
    let all = ndarray::indices(grid.shape).into_iter().enumerate();
    all.filter(|(_, at)| inside(*at)).map(|(cell, _)| cell as u32).collect()
}

/// Half of a Hertzian flux into each of two equal bodies at rest; temperature of the centre and of all cells.
pub(super) const HERTZIAN: Case = Case {
    name: "Hertzian flux at rest",
    source: "Johnson (1985), section 3.4, for E* = 2λ",
    checks: || {
        let checks = [
            ("centre", Expected::Order { order: 1.4..=2.6, finest: 1e-3 }),
            ("largest error", Expected::Order { order: 1.0..=2.0, finest: 1e-2 }),
        ];
        study("a/Δx", &[8, 16, 32], checks, |n| {
            let thermal = steel();
            let grid = Grid::new([2 * n + 1; 2], [1e-5 / n as f64; 2])?;
            let exact = HertzianFlux { radius: 1e-5, mean_flux: FLUX, conductivity: thermal.conductivity };
            let cells = within(&grid, n as f64);
            let distance = |cell: u32| {
                let at = |index: usize| (index as f64 - n as f64) * grid.pitch[0];
                at(cell as usize / grid.shape[1]).hypot(at(cell as usize % grid.shape[1]))
            };
            let fluxes: Vec<f64> = cells.iter().map(|&cell| 2.0 * exact.flux(distance(cell))).collect();
            let mut steady = SteadyTemperature::new(grid, [thermal; 2], Boundary::FREE, [0.0; 2], [BULK; 2])?;
            let found = steady.solve(&cells, &fluxes)?.temperature;
            let errors: Vec<f64> = cells
                .iter()
                .zip(&found)
                .map(|(&cell, t)| (t - BULK - exact.temperature(distance(cell))) / exact.temperature(0.0))
                .collect();
            Ok([errors[cells.len() / 2], largest(&errors)])
        })
    },
};

/// A square of n cells per side moves over a cold body by one cell per step, for three of its sides or, if
/// slow, for eight. Its largest temperature is compared with the steady one.
pub(super) const TRANSIENT: Case = Case {
    name: "moving square, step by step",
    source: "Jaeger (1942)",
    checks: || {
        // 2 % at 8 cells, 1 % at 16.
        let checks = ["Pe = 1/2", "Pe = 2", "Pe = 5"].map(|name| (name, Expected::Counted(0.16)));
        study("cells a side", &[8, 16], checks, |n| {
            Ok([travelling_square(n, 0.5)?, travelling_square(n, 2.0)?, travelling_square(n, 5.0)?])
        })
    },
};

fn travelling_square(n: usize, peclet: f64) -> Result<f64> {
    let (thermal, side) = (steel(), 1e-5);
    let pitch = side / n as f64;
    let exact = square_source(peclet, side);
    let steps = (n as f64 * (8.0 / peclet).clamp(3.0, 8.0)) as usize;
    let grid = Grid::new([n + steps, n], [pitch; 2])?;
    let bodies = [thermal, insulating(&thermal)];
    let mut flash =
        FlashTemperature::new([&grid; 2], bodies, Boundary::FREE, steps, pitch / exact.speed, [BULK; 2])?;
    let mut hottest = BULK;
    for k in 0..steps {
        let first = (k * n) as u32;
        let cells: Vec<u32> = (first..first + (n * n) as u32).collect();
        let found = flash.step([&cells, &cells], &vec![FLUX; n * n])?;
        hottest = found.max_temperature().unwrap_or(BULK);
    }
    Ok(relative(hottest - BULK, exact.max_temperature()))
}

/// Between equal bodies, one of them moving, the heat is divided equally as the speed decreases. At every
/// speed, for any bodies, the sum is the frictional heat.
pub(super) const DIVISION: Case = Case {
    name: "heat: divided, and all of it",
    source: "q₁ + q₂ = q",
    checks: || {
        let checks = [
            ("half each, Pe = 1/size", Expected::Order { order: 0.8..=1.2, finest: 1e-3 }),
            ("sum, steady", Expected::RoundOff(1e-12)),
            ("sum, over a pass", Expected::RoundOff(1e-12)),
        ];
        study("1/Pe", &[10, 100, 1000], checks, |slowness| {
            let (thermal, n) = (steel(), 12);
            let grid = Grid::new([n, n], [1e-6; 2])?;
            let cells: Vec<u32> = (0..144).filter(|cell| cell * 7 % 5 < 3).collect();
            let fluxes: Vec<f64> = cells.iter().map(|cell| FLUX * f64::from(1 + cell % 3)).collect();
            let all = grid.cell_area() * fluxes.iter().sum::<f64>();
            let speed = 4.0 * thermal.diffusivity() / (slowness as f64 * grid.extent()[0]);
            let mut steady =
                SteadyTemperature::new(grid, [thermal; 2], Boundary::FREE, [0.0, speed], [BULK; 2])?;
            let heat = steady.solve(&cells, &fluxes)?.heat;
            let other = Thermal { conductivity: 0.3, heat_capacity: 1500.0, density: 1200.0 };
            let mut flash = FlashTemperature::new(
                [&grid; 2],
                [thermal, other],
                Boundary::PERIODIC,
                20,
                grid.pitch[0] / speed,
                [BULK, BULK + 20.0],
            )?;
            let mut pass = 0.0;
            for shift in 0..20 {
                let moved: Vec<u32> = cells.iter().map(|cell| (cell + 12 * shift) % 144).collect();
                pass += flash.step([&cells, &moved], &fluxes)?.heat.iter().sum::<f64>();
            }
            Ok([relative(heat[0], 0.5 * all), relative(heat.iter().sum(), all), relative(pass, 20.0 * all)])
        })
    },
};

/// Waves of flux into two equal bodies at rest, each of which takes half: T̂ = q̂/2λq.
pub(super) const WAVE: Case = Case {
    name: "periodic heat: oblique sinusoid",
    source: "1/λ√(q² + iVq_x/D)",
    checks: || {
        study("cells a side", &[8, 15, 32], [("temperature", Expected::RoundOff(1e-9))], |n| {
            let thermal = steel();
            let grid = Grid::new([n, n + 1], [1e-6, 0.7e-6])?;
            let [lx, ly] = grid.extent();
            let phase = |i, j| 2.0 * PI * (2.0 * grid.centre(0, i) / lx - grid.centre(1, j) / ly);
            let speed = 3.0;
            let mut steady =
                SteadyTemperature::new(grid, [thermal; 2], Boundary::PERIODIC, [speed; 2], [BULK; 2])?;
            // A wave heats all cells but one, which has zero flux, as at a node of the wave.
            let (i0, j0) = (0, 0);
            let wave = Field::from_shape_fn(grid.shape, |(i, j)| (phase(i, j) - phase(i0, j0)).sin());
            let cells: Vec<u32> = (1..grid.cells() as u32).collect();
            let flat = wave.as_slice().expect("standard layout");
            let fluxes: Vec<f64> = cells.iter().map(|cell| 2.0 * FLUX * flat[*cell as usize]).collect();
            let found = steady.solve(&cells, &fluxes)?.temperature;
            // 1/√(q² + iVq_x/D) has the modulus m and the phase lag of the angle.
            let (qx, qy) = (4.0 * PI / lx, -2.0 * PI / ly);
            let (re, im) = (qx * qx + qy * qy, speed * qx / thermal.diffusivity());
            let (m, angle) = (re.hypot(im).powf(-0.5), -0.5 * im.atan2(re));
            let exact = Field::from_shape_fn(grid.shape, |(i, j)| {
                let at = phase(i, j) - phase(i0, j0);
                FLUX * m / thermal.conductivity * (at + angle).sin()
            });
            let mut computed = exact.clone();
            let values = computed.as_slice_mut().expect("standard layout");
            cells.iter().zip(&found).for_each(|(cell, t)| values[*cell as usize] = t - BULK);
            Ok([relative_max(&computed, &exact)])
        })
    },
};

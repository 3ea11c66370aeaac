//! A one-dimensional sinusoid on a plane, from light to full contact.

use std::f64::consts::PI;

use super::{Case, Check, Expected, press, relative, relative_max, relative_rms, study};
use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::operator::PeriodicFft;
use crate::reference::Westergaard;
use crate::solver::{Control, Solution};
use crate::surface::Form;

const SOURCE: &str = "Westergaard (1939); Johnson (1985), eqs. 13.2–13.8";

/// A quarter, a half and three quarters of the surface in contact: the edge lies between two cells on every
/// grid. Elsewhere the error jumps with the position of the edge in its cell, and four grids would show no
/// order.
pub(super) const QUARTER: Case =
    Case { name: "Westergaard: contact of 1/4", source: SOURCE, checks: || partial(0.25) };
pub(super) const HALF: Case =
    Case { name: "Westergaard: contact of 1/2", source: SOURCE, checks: || partial(0.5) };
pub(super) const THREE_QUARTERS: Case =
    Case { name: "Westergaard: contact of 3/4", source: SOURCE, checks: || partial(0.75) };

/// Without an edge the pressure is one harmonic, which the grid represents without error.
pub(super) const FULL: Case = Case { name: "Westergaard: p̄/p* = 1.2", source: SOURCE, checks: full };

fn partial(fraction: f64) -> Result<Vec<Check>> {
    let closure = (0.5 * PI * fraction).sin().powi(2);
    let second = |finest| Expected::Order { order: 1.8..=2.2, finest };
    let checks = [
        ("mean gap", second(1e-3)),
        ("elastic energy", second(1e-3)),
        ("pressure, rms", Expected::Order { order: 0.8..=1.2, finest: 2e-2 }),
        ("contact fraction", Expected::Counted(2.0)),
    ];
    study("λ/Δx", &[64, 128, 256, 512], checks, |n| {
        let (wave, grid, solution, exact) = solve(closure, n)?;
        let cells = solution.contact_cells() as f64;
        let energy = solution.elastic_energy() / grid.area();
        Ok([
            relative(wave.amplitude - solution.approach, wave.mean_gap()),
            relative(energy, wave.elastic_energy()),
            relative_rms(&solution.pressure, &exact),
            cells / n as f64 - fraction,
        ])
    })
}

fn full() -> Result<Vec<Check>> {
    study("λ/Δx", &[16, 64, 256], [("pressure", Expected::RoundOff(1e-8))], |n| {
        let (_, _, solution, exact) = solve(1.2, n)?;
        Ok([relative_max(&solution.pressure, &exact)])
    })
}

/// The wave at p̄ = `closure` p*, its grid of `cells` cells per wavelength, the solution and the exact
/// pressure.
fn solve(closure: f64, cells: usize) -> Result<(Westergaard, Grid, Solution, Field)> {
    let mut wave = Westergaard { amplitude: 0.02, wavelength: 2.0, modulus: 5.0, mean_pressure: 0.0 };
    wave.mean_pressure = closure * wave.full_contact_pressure();
    let pitch = wave.wavelength / cells as f64;
    let grid = Grid::new([cells, 1], [pitch, pitch])?;
    let form = Form::Sinusoid { amplitude: wave.amplitude, wavelength: [wave.wavelength, f64::INFINITY] };
    let gap = -form.on(&grid)?.into_heights();
    let load = Control::Load(wave.mean_pressure * grid.area());
    let solution = press(&mut PeriodicFft::new(grid, wave.modulus), &gap, f64::INFINITY, load)?;
    let exact =
        Field::from_shape_fn(grid.shape, |(i, _)| wave.pressure(grid.centre(0, i) - 0.5 * wave.wavelength));
    Ok((wave, grid, solution, exact))
}

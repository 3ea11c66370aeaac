//! Times the conductance of rough contacts against the contact solutions that they follow.
//!
//! ```text
//! conductance_cost [512] [3]
//! ```
//!
//! For each boundary, contact fraction and joint it prints the least of some times of both in milliseconds,
//! their ratio, and the operator calls of both.
#![expect(clippy::print_stdout, reason = "the times are what it is for")]

use std::error::Error;
use std::time::Instant;

use asperity::conductance::{Joint, Kind, solve};
use asperity::operator::{FreeFft, Operator, PeriodicFft};
use asperity::solver::{Bounds, Control, Method, Params, solve_normal};
use asperity::{Field, Grid};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let side: usize = arguments.next().map_or(Ok(512), |text| text.parse())?;
    let repeat: usize = arguments.next().map_or(Ok(3), |text| text.parse())?;
    let grid = Grid::new([side, side], [1.0 / side as f64; 2])?;
    println!("boundary contact joint contact_ms conductance_ms ratio contact_calls conductance_calls h");
    for periodic in [true, false] {
        let operator = || -> Box<dyn Operator> {
            if periodic { Box::new(PeriodicFft::new(grid, 1.0)) } else { Box::new(FreeFft::new(grid, 1.0)) }
        };
        for capped in [false, true] {
            for mean_pressure in [0.009, 0.04] {
                report(&grid, operator().as_mut(), [periodic, capped], mean_pressure, repeat)?;
            }
        }
    }
    Ok(())
}

fn report(
    grid: &Grid,
    operator: &mut dyn Operator,
    [periodic, capped]: [bool; 2],
    mean_pressure: f64,
    repeat: usize,
) -> Result<(), Box<dyn Error>> {
    let gap = rough(grid);
    let params = Params::default().with_method(Method::ActiveSet);
    let bounds = if capped { Bounds::up_to(0.4) } else { Bounds::ELASTIC };
    let load = Control::Load(mean_pressure * grid.area());
    let (contact_time, contact) =
        least(repeat, || Ok(solve_normal(operator, &gap, &bounds, load, None, &params)?))?;
    let touching = contact.pressure.mapv(|pressure| pressure > 0.0);
    let share = touching.iter().filter(|touches| **touches).count() as f64 / grid.cells() as f64;
    let open: Field = contact.gap().mapv(|gap| gap.max(0.0));
    let clean = Joint::new(Kind::Thermal);
    let own = operator.influence(0, 0);
    let joints = [
        ("clean", clean, None),
        ("clean,from-pressure", clean, Some(&contact.pressure)),
        ("film", clean.with_film(own), None),
        ("film+gas", clean.with_film(own).with_gas(6e-4, 1e-2), None),
        ("good-gas", clean.with_gas(0.1, 1e-2), None),
    ];
    for (name, joint, start) in joints {
        let (time, found) =
            least(repeat, || Ok(solve(operator, &touching, Some(&open), &joint, start, &params)?))?;
        println!(
            "{} {:.1}% {name}{} {:.1} {:.1} {:.2} {:.0} {:.0} {:.5}",
            if periodic { "periodic" } else { "free" },
            100.0 * share,
            if capped { ",capped" } else { "" },
            1e3 * contact_time,
            1e3 * time,
            time / contact_time,
            contact.stats.convolutions,
            found.stats.convolutions,
            found.joint_conductance(None).unwrap_or(f64::INFINITY),
        );
    }
    Ok(())
}

/// Gap of a self-affine surface: waves of all lengths from the side to eight cells.
fn rough(grid: &Grid) -> Field {
    let side = grid.shape[0];
    let wave = |i: usize, j: usize, k: usize| {
        let angle = 2.4 * k as f64;
        let turns = (1 << (k / 6)) as f64;
        // Whole turns on the period.
        let [x, y] = [(turns * angle.cos()).round(), (turns * angle.sin()).round()];
        let place = (x * i as f64 + y * j as f64) / side as f64;
        (std::f64::consts::TAU * place + (k * k) as f64).sin() / turns.powf(1.8)
    };
    let waves = 6 * (side.ilog2() as usize - 3);
    Field::from_shape_fn(grid.shape, |(i, j)| 0.03 * (0..waves).map(|k| wave(i, j, k)).sum::<f64>())
}

/// The least time of some calls, and the answer of the last.
fn least<T>(
    repeat: usize,
    mut call: impl FnMut() -> Result<T, Box<dyn Error>>,
) -> Result<(f64, T), Box<dyn Error>> {
    let mut times = Vec::new();
    let mut answer = None;
    for _ in 0..repeat.max(1) {
        let start = Instant::now();
        answer = Some(call()?);
        times.push(start.elapsed().as_secs_f64());
    }
    Ok((times.into_iter().fold(f64::INFINITY, f64::min), answer.expect("at least one call")))
}

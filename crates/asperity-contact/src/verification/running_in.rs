//! Running-in: bodies that wear and grow films.

use std::f64::consts::PI;

use super::{Case, Check, Expected, study};
use crate::error::Result;
use crate::film::{FILM, Film, FilmLaw, FilmStress, Films};
use crate::grid::Grid;
use crate::material::Material;
use crate::motion::{Acceleration, Changes, LoadControl, Motion, Pair, Simulation, Strategy};
use crate::operator::Boundary;
use crate::solver::{Control, Params};
use crate::surface::Form;
use crate::units::Metre;
use crate::wear::{Wear, WearCoefficient};

/// The amplitude of grooves along the sliding direction that are pressed flat decays exponentially.
pub(super) const GROOVES: Case = Case {
    name: "grooves wear: A₀ e^(−(k₁+k₂)E*πs/L)",
    source: "decay of a harmonic by Archard's law",
    checks: grooves,
};

/// A film under a uniform pressure approaches its steady thickness exponentially.
pub(super) const FILM_GROWTH: Case =
    Case {
        name: "a film grows", source: "f_e (1 − e^(−(G/f_max + R)t)), exact over any jump", checks: film
    };

const SLIDE: Strategy = Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 };
const PITCH: Metre = 1e-6;

fn grooves() -> Result<Vec<Check>> {
    const PASSES: usize = 1280;
    let order_1 = [("depth, all passes computed", Expected::Order { order: 0.9..=1.1, finest: 1e-2 })];
    let all = study("passes", &[20, 40, 80], order_1, |n| Ok([depth(n, 1)?]))?;
    let order_2 = [("depth, by jumps", Expected::Order { order: 1.8..=2.2, finest: 1e-4 })];
    let jumps = study("computed", &[20, 40, 80], order_2, |n| Ok([depth(PASSES, PASSES / n)?]))?;
    Ok([all, jumps].concat())
}

/// Relative error of the remaining depth after `passes` passes, with extrapolation over up to `jump` passes.
fn depth(passes: usize, jump: usize) -> Result<f64> {
    const CELLS: usize = 16;
    const AMPLITUDE: Metre = 20e-9;
    let grid = Grid::new([4, CELLS], [PITCH; 2])?;
    let length = CELLS as f64 * PITCH;
    let waves = Form::Sinusoid { amplitude: AMPLITUDE, wavelength: [f64::INFINITY, length] }.on(&grid)?;
    let steel = Material::elastic(210e9, 0.3)?;
    let pair = Pair::new(waves, Form::Flat.on(&grid)?, [&steel, &steel])?;
    let modulus = pair.modulus();
    let control = Control::Load(1.5 * PI * modulus * AMPLITUDE / length * grid.area());
    // One position per pass, from which the bodies slide over the length of the grid.
    let motion =
        Motion::new(SLIDE, control).with_passes(passes).with_stride(4).with_load_control(LoadControl::Step);
    let distance = passes as f64 * grid.extent()[0];
    let coefficient = Some(WearCoefficient::archard(length / (2.0 * PI * modulus * distance))?);
    let params = Params::default().with_tolerance(1e-10);
    let acceleration =
        Acceleration::default().with_tolerance(1e6).with_max_wear(f64::INFINITY).with_max_jump(jump);
    let mut simulation = Simulation::new(pair, Boundary::PERIODIC, motion, params)?.with_changes(
        Changes::by(Wear::new([coefficient; 2], [None, None])?).with_acceleration(acceleration),
    )?;
    simulation.run(&(), &mut [])?;
    let gap = &simulation.pair().upper.heights - &simulation.pair().lower.heights;
    let part = |wave: fn(f64) -> f64| -> f64 {
        let row = gap.row(0);
        let terms = row.iter().enumerate().map(|(j, z)| z * wave(2.0 * PI * (j as f64 + 0.5) / CELLS as f64));
        terms.sum::<f64>() * 2.0 / CELLS as f64
    };
    Ok(part(f64::cos).hypot(part(f64::sin)) / AMPLITUDE / (-1.0f64).exp() - 1.0)
}

fn film() -> Result<Vec<Check>> {
    study("jump", &[1, 32, 1024], [("thickness", Expected::RoundOff(1e-6))], |jump| Ok([thickness(jump)?]))
}

/// Relative error of the thickness of a film with extrapolation over up to `jump` passes.
fn thickness(jump: usize) -> Result<f64> {
    const PASSES: usize = 2000;
    let (pressure, speed, growth, removal, max_thickness) = (1e9, 1.0, 2e-6, 1e-7, 10e-9);
    let grid = Grid::new([8, 8], [PITCH; 2])?;
    let steel = Material::elastic(210e9, 0.3)?;
    let pair = Pair::new(Form::Flat.on(&grid)?, Form::Flat.on(&grid)?, [&steel, &steel])?;
    let law = FilmLaw::Arrhenius {
        rate: growth,
        at_temperature: 373.15,
        at_stress: pressure,
        activation_energy: 1.3e-19,
        activation_volume: 3.8e-30,
        stress: FilmStress::Pressure,
        removal,
    };
    let films = Films::new([Some(Film::new(law, max_thickness, None)?), None], &pair)?;
    let motion = Motion::new(SLIDE, Control::Load(pressure * grid.area()))
        .with_passes(PASSES)
        .with_stride(8)
        .with_load_control(LoadControl::Step);
    let acceleration = Acceleration::default().with_tolerance(1e9).with_max_jump(jump);
    let mut simulation = Simulation::new(pair, Boundary::PERIODIC, motion, Params::default())?
        .with_changes(Changes::by(films).with_bulk([373.15; 2]).with_acceleration(acceleration))?;
    simulation.run(&(), &mut [])?;
    let rate = growth / max_thickness + removal * pressure * speed;
    let time = PASSES as f64 * grid.extent()[0] / speed;
    let exact = growth / rate * (1.0 - (-rate * time).exp());
    let found = simulation.pair().lower.state[FILM].values.mean().unwrap_or(f64::NAN);
    Ok(found / exact - 1.0)
}

//! Static contacts that slide in place.

use std::f64::consts::PI;

use super::{Case, Check, Expected, PARAMS, relative, relative_max, study};
use crate::error::Result;
use crate::film::{Film, FilmLaw, FilmStress, Films};
use crate::grid::{Field, Grid};
use crate::material::Material;
use crate::motion::{Changes, Pair, Slide, SlidingContact, SlidingOutcome, UpdateRecord};
use crate::operator::{Boundary, FreeFft, Operator};
use crate::solver::Control;
use crate::surface::Form;
use crate::units::{Metre, PerPascal};
use crate::wear::{Wear, WearCoefficient};

/// The amplitude of grooves pressed flat decays exponentially.
pub(super) const GROOVES: Case = Case {
    name: "grooves wear in place: A₀ e^(−(k₁+k₂)E*πs/L)",
    source: "decay of a harmonic by Archard's law",
    checks: grooves,
};

/// The same decay with a growing film that reduces the wear.
pub(super) const GROOVES_UNDER_FILM: Case = Case {
    name: "grooves wear in place under a growing film",
    source: "k s ⇒ v (k_f t + (k₀ − k_f) τ (1 − e^(−t/τ))), τ = f_max/G",
    checks: grooves_under_film,
};

/// Flat bodies wear until the pressure is uniform.
pub(super) const FLAT: Case =
    Case {
        name: "flat on flat wears: p̄ everywhere, −p̄ C·1", source: "no wear but the mean", checks: flat
    };

/// A ball worn on a disc.
pub(super) const BALL: Case = Case {
    name: "ball on disc wears: k = 1.33e-13 1/Pa, 640 mm",
    source: "uniform pressure on a disc; case of Argatov, Wear 271, 1147 (2011)",
    checks: ball,
};

const CELLS: usize = 16;
const PITCH: Metre = 1e-6;
const LENGTH: Metre = CELLS as f64 * PITCH;
const AMPLITUDE: Metre = 20e-9;
const DISTANCE: Metre = 0.1;

fn grooves() -> Result<Vec<Check>> {
    amplitudes(1e-4, |updates| amplitude(updates, None, (-1.0f64).exp()))
}

fn grooves_under_film() -> Result<Vec<Check>> {
    const SPEED: f64 = 1.0;
    let (k_0, share, max_thickness) = (4.0 * decay()?, 0.1, 100e-9);
    let time = DISTANCE / SPEED;
    let tau = time / 4.0 * 1.5;
    let law = FilmLaw::Arrhenius {
        rate: max_thickness / tau,
        at_temperature: 373.15,
        at_stress: 1e9,
        activation_energy: 0.0,
        activation_volume: 0.0,
        stress: FilmStress::Pressure,
        removal: 0.0,
    };
    let film = Film::new(law, max_thickness, None)?;
    let way = share * time + (1.0 - share) * tau * (1.0 - (-time / tau).exp());
    let exact = (-k_0 / decay()? * way / time).exp();
    let coefficient = WearCoefficient::archard(0.5 * k_0)?.with_film(0.5 * share * k_0)?;
    amplitudes(1e-3, |updates| amplitude(updates, Some((coefficient, &film)), exact))
}

/// Wear of both bodies together that reduces the amplitude by a factor e.
fn decay() -> Result<PerPascal> {
    let steel = Material::elastic(210e9, 0.3)?;
    Ok(LENGTH / (PI * 0.5 * steel.plane_strain_modulus() * DISTANCE))
}

/// Errors of the amplitude for each number of updates, and extrapolated from half that number and itself.
fn amplitudes(finest: f64, error: impl Fn(usize) -> Result<f64>) -> Result<Vec<Check>> {
    let first = [("amplitude", Expected::Order { order: 0.9..=1.1, finest: 4e-2 })];
    let single = study("updates", &[20, 40, 80], first, |n| Ok([error(n)?]))?;
    let second = [("extrapolated", Expected::Order { order: 1.7..=2.3, finest })];
    let both = study("updates", &[20, 40, 80], second, |n| Ok([2.0 * error(n)? - error(n / 2)?]))?;
    Ok([single, both].concat())
}

/// Relative error of the amplitude after `updates` equal updates.
fn amplitude(updates: usize, under: Option<(WearCoefficient, &Film)>, exact: f64) -> Result<f64> {
    let grid = Grid::new([4, CELLS], [PITCH; 2])?;
    let waves = Form::Sinusoid { amplitude: AMPLITUDE, wavelength: [f64::INFINITY, LENGTH] }.on(&grid)?;
    let steel = Material::elastic(210e9, 0.3)?;
    let pair = Pair::new(waves, Form::Flat.on(&grid)?, [&steel, &steel])?;
    let control = Control::Load(1.5 * PI * pair.modulus() * AMPLITUDE / LENGTH * grid.area());
    let ends = (1..=updates).map(|update| DISTANCE * update as f64 / updates as f64).collect();
    let slide = Slide::to(ends, control).with_speed(1.0);
    let mut contact = SlidingContact::new(pair, Boundary::PERIODIC, slide, PARAMS)?;
    contact = match under {
        None => {
            let coefficient = Some(WearCoefficient::archard(0.5 * decay()?)?);
            contact.with_changes(Changes::by(Wear::new([coefficient; 2], [None, None])?))?
        }
        Some((coefficient, film)) => {
            let films = [Some(*film), Some(*film)];
            let law = Films::new(films, contact.pair())?;
            contact.with_changes(
                Changes::by(Wear::new([Some(coefficient); 2], films)?).with_law(law).with_bulk([373.15; 2]),
            )?
        }
    };
    let worn = contact.run(None, &(), &mut [])?.state.pair;
    let gap = &worn.upper.heights - &worn.lower.heights;
    let part = |wave: fn(f64) -> f64| -> f64 {
        let row = gap.row(0);
        let terms = row.iter().enumerate().map(|(j, z)| z * wave(2.0 * PI * (j as f64 + 0.5) / CELLS as f64));
        terms.sum::<f64>() * 2.0 / CELLS as f64
    };
    Ok(relative(part(f64::cos).hypot(part(f64::sin)) / AMPLITUDE, exact))
}

fn flat() -> Result<Vec<Check>> {
    let within = || Expected::RoundOff(1e-6);
    study("cells", &[8, 16, 32], [("pressure", within()), ("worn shape", within())], |n| {
        let grid = Grid::new([n, n], [PITCH; 2])?;
        let steel = Material::elastic(210e9, 0.3)?;
        let pair = Pair::new(Form::Flat.on(&grid)?, Form::Flat.on(&grid)?, [&steel, &steel])?;
        let mean = 100e6;
        let mut even = grid.zeros();
        let pressure = Field::from_elem(grid.shape, mean);
        FreeFft::new(grid, pair.modulus()).apply(&pressure, &mut even);
        even -= even.mean().unwrap_or(f64::NAN);
        // In each of these updates any pattern decays to less than a thirtieth.
        let stiffest = 30.0 * n as f64 * PITCH / pair.modulus();
        let ends = (1..=8).map(|update| f64::from(update) * 0.1).collect();
        let coefficient = Some(WearCoefficient::archard(stiffest / 0.1)?);
        let slide = Slide::to(ends, Control::Load(mean * grid.area()));
        let contact = SlidingContact::new(pair, Boundary::FREE, slide, PARAMS)?;
        let contact = contact.with_changes(Changes::by(Wear::new([coefficient, None], [None, None])?))?;
        let worn = contact.run(None, &(), &mut [])?;
        let mut shape = worn.state.pair.lower.heights.clone();
        shape -= shape.mean().unwrap_or(f64::NAN);
        Ok([relative_max(&worn.state.pressure, &pressure), relative_max(&shape, &even)])
    })
}

fn ball() -> Result<Vec<Check>> {
    let stations = [160, 320, 640];
    let worn = worn_ball(&stations)?;
    let checks = [
        // 0.4, 0.2, 0.1 %.
        ("depth", Expected::Counted(0.64)),
        ("radius of contact, cells", Expected::RoundOff(1.0)),
        ("volume", Expected::RoundOff(1e-12)),
    ];
    let mut found = worn.into_iter();
    study("mm", &stations, checks, |_| Ok(found.next().expect("an error for each station")))
}

/// Errors of depth, contact radius and volume of a ball after these sliding distances, mm.
fn worn_ball(stations: &[usize]) -> Result<Vec<[f64; 3]>> {
    const BALL_CELLS: usize = 65;
    const UPDATES: usize = 40;
    let (radius, load, k) = (50e-3, 10.3846, 1.33e-13);
    let grid = Grid::new([BALL_CELLS; 2], [1.3e-3 / BALL_CELLS as f64; 2])?;
    let steel = Material::elastic(210e9, 0.3)?;
    let ball = Form::Sphere { radius }.on(&grid)?.underside();
    let pair = Pair::new(Form::Flat.on(&grid)?, ball, [&steel, &steel])?;
    let modulus = pair.modulus();
    let coefficient = Some(WearCoefficient::archard(k)?);
    let distances: Vec<Metre> = stations.iter().map(|station| 1e-3 * *station as f64).collect();
    let last = distances.iter().copied().fold(0.0, f64::max);
    let mut slide = Slide::graded(last, UPDATES, Control::Load(load));
    slide.ends.extend(&distances);
    slide.ends.sort_by(f64::total_cmp);
    slide.ends.dedup_by(|one, other| (*one - *other).abs() < 1e-9);
    let contact = SlidingContact::new(pair, Boundary::FREE, slide, PARAMS)?;
    let contact = contact.with_changes(Changes::by(Wear::new([None, coefficient], [None, None])?))?;
    let SlidingOutcome { state, .. } = contact.run(None, &(), &mut [])?;
    let at = |distance: &Metre| {
        let near = |update: &&UpdateRecord| (update.distance - distance).abs() < 1e-9;
        let update = state.updates.iter().find(near).expect("an update ends at each station");
        let volume = k * load * distance;
        // π a⁴/4R − 4Wa/(3πE*) = k W s, by bisection.
        let (mut less, mut more) = (1e-6, 1e-2);
        for _ in 0..200 {
            let a: f64 = 0.5 * (less + more);
            let cap = PI * a.powi(4) / (4.0 * radius) - 4.0 * load * a / (3.0 * PI * modulus);
            if cap < volume { less = a } else { more = a }
        }
        let a = less;
        let depth = a * a / (2.0 * radius) - (2.0 - 4.0 / PI) * load / (PI * a * modulus);
        let found = (update.contact_area / PI).sqrt();
        [
            relative(update.laws.max_wear_upper, depth),
            (found - a) / grid.pitch[0],
            relative(update.lost("wear")[1], volume),
        ]
    };
    Ok(distances.iter().map(at).collect())
}

//! Wear, films and extrapolation over passes.

use std::f64::consts::PI;

use asperity_base::{Field, Grid};
use asperity_contact::film::{FILM, Film, FilmLaw, Films};
use asperity_contact::motion::{
    Acceleration, Changes, ContactCells, FLASH, Law, LoadControl, Motion, Pair, PassRecord, Path, Simulation,
    Strategy,
};
use asperity_contact::operator::Boundary;
use asperity_contact::solver::{Control, Coupling, Friction, Params};
use asperity_contact::temperature::Thermal;
use asperity_surface::{Amplitude, Form, Topography};

use crate::support::{Kept, archard, largest, self_affine, steel, zddp};

const PITCH: f64 = 1e-6;
const SLIDE: Strategy = Strategy::Shift { speed_lower: 0.0, speed_upper: 0.5 };

fn heights(kept: &Kept) -> [&Field; 2] {
    [&kept.last().lower.heights, &kept.last().upper.heights]
}

fn represented(kept: &Kept) -> usize {
    kept.passes.iter().map(PassRecord::represents).sum()
}

fn error(kept: &Kept) -> f64 {
    kept.passes.iter().map(|pass| pass.running.unwrap().error_estimate).sum()
}

fn rms(field: &Field) -> f64 {
    (field.mapv(|z| z * z).mean().unwrap()).sqrt()
}

fn rough(hardness: f64, n: usize) -> Pair {
    let grid = Grid::new([n, n], [PITCH; 2]).unwrap();
    let surface = |seed| self_affine(&grid, Amplitude::Sq(30e-9), Some(8e-6), seed);
    Pair::new(surface(1), surface(2).underside(), [&steel(hardness); 2]).unwrap()
}

/// Periodic bodies that these laws change.
fn changing(pair: Pair, motion: Motion, changes: Changes) -> Simulation {
    let simulation = Simulation::new(pair, Boundary::PERIODIC, motion, Params::default()).unwrap();
    simulation.with_changes(changes).unwrap()
}

fn run_in(hardness: f64, passes: usize, acceleration: Acceleration) -> Kept {
    let motion = Motion::new(SLIDE, Control::Load(0.05)).with_passes(passes).with_stride(4);
    let changes = Changes::by(archard([4e-15; 2])).with_acceleration(acceleration);
    Kept::run(changing(rough(hardness, 16), motion, changes))
}

#[test]
fn jumps_lead_where_all_passes_do_and_within_their_bound() {
    for (hardness, passes) in [(f64::INFINITY, 300), (1.5e9, 200)] {
        let all = run_in(hardness, passes, Acceleration::NONE);
        let few = run_in(hardness, passes, Acceleration::default().with_max_wear(20e-9));
        assert_eq!((all.passes.len(), represented(&all), represented(&few)), (passes, passes, passes));
        assert!(few.passes.len() <= 40, "{} passes computed", few.passes.len());
        assert_eq!(error(&all), 0.0);
        let before = rough(hardness, 16);
        let before = [&before.lower.heights, &before.upper.heights];
        for (body, before) in before.into_iter().enumerate() {
            let [all, jumped] = [&all, &few].map(|kept| heights(kept)[body]);
            let (change, off) = (all - before, jumped - all);
            assert!(rms(&off) < 5e-3 * rms(&change), "{:e} of {:e}", rms(&off), rms(&change));
            let most = largest(&off);
            assert!(most <= error(&few), "{most:e} beyond the bound {:e}", error(&few));
        }
        let plastic = |kept: &Kept| kept.passes.iter().map(|pass| pass.lost("plastic")[0]).sum::<f64>();
        if hardness.is_finite() {
            assert!((plastic(&few) / plastic(&all) - 1.0).abs() < 0.01);
        }
    }
}

#[test]
fn steadily_worn_passes_begin_where_the_last_ones_lead() {
    let motion = Motion::new(SLIDE, Control::Load(0.8)).with_passes(8).with_stride(16);
    let kept = Kept::run(changing(rough(f64::INFINITY, 64), motion, Changes::by(archard([1e-15; 2]))));
    let convolutions: Vec<f64> = kept.passes.iter().map(|pass| pass.convolutions / 4.0).collect();
    // Two changes are known after the third pass.
    assert!(
        convolutions[3..].iter().all(|each| *each <= 12.0 && *each < convolutions[1]),
        "{convolutions:?}"
    );
}

#[test]
fn the_volume_is_archards_and_the_ledger_balances() {
    let kept = run_in(1.5e9, 60, Acceleration::default().with_max_wear(20e-9));
    let before = rough(1.5e9, 16);
    let before = [&before.lower.heights, &before.upper.heights];
    for (body, before) in before.into_iter().enumerate() {
        let mut lost = 0.0;
        for (index, pass) in kept.passes.iter().enumerate() {
            let worn = pass.lost("wear")[body];
            let expected = 4e-15 * kept.force(index) * 4.0 * PITCH * pass.represents() as f64;
            // Between extrapolations the load is met within its tolerance, and so is the volume of the
            // extrapolated passes.
            let within = if pass.represents() == 1 { 1e-12 } else { 3e-4 };
            assert!((worn / expected - 1.0).abs() < within, "{worn:e}, {expected:e}");
            lost += worn + pass.lost("plastic")[body];
        }
        let sign = [-1.0, 1.0][body];
        let fell = sign * (heights(&kept)[body] - before).sum() * PITCH * PITCH;
        assert!((fell / lost - 1.0).abs() < 1e-9, "{fell:e}, {lost:e}");
    }
}

fn growing() -> Film {
    Film::new(zddp(2e-6, 0.0), 10e-9, None).unwrap()
}

/// Flat bodies: pressure and film are uniform.
fn flat_film(passes: usize, jump: usize, law: FilmLaw) -> f64 {
    let grid = Grid::new([8, 8], [PITCH; 2]).unwrap();
    let material = steel(f64::INFINITY);
    let flat = || Form::Flat.on(&grid).unwrap();
    let pair = Pair::new(flat(), flat(), [&material, &material]).unwrap();
    let control = Control::Load(1e9 * grid.area());
    let motion =
        Motion::new(SLIDE, control).with_passes(passes).with_stride(4).with_load_control(LoadControl::Step);
    let films = Films::new([Some(Film::new(law, 10e-9, None).unwrap()), None], &pair).unwrap();
    let acceleration = Acceleration::default().with_tolerance(1e9).with_max_jump(jump);
    let changes = Changes::by(films).with_bulk([373.15; 2]).with_acceleration(acceleration);
    let kept = Kept::run(changing(pair, motion, changes));
    let film = &kept.last().lower.state[FILM].values;
    let mean = film.mean().unwrap();
    assert!(film.iter().all(|f| *f >= 0.0 && (f - mean).abs() <= 1e-9 * mean));
    // The surface rises by the growth of the film.
    let rise = heights(&kept)[0].mean().unwrap();
    assert!((rise - mean).abs() <= 1e-9 * mean, "{rise:e}, {mean:e}");
    mean
}

/// A film that is removed faster than it grows is used up. Its cell stays bare, with a thickness of 0, until
/// growth is faster again. Compared with steps of a thousandth of a pass.
#[test]
fn a_film_is_never_below_0_over_any_jump() {
    let (x, most, c3) = (1e-13, 10e-9, 4e-9);
    let growth = 1.380_649e-23 * 373.15 / 6.626_070_15e-34 * x;
    for c4 in [50.0, 3.0] {
        let law = FilmLaw::MechanoChemical { x, c3, c4 };
        for passes in [1, 2000, 30_000, 60_000, 200_000] {
            let time = passes as f64 * 8.0 * PITCH / 0.5;
            let steps = 400_000;
            let dt = time / f64::from(steps);
            let (mut grown, mut lost) = (0.0, 0.0_f64);
            for _ in 0..steps {
                grown += growth * dt * (most - grown);
                lost = (lost + c4 * dt * (c3 - lost)).min(grown);
            }
            let expected = grown - lost;
            for jump in [64, 100_000] {
                if passes > 100 * jump {
                    continue;
                }
                let found = flat_film(passes, jump, law);
                let off = (found - expected).abs();
                assert!(off < 1e-4 * most, "{c4}: {passes} passes by {jump}: {found:e}, {expected:e}");
            }
        }
    }
}

/// Removes a nanometre from every cell of the lower body in a pass, for any extrapolation.
struct Once;

impl Law for Once {
    fn name(&self) -> &str {
        "once"
    }

    fn repeats(&self) -> bool {
        false
    }

    fn add(&self, _: &Pair, _: &ContactCells, _: &mut [Vec<Field>; 2]) {}

    fn advance(&self, _: &mut Pair, sums: &[Vec<Field>; 2], _: f64) -> [Field; 2] {
        [sums[0][0].mapv(|_| 1e-9), sums[1][0].clone()]
    }
}

#[test]
fn a_law_that_does_not_repeat_acts_once_in_a_jump_wherever_it_is_added() {
    let motion = Motion::new(SLIDE, Control::Load(0.05)).with_passes(20).with_stride(4);
    let changes = Changes::by(archard([4e-15; 2])).with_law(Once).with_acceleration(Acceleration::default());
    // Its volume counts like plastic deformation: the wear of an extrapolation must exceed it.
    let kept = Kept::run(changing(rough(f64::INFINITY, 16), motion, changes));
    assert_eq!(represented(&kept), 20);
    let volume = 256.0 * PITCH * PITCH * 1e-9;
    assert!(kept.passes.iter().all(|pass| (pass.lost("once")[0] / volume - 1.0).abs() < 1e-9));
    assert!(kept.passes.iter().all(|pass| pass.represents() == 1));
}

#[test]
fn what_is_not_accelerated_keeps_nothing_for_jumps() {
    for (acceleration, keeps) in [(Acceleration::NONE, false), (Acceleration::default(), true)] {
        let motion = Motion::new(SLIDE, Control::Load(0.05)).with_passes(2).with_stride(4);
        let changes = Changes::by(archard([4e-15; 2])).with_acceleration(acceleration);
        let kept = Kept::run(changing(rough(f64::INFINITY, 16), motion, changes));
        assert!(kept.warm_starts.len() == 2);
        assert!(kept.warm_starts.iter().all(|warm| warm.extrapolation.is_some() == keeps));
    }
}

/// A pass with one position over the whole length of surfaces that are pressed flat. The wear is computed by
/// the law, or by the caller as an explicit step. Returns the amplitude of the checkerboard mode of the
/// pressures over their mean, after `passes` passes.
fn checkerboard(wear: f64, passes: usize, by_law: bool) -> f64 {
    const CELLS: usize = 16;
    let grid = Grid::new([CELLS, CELLS], [PITCH; 2]).unwrap();
    let steel = steel(f64::INFINITY);
    let alternating = |i: usize, j: usize| if (i + j).is_multiple_of(2) { 1.0 } else { -1.0 };
    // A checkerboard surface whose pressures alternate by a thousandth of the mean, which is E*/1000.
    let flat = Form::Flat.on(&grid).unwrap();
    let pair = Pair::new(flat.clone(), flat, [&steel; 2]).unwrap();
    let (modulus, compliance_of_grid) = (pair.modulus(), chequered_softness(&pair));
    let mut pair = pair;
    let depth = 1e-6 * modulus * compliance_of_grid;
    pair.lower.heights = Field::from_shape_fn(grid.shape, |(i, j)| depth * alternating(i, j));
    let length = CELLS as f64 * PITCH;
    let coefficient = wear * 2.0 * compliance_of_grid / (2.0 * length);
    let motion = Motion::new(SLIDE, Control::Load(1e-3 * modulus * grid.area()))
        .with_passes(passes)
        .with_stride(CELLS)
        .with_load_control(LoadControl::Step);
    let params = Params::default().with_tolerance(1e-9);
    let mut simulation = Simulation::new(pair, Boundary::PERIODIC, motion, params).unwrap();
    if by_law {
        simulation = simulation.with_changes(Changes::by(archard([coefficient; 2]))).unwrap();
    }
    let mut left = f64::NAN;
    for _ in 0..passes {
        let mut pass = simulation.solve(&()).unwrap();
        let pressure = pass.contacts()[0].pressure_field(CELLS);
        left = pressure.indexed_iter().map(|((i, j), p)| p * alternating(i, j)).sum::<f64>() / pressure.sum();
        if !by_law {
            let depth = pressure * (coefficient * length);
            pass.remove("wear", &[depth.clone(), depth]);
        }
        simulation.finish(pass, &(), &mut []).unwrap();
    }
    left.abs()
}

/// Displacement of a periodic surface under a checkerboard pressure of 1: 2/E*q at the shortest wave on the
/// grid.
fn chequered_softness(pair: &Pair) -> f64 {
    2.0 * PITCH / (pair.modulus() * PI * 2.0_f64.sqrt())
}

/// A law from outside, as one in Python: its depths are those of a single pass, and are taken off for each
/// pass that is represented.
#[test]
fn a_custom_law_is_extrapolated_as_one_that_is_built_in() {
    const PASSES: usize = 400;
    let coefficient = 4e-16;
    let run = |acceleration: Acceleration| {
        let motion = Motion::new(SLIDE, Control::Load(0.05)).with_passes(PASSES).with_stride(4);
        let changes = Changes::default().with_acceleration(acceleration);
        let mut simulation = changing(rough(f64::INFINITY, 16), motion, changes);
        let mut kept = Kept::default();
        while simulation.represented() < PASSES {
            let mut pass = simulation.solve(&()).unwrap();
            let mut depth = [16; 2].map(|n| Field::zeros([n, n]));
            let distance = 4.0 * PITCH;
            for contact in pass.contacts() {
                for (cell, pressure) in &contact.pressure {
                    let cells = pass.pair().cells_of_bodies(&contact.position, *cell as usize);
                    for (depth, cell) in depth.iter_mut().zip(cells) {
                        depth.as_slice_mut().unwrap()[cell] += coefficient * pressure * distance;
                    }
                }
            }
            pass.remove("wear", &depth);
            simulation.finish(pass, &(), &mut [&mut kept]).unwrap();
        }
        kept
    };
    let all = run(Acceleration::NONE);
    let some = run(Acceleration::default().with_max_wear(1e-9));
    assert!(represented(&some) == PASSES && some.passes.len() < PASSES / 4, "{}", some.passes.len());
    let volume = |kept: &Kept| kept.passes.iter().map(|pass| pass.lost("wear")[0]).sum::<f64>();
    // Archard: k W s, where each of the passes slides over the length of the grid.
    let expected = coefficient * 0.05 * 16.0 * PITCH * PASSES as f64;
    for kept in [&all, &some] {
        assert!((volume(kept) / expected - 1.0).abs() < 1e-3, "{} {expected}", volume(kept));
    }
    // No extrapolation takes much more than its limit from a cell, and the heights are off by no more than is
    // estimated.
    for (every, some_of_them) in heights(&all).into_iter().zip(heights(&some)) {
        let off = largest(&(every - some_of_them));
        assert!(off < error(&some), "{off:e} {:e}", error(&some));
    }
}

/// The explicit step oscillates above the bound (k₁ + k₂) Σ|Δs| = 2λ, until every second cell has no
/// pressure. If a law wears more, a pass is solved together with its wear, and does not oscillate.
#[test]
fn beyond_the_stability_bound_pressures_swing_unless_a_pass_is_solved_with_its_wear() {
    let first = checkerboard(0.9, 1, false);
    assert!((first / 1e-3 - 1.0).abs() < 1e-3, "{first:e}");
    // A pass multiplies a checkerboard pressure by |1 − 2 · 0.9|, and by |1 − 2 · 1.1|.
    for (wear, by_law) in [(0.9, false), (0.9, true)] {
        let left = checkerboard(wear, 21, by_law);
        assert!((left / first / 0.8_f64.powi(20) - 1.0).abs() < 0.01, "{left:e}");
    }
    let swung = checkerboard(1.1, 61, false);
    assert!(swung > 0.5, "{swung}");
    // An implicit pass multiplies it by 1/(1 + 2 · 1.1).
    let worn = checkerboard(1.1, 6, true);
    let expected = 1e-3 / 3.2_f64.powi(6);
    assert!((worn / expected - 1.0).abs() < 0.01, "{worn:e}, expected {expected:e}");
}

/// Some passes of a body in zinc dialkyl dithiophosphate against a body that slides over it at this speed
/// with friction, heated in every `every`-th pass, or in none for 0.
fn heated(speed: f64, passes: usize, every: usize) -> Kept {
    let friction = Friction::coulomb(0.1).unwrap().with_coupling(Coupling::None);
    let strategy = Strategy::Shift { speed_lower: 0.0, speed_upper: speed };
    let motion =
        Motion::new(strategy, Control::Load(0.05)).with_passes(passes).with_stride(4).with_friction(friction);
    let pair = rough(1.5e9, 16);
    let films = Films::new([Some(growing()), None], &pair).unwrap();
    let steel = Thermal::new(46.0, 460.0, 7850.0).unwrap();
    let changes = Changes::by(films).with_bulk([373.15; 2]);
    let changes = if every > 0 { changes.with_heat([steel; 2], every) } else { changes };
    Kept::run(changing(pair, motion, changes))
}

#[test]
fn friction_heats_the_cells_and_films_see_it() {
    let run = |speed: f64, every: usize| heated(speed, 2, every);
    let [cold, slow, fast] = [run(0.5, 0), run(0.5, 1), run(5.0, 1)];
    let warmest = |kept: &Kept| kept.passes[1].running.unwrap().max_flash_temperature - 373.15;
    assert_eq!(warmest(&cold), 0.0);
    assert!(
        warmest(&slow) > 0.5 && warmest(&fast) > 3.0 * warmest(&slow),
        "{} {}",
        warmest(&slow),
        warmest(&fast)
    );
    // The work is that of friction, for any speed: μ Σ W Δs.
    for kept in [&slow, &fast] {
        let work = kept.passes[0].running.unwrap().friction_work;
        assert!((work / (0.1 * kept.force(0) * 4.0 * PITCH) - 1.0).abs() < 1e-12);
    }
    // In the same time a warm film grows more.
    let grown = |kept: &Kept| kept.passes[1].running.unwrap().laws.mean_film_lower;
    assert!(grown(&slow) > 1.001 * grown(&cold), "{:e} {:e}", grown(&slow), grown(&cold));
}

/// Between passes with a computed flash temperature, the cells have the temperature of the last of these.
#[test]
fn what_is_heated_in_some_passes_grows_films_in_all() {
    let [never, each, third] = [0, 1, 3].map(|every| heated(5.0, 7, every));
    let grown = |kept: &Kept| kept.passes[6].running.unwrap().laws.mean_film_lower;
    let [cold, all, some] = [&never, &each, &third].map(grown);
    assert!(
        all > 1.05 * cold && (some / all - 1.0).abs() < 0.1 * (all / cold - 1.0),
        "{cold:e} {all:e} {some:e}"
    );
    assert!(some != all);
    let warmest = |kept: &Kept, pass: usize| kept.passes[pass].running.unwrap().max_flash_temperature;
    assert_eq!(warmest(&third, 0), warmest(&each, 0));
    let between = (warmest(&third, 1) - 373.15) / (warmest(&each, 1) - 373.15);
    assert!((0.3..1.0 + 1e-9).contains(&between), "{between}");
    let body = &third.last().lower;
    assert!(body.state[FLASH].values.iter().any(|rise| *rise > 0.0));
    assert!(!each.last().lower.state.contains_key(FLASH));
}

/// A pass solved together with its wear has the pressures of the bodies after it: those at the same approach
/// on these bodies.
#[test]
fn a_pass_solved_with_its_wear_presses_the_bodies_that_it_leaves() {
    let params = Params::default().with_tolerance(1e-9);
    for (strategy, boundary, hardness) in [
        (SLIDE, Boundary::PERIODIC, f64::INFINITY),
        (Strategy::Overlap, Boundary::FREE, f64::INFINITY),
        (Strategy::Shift { speed_lower: 0.2, speed_upper: 0.5 }, Boundary::PERIODIC, f64::INFINITY),
    ] {
        let pair = rough(hardness, 16);
        // Thirty times the bound for a cell in contact all the time.
        let coefficient = 30.0 * 2.0 * 0.45 * PITCH / pair.modulus() / (2.0 * 16.0 * PITCH);
        let motion = Motion::new(strategy, Control::Load(0.02))
            .with_stride(4)
            .with_speed((strategy == Strategy::Overlap).then_some(0.5));
        let begin = |pair: Pair, motion: Motion| Simulation::new(pair, boundary, motion, params).unwrap();
        let worn = begin(pair.clone(), motion)
            .with_changes(Changes::by(archard([coefficient; 2])))
            .unwrap()
            .solve(&())
            .unwrap();
        let load =
            worn.contacts().iter().map(|contact| contact.load).sum::<f64>() / worn.contacts().len() as f64;
        assert!((load / 0.02 - 1.0).abs() < 1e-8, "{load}");
        assert!(worn.record().running.unwrap().error_estimate > 0.0);
        let approach = Control::Approach(worn.contacts()[0].approach);
        let again = begin(worn.pair().clone(), motion.with_control(approach)).solve(&()).unwrap();
        let most =
            worn.contacts().iter().flat_map(|c| &c.pressure).fold(0.0, |most: f64, (_, p)| most.max(*p));
        for (found, expected) in worn.contacts().iter().zip(again.contacts()) {
            let difference = found.pressure_field(16) - expected.pressure_field(16);
            let off = largest(&difference);
            assert!(off < 1e-4 * most, "{strategy:?}: {off:e} of {most:e}");
        }
        // The same volume as with explicit wear, but another distribution: k Σ W Δs.
        let distance = motion.sliding_distance_of(4.0, PITCH);
        let volume = coefficient * load * distance * worn.contacts().len() as f64;
        let [lower, upper] = worn.record().lost("wear");
        assert!(
            (lower / volume - 1.0).abs() < 1e-10 && (upper / volume - 1.0).abs() < 1e-10,
            "{lower:e} {volume:e}"
        );
    }
}

/// Flat periodic bodies that pass over each other: the film has lost k p s, whether each pass is computed or
/// only a few.
#[test]
fn a_solid_lubricant_lasts_as_long_as_its_thickness_over_k_p() {
    let grid = Grid::new([16, 8], [PITCH; 2]).unwrap();
    let flat = || Form::Flat.on(&grid).unwrap();
    let (thickness, k, pressure, passes) = (50e-9, 1e-15, 0.1e9, 40);
    // The lower body slides one length under the same pressure in each pass.
    let lost = k * pressure * passes as f64 * 16.0 * PITCH;
    for (thickness, left) in [(thickness, thickness - lost), (0.6 * lost, 0.0)] {
        for acceleration in [Acceleration::NONE, Acceleration::default()] {
            let pair = Pair::new(flat(), flat(), [&steel(f64::INFINITY); 2]).unwrap();
            let film = Film::new(FilmLaw::SolidLubricant { wear: k }, thickness, None).unwrap();
            let films = Films::new([Some(film), None], &pair).unwrap();
            let load = Control::Load(pressure * grid.area());
            let motion = Motion::new(SLIDE, load)
                .with_passes(passes)
                .with_stride(4)
                .with_load_control(LoadControl::Step);
            let changes = Changes::by(films).with_acceleration(acceleration);
            let kept = Kept::run(changing(pair, motion, changes));
            let film = &kept.last().lower.state[FILM].values;
            assert!(
                film.iter().all(|f| (f - left).abs() < 1e-6 * thickness),
                "{:e} of {left:e}",
                film[[0, 0]]
            );
        }
    }
}

/// A round of a shift is as long as the bodies, also if the stride does not divide their columns.
#[test]
fn a_round_of_a_shift_has_the_length_of_the_bodies_at_any_stride() {
    const COEFFICIENT: f64 = 1e-15;
    let friction = Friction::coulomb(0.3).unwrap().with_coupling(Coupling::None);
    for (columns, stride, path, strokes) in [
        (17, 4, Path::OneWay, 1.0),
        (16, 4, Path::OneWay, 1.0),
        (7, 10, Path::OneWay, 1.0),
        (17, 5, Path::Reciprocating, 2.0),
    ] {
        let grid = Grid::new([columns, 8], [PITCH; 2]).unwrap();
        let wave = |i: usize| 20e-9 * (std::f64::consts::TAU * i as f64 / columns as f64).cos();
        let wavy = Topography::new(grid, Field::from_shape_fn(grid.shape, |(i, _)| wave(i))).unwrap();
        let pair = Pair::new(Form::Flat.on(&grid).unwrap(), wavy, [&steel(f64::INFINITY); 2]).unwrap();
        let motion =
            Motion::new(Strategy::Shift { speed_lower: 0.01, speed_upper: -0.02 }, Control::Load(0.1))
                .with_load_control(LoadControl::Step)
                .with_stride(stride)
                .with_path(path)
                .with_passes(2)
                .with_friction(friction);
        let mut simulation = changing(pair, motion, Changes::by(archard([COEFFICIENT; 2])));
        let mut lost = [0.0; 2];
        for pass in 1..=2 {
            let solved = simulation.solve(&()).unwrap();
            let record = solved.record();
            let running = record.running.unwrap();
            // The faster surface goes round at 20 mm/s, while both slide by half as much again.
            let way = f64::from(pass) * strokes * columns as f64 * PITCH;
            lost = [0, 1].map(|body| lost[body] + record.lost("wear")[body]);
            for (found, expected) in [
                (running.time, way / 0.02),
                (running.distance, 1.5 * way),
                (running.friction_work, 0.03 * 1.5 * way / f64::from(pass)),
                (lost[0], COEFFICIENT * 0.1 * 1.5 * way),
                (lost[1], COEFFICIENT * 0.1 * 1.5 * way),
            ] {
                assert!((found / expected - 1.0).abs() < 1e-9, "{columns}, {stride}: {found:e} {expected:e}");
            }
            simulation.finish(solved, &(), &mut []).unwrap();
        }
    }
}

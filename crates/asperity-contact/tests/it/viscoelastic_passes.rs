//! Passes of viscoelastic bodies against Boltzmann's superposition of dense equations, steady sliding and
//! elastic bodies.

use asperity_contact::material::Material;
use asperity_contact::motion::{Changes, LoadControl, Motion, Pair, Path, Simulation, SolvedPass, Strategy};
use asperity_contact::operator::{Boundary, Operators};
use asperity_contact::solver::{Control, Friction, Params};
use asperity_contact::viscoelastic::{Creep, Relaxation, RelaxationTerm, solve_steady};
use asperity_contact::{Field, Grid};
use asperity_surface::{Amplitude, Topography};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::support::dense::{dense, mean_compliance, relaxation};
use crate::support::{archard, self_affine};

const ROUND: Strategy = Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 };
const FINE: Params = Params::new().with_tolerance(1e-10);

/// The loads of a body so far: the time at the begin and at the end of each step, and the change of the
/// elastic displacement in it.
struct Loads {
    creep: Creep,
    matrix: Vec<Vec<f64>>,
    steps: Vec<(f64, f64, Vec<f64>)>,
    borne: Vec<f64>,
    displacement: Vec<f64>,
    pressure: Vec<f64>,
}

impl Loads {
    fn new(creep: &Creep, grid: Grid, boundary: Boundary) -> Self {
        let cells = grid.cells();
        let mut operator = Operators::new(grid, 1.0, boundary).on(grid.shape);
        let column = |cell: usize| {
            let (mut unit, mut displacement) = (grid.zeros(), grid.zeros());
            unit.as_slice_mut().unwrap()[cell] = 1.0;
            operator.apply(&unit, &mut displacement);
            displacement.into_iter().collect::<Vec<_>>()
        };
        let matrix = (0..cells).map(column).collect();
        let nothing = || vec![0.0; cells];
        Self {
            creep: creep.clone(),
            matrix,
            steps: Vec::new(),
            borne: nothing(),
            displacement: nothing(),
            pressure: nothing(),
        }
    }

    /// Displacement at the end of a step in which the body bears no more than before.
    fn history(&self, end: f64) -> Vec<f64> {
        let mut sum = vec![0.0; self.borne.len()];
        for (begin, stop, change) in &self.steps {
            let j = mean_compliance(&self.creep, end, *begin, *stop);
            sum.iter_mut().zip(change).for_each(|(sum, change)| *sum += j * change);
        }
        sum
    }

    /// Adds a step with this pressure at its end; returns the work per area of a cell.
    fn bear(&mut self, begin: f64, end: f64, pressure: Vec<f64>) -> f64 {
        let borne: Vec<f64> =
            self.matrix.iter().map(|row| row.iter().zip(&pressure).map(|(e, p)| e * p).sum()).collect();
        let change = borne.iter().zip(&self.borne).map(|(now, before)| now - before).collect();
        self.steps.push((begin, end, change));
        self.borne = borne;
        let displacement = self.history(end);
        let both = displacement.iter().zip(&self.displacement).zip(pressure.iter().zip(&self.pressure));
        let work = both.map(|((u1, u0), (p1, p0))| 0.5 * (p0 + p1) * (u1 - u0)).sum();
        (self.displacement, self.pressure) = (displacement, pressure);
        work
    }
}

#[test]
fn random_passes_are_those_of_boltzmanns_superposition() {
    let mut random = ChaCha8Rng::seed_from_u64(11);
    for case in 0..40 {
        let is_shift = case % 3 == 0;
        let width = random.random_range(2..5);
        let lower = random.random_range(4..8);
        let upper = if is_shift { lower } else { random.random_range(3..8) };
        let pitch = [1.0, random.random_range(0.5..2.0)];
        let [below, above] = [lower, upper].map(|columns| Grid::new([columns, width], pitch).unwrap());
        let (boundary, strategy) =
            if is_shift { (Boundary::PERIODIC, ROUND) } else { (Boundary::FREE, Strategy::Overlap) };
        let mut rough = |grid: Grid| {
            let heights = Field::from_shape_simple_fn(grid.shape, || random.random_range(0.0..1.0));
            Topography::new(grid, heights).unwrap()
        };
        let surfaces = [rough(below), rough(above)];
        // E* = 1 for two bodies with E₀ = 1.5.
        let soft = Material::elastic(1.5, 0.5).unwrap();
        let mut creeping = || {
            let body = relaxation(&mut random);
            let terms =
                body.terms().iter().map(|term| RelaxationTerm { modulus: 1.5 * term.modulus, ..*term });
            Relaxation::new(1.5, terms.collect::<Vec<_>>()).unwrap()
        };
        let bodies = match case % 4 {
            0 => [Some(creeping()), None],
            1 => [None, Some(creeping())],
            _ => [Some(creeping()), Some(creeping())],
        };
        let [one, other] = surfaces;
        let pair = Pair::new(one, other, [&soft, &soft]).unwrap();
        let pair = pair.with_relaxation([&soft, &soft], bodies).unwrap();
        let pause = if case % 5 < 2 { 0.0 } else { random.random_range(0.1..3.0) };
        let path = if case % 7 == 0 { Path::Reciprocating } else { Path::OneWay };
        let deep = if is_shift { -0.6..-0.35 } else { -0.3..0.3 };
        let approach = random.random_range(deep);
        let motion = Motion::new(strategy, Control::Approach(approach))
            .with_passes(3)
            .with_path(path)
            .with_speed(random.random_range(0.3..3.0))
            .with_pause(pause)
            .with_stride(if is_shift { random.random_range(1..=lower + 1) } else { 1 });
        // A round of a shift is as long as the bodies, whatever the stride: its last step ends where the next
        // round begins.
        let speed = motion.time_of(1.0, 1.0).recip();
        let positions = motion.positions([lower, upper], width, 1).len();
        let strokes = if path == Path::Reciprocating { 2 } else { 1 };
        let lengths: Vec<f64> = (0..positions)
            .map(|step| match step % (positions / strokes) {
                0 if is_shift => (lower - (positions / strokes - 1) * motion.stride.min(lower)) as f64,
                _ => motion.stride.min(lower) as f64,
            })
            .collect();
        assert!(!is_shift || lengths.iter().sum::<f64>() == (strokes * lower) as f64);
        let apart = !is_shift || pause > 0.0;
        let creeps = pair.creep().unwrap().clone();
        let grids = [below, above];
        let mut loads = [0, 1].map(|body| Loads::new(&creeps[body], grids[body], boundary));
        let mut simulation = Simulation::new(pair.clone(), boundary, motion, FINE).unwrap();
        let mut now = 0.0;
        for pass in 0..3 {
            if apart {
                for loads in &mut loads {
                    loads.bear(now, now, vec![0.0; loads.borne.len()]);
                }
                now += pause;
                loads.iter_mut().for_each(|loads| loads.displacement = loads.history(now));
            }
            let solved = simulation.solve(&()).unwrap();
            for (step, contact) in solved.contacts().iter().enumerate() {
                let position = contact.position;
                let placements = pair.placements(&position);
                let end = now + lengths[step] / speed;
                let mut opened = pair.initial_gap(&position);
                let mut matrix = vec![vec![0.0; opened.len()]; opened.len()];
                for (loads, placement) in loads.iter().zip(&placements) {
                    // What is borne already does not change in this step.
                    let j = mean_compliance(&loads.creep, end, now, end);
                    let history = loads.history(end);
                    let left: Vec<f64> = history.iter().zip(&loads.borne).map(|(u, l)| u - j * l).collect();
                    for (cell, gap) in opened.iter_mut().enumerate() {
                        *gap += left[placement.cell(cell)];
                        for (other, entry) in matrix[cell].iter_mut().enumerate() {
                            *entry += j * loads.matrix[placement.cell(cell)][placement.cell(other)];
                        }
                    }
                }
                let field = contact.pressure_field(width);
                let p = field.as_slice().unwrap();
                if boundary == Boundary::FREE || p.contains(&0.0) {
                    let expected = dense(&matrix, opened.as_slice().unwrap(), approach);
                    let largest = expected.iter().copied().fold(1e-3, f64::max);
                    let error = p.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                    assert!(error < 1e-6 * largest, "case {case}, pass {pass}, step {step}: {error}");
                }
                let both = loads.iter_mut().zip(&placements);
                let work: f64 = both
                    .map(|(loads, placement)| {
                        loads.bear(now, end, placement.onto(&field).into_iter().collect())
                    })
                    .sum();
                let drag = solved.steps()[step].drag.unwrap().drag;
                let pressed = is_shift && step == 0 && (apart || pass == 0);
                let wanted = below.cell_area() * work / lengths[step];
                assert!(
                    if pressed {
                        drag.is_nan()
                    } else {
                        (drag - wanted).abs() <= 1e-6 * (contact.load + wanted.abs())
                    },
                    "case {case}, pass {pass}, step {step}: {drag}, expected {wanted}"
                );
                now = end;
            }
            if !is_shift {
                // The bodies come apart in a step.
                let end = now + 1.0 / speed;
                let leave = |loads: &mut Loads| loads.bear(now, end, vec![0.0; loads.borne.len()]);
                let leaving = below.cell_area() * loads.iter_mut().map(leave).sum::<f64>();
                now = end;
                let drags: f64 = solved.steps().iter().map(|step| step.drag.unwrap().drag).sum();
                let mean = (drags + leaving) / solved.steps().len() as f64;
                let found = solved.record().drag.unwrap().mean_drag;
                assert!(
                    (found - mean).abs() <= 1e-6 * (drags.abs() + leaving.abs()),
                    "case {case}, pass {pass}: {found}, expected {mean}"
                );
                assert!(found >= 0.0, "case {case}, pass {pass}: {found}");
            }
            simulation.finish(solved, &(), &mut []).unwrap();
        }
    }
}

/// A rigid bump over a smooth rubber with E₀ = 1 MPa and ten times as much as glass, on a period.
fn bump(grid: Grid, time: f64) -> Pair {
    let wave =
        |axis: usize, n: usize| (std::f64::consts::TAU * grid.centre(axis, n) / grid.extent()[axis]).cos();
    let heights =
        Field::from_shape_fn(grid.shape, |(i, j)| 0.02 * grid.extent()[0] * (wave(0, i) + wave(1, j)));
    over_rubber(Topography::new(grid, heights).unwrap(), time)
}

fn over_rubber(upper: Topography, time: f64) -> Pair {
    let grid = *upper.grid();
    let flat = Topography::new(grid, grid.zeros()).unwrap();
    let rubber = Material::elastic(1e6, 0.5).unwrap();
    let rigid = Material::elastic(f64::INFINITY, 0.3).unwrap();
    let relaxation = Relaxation::new(1e6, [RelaxationTerm { modulus: 9e6, time }]).unwrap();
    let materials = [&rubber, &rigid];
    Pair::new(flat, upper, materials).unwrap().with_relaxation(materials, [Some(relaxation), None]).unwrap()
}

fn last(pair: &Pair, motion: Motion) -> SolvedPass {
    let mut simulation = Simulation::new(pair.clone(), Boundary::PERIODIC, motion, FINE).unwrap();
    for _ in 1..motion.passes {
        let solved = simulation.solve(&()).unwrap();
        simulation.finish(solved, &(), &mut []).unwrap();
    }
    simulation.solve(&()).unwrap()
}

#[test]
fn passes_in_a_round_become_steady_sliding_with_the_second_order_of_the_step() {
    let grid = Grid::new([64, 16], [1e-6, 4e-6]).unwrap();
    // The memory reaches over twenty cells, so that it ends within some passes.
    let pair = bump(grid, 2e-6);
    let load = 2e4 * grid.area();
    let mut operator = pair.sliding_steadily(Boundary::PERIODIC, 1.0).unwrap();
    let gap = pair.initial_gap(&pair.at_rest());
    let steady = solve_steady(&mut operator, &gap, Control::Load(load), None, &FINE, &()).unwrap();
    for load_control in [LoadControl::Step, LoadControl::Pass] {
        let errors = [4, 2, 1].map(|stride| {
            let motion = Motion::new(ROUND, Control::Load(load)).with_load_control(load_control);
            let found = last(&pair, motion.with_passes(5).with_stride(stride).with_load_tolerance(1e-10));
            let record = found.record();
            let drag = record.drag.unwrap();
            assert!((drag.drag_coefficient / (drag.mean_drag / load) - 1.0).abs() < 1e-9);
            assert!((record.approach / steady.solution.approach - 1.0).abs() < 1e-2);
            drag.mean_drag / steady.drag - 1.0
        });
        let order = |k: usize| (errors[k] / errors[k + 1]).log2();
        assert!(errors[2].abs() < 0.01 && order(0) > 1.6 && order(1) > 1.7, "{load_control:?}: {errors:?}");
    }
}

#[test]
fn slow_passes_are_those_of_the_relaxed_bodies_and_fast_ones_those_of_glass() {
    let grid = Grid::new([24, 12], [1e-6; 2]).unwrap();
    let surface = |seed: u64| self_affine(&grid, Amplitude::Sdq(0.1), Some(6e-6), seed);
    let control = Control::Load(3e4 * grid.area());
    let motion = Motion::new(Strategy::Overlap, control).with_stride(2).with_load_tolerance(1e-9);
    for (speed, young) in [(1e-6, 1e6), (1e6, 10e6)] {
        let rubber = Material::elastic(1e6, 0.5).unwrap();
        let relaxation =
            || Some(Relaxation::new(1e6, [RelaxationTerm { modulus: 9e6, time: 1e-6 }]).unwrap());
        let pair = Pair::new(surface(1), surface(2), [&rubber, &rubber]).unwrap();
        let pair = pair.with_relaxation([&rubber, &rubber], [relaxation(), relaxation()]).unwrap();
        let elastic = Material::elastic(young, 0.5).unwrap();
        let elastic = Pair::new(surface(1), surface(2), [&elastic, &elastic]).unwrap();
        let solve = |pair: Pair| {
            Simulation::new(pair, Boundary::FREE, motion.with_speed(speed), FINE).unwrap().solve(&()).unwrap()
        };
        let (found, expected) = (solve(pair), solve(elastic));
        assert!(found.record().drag.unwrap().drag_coefficient.abs() < 1e-5);
        for (a, b) in found.contacts().iter().zip(expected.contacts()) {
            let [p, q] = [a, b].map(|contact| contact.pressure_field(12));
            let largest = b.max_pressure();
            let error = p.iter().zip(&q).map(|(p, q)| (p - q).abs()).fold(0.0, f64::max);
            assert!(error <= 2e-5 * largest, "{speed}: {}", error / largest);
        }
    }
}

#[test]
fn a_pause_lets_the_body_recover() {
    let grid = Grid::new([24, 12], [1e-6; 2]).unwrap();
    let pair = bump(grid, 20e-6);
    let motion = Motion::new(ROUND, Control::Load(2e4 * grid.area())).with_passes(3).with_stride(2);
    // After a long time apart the body is a new one.
    let approaches = |pause: f64| {
        let motion = motion.with_pause(pause).with_load_control(LoadControl::Step);
        let mut simulation = Simulation::new(pair.clone(), Boundary::PERIODIC, motion, FINE).unwrap();
        [(); 2].map(|()| {
            let solved = simulation.solve(&()).unwrap();
            let approach = solved.steps()[3].approach;
            simulation.finish(solved, &(), &mut []).unwrap();
            approach
        })
    };
    let [[fresh, after_long], [_, after_short]] = [approaches(1.0), approaches(1e-6)];
    assert!((after_long / fresh - 1.0).abs() < 1e-8, "{fresh} {after_long}");
    assert!((after_short / fresh - 1.0).abs() > 1e-3, "{fresh} {after_short}");
}

#[test]
fn rubber_wears_in_passes_by_what_its_pressures_say_and_not_by_more_than_they_bear() {
    let grid = Grid::new([24, 12], [1e-6; 2]).unwrap();
    let pair = bump(grid, 20e-6);
    let load = 2e4 * grid.area();
    let motion = Motion::new(ROUND, Control::Load(load)).with_passes(3).with_load_control(LoadControl::Step);
    let worn = |k: f64| {
        Simulation::new(pair.clone(), Boundary::PERIODIC, motion, FINE)
            .unwrap()
            .with_changes(Changes::by(archard([k, 0.0])))
            .unwrap()
    };
    let k = 1e-12;
    let mut simulation = worn(k);
    let mut volume = 0.0;
    for _ in 0..3 {
        let solved = simulation.solve(&()).unwrap();
        volume += solved.record().lost("wear")[0];
        assert!(solved.record().drag.unwrap().mean_drag > 0.0);
        simulation.finish(solved, &(), &mut []).unwrap();
    }
    let wanted = 3.0 * k * load * grid.extent()[0];
    assert!((volume / wanted - 1.0).abs() < 1e-9, "{volume}, expected {wanted}");
    let sunk = -simulation.pair().lower.heights.sum() * grid.cell_area();
    assert!((sunk / wanted - 1.0).abs() < 1e-9, "{sunk}, expected {wanted}");
    let error = worn(1e-7).solve(&()).err().unwrap().to_string();
    assert!(error.contains("so much from bodies that creep"), "{error}");
}

#[test]
fn what_passes_of_viscoelastic_bodies_do_not_support_is_refused() {
    let grid = Grid::new([16, 8], [1e-6; 2]).unwrap();
    let pair = || bump(grid, 1e-6);
    let control = Control::Load(2e4 * grid.area());
    let round = Motion::new(ROUND, control);
    let rubs = round.with_friction(Friction::coulomb(0.3).unwrap());
    let overlap = Motion::new(Strategy::Overlap, control);
    let new = |boundary: Boundary, motion: Motion| {
        Simulation::new(pair(), boundary, motion, Params::default()).map(|_| ())
    };
    assert!(new(Boundary::PERIODIC, round).is_ok() && new(Boundary::FREE, overlap.with_speed(1.0)).is_ok());
    // Shear does not displace an incompressible body on a rigid one normally.
    assert!(new(Boundary::PERIODIC, rubs).is_ok());
    for (what, found) in [
        ("speed of their motion", new(Boundary::FREE, overlap)),
        ("periodic along x", new(Boundary::FREE, round)),
        ("pause", new(Boundary::PERIODIC, round.with_pause(-1.0))),
    ] {
        let error = found.unwrap_err().to_string();
        assert!(error.contains(what), "{what}: {error}");
    }
}

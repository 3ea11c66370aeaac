//! Passes of bodies that attract each other, against dense programs.

use std::sync::Arc;

use crate::adhesion::{Adhesion, History};
use crate::grid::{CellValues, Field, Grid};
use crate::material::Material;
use crate::motion::{Motion, Pair, PlasticUpdate, Position, Simulation, SolvedPass, Strategy};
use crate::operator::{Boundary, PeriodicFft};
use crate::solver::{Bounds, Control, Method, Params, solve_normal};
use crate::surface::Topography;

const SHAPE: [usize; 2] = [24, 8];

/// An elastic body with a bump, and a rigid one with the same bump below it, which passes by. Lengths are in
/// cells, E* = 1.
fn two_asperities(work: f64) -> (Pair, Adhesion) {
    let grid = Grid::new(SHAPE, [1.0, 1.0]).unwrap();
    let bump = |centre: f64| {
        Field::from_shape_fn(SHAPE, |(i, j)| {
            let x = (i as f64 - centre + 12.0).rem_euclid(24.0) - 12.0;
            0.4 * (-(x * x + (j as f64 - 3.5).powi(2)) / 10.0).exp()
        })
    };
    let lower = Topography::new(grid, bump(12.0)).unwrap();
    let upper = Topography::new(grid, 0.8 - bump(3.0)).unwrap();
    let (soft, rigid) =
        (Material::elastic(1.0, 0.0).unwrap(), Material::elastic(f64::INFINITY, 0.0).unwrap());
    let adhesion = Adhesion::new(work, 0.25).unwrap();
    (Pair::new(lower, upper, [&soft, &rigid]).unwrap(), adhesion)
}

fn pass((pair, adhesion): &(Pair, Adhesion), history: History, approach: f64) -> SolvedPass {
    let pair = pair.clone().with_interface(Arc::new(adhesion.with_history(history)));
    let params = Params::new().with_tolerance(1e-7);
    Simulation::new(pair, Boundary::PERIODIC, shift(Control::Approach(approach)), params)
        .unwrap()
        .solve(&())
        .unwrap()
}

/// A pass in which the upper body shifts by its whole length.
fn shift(control: Control) -> Motion {
    Motion::new(Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 }, control)
}

/// Load, energy and force along x of the path, by direct solutions under lagged bounds.
fn dense(pair: &Pair, adhesion: &Adhesion, approach: f64, positions: &[Position]) -> Vec<[f64; 3]> {
    let mut operator = PeriodicFft::new(Grid::new(SHAPE, [1.0, 1.0]).unwrap(), 1.0);
    let params = Params::new().with_method(Method::Direct).with_tolerance(1e-10);
    let gaps: Vec<Field> = positions.iter().map(|position| pair.initial_gap(position)).collect();
    let mut displacement: Option<Field> = None;
    let mut path = Vec::new();
    for (k, gap) in gaps.iter().enumerate() {
        let mut lower = match &displacement {
            Some(u) => (gap + u - approach).mapv(|g| -adhesion.tension(g)),
            None => Field::zeros(SHAPE),
        };
        let solution = loop {
            let bounds = Bounds::up_to(CellValues::Uniform(f64::INFINITY)).above(lower.clone());
            let control = Control::Approach(approach);
            let solution = solve_normal(&mut operator, gap, &bounds, control, None, &params).unwrap();
            let next = solution.gap().mapv(|g| -adhesion.tension(g));
            let change = next.iter().zip(&lower).fold(0.0, |most, (a, b)| f64::max(most, (a - b).abs()));
            if change < 1e-9 * adhesion.max_tension() {
                break solution;
            }
            lower = next;
        };
        let n = gaps.len();
        let slope = (&gaps[(k + 1) % n] - &gaps[(k + n - 1) % n]) * 0.5;
        let force = -(&solution.pressure * &slope).sum();
        let energy = solution.elastic_energy() + solution.gap().mapv(|g| adhesion.energy(g)).sum();
        path.push([solution.load(), energy, force]);
        displacement = Some(solution.displacement);
    }
    path
}

#[test]
fn asperities_that_stick_drag_as_a_dense_program_has_them() {
    let bodies = two_asperities(0.08);
    let (pair, adhesion) = &bodies;
    let approach = -0.12;
    let solved = pass(&bodies, History::Path, approach);
    let positions: Vec<_> = solved.contacts().iter().map(|contact| contact.position).collect();
    let path = dense(pair, adhesion, approach, &positions);
    let size = path.iter().fold(0.0, |most: f64, [load, ..]| most.max(load.abs()));
    for (contact, [load, ..]) in solved.contacts().iter().zip(&path) {
        assert!((contact.load - load).abs() < 1e-4 * size, "{} {load}", contact.load);
        // The field has the tension of open cells, too.
        let pressure = contact.pressure_field(pair.lower.width());
        assert!(pressure.iter().any(|p| *p < 0.0));
        assert!((pair.cell_area() * pressure.sum() / contact.load - 1.0).abs() < 1e-9);
    }
    // The energy lost is the work of the force along the path, less what is stored.
    let work: f64 = path.windows(2).map(|pair| 0.5 * (pair[0][2] + pair[1][2])).sum();
    let lost = work - (path.last().unwrap()[1] - path[0][1]);
    let record = solved.record().interface.unwrap();
    assert!(record.jumps >= 2 && lost > 0.0, "{record:?} {lost}");
    // Losses of less than 1 % of the energy do not count.
    assert!((record.energy_lost / lost - 1.0).abs() < 0.15, "{} {lost}", record.energy_lost);
    assert!((record.adhesive_drag * 24.0 / record.energy_lost - 1.0).abs() < 1e-12);
    // Bodies from afar at each position lose nothing, and the pass says that it depends on the path.
    let alone = pass(&bodies, History::None, approach).record().interface.unwrap();
    assert!(alone.energy_lost == 0.0 && alone.history_difference > 0.01, "{alone:?}");
}

/// With plastic deformation at every position, too, positions follow each other. Here no cell is hard pressed
/// enough to yield.
#[test]
fn the_path_is_followed_when_plastic_deformation_is_applied_at_every_position() {
    let (pair, adhesion) = two_asperities(0.08);
    let pair = pair.with_interface(Arc::new(adhesion.with_history(History::Path)));
    let hard = pair.clone().with_hardness([1e3.into(), f64::INFINITY.into()]).unwrap();
    let loads = |pair: &Pair, update| {
        let motion = shift(Control::Approach(-0.12)).with_plastic_update(update);
        let simulation = Simulation::new(pair.clone(), Boundary::PERIODIC, motion, Params::new()).unwrap();
        let pass = simulation.solve(&()).unwrap();
        pass.contacts().iter().map(|contact| contact.load).collect::<Vec<_>>()
    };
    let [after, within] = [(&pair, PlasticUpdate::Pass), (&hard, PlasticUpdate::Step)]
        .map(|(pair, update)| loads(pair, update));
    for (one, other) in after.iter().zip(&within) {
        assert!((one - other).abs() < 1e-4, "{one} {other}");
    }
}

#[test]
fn positions_of_weak_adhesion_do_not_depend_on_the_path() {
    let bodies = two_asperities(0.004);
    let [path, alone] = [History::Path, History::None].map(|history| pass(&bodies, history, -0.05));
    let size = path.contacts().iter().fold(0.0, |most: f64, contact| most.max(contact.load.abs()));
    for (one, other) in path.contacts().iter().zip(alone.contacts()) {
        assert!((one.load - other.load).abs() < 1e-5 * size, "{} {}", one.load, other.load);
    }
    let [path, alone] = [path, alone].map(|pass| pass.record().interface.unwrap());
    assert!(path.jumps == 0 && path.adhesive_drag == 0.0 && alone.history_difference < 1e-4, "{alone:?}");
}

#[test]
fn a_mean_load_is_met_though_the_load_of_adhesion_falls_first() {
    let (pair, adhesion) = two_asperities(0.004);
    let load = 0.05;
    for history in [History::None, History::Path] {
        let pair = pair.clone().with_interface(Arc::new(adhesion.with_history(history)));
        let simulation =
            Simulation::new(pair, Boundary::PERIODIC, shift(Control::Load(load)), Params::new()).unwrap();
        let record = simulation.solve(&()).unwrap().record();
        assert!((record.mean_load / load - 1.0).abs() < 1e-4, "{history:?}: {}", record.mean_load);
    }
}

//! Elasto-plastic bodies that move over each other.

use asperity_base::{Error, Field, Grid};
use asperity_contact::material::Material;
use asperity_contact::motion::{LoadControl, Motion, Pair, Regime, Simulation, StepRecord, Strategy};
use asperity_contact::operator::Boundary;
use asperity_contact::plasticity::{Hardening, J2, Layers, PlasticBody, PlasticParams, Volume};
use asperity_contact::solver::{Control, Friction, Params};
use asperity_surface::Topography;

use crate::support::{Kept, largest, steel};

/// Size of a cell, m.
const PITCH: f64 = 5e-6;
/// Radius of the ball, m.
const RADIUS: f64 = 0.5e-3;

/// A body with this grid that yields at 1.5 GPa.
fn flowing(shape: [usize; 2], boundary: Boundary, kinematic: f64) -> PlasticBody {
    let grid = Grid::new(shape, [PITCH; 2]).unwrap();
    let layers = Layers::new(60e-6, 8, 1.15).unwrap();
    let law = J2::new(Hardening::perfect(1.5e9).unwrap());
    let law = if kinematic > 0.0 { law.with_back_stress(kinematic, 0.0).unwrap() } else { law };
    PlasticBody::new(Volume::new(grid, layers, boundary, &steel(f64::INFINITY)).unwrap(), law)
}

/// A surface with this grid, from its height as a function of x and y relative to its middle.
fn surface(shape: [usize; 2], height: impl Fn(f64, f64) -> f64) -> Topography {
    let grid = Grid::new(shape, [PITCH; 2]).unwrap();
    let middle = shape.map(|n| 0.5 * (n as f64 - 1.0));
    let heights = Field::from_shape_fn(shape, |(i, j)| {
        height((i as f64 - middle[0]) * PITCH, (j as f64 - middle[1]) * PITCH)
    });
    Topography::new(grid, heights).unwrap()
}

fn ball(x: f64, y: f64) -> f64 {
    (x * x + y * y) / (2.0 * RADIUS)
}

fn flat(_: f64, _: f64) -> f64 {
    0.0
}

/// Residual displacement of the bodies that yield, after the last pass.
fn displacements(kept: &Kept) -> Vec<&Field> {
    kept.volumes.last().unwrap().iter().map(|volume| &volume.displacement).collect()
}

fn shift(lower: f64, upper: f64) -> Strategy {
    Strategy::Shift { speed_lower: lower, speed_upper: upper }
}

/// A ball that rolls over a flat elasto-plastic body, with a load at each position.
fn rolling(load: f64, passes: usize, kinematic: f64) -> Simulation {
    let shape = [32, 16];
    let pair = Pair::new(surface(shape, flat), surface(shape, ball), [&steel(f64::INFINITY); 2]).unwrap();
    let motion = Motion::new(shift(1.0, 0.0), Control::Load(load))
        .with_load_control(LoadControl::Step)
        .with_passes(passes);
    let body = flowing(shape, Boundary::PERIODIC, kinematic);
    Simulation::new(pair, Boundary::PERIODIC, motion, Params::default())
        .unwrap()
        .with_plastic([Some(body), None], PlasticParams::new())
        .unwrap()
}

/// Load at which the ball has the peak pressure `times` k, k = σY/√3, by Hertz.
fn hertz(times: f64) -> f64 {
    let modulus = 0.5 * steel(f64::INFINITY).plane_strain_modulus();
    let peak = times * 1.5e9 / 3f64.sqrt();
    let a = std::f64::consts::PI * peak * RADIUS / (2.0 * modulus);
    2.0 / 3.0 * std::f64::consts::PI * a * a * peak
}

fn regime(kept: &Kept) -> Regime {
    let passes: Vec<_> = kept.passes.iter().filter_map(|pass| pass.plastic).collect();
    Regime::from_passes(&passes)
}

#[test]
fn below_first_yield_nothing_flows_and_the_contacts_are_elastic() {
    let kept = Kept::run(rolling(hertz(2.5), 2, 0.0));
    let shape = [32, 16];
    let pair = Pair::new(surface(shape, flat), surface(shape, ball), [&steel(f64::INFINITY); 2]).unwrap();
    let motion = Motion::new(shift(1.0, 0.0), Control::Load(hertz(2.5)))
        .with_load_control(LoadControl::Step)
        .with_passes(2);
    let elastic = Kept::run(Simulation::new(pair, Boundary::PERIODIC, motion, Params::default()).unwrap());
    for (a, b) in kept.steps.iter().zip(&elastic.steps) {
        assert!((a.max_pressure / b.max_pressure - 1.0).abs() < 1e-5 && a.contact_area == b.contact_area);
        assert_eq!(a.plastic.map(|flow| (flow.yielded_cells, flow.products)), Some((0, 0)));
        assert!(b.plastic.is_none());
    }
    assert_eq!(regime(&kept), Regime::Elastic);
    assert!(displacements(&kept)[0].iter().all(|r| *r == 0.0));
}

#[test]
fn a_ball_rolls_a_groove_that_shakes_down_at_a_moderate_load() {
    let kept = Kept::run(rolling(hertz(3.6), 8, 0.0));
    let flow = |pass: usize| kept.passes[pass].plastic.unwrap();
    assert_eq!(
        regime(&kept),
        Regime::ShakesDown,
        "{:?}",
        kept.passes.iter().map(|p| p.plastic).collect::<Vec<_>>()
    );
    assert!(flow(0).plastic_work_lower > 0.0 && flow(0).plastic_work_upper == 0.0);
    // Deepest along the middle, and uniform along the path, except around the middle, where a pass begins and
    // ends.
    let r = displacements(&kept)[0];
    let far = || (0..8).chain(24..32);
    let along = |iy: usize| far().map(|ix| r[[ix, iy]]).sum::<f64>() / 16.0;
    assert!(along(7) > along(0) + 1e-9 && along(8) > along(0) + 1e-9);
    let depth = along(7) - along(0);
    let spread = far().fold(0.0f64, |m, ix| m.max(((r[[ix, 7]] - along(7)) / depth).abs()));
    assert!(spread < 0.1, "{spread}");
}

#[test]
fn a_high_load_goes_on_flowing_and_kinematic_hardening_makes_that_cyclic() {
    let kept = Kept::run(rolling(hertz(6.5), 3, 0.0));
    assert!(matches!(regime(&kept), Regime::Undecided | Regime::Ratchets));
    let work = |kept: &Kept, pass: usize| kept.passes[pass].plastic.unwrap().plastic_work_lower;
    assert!(work(&kept, 2) > 0.02 * work(&kept, 0));
    let hard = Kept::run(rolling(hertz(6.5), 3, 60e9));
    assert!(work(&hard, 0) < work(&kept, 0));
    let net = |kept: &Kept| kept.passes[2].plastic.unwrap().net_strain_lower;
    assert!(net(&hard) < net(&kept), "{} {}", net(&hard), net(&kept));
}

#[test]
fn one_approach_bears_the_mean_load_and_later_passes_begin_from_it() {
    let shape = [32, 16];
    let wavy = |x: f64, y: f64| ball(x, y) + 0.2e-6 * (x / 20e-6).sin();
    let pair = Pair::new(surface(shape, flat), surface(shape, wavy), [&steel(f64::INFINITY); 2]).unwrap();
    let motion = Motion::new(shift(1.0, 0.0), Control::Load(hertz(4.5))).with_passes(2);
    let simulation = Simulation::new(pair, Boundary::PERIODIC, motion, Params::default())
        .unwrap()
        .with_plastic([Some(flowing(shape, Boundary::PERIODIC, 0.0)), None], PlasticParams::new())
        .unwrap();
    let kept = Kept::run(simulation);
    for pass in &kept.passes {
        assert!((pass.mean_load / hertz(4.5) - 1.0).abs() < 1e-4, "{pass:?}");
        assert!(pass.outer_iterations <= 8, "{} trials", pass.outer_iterations);
    }
    assert!(kept.passes[1].outer_iterations <= 4, "{} trials", kept.passes[1].outer_iterations);
    let one = kept.steps.iter().filter(|step| step.pass == 1).map(|step| step.approach);
    assert!(one.clone().all(|approach| approach == kept.steps[0].approach));
}

/// A ball on the upper body over a flat lower one, and upside down in the other direction: the lower body is
/// stationary in both.
#[test]
fn bodies_exchanged_and_moved_the_other_way_are_mirror_images() {
    let shape = [24, 12];
    let boundary = Boundary::PERIODIC;
    let motion = |strategy| {
        Motion::new(strategy, Control::Load(hertz(5.0))).with_load_control(LoadControl::Step).with_stride(2)
    };
    let flow = PlasticParams::new().with_tolerance(1e-8);
    let params = Params::default().with_tolerance(1e-12);
    let run = |surfaces: [Topography; 2], strategy| {
        let [lower, upper] = surfaces;
        let pair = Pair::new(lower, upper, [&steel(f64::INFINITY); 2]).unwrap();
        let bodies = [(); 2].map(|()| Some(flowing(shape, boundary, 0.0)));
        let simulation = Simulation::new(pair, boundary, motion(strategy), params).unwrap();
        Kept::run(simulation.with_plastic(bodies, flow).unwrap())
    };
    let one = run([surface(shape, flat), surface(shape, ball)], shift(0.0, 1.0));
    let other = run([surface(shape, |x, y| -ball(x, y)), surface(shape, flat)], shift(-1.0, 0.0));
    for (a, b) in [(0, 1), (1, 0)] {
        let [a, b] = [displacements(&one)[a], displacements(&other)[b]];
        let largest = largest(a);
        let apart =
            a.indexed_iter().fold(0.0f64, |m, ((ix, iy), r)| m.max((r - b[[shape[0] - 1 - ix, iy]]).abs()));
        assert!(largest > 1e-9 && apart < 1e-6 * largest, "{apart:e} of {largest:e}");
    }
    let [one, other] = [&one, &other].map(|kept| kept.passes[0].plastic.unwrap());
    assert!(
        (one.surface_shift_lower + other.surface_shift_upper).abs() < 1e-5 * one.surface_shift_lower.abs()
    );
    assert!((one.plastic_work_upper / other.plastic_work_lower - 1.0).abs() < 1e-6);
}

#[test]
fn a_body_that_lies_between_columns_flows_as_much() {
    // The upper surface moves by half cells: its plastic strain follows the weights of its cells.
    let shape = [24, 12];
    let pair = Pair::new(surface(shape, flat), surface(shape, ball), [&steel(f64::INFINITY); 2]).unwrap();
    let motion = Motion::new(shift(1.0, 0.5), Control::Load(hertz(5.0)))
        .with_load_control(LoadControl::Step)
        .with_passes(2);
    let bodies = [(); 2].map(|()| Some(flowing(shape, Boundary::PERIODIC, 0.0)));
    let simulation = Simulation::new(pair, Boundary::PERIODIC, motion, Params::default()).unwrap();
    let kept = Kept::run(simulation.with_plastic(bodies, PlasticParams::new()).unwrap());
    let flow = kept.passes[0].plastic.unwrap();
    assert!(flow.plastic_work_lower > 0.0 && flow.plastic_work_upper > 0.0, "{flow:?}");
    assert!(kept.passes[1].plastic.unwrap().max_plastic_strain_upper >= flow.max_plastic_strain_upper);
}

/// A ball passes over a flat body and leaves it, at constant approach; another one runs on a ring, at the
/// load of the first. Compares the grooves in the middle.
#[test]
fn an_overlap_far_from_all_rims_is_a_shift() {
    let params = Params::default();
    let free = Boundary::FREE;
    let (track, counter, ring) = ([56, 24], [20, 24], [56, 24]);
    let approach = 1.05
        * (3.0 * hertz(4.2) / (4.0 * 0.5 * steel(f64::INFINITY).plane_strain_modulus())).powf(2.0 / 3.0)
        / RADIUS.cbrt();
    let pair = Pair::new(surface(track, flat), surface(counter, ball), [&steel(f64::INFINITY); 2]).unwrap();
    let motion =
        Motion::new(Strategy::Overlap, Control::Approach(approach)).with_load_control(LoadControl::Pass);
    let overlap = Simulation::new(pair, free, motion, params).unwrap();
    let overlap = Kept::run(
        overlap.with_plastic([Some(flowing(track, free, 0.0)), None], PlasticParams::new()).unwrap(),
    );
    let middle: Vec<&StepRecord> =
        overlap.steps.iter().filter(|s| (120e-6..200e-6).contains(&(s.offset + 50e-6))).collect();
    let load = middle.iter().map(|step| step.load).sum::<f64>() / middle.len() as f64;
    let pair = Pair::new(surface(ring, flat), surface(ring, ball), [&steel(f64::INFINITY); 2]).unwrap();
    let motion = Motion::new(shift(0.0, 1.0), Control::Load(load)).with_load_control(LoadControl::Step);
    let periodic = Boundary::PERIODIC;
    let shifted = Simulation::new(pair, periodic, motion, params).unwrap();
    let shifted = Kept::run(
        shifted.with_plastic([Some(flowing(ring, periodic, 0.0)), None], PlasticParams::new()).unwrap(),
    );
    // The pass on the ring begins and ends in its middle: the groove is evaluated where the ball has been
    // rolling for long.
    let groove = |r: &Field, columns: [usize; 8]| {
        let depth = |ix: usize| {
            let row = r.row(ix);
            row[11].max(row[12]) - row.iter().copied().fold(f64::INFINITY, f64::min)
        };
        columns.map(depth).iter().sum::<f64>() / 8.0
    };
    let one = groove(displacements(&overlap)[0], std::array::from_fn(|n| 26 + n));
    let other = groove(displacements(&shifted)[0], std::array::from_fn(|n| 46 + n));
    assert!((one / other - 1.0).abs() < 0.04, "{one:e} {other:e}, load {load}");
    assert!(overlap.passes[0].plastic.unwrap().plastic_work_rim > 0.0);
}

#[test]
fn friction_shears_the_body_the_way_that_it_slides() {
    let shape = [32, 16];
    let run = |friction: Option<f64>, forth: f64| {
        let pair = Pair::new(surface(shape, flat), surface(shape, ball), [&steel(f64::INFINITY); 2]).unwrap();
        let friction = friction.map(|coefficient| Friction::coulomb(coefficient).unwrap());
        let motion = Motion::new(shift(0.0, forth), Control::Load(hertz(4.0)))
            .with_load_control(LoadControl::Step)
            .with_friction(friction);
        let simulation = Simulation::new(pair, Boundary::PERIODIC, motion, Params::default()).unwrap();
        let bodies = [Some(flowing(shape, Boundary::PERIODIC, 0.0)), None];
        Kept::run(simulation.with_plastic(bodies, PlasticParams::new()).unwrap()).passes[0].plastic.unwrap()
    };
    let [none, forth, back] = [run(None, 1.0), run(Some(0.3), 1.0), run(Some(0.3), -1.0)];
    assert!(forth.plastic_work_lower > 1.2 * none.plastic_work_lower, "{none:?} {forth:?}");
    // Without friction the surface creeps slightly, in the direction of the motion under it.
    assert!(forth.surface_shift_lower > 0.0 && back.surface_shift_lower < 0.0, "{forth:?} {back:?}");
    assert!(forth.surface_shift_lower > 2.0 * none.surface_shift_lower.abs(), "{none:?} {forth:?}");
    assert!((forth.surface_shift_lower / -back.surface_shift_lower - 1.0).abs() < 0.05);
}

#[test]
fn what_bodies_that_flow_do_not_have_is_refused() {
    let shape = [16, 8];
    let hard = steel(4e9);
    let simulation = |material: &Material, boundary: Boundary, strategy| {
        let pair = Pair::new(surface(shape, flat), surface(shape, ball), [material, material]).unwrap();
        let motion = Motion::new(strategy, Control::Approach(1e-7));
        Simulation::new(pair, boundary, motion, Params::default()).unwrap()
    };
    let refused = |simulation: Simulation, boundary| {
        let flow = simulation.with_plastic([Some(flowing(shape, boundary, 0.0)), None], PlasticParams::new());
        match flow.map(|_| ()) {
            Err(Error::Unsupported(what)) => what,
            other => panic!("{other:?}"),
        }
    };
    let periodic = Boundary::PERIODIC;
    assert!(
        refused(simulation(&hard, periodic, shift(0.0, 1.0)), periodic).contains("does not take a hardness")
    );
    let free = simulation(&steel(f64::INFINITY), Boundary::FREE, shift(0.0, 1.0));
    assert!(refused(free, Boundary::FREE).contains("needs a periodic boundary"));
}

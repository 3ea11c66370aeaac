//! Steady sliding of viscoelastic bodies, their passes and their creep.

use std::f64::consts::TAU;

use super::{Case, Check, Expected, PARAMS, relative, study};
use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::material::{Coating, Material};
use crate::motion::{LoadControl, Motion, Pair, Simulation, Strategy};
use crate::operator::{Boundary, Edge, FreeFft};
use crate::reference::viscoelastic::{fast_sphere, sphere_under_step};
use crate::reference::{CylinderOnFoundation, ViscoelasticCylinder};
use crate::solver::Control;
use crate::surface::Topography;
use crate::viscoelastic::{
    BodyRelaxation, CreepMemory, Relaxation, RelaxationTerm, SlidingBodies, SteadyContact, SteadySliding,
    ViscoelasticStack, solve_in_time, solve_steady,
};

/// Glassy over relaxed modulus.
const RATIO: f64 = 10.0;
/// Load of a cylinder of radius 1 per length.
const LOAD: f64 = 0.05;

/// A body with a relaxed modulus and a retardation time of 1.
fn standard_solid() -> Result<Relaxation> {
    Relaxation::new(1.0, [RelaxationTerm { modulus: RATIO - 1.0, time: 1.0 / RATIO }])
}

fn slide(grid: Grid, boundary: Boundary, gap: &Field, load: f64, speed: f64) -> Result<SteadyContact> {
    slide_over(&standard_solid()?.creep(), (grid, boundary), gap, load, speed)
}

fn slide_over(
    bodies: impl Into<SlidingBodies>,
    (grid, boundary): (Grid, Boundary),
    gap: &Field,
    load: f64,
    speed: f64,
) -> Result<SteadyContact> {
    let mut operator = SteadySliding::new(grid, boundary, bodies, speed)?;
    solve_steady(&mut operator, gap, Control::Load(load), None, &PARAMS, &())
}

/// A wave in full contact takes E″ of its frequency, whatever the grid.
pub(super) const WAVE: Case = Case {
    name: "Viscoelastic body: wave in full contact",
    source: "energy of a wave, q²A²E″(qv)/4 of an area",
    checks: wave,
};

fn wave() -> Result<Vec<Check>> {
    const SPEED: f64 = 0.02;
    let checks = [("drag", Expected::RoundOff(1e-9))];
    study("cells a side", &[16, 32, 64], checks, |n| {
        let grid = Grid::new([n, n], [1.0 / n as f64; 2])?;
        let (q, amplitude) = (3.0 * TAU, 1e-3);
        let gap = Field::from_shape_fn(grid.shape, |(i, _)| -amplitude * (q * i as f64 / n as f64).cos());
        let found = slide(grid, Boundary::PERIODIC, &gap, LOAD, SPEED)?;
        let loss = standard_solid()?.complex(q * SPEED).im;
        Ok([relative(found.drag, 0.25 * q * q * amplitude * amplitude * loss)])
    })
}

/// A cylinder, while the body creeps over a third of its contact and over all of it. Cells at the edges are
/// inside or outside.
pub(super) const CYLINDER: Case =
    Case { name: "Viscoelastic body: sliding cylinder", source: "Hunter (1961)", checks: cylinder };

fn cylinder() -> Result<Vec<Check>> {
    let drag = |finest| Expected::Order { order: 1.0..=4.0, finest };
    let checks = [
        ("drag, v = 0.3", drag(1e-4)),
        ("reach ahead, v = 0.3", Expected::Counted(3.0)),
        ("drag, v = 1", drag(1e-4)),
        ("reach ahead, v = 1", Expected::Counted(3.0)),
    ];
    study("cells a side", &[32, 128, 512], checks, |n| {
        let mut errors = [0.0; 4];
        for (speed, errors) in [0.3, 1.0].into_iter().zip(errors.chunks_exact_mut(2)) {
            let exact = ViscoelasticCylinder {
                radius: 1.0,
                load_per_length: LOAD,
                glassy: 1.0 / RATIO,
                delayed: 1.0 - 1.0 / RATIO,
                decay: speed,
            };
            let [ahead, behind] = exact.reach();
            let pitch = 2.6 * ahead.max(behind) / n as f64;
            let grid = Grid::new([n, 1], [pitch; 2])?;
            let at = |i: usize| pitch * (i as f64 + 0.5 - 0.5 * n as f64);
            let gap = Field::from_shape_fn(grid.shape, |(i, _)| 0.5 * at(i).powi(2));
            let line = Boundary([Edge::Free, Edge::Periodic]);
            let found = slide(grid, line, &gap, LOAD * pitch, speed)?;
            let touching = (0..n).rev().find(|i| found.solution.pressure[[*i, 0]] > 0.0);
            errors[0] = relative(found.drag / pitch, exact.drag_per_length());
            errors[1] = relative(touching.map_or(0.0, at) + 0.5 * pitch, ahead);
        }
        Ok(errors)
    })
}

/// A cylinder on a compressible layer that relaxes and is thin compared with the contact, on a rigid body: a foundation, apart
/// from edges as wide as the layer is thick.
pub(super) const LAYER: Case = Case {
    name: "Viscoelastic layer: cylinder sliding on a thin layer",
    source: "Johnson (1985), section 9.4",
    checks: layer,
};

fn layer() -> Result<Vec<Check>> {
    const POISSON: f64 = 0.3;
    let order = |finest| Expected::Order { order: 1.8..=3.3, finest };
    let checks = [
        ("drag, v = 0.5 a/τ", order(1e-4)),
        ("largest pressure, v = 0.5 a/τ", order(1e-3)),
        ("drag, v = 0.1 a/τ", order(1e-4)),
        ("largest pressure, v = 0.1 a/τ", order(1e-3)),
    ];
    study("a/t", &[8, 16, 32], checks, |n| {
        let thickness = 1.0 / n as f64;
        let layer = Coating::new(thickness, 1.0, POISSON)?;
        let rigid = Material::elastic(f64::INFINITY, 0.0)?;
        let relaxation = BodyRelaxation { body: None, layers: vec![Some(standard_solid()?)] };
        let moving = ViscoelasticStack::new(&rigid.clone().layered(vec![layer]), relaxation)?;
        let standing = ViscoelasticStack::new(&rigid, BodyRelaxation::default())?;
        let bodies = SlidingBodies::Layered { moving, standing };
        // M/E of a material that cannot widen.
        let oedometric = (1.0 - POISSON) / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON));
        let mut errors = [0.0; 4];
        for (decay, errors) in [0.5, 0.1].into_iter().zip(errors.chunks_exact_mut(2)) {
            let relaxed = oedometric / thickness;
            let relaxing = relaxed * (RATIO - 1.0);
            let exact = CylinderOnFoundation { radius: 1.0, ahead: 1.0, relaxed, relaxing, decay };
            // The surface recovers over RATIO decays: the period is many of these.
            let pitch = 0.25 * thickness;
            let grid = Grid::new([400 * n, 1], [pitch; 2])?;
            let gap =
                Field::from_shape_fn(grid.shape, |(i, _)| 0.5 * (pitch * (i as f64 + 0.5) - 2.0).powi(2));
            let load = exact.load_per_length() * pitch;
            // The relaxation time is τ = 1/RATIO.
            let speed = decay * RATIO;
            let found = slide_over(bodies.clone(), (grid, Boundary::PERIODIC), &gap, load, speed)?;
            let peak = (1..1000).map(|k| exact.pressure(1e-3 * f64::from(k))).fold(0.0, f64::max);
            errors[0] = relative(found.drag / pitch, exact.drag_per_length());
            errors[1] = relative(found.solution.max_pressure(), peak);
        }
        Ok(errors)
    })
}

/// A cylinder that passes over a body which has not been touched before. In the end it slides as if it always
/// had.
pub(super) const PASS: Case =
    Case { name: "Viscoelastic body: cylinder in a pass", source: "Hunter (1961)", checks: pass };

fn pass() -> Result<Vec<Check>> {
    const SPEED: f64 = 0.3;
    let checks = [("drag", Expected::Order { order: 1.0..=3.0, finest: 5e-3 })];
    study("cells of the cylinder", &[16, 32, 64], checks, |n| {
        let decay = SPEED;
        let (glassy, delayed) = (1.0 / RATIO, 1.0 - 1.0 / RATIO);
        let exact = ViscoelasticCylinder { radius: 1.0, load_per_length: LOAD, glassy, delayed, decay };
        let [ahead, behind] = exact.reach();
        let pitch = 2.6 * ahead.max(behind) / n as f64;
        let at = |i: usize| pitch * (i as f64 + 0.5 - 0.5 * n as f64);
        let body = |columns: usize, height: &dyn Fn(usize) -> f64| {
            let grid = Grid::new([columns, 1], [pitch; 2])?;
            Topography::new(grid, Field::from_shape_fn(grid.shape, |(i, _)| height(i)))
        };
        let (long, cylinder) = (body(5 * n, &|_| 0.0)?, body(n, &|i| 0.5 * at(i).powi(2))?);
        // Half of an incompressible body, whose composite modulus is 1.
        let young = 0.75;
        let [soft, rigid] = [Material::elastic(young, 0.5)?, Material::elastic(f64::INFINITY, 0.3)?];
        let relaxation =
            Relaxation::new(young, [RelaxationTerm { modulus: young * (RATIO - 1.0), time: 1.0 / RATIO }])?;
        let materials = [&soft, &rigid];
        let pair =
            Pair::new(long, cylinder, materials)?.with_relaxation(materials, [Some(relaxation), None])?;
        let motion = Motion::new(Strategy::Overlap, Control::Load(LOAD * pitch))
            .with_load_control(LoadControl::Step)
            .with_speed(SPEED);
        let line = Boundary([Edge::Free, Edge::Periodic]);
        let passed = Simulation::new(pair, line, motion, PARAMS)?.solve(&())?;
        // The last position at which the whole cylinder is over the body.
        let step = passed.steps().iter().rev().find(|step| step.overlap_columns == n);
        let drag = step.and_then(|step| step.drag).map_or(f64::NAN, |record| record.drag);
        Ok([relative(drag / pitch, exact.drag_per_length())])
    })
}

/// A sphere that slides fast: the glassy contact, whose drag falls with the speed.
pub(super) const FAST: Case = Case {
    name: "Viscoelastic body: fast sphere",
    source: "glassy Hertz contact, first order of 1/v",
    checks: fast,
};

fn fast() -> Result<Vec<Check>> {
    const SPEED: f64 = 1e4;
    let checks = [("drag", Expected::Order { order: 0.7..=3.0, finest: 1e-2 })];
    study("cells a side", &[16, 32, 64], checks, |n| {
        let load = 0.01;
        let radius = (0.75 * load / RATIO).cbrt();
        let pitch = 2.4 * radius / n as f64;
        let grid = Grid::new([n, n], [pitch; 2])?;
        let at = |i: usize| pitch * (i as f64 + 0.5 - 0.5 * n as f64);
        let gap = Field::from_shape_fn(grid.shape, |(i, j)| 0.5 * (at(i).powi(2) + at(j).powi(2)));
        let found = slide(grid, Boundary::FREE, &gap, load, SPEED)?;
        let exact = fast_sphere(1.0, load, 1.0 / RATIO, &[(1.0 - 1.0 / RATIO, 1.0)]) / SPEED;
        Ok([relative(found.drag / load, exact)])
    })
}

/// A sphere under a load that comes at once and stays: at once, after half of the retardation time, and after
/// two of them.
pub(super) const CREEP: Case = Case {
    name: "Viscoelastic body: sphere under a step of load",
    source: "Lee, Radok (1960)",
    checks: creep,
};

fn creep() -> Result<Vec<Check>> {
    const STEPS: usize = 8;
    let order = || Expected::Order { order: 0.7..=3.0, finest: 1e-3 };
    let checks =
        [("approach, t = 0", order()), ("approach, t = ρ/2", order()), ("approach, t = 2 ρ", order())];
    study("cells a side", &[12, 24, 48], checks, |n| {
        let (creep, load) = (standard_solid()?.creep(), 0.01f64);
        let pitch = 2.3 * (0.75 * load).cbrt() / n as f64;
        let grid = Grid::new([n, n], [pitch; 2])?;
        let at = |i: usize| pitch * (i as f64 + 0.5 - 0.5 * n as f64);
        let gap = Field::from_shape_fn(grid.shape, |(i, j)| 0.5 * (at(i).powi(2) + at(j).powi(2)));
        let (mut operator, mut memory) =
            (FreeFft::new(grid, 1.0), CreepMemory::new(creep.clone(), grid.shape));
        let time = |step: usize| 2.0 * (step as f64 / STEPS as f64).powi(2);
        let mut errors = Vec::new();
        for step in 0..=STEPS {
            let (control, duration) = (Control::Load(load), time(step) - time(step.saturating_sub(1)));
            let found =
                solve_in_time(&mut operator, 1.0, &mut memory, &gap, control, duration, None, &PARAMS, &())?;
            if step % (STEPS / 2) == 0 {
                errors.push(relative(
                    found.approach,
                    sphere_under_step(1.0, load, creep.compliance(time(step)))[0],
                ));
            }
        }
        Ok([errors[0], errors[1], errors[2]])
    })
}

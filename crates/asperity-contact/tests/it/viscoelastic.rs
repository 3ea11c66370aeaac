//! Viscoelastic bodies in steady sliding and in time against dense programs, and their symmetries.

use crate::support::dense::{dense, mean_compliance, relaxation as body};
use std::f64::consts::TAU;
use std::sync::Arc;

use asperity_contact::adhesion::Adhesion;
use asperity_contact::material::Material;
use asperity_contact::motion::{MovingBody, Pair, Stage, StagedLoading};
use asperity_contact::operator::{Boundary, Edge, Operators};
use asperity_contact::solver::{Control, Friction, Loading, Params};
use asperity_contact::viscoelastic::{
    Creep, CreepMemory, Relaxation, RelaxationTerm, SteadyContact, SteadySliding, solve_in_time, solve_steady,
};
use asperity_contact::{Field, Grid};
use asperity_surface::Topography;
use ndarray::s;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const BOUNDARIES: [Boundary; 3] =
    [Boundary::FREE, Boundary::PERIODIC, Boundary([Edge::Free, Edge::Periodic])];

fn gap(random: &mut ChaCha8Rng, shape: [usize; 2]) -> Field {
    Field::from_shape_simple_fn(shape, || random.random_range(0.0..1.0))
}

fn slide(
    grid: Grid,
    boundary: Boundary,
    creep: &Creep,
    speed: f64,
    gap: &Field,
    control: Control,
) -> SteadyContact {
    let mut operator = SteadySliding::new(grid, boundary, creep, speed).unwrap();
    let params = Params::default().with_tolerance(1e-10);
    solve_steady(&mut operator, gap, control, None, &params, &()).unwrap()
}

/// The dense matrix of an operator, column by column.
fn matrix(grid: Grid, boundary: Boundary, creep: &Creep, speed: f64) -> Vec<Vec<f64>> {
    let mut operator = SteadySliding::new(grid, boundary, creep, speed).unwrap();
    let columns = (0..grid.cells()).map(|cell| {
        let (mut unit, mut displacement) = (grid.zeros(), grid.zeros());
        unit.as_slice_mut().unwrap()[cell] = 1.0;
        operator.displace(&unit, &mut displacement);
        displacement.into_iter().collect::<Vec<_>>()
    });
    let columns: Vec<_> = columns.collect();
    (0..grid.cells()).map(|row| columns.iter().map(|column| column[row]).collect()).collect()
}

#[test]
fn three_hundred_random_contacts_are_those_of_a_dense_program() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    for case in 0..300 {
        let shape = [random.random_range(3..8), random.random_range(3..8)];
        let grid = Grid::new(shape, [1.0, random.random_range(0.5..2.0)]).unwrap();
        // The tables of cells take longer than waves.
        let boundary = BOUNDARIES[if case % 60 == 7 { 2 } else { usize::from(case % 10 != 0) }];
        let creep = body(&mut random).creep();
        let speed = 10f64.powf(random.random_range(-2.0..2.0)) * if case % 2 == 0 { 1.0 } else { -1.0 };
        let gap = gap(&mut random, shape);
        let load = 10f64.powf(random.random_range(-2.0..0.0)) * grid.cells() as f64 * grid.cell_area();
        let found = slide(grid, boundary, &creep, speed, &gap, Control::Load(load));
        let p = &found.solution.pressure;
        assert!((found.solution.load() / load - 1.0).abs() < 1e-10);
        // At full contact of a periodic grid the approach is free in the dense equations.
        if boundary == Boundary::PERIODIC && p.iter().all(|p| *p > 0.0) {
            continue;
        }
        let c = matrix(grid, boundary, &creep, speed);
        let expected = dense(&c, gap.as_slice().unwrap(), found.solution.approach);
        let largest = expected.iter().copied().fold(0.0, f64::max);
        let error = p.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error < 1e-7 * largest, "case {case}: {}", error / largest);
        assert!(found.drag > -1e-12 * load, "case {case}: {}", found.drag);
    }
}

#[test]
fn a_hundred_random_histories_are_those_of_boltzmanns_superposition() {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    for case in 0..100 {
        let shape = [random.random_range(3..8), random.random_range(3..8)];
        let grid = Grid::new(shape, [1.0, random.random_range(0.5..2.0)]).unwrap();
        let boundary = BOUNDARIES[case % 2];
        let creep = body(&mut random).creep().plus(&body(&mut random).creep());
        let gap = gap(&mut random, shape);
        let elastic = matrix(grid, boundary, &Creep::elastic(1.0), 1.0);
        let times =
            |c: f64| elastic.iter().map(|row| row.iter().map(|e| c * e).collect()).collect::<Vec<Vec<f64>>>();
        let mut operator = Operators::new(grid, 1.0, boundary).on(shape);
        let mut memory = CreepMemory::new(creep.clone(), shape);
        // The steps so far: their begin and end, and the change of the elastic displacement in them.
        let mut steps: Vec<(f64, f64, Vec<f64>)> = Vec::new();
        let (mut now, mut before) = (0.0, vec![0.0; grid.cells()]);
        for step in 0..8 {
            let is_sudden = step == 0 || random.random_bool(0.2);
            let duration = if is_sudden { 0.0 } else { 10f64.powf(random.random_range(-2.0..1.5)) };
            let control = if random.random_bool(0.5) {
                Control::Load(
                    10f64.powf(random.random_range(-2.0..0.0)) * grid.extent()[0] * grid.extent()[1],
                )
            } else {
                Control::Approach(random.random_range(0.2..0.9) * gap.mean().unwrap())
            };
            let params = Params::default().with_tolerance(1e-10);
            let (operator, memory) = (operator.as_mut(), &mut memory);
            let found =
                solve_in_time(operator, 1.0, memory, &gap, control, duration, None, &params, &()).unwrap();
            if let Control::Load(load) = control {
                assert!((found.load() / load - 1.0).abs() < 1e-10);
            }
            let (begin, end) = (now, now + duration);
            now = end;
            let mut opened = gap.as_slice().unwrap().to_vec();
            for (begin, end, change) in &steps {
                let j = mean_compliance(&creep, now, *begin, *end);
                opened.iter_mut().zip(change).for_each(|(gap, change)| *gap += j * change);
            }
            // What is borne already does not change in this step.
            let j = mean_compliance(&creep, now, begin, end);
            opened.iter_mut().zip(&before).for_each(|(gap, before)| *gap -= j * before);
            let p = found.pressure.as_slice().unwrap();
            let displaced: Vec<f64> =
                elastic.iter().map(|row| row.iter().zip(p).map(|(e, p)| e * p).sum()).collect();
            if boundary == Boundary::FREE || p.contains(&0.0) {
                let expected = dense(&times(j), &opened, found.approach);
                let largest = expected.iter().copied().fold(1e-3, f64::max);
                let error = p.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(error < 1e-6 * largest, "case {case}, step {step}: {}", error / largest);
            }
            steps.push((begin, end, displaced.iter().zip(&before).map(|(now, then)| now - then).collect()));
            before = displaced;
        }
    }
}

#[test]
fn the_power_of_the_drag_is_what_the_dashpots_dissipate() {
    let mut random = ChaCha8Rng::seed_from_u64(9);
    for shape in [[16, 6], [15, 8], [24, 1]] {
        let grid = Grid::new(shape, [1.0, 0.7]).unwrap();
        let (creep, gap) = (body(&mut random).creep(), gap(&mut random, shape));
        let speed = 0.8;
        let found = slide(grid, Boundary::PERIODIC, &creep, speed, &gap, Control::Load(0.3 * grid.area()));
        // Each spring of a retardation time has a dashpot beside it, on which the pressure p − q acts, with ρ
        // q̇ = p − q.
        let mut power = 0.0;
        let [nx, ny] = shape.map(|n| n as isize);
        for (kx, ky) in (0..nx).flat_map(|kx| (0..ny).map(move |ky| (kx, ky))) {
            let half = |k: isize, n: isize| if 2 * k > n { k - n } else { k };
            let waves = [half(kx, nx), half(ky, ny)];
            let q = [0, 1].map(|axis| TAU * waves[axis] as f64 / grid.extent()[axis]);
            let size = q[0].hypot(q[1]);
            // Waves of two cells have no slope on the grid.
            if size == 0.0 || 2 * kx == nx {
                continue;
            }
            let mut sum = [0.0; 2];
            for ((i, j), p) in found.solution.pressure.indexed_iter() {
                let phase = TAU * (kx as f64 * i as f64 / nx as f64 + ky as f64 * j as f64 / ny as f64);
                sum = [sum[0] + p * phase.cos(), sum[1] + p * phase.sin()];
            }
            let squared = (sum[0] * sum[0] + sum[1] * sum[1]) / grid.cells() as f64;
            for term in &creep.terms {
                let x = (q[0] * speed * term.time).powi(2);
                power +=
                    grid.cell_area() * term.compliance / term.time * 2.0 / size * squared * x / (1.0 + x);
            }
        }
        let drag = found.drag * speed;
        assert!((drag / power - 1.0).abs() < 1e-10, "{shape:?}: {drag}, dissipated {power}");
    }
}

#[test]
fn the_other_way_a_mirrored_contact_is_mirrored() {
    let mut random = ChaCha8Rng::seed_from_u64(4);
    for boundary in BOUNDARIES {
        let grid = Grid::new([24, 10], [1.0, 1.0]).unwrap();
        let creep = body(&mut random).creep();
        let gap = gap(&mut random, grid.shape);
        let mirrored = gap.slice(s![..;-1, ..]).to_owned();
        let one = slide(grid, boundary, &creep, 0.7, &gap, Control::Load(20.0));
        let other = slide(grid, boundary, &creep, -0.7, &mirrored, Control::Load(20.0));
        let back = other.solution.pressure.slice(s![..;-1, ..]);
        let largest = one.solution.max_pressure();
        assert!(one.solution.pressure.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-7 * largest));
        assert!((one.drag / other.drag - 1.0).abs() < 1e-7 && one.drag > 0.0);
    }
}

#[test]
fn slowly_it_is_the_relaxed_contact_and_fast_the_glassy_one() {
    let grid = Grid::new([20, 16], [1.0, 1.0]).unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let (creep, gap) = (body(&mut random).creep(), gap(&mut random, grid.shape));
    for (speed, compliance) in [(1e-9, creep.relaxed()), (1e9, creep.glassy)] {
        let control = Control::Load(10.0);
        let found = slide(grid, Boundary::FREE, &creep, speed, &gap, control);
        let elastic = slide(grid, Boundary::FREE, &Creep::elastic(compliance), 1.0, &gap, control);
        let largest = elastic.solution.max_pressure();
        let pairs = found.solution.pressure.iter().zip(&elastic.solution.pressure);
        assert!(pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) < 1e-6 * largest, "{speed}");
        assert!(found.drag.abs() < 1e-6 * 10.0, "{speed}: {}", found.drag);
    }
}

#[test]
fn the_body_that_is_smooth_along_x_moves_through_the_contact() {
    let grid = Grid::new([16, 8], [1e-6; 2]).unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(6);
    let rough = Topography::new(grid, gap(&mut random, grid.shape) * 1e-8).unwrap();
    let groove = Topography::new(grid, Field::from_shape_fn(grid.shape, |(_, j)| 1e-8 * j as f64)).unwrap();
    let rubber = Material::elastic(1e6, 0.5).unwrap();
    let rigid = Material::elastic(f64::INFINITY, 0.3).unwrap();
    let relaxation = || Relaxation::new(1e6, [RelaxationTerm { modulus: 9e6, time: 1e-3 }]).unwrap();
    let pair = |lower: &Topography, upper: &Topography, materials: [&Material; 2], relaxations| {
        Pair::new(lower.clone(), upper.clone(), materials)
            .unwrap()
            .with_relaxation(materials, relaxations)
            .unwrap()
    };
    let below = pair(&groove, &rough, [&rubber, &rigid], [Some(relaxation()), None]);
    assert_eq!(below.moving_body().unwrap(), MovingBody::Lower);
    // The same bodies, turned over: the contact moves the other way.
    let above = pair(&rough, &groove, [&rigid, &rubber], [None, Some(relaxation())]);
    assert_eq!(above.moving_body().unwrap(), MovingBody::Upper);
    let both = pair(&rough, &rough, [&rubber, &rigid], [Some(relaxation()), None]);
    assert!(both.moving_body().unwrap_err().to_string().contains("smooth along x"));
    // A rough body that creeps stands still, and is relaxed.
    let still = pair(&rough, &groove, [&rubber, &rigid], [Some(relaxation()), None]);
    let mut operator = still.sliding_steadily(Boundary::FREE, 1.0).unwrap();
    let load = Control::Load(1e-6);
    let found = solve_steady(&mut operator, rough.heights(), load, None, &Params::default(), &()).unwrap();
    assert!(found.drag.abs() < 1e-12 * 1e-6, "{}", found.drag);
}

#[test]
fn what_viscoelastic_bodies_do_not_support_is_refused_before_anything_is_solved() {
    let grid = Grid::new([8, 8], [1e-6; 2]).unwrap();
    let flat = || Topography::new(grid, grid.zeros()).unwrap();
    let rubber = Material::elastic(1e6, 0.5).unwrap();
    let relaxation = || Relaxation::new(1e6, [RelaxationTerm { modulus: 9e6, time: 1e-3 }]).unwrap();
    let pair = || {
        let pair = Pair::new(flat(), flat(), [&rubber, &rubber]).unwrap();
        pair.with_relaxation([&rubber, &rubber], [Some(relaxation()), None]).unwrap()
    };
    let control = Control::Load(1e-6);
    let loaded = |pair: Pair, friction: Option<Friction>| {
        let stage = Stage::new(Loading::pressing(control), 1);
        StagedLoading::new(pair, Boundary::FREE, friction, vec![stage], Params::default()).map(|_| ())
    };
    assert!(loaded(pair(), None).is_ok() && pair().sliding_steadily(Boundary::FREE, 1.0).is_ok());
    let sticky = || pair().with_interface(Arc::new(Adhesion::new(0.05, 1e-8).unwrap()));
    let soft = || pair().with_hardness([1e6.into(), f64::INFINITY.into()]).unwrap();
    for (what, found) in [
        ("attract each other", loaded(sticky(), None)),
        ("attract each other", sticky().sliding_steadily(Boundary::FREE, 1.0).map(|_| ())),
        ("a hardness", loaded(soft(), None)),
        ("a hardness", soft().sliding_steadily(Boundary::FREE, 1.0).map(|_| ())),
        ("without friction", loaded(pair(), Some(Friction::coulomb(0.3).unwrap()))),
    ] {
        let error = found.unwrap_err().to_string();
        assert!(error.contains("viscoelastic") && error.contains(what), "{what}: {error}");
    }
}

//! Steady sliding against closed forms.

use std::f64::consts::TAU;

use rand::{RngExt as _, SeedableRng as _};

use crate::grid::{Field, Grid};
use crate::kernel::{Stack, normal_displacement};
use crate::material::{Coating, Material};
use crate::math::RealFft2;
use crate::math::fft::angular_frequency;
use crate::operator::{Boundary, Edge};
use crate::reference::ViscoelasticCylinder;
use crate::reference::viscoelastic::{fast_sphere, slow_paraboloid};
use crate::solver::{Control, Params};
use crate::viscoelastic::table::{ElasticCell, MovingCell};
use crate::viscoelastic::{
    BodyRelaxation, Creep, Relaxation, RelaxationTerm, SlidingBodies, SteadyContact, SteadySliding,
    ViscoelasticStack, solve_steady,
};

fn body(terms: &[(f64, f64)]) -> Relaxation {
    let terms = terms.iter().map(|&(modulus, time)| RelaxationTerm { modulus, time });
    Relaxation::new(1.0, terms).unwrap()
}

/// A body with E₀ = 1, the ratio of the glassy to the relaxed modulus, and the retardation time 1.
fn standard(ratio: f64) -> Relaxation {
    body(&[(ratio - 1.0, 1.0 / ratio)])
}

fn solve(
    body: &Relaxation,
    (grid, boundary): (Grid, Boundary),
    gap: &Field,
    load: f64,
    speed: f64,
    tolerance: f64,
) -> SteadyContact {
    let mut operator = SteadySliding::new(grid, boundary, &body.creep(), speed).unwrap();
    let params = Params::default().with_tolerance(tolerance);
    solve_steady(&mut operator, gap, Control::Load(load), None, &params, &()).unwrap()
}

#[test]
fn a_wave_in_full_contact_loses_the_energy_of_its_loss_modulus() {
    let (n, speed, amplitude) = (64, 0.02, 1e-3);
    let grid = Grid::new([n, n], [1.0 / n as f64; 2]).unwrap();
    let q = 3.0 * TAU;
    let gap = Field::from_shape_fn(grid.shape, |(i, _)| -amplitude * (q * i as f64 / n as f64).cos());
    let body = standard(10.0);
    let contact = solve(&body, (grid, Boundary::PERIODIC), &gap, 0.05, speed, 1e-10);
    let expected = q * q * amplitude * amplitude * body.complex(q * speed).im / 4.0;
    assert!((contact.drag / expected - 1.0).abs() < 1e-9, "{}", contact.drag / expected - 1.0);
    // The other way it is the same.
    let back = solve(&body, (grid, Boundary::PERIODIC), &gap, 0.05, -speed, 1e-10);
    assert!((back.drag / expected - 1.0).abs() < 1e-9, "{}", back.drag / expected - 1.0);
}

#[test]
fn a_rough_surface_in_full_contact_loses_the_sum_over_its_spectrum() {
    let (n, speed) = (64, 0.02);
    let grid = Grid::new([n, n], [1.0 / n as f64; 2]).unwrap();
    let body = body(&[(2.0, 1.0), (5.0, 0.1), (30.0, 3e-3)]);
    let mut seed = 1u64;
    let noise = Field::from_shape_simple_fn(grid.shape, || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 40) as f64 / f64::from(1u32 << 24) - 0.5
    });
    let fft = RealFft2::new(grid.shape);
    let mut spectrum = fft.forward(&noise);
    let wave = |k: usize, l: usize| {
        [angular_frequency(k, n, 1.0 / n as f64), angular_frequency(l, n, 1.0 / n as f64)]
    };
    for ((k, l), value) in spectrum.indexed_iter_mut() {
        let [x, y] = wave(k, l);
        let q = x.hypot(y);
        *value *= if q > 0.0 && q < 60.0 { q.max(12.0).powf(-1.8) } else { 0.0 };
    }
    let cells = (n * n) as f64;
    let scale = 2e-3 / {
        let field = fft.inverse_leading(&spectrum, grid.shape);
        field.std(0.0)
    };
    let gap = fft.inverse_leading(&spectrum, grid.shape) * scale;
    let spectrum = fft.forward(&gap);
    let expected: f64 = spectrum
        .indexed_iter()
        .map(|((k, l), value)| {
            let [x, y] = wave(k, l);
            let twice = if l == 0 || 2 * l == n { 1.0 } else { 2.0 };
            twice * 0.5 * x.hypot(y) * x * value.norm_sqr() * body.complex(x * speed).im / (cells * cells)
        })
        .sum();
    let contact = solve(&body, (grid, Boundary::PERIODIC), &gap, 2.0, speed, 1e-10);
    assert!(contact.solution.pressure.iter().all(|p| *p > 0.0));
    assert!((contact.drag / expected - 1.0).abs() < 1e-9, "{}", contact.drag / expected - 1.0);
}

#[test]
fn a_cylinder_is_that_of_hunter_and_its_error_falls_with_the_grid() {
    let boundary = Boundary([Edge::Free, Edge::Periodic]);
    for (ratio, speed) in [(10.0, 0.03), (10.0, 0.1), (10.0, 0.3), (10.0, 1.0), (10.0, 10.0), (100.0, 0.3)] {
        let exact = ViscoelasticCylinder {
            radius: 1.0,
            load_per_length: 0.05,
            glassy: 1.0 / ratio,
            delayed: 1.0 - 1.0 / ratio,
            decay: speed,
        };
        let [a, b] = exact.reach();
        let errors = [64usize, 256].map(|n| {
            let dx = 2.6 * a.max(b) / n as f64;
            let grid = Grid::new([n, 1], [dx, dx]).unwrap();
            let gap = Field::from_shape_fn(grid.shape, |(i, _)| {
                (dx * (i as f64 + 0.5 - 0.5 * n as f64)).powi(2) / 2.0
            });
            let contact = solve(&standard(ratio), (grid, boundary), &gap, 0.05 * dx, speed, 1e-7);
            contact.drag / dx / exact.drag_per_length() - 1.0
        });
        assert!(errors[1].abs() < 3e-4, "{ratio}, {speed}: {errors:?}");
    }
}

#[test]
fn a_sphere_is_that_of_the_limits() {
    let (load, n) = (0.01, 64);
    let a0 = (0.75f64 * load).cbrt();
    let dx = 2.3 * a0 / n as f64;
    let grid = Grid::new([n, n], [dx; 2]).unwrap();
    let at = |i: usize| dx * (i as f64 + 0.5 - 0.5 * n as f64);
    let gap = Field::from_shape_fn(grid.shape, |(i, j)| (at(i).powi(2) + at(j).powi(2)) / 2.0);
    let body = standard(10.0);
    let delayed = [(0.9, 1.0)];
    let drag = |speed: f64| {
        let contact = solve(&body, (grid, Boundary::FREE), &gap, load, speed, 1e-6);
        contact.drag / load
    };
    let slow = drag(0.01);
    assert!((slow - 0.00869).abs() < 4e-5, "{slow}");
    assert!(slow < 0.01 * slow_paraboloid(1.0, 1.0, &delayed));
    let middle = drag(0.2);
    assert!((middle - 0.0777).abs() < 2e-4, "{middle}");
    let fast = drag(100.0) * 100.0;
    assert!((fast / fast_sphere(1.0, load, 0.1, &delayed) - 1.0).abs() < 0.01, "{fast}");
}

#[test]
fn elastic_bodies_have_no_drag() {
    let grid = Grid::new([32, 32], [1.0; 2]).unwrap();
    let gap =
        Field::from_shape_fn(grid.shape, |(i, j)| 0.01 * ((i * 7 + j * 13) % 17) as f64 + 0.002 * i as f64);
    for boundary in [Boundary::PERIODIC, Boundary::FREE] {
        let creep = crate::viscoelastic::Creep::elastic(1.0);
        let mut operator = SteadySliding::new(grid, boundary, &creep, 3.0).unwrap();
        let contact =
            solve_steady(&mut operator, &gap, Control::Load(2.0), None, &Params::default(), &()).unwrap();
        assert!(contact.drag.abs() < 1e-14, "{}", contact.drag);
    }
}

/// The same stepped pressure on finer and finer grids: its power is a double integral that does not depend on
/// them. The slope on the middle line of the cells comes to it with an order between 1 and 2.
#[test]
fn the_drag_is_the_power_of_the_stepped_pressure_on_every_grid() {
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(5);
    let (shape, creep) = ([7, 6], standard(30.0).creep());
    for speed in [0.2, 2.0, -15.0] {
        // Spots of a few cells.
        let pressure = Field::from_shape_simple_fn(shape, || random.random_range(-1.5f64..1.0).max(0.0));
        let line = Boundary([Edge::Free, Edge::Periodic]);
        for boundary in [Boundary::FREE, line].into_iter().take(if speed == 2.0 { 2 } else { 1 }) {
            let on = |parts: usize| {
                let grid =
                    Grid::new(shape.map(|n| n * parts), [1.0, 0.8].map(|size| size / parts as f64)).unwrap();
                (grid, Field::from_shape_fn(grid.shape, |(i, j)| pressure[[i / parts, j / parts]]))
            };
            let drags = [1, 2, 3].map(|parts| {
                let (grid, pressure) = on(parts);
                SteadySliding::new(grid, boundary, &creep, speed).unwrap().drag(&pressure)
            });
            let off = drags.map(|drag| (drag / drags[2] - 1.0).abs());
            let within = if boundary == Boundary::FREE { 1e-8 } else { 1e-6 };
            assert!(off[0] < within && off[1] < within, "{boundary:?} {speed}: {drags:?}");
            if boundary != Boundary::FREE {
                continue;
            }
            let errors = [1, 2, 4].map(|parts| {
                let (grid, pressure) = on(parts);
                let near = |x: f64, _: bool| -> Option<Vec<f64>> {
                    let row = 0..grid.shape[1];
                    Some(
                        row.map(|j| normal_displacement(x, j as f64 * grid.pitch[1], grid.pitch, 1.0))
                            .collect(),
                    )
                };
                let elastic = ElasticCell { near: &near, far: &|_, _| None };
                let decays: Vec<_> =
                    creep.terms.iter().map(|term| [term.compliance, term.time * speed.abs()]).collect();
                let table = MovingCell::new(&elastic, grid.shape, grid.pitch[0], creep.glassy, &decays).slope;
                let cells: Vec<_> = pressure.indexed_iter().filter(|(_, p)| **p > 0.0).collect();
                let mut power = 0.0;
                for ((i, j), p) in &cells {
                    for ((k, l), q) in &cells {
                        let ahead =
                            if speed > 0.0 { i + grid.shape[0] - 1 - k } else { k + grid.shape[0] - 1 - i };
                        power -= *p * *q * table[[ahead, j.abs_diff(*l)]];
                    }
                }
                grid.cell_area() * power / drags[2] - 1.0
            });
            let order = [0, 1].map(|k| (errors[k] / errors[k + 1]).abs().log2());
            assert!(
                errors[0].abs() > 0.02 && (1.0..2.0).contains(&order[1]),
                "{speed}: {errors:?} {order:?}"
            );
        }
    }
}

/// On a grid of twice the pitch the displacement is the mean of that of four cells under the same pressure.
#[test]
fn a_coarse_response_is_the_mean_of_four_cells() {
    let grid = Grid::new([32, 12], [1.0, 1.5]).unwrap();
    for boundary in [Boundary::FREE, Boundary([Edge::Free, Edge::Periodic])] {
        for speed in [0.0, 3.0, -0.7] {
            let mut operator = SteadySliding::new(grid, boundary, &standard(5.0).creep(), speed).unwrap();
            let mut coarse = operator.response.coarse().unwrap();
            let rough = Field::from_shape_fn([16, 6], |(i, j)| ((7 * i * i + 3 * j) % 11) as f64);
            let fine = Field::from_shape_fn(grid.shape, |(i, j)| rough[(i / 2, j / 2)]);
            let (mut mean, mut all) = (Field::zeros([16, 6]), grid.zeros());
            coarse.displace(&rough, &mut mean);
            operator.displace(&fine, &mut all);
            let largest = mean.iter().fold(0.0f64, |most, u| most.max(u.abs()));
            for (u, cells) in mean.iter().zip(all.exact_chunks((2, 2))) {
                assert!((u - 0.25 * cells.sum()).abs() < 1e-12 * largest, "{boundary:?} {speed}");
            }
        }
    }
}

/// Returns layers (t, relaxation, ν), from the surface down, on a body, and the material with the moduli that `young` takes.
fn stack(
    layers: &[(f64, &Relaxation, f64)],
    (base, poisson): (&Relaxation, f64),
    young: fn(&Relaxation) -> f64,
) -> (ViscoelasticStack, Material) {
    let coatings = layers.iter().map(|(t, layer, nu)| Coating::new(*t, young(layer), *nu).unwrap());
    let material = Material::elastic(young(base), poisson).unwrap().layered(coatings.collect());
    let relaxation = BodyRelaxation {
        body: Some(base.clone()),
        layers: layers.iter().map(|(_, layer, _)| Some((*layer).clone())).collect(),
    };
    (ViscoelasticStack::new(&material, relaxation).unwrap(), material)
}

#[test]
fn slow_waves_see_the_relaxed_layers_and_fast_ones_the_glassy_layers() {
    let [soft, stiff, base] =
        [standard(50.0), body(&[(20.0, 0.3), (90.0, 1e-3)]), body(&[(3.0, 2.0), (5.0, 0.01)])];
    let layers = [(0.3, &soft, 0.5), (0.1, &stiff, 0.3), (2.0, &soft, 0.4)];
    for (frequency, young) in
        [(1e-11, Relaxation::relaxed as fn(&Relaxation) -> f64), (1e14, Relaxation::glassy)]
    {
        let (relaxing, elastic) = stack(&layers, (&base, 0.45), young);
        for q in [1e-3, 0.3, 1.0, 5.0, 80.0] {
            let (found, expected) = (relaxing.at(frequency).normal(q), Stack::new(&elastic).normal(q));
            assert!((found - expected).norm() < 1e-9 * expected, "{frequency}, {q}: {found} for {expected}");
        }
    }
}

#[test]
fn layers_that_are_alike_are_the_viscoelastic_half_space() {
    let rubber = body(&[(2.0, 1.0), (5.0, 0.1), (30.0, 3e-3)]);
    let nu = 0.45;
    let (relaxing, _) = stack(&[(0.1, &rubber, nu); 5], (&rubber, nu), Relaxation::relaxed);
    let rigid = Material::elastic(f64::INFINITY, 0.0).unwrap();
    let rigid = ViscoelasticStack::new(&rigid, BodyRelaxation::default()).unwrap();
    let layered = SlidingBodies::Layered { moving: relaxing, standing: rigid };
    let half_space = SlidingBodies::from(&rubber.creep().times(1.0 - nu * nu));
    for frequency in [-300.0, -1.0, 0.0, 0.02, 5.0, 1e6] {
        for q in [1e-3, 0.5, 1.0, 7.0, 300.0] {
            let [found, expected] = [&layered, &half_space].map(|bodies| bodies.at(frequency).response(q));
            assert!(
                (found - expected).norm() < 1e-12 * expected.norm(),
                "{frequency}, {q}: {found}, {expected}"
            );
        }
    }
    // The same contact and the same cost.
    let grid = Grid::new([64, 48], [0.02; 2]).unwrap();
    let gap = Field::from_shape_fn(grid.shape, |(i, j)| {
        let [x, y] = [i, j].map(|k| 0.02 * k as f64);
        0.5 * ((x - 0.64).powi(2) + (y - 0.48).powi(2)) + 2e-3 * ((40.0 * x).cos() + (60.0 * y).sin())
    });
    let [one, other] = [layered, half_space].map(|bodies| {
        let mut operator = SteadySliding::new(grid, Boundary::PERIODIC, bodies, 0.3).unwrap();
        solve_steady(&mut operator, &gap, Control::Load(0.02), None, &Params::default(), &()).unwrap()
    });
    assert!((one.drag / other.drag - 1.0).abs() < 1e-9, "{} {}", one.drag, other.drag);
    assert_eq!(one.solution.stats.convolutions, other.solution.stats.convolutions);
}

#[test]
fn a_wave_on_layers_loses_the_energy_of_their_stiffness() {
    let (n, speed, amplitude) = (48, 0.02, 1e-3);
    let grid = Grid::new([n, 4], [1.0 / n as f64; 2]).unwrap();
    let q = 2.0 * TAU;
    let gap = Field::from_shape_fn(grid.shape, |(i, _)| -amplitude * (q * i as f64 / n as f64).cos());
    let (soft, stiff) = (standard(10.0), body(&[(300.0, 0.2)]));
    let skin = [(0.02, &stiff, 0.4), (0.1, &soft, 0.3)];
    let (moving, _) = stack(&skin, (&stiff, 0.5), Relaxation::relaxed);
    let (standing, _) = stack(&[(0.05, &soft, 0.3)], (&stiff, 0.3), Relaxation::relaxed);
    let load = 0.5 * grid.area();
    // The stiffness of both bodies in series, of which the one that stands still is relaxed.
    let compliance = moving.at(q * speed).normal(q) + standing.at(0.0).normal(q);
    let expected = 0.5 * q * amplitude * amplitude * compliance.inv().im * grid.area();
    let bodies = SlidingBodies::Layered { moving, standing };
    for speed in [speed, -speed] {
        let mut operator = SteadySliding::new(grid, Boundary::PERIODIC, bodies.clone(), speed).unwrap();
        let params = Params::default().with_tolerance(1e-10);
        let contact = solve_steady(&mut operator, &gap, Control::Load(load), None, &params, &()).unwrap();
        assert!(contact.solution.pressure.iter().all(|p| *p > 0.0));
        assert!((contact.drag / expected - 1.0).abs() < 1e-9, "{}", contact.drag / expected - 1.0);
    }
    let refused = SteadySliding::new(grid, Boundary::FREE, bodies, speed).err().unwrap();
    assert!(refused.to_string().contains("layers on a grid that is not periodic"), "{refused}");
    assert!(SteadySliding::new(grid, Boundary::FREE, &Creep::elastic(1.0), speed).is_ok());
}

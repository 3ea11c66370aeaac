//! Dang Van's criterion: closed forms, invariances, and histories of random contacts one by one.

use asperity_contact::fatigue::{DangVan, StressHistory, risk};
use asperity_contact::kernel::Stack;
use asperity_contact::material::{Coating, Material};
use asperity_contact::operator::{Boundary, Edge};
use asperity_contact::reference::HertzLine;
use asperity_contact::stress::Stress;
use asperity_contact::subsurface::{Subsurface, Tractions};
use asperity_contact::{Field, Grid};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A line contact with p₀ = a = 1.
const LINE: HertzLine = HertzLine { radius: 1.0, modulus: 2.0, load_per_length: std::f64::consts::FRAC_PI_2 };

/// Limits with a = 0.3 and b = 1.
fn criterion() -> DangVan {
    DangVan::new(1.0, 3.0 / 1.8).unwrap()
}

/// The stress at a depth as the line passes over it.
fn history(depth: f64, friction: f64) -> Vec<Stress> {
    (-6000..=6000).map(|k| LINE.stress(0.002 * f64::from(k), depth, 0.3, friction)).collect()
}

#[test]
fn a_line_contact_has_its_numbers() {
    assert!((LINE.half_width() - 1.0).abs() < 1e-15 && (LINE.peak_pressure() - 1.0).abs() < 1e-15);
    let shear = history(0.5, 0.0).iter().fold(0.0f64, |most, stress| most.max(stress.xz));
    assert!((shear - 0.25).abs() < 1e-6, "{shear}");
    let of = |depth: f64, friction: f64| criterion().evaluate(&history(depth, friction))[0];
    let depths = [1e-9, 0.1, 0.25, 0.5, 0.75, 1.0, 1.5];
    for (friction, expected) in [
        (0.0, [0.1, 0.09785, 0.143584, 0.169172, 0.167828, 0.156657, 0.129594]),
        (0.1, [0.174995, 0.115245, 0.152192, 0.174041, 0.170920, 0.158748, 0.130743]),
    ] {
        for (depth, expected) in depths.into_iter().zip(expected) {
            let found = of(depth, friction);
            // The history is sampled: the ball depends on the points that it meets.
            assert!((found - expected).abs() < 2e-4, "{depth}, {friction}: {found}, expected {expected}");
        }
    }
    // The largest below the surface.
    assert!((of(0.615, 0.0) - 0.17050).abs() < 1e-4);
}

#[test]
fn simple_loads_and_invariances() {
    let of = |history: &[Stress]| criterion().evaluate(history)[0];
    let cycle = |stress: fn(f64) -> Stress| -> Vec<Stress> {
        (0..400).map(|k| stress((std::f64::consts::TAU * f64::from(k) / 400.0).sin())).collect()
    };
    let torsion = cycle(|s| Stress { xz: s, ..Stress::default() });
    let tension = cycle(|s| Stress { xx: s, ..Stress::default() });
    assert!((of(&torsion) - 1.0).abs() < 1e-5 && (of(&tension) - (0.5 + 0.1)).abs() < 1e-5);
    // At the limits of the material both reach b.
    let scaled: Vec<Stress> = tension.iter().map(|stress| 3.0 / 1.8 * *stress).collect();
    assert!((of(&scaled) - 1.0).abs() < 1e-5);
    let path = history(0.6, 0.05);
    let f = of(&path);
    let with = |more: Stress| path.iter().map(|stress| *stress + more).collect::<Vec<_>>();
    let deviator = Stress { xx: 0.3, yy: -0.1, zz: -0.2, yz: 0.4, xz: -0.5, xy: 0.2 };
    let hydrostatic = Stress { xx: 0.2, yy: 0.2, zz: 0.2, ..Stress::default() };
    let reversed: Vec<Stress> = path.iter().rev().copied().collect();
    let tripled: Vec<Stress> = path.iter().map(|stress| 3.0 * *stress).collect();
    let turned: Vec<Stress> =
        path.iter().map(|s| Stress { xx: s.zz, yy: s.xx, zz: s.yy, yz: s.xy, xz: s.yz, xy: s.xz }).collect();
    for (what, found, expected) in [
        ("deviator", of(&with(deviator)), f),
        ("hydrostatic", of(&with(hydrostatic)), f + 0.3 * 0.2),
        ("reversed", of(&reversed), f),
        ("tripled", of(&tripled), 3.0 * f),
        ("turned", of(&turned), f),
    ] {
        assert!((found - expected).abs() < 1e-8, "{what}: {found}, expected {expected}");
    }
    assert_eq!(of(&[]), f64::NEG_INFINITY);
}

#[test]
fn random_passes_are_those_of_their_stresses_one_by_one() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    for case in 0..12 {
        let shape = [random.random_range(3..7), random.random_range(2..5)];
        let grid = Grid::new(shape, [1.0, random.random_range(0.5..2.0)]).unwrap();
        let boundary = [Boundary::FREE, Boundary::PERIODIC, Boundary([Edge::Free, Edge::Periodic])][case % 3];
        let positions = random.random_range(1..12);
        let contacts: Vec<Tractions> = (0..positions)
            .map(|_| {
                let mut field = |least: f64| {
                    Field::from_shape_simple_fn(shape, || random.random_range(-1.0f64..1.0).max(least))
                };
                Tractions { pressure: field(0.0), shear: [Some(0.3 * field(-1.0)), Some(0.3 * field(-1.0))] }
            })
            .collect();
        let depths = [0.0, 0.4, 1.5];
        let pass = StressHistory::new(grid, boundary, 0.3, positions, |at| contacts[at].clone());
        let found = pass.dang_van(&criterion(), &depths).unwrap();
        for (depth, found) in depths.into_iter().zip(&found) {
            let planes: Vec<_> = contacts
                .iter()
                .map(|tractions| Subsurface::new(grid, boundary, 0.3, tractions).plane(depth))
                .collect();
            for cell in ndarray::indices(shape).into_iter().map(|(i, j)| [i, j]) {
                let history: Vec<Stress> = planes.iter().map(|plane| plane.stress(cell)).collect();
                let [f, radius] = criterion().evaluate(&history);
                assert!((found.f[cell] - f).abs() < 1e-8, "case {case}: {} {f}", found.f[cell]);
                assert!((found.radius[cell] - radius).abs() < 1e-9);
                let shears = || history.iter().map(|stress| stress.xz);
                let range =
                    shears().fold(f64::NEG_INFINITY, f64::max) - shears().fold(f64::INFINITY, f64::min);
                assert!((found.shear_amplitude[cell] - 0.5 * range).abs() < 1e-12);
            }
        }
    }
}

/// Layers like the body below them change nothing; a stiffer one bears the contact in place of the body.
#[test]
fn a_body_below_layers_sees_the_stress_of_a_body_below_layers() {
    let grid = Grid::new([12, 6], [1.0, 1.5]).unwrap();
    let ridge = |at: usize| {
        let pressure = Field::from_shape_fn(grid.shape, |(i, j)| if i == at && j != 2 { 1.0 } else { 0.0 });
        Tractions { shear: [Some(0.2 * &pressure), None], pressure }
    };
    let body = Material::elastic(2.0, 0.3).unwrap();
    let depths = [1.25, 2.5];
    for boundary in [Boundary::FREE, Boundary::PERIODIC, Boundary([Edge::Free, Edge::Periodic])] {
        let plain = || StressHistory::new(grid, boundary, 0.3, 12, ridge);
        let layered = |young: f64| {
            let layers = [0.5, 0.75].map(|thickness| Coating::new(thickness, young, 0.3).unwrap()).to_vec();
            plain()
                .with_layers(Stack::new(&body.clone().layered(layers)))
                .dang_van(&criterion(), &depths)
                .unwrap()
        };
        let expected = plain().dang_van(&criterion(), &depths).unwrap();
        for (found, expected) in layered(2.0).iter().zip(&expected) {
            let furthest = (&found.f - &expected.f).iter().fold(0.0f64, |most, f| most.max(f.abs()));
            assert!(furthest < 1e-7, "{boundary:?}: {furthest}");
        }
        let most = |f: &Field| f.iter().copied().fold(0.0, f64::max);
        assert!(most(&layered(20.0)[0].f) < 0.8 * most(&expected[0].f), "{boundary:?}");
    }
}

#[test]
fn the_life_of_a_line_falls_with_the_fourth_power_of_its_load() {
    // Twice the load: √2 times the pressure and the width.
    let of = |scale: f64| {
        let depths: Vec<f64> = (1..=400).map(|k| 0.01 * f64::from(k) * scale).collect();
        let amplitude = |z: &f64| {
            let shears = history(z / scale, 0.0).into_iter().map(|stress| stress.xz.abs());
            scale * shears.fold(0.0, f64::max)
        };
        risk(&depths, &depths.iter().map(amplitude).collect::<Vec<_>>(), 0.0)
    };
    let exponent = (of(2f64.sqrt()) / of(1.0)).log2() / (9.0 / 8.0);
    assert!((exponent - 4.0).abs() < 1e-9, "{exponent}");
}

#[test]
fn what_is_no_history_is_refused() {
    let grid = Grid::new([4, 4], [1.0; 2]).unwrap();
    let none = |positions: usize| {
        StressHistory::new(grid, Boundary::FREE, 0.3, positions, |_| Tractions::frictionless(grid.zeros()))
    };
    assert!(none(0).dang_van(&criterion(), &[1.0]).unwrap_err().to_string().contains("contacts"));
    assert!(none(1).dang_van(&criterion(), &[-1.0]).unwrap_err().to_string().contains("depth"));
    let stopped = none(1).until(&|| true).dang_van(&criterion(), &[1.0]).unwrap_err();
    assert!(matches!(stopped, asperity_base::Error::Interrupted));
    assert!(none(3).dang_van(&criterion(), &[1.0]).unwrap()[0].f.iter().all(|f| *f == 0.0));
}

//! User-defined elastic responses, from outside the library: all kinds of contacts accept them.

use asperity_base::error::Error;
use asperity_base::{Field, Grid};
use asperity_contact::kernel::{HalfSpaces, Influence, Layering, Response};
use asperity_contact::material::{Coating, Material};
use asperity_contact::motion::{
    LoadControl, Motion, Pair, PlasticUpdate, Simulation, SlipRegime, Stage, Strategy, load_in_stages, press,
};
use asperity_contact::operator::{Boundary, DirectSum, Edge, FreeFft, Operator, Operators, PeriodicFft};
use asperity_contact::solver::{
    Bounds, Control, Coupling, Creep, Friction, Loading, Method, Params, Rolling, Tangential, solve_normal,
};
use asperity_surface::LowPass;

/// Half-spaces under a bed of springs, u = kp, which deforms only under pressure.
#[derive(Debug)]
struct Sprung {
    modulus: f64,
    compliance: f64,
}

impl Response for Sprung {
    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64 {
        match HalfSpaces::from(self.modulus).harmonic_displacement(qx, qy) {
            0.0 => 0.0,
            displacement => displacement + self.compliance,
        }
    }

    fn influence(&self, pitch: [f64; 2]) -> Box<dyn Influence> {
        let (half_spaces, compliance) = (HalfSpaces::from(self.modulus).influence(pitch), self.compliance);
        Box::new(move |x: f64, y: f64| {
            half_spaces.displacement(x, y) + if (x, y) == (0.0, 0.0) { compliance } else { 0.0 }
        })
    }
}

/// A body whose stiffness increases with depth, given by its harmonics alone.
#[derive(Debug)]
struct Graded;

impl Response for Graded {
    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64 {
        let q = qx.hypot(qy);
        if q == 0.0 { 0.0 } else { graded(q) }
    }

    fn influence(&self, pitch: [f64; 2]) -> Box<dyn Influence> {
        Layering { short: 1.0, long: 0.25, depth: 3e-6 }.influence(graded, pitch)
    }
}

fn graded(q: f64) -> f64 {
    let x = 3e-6 * q;
    2.0 / q * (1.0 - 0.75 * (1.0 + 0.5 * x) * (-x).exp())
}

const FRICTIONLESS: SlipRegime = SlipRegime::Frictionless;

const GRID: Grid = Grid { shape: [20, 18], pitch: [1e-6, 1.3e-6] };

fn rough_pair(materials: [&Material; 2]) -> Pair {
    let rough = LowPass::new(35e-9, [5e-6; 2]);
    let [lower, upper] = [1, 2].map(|seed| rough.generate(&GRID, seed).unwrap());
    Pair::new(lower, upper.underside(), materials).unwrap()
}

fn steel() -> Material {
    Material::new(210e9, 0.3, 4e9).unwrap()
}

#[test]
fn a_contact_of_ones_own_bodies_is_that_of_a_sum_of_ones_own_cells() {
    let (modulus, compliance) = (115e9, 2e-17);
    let pair = rough_pair([&steel(), &steel()]).with_response(Sprung { modulus, compliance });
    let params = Params::default().with_tolerance(1e-10).with_method(Method::ActiveSet);
    let found = press(&pair, Boundary::FREE, Control::Load(0.3), FRICTIONLESS, &params, &()).unwrap();
    let (record, solution) = (found.record, found.solution.into_normal());
    // u = Cp from the coefficients of half-spaces, cell by cell, and from the springs. The gap is never below
    // 0, and it is 0 under pressure below the hardness.
    let mut displacement = Field::zeros(GRID.shape);
    DirectSum::new(GRID, modulus).apply(&solution.pressure, &mut displacement);
    displacement.scaled_add(compliance, &solution.pressure);
    let gap = &pair.upper.heights - &pair.lower.heights + &displacement - solution.approach;
    let size = displacement.std(0.0);
    for (g, p) in gap.iter().zip(&solution.pressure) {
        assert!(*g > -1e-8 * size || *p >= 4e9, "gap {g:e}");
        assert!(*p == 0.0 || *g < 1e-8 * size, "gap {g:e} under {p:e}");
    }
    assert!((record.load / 0.3 - 1.0).abs() < 1e-9 && record.contact_area > 0.0);
    // It differs from the contact without springs.
    let plain = rough_pair([&steel(), &steel()]);
    let plain = press(&plain, Boundary::FREE, Control::Load(0.3), FRICTIONLESS, &params, &()).unwrap().record;
    assert!(record.approach > plain.approach + 1e-3 * size);
}

#[test]
fn all_methods_find_the_same_contact_of_ones_own_bodies() {
    let gap = {
        let pair = rough_pair([&steel(), &steel()]);
        &pair.upper.heights - &pair.lower.heights
    };
    let operators: [fn() -> Box<dyn Operator>; 4] = [
        || Box::new(FreeFft::new(GRID, Sprung { modulus: 1.0, compliance: 2e-6 })),
        || Box::new(PeriodicFft::new(GRID, Sprung { modulus: 1.0, compliance: 2e-6 })),
        || Box::new(FreeFft::new(GRID, Graded)),
        || Box::new(PeriodicFft::new(GRID, Graded)),
    ];
    for (n, operator) in operators.into_iter().enumerate() {
        let [direct, active_set, polonsky_keer] = [Method::Direct, Method::ActiveSet, Method::PolonskyKeer]
            .map(|method| {
                let params = Params::default().with_tolerance(1e-9).with_method(method);
                let control = Control::Load(0.004 * GRID.area());
                solve_normal(operator().as_mut(), &gap, &Bounds::up_to(0.05), control, None, &params).unwrap()
            });
        let largest = direct.max_pressure();
        for other in [active_set, polonsky_keer] {
            let error = (&other.pressure - &direct.pressure).fold(0.0, |most: f64, p| most.max(p.abs()));
            assert!(error < 1e-6 * largest, "{n}: {:e}", error / largest);
        }
    }
}

#[test]
fn transforms_of_ones_own_bodies_are_the_direct_sum_on_fine_and_coarse_grids() {
    let pressure = Field::from_shape_fn(GRID.shape, |(i, j)| ((7 * i + 3 * j * j) % 11) as f64);
    let (mut fast, mut slow) = (GRID.zeros(), GRID.zeros());
    FreeFft::new(GRID, Graded).apply(&pressure, &mut fast);
    DirectSum::new(GRID, Graded).apply(&pressure, &mut slow);
    let largest = slow.fold(0.0, |most: f64, u| most.max(u.abs()));
    assert!((&fast - &slow).iter().all(|error| error.abs() < 1e-13 * largest));
    let coarse = FreeFft::new(GRID, Graded).coarse();
    let own = Graded.influence(coarse.grid().pitch).displacement(0.0, 0.0);
    assert_eq!(coarse.influence(0, 0), own);
}

#[test]
fn what_is_not_known_of_a_response_is_refused() {
    let pair = || rough_pair([&steel(), &steel()]).with_response(Graded);
    let params = Params::default();
    let load = Control::Load(0.1);
    let unsupported = |error: Error, word: &str| {
        assert!(matches!(error, Error::Unsupported(_)), "{error}");
        assert!(error.to_string().contains(word), "{error}");
    };
    let line = Boundary([Edge::Free, Edge::Periodic]);
    unsupported(
        press(&pair(), line, load, FRICTIONLESS, &params, &()).unwrap_err(),
        "periodic along one axis",
    );
    let friction = Friction::coulomb(0.2).unwrap();
    let loading = Loading { normal: load, tangential: Tangential::Force([0.01, 0.0]) };
    let stages = [Stage::new(loading, 1)];
    let loaded =
        load_in_stages(&pair(), Boundary::FREE, Some(&friction), &stages, &params, None, &(), &mut []);
    unsupported(loaded.map(|_| ()).unwrap_err(), "gross sliding");
    let rolling = Rolling { creep: Creep::Creepage([0.001, 0.0]), spin: 0.0 };
    let rolled = press(&pair(), Boundary::FREE, load, SlipRegime::Rolling(friction, rolling), &params, &());
    unsupported(rolled.map(|_| ()).unwrap_err(), "gross sliding");
    for (coupling, slides) in [(Coupling::Full, false), (Coupling::None, true)] {
        let motion = Motion::new(Strategy::Overlap, Control::Load(0.05))
            .with_passes(1)
            .with_stride(4)
            .with_load_control(LoadControl::Pass)
            .with_plastic_update(PlasticUpdate::Pass)
            .with_friction(Some(friction.with_coupling(coupling)))
            .with_load_tolerance(1e-3);
        let made = Simulation::new(pair(), Boundary::FREE, motion, params);
        if slides {
            made.unwrap().run(&(), &mut []).unwrap()
        } else {
            unsupported(made.map(|_| ()).unwrap_err(), "gross sliding")
        }
    }
}

#[test]
fn materials_with_a_coating_press_as_their_two_bodies() {
    let rigid = Material::elastic(f64::INFINITY, 0.3).unwrap();
    let coating = Coating::new(2e-6, 5e9, 0.4).unwrap();
    let coated = Material::elastic(3e9, 0.35).unwrap().coated(coating);
    let largest = |pair: &Pair, pressure: &Field, boundary| {
        let mut displacement = GRID.zeros();
        Operators::new(GRID, pair.response().clone(), boundary)
            .on(GRID.shape)
            .apply(pressure, &mut displacement);
        displacement
    };
    let pressure = Field::from_shape_fn(GRID.shape, |(i, j)| ((7 * i + 3 * j * j) % 11) as f64);
    for boundary in [Boundary::FREE, Boundary::PERIODIC] {
        let of =
            |lower: &Material, upper: &Material| largest(&rough_pair([lower, upper]), &pressure, boundary);
        let both = of(&coated, &steel().coated(coating));
        let sum = of(&coated, &rigid) + of(&rigid, &steel().coated(coating));
        let size = both.fold(0.0, |most: f64, u| most.max(u.abs()));
        assert!((&both - &sum).iter().all(|error| error.abs() < 1e-12 * size));
        // A coated rigid body is valid.
        let thin = of(&rigid.clone().coated(coating), &rigid);
        assert!(thin.iter().any(|u| *u > 0.0));
    }
}

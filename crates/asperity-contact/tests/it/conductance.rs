//! Conductance compared with an independent program, and with stiffnesses of load sweeps.
//!
//! `data/conductance.json` contains its numbers: spots with film and gas, and rough contacts.

use asperity_base::ndarray::Array2;
use asperity_base::{Field, Grid};
use asperity_contact::conductance::{
    Bracket, Conductance, Joint, JointRoughness, Kind, full_resistance, solve,
};
use asperity_contact::operator::{Boundary, Edge, FreeFft, Operator, Operators, PeriodicFft};
use asperity_contact::solver::{Bounds, Control, Method, Params, Solution, solve_normal};
use asperity_surface::LowPass;
use serde_json::Value;

fn data() -> Value {
    serde_json::from_str(include_str!("../data/conductance.json")).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn fine(tolerance: f64) -> Params {
    Params::default().with_method(Method::ActiveSet).with_tolerance(tolerance)
}

const CLEAN: Joint = Joint::new(Kind::Thermal);

#[test]
fn spots_film_and_gas_are_those_of_an_independent_program() {
    for case in data()["cases"].as_array().unwrap() {
        let [nx, ny] = [0, 1].map(|axis| case["shape"][axis].as_u64().unwrap() as usize);
        let pitch = [0, 1].map(|axis| number(&case["pitch"][axis]));
        let grid = Grid::new([nx, ny], pitch).unwrap();
        let gap = Field::from_shape_fn([nx, ny], |(i, j)| number(&case["gap"][i * ny + j]));
        let touching = gap.mapv(|gap| gap == 0.0);
        let film = CLEAN.with_film(number(&case["film"]));
        let both = film.with_gas(number(&case["gas_conductivity"]), number(&case["jump"]));
        for (boundary, word) in [(Boundary::FREE, "free"), (Boundary::PERIODIC, "periodic")] {
            let mut operator = Operators::new(grid, 1.0, boundary).on(grid.shape);
            for (joint, name) in [(CLEAN, "spots"), (film, "with_film"), (both, "with_film_and_gas")] {
                let found = solve(operator.as_mut(), &touching, Some(&gap), &joint, None, &fine(1e-11));
                let found = found.unwrap();
                let found = match word {
                    "free" => found.conductance,
                    _ => found.joint_conductance(None),
                };
                let (found, expected) = (found.unwrap(), number(&case[word][name]));
                assert!((found / expected - 1.0).abs() < 2e-12, "{word}, {name}: {found}, {expected}");
            }
        }
    }
}

/// The surface of the other program: the same waves on any grid.
fn surface(data: &Value, seed: &str, n: usize) -> Field {
    let mut phases = data["phases"][seed].as_array().unwrap().iter().map(number);
    let turn = std::f64::consts::TAU;
    let table: Vec<(f64, f64)> = (0..n).map(|i| (turn * i as f64 / n as f64).sin_cos()).collect();
    let mut heights = Field::zeros([n, n]);
    let mut slope = 0.0;
    for k in -17..=17_i64 {
        for l in 0..=17_i64 {
            let frequency = (k as f64).hypot(l as f64);
            if frequency == 0.0 || frequency > 16.0 || (l == 0 && k <= 0) {
                continue;
            }
            let amplitude = frequency.max(4.0).powf(-1.8);
            slope += 2.0 * (amplitude * turn * frequency).powi(2);
            let (sin, cos) = phases.next().unwrap().sin_cos();
            heights.indexed_iter_mut().for_each(|((i, j), z)| {
                let (s, c) = table[(k * i as i64 + l * j as i64).rem_euclid(n as i64) as usize];
                *z += 2.0 * amplitude * (c * cos - s * sin);
            });
        }
    }
    heights / slope.sqrt()
}

fn gap_of(heights: &Field) -> Field {
    let most = heights.iter().copied().fold(f64::MIN, f64::max);
    heights.mapv(|z| most - z)
}

fn unit(n: usize) -> Grid {
    Grid::new([n, n], [1.0 / n as f64; 2]).unwrap()
}

fn press(operator: &mut dyn Operator, gap: &Field, hardness: f64, load: f64, tolerance: f64) -> Solution {
    let (bounds, load) = (Bounds::up_to(hardness), Control::Load(load));
    solve_normal(operator, gap, &bounds, load, None, &fine(tolerance)).unwrap()
}

fn conduct(operator: &mut dyn Operator, contact: &Solution) -> Conductance {
    let touching = contact.pressure.mapv(|p| p > 0.0);
    solve(operator, &touching, None, &CLEAN, None, &fine(1e-8)).unwrap()
}

#[test]
fn rough_joints_conduct_as_in_an_independent_program_and_nearly_as_by_correlations() {
    let data = data();
    for seed in ["1", "2"] {
        let heights = surface(&data, seed, 128);
        let gap = gap_of(&heights);
        let mut operator = PeriodicFft::new(unit(128), 1.0);
        let sigma = (heights.iter().map(|z| z * z).sum::<f64>() / heights.len() as f64).sqrt();
        for row in data["joints"].as_array().unwrap() {
            if row["seed"].as_u64() != seed.parse().ok() {
                continue;
            }
            let capped = row["law"] == "capped";
            // The other program states loads by the mean slope, as its hardness or its mean pressure is
            // round.
            let hardness = if number_or(&row["H_over_Em"], 1.0) > 0.1 { 0.1 } else { 0.03 };
            let (slope, load, hardness) = if capped {
                (hardness / number(&row["H_over_Em"]), hardness * number(&row["P_over_H"]), hardness)
            } else {
                let slope = mean_slope(&heights);
                (slope, number(&row["P_over_Em"]) * slope, f64::INFINITY)
            };
            let contact = press(&mut operator, &gap, hardness, load, 1e-9);
            let found = conduct(&mut operator, &contact);
            let h = found.joint_conductance(None).unwrap();
            let scaled = h * sigma / slope;
            let error = scaled / number(&row["h"]) - 1.0;
            assert!(error.abs() < 2e-3, "{row}: {scaled}, {error:e}");
            let roughness = JointRoughness { height: sigma, slope };
            let (correlation, written, range) = if capped {
                let h = roughness.cooper_mikic_yovanovich(1.0, load, hardness);
                (h.unwrap(), number(&row["cmy"]), 0.74..1.08)
            } else {
                (roughness.mikic(1.0, load, 1.0).unwrap(), number(&row["mikic"]), 0.82..1.04)
            };
            assert!((correlation * sigma / slope / written - 1.0).abs() < 1e-5, "{row}: {correlation}");
            assert!(range.contains(&(h / correlation)), "{row}: {h} {correlation}");
            if capped {
                // Elastic cells alone conduct far less.
                let elastic = solve(&mut operator, &contact.elastic_cells(), None, &CLEAN, None, &fine(1e-6));
                assert!(elastic.unwrap().conductance.unwrap() < 0.5 * found.conductance.unwrap());
            }
        }
        // Neighbouring differences are below the slope by the sinc of the shortest waves.
        let roughness = JointRoughness::new(&unit(128), &gap, [true; 2]);
        assert!((roughness.height / sigma - 1.0).abs() < 1e-9);
        assert!((roughness.slope / mean_slope(&heights) - 1.0).abs() < 0.1, "{roughness:?}");
    }
}

fn number_or(value: &Value, otherwise: f64) -> f64 {
    value.as_f64().unwrap_or(otherwise)
}

/// Mean |∂z/∂x| by central differences of order 8, which the shortest wave of eight cells has to 1e-3.
fn mean_slope(heights: &Field) -> f64 {
    let n = heights.nrows();
    let weights = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
    let at = |i: usize, j: usize| -> f64 {
        let pairs = weights.iter().zip(1..);
        n as f64
            * pairs.map(|(w, k)| w * (heights[[(i + k) % n, j]] - heights[[(i + n - k) % n, j]])).sum::<f64>()
    };
    let slopes = (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).map(|(i, j)| at(i, j).abs());
    slopes.sum::<f64>() / (n * n) as f64
}

#[test]
fn a_rough_conductance_is_that_of_an_independent_program_and_lies_in_its_bracket() {
    let data = data();
    let gap = gap_of(&surface(&data, "4", 128));
    let mut operator = PeriodicFft::new(unit(128), 1.0);
    for row in data["barber"].as_array().unwrap() {
        let load = number(&row["load"]);
        let contact = press(&mut operator, &gap, f64::INFINITY, load, 1e-10);
        let area = contact.contact_cells() as f64 / 128f64.powi(2);
        let h = conduct(&mut operator, &contact).joint_conductance(None).unwrap();
        assert!((area - number(&row["area"])).abs() < 1e-3, "{row}: {area}");
        assert!((h / number(&row["conductance"]) - 1.0).abs() < 1e-4, "{row}: {h}");
    }
    let mut free = FreeFft::new(unit(128), 1.0);
    for row in data["holm_greenwood"].as_array().unwrap() {
        // The other program computes the contact under a periodic boundary, its resistance under a free one.
        let contact = press(&mut operator, &gap, f64::INFINITY, number(&row["load"]), 1e-10);
        let found = conduct(&mut free, &contact);
        let ratio = found.holm_greenwood(1.0).unwrap() / found.resistance().unwrap() - 1.0;
        assert!((ratio - number(&row["ratio"])).abs() < 2e-3, "{row}: {ratio}");
    }
}

#[test]
fn conductance_converges_before_the_area_of_contact() {
    let data = data();
    let [coarse, middle, fine] = [64, 128, 256].map(|n| {
        let gap = gap_of(&surface(&data, "4", n));
        let mut operator = PeriodicFft::new(unit(n), 1.0);
        let contact = press(&mut operator, &gap, f64::INFINITY, 0.055, 1e-8);
        let h = conduct(&mut operator, &contact).joint_conductance(None).unwrap();
        [h, contact.contact_cells() as f64 / (n * n) as f64]
    });
    let off = |one: [f64; 2], quantity: usize| (one[quantity] / fine[quantity] - 1.0).abs();
    assert!(off(middle, 0) < 2e-3 && off(coarse, 0) < 6e-3, "{coarse:?} {middle:?} {fine:?}");
    assert!(off(coarse, 1) > 0.05, "{coarse:?} {middle:?} {fine:?}");
}

/// Load over approach on either side of a contact, under loads 1 % less and more.
#[test]
fn random_elastic_contacts_conduct_as_they_are_stiff() {
    let mut largest = 0.0f64;
    for seed in 0..100 {
        let n = 40 + (seed % 5) as usize * 3;
        let grid = Grid::new([n, n + seed as usize % 7], [1e-6, 1.2e-6]).unwrap();
        let shortest = [4e-6, 6e-6, 9e-6][seed as usize % 3];
        let gap = LowPass::new(0.2e-6, [shortest; 2]).generate(&grid, seed).unwrap();
        let gap = gap_of(gap.heights());
        let (modulus, composite) = (1e11, 46.0);
        let boundary = if seed % 2 == 0 { Boundary::PERIODIC } else { Boundary::FREE };
        let load = modulus * grid.area() * 1e-3 * 1.04f64.powi(seed as i32);
        let mut operator = Operators::new(grid, modulus, boundary).on(grid.shape);
        let contacts =
            [0.99, 1.0, 1.01].map(|share| press(operator.as_mut(), &gap, f64::INFINITY, share * load, 1e-10));
        let points: Vec<_> = contacts.iter().map(|contact| (contact.load(), contact.approach)).collect();
        let bracket = Bracket::of_sweep(&points, composite, modulus)[1];
        let mut conductor = Operators::new(grid, composite, boundary).on(grid.shape);
        let touching: Array2<bool> = contacts[1].pressure.mapv(|p| p > 0.0);
        let joint = Joint::new(Kind::Thermal);
        let found = solve(conductor.as_mut(), &touching, None, &joint, None, &fine(1e-9)).unwrap();
        let Some(conductance) = found.conductance else { continue };
        assert!(bracket.holds(conductance, 1e-5), "{seed}: {bracket:?} {conductance}");
        assert!(!bracket.holds(1.1 * conductance, 1e-5) && !bracket.holds(0.9 * conductance, 1e-5));
        let mean = 0.5 * (bracket.lower + bracket.upper);
        largest = largest.max((mean / conductance - 1.0).abs());
    }
    assert!(largest < 2e-2, "{largest}");
}

/// The same roughness on maps of more and more periods: the spreading from the outline grows, the joint stays
/// that of the period. Both pressure and flux crowd at the outline, so that the drop across the joint is
/// nearly even.
#[test]
fn a_joint_under_a_free_boundary_is_that_of_the_period_whatever_the_size_of_the_map() {
    let n = 24;
    let wave = |x: usize, y: usize| {
        let [x, y] = [x, y].map(|i| std::f64::consts::TAU * i as f64 / n as f64);
        0.02 * ((x + y).cos()
            + (2.0 * x - y).sin()
            + 0.7 * (2.0 * y + 1.0).cos()
            + 0.5 * (3.0 * x + 2.0 * y).sin())
    };
    for (pressure, joint) in [(0.01, CLEAN), (0.04, CLEAN), (0.04, CLEAN.with_film(0.05))] {
        let of = |tiles: usize, boundary: Boundary| {
            let grid = Grid::new([tiles * n; 2], [1.0 / n as f64; 2]).unwrap();
            let gap = Field::from_shape_fn(grid.shape, |(i, j)| wave(i, j));
            let mut operator = Operators::new(grid, 1.0, boundary).on(grid.shape);
            let contact = press(operator.as_mut(), &gap, f64::INFINITY, pressure * grid.area(), 1e-8);
            let touching = contact.pressure.mapv(|p| p > 0.0);
            let found = solve(operator.as_mut(), &touching, None, &joint, None, &fine(1e-9)).unwrap();
            let full = full_resistance(operator.as_mut(), &fine(1e-9)).unwrap();
            [found.joint_conductance(full).unwrap(), found.conductance.unwrap() / grid.area()]
        };
        let [expected, _] = of(1, Boundary::PERIODIC);
        let found = [3, 6, 9].map(|tiles| of(tiles, Boundary::FREE));
        // A period has few spots, whose conductance is not in proportion to the pressure.
        assert!(found.iter().all(|[joint, _]| (joint / expected - 1.0).abs() < 0.18), "{expected} {found:?}");
        assert!((found[2][0] / found[1][0] - 1.0).abs() < 0.05, "{found:?}");
        assert!(found[2][1] < 0.75 * found[1][1], "the conductance over the area falls: {found:?}");
    }
}

#[test]
fn what_cannot_be_split_is_no_joint() {
    let grid = unit(48);
    let disc = |radius: f64| {
        Array2::from_shape_fn(grid.shape, |(i, j)| (i as f64 - 23.5).hypot(j as f64 - 23.5) < 48.0 * radius)
    };
    let stripe =
        |width: f64| Array2::from_shape_fn(grid.shape, |(i, _)| (i as f64 - 23.5).abs() < 24.0 * width);
    let line = Boundary([Edge::Free, Edge::Periodic]);
    for (touching, boundary, is_joint) in [
        (disc(0.15), Boundary::FREE, false),
        (disc(0.15), Boundary::PERIODIC, true),
        (stripe(0.2), line, false),
        (stripe(0.2), Boundary::FREE, false),
        (stripe(0.9), line, true),
        (disc(2.0), Boundary::FREE, false),
        (disc(0.0), Boundary::FREE, true),
    ] {
        let mut operator = Operators::new(grid, 1.0, boundary).on(grid.shape);
        let found = solve(operator.as_mut(), &touching, None, &CLEAN, None, &fine(1e-9)).unwrap();
        let full = full_resistance(operator.as_mut(), &fine(1e-9)).unwrap();
        let joint = found.joint_conductance(full);
        assert_eq!(
            joint.is_some(),
            is_joint,
            "{boundary:?} {}: {joint:?}",
            found.spots.areas.iter().sum::<f64>()
        );
        assert!(found.conductance.is_some());
    }
}

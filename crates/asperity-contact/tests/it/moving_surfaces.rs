//! The motion compared with an independent dense implementation (numpy and scipy): two surfaces of 12 × 12
//! cells.
//!
//! `data/moving_surfaces_12.json` contains its numbers, computed with exact active sets and pass-mean loads
//! to 1e-12.

use asperity_base::{Field, Grid};
use asperity_contact::material::Material;
use asperity_contact::motion::{Contact, Motion, Pair, PlasticUpdate, Simulation, Strategy};
use asperity_contact::operator::{Boundary, DirectSum, Operator};
use asperity_contact::solver::{Method, Params};
use asperity_surface::Topography;
use serde_json::Value;

use crate::support::{Held, Kept, assert_close, at_approach, pass_load};

/// Tolerance of each method, relative to the largest value of its kind.
const METHODS: [(Method, f64); 2] = [(Method::Direct, 1e-8), (Method::ActiveSet, 1e-5)];

fn case() -> Value {
    serde_json::from_str(include_str!("../data/moving_surfaces_12.json")).unwrap()
}

fn field(value: &Value, scale: f64) -> Field {
    let rows = value.as_array().unwrap();
    let columns = rows[0].as_array().unwrap().len();
    Field::from_shape_fn([rows.len(), columns], |(i, j)| value[i][j].as_f64().unwrap() * scale)
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

/// Two bodies with equal hardness, one of them rigid, with the composite modulus of the case.
fn pair(case: &Value, hardness: f64, share: f64) -> Pair {
    let grid = Grid::new([12, 12], [1e-6, 1e-6]).unwrap();
    let topography = |key: &str| Topography::new(grid, field(&case[key], 1e-12)).unwrap();
    let modulus = case["Estar"].as_f64().unwrap();
    let soft = Material::new(modulus, 0.0, hardness).unwrap();
    let rigid = Material::new(f64::INFINITY, 0.0, hardness).unwrap();
    let pair = Pair::new(topography("Z1_pm"), topography("Z2_pm"), [&soft, &rigid]).unwrap();
    pair.with_plastic_share(share)
}

fn motion((control, load_control): Held, plastic_update: PlasticUpdate) -> Motion {
    Motion::new(Strategy::Overlap, control)
        .with_passes(1)
        .with_stride(1)
        .with_load_control(load_control)
        .with_plastic_update(plastic_update)
        .with_load_tolerance(1e-12)
        .with_friction(None)
}

fn params(method: Method) -> Params {
    Params::default().with_method(method).with_tolerance(1e-11)
}

fn run(pair: Pair, motion: Motion, method: Method) -> Kept {
    Kept::run(Simulation::new(pair, Boundary::FREE, motion, params(method)).unwrap())
}

fn loads(contacts: &[Contact]) -> Vec<f64> {
    contacts.iter().map(|c| c.load).collect()
}

fn assert_counts(contacts: &[Contact], expected: &Value, what: &str) {
    let contact: Vec<f64> = contacts.iter().map(|c| c.pressure.len() as f64).collect();
    let capped: Vec<f64> = contacts.iter().map(|c| c.plastic.len() as f64).collect();
    assert_eq!(contact, numbers(&expected["n_contact"]), "cells in contact, {what}");
    assert_eq!(capped, numbers(&expected["n_capped"]), "cells at the hardness, {what}");
}

#[test]
fn a_pass_at_a_fixed_approach_has_the_loads_pressures_and_energies_of_the_reference() {
    let case = case();
    let (area, modulus) = (1e-12, case["Estar"].as_f64().unwrap());
    for expected in case["fixed_r"].as_array().unwrap() {
        let (approach, tag) = (expected["r"].as_f64().unwrap(), expected["tag"].as_str().unwrap());
        let hardness = if tag == "capped" { case["H"].as_f64().unwrap() } else { f64::INFINITY };
        for (method, tolerance) in METHODS {
            let what = format!("{tag} at {approach:e} by {method:?}");
            let initial = pair(&case, hardness, 0.5);
            let motion = motion(at_approach(approach), PlasticUpdate::Pass);
            let kept = run(initial.clone(), motion, method);
            let contacts = &kept.contacts[0];
            assert_counts(contacts, expected, &what);
            assert_close(&loads(contacts), &numbers(&expected["F_k"]), tolerance, &what);
            let peaks: Vec<f64> = contacts.iter().map(Contact::max_pressure).collect();
            assert_close(&peaks, &numbers(&expected["pmax_k"]), tolerance, &what);
            let plastic: Vec<f64> = contacts.iter().map(|c| c.plastic_volume(&initial) / area).collect();
            assert_close(&plastic, &numbers(&expected["wp_sum_k"]), tolerance, &what);
            // The complementary energy without the cell area, as in the reference: ½ pᵀCp − pᵀ(δ − h).
            let energies: Vec<f64> = contacts
                .iter()
                .map(|contact| {
                    let p = contact.pressure_field(12);
                    let mut u = Field::zeros(p.raw_dim());
                    DirectSum::new(initial.grid(p.nrows()), modulus).apply(&p, &mut u);
                    let gap = initial.initial_gap(&contact.position);
                    (&p * &(0.5 * &u - approach + &gap)).sum()
                })
                .collect();
            assert_close(&energies, &numbers(&expected["energy_k"]), tolerance, &what);
            let key = format!("{tag}_{}", (approach * 1e9).round());
            for (step, kind) in [(11, "pressure_full"), (2, "pressure_k3")] {
                let p = contacts[step].pressure_field(12);
                let expected = field(&case[kind][&key], 1.0);
                assert_close(p.as_slice().unwrap(), expected.as_slice().unwrap(), tolerance, &what);
            }
            let mut plastic = Field::zeros([12, 12]);
            contacts[11]
                .plastic
                .iter()
                .for_each(|(cell, w)| plastic.as_slice_mut().unwrap()[*cell as usize] = *w);
            let expected = field(&case["plastic_full"][&key], 1.0);
            assert_close(plastic.as_slice().unwrap(), expected.as_slice().unwrap(), tolerance, &what);
        }
    }
}

#[test]
fn pass_mean_load_with_and_without_plasticity_is_the_references_over_three_passes() {
    let case = case();
    for expected in case["load_control"].as_array().unwrap() {
        let (update, rule) = (expected["update"].as_str().unwrap(), expected["rule"].as_str().unwrap());
        let share = expected["share"][0].as_f64().unwrap();
        let hardness = expected["H"].as_f64().unwrap_or(f64::INFINITY);
        let load = expected["W"].as_f64().unwrap();
        let passes = expected["passes"].as_array().unwrap();
        for (method, tolerance) in METHODS {
            let what = format!("H {hardness:e}, update {update} {rule}, share {share}, {method:?}");
            let plastic_update = if update == "position" { PlasticUpdate::Step } else { PlasticUpdate::Pass };
            let motion = motion(pass_load(load), plastic_update);
            let mut bodies = pair(&case, hardness, share);
            for expected in passes {
                let before = bodies.clone();
                let kept = run(bodies, motion, method);
                let contacts = &kept.contacts[0];
                assert_counts(contacts, expected, &what);
                assert_close(&loads(contacts), &numbers(&expected["F_k"]), tolerance, &what);
                assert_close(
                    &[kept.passes[0].approach],
                    &[expected["r"].as_f64().unwrap()],
                    tolerance,
                    &what,
                );
                let plastic: f64 = contacts.iter().map(|c| c.plastic_volume(&before)).sum();
                assert_close(&[plastic], &[expected["plastic_volume"].as_f64().unwrap()], tolerance, &what);
                bodies = if rule == "mean" {
                    deformed_by_the_mean(&before, contacts, share)
                } else {
                    kept.last().clone()
                };
                let drop = (&before.lower.heights - &bodies.lower.heights).sum() * 1e-12;
                let rise = (&bodies.upper.heights - &before.upper.heights).sum() * 1e-12;
                if update != "none" {
                    assert_close(&[drop], &[expected["Z1_drop"].as_f64().unwrap()], tolerance, &what);
                    assert_close(&[rise], &[expected["Z2_rise"].as_f64().unwrap()], tolerance, &what);
                }
                if rule == "max" && update != "none" {
                    assert_close(&kept.passes[0].lost("plastic"), &[drop, rise], 1e-9, &what);
                }
                if update == "position" {
                    assert_close(&[drop + rise], &[plastic], 1e-9, &format!("volume balance, {what}"));
                }
            }
            if update != "none" {
                let key = format!("{update}_{rule}_{share}");
                for (body, heights) in [("Z1", &bodies.lower.heights), ("Z2", &bodies.upper.heights)] {
                    let expected = field(&case["after_three_passes"][format!("{body}_after3_{key}")], 1.0);
                    assert_close(heights.as_slice().unwrap(), expected.as_slice().unwrap(), tolerance, &what);
                }
            }
        }
    }
}

/// The other rule of the reference for a frozen geometry: the mean instead of the largest interference.
fn deformed_by_the_mean(before: &Pair, contacts: &[Contact], share: f64) -> Pair {
    let mut after = before.clone();
    let positions = contacts.len() as f64;
    for contact in contacts {
        for &(cell, w) in &contact.plastic {
            let [lower, upper] = before.cells_of_bodies(&contact.position, cell as usize);
            after.lower.heights.as_slice_mut().unwrap()[lower] -= share * w / positions;
            after.upper.heights.as_slice_mut().unwrap()[upper] += (1.0 - share) * w / positions;
        }
    }
    after
}

#[test]
fn circular_shift_has_the_references_loads() {
    let case = case();
    let expected = &case["conventional_fixed_r0"];
    for (method, tolerance) in METHODS {
        let motion = motion(at_approach(0.0), PlasticUpdate::Pass)
            .with_strategy(Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 });
        let kept = run(pair(&case, case["H"].as_f64().unwrap(), 0.5), motion, method);
        assert_close(&loads(&kept.contacts[0]), &numbers(&expected["F"]), tolerance, "shift");
    }
}

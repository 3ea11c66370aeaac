//! Fatigue of the bodies of a case.

use std::sync::atomic::{AtomicUsize, Ordering};

use asperity_base::Error;
use asperity_contact::Field;
use asperity_contact::fatigue::{Basquin, Fatigue, FatigueRecord, OnBody, advance_damage};
use asperity_contact::material::Coating;
use asperity_contact::motion::{PassRecord, Progress, Watch};
use asperity_contact::wear::WearRate;
use asperity_contact::with::Capability;
use asperity_study::{Case, Existing, Results, Summary, SurfaceInput};
use tempfile::TempDir;

use crate::resume::{Whole, goes_on};
use crate::support::{most, parsed};

fn case(passes: usize, tables: &str) -> Case {
    parsed(&format!(
        r#"
[lower]
young = "210 GPa"
poisson = 0.3
topography = {{ generate = "low-pass", shape = [24, 16], pitch = "1 um", sq = "30 nm", cutoff = "8 um", seed = 1 }}
fatigue = {{ torsion = "350 MPa", tension = "600 MPa" }}
wear = {{ coefficient = "1e-7 mm3/(N m)" }}
[upper]
young = "210 GPa"
poisson = 0.3
topography = {{ generate = "low-pass", sq = "30 nm", cutoff = "8 um", seed = 2 }}
fatigue = {{ torsion = "500 MPa", tension = "800 MPa", endurance = true }}
[contact]
mean_pressure = "50 MPa"
boundary = "periodic"
[friction]
coefficient = 0.1
[motion]
strategy = "shift"
passes = {passes}
stride = 2
speed_lower = 0
[fatigue]
to = "4 um"
layers = 4
{tables}
"#
    ))
}

/// What is found of the fatigue of a case, with its results as long as their folder is there.
fn run(case: &Case) -> (Summary, Vec<FatigueRecord>, Results, TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let (summary, results) = crate::support::run(case, &folder.path().join("out"));
    let rows = results.rows::<Fatigue>().unwrap();
    (summary, rows, results, folder)
}

#[test]
fn bodies_of_a_motion_tire_pass_after_pass_and_go_on_to_the_same_bits() {
    let Whole { summary, results, .. } = &goes_on(&case(3, ""));
    let rows = results.rows::<Fatigue>().unwrap();
    let places: Vec<_> = rows.iter().map(|row| (row.pass, row.body)).collect();
    let expected: Vec<_> =
        (1..=3).flat_map(|pass| [(Some(pass), OnBody::Lower), (Some(pass), OnBody::Upper)]).collect();
    assert_eq!(places, expected);
    assert!(rows.iter().all(|row| row.over_limit > 0.1
        && row.critical.critical_wear.is_some_and(|wear| wear >= 0.0)
        && row.depth <= 4e-6));
    // The same stress, with a limit that is larger by more than the weight of the hydrostatic stress makes up
    // for.
    assert!(rows[0].over_limit > rows[1].over_limit);
    // The summary has the last pass.
    assert_eq!(summary.found.fatigue, rows[4..]);
    let maps = results.observed_fields("fatigue", 3).unwrap();
    let largest = most(&maps.read("over_limit_lower").unwrap().into_field().unwrap());
    assert!((largest / rows[4].over_limit - 1.0).abs() < 1e-12);
    let depths = (1..=4).map(|k| state(results, 3, &format!("over_limit_{k:02}")));
    assert!(depths.map(|depth| most(&depth)).any(|depth| depth == largest));
}

#[test]
fn only_the_passes_asked_for_are_looked_at_and_what_is_beyond_the_model_is_told() {
    let (summary, rows, results, _folder) = run(&case(3, "passes = [2]\nevery = 6"));
    assert!(rows.iter().all(|row| row.pass == Some(2)) && rows.len() == 2);
    let told = |words: &str| summary.warnings.iter().any(|warning| warning.contains(words));
    assert!(told("between two positions whose stress is computed"), "{:?}", summary.warnings);
    assert!(told("no pass before pass 2 is looked at"), "{:?}", summary.warnings);
    assert!(!told("may be deeper than the largest depth"));
    assert!(!results.directory().join("fields/fatigue-0001.h5").exists());
    let text = "times the one above it, and the largest f may lie between two";
    assert!(!told(text));
    let mut deep = case(1, "");
    deep.with.fatigue.as_mut().unwrap().to = 4e-3;
    let (summary, ..) = run(&deep);
    assert!(summary.warnings.iter().any(|warning| warning.contains(text)), "{:?}", summary.warnings);
    let text = "pits of the lower body may be deeper than the largest depth, 4 µm";
    let mut deep = case(1, "");
    deep.lower.properties.fatigue.as_mut().unwrap().pit_depth = 5e-3;
    let (summary, ..) = run(&deep);
    assert!(summary.warnings.iter().any(|warning| warning.contains(text)), "{:?}", summary.warnings);
}

/// The state of a body after a pass, at a depth from 1.
fn state(results: &Results, pass: usize, name: &str) -> Field {
    let [lower, _] = results.states_after(pass).unwrap();
    lower[name].values.clone()
}

#[test]
fn damage_adds_up_over_passes_as_miner_has_it() {
    let case = case(3, "");
    let (_, rows, results, _folder) = run(&case);
    let law = Basquin::new(10.0, 2e6, false).unwrap();
    let depths = case.with.fatigue.as_ref().unwrap().depths([1e-6; 2], 0.0);
    let shape = [24, 16];
    let mut suffered = vec![vec![0.0; 4]; shape[0] * shape[1]];
    let mut worn_before = Field::zeros(shape);
    for pass in 1..=3 {
        let worn = state(&results, pass, "wear");
        let over: Vec<Field> =
            (1..=4).map(|k| state(&results, pass, &format!("over_limit_{k:02}"))).collect();
        for (cell, suffered) in suffered.iter_mut().enumerate() {
            let at = [cell / shape[1], cell % shape[1]];
            let each: Vec<f64> = over.iter().map(|over| law.damage(over[at])).collect();
            advance_damage(&depths, suffered, &each, 1.0, worn[at] - worn_before[at]);
        }
        worn_before = worn;
        let most = suffered.iter().flatten().copied().fold(0.0, f64::max);
        let row = &rows[2 * (pass - 1)];
        assert!(
            (row.damage / most - 1.0).abs() < 1e-6 && row.damage > row.damage_of_pass * (pass as f64 - 0.5)
        );
        let life = row.life.unwrap();
        let expected = pass as f64 + (1.0 - row.damage) / row.damage_of_pass;
        assert!((life / expected - 1.0).abs() < 1e-3, "{life} {expected}");
        assert!(
            row.critical.unsaved_share.is_some_and(|share| Some(share) <= row.critical.critical_share)
                && row.pitted_share.is_none()
        );
    }
    // The upper body does not wear.
    assert!(rows[1].critical.unsaved_share.is_none());
}

/// The limits are those of the body below the layers, which wear takes nothing from.
#[test]
fn a_body_below_layers_tires_at_its_own_depths() {
    let mut covered = case(2, "");
    let layer = |young: f64| vec![Coating::new(1.5e-6, young, 0.3).unwrap()];
    covered.lower.material.layers = layer(210e9);
    let of = |case: &Case| {
        let (_, rows, results, folder) = run(case);
        let [lower, upper] = [rows[2].clone(), rows[3].clone()];
        (lower, upper, results, folder)
    };
    let (alike, upper, results, _folder) = of(&covered);
    let (_, bare, ..) = of(&case(2, ""));
    assert!((upper.over_limit / bare.over_limit - 1.0).abs() < 1e-6);
    assert!(
        alike.depth >= 1.5e-6
            && alike.critical.critical_wear.is_none()
            && alike.critical.critical_share.is_none()
    );
    // Damage of both passes, from which wear takes nothing.
    let each = alike.damage_of_pass;
    assert!((alike.damage / each - 2.0).abs() < 1e-2, "{} {each}", alike.damage);
    let maps = results.observed_fields("fatigue", 2).unwrap();
    assert!(maps.read("critical_wear_lower").is_err() && maps.read("critical_wear_upper").is_ok());
    let section = maps.read("over_limit_section_lower").unwrap().into_field().unwrap();
    // The layer has three eighths of the largest depth, 36 of 96 rows.
    assert!((0..96).all(|k| (section[[0, k]] == 0.0) == (k < 36)));
    // A soft layer spreads the pressure before it reaches the body.
    covered.lower.material.layers = layer(20e9);
    let soft = of(&covered).0.over_limit;
    assert!(soft < 0.8 * alike.over_limit, "{soft} {}", alike.over_limit);
}

#[test]
fn damage_between_two_computed_passes_is_between_theirs() {
    let mut case = case(40, "[acceleration]\nmax_jump = 8\ntolerance = 10\nmax_wear = \"1 um\"");
    // The other body wears, so that the pressures change and the depths do not.
    let mut wear = case.lower.laws.wear.take().unwrap();
    wear.rate = WearRate::Coefficient(1e-14);
    case.upper.laws.wear = Some(wear);
    let (_, _, results, _folder) = run(&case);
    let jumps: Vec<usize> = results.passes().unwrap().iter().map(PassRecord::represents).collect();
    assert!(jumps.contains(&8) && jumps.iter().sum::<usize>() == 40, "{jumps:?}");
    let law = Basquin::new(10.0, 2e6, false).unwrap();
    for depth in ["01", "03"] {
        let of =
            |pass: usize| state(&results, pass, &format!("over_limit_{depth}")).mapv(|over| law.damage(over));
        let mut expected = Field::zeros([24, 16]);
        for (index, jump) in jumps.iter().enumerate() {
            let (now, next) = (of(index + 1), of((index + 2).min(jumps.len())));
            // The passes of a jump, each on the line from one computed pass to the next.
            for k in 0..*jump {
                let share = k as f64 / *jump as f64;
                expected = expected + &now * (1.0 - share) + &next * share;
            }
        }
        let found = state(&results, jumps.len(), &format!("damage_{depth}"));
        let largest = most(&expected);
        let changes = of(1) - of(jumps.len());
        assert!(changes.iter().any(|change| change.abs() > 0.01 * largest / 40.0));
        let error = most(&(found - &expected).mapv(f64::abs));
        assert!(error < 1e-9 * largest, "{error} of {largest}");
    }
}

#[test]
fn what_has_failed_breaks_out_and_goes_to_the_ledger() {
    let tables = "[acceleration]\nmax_jump = 1000";
    let pitting = |passes: usize| {
        let mut case = case(passes, tables);
        let limits = case.lower.properties.fatigue.as_mut().unwrap();
        (limits.cycles, limits.pit_depth) = (1e5, 1.5e-6);
        case
    };
    let (summary, rows, results, _folder) = run(&pitting(3000));
    let passes = results.passes().unwrap();
    let last = passes.len();
    assert!(passes.iter().any(|pass| pass.represents() > 10));
    let pitted = state(&results, last, "pitted");
    let share = pitted.iter().filter(|depth| **depth > 0.0).count() as f64 / pitted.len() as f64;
    let row = rows.iter().rfind(|row| row.body == OnBody::Lower).unwrap();
    assert!(share > 0.0 && share < 0.5 && row.pitted_share == Some(share), "{share}");
    let volume: f64 = passes.iter().map(|pass| pass.lost("pits")[0]).sum();
    assert!((volume / (1e-12 * pitted.sum()) - 1.0).abs() < 1e-9);
    assert!(passes.iter().all(|pass| pass.lost("pits")[1] == 0.0));
    // The height of a column falls by what was worn and what broke out.
    let [before, after] = [0, last].map(|pass| results.surfaces_after(pass).unwrap()[0].heights().clone());
    let worn = state(&results, last, "wear");
    let error = most(&(before - after - worn - &pitted).mapv(f64::abs));
    assert!(error < 1e-15, "{error}");
    // Pits are as deep as the material is damaged, and no deeper than asked for but by the way to the next
    // depth.
    assert!(pitted.iter().all(|depth| *depth < 20.0 * 4e-6));
    // Nothing within the depth of pits is left that has failed.
    for depth in ["01", "02"] {
        let left = state(&results, last, &format!("damage_{depth}"));
        assert!(left.iter().all(|damage| *damage < 1.0 + 1e-9));
    }
    let answers = Fatigue::answers(case(1, "").with.fatigue.as_ref().unwrap(), &summary.found.fatigue);
    assert!(answers[0].sentence.contains("has pitted"), "{}", answers[0].sentence);
}

/// A ball with this roughness that rolls over a smooth plate, with the risk asked for.
fn ball(sq: &str, form: &str) -> Case {
    parsed(&format!(
        r#"
[lower]
young = "210 GPa"
poisson = 0.3
topography = {{ form = "flat", shape = [48, 32], pitch = "4 um" }}
fatigue = {{ torsion = "350 MPa", tension = "600 MPa", risk = true }}
[upper]
young = "210 GPa"
poisson = 0.3
topography = {{ form = "{form}", plus = [{{ generate = "low-pass", sq = "{sq}", cutoff = "32 um", seed = 2 }}] }}
[contact]
load = "3 N"
boundary = "free"
[motion]
strategy = "overlap"
stride = 4
[fatigue]
to = "60 um"
layers = 6
"#
    ))
}

/// Counts how often it is asked whether to stop, and stops at one of these questions.
struct StopAt {
    asked: AtomicUsize,
    at: usize,
}

impl Watch for StopAt {
    fn position(&self, _: &Progress) {}

    fn stop(&self) -> bool {
        self.asked.fetch_add(1, Ordering::Relaxed) >= self.at
    }
}

/// The pass of the smooth bodies is solved after that of the bodies, and asks to the end.
#[test]
fn the_pass_of_the_smooth_bodies_can_be_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let ball = ball("20 nm", r#"sphere", radius = "5 mm"#);
    let mut without_risk = ball.clone();
    without_risk.lower.properties.fatigue.as_mut().unwrap().risk = false;
    let asked = |case: &Case, at: usize| {
        let out = tempfile::tempdir_in(folder.path()).unwrap();
        let watch = StopAt { asked: AtomicUsize::new(0), at };
        let input = SurfaceInput::default();
        let ended = asperity_study::run(case, input, &out.path().join("out"), Existing::Keep, &watch);
        (watch.asked.into_inner(), ended.map(|_| ()))
    };
    let [before, whole] = [&without_risk, &ball].map(|case| asked(case, usize::MAX).0);
    assert!(whole > before + before / 4, "{before} {whole}");
    let (_, ended) = asked(&ball, whole - (whole - before) / 4);
    assert!(matches!(ended, Err(Error::Interrupted)), "{ended:?}");
}

#[test]
fn roughness_shortens_the_life_of_a_ball() {
    let sphere = r#"sphere", radius = "5 mm"#;
    let ratio = |sq: &str, form: &str| {
        let (summary, rows, ..) = run(&ball(sq, form));
        (rows[0].life_ratio, summary.warnings.iter().any(|warning| warning.contains("these are flat")))
    };
    // A polynomial of second order is a ball but for its fourth order.
    let (smooth, _) = ratio("0.01 nm", sphere);
    assert!((smooth.unwrap() - 1.0).abs() < 0.02, "{smooth:?}");
    let (fine, _) = ratio("20 nm", sphere);
    let (rough, is_told) = ratio("60 nm", sphere);
    assert!(rough.unwrap() < 0.5 * fine.unwrap() && fine.unwrap() < 0.9 && !is_told, "{fine:?} {rough:?}");
    assert_eq!(ratio("60 nm", "flat"), (None, true));
}

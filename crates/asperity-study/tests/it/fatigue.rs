//! Fatigue of the bodies of a case.

use std::fs;
use std::path::Path;

use asperity_contact::fatigue::{FatigueRecord, OnBody};
use asperity_study::{Case, Existing, Results, Summary, SurfaceInput};

fn case(passes: usize, tables: &str) -> Case {
    let text = format!(
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
    );
    Case::parse(&text, "case.toml".as_ref(), "".as_ref()).unwrap()
}

fn run(case: &Case, out: &Path, existing: Existing) -> (Summary, Vec<FatigueRecord>) {
    let (summary, _) = asperity_study::run(case, SurfaceInput::default(), out, existing, &()).unwrap();
    let rows = Results::open(out).unwrap().rows::<asperity_contact::fatigue::Fatigue>().unwrap();
    (summary, rows)
}

#[test]
fn bodies_of_a_motion_tire_pass_after_pass_and_go_on_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let whole = folder.path().join("whole");
    let (summary, rows) = run(&case(3, ""), &whole, Existing::Keep);
    let places: Vec<_> = rows.iter().map(|row| (row.pass, row.body)).collect();
    let expected: Vec<_> = (1..=3).flat_map(|pass| [(pass, OnBody::Lower), (pass, OnBody::Upper)]).collect();
    assert_eq!(places, expected);
    assert!(rows.iter().all(|row| row.over_limit > 0.1 && row.critical_wear >= 0.0 && row.depth <= 4e-6));
    // The same stress, with a limit that is larger by more than the weight of the hydrostatic stress makes up for.
    assert!(rows[0].over_limit > rows[1].over_limit);
    // The summary has the last pass.
    assert_eq!(summary.found.fatigue, rows[4..]);
    let parts = folder.path().join("parts");
    run(&case(1, ""), &parts, Existing::Keep);
    let (_, again) = run(&case(3, ""), &parts, Existing::Resume);
    assert_eq!(again, rows);
    let read = |out: &Path| fs::read(out.join("fields/fatigue-0003.h5")).unwrap();
    assert!(read(&whole) == read(&parts));
    let maps = Results::open(&whole).unwrap().observed_fields("fatigue", 3).unwrap();
    let map = maps.read("over_limit_lower").unwrap().into_field().unwrap();
    let most = map.iter().copied().fold(0.0, f64::max);
    assert!((most / rows[4].over_limit - 1.0).abs() < 1e-12);
    let depths =
        (1..=4).map(|k| maps.read(&format!("over_limit_lower_{k:02}")).unwrap().into_field().unwrap());
    assert!(depths.map(|depth| depth.iter().copied().fold(0.0, f64::max)).any(|depth| depth == most));
}

#[test]
fn only_the_passes_asked_for_are_looked_at_and_what_is_beyond_the_model_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let (summary, rows) = run(&case(3, "passes = [2]\nevery = 6"), folder.path(), Existing::Keep);
    assert!(rows.iter().all(|row| row.pass == 2) && rows.len() == 2);
    let told = |words: &str| summary.warnings.iter().any(|warning| warning.contains(words));
    assert!(told("between two positions whose stress is computed"), "{:?}", summary.warnings);
    assert!(!folder.path().join("fields/fatigue-0001.h5").exists());
    let text = "times the one above it, and the largest f may lie between two";
    assert!(!told(text));
    let mut deep = case(1, "");
    deep.with.fatigue.as_mut().unwrap().to = 4e-3;
    let (summary, _) = run(&deep, tempfile::tempdir().unwrap().path(), Existing::Keep);
    assert!(summary.warnings.iter().any(|warning| warning.contains(text)), "{:?}", summary.warnings);
}

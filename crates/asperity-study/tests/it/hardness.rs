//! A hardness map, from its file to the results.

use std::path::Path;

use asperity_base::{Error, Field, Grid};
use asperity_contact::motion::{PassRecord, StaticRecord};
use asperity_study::{Case, Existing, Outcome, Results, SurfaceInput};
use asperity_surface::Topography;

use crate::support::{self, parsed_in, written};

const CASE: &str = r#"
[lower]
young = "210 GPa"
poisson = 0.3
hardness = { file = "map.npy", unit = "GPa" }
[lower.topography]
generate = "self-affine"
hurst = 0.8
sq = "50 nm"
seed = 1
shape = [24, 20]
pitch = "1 um"

[upper]
young = "210 GPa"
poisson = 0.3
hardness = "3 GPa"
[upper.topography]
generate = "self-affine"
hurst = 0.8
sq = "50 nm"
seed = 2

[contact]
mean_pressure = "400 MPa"
"#;

/// Soft stripes along y, in GPa.
fn stripes(shape: [usize; 2]) -> Field {
    Field::from_shape_fn(shape, |(i, _)| if i % 6 < 3 { 1.0 } else { 5.0 })
}

fn write_map(folder: &Path, map: &Field) {
    let grid = Grid::new([map.nrows(), map.ncols()], [1e-6; 2]).unwrap();
    Topography::new(grid, map.clone()).unwrap().write(folder.join("map.npy")).unwrap();
}

fn run(text: &str, folder: &Path, out: &str, existing: Existing) -> asperity_base::Result<Outcome> {
    let case = Case::parse(text, Path::new("case.toml"), folder)?;
    asperity_study::run(&case, SurfaceInput::default(), &folder.join(out), existing, &())
        .map(|(summary, _)| summary.outcome)
}

fn at_rest(text: &str, folder: &Path, out: &str) -> (Box<StaticRecord>, Results) {
    let (summary, results) = support::run(&parsed_in(text, folder), &folder.join(out));
    let Outcome::Static(record) = summary.outcome else { panic!("a static contact") };
    (record, results)
}

fn passes(outcome: Outcome) -> Vec<PassRecord> {
    let Outcome::Passes(passes) = outcome else { panic!("a motion") };
    passes
}

#[test]
fn each_cell_is_capped_by_its_own_hardness_and_the_softer_cell_flows() {
    let folder = tempfile::tempdir().unwrap();
    let map = stripes([24, 20]);
    write_map(folder.path(), &map);
    let (record, results) = at_rest(CASE, folder.path(), "out");
    let [pressure, cap, plastic] = ["pressure", "cap", "plastic"].map(|name| written(&results, name));
    assert_eq!(cap, map.mapv(|hardness| 1e9 * f64::min(hardness, 3.0)));
    let mut capped = 0;
    for ((p, cap), w) in pressure.iter().zip(&cap).zip(&plastic) {
        assert!(p <= cap && (*w == 0.0 || p == cap), "{p:e} of {cap:e}, w = {w:e}");
        capped += usize::from(p == cap);
    }
    assert_eq!(capped, record.plastic_cells);
    assert!(record.plastic_cells > 10 && record.max_pressure == 3e9, "{record:?}");
    // A uniform map equals its value.
    write_map(folder.path(), &Field::from_elem([24, 20], 2.0));
    let (mapped, _) = at_rest(CASE, folder.path(), "mapped");
    let number = CASE.replace("{ file = \"map.npy\", unit = \"GPa\" }", "\"2 GPa\"");
    let (uniform, _) = at_rest(&number, folder.path(), "uniform");
    assert_eq!(mapped, uniform);
}

#[test]
fn a_map_in_text_has_its_lines_along_x_unless_the_case_says_otherwise() {
    let folder = tempfile::tempdir().unwrap();
    let map = stripes([24, 20]);
    write_map(folder.path(), &map);
    let (from_npy, _) = at_rest(CASE, folder.path(), "npy");
    let text = |map: ndarray::ArrayView2<'_, f64>| -> String {
        map.rows()
            .into_iter()
            .map(|row| format!("{}\n", row.iter().map(f64::to_string).collect::<Vec<_>>().join(",")))
            .collect()
    };
    for (n, (words, lines, keys)) in [
        ("", text(map.t()), ""),
        ("", text(map.view()), ", lines = \"y\""),
        ("phases\n20 24\n", text(map.t()), ", skip = 2"),
    ]
    .into_iter()
    .enumerate()
    {
        std::fs::write(folder.path().join("map.csv"), format!("{words}{lines}")).unwrap();
        let case =
            CASE.replace("\"map.npy\"", "\"map.csv\"").replace("\"GPa\" }", &format!("\"GPa\"{keys} }}"));
        let (from_text, _) = at_rest(&case, folder.path(), &format!("text-{n}"));
        assert_eq!(from_text, from_npy);
        if n == 2 {
            let bare = case.replace(keys, "");
            let error = run(&bare, folder.path(), "none", Existing::Keep).unwrap_err().to_string();
            assert!(error.contains("the matrix begins at line 3"), "{error}");
        }
    }
}

const MOTION: &str =
    "\n[motion]\nstrategy = \"overlap\"\npasses = 2\nstride = 4\n[output]\npressure_every = 1\n";

#[test]
fn the_map_moves_with_its_body() {
    let folder = tempfile::tempdir().unwrap();
    let map = stripes([24, 20]);
    write_map(folder.path(), &map);
    // On the upper body, turned over with it.
    let upper = CASE
        .replace("hardness = { file = \"map.npy\", unit = \"GPa\" }", "hardness = \"PLACE\"")
        .replace("hardness = \"3 GPa\"", "hardness = { file = \"map.npy\", unit = \"1 GPa\" }")
        .replace("PLACE", "3 GPa");
    let moving = upper + MOTION;
    let whole = passes(run(&moving, folder.path(), "whole", Existing::Keep).unwrap());
    let results = Results::open(&folder.path().join("whole")).unwrap();
    let fields = results.fields_after(1).unwrap();
    for step in results.steps().unwrap().iter().filter(|step| step.pass == 1) {
        let stored = |name: &str| fields.read(name).unwrap().into_field().unwrap();
        let pressure = stored(&asperity_study::pressure_name(step.step));
        let offset = (step.offset / 1e-6).round() as isize;
        for ((i, j), p) in pressure.indexed_iter() {
            let column = i as isize - offset.min(0);
            // Mirrored in x: the measured heights have the opposite orientation.
            let cap = 1e9 * f64::min(3.0, map[[23 - column as usize, j]]);
            assert!(*p <= cap, "{step:?}: {p:e} of {cap:e} at {i}, {j}");
        }
    }
    let [lower, lost] = whole[0].lost("plastic");
    assert!(lost > lower && lower > 0.0, "soft cells of the upper body take more: {lower:e}, {lost:e}");
    // A resumed motion continues from its state.
    let once = moving.replace("passes = 2", "passes = 1");
    run(&once, folder.path(), "parts", Existing::Keep).unwrap();
    let rest = passes(run(&moving, folder.path(), "parts", Existing::Resume).unwrap());
    assert_eq!(rest[1].lost, whole[1].lost);
    // With another map it is refused.
    run(&once, folder.path(), "changed", Existing::Keep).unwrap();
    write_map(folder.path(), &map.mapv(|hardness| 1.1 * hardness));
    let changed = run(&moving, folder.path(), "changed", Existing::Resume).unwrap_err();
    assert!(matches!(changed, Error::SurfaceChanged { .. }), "{changed}");
}

#[test]
fn a_map_that_does_not_fit_is_refused_at_its_key() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |map: &Field| {
        write_map(folder.path(), map);
        let Err(Error::Case(error)) = run(CASE, folder.path(), "out", Existing::Keep) else {
            panic!("refused")
        };
        assert_eq!(error.key, "lower.hardness.file");
        error.message.clone()
    };
    let message = refused(&stripes([20, 24]));
    assert!(message.ends_with("has 20 × 24 values, the body as it is prepared 24 × 20 cells"), "{message}");
    let message = refused(&stripes([24, 20]).mapv(|hardness| hardness - 1.0));
    assert!(message.contains("has a hardness of 0 Pa in cell [0, 0], expected"), "{message}");
    let mut map = stripes([24, 20]);
    map[[3, 7]] = f64::NAN;
    let message = refused(&map);
    assert!(message.contains("has no number in cell [3, 7], expected"), "{message}");
}

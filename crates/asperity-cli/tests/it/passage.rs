//! Flow and conductance of maps from files.

use std::fs;
use std::path::Path;
use std::process::Output;

use asperity::io::fields::{Fields, read_field};
use asperity::surface::Topography;
use asperity::{Field, Grid};
use serde_json::Value;
use tempfile::TempDir;

use crate::support::{asperity, command, files, ok, refused, stderr};

/// A rough surface on a flat one, with film and gas on the spots, and oil in the gap.
const CASE: &str = r#"
[lower]
young = "210 GPa"
poisson = 0.3
conductivity = "46 W/(m K)"
topography = { generate = "self-affine", hurst = 0.8, sq = "0.2 um", shape = [32, 24], pitch = "1 um", seed = 3 }
[upper]
young = "210 GPa"
poisson = 0.3
conductivity = "20 W/(m K)"
topography = { form = "flat" }
[contact]
mean_pressure = "300 MPa"
boundary = "periodic"
[conductance]
film = "2e-8 m2 K/W"
gas = "0.026 W/(m K)"
jump = "0.3 um"
[flow]
viscosity = "80 mPa s"
"#;

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// Runs the command with one argument for each of these words.
fn words(folder: &TempDir, words: &[&str]) -> Output {
    command(folder, "").args(words).output().unwrap()
}

fn json(output: &Output) -> Value {
    serde_json::from_str(&ok(output)).unwrap()
}

fn near(one: &Value, other: &Value, within: f64) -> bool {
    let [one, other] = [one, other].map(|value| value.as_f64().unwrap());
    (one - other).abs() <= within * other.abs()
}

fn write(path: &Path, rows: &[&str]) {
    fs::write(path, rows.join("\n")).unwrap();
}

/// Writes a field as a topography file.
fn store(path: &Path, field: Field) {
    let grid = Grid::new([field.nrows(), field.ncols()], [1e-6; 2]).unwrap();
    Topography::new(grid, field).unwrap().write(path).unwrap();
}

#[test]
fn maps_from_files_have_the_numbers_of_the_case() {
    let folder = folder();
    fs::write(folder.path().join("case.toml"), CASE).unwrap();
    ok(&asperity(&folder, "run case.toml --out results --quiet"));
    let at = |name: &str| folder.path().join(name);
    let summary: Value =
        serde_json::from_str(&fs::read_to_string(at("results/summary.json")).unwrap()).unwrap();
    let field = |name: &str| read_field(&at("results/fields.h5"), name).unwrap().into_field().unwrap();
    let (pressure, mut gap) = (field("pressure"), field("gap"));
    gap.zip_mut_with(&pressure, |gap, p| *gap = if *p > 0.0 { 0.0 } else { *gap });
    store(&at("gap.x3p"), gap);
    store(&at("pressure.npy"), pressure);

    let found = json(&asperity(
        &folder,
        "flow gap.x3p --viscosity 80mPas --pressure 1bar --json --out leak --dpi 50",
    ));
    for (axis, row) in ["x", "y"].iter().zip(summary["flow"].as_array().unwrap()) {
        let along = &found["along"][axis];
        for key in ["permeability", "leakage", "critical_gap", "flow_factor", "trapped_volume", "estimate"] {
            assert!(near(&along[key], &row[key], 1e-9), "{key} along {axis}: {along} {row}");
        }
        assert_eq!(along["critical_cells"], row["critical_cells"]);
        assert!(near(&along["critical_position"][0], &row["critical_x"], 1e-9), "{along} {row}");
    }
    assert!(near(&found["mean_gap"], &summary["flow"][0]["mean_gap"], 1e-9));
    let expected =
        ["fields.h5", "flow.json", "flow_x.png", "flow_y.png"].map(str::to_owned).into_iter().collect();
    assert_eq!(files(&at("leak")), expected);
    let kept = Fields::open(&at("leak/fields.h5")).unwrap();
    for name in ["flow_x", "flow_y", "fluid_pressure_x", "fluid_pressure_y"] {
        let [own, of_case] = [kept.read(name).unwrap(), read_field(&at("results/fields.h5"), name).unwrap()];
        let largest = of_case.values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let differs = |(one, other): (&f64, &f64)| (one - other).abs() > 1e-9 * largest;
        assert!(own.unit == of_case.unit && !own.values.iter().zip(&of_case.values).any(differs), "{name}");
    }
    let error = refused(&asperity(&folder, "flow gap.x3p --out leak"));
    assert!(error.contains("`leak` exists") && error.contains("--overwrite"), "{error}");
    ok(&asperity(&folder, "flow gap.x3p --out leak --overwrite --along y --format svg"));

    let conducts = [
        "conductance",
        "pressure.npy",
        "--pitch=1um",
        "--conductivity=46 W/(m K), 20 W/(m K)",
        "--boundary=periodic",
        "--film=2e-8 m2 K/W",
        "--gas=0.026 W/(m K)",
        "--jump=0.3um",
        "--gap=gap.x3p",
    ];
    let found = json(&words(&folder, &[&conducts[..], &["--json", "--out=heat", "--dpi=50"]].concat()));
    let row = &summary["conductance"][0];
    for (key, column) in [
        ("conductance", "thermal_conductance"),
        ("joint_conductance", "thermal_joint_conductance"),
        ("resistance", "thermal_resistance"),
        ("spot_share", "spot_share"),
        ("gas_share", "gas_share"),
        ("film_share", "film_share"),
        ("spots", "spots"),
        ("contact_area", "contact_area"),
    ] {
        assert!(near(&found[key], &row[column], 1e-6), "{key}: {found} {row}");
    }
    assert!(found["full_resistance"].is_null());
    let expected = ["conductance.json", "fields.h5", "flux.png"].map(str::to_owned).into_iter().collect();
    assert_eq!(files(&at("heat")), expected);
    let text = ok(&words(&folder, &conducts));
    for part in ["32 × 24 cells of 1 µm × 1 µm", " spots, median ", "joint conductance", " of the resistance"]
    {
        assert!(text.contains(part), "{text}");
    }
}

#[test]
fn plates_leak_as_poiseuille_says() {
    let folder = folder();
    write(&folder.path().join("gap.txt"), &["2 2 2", "2 2 2", "2 2 2", "2 2 2"]);
    let flow =
        |more: &str| json(&asperity(&folder, &format!("flow gap.txt --unit 1um --pitch 1um --json {more}")));
    let liquid = flow("--viscosity 0.02mPas --pressure 2bar");
    let shape: Vec<f64> = liquid["shape"].as_array().unwrap().iter().map(|n| n.as_f64().unwrap()).collect();
    // K ΔP/12η times width over length.
    for (axis, aspect) in [("x", shape[1] / shape[0]), ("y", shape[0] / shape[1])] {
        let expected = 8e-18 * 2e5 / (12.0 * 2e-5) * aspect;
        assert!(near(&liquid["along"][axis]["leakage"], &expected.into(), 1e-9), "{liquid}");
    }
    assert!(near(&liquid["permeability"][0][0], &8e-18.into(), 1e-9));
    // (9 − 1)/2 bar in place of 2 bar.
    let gas = flow("--viscosity 0.02mPas --pressure 2bar --outlet 1bar --ends reservoirs --along x");
    let leakage = |found: &Value| found["along"]["x"]["leakage"].as_f64().unwrap();
    assert!((leakage(&gas) / leakage(&liquid) - 2.0).abs() < 1e-9 && gas["along"].get("y").is_none());
    assert!(gas["permeability"].is_null() && flow("")["along"]["x"]["leakage"].is_null());
    let text = ok(&asperity(&folder, "flow gap.txt --unit 1um --pitch 1um"));
    assert!(
        text.contains("4 cells of 1 µm × 1 µm; mean 2 µm, 0 % closed") || text.contains("3 cells of"),
        "{text}"
    );
    assert!(text.contains("flow along x") && text.contains("permeability 8 µm³"), "{text}");
}

#[test]
fn maps_without_path_contact_or_gap_have_an_answer() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let both = |name: &str| {
        [
            asperity(&folder, &format!("flow {name} --pitch 1um --viscosity 1Pas --pressure 1bar")),
            asperity(&folder, &format!("conductance {name} --pitch 1um --conductivity 46")),
        ]
        .map(|output| ok(&output))
    };
    write(&at("zero.txt"), &["0 0 0", "0 0 0"]);
    let [flow, heat] = both("zero.txt");
    assert!(flow.contains("leakage along x   none: no path through the gap"), "{flow}");
    assert!(heat.contains("conductance       0 W/K"), "{heat}");
    write(&at("one.txt"), &["1"]);
    let [flow, heat] = both("one.txt");
    assert!(flow.contains("1 × 1 cells") && !flow.contains("none"), "{flow}");
    assert!(heat.contains("one spot") && heat.contains("100 % in contact"), "{heat}");
    write(&at("row.txt"), &["1 0 1 1"]);
    let [flow, heat] = both("row.txt");
    assert_eq!(flow.matches("none: no path").count(), 1, "{flow}");
    assert!(heat.contains("2 spots"), "{heat}");
    let full = asperity(&folder, "conductance one.txt --pitch 1um --conductivity 46 --boundary periodic");
    assert!(ok(&full).contains("no resistance: all cells touch without a film"));
    let mixed = "conductance row.txt --pitch 1um --conductivity inf,46 --boundary periodic,free --json";
    assert!(json(&asperity(&folder, mixed))["conductance"].as_f64().unwrap() > 0.0);
}

#[test]
fn an_image_has_a_threshold() {
    let folder = folder();
    write(&folder.path().join("image.txt"), &["10 200 200", "10 200 30", "200 200 200"]);
    let share = |option: &str| {
        let found = format!("conductance image.txt --pitch 1um --conductivity 46 --json {option}");
        json(&asperity(&folder, &found))["contact_fraction"].as_f64().unwrap()
    };
    assert_eq!(
        ["", "--above 100", "--below 20", "--below 100"].map(share),
        [1.0, 6.0 / 9.0, 2.0 / 9.0, 3.0 / 9.0]
    );
    let warned = asperity(&folder, "conductance image.txt --pitch 1um --conductivity 46 --below 20");
    assert!(
        stderr(&warned).contains("warning: the median spot of contact has 2 cells"),
        "{}",
        stderr(&warned)
    );
}

#[test]
fn a_mistake_names_its_option() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    write(&at("map.txt"), &["1 0", "2 1"]);
    write(&at("holes.txt"), &["1 nan", "2 1"]);
    write(&at("other.txt"), &["1 0 1", "2 1 1"]);
    for (arguments, parts) in [
        ("flow map.txt", &["need a pitch", "--pitch"][..]),
        ("flow map.txt --pitch 1um --viscosity 1Pas", &["--pressure"]),
        ("flow map.txt --pitch 1um --pressure 1bar", &["--viscosity"]),
        (
            "flow map.txt --pitch 1um --viscosity 0 --pressure 1bar",
            &["--viscosity", "expected a viscosity of 1e-9"],
        ),
        (
            "flow map.txt --pitch 1um --viscosity 1m --pressure 1bar",
            &["--viscosity", "is a length, expected a viscosity"],
        ),
        (
            "flow map.txt --pitch 1um --viscosity 1Pas --pressure=-1bar",
            &["--pressure", "expected 0, or a pressure"],
        ),
        ("flow map.txt --pitch 1um --viscosity 1Pas --pressure 1bar --outlet 0", &["--outlet"]),
        ("flow map.txt --pitch 1um --ends open", &["--ends", "reservoirs"]),
        ("flow map.txt --pitch 1um --overwrite", &["--out"]),
        ("flow holes.txt --pitch 1um", &["1 of 4 samples are undefined", "--fill"]),
        ("flow nowhere.npy --pitch 1um", &["nowhere.npy"]),
        ("conductance map.txt --pitch 1um", &["--conductivity"]),
        ("conductance map.txt --conductivity 46", &["need a pitch", "--pitch"]),
        (
            "conductance map.txt --pitch 1um --conductivity 0",
            &["--conductivity", "expected a thermal conductivity of"],
        ),
        (
            "conductance map.txt --pitch 1um --conductivity inf",
            &["--conductivity", "finite conductivity of one body"],
        ),
        ("conductance map.txt --pitch 1um --conductivity 1,2,3", &["--conductivity", "one value, or two"]),
        ("conductance map.txt --pitch 1um --conductivity 1MS/m", &["--conductivity"]),
        ("conductance map.txt --pitch 1um --conductivity 46 --film=-1", &["--film", "expected 0, or"]),
        ("conductance map.txt --pitch 1um --conductivity 46 --film 1V", &["--film"]),
        ("conductance map.txt --pitch 1um --conductivity 46 --gas 0.026", &["--gap"]),
        ("conductance map.txt --pitch 1um --conductivity 46 --jump 1um", &["--gas"]),
        ("conductance map.txt --pitch 1um --conductivity 46 --gap map.txt", &["--gas"]),
        ("conductance map.txt --pitch 1um --conductivity 46 --gas 0 --gap map.txt", &["--gas"]),
        (
            "conductance map.txt --pitch 1um --conductivity 46 --gas 1 --gap other.txt",
            &["--gap `other.txt` has", "same cells"],
        ),
        ("conductance map.txt --pitch 1um --conductivity 46 --gas 1 --gap holes.txt", &["undefined"]),
        (
            "conductance map.txt --pitch 1um --kind electrical --conductivity 1MS/m --gas 1 --gap map.txt",
            &["--gas", "--kind electrical"],
        ),
        (
            "conductance map.txt --pitch 1um --conductivity 46 --boundary open",
            &["--boundary", "free or periodic"],
        ),
        ("conductance map.txt --pitch 1um --conductivity 46 --above 1 --below 2", &["--above", "--below"]),
        ("conductance map.txt --pitch 1um --conductivity 46 --above nan", &["--above", "expected a number"]),
        ("conductance holes.txt --pitch 1um --conductivity 46", &["undefined", "--fill"]),
    ] {
        let error = refused(&asperity(&folder, arguments));
        for part in parts {
            assert!(error.contains(part), "{arguments}: {error}");
        }
    }
    assert!(!at("leak").exists());
}

//! Flow and conductance of maps from files.

use std::fs;
use std::process::Output;

use asperity::io::fields::{Fields, read_field};
use asperity::surface::Topography;
use asperity::{Field, Grid};
use serde_json::Value;
use tempfile::TempDir;

use crate::support::{asperity, assert_has, assert_refused, command, files, folder_with, json, ok, set};
use crate::support::{stderr, summary};

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

/// Runs the command with one argument for each of these words.
fn words(folder: &TempDir, words: &[&str]) -> Output {
    command(folder, "").args(words).output().unwrap()
}

fn near(one: &Value, other: &Value, within: f64) -> bool {
    let [one, other] = [one, other].map(|value| value.as_f64().unwrap());
    (one - other).abs() <= within * other.abs()
}

/// A folder with maps of these rows.
fn maps(maps: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, rows) in maps {
        fs::write(folder.path().join(name), rows).unwrap();
    }
    folder
}

#[test]
fn maps_from_files_have_the_numbers_of_the_case() {
    let folder = folder_with("case.toml", CASE);
    ok(&asperity(&folder, "run case.toml --out results --quiet"));
    let at = |name: &str| folder.path().join(name);
    let summary = summary(&at("results"));
    let field = |name: &str| read_field(&at("results/fields.h5"), name).unwrap().into_field().unwrap();
    let store = |name: &str, field: Field| {
        let grid = Grid::new([field.nrows(), field.ncols()], [1e-6; 2]).unwrap();
        Topography::new(grid, field).unwrap().write(at(name)).unwrap();
    };
    let (pressure, mut gap) = (field("pressure"), field("gap"));
    gap.zip_mut_with(&pressure, |gap, p| *gap = if *p > 0.0 { 0.0 } else { *gap });
    store("gap.x3p", gap);
    store("pressure.npy", pressure);

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
    assert_eq!(files(&at("leak")), set("fields.h5 flow.json flow_x.png flow_y.png"));
    let kept = Fields::open(&at("leak/fields.h5")).unwrap();
    for name in ["flow_x", "flow_y", "fluid_pressure_x", "fluid_pressure_y"] {
        let [own, of_case] = [kept.read(name).unwrap(), read_field(&at("results/fields.h5"), name).unwrap()];
        let largest = of_case.values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let differs = |(one, other): (&f64, &f64)| (one - other).abs() > 1e-9 * largest;
        assert!(own.unit == of_case.unit && !own.values.iter().zip(&of_case.values).any(differs), "{name}");
    }
    assert_refused(&folder, [("flow gap.x3p --out leak", "`leak` exists … --overwrite")]);
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
    assert_eq!(files(&at("heat")), set("conductance.json fields.h5 flux.png"));
    let text = ok(&words(&folder, &conducts));
    assert_has(
        &text,
        "32 × 24 cells of 1 µm × 1 µm …  spots, median  … joint conductance …  of the resistance",
    );
}

#[test]
fn flow_takes_the_pressures_ends_and_direction_that_are_named() {
    let folder = maps(&[("gap.txt", "2 2 2\n2 2 2\n2 2 2\n2 2 2")]);
    let flow = |more: &str| asperity(&folder, &format!("flow gap.txt --unit 1um --pitch 1um {more}"));
    let leakage = |more: &str| json(&flow(&format!("--json --viscosity 0.02mPas --pressure 2bar {more}")));
    let liquid = leakage("");
    // (9 − 1)/2 bar in place of 2 bar.
    let gas = leakage("--outlet 1bar --ends reservoirs --along x");
    let of = |found: &Value| found["along"]["x"]["leakage"].as_f64().unwrap();
    assert!((of(&gas) / of(&liquid) - 2.0).abs() < 1e-9 && gas["along"].get("y").is_none());
    assert!(gas["permeability"].is_null() && json(&flow("--json"))["along"]["x"]["leakage"].is_null());
    let text = ok(&flow(""));
    assert_has(
        &text,
        "3 × 4 cells of 1 µm × 1 µm; mean 2 µm, 0 % closed … flow along x … permeability 8 µm³",
    );
}

#[test]
fn maps_without_path_contact_or_gap_have_an_answer() {
    let folder = maps(&[("zero.txt", "0 0 0\n0 0 0"), ("one.txt", "1"), ("row.txt", "1 0 1 1")]);
    let flow = |map: &str| {
        ok(&asperity(&folder, &format!("flow {map}.txt --pitch 1um --viscosity 1Pas --pressure 1bar")))
    };
    let heat = |arguments: &str| asperity(&folder, &format!("conductance {arguments} --pitch 1um"));
    assert_has(&flow("zero"), "leakage along x   none: no path through the gap");
    assert_has(&ok(&heat("zero.txt --conductivity 46")), "conductance       0 W/K");
    let one = flow("one");
    assert!(one.contains("1 × 1 cells") && !one.contains("none"), "{one}");
    assert_has(&ok(&heat("one.txt --conductivity 46")), "one spot … 100 % in contact");
    let row = flow("row");
    assert_eq!(row.matches("none: no path").count(), 1, "{row}");
    assert_has(&ok(&heat("row.txt --conductivity 46")), "2 spots");
    let full = ok(&heat("one.txt --conductivity 46 --boundary periodic"));
    assert_has(&full, "no resistance: all cells touch without a film");
    let mixed = heat("row.txt --conductivity inf,46 --boundary periodic,free --json");
    assert!(json(&mixed)["conductance"].as_f64().unwrap() > 0.0);
}

#[test]
fn an_image_has_a_threshold() {
    let folder = maps(&[("image.txt", "10 200 200\n10 200 30\n200 200 200")]);
    let heat = |option: &str| {
        asperity(&folder, &format!("conductance image.txt --pitch 1um --conductivity 46 {option}"))
    };
    let share = |option: &str| json(&heat(&format!("--json {option}")))["contact_fraction"].as_f64().unwrap();
    let options = ["", "--above 100", "--below 20", "--below 100"];
    assert_eq!(options.map(share), [1.0, 6.0 / 9.0, 2.0 / 9.0, 3.0 / 9.0]);
    assert_has(&stderr(&heat("--below 20")), "warning: the median spot of contact has 2 cells");
}

#[test]
fn a_mistake_names_its_option() {
    let folder = maps(&[("map.txt", "1 0\n2 1"), ("holes.txt", "1 nan\n2 1"), ("other.txt", "1 0 1\n2 1 1")]);
    for (arguments, parts) in [
        ("map.txt", "need a pitch … --pitch"),
        ("map.txt --pitch 1um --viscosity 1Pas", "--pressure"),
        ("map.txt --pitch 1um --pressure 1bar", "--viscosity"),
        ("map.txt --pitch 1um --viscosity 0 --pressure 1bar", "--viscosity … expected a viscosity of 1e-9"),
        (
            "map.txt --pitch 1um --viscosity 1m --pressure 1bar",
            "--viscosity … a length, expected a viscosity",
        ),
        ("map.txt --pitch 1um --viscosity 1Pas --pressure=-1bar", "--pressure … expected 0, or a pressure"),
        ("map.txt --pitch 1um --viscosity 1Pas --pressure 1bar --outlet 0", "--outlet"),
        ("map.txt --pitch 1um --ends open", "--ends … reservoirs"),
        ("map.txt --pitch 1um --overwrite", "--out"),
        ("holes.txt --pitch 1um", "1 of 4 samples are undefined … --fill"),
        ("nowhere.npy --pitch 1um", "nowhere.npy"),
    ] {
        assert_refused(&folder, [(&format!("flow {arguments}"), parts)]);
    }
    for (arguments, parts) in [
        ("map.txt", "--conductivity"),
        ("map.txt --conductivity 0", "--conductivity … expected a thermal conductivity of"),
        ("map.txt --conductivity inf", "--conductivity … finite conductivity of one body"),
        ("map.txt --conductivity 1,2,3", "--conductivity … one value, or two"),
        ("map.txt --conductivity 1MS/m", "--conductivity"),
        ("map.txt --conductivity 46 --film=-1", "--film … expected 0, or"),
        ("map.txt --conductivity 46 --film 1V", "--film"),
        ("map.txt --conductivity 46 --gas 0.026", "--gap"),
        ("map.txt --conductivity 46 --jump 1um", "--gas"),
        ("map.txt --conductivity 46 --gap map.txt", "--gas"),
        ("map.txt --conductivity 46 --gas 0 --gap map.txt", "--gas"),
        ("map.txt --conductivity 46 --gas 1 --gap other.txt", "--gap `other.txt` has … same cells"),
        ("map.txt --conductivity 46 --gas 1 --gap holes.txt", "undefined"),
        ("map.txt --kind electrical --conductivity 1MS/m --gas 1 --gap map.txt", "--gas … --kind electrical"),
        ("map.txt --conductivity 46 --boundary open", "--boundary … free or periodic"),
        ("map.txt --conductivity 46 --above 1 --below 2", "--above … --below"),
        ("map.txt --conductivity 46 --above nan", "--above … expected a number"),
        ("holes.txt --conductivity 46", "undefined … --fill"),
    ] {
        assert_refused(&folder, [(&format!("conductance {arguments} --pitch 1um"), parts)]);
    }
    assert_refused(&folder, [("conductance map.txt --conductivity 46", "need a pitch … --pitch")]);
}

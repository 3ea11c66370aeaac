//! Studies: many cases made of one, by processes that come and go.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, SystemTime};

use asperity::io::fields::Fields;
use serde_json::Value;
use tempfile::TempDir;

use crate::support::{asperity, change, command, files, limited, ok, refused, spawn, stderr, wait_for};

/// A rough body against a flat one, of few cells.
const CASE: &str = r#"
[lower]
young = "210 GPa"
poisson = 0.3
hardness = "4 GPa"
topography = { generate = "low-pass", shape = [16, 16], pitch = "1 um", sq = "20 nm", cutoff = "6 um", seed = 1 }
[upper]
young = "210 GPa"
poisson = 0.3
topography = { form = "flat" }
[contact]
load = "2 mN"
"#;

const STUDY: &str = r#"
base = "case.toml"
[axes]
contact.load = ["1 mN", 0.002]
"lower.topography.sq" = { from = "10 nm", to = "40 nm", count = 3, spacing = "log" }
"lower.topography.seed" = { seeds = 2, first = 7 }
[[exclude]]
"contact.load" = { above = "1.5 mN" }
"lower.topography.sq" = ["10 nm"]
"#;

// ---- plan, cases, tables ---------------------------------------------------------------------------------

#[test]
fn each_case_has_the_numbers_that_it_has_when_it_is_run_alone() {
    let folder = folder_with(STUDY);
    let output = asperity(&folder, "study load.toml");
    // A mean over two seeds for each combination of load and roughness.
    let told = ok(&output);
    assert!(
        told.contains("real area of") && told.ends_with("mean ± standard deviation over the seeds\n"),
        "{told}"
    );
    assert_eq!(
        told.lines().filter(|line| line.contains(" ± ") && line.ends_with("  2")).count(),
        5,
        "{told}"
    );
    assert!(
        stderr(&output).contains("10 of 10 cases are done, 0 have failed; table.csv"),
        "{}",
        stderr(&output)
    );
    let path = |name: &str| folder.path().join(name);
    let plan = fs::read_to_string(path("load/plan.csv")).unwrap();
    let lines: Vec<&str> = plan.lines().collect();
    assert_eq!(lines[0], "case,contact.load (N),lower.topography.sq (m),lower.topography.seed");
    assert_eq!(lines[1..3], ["0001,0.001,1e-8,7", "0002,0.001,1e-8,8"]);
    // The largest load on the smoothest surface is left out.
    assert_eq!((lines.len(), lines[7], lines[10]), (11, "0007,0.002,2e-8,7", "0010,0.002,4e-8,8"));

    let rows = table(&path("load/table.csv"));
    assert_eq!(rows.len(), 10);
    for row in &rows {
        assert_eq!((row["state"].as_str(), row["message"].as_str()), ("done", ""));
        let case = path("load/cases").join(&row["case"]);
        ok(&asperity(
            &folder,
            &format!("run {} --out alone --overwrite --quiet", case.join("case.toml").display()),
        ));
        let [of_study, alone] = [summary(&case), summary(&path("alone"))];
        for key in ["load", "approach", "contact_area", "max_pressure", "mean_gap", "residual"] {
            assert_eq!(of_study["static"][key], alone["static"][key], "{key}");
            assert_eq!(row[key].parse::<f64>().unwrap(), alone["static"][key].as_f64().unwrap(), "{key}");
        }
        assert_eq!(row["contact.load (N)"].parse::<f64>().unwrap(), alone["case"]["contact"]["load"]);
        let topography = &alone["case"]["lower"]["topography"];
        assert_eq!(row["lower.topography.sq (m)"].parse::<f64>().unwrap(), topography["sq"]);
        assert_eq!(row["lower.topography.seed"].parse::<u64>().unwrap(), topography["seed"]);
    }
    let fields = Fields::open(&path("load/table.h5")).unwrap();
    for (name, unit) in
        [("contact.load", "N"), ("contact_area", "m²"), ("lower.topography.seed", "1"), ("done", "1")]
    {
        let column = fields.read(name).unwrap();
        assert_eq!((column.unit.as_str(), column.values.len()), (unit, 10), "{name}");
    }
    let areas: Vec<f64> = rows.iter().map(|row| row["contact_area"].parse().unwrap()).collect();
    assert_eq!(fields.read("contact_area").unwrap().values.into_raw_vec_and_offset().0, areas);

    let page = fs::read_to_string(path("load/study.html")).unwrap();
    assert!((1..=10).all(|case| page.contains(&format!("<tr><th scope=\"row\">{case:04}</th>"))), "{page}");
    assert!(page.contains("Sq of the lower body") && page.contains("area of contact"), "{page}");
    // Done is done: another call computes nothing.
    let before = fs::metadata(path("load/cases/0003/summary.json")).unwrap().modified().unwrap();
    ok(&asperity(&folder, "study load.toml"));
    assert_eq!(fs::metadata(path("load/cases/0003/summary.json")).unwrap().modified().unwrap(), before);
}

#[test]
fn a_table_is_a_plan_and_the_plan_of_a_study_is_such_a_table() {
    let folder = folder_with(
        "base = \"case.toml\"\ntable = \"rows.csv\"\n[axes]\n\"lower.topography.seed\" = [1, 2]\n",
    );
    let rows = "case,contact.load (N),upper.topography.form\n1,0.001,flat\n2,0.002,flat\n";
    fs::write(folder.path().join("rows.csv"), rows).unwrap();
    ok(&asperity(&folder, "study load.toml"));
    let plan = fs::read_to_string(folder.path().join("load/plan.csv")).unwrap();
    let expected = "case,lower.topography.seed,contact.load (N),upper.topography.form\n0001,1,0.001,flat\n0002,1,0.002,flat\n\
                    0003,2,0.001,flat\n0004,2,0.002,flat\n";
    assert_eq!(plan, expected);
    fs::write(folder.path().join("again.toml"), "base = \"case.toml\"\ntable = \"load/plan.csv\"\n").unwrap();
    ok(&asperity(&folder, "study again.toml"));
    assert_eq!(fs::read_to_string(folder.path().join("again/plan.csv")).unwrap(), plan);
    assert_eq!(contents(&folder, "again/table.csv"), contents(&folder, "load/table.csv"));

    // A mistake in a row is shown there.
    change(&folder.path().join("rows.csv"), "2,0.002,flat", "2,0.002,flatt");
    let error = refused(&asperity(&folder, "study load.toml --out other"));
    assert!(error.contains("'form' is \"flatt\"") && error.contains("rows.csv:3:9"), "{error}");
    change(&folder.path().join("rows.csv"), "0.002,flatt", ",flat");
    let error = refused(&asperity(&folder, "study load.toml --out other"));
    assert!(
        error.contains("no value of 'contact.load' in this row") && error.contains("rows.csv:3:"),
        "{error}"
    );
}

#[test]
fn files_are_found_from_where_the_study_lies() {
    let folder = folder_with("");
    let make = |seed: usize| {
        let made = "surface generate low-pass --shape 16x16 --pitch 1um --sq 20nm --cutoff 6um";
        ok(&asperity(&folder, &format!("{made} --seed {seed} --out there/data/{seed}.npy")));
    };
    fs::create_dir_all(folder.path().join("there/data")).unwrap();
    make(1);
    make(2);
    let case = CASE.replace(
        "{ generate = \"low-pass\", shape = [16, 16], pitch = \"1 um\", sq = \"20 nm\", cutoff = \"6 um\", seed = 1 }",
        "{ file = \"data/1.npy\", pitch = \"1 um\" }",
    );
    fs::write(folder.path().join("there/case.toml"), case).unwrap();
    let study = "base = \"case.toml\"\n[axes]\n\"contact.load\" = [1e-3, 2e-3]\n";
    fs::write(folder.path().join("there/loads.toml"), study).unwrap();
    fs::write(
        folder.path().join("there/files.toml"),
        format!("{study}\"lower.topography.file\" = [\"data/1.npy\", \"data/2.npy\"]\n"),
    )
    .unwrap();
    ok(&asperity(&folder, "study there/loads.toml --out results/loads"));
    ok(&asperity(&folder, "study there/files.toml"));
    let [loads, files] =
        ["results/loads", "there/files"].map(|study| table(&folder.path().join(study).join("table.csv")));
    assert_eq!(files[0]["lower.topography.file"], "data/1.npy");
    let pressures = |rows: &[BTreeMap<String, String>]| {
        rows.iter().map(|row| row["max_pressure"].clone()).collect::<Vec<_>>()
    };
    let [loads, files] = [pressures(&loads), pressures(&files)];
    assert_eq!([&files[0], &files[2]], [&loads[0], &loads[1]]);
    assert_ne!(files[0], files[1]);
    // The study may be moved as a whole, and a case computed where it lies.
    fs::rename(folder.path().join("there"), folder.path().join("here")).unwrap();
    ok(&asperity(&folder, "run here/files/cases/0002/case.toml --out alone"));
}

/// A surface of so many cells and this seed at `name`, and a map of the hardness beside it.
fn measure(folder: &TempDir, name: &str, seed: usize) {
    let made = "surface generate low-pass --shape 16x16 --pitch 1um --sq 20nm --cutoff 6um --overwrite";
    ok(&asperity(folder, &format!("{made} --seed {seed} --out {name}")));
}

/// A case whose lower body is measured, in a file of a folder that others have too.
fn measured() -> String {
    CASE.replace(
        "{ generate = \"low-pass\", shape = [16, 16], pitch = \"1 um\", sq = \"20 nm\", cutoff = \"6 um\", seed = 1 }",
        "{ file = \"a/disc.npy\", pitch = \"1 um\" }",
    )
}

#[test]
fn a_measured_file_that_changes_ends_the_study_and_is_named() {
    let folder = folder_with("");
    let path = |name: &str| folder.path().join(name);
    fs::create_dir_all(path("a")).unwrap();
    fs::create_dir_all(path("b")).unwrap();
    let hardness = |gigapascal: f64| {
        let row = format!("{:e} ", gigapascal * 1e9).repeat(16);
        fs::write(path("b/hard.txt"), format!("{row}\n").repeat(16)).unwrap();
    };
    let restore = || {
        measure(&folder, "a/disc.npy", 1);
        measure(&folder, "b/disc.npy", 2);
        hardness(4.0);
    };
    restore();
    fs::write(
        path("case.toml"),
        measured().replace("hardness = \"4 GPa\"", "hardness = { file = \"b/hard.txt\" }"),
    )
    .unwrap();
    let study = "base = \"case.toml\"\n[axes]\n\"contact.load\" = [1e-3, 2e-3]\n\
                 \"upper.topography\" = [{ form = \"flat\" }, { file = \"b/disc.npy\", pitch = \"1 um\" }]\n";
    fs::write(path("load.toml"), study).unwrap();
    // The first of two processes makes the plan.
    ok(&asperity(&folder, "study load.toml --task 1/4 --quiet"));
    let kept: Value = serde_json::from_slice(&fs::read(path("load/files.json")).unwrap()).unwrap();
    let names: Vec<&String> = kept.as_object().unwrap().keys().collect();
    assert_eq!(names, ["lower.hardness.file", "lower.topography.file", "upper.topography.file = b/disc.npy"]);
    for (change, file) in [
        (&(|| measure(&folder, "a/disc.npy", 3)) as &dyn Fn(), "a/disc.npy"),
        (&|| hardness(3.0), "b/hard.txt"),
        (&|| measure(&folder, "b/disc.npy", 3), "b/disc.npy"),
    ] {
        change();
        let error = refused(&asperity(&folder, "study load.toml --quiet"));
        assert!(
            error.contains(&format!("{file} has changed since the results in load were begun")),
            "{error}"
        );
        assert!(error.contains("hint: bring the file back as it was"), "{error}");
        restore();
    }
    ok(&asperity(&folder, "study load.toml --quiet"));
    assert_eq!(table(&path("load/table.csv")).len(), 4);
    // From another folder it is the same study of the same files.
    fs::create_dir(path("elsewhere")).unwrap();
    let moved =
        command(&folder, "study ../load.toml --quiet").current_dir(path("elsewhere")).output().unwrap();
    ok(&moved);
}

#[test]
fn an_older_file_of_a_study_leaves_the_table_of_the_present_one() {
    let study = |values: &str| format!("base = \"case.toml\"\n[axes]\n\"contact.load\" = [{values}]\n");
    let folder = folder_with(&study("\"1 mN\", \"2 mN\", \"3 mN\""));
    ok(&asperity(&folder, "study load.toml"));
    let whole = contents(&folder, "load/table.csv");
    fs::write(folder.path().join("load.toml"), study("\"1 mN\", \"2 mN\"")).unwrap();
    let output = asperity(&folder, "study load.toml --quiet");
    ok(&output);
    assert!(stderr(&output).contains("the study has grown since this file was written"), "{output:?}");
    let error = refused(&asperity(&folder, "study load.toml --collect"));
    assert!(
        error.contains("load has grown: its plan has cases that this study file does not have"),
        "{error}"
    );
    assert!(contents(&folder, "load/table.csv") == whole);
}

#[test]
fn a_text_of_a_table_is_no_formula() {
    let folder = folder_with("");
    let path = |name: &str| folder.path().join(name);
    fs::create_dir_all(path("a")).unwrap();
    measure(&folder, "=1+1.npy", 1);
    measure(&folder, "@a.npy", 2);
    fs::write(path("case.toml"), measured()).unwrap();
    let files = "\"lower.topography.file\" = [\"=1+1.npy\", \"@a.npy\"]\n\"contact.load\" = [1e-3]\n";
    fs::write(path("load.toml"), format!("base = \"case.toml\"\n[axes]\n{files}")).unwrap();
    ok(&asperity(&folder, "study load.toml --quiet"));
    for name in ["load/plan.csv", "load/table.csv"] {
        let text = fs::read_to_string(path(name)).unwrap();
        assert!(text.contains(",'=1+1.npy,0.001") || text.contains("'=1+1.npy,"), "{text}");
        let formulas =
            text.lines().flat_map(|line| line.split(',')).filter(|cell| cell.starts_with(['=', '@', '+']));
        assert_eq!(formulas.count(), 0, "{text}");
        // A number keeps its sign.
        assert!(!text.contains("'-"), "{text}");
    }
    // A plan is a table for another study.
    fs::write(path("again.toml"), "base = \"case.toml\"\ntable = \"load/plan.csv\"\n").unwrap();
    ok(&asperity(&folder, "study again.toml --quiet"));
    assert_eq!(contents(&folder, "again/table.csv"), contents(&folder, "load/table.csv"));
}

/// The numbers of a column of a table.
fn column(rows: &[BTreeMap<String, String>], head: &str) -> Vec<f64> {
    let number = |row: &BTreeMap<String, String>| {
        let cell = row.get(head).unwrap_or_else(|| panic!("no {head} in {:?}", row.keys()));
        cell.parse().unwrap_or(f64::NAN)
    };
    rows.iter().map(number).collect()
}

#[test]
fn a_motion_has_sums_of_what_adds_up_and_says_what_is_of_its_last_pass() {
    let folder = folder_with("base = \"case.toml\"\n[axes]\n\"lower.topography.seed\" = { seeds = 3 }\n");
    let path = |name: &str| folder.path().join(name);
    let wear = "wear = { coefficient = \"1e-7 mm3/(N m)\" }\n[";
    let moves = "load = \"2 mN\"\nboundary = \"periodic\"\n[friction]\ncoefficient = 0.1\n[motion]\nstrategy = \"shift\"\n\
                 speed_upper = \"1 m/s\"\nstride = 4\npasses = 500\n[acceleration]\n[output]\npressure_every = 0\n";
    let case = CASE.replacen("\n[upper]", &format!("\n{wear}upper]"), 1).replace("load = \"2 mN\"\n", moves);
    fs::write(path("case.toml"), case).unwrap();
    let told = ok(&asperity(&folder, "study load.toml"));
    assert!(told.contains("worn volume") && told.contains("µm³") && told.contains(" ± "), "{told}");
    let rows = table(&path("load/table.csv"));
    let [volume, work, distance] =
        ["wear_volume_lower (m³)", "friction_work (J)", "distance (m)"].map(|head| column(&rows, head));
    // Extrapolations end at other passes for other seeds, of which the sums know nothing: k W s, and μ W s.
    assert_ne!(column(&rows, "pass")[0], 500.0);
    assert_eq!(column(&rows, "represents"), [500.0; 3]);
    for n in 0..3 {
        let slid = 2e-3 * distance[n];
        assert!((volume[n] / (1e-16 * slid) - 1.0).abs() < 1e-3, "{}", volume[n] / (1e-16 * slid));
        assert!((work[n] / (0.1 * slid) - 1.0).abs() < 1e-3, "{}", work[n] / (0.1 * slid));
    }
    assert_eq!(column(&rows, "lost_wear_lower (m³)"), volume);
    let last = |head: &str| {
        let summary = |row: &BTreeMap<String, String>| summary(&path("load/cases").join(&row["case"]));
        let passes = |row| summary(row)["passes"].as_array().unwrap().clone();
        rows.iter().map(|row| passes(row).last().unwrap()[head].as_f64().unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(column(&rows, "max_pressure (Pa) of the last pass"), last("max_pressure"));
    assert_eq!(column(&rows, "sq_lower (m)"), last("sq_lower"));
    let page = fs::read_to_string(path("load/study.html")).unwrap();
    assert!(
        page.contains("worn volume, lower body") && page.contains("largest pressure, last pass"),
        "{page}"
    );
}

#[test]
fn a_sweep_in_a_study_has_a_row_for_each_point_with_the_answers_of_all_capabilities() {
    let folder = folder_with("base = \"case.toml\"\n[axes]\n\"lower.topography.seed\" = { seeds = 2 }\n");
    let path = |name: &str| folder.path().join(name);
    let sweeps = "loads = [\"1 mN\", \"2 mN\", \"4 N\"]\nboundary = \"periodic\"\n[flow]\nviscosity = \"1 mPa s\"\npressure = \"1 bar\"\n";
    // With a hardness no pressure carries the last load.
    fs::write(path("case.toml"), CASE.replace("load = \"2 mN\"\n", sweeps)).unwrap();
    assert_eq!(asperity(&folder, "study load.toml").status.code(), Some(1));
    let rows = table(&path("load/table.csv"));
    assert_eq!(rows.iter().map(|row| row["state"].as_str()).collect::<Vec<_>>(), ["failed", "failed"]);
    change(&path("case.toml"), "\"4 N\"", "\"4 mN\"");
    let output = asperity(&folder, "study load.toml --out swept");
    let told = ok(&output);
    let lines: Vec<&str> = told.lines().map(str::trim).collect();
    assert!(told.contains("leakage,") && told.contains("along x      along y"), "{told}");
    for load in ["1 mN", "2 mN", "4 mN"] {
        assert_eq!(
            lines.iter().filter(|line| line.starts_with(load) && line.ends_with("  2")).count(),
            1,
            "{told}"
        );
    }
    assert!(stderr(&output).contains("2 of 2 cases are done, 0 have failed"));
    let rows = table(&path("swept/table.csv"));
    assert_eq!(column(&rows, "case"), [1.0, 1.0, 1.0, 2.0, 2.0, 2.0]);
    assert_eq!(column(&rows, "contact.load (N)"), [1e-3, 2e-3, 4e-3, 1e-3, 2e-3, 4e-3]);
    for case in ["0001", "0002"] {
        let of_case: Vec<_> = rows.iter().filter(|row| row["case"] == case).cloned().collect();
        let found = path("swept/cases").join(case);
        let alone = table(&found.join("results.csv"));
        for head in
            ["point", "load (N)", "contact_area (m²)", "flow_x_leakage (m³/s)", "flow_y_critical_gap (m)"]
        {
            assert_eq!(column(&of_case, head), column(&alone, head), "{head}");
        }
    }
    assert_eq!(Fields::open(&path("swept/table.h5")).unwrap().read("contact.load").unwrap().values.len(), 6);
    let page = fs::read_to_string(path("swept/study.html")).unwrap();
    assert!(page.contains(">0002/3</th>") && page.contains("leakage, along x"), "{page}");
    // A damaged table of a capability is a row that says so.
    let flow = path("swept/cases/0002/flow.csv");
    let whole = fs::read(&flow).unwrap();
    fs::write(&flow, "a,b\n1,2\n").unwrap();
    ok(&asperity(&folder, "study load.toml --out swept --collect"));
    let damaged = table(&path("swept/table.csv"));
    assert_eq!(column(&damaged, "case"), [1.0, 1.0, 1.0, 2.0]);
    assert!(
        damaged[3]["message"].contains("its flow.csv is damaged")
            && damaged[3]["contact.load (N)"].is_empty()
    );
    fs::write(&flow, whole).unwrap();
    // Without a list there is no axis of points.
    change(&path("case.toml"), "loads = [\"1 mN\", \"2 mN\", \"4 mN\"]", "load = \"2 mN\"");
    ok(&asperity(&folder, "study load.toml --out one --quiet"));
    assert!(!table(&path("one/table.csv"))[0].contains_key("contact.load (N)"));
}

// ---- what goes wrong -------------------------------------------------------------------------------------

#[test]
fn a_case_that_fails_has_a_row_with_its_message_and_is_done_until_it_is_retried() {
    // Every cell at the hardness bears 1 N.
    let folder =
        folder_with("base = \"case.toml\"\n[axes]\n\"contact.load\" = [\"1 mN\", \"2 N\", \"2 mN\"]\n");
    let path = |name: &str| folder.path().join(name);
    let output = asperity(&folder, "study load.toml");
    assert_eq!(output.status.code(), Some(1));
    let told = "load 2 N exceeds the plastic limit";
    assert!(stderr(&output).contains(&format!("case 0002: {told}")), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("error: 1 of 3 cases failed\nhint: `--list` tells why"),
        "{}",
        stderr(&output)
    );
    let rows = table(&path("load/table.csv"));
    assert_eq!(rows.iter().map(|row| row["state"].as_str()).collect::<Vec<_>>(), ["done", "failed", "done"]);
    assert!(rows[1]["message"].contains(told) && rows[1]["contact_area"].is_empty());
    assert!(fs::read_to_string(path("load/study.html")).unwrap().contains(told));
    let listed = asperity(&folder, "study load.toml --list");
    assert!(ok(&listed).starts_with(&format!("0002  failed   {told}")), "{listed:?}");
    assert!(stderr(&listed).contains("2 of 3 cases are done, 1 have failed, 0 are running, 0 are open"));

    let modified = |name: &str| fs::metadata(path(name)).unwrap().modified().unwrap();
    let before = ["load/cases/0001/summary.json", "load/cases/0002/failed.json"].map(modified);
    assert_eq!(asperity(&folder, "study load.toml").status.code(), Some(1));
    assert_eq!(["load/cases/0001/summary.json", "load/cases/0002/failed.json"].map(modified), before);
    assert_eq!(asperity(&folder, "study load.toml --retry").status.code(), Some(1));
    assert_eq!(modified("load/cases/0001/summary.json"), before[0]);
    assert!(modified("load/cases/0002/failed.json") > before[1]);
    // What failed for a reason that has gone.
    fs::remove_file(path("load/cases/0001/summary.json")).unwrap();
    fs::write(path("load/cases/0001/failed.json"), "{\"version\": \"0\", \"message\": \"no memory\"}")
        .unwrap();
    ok_or_failed(&asperity(&folder, "study load.toml --retry"));
    assert!(path("load/cases/0001/summary.json").exists() && !path("load/cases/0001/failed.json").exists());
    assert_eq!(table(&path("load/table.csv"))[0]["state"], "done");
}

#[test]
fn a_damaged_summary_is_a_row_that_says_so() {
    let folder = folder_with("base = \"case.toml\"\n[axes]\n\"contact.load\" = [\"1 mN\", \"2 mN\"]\n");
    let path = |name: &str| folder.path().join(name);
    ok(&asperity(&folder, "study load.toml"));
    let whole = fs::read_to_string(path("load/table.csv")).unwrap();
    let summary = path("load/cases/0002/summary.json");
    for damaged in ["", "{\"version\": ", "not JSON"] {
        fs::write(&summary, damaged).unwrap();
        let output = asperity(&folder, "study load.toml --collect");
        assert!(stderr(&output).starts_with("1 of 2 cases are done, 1 have failed"), "{output:?}");
        let rows = table(&path("load/table.csv"));
        assert_eq!([&rows[0]["state"], &rows[1]["state"]], ["done", "failed"]);
        assert!(rows[1]["message"].starts_with("its summary.json is damaged"), "{}", rows[1]["message"]);
    }
    fs::remove_file(&summary).unwrap();
    ok(&asperity(&folder, "study load.toml"));
    assert_eq!(fs::read_to_string(path("load/table.csv")).unwrap(), whole);
}

#[test]
fn a_motion_whose_bodies_never_touch_is_a_row_too() {
    let folder = folder_with("base = \"case.toml\"\n[axes]\n\"contact.approach\" = [\"-1 um\", \"20 nm\"]\n");
    add_motion(&folder);
    change(&folder.path().join("case.toml"), "load = \"2 mN\"", "");
    ok(&asperity(&folder, "study load.toml"));
    let rows = table(&folder.path().join("load/table.csv"));
    let of = |column: &str| rows.iter().map(|row| row[column].clone()).collect::<Vec<_>>();
    assert_eq!(of("state"), ["done", "done"]);
    assert_eq!(
        (of("max_load")[0].as_str(), of("friction_coefficient")),
        ("0.0", vec![String::new(), "0.0".to_owned()])
    );
}

#[test]
fn a_study_grows_on_any_axis_and_computes_only_what_is_new() {
    let study = |loads: &str, seeds: usize| {
        format!(
            "base = \"case.toml\"\n[axes]\n\"contact.load\" = [{loads}]\n\"lower.topography.seed\" = {{ seeds = {seeds} }}\n"
        )
    };
    let folder = folder_with(&study("\"1 mN\", \"2 mN\"", 2));
    let write = |text: &str| fs::write(folder.path().join("load.toml"), text).unwrap();
    ok(&asperity(&folder, "study load.toml"));
    let summary_of = |case: &str| folder.path().join(format!("load/cases/{case}/summary.json"));
    let kept = ["0001", "0002", "0003", "0004"]
        .map(|case| fs::metadata(summary_of(case)).unwrap().modified().unwrap());
    write(&study("\"1 mN\", \"1.5 mN\", \"2 mN\"", 3));
    ok(&asperity(&folder, "study load.toml"));
    let rows = table(&folder.path().join("load/table.csv"));
    assert_eq!(rows.len(), 9);
    let values = |row: &BTreeMap<String, String>| {
        (row["contact.load (N)"].clone(), row["lower.topography.seed"].clone())
    };
    assert_eq!(values(&rows[3]), ("0.002".to_owned(), "2".to_owned()));
    assert_eq!(values(&rows[4]), ("0.001".to_owned(), "3".to_owned()));
    let now = ["0001", "0002", "0003", "0004"]
        .map(|case| fs::metadata(summary_of(case)).unwrap().modified().unwrap());
    assert_eq!(now, kept);
    // The numbers are those of a study that had all cases from the beginning.
    ok(&asperity(&folder, "study load.toml --out whole"));
    let whole = table(&folder.path().join("whole/table.csv"));
    for row in &rows {
        let same = whole.iter().find(|other| values(other) == values(row)).unwrap();
        for key in ["approach", "contact_area", "max_pressure"] {
            assert_eq!(row[key], same[key], "{key}");
        }
    }
}

#[test]
fn loads_beyond_the_plastic_limit_are_named_before_anything_is_computed() {
    // 16 × 16 cells of 1 µm² at 4 GPa bear 1.024 N.
    let folder =
        folder_with("base = \"case.toml\"\n[axes]\n\"contact.load\" = [\"1 mN\", \"1.2 N\", \"2 N\"]\n");
    let output = asperity(&folder, "study load.toml --quiet");
    let told = stderr(&output);
    let first = told.lines().next().unwrap_or_default();
    assert!(
        first.contains("case 0002 will fail, and 1 more case: load 1.2 N exceeds the plastic limit 1.024 N"),
        "{told}"
    );
    // What has failed is not foreseen again.
    assert!(!stderr(&asperity(&folder, "study load.toml --quiet")).contains("will fail"));
}

#[test]
fn a_study_grows_at_its_end_and_is_not_mixed_with_another() {
    let study = |values: &str| format!("base = \"case.toml\"\n[axes]\n\"contact.load\" = [{values}]\n");
    let folder = folder_with(&study("\"1 mN\", \"2 mN\""));
    let write = |text: &str| fs::write(folder.path().join("load.toml"), text).unwrap();
    ok(&asperity(&folder, "study load.toml"));
    write(&study("\"1 mN\", \"2 mN\", \"3 mN\""));
    ok(&asperity(&folder, "study load.toml"));
    assert_eq!(table(&folder.path().join("load/table.csv")).len(), 3);
    for (text, told) in [
        (study("\"2 mN\", \"4 mN\""), "cases of its plan have other values"),
        (
            study("\"1 mN\"").replace("contact.load", "contact.mean_pressure"),
            "both 'load' and 'mean_pressure'",
        ),
        (
            study("1, 2").replace("contact.load", "lower.topography.seed"),
            "its base or the keys of its axes differ",
        ),
    ] {
        write(&text);
        let error = refused(&asperity(&folder, "study load.toml"));
        assert!(error.contains(told), "{error}");
    }
    write(&study("\"1 mN\""));
    change(&folder.path().join("case.toml"), "4 GPa", "3 GPa");
    let error = refused(&asperity(&folder, "study load.toml"));
    assert!(
        error.contains("load holds another study: its base") && error.contains("hint: --out names"),
        "{error}"
    );
    let error = refused(&asperity(&folder, "study load.toml --out ."));
    assert!(error.contains("is not empty, and holds no study"), "{error}");
    let error = refused(&asperity(&folder, "study load.toml --collect --out nowhere"));
    assert!(error.contains("nowhere holds no study"), "{error}");
    // Neither a title nor how it is written is another study.
    change(&folder.path().join("case.toml"), "3 GPa", "4 GPa");
    write(&format!("title = \"named\"\n{}", study("\"1 mN\", \"2 mN\"")));
    ok(&asperity(&folder, "study load.toml"));
}

#[test]
fn bad_usage_of_study_is_told() {
    let folder = folder_with("base = \"case.toml\"\n[axes]\n\"lower.topography.seed\" = { seeds = 6000 }\n");
    let error = refused(&asperity(&folder, "study load.toml"));
    assert!(
        error.contains("the study has 6000 cases") && error.contains("hint: `--yes` computes them"),
        "{error}"
    );
    assert!(!folder.path().join("load").exists());
    for task in ["5/4", "0/4", "4", "-1/4"] {
        let error = refused(&asperity(&folder, &format!("study load.toml --task={task}")));
        assert!(error.contains("--task"), "{error}");
    }
    assert!(
        refused(&asperity(&folder, "study load.toml --task 5/4")).contains("there are 4 tasks: 1/4 to 4/4")
    );
    assert!(refused(&asperity(&folder, "study load.toml --list --retry")).contains("cannot be used with"));
    assert!(refused(&asperity(&folder, "study nowhere.toml")).contains("nowhere.toml"));
    let listed = asperity(&folder, "study load.toml --list --task 3/4");
    assert_eq!(ok(&listed).lines().next(), Some("0003  open     lower.topography.seed = 3"));
    assert_eq!(ok(&listed).lines().count(), 1500);
}

#[test]
#[cfg(unix)]
fn a_full_disk_ends_a_process_and_no_case() {
    let folder = folder_with(STUDY);
    let output = limited(&folder, "-f 8", "study load.toml");
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stderr(&output).contains("fields.h5: File too large"), "{}", stderr(&output));
    let there = files(&folder.path().join("load"));
    assert!(!there.iter().any(|name| name.contains("failed.json")), "{there:?}");
    ok(&asperity(&folder, "study load.toml"));
    assert_eq!(table(&folder.path().join("load/table.csv")).len(), 10);
}

// ---- many processes --------------------------------------------------------------------------------------

#[test]
fn tasks_share_a_study_and_the_last_makes_the_tables() {
    let folder = folder_with(STUDY);
    ok(&asperity(&folder, "study load.toml --out whole"));
    let path = |name: &str| folder.path().join("load").join(name);
    for number in 1..=3 {
        let output = asperity(&folder, &format!("study load.toml --task {number}/3"));
        ok(&output);
        assert_eq!(path("table.csv").exists(), number == 3);
        let done = [4, 7, 10][number - 1];
        let told = format!("{done} of 10 cases are done");
        assert!(stderr(&output).contains(&told), "{told}: {}", stderr(&output));
        if number == 1 {
            let listed = ok(&asperity(&folder, "study load.toml --list"));
            assert!(
                listed.starts_with("0002  open     contact.load = 1 mN") && listed.lines().count() == 6,
                "{listed}"
            );
            // What is there can be looked at meanwhile.
            ok(&asperity(&folder, "study load.toml --collect"));
            assert_eq!(table(&path("table.csv")).len(), 4);
            fs::remove_file(path("table.csv")).unwrap();
        }
    }
    for name in ["table.csv", "table.h5"] {
        assert!(
            contents(&folder, &format!("load/{name}")) == contents(&folder, &format!("whole/{name}")),
            "{name}"
        );
    }
}

#[test]
fn a_case_that_another_process_computes_is_left_to_it() {
    let folder = folder_with("base = \"case.toml\"\n[axes]\n\"motion.passes\" = [100000, 1]\n");
    add_motion(&folder);
    let path = |name: &str| folder.path().join("load").join(name);
    let mut first = spawn(&folder, "study load.toml --threads 1");
    wait_for(&mut first, &path("cases/0001/passes.csv"));
    // An incomplete result is told of whoever asks for quiet.
    for quiet in ["", " --quiet"] {
        let output = asperity(&folder, &format!("study load.toml --threads 1{quiet}"));
        ok(&output);
        let told = "1 of 2 cases are done, 0 have failed, 1 are running, 0 are left";
        assert!(stderr(&output).contains(told), "{quiet}: {}", stderr(&output));
    }
    let listed = ok(&asperity(&folder, "study load.toml --list"));
    assert!(listed.starts_with("0001  running\n"), "{listed}");
    first.kill().unwrap();
    first.wait().unwrap();
    // It is known at once that the process has gone.
    let listed = ok(&asperity(&folder, "study load.toml --list"));
    assert!(listed.starts_with("0001  open     "), "{listed}");
    let rows = || fs::read_to_string(path("cases/0001/passes.csv")).map_or(0, |text| text.lines().count());
    let before = rows();
    let mut next = spawn(&folder, "study load.toml --threads 1");
    let began = std::time::Instant::now();
    while rows() <= before {
        assert!(began.elapsed() < Duration::from_secs(60), "nobody goes on with the case");
        std::thread::sleep(Duration::from_millis(5));
    }
    crate::support::send("INT", &next);
    assert_eq!(next.wait().unwrap().code(), Some(130));
    let listed = ok(&asperity(&folder, "study load.toml --list"));
    assert!(listed.starts_with("0001  open     "), "who is interrupted gives back what it had: {listed}");
}

/// As many kills as `ASPERITY_KILLS` says.
#[test]
fn processes_that_are_killed_at_random_lose_no_case_and_count_none_twice() {
    let kills: usize = std::env::var("ASPERITY_KILLS").ok().and_then(|text| text.parse().ok()).unwrap_or(6);
    let study = "base = \"case.toml\"\n[axes]\n\"contact.load\" = { from = \"1 mN\", to = \"5 mN\", count = 5 }\n\
                 \"lower.topography.seed\" = { seeds = 4 }\n\"motion.passes\" = [2, 12]\n";
    let folder = folder_with(study);
    add_motion(&folder);
    ok(&asperity(&folder, "study load.toml --out whole"));
    let whole = ["table.csv", "table.h5", "plan.csv"].map(|name| contents(&folder, &format!("whole/{name}")));
    let mut random = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap().as_nanos() as u64;
    let mut below = |n: u64| {
        random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (random >> 33) % n
    };
    let (mut killed, mut round) = (0, 0);
    while killed < kills {
        round += 1;
        assert!(round < 20 + 4 * kills, "{killed} of {kills} processes were killed in {round} rounds");
        let start = || {
            let mut started =
                command(&folder, &format!("study load.toml --out killed-{round} --threads 1 --quiet"));
            started.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
        };
        let mut processes: Vec<Child> = (0..3).map(|_| start()).collect();
        while killed < kills && !processes.is_empty() {
            std::thread::sleep(Duration::from_millis(5 + below(150)));
            let mut victim = processes.swap_remove(below(processes.len() as u64) as usize);
            if victim.try_wait().unwrap().is_none() {
                victim.kill().unwrap();
                killed += 1;
                processes.push(start());
            }
            victim.wait().unwrap();
        }
        for mut process in processes {
            assert!(process.wait().unwrap().success());
        }
        ok(&asperity(&folder, &format!("study load.toml --out killed-{round}")));
        for (name, whole) in ["table.csv", "table.h5", "plan.csv"].iter().zip(&whole) {
            assert!(contents(&folder, &format!("killed-{round}/{name}")) == *whole, "round {round}: {name}");
        }
        let there = files(&folder.path().join(format!("killed-{round}")));
        assert_eq!(there.iter().filter(|name| name.ends_with("summary.json")).count(), 40);
        assert!(!there.iter().any(|name| name.contains("failed.json")), "{there:?}");
    }
}

// ---- what they share -------------------------------------------------------------------------------------

fn folder_with(study: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("case.toml"), CASE).unwrap();
    fs::write(folder.path().join("load.toml"), study).unwrap();
    folder
}

/// The upper body moves over the lower one.
fn add_motion(folder: &TempDir) {
    let flat = "topography = { form = \"flat\" }";
    let ball = "topography = { form = \"sphere\", radius = \"100 um\", shape = [12, 16] }";
    change(&folder.path().join("case.toml"), flat, ball);
    let case = fs::read_to_string(folder.path().join("case.toml")).unwrap();
    fs::write(folder.path().join("case.toml"), case + "[motion]\nstride = 4\n[output]\npressure_every = 0\n")
        .unwrap();
}

fn contents(folder: &TempDir, name: &str) -> Vec<u8> {
    fs::read(folder.path().join(name)).unwrap()
}

/// The rows of a table, by column: its head, and its name alone.
fn table(path: &Path) -> Vec<BTreeMap<String, String>> {
    let text = fs::read_to_string(path).unwrap();
    // Excel knows the encoding by this mark.
    let mut lines = text.strip_prefix('\u{feff}').unwrap().lines();
    let columns: Vec<&str> = lines.next().unwrap().split(',').collect();
    let row = |line: &str| {
        // The message comes last, and may hold commas.
        let cells: Vec<String> = line.splitn(columns.len(), ',').map(str::to_owned).collect();
        let names = |head: &&str| {
            [
                (*head).to_owned(),
                head.trim_end_matches(" of the last pass").split(" (").next().unwrap_or_default().to_owned(),
            ]
        };
        columns
            .iter()
            .map(names)
            .zip(cells)
            .flat_map(|(names, cell)| names.map(|name| (name, cell.clone())))
            .collect()
    };
    lines.map(row).collect()
}

fn summary(directory: &Path) -> Value {
    serde_json::from_slice(&fs::read(directory.join("summary.json")).unwrap()).unwrap()
}

fn ok_or_failed(output: &std::process::Output) {
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", stderr(output));
}

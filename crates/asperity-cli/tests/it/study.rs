//! Studies: many cases made of one, by processes that come and go.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, SystemTime};

use tempfile::TempDir;

use crate::support::{
    asperity, assert_has, assert_refused, change, command, failed, files, keys, limited, ok,
};
use crate::support::{spawn, stderr, summary, wait_for};

const GENERATED: &str = "{ generate = \"low-pass\", shape = [16, 16], pitch = \"1 um\", sq = \"20 nm\", \
                         cutoff = \"6 um\", seed = 1 }";

/// A rough body against a flat one, of few cells.
const CASE: &str = r#"
[lower]
young = "210 GPa"
poisson = 0.3
hardness = "4 GPa"
topography = GENERATED
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
    assert_has(&told, "real area of");
    assert!(told.ends_with("mean ± standard deviation over the seeds\n"), "{told}");
    let means = told.lines().filter(|line| line.contains(" ± ") && line.ends_with("  2"));
    assert_eq!(means.count(), 5, "{told}");
    assert_has(&stderr(&output), "10 of 10 cases are done, 0 have failed; table.csv");
    let path = |name: &str| folder.path().join(name);
    let rows = table(&path("load/table.csv"));
    assert_eq!(rows.len(), 10);
    for row in &rows {
        assert_eq!((row["state"].as_str(), row["message"].as_str()), ("done", ""));
        let case = path("load/cases").join(&row["case"]).join("case.toml");
        ok(&asperity(&folder, &format!("run {} --out alone --overwrite --quiet", case.display())));
        let alone = summary(&path("alone"));
        for key in ["load", "approach", "contact_area", "max_pressure", "mean_gap", "residual"] {
            assert_eq!(row[key].parse::<f64>().unwrap(), alone["static"][key].as_f64().unwrap(), "{key}");
        }
        let topography = &alone["case"]["lower"]["topography"];
        assert_eq!(row["contact.load (N)"].parse::<f64>().unwrap(), alone["case"]["contact"]["load"]);
        assert_eq!(row["lower.topography.sq (m)"].parse::<f64>().unwrap(), topography["sq"]);
        assert_eq!(row["lower.topography.seed"].parse::<u64>().unwrap(), topography["seed"]);
    }
    let page = fs::read_to_string(path("load/study.html")).unwrap();
    assert!((1..=10).all(|case| page.contains(&format!("<tr><th scope=\"row\">{case:04}</th>"))), "{page}");
    assert_has(&page, "Sq of the lower body … area of contact");
    // Done is done: another call computes nothing.
    let before = modified(&path("load/cases/0003/summary.json"));
    ok(&asperity(&folder, "study load.toml"));
    assert_eq!(modified(&path("load/cases/0003/summary.json")), before);
}

#[test]
fn a_table_is_a_plan_and_the_plan_of_a_study_is_such_a_table() {
    let folder = folder_with(
        "base = \"case.toml\"\ntable = \"rows.csv\"\n[axes]\n\"lower.topography.seed\" = [1, 2]\n",
    );
    let rows = folder.path().join("rows.csv");
    fs::write(&rows, "case,contact.load (N),upper.topography.form\n1,0.001,flat\n2,0.002,flat\n").unwrap();
    ok(&asperity(&folder, "study load.toml"));
    let plan = fs::read_to_string(folder.path().join("load/plan.csv")).unwrap();
    let expected = "case,lower.topography.seed,contact.load (N),upper.topography.form\n\
                    0001,1,0.001,flat\n0002,1,0.002,flat\n0003,2,0.001,flat\n0004,2,0.002,flat\n";
    assert_eq!(plan, expected);
    fs::write(folder.path().join("again.toml"), "base = \"case.toml\"\ntable = \"load/plan.csv\"\n").unwrap();
    ok(&asperity(&folder, "study again.toml"));
    assert_eq!(fs::read_to_string(folder.path().join("again/plan.csv")).unwrap(), plan);
    assert_eq!(contents(&folder, "again/table.csv"), contents(&folder, "load/table.csv"));

    // A mistake in a row is shown there.
    change(&rows, "2,0.002,flat", "2,0.002,flatt");
    assert_refused(&folder, [("study load.toml --out other", "'form' is \"flatt\" … rows.csv:3:9")]);
    change(&rows, "0.002,flatt", ",flat");
    let told = "no value of 'contact.load' in this row … rows.csv:3:";
    assert_refused(&folder, [("study load.toml --out other", told)]);
}

#[test]
fn files_are_found_from_where_the_study_lies() {
    let folder = folder_with("");
    let path = |name: &str| folder.path().join(name);
    fs::create_dir_all(path("there/data")).unwrap();
    measure(&folder, "there/data/1.npy", 1);
    measure(&folder, "there/data/2.npy", 2);
    fs::write(path("there/case.toml"), measured("data/1.npy")).unwrap();
    let study = "base = \"case.toml\"\n[axes]\n\"contact.load\" = [1e-3, 2e-3]\n";
    fs::write(path("there/loads.toml"), study).unwrap();
    let files = "\"lower.topography.file\" = [\"data/1.npy\", \"data/2.npy\"]\n";
    fs::write(path("there/files.toml"), format!("{study}{files}")).unwrap();
    ok(&asperity(&folder, "study there/loads.toml --out results/loads"));
    ok(&asperity(&folder, "study there/files.toml"));
    let [loads, files] = ["results/loads", "there/files"].map(|study| table(&path(study).join("table.csv")));
    assert_eq!(files[0]["lower.topography.file"], "data/1.npy");
    let [loads, files] = [loads, files].map(|rows| column(&rows, "max_pressure"));
    assert_eq!([files[0], files[2]], [loads[0], loads[1]]);
    assert_ne!(files[0], files[1]);
    // The study may be moved as a whole, and a case computed where it lies.
    fs::rename(path("there"), path("here")).unwrap();
    ok(&asperity(&folder, "run here/files/cases/0002/case.toml --out alone"));
}

/// A measured surface with this seed at `name`.
fn measure(folder: &TempDir, name: &str, seed: usize) {
    let made = "surface generate low-pass --shape 16x16 --pitch 1um --sq 20nm --cutoff 6um --overwrite";
    ok(&asperity(folder, &format!("{made} --seed {seed} --out {name}")));
}

/// A case whose lower body is measured.
fn measured(file: &str) -> String {
    case().replace(GENERATED, &format!("{{ file = \"{file}\", pitch = \"1 um\" }}"))
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
    let case = measured("a/disc.npy").replace("\"4 GPa\"", "{ file = \"b/hard.txt\" }");
    fs::write(path("case.toml"), case).unwrap();
    let study = "base = \"case.toml\"\n[axes]\n\"contact.load\" = [1e-3, 2e-3]\n\
                 \"upper.topography\" = [{ form = \"flat\" }, { file = \"b/disc.npy\", pitch = \"1 um\" }]\n";
    fs::write(path("load.toml"), study).unwrap();
    // The first of two processes makes the plan.
    ok(&asperity(&folder, "study load.toml --task 1/4 --quiet"));
    let kept = serde_json::from_slice(&contents(&folder, "load/files.json")).unwrap();
    let names = ["lower.hardness.file", "lower.topography.file", "upper.topography.file = b/disc.npy"];
    assert_eq!(keys(&kept), names.map(str::to_owned).into());
    for (change, file) in [
        (&(|| measure(&folder, "a/disc.npy", 3)) as &dyn Fn(), "a/disc.npy"),
        (&|| hardness(3.0), "b/hard.txt"),
        (&|| measure(&folder, "b/disc.npy", 3), "b/disc.npy"),
    ] {
        change();
        let told = format!("{file} has changed since the results in load were begun");
        let hint = "hint: bring the file back as it was";
        assert_refused(&folder, [("study load.toml --quiet", &format!("{told} … {hint}"))]);
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
fn a_text_of_a_table_is_no_formula() {
    let folder = folder_with("");
    let path = |name: &str| folder.path().join(name);
    measure(&folder, "=1+1.npy", 1);
    measure(&folder, "@a.npy", 2);
    fs::write(path("case.toml"), measured("=1+1.npy")).unwrap();
    let files = "\"lower.topography.file\" = [\"=1+1.npy\", \"@a.npy\"]\n\"contact.load\" = [1e-3]";
    fs::write(path("load.toml"), axes(files)).unwrap();
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

#[test]
fn a_motion_has_sums_of_what_adds_up_and_says_what_is_of_its_last_pass() {
    let folder = folder_with(&axes("\"lower.topography.seed\" = { seeds = 3 }"));
    let path = |name: &str| folder.path().join(name);
    let moves = "load = \"2 mN\"\nboundary = \"periodic\"\n[friction]\ncoefficient = 0.1\n[motion]\n\
                 strategy = \"shift\"\nspeed_upper = \"1 m/s\"\nstride = 4\npasses = 500\n[acceleration]\n\
                 [output]\npressure_every = 0\n";
    let wears = "wear = { coefficient = \"1e-7 mm3/(N m)\" }\n[upper]";
    fs::write(path("case.toml"), case().replace("[upper]", wears).replace("load = \"2 mN\"\n", moves))
        .unwrap();
    assert_has(&ok(&asperity(&folder, "study load.toml")), "worn volume … µm³ …  ± ");
    let rows = table(&path("load/table.csv"));
    // Extrapolations end at other passes for other seeds, of which the sums know nothing.
    assert_ne!(column(&rows, "pass")[0], 500.0);
    assert_eq!(column(&rows, "represents"), [500.0; 3]);
    assert!(rows[0].contains_key("max_pressure (Pa) of the last pass"), "{:?}", rows[0].keys());
    let page = fs::read_to_string(path("load/study.html")).unwrap();
    assert_has(&page, "worn volume, lower body … largest pressure, last pass");
}

#[test]
fn a_sweep_in_a_study_has_a_row_for_each_point_with_the_answers_of_all_capabilities() {
    let folder = folder_with(&axes("\"lower.topography.seed\" = { seeds = 2 }"));
    let path = |name: &str| folder.path().join(name);
    let sweeps = "loads = [\"1 mN\", \"2 mN\", \"4 mN\"]\nboundary = \"periodic\"\n\
                  [flow]\nviscosity = \"1 mPa s\"\npressure = \"1 bar\"\n";
    change(&path("case.toml"), "load = \"2 mN\"\n", sweeps);
    let output = asperity(&folder, "study load.toml --out swept");
    let told = ok(&output);
    assert_has(&told, "leakage, … along x      along y");
    for load in ["1 mN", "2 mN", "4 mN"] {
        let means = told.lines().filter(|line| line.trim().starts_with(load) && line.ends_with("  2"));
        assert_eq!(means.count(), 1, "{told}");
    }
    assert_has(&stderr(&output), "2 of 2 cases are done, 0 have failed");
    let rows = table(&path("swept/table.csv"));
    assert_eq!(column(&rows, "case"), [1.0, 1.0, 1.0, 2.0, 2.0, 2.0]);
    assert_eq!(column(&rows, "contact.load (N)"), [1e-3, 2e-3, 4e-3, 1e-3, 2e-3, 4e-3]);
    for case in ["0001", "0002"] {
        let of_case: Vec<_> = rows.iter().filter(|row| row["case"] == case).cloned().collect();
        let found = path("swept/cases").join(case);
        let alone = table(&found.join("results.csv"));
        let flows = ["flow_x_leakage (m³/s)", "flow_y_critical_gap (m)"];
        for head in ["point", "load (N)", "contact_area (m²)"].into_iter().chain(flows) {
            assert_eq!(column(&of_case, head), column(&alone, head), "{head}");
        }
    }
    let page = fs::read_to_string(path("swept/study.html")).unwrap();
    assert_has(&page, ">0002/3</th> … leakage, along x");
    // A damaged table of a capability is a row that says so.
    let flow = path("swept/cases/0002/flow.csv");
    let whole = fs::read(&flow).unwrap();
    fs::write(&flow, "a,b\n1,2\n").unwrap();
    ok(&asperity(&folder, "study load.toml --out swept --collect"));
    let damaged = table(&path("swept/table.csv"));
    assert_eq!(column(&damaged, "case"), [1.0, 1.0, 1.0, 2.0]);
    assert_has(&damaged[3]["message"], "its flow.csv is damaged");
    assert_eq!(damaged[3]["contact.load (N)"], "");
    fs::write(&flow, whole).unwrap();
    // Without a list there is no axis of points.
    change(&path("case.toml"), "loads = [\"1 mN\", \"2 mN\", \"4 mN\"]", "load = \"2 mN\"");
    ok(&asperity(&folder, "study load.toml --out one --quiet"));
    assert!(!table(&path("one/table.csv"))[0].contains_key("contact.load (N)"));
}

// ---- what goes wrong -------------------------------------------------------------------------------------

#[test]
fn a_case_that_fails_has_a_row_with_its_message_and_is_done_until_it_is_retried() {
    // 16 × 16 cells of 1 µm² at 4 GPa bear 1.024 N.
    let folder = folder_with(&axes("\"contact.load\" = [\"1 mN\", \"1.2 N\", \"2 N\"]"));
    let path = |name: &str| folder.path().join(name);
    let said = failed(&asperity(&folder, "study load.toml --quiet"), 1);
    let told = "load 1.2 N exceeds the plastic limit 1.024 N";
    let foreseen = format!("case 0002 will fail, and 1 more case: {told}");
    assert_has(said.lines().next().unwrap_or_default(), &foreseen);
    assert_has(&said, &format!("case 0002: {told} … error: 2 of 3 cases failed\nhint: `--list` says why"));
    let rows = table(&path("load/table.csv"));
    assert_eq!(states(&rows), ["done", "failed", "failed"]);
    assert!(rows[1]["message"].contains(told) && rows[1]["contact_area"].is_empty());
    assert_has(&fs::read_to_string(path("load/study.html")).unwrap(), told);
    let listed = asperity(&folder, "study load.toml --list");
    assert!(ok(&listed).starts_with(&format!("0002  failed   {told}")), "{listed:?}");
    assert_has(&stderr(&listed), "1 of 3 cases are done, 2 have failed, 0 are running, 0 are open");

    // What has failed is neither foreseen nor computed again.
    let [done, other] = ["load/cases/0001/summary.json", "load/cases/0002/failed.json"].map(path);
    let before = modified(&other);
    assert!(!failed(&asperity(&folder, "study load.toml --quiet"), 1).contains("will fail"));
    assert_eq!(modified(&other), before);
    // What failed for a reason that has gone.
    fs::remove_file(&done).unwrap();
    let gone = path("load/cases/0001/failed.json");
    fs::write(&gone, "{\"version\": \"0\", \"message\": \"no memory\"}").unwrap();
    failed(&asperity(&folder, "study load.toml --retry"), 1);
    assert!(done.exists() && !gone.exists() && modified(&other) > before);
    assert_eq!(states(&table(&path("load/table.csv"))), ["done", "failed", "failed"]);
}

#[test]
fn a_damaged_summary_is_a_row_that_says_so() {
    let folder = folder_with(&axes("\"contact.load\" = [\"1 mN\", \"2 mN\"]"));
    let path = |name: &str| folder.path().join(name);
    ok(&asperity(&folder, "study load.toml"));
    let whole = fs::read_to_string(path("load/table.csv")).unwrap();
    let summary = path("load/cases/0002/summary.json");
    for damaged in ["", "{\"version\": ", "not JSON"] {
        fs::write(&summary, damaged).unwrap();
        let output = asperity(&folder, "study load.toml --collect");
        assert!(stderr(&output).starts_with("1 of 2 cases are done, 1 have failed"), "{output:?}");
        let rows = table(&path("load/table.csv"));
        assert_eq!(states(&rows), ["done", "failed"]);
        assert!(rows[1]["message"].starts_with("its summary.json is damaged"), "{}", rows[1]["message"]);
    }
    fs::remove_file(&summary).unwrap();
    ok(&asperity(&folder, "study load.toml"));
    assert_eq!(fs::read_to_string(path("load/table.csv")).unwrap(), whole);
}

#[test]
fn a_motion_whose_bodies_never_touch_is_a_row_too() {
    let folder = folder_with(&axes("\"contact.approach\" = [\"-1 um\", \"20 nm\"]"));
    add_motion(&folder);
    change(&folder.path().join("case.toml"), "load = \"2 mN\"", "");
    ok(&asperity(&folder, "study load.toml"));
    let rows = table(&folder.path().join("load/table.csv"));
    assert_eq!(states(&rows), ["done", "done"]);
    assert_eq!((rows[0]["max_load"].as_str(), rows[0]["friction_coefficient"].as_str()), ("0.0", ""));
    assert_eq!(rows[1]["friction_coefficient"], "0.0");
}

#[test]
fn a_study_grows_on_any_axis_and_is_not_mixed_with_another() {
    let loads = |values: &str| axes(&format!("\"contact.load\" = [{values}]"));
    let seeds = "\"lower.topography.seed\" = [1, 2]\n";
    let folder = folder_with(&loads("\"1 mN\", \"2 mN\""));
    let path = |name: &str| folder.path().join(name);
    let write = |text: &str| fs::write(path("load.toml"), text).unwrap();
    ok(&asperity(&folder, "study load.toml"));
    let before = modified(&path("load/cases/0002/summary.json"));
    write(&loads("\"1 mN\", \"1.5 mN\", \"2 mN\""));
    ok(&asperity(&folder, "study load.toml"));
    assert_eq!(column(&table(&path("load/table.csv")), "contact.load (N)"), [1e-3, 2e-3, 1.5e-3]);
    assert_eq!(modified(&path("load/cases/0002/summary.json")), before, "it is computed again");
    for (text, told) in [
        (loads("\"2 mN\", \"4 mN\""), "cases of its plan have other values"),
        (
            loads("\"1 mN\"").replace("contact.load", "contact.mean_pressure"),
            "both 'load' and 'mean_pressure'",
        ),
        (loads("\"1 mN\"") + seeds, "its base or the keys of its axes differ"),
    ] {
        write(&text);
        assert_refused(&folder, [("study load.toml", told)]);
    }
    write(&loads("\"1 mN\""));
    change(&path("case.toml"), "4 GPa", "3 GPa");
    assert_refused(
        &folder,
        [
            ("study load.toml", "load holds another study: its base … hint: --out names"),
            ("study load.toml --out .", "is not empty, and holds no study"),
            ("study load.toml --collect --out nowhere", "nowhere holds no study"),
        ],
    );
    // Neither a title nor an older file is another study; the table stays that of the present one.
    change(&path("case.toml"), "3 GPa", "4 GPa");
    write(&format!("title = \"named\"\n{}", loads("\"1 mN\", \"2 mN\"")));
    let whole = contents(&folder, "load/table.csv");
    let output = asperity(&folder, "study load.toml --quiet");
    ok(&output);
    assert_has(&stderr(&output), "the study has grown since this file was written");
    let told = "load has grown: its plan has cases that this study file does not have";
    assert_refused(&folder, [("study load.toml --collect", told)]);
    assert!(contents(&folder, "load/table.csv") == whole);
}

#[test]
fn bad_usage_of_study_is_told() {
    let folder = folder_with(&axes("\"lower.topography.seed\" = { seeds = 6000 }"));
    assert_refused(
        &folder,
        [
            ("study load.toml", "the study has 6000 cases … hint: `--yes` computes them"),
            ("study load.toml --task=5/4", "--task … there are 4 tasks: 1/4 to 4/4"),
            ("study load.toml --task=0/4", "--task"),
            ("study load.toml --task=4", "--task"),
            ("study load.toml --task=-1/4", "--task"),
            ("study load.toml --list --retry", "cannot be used with"),
            ("study nowhere.toml", "nowhere.toml"),
        ],
    );
    assert!(!folder.path().join("load").exists());
    let listed = ok(&asperity(&folder, "study load.toml --list --task 3/4"));
    assert_eq!(listed.lines().next(), Some("0003  open     lower.topography.seed = 3"));
    assert_eq!(listed.lines().count(), 1500);
}

#[test]
fn a_bad_value_of_an_axis_is_shown_where_it_stands() {
    let layers = "layers = [{ thickness = \"1 um\", young = \"300 GPa\", poisson = 0.3 }, { thickness = \"2 um\", young = \"400 GPa\", poisson = 0.3 }]";
    let told = |axes_of: &str| {
        let folder = folder_with(&axes(axes_of));
        let layered = case().replace("[upper]\n", &format!("[upper]\n{layers}\n"));
        fs::write(folder.path().join("case.toml"), layered).unwrap();
        failed(&asperity(&folder, "study load.toml"), 2)
    };
    assert_has(&told("\"contact.load\" = [1, -2]"), "'load' is -2 … load.toml:3:22");
    let thickness = "\"upper.layers.1.thickness\" = [\"1 um\", \"-2 um\"]";
    assert_has(&told(thickness), "'thickness' is \"-2 um\" … load.toml:3:39");
    // The message does not say which of two tables is meant.
    let both = format!("{thickness}\n\"upper.layers.0.thickness\" = [\"1 um\"]");
    assert_has(&told(&both), "'thickness' is \"-2 um\" … case.toml");
}

#[test]
#[cfg(unix)]
fn a_full_disk_ends_a_process_and_no_case() {
    let folder = folder_with(STUDY);
    assert_has(&failed(&limited(&folder, "-f 8", "study load.toml"), 1), "fields.h5: File too large");
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
        assert_has(&stderr(&output), &format!("{} of 10 cases are done", [4, 7, 10][number - 1]));
        if number == 1 {
            let listed = ok(&asperity(&folder, "study load.toml --list"));
            assert!(listed.starts_with("0002  open     contact.load = 1 mN"), "{listed}");
            assert_eq!(listed.lines().count(), 6, "{listed}");
            // What is there can be looked at meanwhile.
            ok(&asperity(&folder, "study load.toml --collect"));
            assert_eq!(table(&path("table.csv")).len(), 4);
            fs::remove_file(path("table.csv")).unwrap();
        }
    }
    let [found, whole] = ["load", "whole"].map(|study| contents(&folder, &format!("{study}/table.csv")));
    assert!(found == whole);
}

#[test]
fn a_case_that_another_process_computes_is_left_to_it() {
    let folder = folder_with(&axes("\"motion.passes\" = [100000, 1]"));
    add_motion(&folder);
    let path = |name: &str| folder.path().join("load").join(name);
    let mut first = spawn(&folder, "study load.toml --threads 1");
    wait_for(&mut first, &path("cases/0001/passes.csv"));
    // An incomplete result is reported even with --quiet.
    for quiet in ["", " --quiet"] {
        let output = asperity(&folder, &format!("study load.toml --threads 1{quiet}"));
        ok(&output);
        assert_has(&stderr(&output), "1 of 2 cases are done, 0 have failed, 1 are running, 0 are left");
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
    let study = "\"contact.load\" = { from = \"1 mN\", to = \"5 mN\", count = 5 }\n\
                 \"lower.topography.seed\" = { seeds = 4 }\n\"motion.passes\" = [2, 12]";
    let folder = folder_with(&axes(study));
    add_motion(&folder);
    ok(&asperity(&folder, "study load.toml --out whole"));
    let whole = ["table.csv", "plan.csv"].map(|name| contents(&folder, &format!("whole/{name}")));
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
        for (name, whole) in ["table.csv", "plan.csv"].iter().zip(&whole) {
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
    fs::write(folder.path().join("case.toml"), case()).unwrap();
    fs::write(folder.path().join("load.toml"), study).unwrap();
    folder
}

/// A study with these axes.
fn axes(axes: &str) -> String {
    format!("base = \"case.toml\"\n[axes]\n{axes}\n")
}

fn case() -> String {
    CASE.replace("GENERATED", GENERATED)
}

fn modified(file: &Path) -> SystemTime {
    fs::metadata(file).unwrap().modified().unwrap()
}

/// The upper body moves over the lower one.
fn add_motion(folder: &TempDir) {
    let flat = "topography = { form = \"flat\" }";
    let ball = "topography = { form = \"sphere\", radius = \"100 um\", shape = [12, 16] }";
    change(&folder.path().join("case.toml"), flat, ball);
    let path = folder.path().join("case.toml");
    let case = fs::read_to_string(&path).unwrap();
    fs::write(path, case + "[motion]\nstride = 4\n[output]\npressure_every = 0\n").unwrap();
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
        let mut row = BTreeMap::new();
        // The message comes last, and may hold commas.
        for (head, cell) in columns.iter().zip(line.splitn(columns.len(), ',')) {
            let name = head.trim_end_matches(" of the last pass").split(" (").next().unwrap_or_default();
            row.insert((*head).to_owned(), cell.to_owned());
            row.insert(name.to_owned(), cell.to_owned());
        }
        row
    };
    lines.map(row).collect()
}

/// The numbers of a column of a table.
fn column(rows: &[BTreeMap<String, String>], head: &str) -> Vec<f64> {
    let number = |row: &BTreeMap<String, String>| {
        let cell = row.get(head).unwrap_or_else(|| panic!("no {head} in {:?}", row.keys()));
        cell.parse().unwrap_or(f64::NAN)
    };
    rows.iter().map(number).collect()
}

fn states(rows: &[BTreeMap<String, String>]) -> Vec<&str> {
    rows.iter().map(|row| row["state"].as_str()).collect()
}

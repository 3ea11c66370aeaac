//! Runs whose files are in memory: those of the command, byte by byte but for times, and resumed after a
//! stop.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use asperity_study::io::fields::Fields;
use asperity_web::{Failure, cases, files, runs, surfaces};
use serde_json::{Value, json};

fn ignore(_: &Value) -> bool {
    false
}

/// Names of all files of a folder, without the folder.
fn names(folder: &str) -> Vec<String> {
    let files = files::files(folder);
    let name = |file: &Value| file["name"].as_str().unwrap()[folder.len() + 1..].to_owned();
    files.as_array().unwrap().iter().map(name).collect()
}

/// The content of a file without times.
fn timeless(name: &str, bytes: &[u8]) -> Value {
    match name.rsplit('.').next() {
        Some("json") => without_times(serde_json::from_slice(bytes).unwrap()),
        Some("csv") => {
            let text = std::str::from_utf8(bytes).unwrap();
            let columns: Vec<&str> = text.lines().next().unwrap().split(',').collect();
            let row = |line: &str| {
                let cells = line.split(',').zip(&columns).filter(|(_, column)| **column != "wall_time_s");
                cells.map(|(cell, _)| cell.to_owned()).collect::<Vec<_>>()
            };
            json!(text.lines().map(row).collect::<Vec<_>>())
        }
        Some("h5") => {
            files::put("compared/fields.h5", bytes).unwrap();
            let fields = Fields::open(Path::new("compared/fields.h5")).unwrap();
            fields.verify().unwrap();
            format!("{:?} {:?}", fields.names().unwrap(), fields.attributes().unwrap()).into()
        }
        _ => bytes.into(),
    }
}

fn without_times(value: Value) -> Value {
    match value {
        Value::Object(table) => {
            let kept = table.into_iter().filter(|(key, _)| key != "wall_time_s");
            kept.map(|(key, value)| (key, without_times(value))).collect()
        }
        Value::Array(items) => items.into_iter().map(without_times).collect(),
        other => other,
    }
}

/// The files of results without times; those of a page are left out.
fn results(folder: &str) -> BTreeMap<String, Value> {
    let kept = names(folder).into_iter().filter(|name| !name.starts_with('.') && name != "report.html");
    kept.map(|name| (name.clone(), timeless(&name, &files::get(&format!("{folder}/{name}")).unwrap())))
        .collect()
}

#[test]
#[ignore = "needs an optimised build of the command, which ASPERITY_BINARY names"]
fn files_in_memory_are_those_of_the_command() {
    let command = std::env::var_os("ASPERITY_BINARY").expect("ASPERITY_BINARY names the command");
    for name in ["quickstart", "hertz", "friction", "measured", "viscoelastic"] {
        let disk = tempfile::tempdir().unwrap();
        let run = |arguments: &[&str]| {
            let output = Command::new(&command).current_dir(disk.path()).args(arguments).output().unwrap();
            assert!(output.status.success(), "{output:?}");
        };
        run(&["example", name]);
        run(&[
            "run",
            &format!("{name}/case.toml"),
            "--out",
            &format!("{name}/results"),
            "--threads",
            "1",
            "--quiet",
        ]);
        let case = cases::example(name).unwrap();
        let folder = format!("{name}/results");
        runs::run(&case, &folder, "keep", ignore).unwrap();
        let computed = results(&folder);
        assert!(computed.contains_key("summary.json") && computed.contains_key("case.json"), "{name}");
        for (file, content) in &computed {
            let bytes = std::fs::read(disk.path().join(&folder).join(file)).unwrap();
            assert_eq!(timeless(file, &bytes), *content, "{name}: {file}");
        }
    }
}

#[test]
fn a_stopped_motion_goes_on_from_files_that_were_put_back() {
    fn stop_after_two(event: &Value) -> bool {
        event["kind"] == "step" && event["number"] == 2
    }
    let case = cases::example("quickstart").unwrap();
    runs::run(&case, "whole", "keep", ignore).unwrap();
    let stopped = runs::run(&case, "part", "keep", stop_after_two).unwrap_err();
    assert_eq!(stopped.name, "Interrupted");
    runs::report("part").unwrap();
    let kept: Vec<(String, Vec<u8>)> = names("part")
        .into_iter()
        .map(|name| format!("part/{name}"))
        .map(|name| (name.clone(), files::get(&name).unwrap()))
        .collect();
    files::remove("part");
    assert_eq!(names("part"), [""; 0]);
    for (name, bytes) in &kept {
        files::put(name, bytes).unwrap();
    }
    let summary = runs::run(&case, "part", "resume", ignore).unwrap();
    assert_eq!(summary["passes"].as_array().unwrap().len(), 5);
    assert_eq!(results("part"), results("whole"));
}

#[test]
fn a_contact_is_checked_run_and_shown() {
    let case = cases::example("hertz").unwrap();
    let checked = runs::check(&case).unwrap();
    assert!(checked["memory"].as_f64().unwrap() > 1e6 && checked["coarser"].is_null());
    assert_eq!(checked["rows"][0]["name"], "lower");
    let summary = runs::run(&case, "hertz/shown", "keep", ignore).unwrap();
    assert!(summary["static"]["max_pressure"].as_f64().unwrap() > 0.0, "{summary}");
    runs::report("hertz/shown").unwrap();
    let page = files::get("hertz/shown/report.html").unwrap();
    assert!(page.starts_with(b"<!doctype html>"));
    let figures = runs::figures("hertz/shown").unwrap();
    assert!(figures.as_array().unwrap().contains(&"pressure".into()), "{figures}");
    for (format, magic) in [("png", b"\x89PNG".as_slice()), ("svg", b"<"), ("pdf", b"%PDF")] {
        assert!(runs::figure("hertz/shown", "pressure", format).unwrap().starts_with(magic), "{format}");
        assert!(
            runs::figure("hertz/shown", "pressure", format).unwrap().starts_with(magic),
            "{format} again"
        );
    }
    assert_eq!(runs::run(&case, "hertz/shown", "keep", ignore).unwrap_err().name, "ResultsExist");
}

#[test]
fn a_case_that_is_too_large_gets_a_coarser_pitch() {
    let case = "[lower]\nmaterial = \"steel\"\n[lower.topography]\ngenerate = \"self-affine\"\nshape = [8192, 8192]\n\
                pitch = \"1 um\"\nsq = \"0.2 um\"\nhurst = 0.8\n[upper]\nmaterial = \"steel\"\n[upper.topography]\n\
                form = \"flat\"\n[contact]\nload = \"1 N\"\n";
    files::put("large.toml", case.as_bytes()).unwrap();
    let checked = runs::check("large.toml").unwrap();
    let coarser = &checked["coarser"];
    assert!(checked["memory"].as_f64().unwrap() > 1.5e9 && coarser["memory"].as_f64().unwrap() <= 1.5e9);
    assert!(coarser["pitch"][0].as_f64().unwrap() >= 2e-6);
}

#[test]
fn a_mistake_has_its_key_its_line_and_a_hint() {
    files::put("mistake.toml", b"[lower]\nmaterial = \"steal\"\n").unwrap();
    let Failure { key, place, hint, .. } = runs::check("mistake.toml").unwrap_err();
    assert_eq!((key.as_deref(), place), (Some("lower.material"), Some([2, 12])));
    assert!(hint.is_some());
    assert_eq!(cases::read_case("a = 1\nb = = 2\n").unwrap_err().place, Some([2, 5]));
}

#[test]
fn each_example_comes_back_from_its_tables() {
    for example in cases::examples().as_array().unwrap() {
        let case = cases::example(example["name"].as_str().unwrap()).unwrap();
        let text = String::from_utf8(files::get(&case).unwrap()).unwrap();
        let tables = cases::read_case(&text).unwrap();
        let written = cases::write_case(&tables.to_string()).unwrap();
        assert_eq!(cases::read_case(&written).unwrap(), tables, "{case}");
    }
}

#[test]
fn a_measured_surface_is_scanned_prepared_and_written() {
    cases::example("measured").unwrap();
    let scan = surfaces::scan("measured/disc.x3p", "").unwrap();
    assert_eq!((&scan["format"], &scan["unit_known"]), (&json!("x3p"), &json!(true)));
    assert!(scan["undefined"].as_u64().unwrap() > 0, "{scan}");
    let table = "file = \"measured/disc.x3p\"\nfill = \"harmonic\"\nlevel = \"plane\"";
    let surface = surfaces::Surface::new(table).unwrap();
    let about = surface.about().unwrap();
    assert_eq!(about["undefined"], 0);
    assert!(about["findings"][0].as_str().unwrap().ends_with("missing heights filled"), "{about}");
    let heights = &about["sections"][0];
    assert_eq!(
        (&heights["rows"][0]["name"], &heights["title"]),
        (&json!("Sa"), &json!("height parameters, ISO 25178-2"))
    );
    surface.write("prepared.x3p").unwrap();
    let again = surfaces::Surface::new("file = \"prepared.x3p\"").unwrap();
    assert_eq!(again.heights(), surface.heights());
    let wrong = surfaces::Surface::new("file = \"none.x3p\"").unwrap_err();
    assert_eq!(wrong.key.as_deref(), Some("file"));
}

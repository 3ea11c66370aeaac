//! The tables of the documents equal the output of the program.

use std::fs;
use std::path::{Path, PathBuf};

use asperity_base::Grid;
use asperity_contact::motion::Column;
use asperity_study::{Case, records as all_records};
use asperity_surface::{Axis, Form, Parameter};
use serde_json::Value;

use crate::support::{parsed, run};

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs").join(name)
}

fn document(name: &str) -> String {
    fs::read_to_string(path(name)).unwrap()
}

#[test]
fn every_roughness_parameter_stands_in_its_table() {
    let surface = Form::Flat.on(&Grid::new([9, 9], [1e-6; 2]).unwrap()).unwrap();
    let areal = surface.parameters().rows();
    let profile = surface.profile_parameters(Axis::X, 3e-6).unwrap().rows();
    let page = document("surfaces.md");
    let line = |row: &Parameter| {
        let meaning = row.meaning.replace('|', "\\|");
        format!("| {} | {meaning} | {} |", row.symbol, row.unit.symbol())
    };
    let missing: Vec<String> =
        areal.iter().chain(&profile).map(line).filter(|line| !page.contains(line.as_str())).collect();
    assert!(missing.is_empty(), "docs/surfaces.md lacks\n{}", missing.join("\n"));
}

/// A line of a document above a table of columns, with the names of the records between these parts.
const MARK: [&str; 2] = ["<!-- columns: ", " -->"];

/// With the environment variable `UPDATE` the tables are rewritten from the declarations.
#[test]
fn the_tables_of_columns_are_those_of_the_records() {
    let mut records: Vec<&str> = Vec::new();
    for name in ["results.md", "studies.md"] {
        let page = document(name);
        let of_records = with_tables(&page, &mut records);
        if std::env::var_os("UPDATE").is_some() {
            fs::write(path(name), &of_records).unwrap();
        } else if let Some((stands, stated)) =
            page.lines().zip(of_records.lines()).find(|(stands, stated)| stands != stated)
        {
            panic!("docs/{name} has\n{stands}\nthe records have\n{stated}\nUPDATE=1 writes all tables anew");
        }
        assert_eq!(page.matches("| unit | content |").count(), page.matches(MARK[0]).count(), "docs/{name}");
    }
    records.sort_unstable();
    let mut declared: Vec<_> = all_records().iter().copied().map(|(record, _)| record).collect();
    declared.sort_unstable();
    assert_eq!(records, declared, "each record has one table");
}

/// Returns a document with the tables of the records that it names; adds their names to `records`.
fn with_tables(page: &str, records: &mut Vec<&'static str>) -> String {
    let mut text = String::new();
    let mut lines = page.lines().peekable();
    while let Some(line) = lines.next() {
        text += &format!("{line}\n");
        let Some(names) = line.strip_prefix(MARK[0]).and_then(|rest| rest.strip_suffix(MARK[1])) else {
            continue;
        };
        // The header stays.
        for head in lines.by_ref().take(2) {
            text += &format!("{head}\n");
        }
        while lines.next_if(|line| line.starts_with('|')).is_some() {}
        for name in names.split(", ") {
            let known = all_records().iter().copied().find(|(record, _)| *record == name);
            let (record, columns) = known.unwrap_or_else(|| panic!("no record `{name}`"));
            records.push(record);
            for Column { name, unit, text: meaning, .. } in columns {
                let unit = if *unit == "1" { "" } else { unit };
                text += &format!("| `{name}` | {unit} | {meaning} |\n").replace("|  |", "| |");
            }
        }
    }
    text
}

#[test]
fn every_key_of_a_summary_is_explained() {
    let page = document("results.md");
    let mut names = Vec::new();
    let ball = r#"
        lower = { young = 210e9, poisson = 0.3, topography = { form = "flat", shape = [16, 16], pitch = 1e-6 } }
        upper = { young = 210e9, poisson = 0.3, topography = { form = "sphere", radius = 1e-3 } }
        contact = { load = 0.02 }
        friction = { coefficient = 0.3, creepage = [2e-4, 0.0] }
        subsurface = { to = 5e-6, layers = 3 }
    "#;
    for case in [ball.to_owned(), ball.replace("creepage = [2e-4, 0.0]", "force = [1e-3, 0.0]")] {
        let folder = tempfile::tempdir().unwrap();
        run(&parsed(&case), folder.path());
        let text = fs::read(folder.path().join("summary.json")).unwrap();
        keys(&serde_json::from_slice(&text).unwrap(), &mut names);
    }
    let missing: Vec<_> = names.iter().filter(|name| !page.contains(&format!("`{name}`"))).collect();
    assert!(missing.is_empty(), "docs/results.md explains none of {missing:?}");
}

#[test]
fn the_cases_of_the_gallery_are_valid() {
    let files = fs::read_dir(path("gallery")).unwrap().map(|entry| entry.unwrap().path());
    let cases = files.filter(|file| file.extension().is_some_and(|end| end == "toml"));
    let loaded =
        cases.map(|file| Case::load(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display())));
    assert!(loaded.count() > 0);
}

/// Collects the keys of an object and of nested objects, without the case.
fn keys(value: &Value, names: &mut Vec<String>) {
    match value {
        Value::Object(object) => {
            for (key, value) in object {
                names.push(key.clone());
                if key != "case" {
                    keys(value, names);
                }
            }
        }
        Value::Array(items) => items.iter().for_each(|item| keys(item, names)),
        _ => {}
    }
}

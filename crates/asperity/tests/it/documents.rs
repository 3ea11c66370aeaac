//! The tables of the documents hold what the program prints.

use std::fs;
use std::path::Path;

use asperity::Grid;
use asperity::study;
use asperity::study::Case;
use asperity::study::Existing;
use asperity::study::{INCREMENT_COLUMNS, PASS_COLUMNS, STEP_COLUMNS, SWEEP_COLUMNS};
use asperity::surface::{Axis, Form, Parameter};
use serde_json::Value;

fn document(name: &str) -> String {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    fs::read_to_string(docs.join(name)).unwrap()
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

#[test]
fn every_column_and_every_key_of_the_results_is_explained() {
    let page = document("results.md");
    let mut names: Vec<String> = [&STEP_COLUMNS[..], &PASS_COLUMNS, &INCREMENT_COLUMNS, &SWEEP_COLUMNS]
        .iter()
        .flat_map(|columns| columns.iter().map(|column| (*column).to_owned()))
        .collect();
    let ball = r#"
        lower = { young = 210e9, poisson = 0.3, topography = { form = "flat", shape = [16, 16], pitch = 1e-6 } }
        upper = { young = 210e9, poisson = 0.3, topography = { form = "sphere", radius = 1e-3 } }
        contact = { load = 0.02 }
        friction = { coefficient = 0.3, creepage = [2e-4, 0.0] }
        subsurface = { to = 5e-6, layers = 3 }
    "#;
    for case in [ball.to_owned(), ball.replace("creepage = [2e-4, 0.0]", "force = [1e-3, 0.0]")] {
        let folder = tempfile::tempdir().unwrap();
        let case = Case::parse(&case, Path::new("case.toml"), folder.path()).unwrap();
        study::run(&case, asperity::study::Given::default(), &folder.path().join("out"), Existing::Keep, &())
            .unwrap();
        let text = fs::read(folder.path().join("out/summary.json")).unwrap();
        keys(&serde_json::from_slice(&text).unwrap(), &mut names);
    }
    let missing: Vec<_> = names.iter().filter(|name| !page.contains(&format!("`{name}`"))).collect();
    assert!(missing.is_empty(), "docs/results.md explains none of {missing:?}");
}

/// The keys of an object and of those within it, but for the case.
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

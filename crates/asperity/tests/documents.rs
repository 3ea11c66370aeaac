//! The tables of the documents hold what the program prints.

use std::fs;
use std::path::Path;

use asperity::Grid;
use asperity::surface::{Axis, Form, Parameter};

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

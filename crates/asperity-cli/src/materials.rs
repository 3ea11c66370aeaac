//! `asperity materials`.

use std::fmt::Write as _;

use asperity::material::{MATERIALS, NamedMaterial};
use asperity::units::{self, Dimension, format_number};

use crate::args::Materials;
use crate::report::{Outcome, print};

pub(crate) fn materials(arguments: &Materials) -> Outcome {
    let named =
        |material: &&NamedMaterial| arguments.name.as_deref().is_none_or(|name| material.name == name);
    let shown: Vec<&NamedMaterial> = MATERIALS.iter().filter(named).collect();
    if arguments.json {
        return print(&format!("{:#}\n", serde_json::json!(shown)));
    }
    print(&match (&arguments.name, &shown[..]) {
        (Some(_), [material]) => one(material),
        _ => table(&shown),
    })
}

/// The heads of the table, with the width of each column.
const HEADS: [(&str, usize); 8] = [
    ("", 16),
    ("young", 10),
    ("poisson", 8),
    ("hardness", 9),
    ("conductivity", 13),
    ("heat capacity", 14),
    ("density", 11),
    ("resistivity", 13),
];

fn table(materials: &[&NamedMaterial]) -> String {
    let mut text = String::new();
    let mut row = |cells: [String; 8]| {
        let line: String = cells
            .iter()
            .zip(HEADS)
            .enumerate()
            .map(|(column, (cell, (_, width)))| match column {
                0 => format!("{cell:<width$}"),
                _ => format!("{cell:>width$}"),
            })
            .collect();
        let _ = writeln!(text, "{}", line.trim_end());
    };
    row(HEADS.map(|(head, _)| head.to_owned()));
    row(["", "GPa", "", "GPa", "W/(m K)", "J/(kg K)", "kg/m³", "nΩ m"].map(str::to_owned));
    for material in materials {
        let scaled = |value: Option<f64>, factor: f64| {
            value.map_or_else(|| "–".to_owned(), |value| format_number(value * factor))
        };
        row([
            material.name.to_owned(),
            scaled(Some(material.young), 1e-9),
            format_number(material.poisson),
            scaled(material.hardness, 1e-9),
            scaled(material.conductivity, 1.0),
            scaled(material.heat_capacity, 1.0),
            scaled(material.density, 1.0),
            scaled(material.resistivity, 1e9),
        ]);
    }
    text + "\nAt room temperature. `asperity materials NAME` prints the grade and the source.\n"
}

fn one(material: &NamedMaterial) -> String {
    let mut text = format!("{}: {}\n\n", material.name, material.about);
    let quantity = |value: Option<f64>, dimension| value.map(|value: f64| units::format(value, dimension));
    for (name, value) in [
        ("young", quantity(Some(material.young), Dimension::Pressure)),
        ("poisson", Some(format_number(material.poisson))),
        ("hardness", quantity(material.hardness, Dimension::Pressure)),
        ("conductivity", quantity(material.conductivity, Dimension::Conductivity)),
        ("heat_capacity", quantity(material.heat_capacity, Dimension::HeatCapacity)),
        ("density", quantity(material.density, Dimension::Density)),
        ("resistivity", quantity(material.resistivity, Dimension::Resistivity)),
        ("source", Some(material.source.to_owned())),
    ] {
        if let Some(value) = value {
            let _ = writeln!(text, "{name:<14} {value}");
        }
    }
    text
}

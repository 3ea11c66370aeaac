//! `asperity materials`.

use std::fmt::Write as _;

use asperity::Choice as _;
use asperity::lubrication::{NamedOil, OILS};
use asperity::material::{MATERIALS, NamedMaterial};
use asperity::units::{self, CELSIUS, Dimension, format_number};
use serde_json::{Value, json};

use crate::args::Materials;
use crate::report::{Outcome, print};

pub(crate) fn materials(arguments: &Materials) -> Outcome {
    let is_named = |name: &str| arguments.name.as_deref().is_none_or(|named| named == name);
    let solids: Vec<&NamedMaterial> = MATERIALS.iter().filter(|material| is_named(material.name)).collect();
    let oils: Vec<&NamedOil> = OILS.iter().filter(|oil| is_named(oil.name)).collect();
    if arguments.json {
        let solids = solids.iter().map(|material| json!(material));
        let all: Vec<Value> = solids.chain(oils.iter().map(|oil| json!(oil))).collect();
        return print(&format!("{:#}\n", json!(all)));
    }
    print(&match (&arguments.name, &solids[..], &oils[..]) {
        (Some(_), [material], _) => one(material),
        (Some(_), _, [oil]) => one_oil(oil),
        _ => tables(&solids, &oils),
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

/// The heads of the table of lubricants, with the width of each column.
const OIL_HEADS: [(&str, usize); 5] =
    [("", 16), ("40 °C", 10), ("100 °C", 9), ("pressure-viscosity", 20), ("density", 9)];

fn tables(materials: &[&NamedMaterial], oils: &[&NamedOil]) -> String {
    let mut text = String::new();
    let mut row = |cells| write_row(&mut text, HEADS, cells);
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
    text += "\nLubricants\n";
    let mut row = |cells| write_row(&mut text, OIL_HEADS, cells);
    row(OIL_HEADS.map(|(head, _)| head.to_owned()));
    row(["", "mPa s", "mPa s", "1/GPa", "kg/m³"].map(str::to_owned));
    for oil in oils {
        let [warm, hot] = oil.viscosity.map(|viscosity| format_number(1e3 * viscosity));
        let coefficient = format_number(1e9 * oil.pressure_viscosity);
        row([oil.name.to_owned(), warm, hot, coefficient, format_number(oil.density)]);
    }
    text + "\nMaterials at room temperature. Pressure-viscosity coefficients at 40 °C, densities of lubricants at 15 °C.\n\
            `asperity materials NAME` prints the grade and the source.\n"
}

/// Appends a row of a table: the first column to the left, the others to the right.
fn write_row<const N: usize>(text: &mut String, heads: [(&str, usize); N], cells: [String; N]) {
    let mut line = String::new();
    for (column, (cell, (_, width))) in cells.iter().zip(heads).enumerate() {
        let _ = if column == 0 { write!(line, "{cell:<width$}") } else { write!(line, "{cell:>width$}") };
    }
    let _ = writeln!(text, "{}", line.trim_end());
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

fn one_oil(oil: &NamedOil) -> String {
    let viscosity = |node: usize| units::format(oil.viscosity[node], Dimension::Viscosity);
    let [least, most] = oil.temperatures.map(|kelvin| format_number(kelvin - CELSIUS));
    let mut text = format!("{}: {}\n\n", oil.name, oil.about);
    for (name, value) in [
        ("viscosity", format!("{} at 40 °C, {} at 100 °C", viscosity(0), viscosity(1))),
        ("pressure_viscosity", format!("{} 1/GPa at 40 °C", format_number(1e9 * oil.pressure_viscosity))),
        ("law", oil.law.word().to_owned()),
        ("density", format!("{} at 15 °C", units::format(oil.density, Dimension::Density))),
        ("temperature", format!("{least} °C … {most} °C")),
        ("source", oil.source.to_owned()),
    ] {
        let _ = writeln!(text, "{name:<18} {value}");
    }
    text
}

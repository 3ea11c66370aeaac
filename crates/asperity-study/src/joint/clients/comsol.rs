//! COMSOL Multiphysics: interpolation functions from files, argument before value.

use std::fmt::Write as _;

use super::{Sheet, number};

/// Pressure over closure.
pub(super) fn pressure(sheet: &Sheet<'_>) -> String {
    let head = sheet.head("%", &[
        "Interpolation function of the closure: closure, pressure. Extrapolation: linear",
        "In Contact, Penalty: the pressure is this function of the negative gap; give argument and function their units",
    ]);
    rows(head, sheet.closure.iter().map(|[p, c]| [*c, *p]))
}

/// Conductance over pressure.
pub(super) fn conductance(sheet: &Sheet<'_>) -> String {
    let head = sheet.head(
        "%",
        &[
            "Interpolation function of the contact pressure: pressure, conductance. Extrapolation: linear",
            "In Thermal Contact: constriction conductance, user defined, as this function of solid.Tn",
        ],
    );
    rows(head, sheet.conductance.iter().copied())
}

fn rows(mut text: String, rows: impl Iterator<Item = [f64; 2]>) -> String {
    for [argument, value] in rows {
        let _ = writeln!(text, "{} {}", number(argument), number(value));
    }
    text
}

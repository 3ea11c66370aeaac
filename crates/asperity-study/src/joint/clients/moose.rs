//! MOOSE: functions of the closure and of the pressure, for materials that its user writes.

use std::fmt::Write as _;

use super::{Sheet, number};

/// Functions of the closure and of the pressure.
pub(super) fn functions(sheet: &Sheet<'_>) -> String {
    let mut text = sheet.head("#", &[
        "PiecewiseLinear keeps its first and last value outside the table",
        "GapFluxModelPressureDependentConduction is linear in the pressure, and this law is not: take joint_conductance in a",
        "material of your own",
    ]);
    text += "[Functions]\n";
    let closure: Vec<[f64; 2]> = sheet.closure.iter().map(|[p, c]| [*c, *p]).collect();
    function(&mut text, "joint_pressure", "pressure over closure", &closure);
    if !sheet.conductance.is_empty() {
        function(&mut text, "joint_conductance", "conductance over pressure", &sheet.conductance);
    }
    text + "[]\n"
}

fn function(text: &mut String, name: &str, about: &str, rows: &[[f64; 2]]) {
    let list = |n: usize| rows.iter().map(|row| number(row[n])).collect::<Vec<_>>().join(" ");
    let _ = writeln!(
        text,
        "  [{name}]\n    # {about}\n    type = PiecewiseLinear\n    x = '{}'\n    y = '{}'\n  []",
        list(0),
        list(1)
    );
}

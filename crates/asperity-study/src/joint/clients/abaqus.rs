//! Abaqus: an interaction of surfaces with a table.

use std::fmt::Write as _;

use super::{Sheet, number};

/// The joint, with its conductance where it is known.
pub(super) fn interaction(sheet: &Sheet<'_>) -> String {
    let mut text = sheet.head(
        "**",
        &[
            "Beyond the last line Abaqus goes on with the last slope; the conductance stays constant",
            "*GAP CONDUCTANCE is over the pressure: without the word PRESSURE it would be over the clearance",
        ],
    );
    text += "*SURFACE INTERACTION, NAME=JOINT\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR\n";
    for [pressure, closure] in &sheet.closure {
        let _ = writeln!(text, "{}, {}", number(*pressure), number(*closure));
    }
    if let (Some(friction), Some([pressure, stiffness])) =
        (sheet.settings.friction, sheet.tangential_stiffness())
    {
        // In stick the stiffness is μ p/γ, in proportion to the pressure, as that of a joint is.
        let slip = friction * pressure / stiffness;
        let _ = writeln!(text, "*FRICTION, ELASTIC SLIP={}\n{},", number(slip), number(friction));
    }
    if !sheet.conductance.is_empty() {
        text += "*GAP CONDUCTANCE, PRESSURE\n";
        for [pressure, conductance] in &sheet.conductance {
            let _ = writeln!(text, "{}, {}", number(*conductance), number(*pressure));
        }
    }
    text
}

//! Ansys Mechanical APDL: tables for the real constants of contact elements.

use std::fmt::Write as _;

use super::{Sheet, number};

/// Tables of the secant stiffness and of the conductance over the pressure.
pub(super) fn tables(sheet: &Sheet<'_>) -> String {
    let mut text = sheet.head("!", &[
        "For CONTA174 with the real constant set CID: RMODIF,CID,3,%JOINT_FKN% and RMODIF,CID,14,%JOINT_TCC%",
        "FKN is a stiffness of an area (KEYOPT(2)=1, penalty): pressure over closure, a secant over the contact pressure",
        "Outside a table Ansys keeps its first or last value",
    ]);
    let secants: Vec<[f64; 2]> = sheet.closure.iter().skip(1).map(|[p, c]| [*p, p / c]).collect();
    table(&mut text, "JOINT_FKN", &secants);
    if !sheet.conductance.is_empty() {
        table(&mut text, "JOINT_TCC", &sheet.conductance);
    }
    if let Some([_, stiffness]) = sheet.tangential_stiffness() {
        let _ = writeln!(
            text,
            "! Tangential stiffness of an area in the middle of the range, for FKT\nJOINT_FKT={}",
            number(stiffness)
        );
    }
    text
}

fn table(text: &mut String, name: &str, rows: &[[f64; 2]]) {
    let _ = writeln!(text, "*DIM,{name},TABLE,{},1,1,PRESSURE", rows.len());
    for (n, [argument, value]) in rows.iter().enumerate() {
        let _ =
            writeln!(text, "{name}({0},0)={1}\n{name}({0},1)={2}", n + 1, number(*argument), number(*value));
    }
}

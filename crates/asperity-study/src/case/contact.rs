//! `[contact]`: the load of the bodies, and the solver of the contact.

use super::Contact;
use super::cursor::Table;
use super::prescribed::{prescribed, sweep};
use super::schema::loading::contact as keys;
use super::schema::tables::known_in;
use asperity_base::error::Result;

pub(super) fn contact(table: &Table<'_>) -> Result<Contact> {
    known_in(table)?;
    const PRESCRIBED: [&str; 6] =
        ["load", "mean_pressure", "approach", "loads", "mean_pressures", "approaches"];
    table.exactly_one(&PRESCRIBED, "for example `load = \"2 N\"`")?;
    let sweep = sweep(table)?;
    Ok(Contact {
        prescribed: match sweep.iter().max_by(|a, b| a.value().total_cmp(&b.value())) {
            Some(largest) => *largest,
            None => prescribed(table)?,
        },
        sweep,
        boundary: keys::BOUNDARY.of(table)?,
        grid: keys::GRID.of(table)?,
        method: keys::METHOD.of(table)?,
        device: keys::DEVICE.of(table)?,
        tolerance: keys::TOLERANCE.of(table)?,
    })
}

//! `[output]`: output options.

use super::Output;
use super::cursor::Table;
use super::schema::results::output as keys;
use super::schema::tables::known_in;
use asperity_base::error::Result;

pub(super) fn output(root: &Table<'_>) -> Result<Output> {
    let Some(table) = super::schema::root::OUTPUT.of(root)? else {
        return Ok(Output {
            pressure_every: keys::PRESSURE_EVERY.default(),
            rim: keys::RIM.default(),
            paraview: keys::PARAVIEW.default(),
        });
    };
    known_in(&table)?;
    Ok(Output {
        pressure_every: keys::PRESSURE_EVERY.of(&table)?,
        rim: keys::RIM.of(&table)?,
        paraview: keys::PARAVIEW.of(&table)?,
    })
}

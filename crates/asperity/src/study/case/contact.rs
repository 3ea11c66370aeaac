//! `[contact]`: what presses the bodies together, and how the contact is solved.

use super::cursor::{Entry, Table};
use super::prescribed::prescribed;
use super::schema::loading::contact as keys;
use super::schema::tables::known_in;
use super::sweep::{Sweep, sweep};
use super::{Boundary, Contact, Edge};
use crate::error::Result;

pub(super) fn contact(table: &Table<'_>) -> Result<Contact> {
    known_in(table)?;
    const PRESCRIBED: [&str; 6] =
        ["load", "mean_pressure", "approach", "loads", "mean_pressures", "approaches"];
    table.exactly_one(&PRESCRIBED, "for example `load = \"2 N\"` and no other of them")?;
    let sweep = sweep(table)?;
    Ok(Contact {
        prescribed: sweep.as_ref().map(Sweep::largest).map_or_else(|| prescribed(table), Ok)?,
        sweep,
        boundary: keys::BOUNDARY.of(table)?,
        method: keys::METHOD.of(table)?,
        tolerance: keys::TOLERANCE.of(table)?,
    })
}

/// A word for both axes, or one for each.
pub(super) fn boundary(entry: &Entry<'_>) -> Result<Boundary> {
    const EXPECTED: &str = "\"free\", \"periodic\", or one of them for x and one for y";
    Ok(Boundary(entry.pair(EXPECTED, |word| word.choice::<Edge>())?))
}

/// A direction in the plane, as a unit vector.
pub(super) fn direction(entry: &Entry<'_>) -> Result<[f64; 2]> {
    const EXPECTED: &str = "a direction such as [1, 0]";
    let [x, y] = entry.vector(EXPECTED, |item| item.number(f64::is_finite, "a finite number"))?;
    let length = x.hypot(y);
    if length == 0.0 { Err(entry.unexpected(EXPECTED, None)) } else { Ok([x / length, y / length]) }
}

//! CSV: a table of x, y and heights, or of x and heights, below a line of names; read only.
//!
//! The names of the first two columns begin with x and y, or the table is a profile, whose first column
//! begins with x or is a distance or position. Each further column is a channel. A name may end with a unit
//! of length, as in `x [µm]` or `height (nm)`; without one it is m. x and y form a regular grid, in any
//! order, and missing points are missing heights. Separators and other rules for text are described in
//! [`text`](super::text). A line of names below other words is found by [`preamble`](super::preamble).

use super::numbers::{Part, Separator, fields, matrix, value};
use super::points::{Raster, profile, raster};
use super::words::{excerpt, unit_of_length};
use super::{Decoded, Fault, LengthUnit, Scan, choose, distinct, usable_pitch};
use asperity_base::error::Defect;

/// Decodes the heights, if the content begins with such a line of three names or more.
pub(super) fn decode(part: Part<'_>, channel: Option<&str>) -> Option<Decoded> {
    let mut names: Vec<_> = fields(part.text.lines().next()?).collect();
    while names.len() > 2 && names.last() == Some(&"") {
        names.pop();
    }
    let are_names = names.len() > 2 && are_positions(&names) && names.iter().all(|name| !is_number(name));
    are_names.then(|| table(&names, part.skip(1), channel))
}

fn is_number(name: &str) -> bool {
    value(name, Separator::Space).is_some()
}

/// Whether names of columns begin with those of positions.
pub(super) fn are_positions(names: &[&str]) -> bool {
    positions(names).is_some()
}

/// Returns the number of columns of positions.
fn positions(names: &[&str]) -> Option<usize> {
    let begins_with = |name: &str, starts: &[&str]| {
        let name = name.to_lowercase();
        starts.iter().any(|start| name.starts_with(start))
    };
    match names {
        [x, _] => begins_with(x, &["x", "distance", "position"]).then_some(1),
        [x, y, _, ..] if begins_with(x, &["x"]) && begins_with(y, &["y"]) => Some(2),
        [x, z, _, ..] if begins_with(x, &["x"]) && begins_with(z, &["z", "height"]) => Some(1),
        _ => None,
    }
}

/// Decodes the numbers below names of positions.
pub(super) fn table(names: &[&str], numbers: Part<'_>, channel: Option<&str>) -> Decoded {
    let fault = |defect| Fault::defect("csv", defect);
    let columns: Vec<_> = names.iter().map(|name| name_and_unit(name)).collect();
    let positions = positions(names).expect("names of positions");
    let channels = distinct(columns[positions..].iter().map(|(name, _)| (*name).to_owned()));
    let column = positions + choose(&channels, channel)?;
    let table = matrix(numbers, false).map_err(fault)?;
    if table.ncols() != names.len() {
        let line = numbers.before + 1;
        return Err(fault(Defect::Ragged { line, expected: names.len(), found: table.ncols() }));
    }
    let unit = |column: usize| columns[column].1.map_or(Ok(1.0), unit_of_length).map_err(fault);
    let (x, y, z) = (unit(0)?, unit(positions - 1)?, unit(column)?);
    let found = if positions == 1 { profile(&table, column) } else { raster(&table, column) };
    let Raster { pitch, heights } = found.ok_or_else(|| {
        fault(match positions {
            1 => Defect::Value {
                what: "x",
                found: excerpt(names[0]),
                expected: "at least 3 evenly spaced positions, each once",
            },
            _ => {
                let (count, columns) = table.dim();
                let what = "points x, y and height on no grid";
                let expected = "a regular grid of at least 2 × 2 points, most of them there, each once";
                Defect::Points { count, columns, what, expected, named: true }
            }
        })
    })?;
    let pitch = usable_pitch([pitch[0] * x, pitch[1] * y]);
    let unit = match [columns[0].1, columns[positions - 1].1, columns[column].1] {
        [_, _, Some(_)] => LengthUnit::Known,
        [None, None, None] => LengthUnit::MetresThroughout,
        [_, _, None] => LengthUnit::Metres,
    };
    let (channel, heights) = (channels[column - positions].clone(), heights * z);
    Ok(Scan { format: "csv", channel, channels, pitch, heights, unit, lines: None })
}

/// Splits a name from its unit: `height (nm)` is a height in nm.
fn name_and_unit(name: &str) -> (&str, Option<&str>) {
    match name.trim_end_matches([')', ']']).split_once(['(', '[']) {
        Some((name, unit)) => (name.trim(), Some(unit.trim())),
        None => (name, None),
    }
}

//! CSV: a table of x, y and heights below a line of names; read only.
//!
//! The names of the first two columns begin with x and y. Each further column is a channel. A name may end with a unit of
//! length, as in `x [µm]` or `height (nm)`; without one it is m. x and y form a regular grid, in any order, and missing
//! points are missing heights. A table of x and one more column is a line scan, which is rejected. Separators and other
//! rules for text are described in [`text`](super::text).

use super::points::{Raster, raster};
use super::text::matrix;
use super::words::{excerpt, unit_of_length};
use super::{Decoded, Fault, LengthUnit, Scan, choose, distinct, usable_pitch};
use crate::error::Defect;

/// Decodes the heights, if the content begins with such a line of names.
pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Option<Decoded> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let end = bytes.iter().position(|byte| *byte == b'\n')?;
    let line = std::str::from_utf8(&bytes[..end]).ok()?;
    let names: Vec<_> = match [';', '\t', ','].into_iter().find(|separator| line.contains(*separator)) {
        Some(separator) => line.split(separator).map(str::trim).collect(),
        None => line.split_whitespace().collect(),
    };
    let begins_with = |name: &str, letter| name.to_ascii_lowercase().starts_with(letter);
    if let [x, z] = names[..] {
        return begins_with(x, 'x').then(|| Err(Fault::defect("csv", line_scan(x, z))));
    }
    let [x, y, _, ..] = names[..] else { return None };
    (begins_with(x, 'x') && begins_with(y, 'y')).then(|| table(&names, &bytes[end + 1..], channel))
}

fn table(names: &[&str], lines: &[u8], channel: Option<&str>) -> Decoded {
    let fault = |defect| Fault::defect("csv", defect);
    let columns: Vec<_> = names.iter().map(|name| name_and_unit(name)).collect();
    let channels = distinct(columns[2..].iter().map(|(name, _)| (*name).to_owned()));
    let column = 2 + choose(&channels, channel)?;
    let table = matrix(lines, 1).map_err(fault)?;
    if table.ncols() != names.len() {
        return Err(fault(Defect::Ragged { line: 2, expected: names.len(), found: table.ncols() }));
    }
    let [x, y, z] = [0, 1, column].map(|column| columns[column].1.map_or(Ok(1.0), unit_of_length));
    let (x, y, z) = (x.map_err(fault)?, y.map_err(fault)?, z.map_err(fault)?);
    let Raster { pitch, heights } = raster(&table, column).ok_or_else(|| {
        let found = excerpt(&names[..2].join(", "));
        let expected = "a regular grid of at least 2 × 2 points, most of them there, each once";
        fault(Defect::Value { what: "x and y", found, expected })
    })?;
    let pitch = usable_pitch([pitch[0] * x, pitch[1] * y]);
    let unit = match [columns[0].1, columns[1].1, columns[column].1] {
        [_, _, Some(_)] => LengthUnit::Known,
        [None, None, None] => LengthUnit::MetresThroughout,
        [_, _, None] => LengthUnit::Metres,
    };
    let (channel, heights) = (channels[column - 2].clone(), heights * z);
    Ok(Scan { format: "csv", channel, channels, pitch, heights, unit })
}

fn line_scan(x: &str, z: &str) -> Defect {
    let found = excerpt(&format!("a line scan of {x}, {z}"));
    Defect::Value { what: "the table", found, expected: "a map: x, y and heights" }
}

/// Splits a name from its unit: `height (nm)` is a height in nm.
fn name_and_unit(name: &str) -> (&str, Option<&str>) {
    match name.trim_end_matches([')', ']']).split_once(['(', '[']) {
        Some((name, unit)) => (name.trim(), Some(unit.trim())),
        None => (name, None),
    }
}

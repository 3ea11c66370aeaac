//! ASC: ASCII grid of ESRI; read only.
//!
//! Format: "Esri ASCII raster format" in the documentation of ArcGIS. Lines of a name and a number, in any
//! case and order: `ncols`, `nrows`, the corner or the centre of the first cell, `cellsize` (or `dx` and
//! `dy`, as GDAL writes them), and `NODATA_value`, which is −9999 if it is absent. Then come the heights in
//! any number of lines, x fastest, the first at the largest y. There is no unit.

use super::binary::shape;
use super::numbers::{Separator, value};
use super::words::excerpt;
use super::{Decoded, Fault, LengthUnit, Scan, from_last_y_to_first, only_channel, usable_pitch, x_fastest};
use asperity_base::error::Defect;
use asperity_base::grid::Field;

/// Names in the header.
const NAMES: [&str; 10] = [
    "ncols",
    "nrows",
    "xllcorner",
    "xllcenter",
    "yllcorner",
    "yllcenter",
    "cellsize",
    "dx",
    "dy",
    "nodata_value",
];

/// Decodes the heights, if the content begins with the number of columns or rows.
pub(super) fn decode(text: &str, channel: Option<&str>) -> Option<Decoded> {
    let start = text.get(..5)?.to_ascii_lowercase();
    if !["ncols", "nrows"].contains(&&start[..]) {
        return None;
    }
    let scan = |(pitch, heights)| {
        let channels = only_channel(channel)?;
        let channel = channels[0].clone();
        let (pitch, unit) = (usable_pitch(pitch), LengthUnit::MetresThroughout);
        Ok(Scan { format: "asc", channel, channels, pitch, heights, unit, lines: None })
    };
    Some(read(text).map_err(|defect| Fault::defect("asc", defect)).and_then(scan))
}

fn read(text: &str) -> Result<([f64; 2], Field), Defect> {
    let mut values = [None; NAMES.len()];
    let mut rest = text;
    loop {
        let (line, next) = rest.split_once('\n').unwrap_or((rest, ""));
        let mut words = line.split_whitespace();
        let name = words.next().unwrap_or_default().to_ascii_lowercase();
        if let Some(index) = NAMES.iter().position(|known| *known == name) {
            let found = words.next().unwrap_or_default();
            let number = value(found, Separator::Space).filter(|_| !found.is_empty());
            let unusable =
                || Defect::Value { what: NAMES[index], found: excerpt(found), expected: "a number" };
            values[index] = Some(number.ok_or_else(unusable)?);
        } else if !name.is_empty() {
            break;
        }
        if next.is_empty() {
            break;
        }
        rest = next;
    }
    let get = |name: &str| NAMES.iter().position(|known| *known == name).and_then(|index| values[index]);
    let size = |name: &'static str| {
        let found = get(name).ok_or(Defect::Missing(name))?;
        let whole = found.fract() == 0.0 && (1.0..=f64::from(u32::MAX)).contains(&found);
        let expected = "a whole number above 0";
        if whole {
            Ok(found as u32)
        } else {
            Err(Defect::Value { what: name, found: found.to_string(), expected })
        }
    };
    let shape = shape([size("ncols")?, size("nrows")?])?;
    let pitch = match (get("cellsize"), get("dx"), get("dy")) {
        (Some(size), ..) => [size; 2],
        (None, Some(x), Some(y)) => [x, y],
        _ => return Err(Defect::Missing("cellsize")),
    };
    let missing = get("nodata_value").unwrap_or(-9999.0);
    let cells = shape[0] * shape[1];
    // A height has a character and a separator, except behind the last.
    let (least, found) = (2 * cells as u64 - 1, rest.len() as u64);
    if found < least {
        return Err(Defect::Length { what: "the part of the heights", expected: least, found });
    }
    let mut heights = Vec::with_capacity(cells);
    let before = text[..text.len() - rest.len()].matches('\n').count();
    for (index, line) in rest.lines().enumerate() {
        for token in line.split_whitespace() {
            let height = value(token, Separator::Space)
                .ok_or_else(|| Defect::NotANumber { line: before + index + 1, token: excerpt(token) })?;
            heights.push(if height == missing { f64::NAN } else { height });
        }
    }
    if heights.len() != cells {
        let found = format!("{}", heights.len());
        return Err(Defect::Value { what: "the number of heights", found, expected: "ncols · nrows" });
    }
    let mut field = x_fastest(shape, |first, part| part.copy_from_slice(&heights[first..][..part.len()]));
    from_last_y_to_first(&mut field);
    Ok((pitch, field))
}

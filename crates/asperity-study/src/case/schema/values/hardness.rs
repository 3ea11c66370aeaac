//! The hardness of a body.

use std::path::PathBuf;

use super::super::hardness::{given, map as keys};
use crate::case::cursor::Entry;
use crate::case::{Hardness, HardnessInput, HardnessMap};
use asperity_base::error::Result;
use asperity_base::units::Dimension;

/// Reads one pressure, or a table that names a map.
pub(in crate::case) fn hardness(entry: &Entry<'_>) -> Result<Hardness> {
    if !entry.is_table() {
        let infinite = "an elastic body, as is leaving it out";
        return entry.positive_or_infinite(Dimension::Pressure, infinite).map(Hardness::Uniform);
    }
    let map = entry.clone().table()?;
    if given::GIVEN.entry(&map).is_some() {
        map.known(&["given"], |_| None)?;
        return Ok(Hardness::Given(HardnessInput { name: given::GIVEN.of(&map)? }));
    }
    map.known(&["file", "channel", "unit", "lines", "skip"], |_| None)?;
    let path = match keys::FILE.of(&map)?.as_str() {
        "" => return Err(keys::FILE.demand(&map)?.unexpected("the name of a file", None)),
        path => PathBuf::from(path),
    };
    Ok(Hardness::Map(HardnessMap {
        path,
        channel: keys::CHANNEL.of(&map)?,
        unit: keys::UNIT.of(&map)?,
        lines: keys::LINES.of(&map)?,
        skip: keys::SKIP.of(&map)?,
    }))
}

//! The range of an attraction.

use crate::error::Result;
use crate::study::case::AdhesionRange;
use crate::study::case::cursor::Entry;
use crate::units::Dimension;

/// Reads a length above 0, or the word for the shortest range that the grid resolves.
pub(in crate::study::case) fn range(entry: &Entry<'_>) -> Result<AdhesionRange> {
    match entry.text() {
        Ok("grid") => Ok(AdhesionRange::Grid),
        _ => entry.positive(Dimension::Length).map(AdhesionRange::Length),
    }
}

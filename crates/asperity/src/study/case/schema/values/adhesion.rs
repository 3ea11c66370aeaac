//! The range of an attraction.

use crate::error::Result;
use crate::study::case::AdhesionRange;
use crate::study::case::cursor::{Entry, did_you_mean};
use crate::units::Dimension;

/// The word for the shortest range that the grid resolves.
const GRID: &str = "grid";

/// Reads a length above 0, or the word for the shortest range that the grid resolves.
pub(in crate::study::case) fn range(entry: &Entry<'_>) -> Result<AdhesionRange> {
    match entry.text() {
        Ok(GRID) => Ok(AdhesionRange::Grid),
        // No word is a length.
        Ok(word) if !word.contains(|c: char| c.is_ascii_digit()) => {
            let hint = did_you_mean(word, [GRID].into_iter());
            Err(entry.unexpected("a length above 0 such as \"2 nm\", or \"grid\"", hint))
        }
        _ => entry.positive(Dimension::Length).map(AdhesionRange::Length),
    }
}

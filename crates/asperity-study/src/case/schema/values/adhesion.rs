//! The range of an attraction.

use serde::{Serialize, Serializer};

use crate::case::cursor::{Entry, did_you_mean};
use asperity_base::error::Result;
use asperity_base::units::{Dimension, Metre};

/// Range of the attraction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AdhesionRange {
    /// A length, > 0.
    Length(Metre),
    /// The shortest range that the grid resolves.
    Grid,
}

/// The word for the shortest range that the grid resolves.
const GRID: &str = "grid";

impl Serialize for AdhesionRange {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        match self {
            Self::Length(length) => serializer.serialize_f64(*length),
            Self::Grid => serializer.serialize_str(GRID),
        }
    }
}

/// Reads a length above 0, or the word for the shortest range that the grid resolves.
pub(in crate::case) fn range(entry: &Entry<'_>) -> Result<AdhesionRange> {
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

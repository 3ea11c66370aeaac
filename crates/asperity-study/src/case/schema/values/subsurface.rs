//! Values of `[subsurface]`.

use crate::case::cursor::Entry;
use asperity_base::choice::choice;
use asperity_base::error::Result;
use asperity_base::units::{Dimension, Metre};

/// One of the two bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The body underneath.
    Lower,
    /// The body above.
    Upper,
}

choice!(Side: "lower" => Lower, "upper" => Upper);

/// Depths below the surface.
pub(in crate::case) fn depths(entry: &Entry<'_>) -> Result<Vec<Metre>> {
    entry.list("a list of depths such as [\"1 um\", \"5 um\"]", length)
}

/// Positions on the surface.
pub(in crate::case) fn positions(entry: &Entry<'_>) -> Result<Vec<[Metre; 2]>> {
    entry.list("a list of positions such as [[\"5 um\", \"10 um\"]]", |item| {
        item.array("a position [x, y] of two lengths", length)
    })
}

/// A length of at least 0.
fn length(entry: &Entry<'_>) -> Result<Metre> {
    let length = entry.quantity(Dimension::Length)?;
    if length >= 0.0 { Ok(length) } else { Err(entry.unexpected("a length of at least 0", None)) }
}

//! Values of `[contact]` and `[friction]`.

use crate::case::cursor::Entry;
use crate::case::{Boundary, Edge};
use asperity_base::error::Result;

/// A word for both axes, or one for each.
pub(in crate::case) fn boundary(entry: &Entry<'_>) -> Result<Boundary> {
    const EXPECTED: &str = "\"free\", \"periodic\", or one of them for x and one for y";
    Ok(Boundary(entry.pair(EXPECTED, |word| word.choice::<Edge>())?))
}

/// A direction in the plane, as a unit vector.
pub(in crate::case) fn direction(entry: &Entry<'_>) -> Result<[f64; 2]> {
    const EXPECTED: &str = "a direction such as [1, 0]";
    let [x, y] = entry.vector(EXPECTED, |item| item.number(f64::is_finite, "a finite number"))?;
    let length = x.hypot(y);
    if length == 0.0 { Err(entry.unexpected(EXPECTED, None)) } else { Ok([x / length, y / length]) }
}

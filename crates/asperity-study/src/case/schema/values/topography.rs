//! Values of `[topography]`.

use crate::case::cursor::Entry;
use asperity_base::error::Result;
use asperity_base::grid::MAX_CELLS;
use asperity_surface::Level;

/// The part of a topography to keep.
pub(in crate::case) fn window(entry: &Entry<'_>) -> Result<[usize; 4]> {
    let window: [usize; 4] = entry.array("four whole numbers [x0, y0, nx, ny]", |item| item.count(0))?;
    if window[2..].contains(&0) {
        return Err(entry.unexpected("a window [x0, y0, nx, ny] of at least one sample", None));
    }
    Ok(window)
}

/// Reads a word of [`Level`]; each order of a polynomial has its own word.
pub(in crate::case) fn level(entry: &Entry<'_>) -> Result<Level> {
    if let Some(level) = entry.text().ok().and_then(|text| text.parse().ok()) {
        return Ok(level);
    }
    let choices = Level::WORDS.map(|word| (word, Level::None));
    let hint = || format!("the order of a polynomial is from 0 to {}", Level::MAX_ORDER);
    match entry.text() {
        Ok(text) if text.starts_with("polynomial") => {
            Err(entry.unexpected("a polynomial such as \"polynomial-3\"", Some(hint())))
        }
        _ => entry.word(&choices),
    }
}

/// Numbers of cells along x and y.
pub(in crate::case) fn shape(entry: &Entry<'_>) -> Result<[usize; 2]> {
    const EXPECTED: &str = "two whole numbers of at least 1, such as [256, 256]";
    let whole = |item: &Entry<'_>| item.whole(0).map(|cells| usize::try_from(cells).unwrap_or(usize::MAX));
    let shape: [usize; 2] = entry.array(EXPECTED, whole)?;
    match shape[0].checked_mul(shape[1]) {
        Some(0) => Err(entry.unexpected(EXPECTED, None)),
        Some(cells) if cells <= MAX_CELLS => Ok(shape),
        _ => Err(entry.unexpected("a grid of at most 2³² cells", None)),
    }
}

//! Values of `[motion]`.

use crate::error::Result;
use crate::study::case::RANDOM;
use crate::study::case::cursor::Entry;

/// Reads a number of cells; none for `random`.
pub(in crate::study::case) fn offset(entry: &Entry<'_>) -> Result<Option<usize>> {
    if entry.text().is_err() {
        return entry.count(0).map(Some);
    }
    let random = entry.word(&[(RANDOM, None)]);
    random.map_err(|_| entry.unexpected("a whole number of cells, or \"random\"", None))
}

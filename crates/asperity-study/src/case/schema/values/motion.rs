//! Values of `[motion]`.

use crate::case::RANDOM;
use crate::case::cursor::Entry;
use asperity_base::error::Result;

/// Reads a number of cells; none for `random`.
pub(in crate::case) fn offset(entry: &Entry<'_>) -> Result<Option<usize>> {
    if entry.text().is_err() {
        return entry.count(0).map(Some);
    }
    let random = entry.word(&[(RANDOM, None)]);
    random.map_err(|_| entry.unexpected("a whole number of cells, or \"random\"", None))
}

//! Whether to go on with what takes long.

use crate::error::{Error, Result};

/// Asked now and then by what takes long, on any thread: whether to stop, which then ends with [`Error::Interrupted`].
pub type Stop<'a> = &'a (dyn Fn() -> bool + Sync);

/// Nobody asks to stop.
pub(crate) const NEVER: Stop<'static> = &|| false;

/// [`Error::Interrupted`] if somebody asks to stop.
pub(crate) fn go_on(stop: Stop<'_>) -> Result<()> {
    if stop() { Err(Error::Interrupted) } else { Ok(()) }
}

/// Samples between two questions.
const STRIDE: usize = 1 << 14;

/// As [`go_on`], asked at every so many of the samples that are counted by `n`.
pub(crate) fn go_on_at(n: usize, stop: Stop<'_>) -> Result<()> {
    if n.is_multiple_of(STRIDE) { go_on(stop) } else { Ok(()) }
}

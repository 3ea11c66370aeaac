//! Cancellation of long computations.

use asperity_base::error::{Error, Result};

/// Called repeatedly by long computations, on any thread. If it returns true, the computation fails with
/// [`Error::Interrupted`].
pub type Stop<'a> = &'a (dyn Fn() -> bool + Sync);

/// Never stops.
pub const NEVER: Stop<'static> = &|| false;

/// Returns [`Error::Interrupted`] if `stop` returns true.
pub(crate) fn check_stop(stop: Stop<'_>) -> Result<()> {
    if stop() { Err(Error::Interrupted) } else { Ok(()) }
}

/// Number of samples between two calls.
const STRIDE: usize = 1 << 14;

/// [`check_stop`], called once for every `STRIDE` samples counted by `n`.
pub(crate) fn check_stop_at(n: usize, stop: Stop<'_>) -> Result<()> {
    if n.is_multiple_of(STRIDE) { check_stop(stop) } else { Ok(()) }
}

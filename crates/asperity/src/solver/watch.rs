//! Who looks on while a contact is solved.

use crate::error::{Error, Result};

/// Looks on while a contact is solved.
pub trait Watch: Sync {
    /// An iteration has come to a residual, of which the `tolerance` is asked.
    fn iteration(&self, residual: f64, tolerance: f64);

    /// Whether to stop: the solution then ends with [`Error::Interrupted`] at the next convolution.
    fn stop(&self) -> bool;
}

/// Nobody looks on.
impl Watch for () {
    fn iteration(&self, _: f64, _: f64) {}

    fn stop(&self) -> bool {
        false
    }
}

/// Stops as another watch does, and reports nothing: for the solutions that an iteration is made of.
pub(super) struct InnerWatch<'a>(pub(super) &'a dyn Watch);

impl Watch for InnerWatch<'_> {
    fn iteration(&self, _: f64, _: f64) {}

    fn stop(&self) -> bool {
        self.0.stop()
    }
}

/// [`Error::Interrupted`] if the watch wants to stop.
pub(super) fn go_on(watch: &dyn Watch) -> Result<()> {
    if watch.stop() { Err(Error::Interrupted) } else { Ok(()) }
}

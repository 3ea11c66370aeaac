//! Observation of a contact while it is solved.

use crate::error::{Error, Result};

/// Observes a contact while it is solved.
pub trait Watch: Sync {
    /// Reports the residual of an iteration and the required `tolerance`.
    fn iteration(&self, residual: f64, tolerance: f64);

    /// Whether to stop. The solution then fails with [`Error::Interrupted`] at the next convolution.
    fn stop(&self) -> bool;
}

/// A watch that does nothing.
impl Watch for () {
    fn iteration(&self, _: f64, _: f64) {}

    fn stop(&self) -> bool {
        false
    }
}

/// Stops when another watch does, but reports nothing; for the inner solutions of an iteration.
pub struct InnerWatch<'a>(pub &'a dyn Watch);

impl Watch for InnerWatch<'_> {
    fn iteration(&self, _: f64, _: f64) {}

    fn stop(&self) -> bool {
        self.0.stop()
    }
}

/// Returns [`Error::Interrupted`] if the watch requests a stop.
///
/// # Errors
/// [`Error::Interrupted`].
pub fn check_stop(watch: &dyn Watch) -> Result<()> {
    if watch.stop() { Err(Error::Interrupted) } else { Ok(()) }
}

//! What several tests use.

use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use asperity_contact::motion::{Progress, Watch};

/// Stops a course once some of its steps are done: points of a sweep, or increments of a loading.
pub(crate) struct StopAfter {
    steps: usize,
    solved: AtomicUsize,
}

impl StopAfter {
    pub(crate) fn steps(steps: usize) -> Self {
        Self { steps, solved: AtomicUsize::new(0) }
    }
}

impl Watch for StopAfter {
    fn at(&self, progress: &Progress) {
        self.solved.store(progress.solved, Relaxed);
    }

    fn stop(&self) -> bool {
        self.solved.load(Relaxed) >= self.steps
    }
}

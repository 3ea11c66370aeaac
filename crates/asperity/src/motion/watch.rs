//! Who looks on while a contact or a motion is computed.

use std::sync::OnceLock;

use crate::motion::record::{PassRecord, SweepRecord, UpdateRecord};
use crate::solver::{self, Control};
use crate::units::Newton;

/// How far a motion has come.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Progress {
    /// The pass under way, from 1.
    pub pass: usize,
    /// Passes in all.
    pub passes: usize,
    /// The approach being tried in this pass, from 1.
    pub trial: usize,
    /// Positions solved in this trial.
    pub solved: usize,
    /// Positions of a pass.
    pub positions: usize,
    /// Load at the position solved last.
    pub load: Newton,
    /// Where all positions are solved together, or a contact at rest is being solved: the part of the way, 0 to 1, in the
    /// logarithm of the residual.
    pub together: Option<f64>,
}

/// Watches a computation, from the threads that solve, and may stop it.
pub trait Watch: Sync {
    /// A position has been solved.
    fn at(&self, progress: &Progress);

    /// A contact at rest is being solved: [`Progress::together`] says how far it has come.
    fn solving(&self, _: &Progress) {}

    /// A pass has been finished: each in its turn, those too from which an interrupted motion goes on.
    fn pass(&self, _: &PassRecord) {}

    /// A point of a sweep has been solved: each in its turn, those too from which an interrupted sweep goes on.
    fn point(&self, _: &SweepRecord) {}

    /// An update of a contact that slides in place has been solved: each in its turn, those too from which an interrupted one goes
    /// on.
    fn update(&self, _: &UpdateRecord) {}

    /// Whether to stop: what is computed then ends with [`crate::Error::Interrupted`] at the next convolution.
    fn stop(&self) -> bool;
}

/// The watch of a computation that nobody looks on.
impl Watch for () {
    fn at(&self, _: &Progress) {}

    fn stop(&self) -> bool {
        false
    }
}

/// Looks on at a contact that is one of many: it stops when the whole does.
pub(super) struct OneOfMany<'a>(pub(super) &'a dyn Watch);

impl solver::Watch for OneOfMany<'_> {
    fn iteration(&self, _: f64, _: f64) {}

    fn stop(&self) -> bool {
        self.0.stop()
    }
}

/// Looks on at a contact at rest, after so many increments or points of all.
pub(super) struct AtRest<'a> {
    watch: &'a dyn Watch,
    progress: Progress,
    /// The residual at the beginning.
    first: OnceLock<f64>,
}

impl<'a> AtRest<'a> {
    pub(super) fn new(watch: &'a dyn Watch, solved: usize, positions: usize, control: Control) -> Self {
        let load = match control {
            Control::Load(load) => load,
            Control::Approach(_) => 0.0,
        };
        let progress = Progress { pass: 1, passes: 1, trial: 1, solved, positions, load, together: None };
        Self { watch, progress, first: OnceLock::new() }
    }
}

impl solver::Watch for AtRest<'_> {
    fn iteration(&self, residual: f64, tolerance: f64) {
        let first = self.first.get_or_init(|| residual);
        let way = (first / residual).ln() / (first / tolerance).ln();
        let way = if way.is_finite() { way.clamp(0.0, 1.0) } else { 0.0 };
        self.watch.solving(&Progress { together: Some(way), ..self.progress });
    }

    fn stop(&self) -> bool {
        self.watch.stop()
    }
}

//! Observers of the computation of a contact or a motion.

use std::sync::OnceLock;

use crate::motion::record::{PassRecord, SweepRecord, UpdateRecord};
use crate::solver::{self, Control};
use crate::units::Newton;

/// Progress of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Progress {
    /// The current pass, from 1.
    pub pass: usize,
    /// Total number of passes.
    pub passes: usize,
    /// The current trial of the approach in this pass, from 1.
    pub trial: usize,
    /// Positions solved in this trial.
    pub solved: usize,
    /// Number of positions of a pass.
    pub positions: usize,
    /// Load at the position solved last.
    pub load: Newton,
    /// Progress, 0 to 1, in the logarithm of the residual, while a sample of the positions is solved together or
    /// a static contact is solved.
    pub together: Option<f64>,
}

/// A number of a capability in the row of a pass on the terminal; `None` if it is unknown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepCell {
    /// The head of its column.
    pub head: &'static str,
    /// The column of the results that has its unit; a share has none, and is printed in per cent.
    pub column: Option<&'static str>,
    /// The value.
    pub value: Option<f64>,
}

/// Observes a computation from the solving threads, and may stop it.
pub trait Watch: Sync {
    /// Called after a position has been solved.
    fn position(&self, progress: &Progress);

    /// Called while a static contact is being solved; [`Progress::together`] is its progress.
    fn solving(&self, _: &Progress) {}

    /// Called before [`Watch::pass`] with the numbers that capabilities show in its row, not for passes
    /// before an interruption.
    fn cells(&self, _: &[StepCell]) {}

    /// Called after each pass in turn, including those before an interruption when a motion resumes.
    fn pass(&self, _: &PassRecord) {}

    /// Called after each point of a sweep in turn, including those before an interruption when a sweep
    /// resumes.
    fn point(&self, _: &SweepRecord) {}

    /// Called after each update of a contact that slides in place in turn, including those before an
    /// interruption when it resumes.
    fn update(&self, _: &UpdateRecord) {}

    /// Called with each warning about a result as soon as it is known.
    fn warning(&self, _: &str) {}

    /// Whether to stop. The computation then fails with [`crate::Error::Interrupted`] at the next
    /// convolution.
    fn stop(&self) -> bool;
}

/// The watch of an unobserved computation.
impl Watch for () {
    fn position(&self, _: &Progress) {}

    fn stop(&self) -> bool {
        false
    }
}

/// Observes a motion on the side of another computation, and stops it with that one.
pub struct StopsWith<'a>(pub &'a (dyn Fn() -> bool + Sync));

impl Watch for StopsWith<'_> {
    fn position(&self, _: &Progress) {}

    fn stop(&self) -> bool {
        self.0()
    }
}

/// Observes one contact of many, which stops when the whole computation does.
pub(super) struct OneOfMany<'a>(pub(super) &'a dyn Watch);

impl solver::Watch for OneOfMany<'_> {
    fn iteration(&self, _: f64, _: f64) {}

    fn stop(&self) -> bool {
        self.0.stop()
    }
}

/// Observes a static contact after the finished increments or points.
pub(super) struct StaticWatch<'a> {
    watch: &'a dyn Watch,
    progress: Progress,
    /// The initial residual.
    first: OnceLock<f64>,
}

impl<'a> StaticWatch<'a> {
    pub(super) fn new(watch: &'a dyn Watch, solved: usize, positions: usize, control: Control) -> Self {
        let load = match control {
            Control::Load(load) => load,
            Control::Approach(_) => 0.0,
        };
        let progress = Progress { pass: 1, passes: 1, trial: 1, solved, positions, load, together: None };
        Self { watch, progress, first: OnceLock::new() }
    }
}

impl solver::Watch for StaticWatch<'_> {
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

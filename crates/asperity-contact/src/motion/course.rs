//! The loop shared by all computations of more than one step.

use crate::error::{Error, Result};
use crate::motion::record::{IncrementRecord, SweepRecord};
use crate::motion::report::PassReport;
use crate::motion::state::{LoadedContact, LoadingState, SlidingState};
use crate::motion::watch::{Progress, Watch};
use crate::motion::worn_away;
use crate::solver::{Equilibrium, Solution};
use crate::units::Newton;

/// A computation in steps: increments of a loading, updates of a contact that slides in place, points of a load sweep, or
/// passes of a motion.
pub(super) trait Course {
    /// A solved step that is not committed yet.
    type Solved;

    /// Solves the next step; returns `None` once all are done.
    ///
    /// # Errors
    /// The reason why the step cannot be solved. The course cannot continue after it.
    fn next(&mut self, watch: &dyn Watch) -> Result<Option<Self::Solved>>;

    /// Returns the report of a solved step for the outputs.
    fn report<'a>(&'a self, solved: &'a Self::Solved) -> Step<'a>;

    /// Commits a solved step: the next one begins from its end.
    fn take(&mut self, solved: Self::Solved);
}

/// Report of a step before it is committed.
pub enum Step<'a> {
    /// An increment of a loading.
    Increment {
        /// The loading after it.
        state: &'a LoadingState,
        /// Total number of increments.
        of: usize,
    },
    /// An increment of a loading of elasto-plastic bodies.
    Plastic {
        /// The record of the increment.
        record: &'a IncrementRecord,
        /// The contact at its end; `None` while the bodies are unloaded at the end of their path.
        contact: Option<&'a Equilibrium>,
        /// Whether no loading follows, but unloading may.
        is_last_load: bool,
        /// Total number of increments, unloading included.
        of: usize,
    },
    /// An update of a contact that slides in place.
    Update {
        /// The contact after it.
        state: &'a SlidingState,
        /// The solution at its end.
        solution: &'a Solution,
        /// Total number of updates, without the initial contact.
        of: usize,
    },
    /// A point of a load sweep.
    Point {
        /// The record of the point.
        record: &'a SweepRecord,
        /// The contact at the point.
        contact: &'a LoadedContact,
        /// Total number of points.
        of: usize,
    },
    /// A pass of a motion.
    Pass(PassReport<'a>),
}

/// Receives the steps of a course. An error of an output ends the course.
pub trait Output {
    /// Receives a step.
    ///
    /// # Errors
    /// The reason why the step could not be written.
    fn step(&mut self, step: &Step<'_>) -> Result<()>;

    /// Returns warnings about the step received last, for the watch.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }
}

/// Runs the remaining steps.
///
/// # Errors
/// The errors of the course and of the outputs; [`Error::Interrupted`].
pub(super) fn run<C: Course>(
    course: &mut C,
    watch: &dyn Watch,
    outputs: &mut [&mut dyn Output],
) -> Result<()> {
    while let Some(solved) = course.next(watch)? {
        finish(course, solved, watch, outputs)?;
    }
    Ok(())
}

/// Passes a solved step to the outputs and commits it.
///
/// # Errors
/// The errors of the outputs, [`Error::NotFinite`] if the bodies have NaN or infinite values, and [`Error::WornAway`]. The step
/// is then not committed.
pub(super) fn finish<C: Course>(
    course: &mut C,
    solved: C::Solved,
    watch: &dyn Watch,
    outputs: &mut [&mut dyn Output],
) -> Result<()> {
    let step = course.report(&solved);
    step.check()
        .and_then(|()| outputs.iter_mut().try_for_each(|output| output.step(&step)))
        .map_err(|error| error.if_of_step(|source| step.at(source)))?;
    step.notify(watch);
    outputs.iter().flat_map(|output| output.warnings()).for_each(|warning| watch.warning(&warning));
    course.take(solved);
    Ok(())
}

impl<'a> Step<'a> {
    /// Number of the step, from 1; the initial contact of sliding in place is update 0.
    pub fn number(&self) -> usize {
        match self {
            Self::Increment { state, .. } => state.increments.len(),
            Self::Plastic { record, .. } => record.increment,
            Self::Update { state, .. } => state.updates.len() - 1,
            Self::Point { record, .. } => record.point,
            Self::Pass(report) => report.record.pass,
        }
    }

    /// Returns whether no step of the course follows. A motion may be given more passes later, so none of its passes is the last.
    pub fn is_last(&self) -> bool {
        match self {
            Self::Increment { of, .. }
            | Self::Plastic { of, .. }
            | Self::Update { of, .. }
            | Self::Point { of, .. } => self.number() == *of,
            Self::Pass(_) => false,
        }
    }

    /// Returns the pass, if the step is a pass of a motion.
    pub fn pass(&self) -> Option<&PassReport<'a>> {
        match self {
            Self::Pass(report) => Some(report),
            _ => None,
        }
    }

    /// Checks that the bodies after the step have only finite values, and are still surfaces.
    fn check(&self) -> Result<()> {
        match self {
            Self::Update { state, .. } => {
                state.pair.check_finite()?;
                let update = state.updates.last().expect("the update just done");
                worn_away::check_update(&state.pair, update)
            }
            Self::Pass(report) => {
                report.pair.check_finite()?;
                worn_away::check_pass(report.pair, report.record)
            }
            Self::Increment { .. } | Self::Plastic { .. } | Self::Point { .. } => Ok(()),
        }
    }

    /// Wraps an error as one at this step.
    fn at(&self, source: Box<Error>) -> Error {
        let number = self.number();
        match self {
            Self::Increment { .. } | Self::Plastic { .. } => Error::AtIncrement { increment: number, source },
            Self::Update { .. } => Error::AtUpdate { update: number, source },
            Self::Point { of, .. } => Error::AtPoint { point: number, points: *of, source },
            Self::Pass(_) => Error::AtPass { pass: number, source },
        }
    }

    /// Notifies the watch that the step is done. The positions of a pass have notified it already.
    fn notify(&self, watch: &dyn Watch) {
        let solved = |load: Newton, positions: usize| {
            let solved = self.number();
            watch.at(&Progress { pass: 1, passes: 1, trial: 1, solved, positions, load, together: None });
        };
        match self {
            Self::Increment { state, of } => solved(state.contact.normal().load(), *of),
            Self::Plastic { record, of, .. } => solved(record.load, *of),
            Self::Update { state, of, .. } => {
                let update = state.updates.last().expect("the update just done");
                solved(update.load, *of);
                watch.update(update);
            }
            Self::Point { record, of, .. } => {
                solved(record.load, *of);
                watch.point(record);
            }
            Self::Pass(report) => watch.pass(report.record),
        }
    }
}

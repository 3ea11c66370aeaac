//! The course of a contact: the one loop of every computation that takes more than one step.

use crate::error::{Error, Result};
use crate::motion::record::{IncrementRecord, SweepRecord};
use crate::motion::report::PassReport;
use crate::motion::state::{LoadedContact, LoadingState, SlidingState};
use crate::motion::watch::{Progress, Watch};
use crate::units::Newton;

/// What a contact goes through, step after step: the increments of a loading, the updates of a contact that slides in place, the
/// points of a sweep, the passes of a motion.
pub(super) trait Course {
    /// A step that is solved, and does not count yet.
    type Solved;

    /// Solves the next step; none once all are done.
    ///
    /// # Errors
    /// What keeps the step from being solved. The course cannot go on after it.
    fn next(&mut self, watch: &dyn Watch) -> Result<Option<Self::Solved>>;

    /// What outputs take of a solved step.
    fn report<'a>(&'a self, solved: &'a Self::Solved) -> Step<'a>;

    /// Makes a solved step count: the next one begins where it ends.
    fn take(&mut self, solved: Self::Solved);
}

/// A step of a course, before it counts.
#[non_exhaustive]
pub enum Step<'a> {
    /// An increment of a loading.
    Increment {
        /// The loading after it.
        state: &'a LoadingState,
        /// Increments in all.
        of: usize,
    },
    /// An increment of a loading of elasto-plastic bodies.
    Flow {
        /// The increment in numbers.
        record: &'a IncrementRecord,
        /// Increments in all, with those in which the load is taken off.
        of: usize,
    },
    /// An update of a contact that slides in place.
    Update {
        /// The contact after it.
        state: &'a SlidingState,
        /// Updates in all, without the contact before it slides.
        of: usize,
    },
    /// A point of a sweep.
    Point {
        /// The point in numbers.
        record: &'a SweepRecord,
        /// The contact there.
        contact: &'a LoadedContact,
        /// Points in all.
        of: usize,
    },
    /// A pass of a motion.
    Pass(PassReport<'a>),
}

/// Takes the steps of a course. An output that cannot be written ends the course.
pub trait Output {
    /// Takes a step.
    ///
    /// # Errors
    /// What kept it from being written.
    fn step(&mut self, step: &Step<'_>) -> Result<()>;
}

/// Goes through the steps that are left.
///
/// # Errors
/// Returns the errors of the course and of the outputs; [`Error::Interrupted`].
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

/// Hands a solved step out, and makes it count.
///
/// # Errors
/// Returns the errors of the outputs, and [`Error::NotFinite`] if a height or a state of a body is not finite. The step then does
/// not count.
pub(super) fn finish<C: Course>(
    course: &mut C,
    solved: C::Solved,
    watch: &dyn Watch,
    outputs: &mut [&mut dyn Output],
) -> Result<()> {
    let step = course.report(&solved);
    step.check()
        .and_then(|()| outputs.iter_mut().try_for_each(|output| output.step(&step)))
        .map_err(|error| error.if_not_finite(|source| step.at(source)))?;
    step.tell(watch);
    course.take(solved);
    Ok(())
}

impl<'a> Step<'a> {
    /// The number of the step. It counts from 1; the contact before it slides in place is update 0.
    pub fn number(&self) -> usize {
        match self {
            Self::Increment { state, .. } => state.increments.len(),
            Self::Flow { record, .. } => record.increment,
            Self::Update { state, .. } => state.updates.len() - 1,
            Self::Point { record, .. } => record.point,
            Self::Pass(report) => report.record.pass,
        }
    }

    /// Whether no step of the course follows. A motion may be given more passes later, so none of its passes is the last.
    pub(crate) fn is_last(&self) -> bool {
        match self {
            Self::Increment { of, .. }
            | Self::Flow { of, .. }
            | Self::Update { of, .. }
            | Self::Point { of, .. } => self.number() == *of,
            Self::Pass(_) => false,
        }
    }

    /// The report of the pass, where the step is one.
    pub fn pass(&self) -> Option<&PassReport<'a>> {
        match self {
            Self::Pass(report) => Some(report),
            _ => None,
        }
    }

    /// An error if the bodies that the step leaves are no numbers.
    fn check(&self) -> Result<()> {
        match self {
            Self::Update { state, .. } => state.pair.check_finite(),
            Self::Pass(report) => report.pair.check_finite(),
            Self::Increment { .. } | Self::Flow { .. } | Self::Point { .. } => Ok(()),
        }
    }

    /// The error that something is wrong at this step.
    fn at(&self, source: Box<Error>) -> Error {
        let number = self.number();
        match self {
            Self::Increment { .. } | Self::Flow { .. } => Error::AtIncrement { increment: number, source },
            Self::Update { .. } => Error::AtUpdate { update: number, source },
            Self::Point { of, .. } => Error::AtPoint { point: number, points: *of, source },
            Self::Pass(_) => Error::AtPass { pass: number, source },
        }
    }

    /// Tells those who look on that the step is done. The positions of a pass have told of themselves.
    fn tell(&self, watch: &dyn Watch) {
        let solved = |load: Newton, positions: usize| {
            let solved = self.number();
            watch.at(&Progress { pass: 1, passes: 1, trial: 1, solved, positions, load, together: None });
        };
        match self {
            Self::Increment { state, of } => solved(state.contact.normal().load(), *of),
            Self::Flow { record, of } => solved(record.load, *of),
            Self::Update { state, of } => {
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

//! The loop shared by all computations of more than one step.

use std::any::Any;

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::lubrication::Film;
use crate::motion::pair::Pair;
use crate::motion::record::{IncrementRecord, PassRecord, SweepRecord, UpdateRecord};
use crate::motion::report::{CycleReport, PassReport};
use crate::motion::state::Flattening;
use crate::motion::store::CourseState;
use crate::motion::watch::{Progress, StepCell, Watch};
use crate::motion::worn_away;
use crate::solver::Solution;
use crate::units::{Metre, Newton};

/// A computation in steps: increments of a loading, updates of a contact that slides in place, points of a
/// load sweep, or passes of a motion.
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

/// A solved step of a course, before it is committed.
#[derive(Clone, Copy)]
pub struct Step<'a> {
    /// Its number, from 1; the initial contact of sliding in place is update 0.
    pub number: usize,
    /// Number of the last step; `None` for the passes of a motion, which may be given more later.
    pub of: Option<usize>,
    /// Its row.
    pub row: StepRow<'a>,
    /// The contact of a course that does not move; `None` for a pass, and while elasto-plastic bodies are
    /// unloaded at the end.
    pub contact: Option<&'a Solution>,
    /// The plastic interference of earlier contacts of a loading.
    pub flattening: Option<&'a Flattening>,
    /// The film of lubricated bodies at a point of a sweep; `None` between others.
    pub film: Option<&'a Film>,
    /// Whether no loading follows, but unloading may.
    pub ends_loading: bool,
    /// The bodies after the step, if it may have changed them.
    pub changed: Option<&'a Pair>,
    /// The state from which the next step begins; `None` if the course cannot be resumed.
    pub state: Option<&'a dyn CourseState>,
    /// The load cycle that ends with the step.
    pub(super) cycle: Option<CycleReport<'a>>,
}

/// The row of a step.
#[derive(Clone, Copy)]
pub enum StepRow<'a> {
    /// An increment of a loading.
    Increment(&'a IncrementRecord),
    /// An update of a contact that slides in place.
    Update(&'a UpdateRecord),
    /// A point of a load sweep.
    Point(&'a SweepRecord),
    /// A pass of a motion.
    Pass(&'a PassRecord),
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

    /// Returns numbers of the step received last, for the watch.
    fn cells(&self) -> Vec<StepCell> {
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
/// The errors of the outputs, [`Error::NotFinite`] if the bodies have NaN or infinite values, and
/// [`Error::WornAway`]. The step is then not committed.
pub(super) fn finish<C: Course>(
    course: &mut C,
    solved: C::Solved,
    watch: &dyn Watch,
    outputs: &mut [&mut dyn Output],
) -> Result<()> {
    let mut step = course.report(&solved);
    if let Some(cycle) = &mut step.cycle {
        cycle.watch = watch;
    }
    step.check()
        .and_then(|()| outputs.iter_mut().try_for_each(|output| output.step(&step)))
        .map_err(|error| error.if_of_step(|source| step.at(source)))?;
    watch.cells(&outputs.iter().flat_map(|output| output.cells()).collect::<Vec<_>>());
    step.notify(watch);
    outputs.iter().flat_map(|output| output.warnings()).for_each(|warning| watch.warning(&warning));
    course.take(solved);
    Ok(())
}

impl<'a> Step<'a> {
    /// Creates a step with its `row`, of which `of` is the last, without anything else.
    pub(super) fn new(number: usize, of: usize, row: StepRow<'a>) -> Self {
        Self {
            number,
            of: Some(of),
            row,
            contact: None,
            flattening: None,
            film: None,
            ends_loading: number == of,
            changed: None,
            state: None,
            cycle: None,
        }
    }

    /// Creates the step of a pass.
    pub(super) fn of_pass(report: PassReport<'a>) -> Self {
        Self {
            of: None,
            ends_loading: false,
            changed: Some(report.pair),
            state: Some(report.warm),
            cycle: Some(report.cycle()),
            ..Self::new(report.record.pass, report.record.pass, StepRow::Pass(report.record))
        }
    }

    /// Returns whether no step of the course follows.
    pub fn is_last(&self) -> bool {
        self.of == Some(self.number)
    }

    /// Returns the pass, if the step is a pass of a motion.
    pub fn pass(&self) -> Option<&PassReport<'a>> {
        self.cycle.as_ref()?.pass.as_ref()
    }

    /// Returns the load cycle that ends with the step: a pass of a motion, or a computed cycle of a loading
    /// whose bodies laws change or memories remember.
    pub fn cycle(&self) -> Option<&CycleReport<'a>> {
        self.cycle.as_ref()
    }

    /// The pitch of the bodies; `None` while elasto-plastic bodies are unloaded at the end.
    pub fn pitch(&self) -> Option<[Metre; 2]> {
        self.contact.map(|contact| contact.grid.pitch).or(self.changed.map(Pair::pitch))
    }

    /// Returns the state from which the next step begins, if it is of this type.
    pub fn state_as<S: CourseState>(&self) -> Option<&'a S> {
        let state: &dyn Any = self.state?;
        state.downcast_ref()
    }

    /// Computes the plastic interference of both bodies together; `None` without a contact.
    pub fn plastic(&self) -> Option<Field> {
        let now = self.contact?.plastic_interference();
        Some(match self.flattening {
            Some(flattening) => flattening.total(now),
            None => now,
        })
    }

    /// Checks that the bodies after the step have only finite values, and are still surfaces.
    fn check(&self) -> Result<()> {
        let Some(pair) = self.changed else { return Ok(()) };
        pair.check_finite()?;
        match self.row {
            StepRow::Update(update) => worn_away::check_update(pair, update),
            StepRow::Pass(pass) => worn_away::check_pass(pair, pass),
            StepRow::Increment(_) | StepRow::Point(_) => Ok(()),
        }
    }

    /// Notifies the watch that the step is done. The positions of a pass have notified it already.
    fn notify(&self, watch: &dyn Watch) {
        if let (Some(load), Some(positions)) = (self.row.load(), self.of) {
            let solved = self.number;
            let together = None;
            watch.position(&Progress { pass: 1, passes: 1, trial: 1, solved, positions, load, together });
        }
        match self.row {
            StepRow::Increment(_) => {}
            StepRow::Update(update) => watch.update(update),
            StepRow::Point(point) => watch.point(point),
            StepRow::Pass(pass) => watch.pass(pass),
        }
    }

    /// Wraps an error as one at this step.
    fn at(&self, source: Box<Error>) -> Error {
        let number = self.number;
        match self.row {
            StepRow::Increment(_) => Error::AtIncrement { increment: number, source },
            StepRow::Update(_) => Error::AtUpdate { update: number, source },
            StepRow::Point(_) => Error::AtPoint { point: number, points: self.of.unwrap_or(number), source },
            StepRow::Pass(_) => Error::AtPass { pass: number, source },
        }
    }
}

impl StepRow<'_> {
    /// The load of a course that does not move.
    fn load(&self) -> Option<Newton> {
        match self {
            Self::Increment(increment) => Some(increment.load),
            Self::Update(update) => Some(update.load),
            Self::Point(point) => Some(point.load),
            Self::Pass(_) => None,
        }
    }
}

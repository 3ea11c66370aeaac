//! Observers: they compute something from each solved contact and change nothing.
//!
//! An observer has a table of its own with a row for each contact that it looks at, and fields. The fields of a static contact are
//! those of its last contact, in `fields.h5`. The fields of points and positions that are kept are in `fields/NAME-NNNN.h5`, a file for
//! each point or pass. The rows of a step are written before the row of the step itself, which marks it as done; a resumed run removes
//! the rows of later steps.

mod conductance; // what heat or current passes
mod flow; // what a fluid passes
mod review; // warnings

pub(super) use review::{barber, warnings};

use std::mem;

use conductance::ConductanceObserver;
use flow::FlowObserver;
use serde::de::DeserializeOwned;

use crate::case::Case;
use crate::fields::NamedField;
use crate::io::fields::FieldFile;
use crate::observed::{ConductanceRecord, GapFlowRecord};
use crate::results::{Results, Writer, is_nth};
use crate::tables::{self, GrowingTable, Record};
use asperity_base::error::{Error, Result};
use asperity_base::math::parallel;
use asperity_contact::motion::{ObservedContact, Output, Pair, Position, Step};
use asperity_contact::solver::Solution;

/// Computes something from a solved contact and changes nothing.
trait Observer: Sync {
    /// A row of its table.
    type Record: Record + DeserializeOwned + Clone + Send;

    /// Name of its table, `NAME.csv`, and of its field files, `fields/NAME-NNNN.h5`.
    const NAME: &'static str;

    /// Interval of the positions of a pass, or of the increments, updates or points, that are looked at: 1 for all of them; 0 for
    /// the position of full overlap of each pass, or for the last contact.
    fn every(&self) -> usize;

    /// Computes the rows and the fields of a contact.
    ///
    /// # Errors
    /// The reason why they cannot be computed.
    fn observe(
        &self,
        place: Place,
        contact: &ObservedContact<'_>,
    ) -> Result<(Vec<Self::Record>, Vec<NamedField>)>;
}

/// Place of a contact in its course.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Place {
    /// Number of the pass, from 1; `None` for a static contact.
    pass: Option<usize>,
    /// Number of the position, increment, update or point, from 1, but from 0 for updates; 1 for a contact in one step.
    step: usize,
}

/// An observer with what it has seen.
struct Observed<O: Observer> {
    observer: O,
    /// The rows of the present step.
    rows: Vec<O::Record>,
    /// The rows of the steps before, if they are not in a file.
    records: Vec<O::Record>,
    /// The fields of the last contact of a static contact.
    fields: Vec<NamedField>,
    files: Option<Files>,
}

/// The files of an observer.
struct Files {
    results: Results,
    identity: String,
    table: GrowingTable,
    /// Interval of the points or positions whose fields are kept; 0 for none.
    kept_every: usize,
    /// The fields of the present step.
    of_step: Option<FieldFile>,
}

impl<O: Observer> Observed<O> {
    /// Creates an observer that writes to files if there is a `writer`.
    fn new(
        observer: O,
        writer: Option<&Writer>,
        done: Option<usize>,
        kept_every: usize,
        is_motion: bool,
    ) -> Result<Self> {
        match writer {
            Some(writer) => Self::in_files(observer, writer, done, kept_every, is_motion),
            None => Ok(Self::in_memory(observer)),
        }
    }

    /// Creates an observer whose rows stay in memory.
    fn in_memory(observer: O) -> Self {
        Self { observer, rows: Vec::new(), records: Vec::new(), fields: Vec::new(), files: None }
    }

    /// Creates an observer that writes its table and its fields to the results of a `writer`, after `done` steps.
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::NotResumable`] if the table of the finished steps is missing.
    fn in_files(
        observer: O,
        writer: &Writer,
        done: Option<usize>,
        kept_every: usize,
        is_motion: bool,
    ) -> Result<Self> {
        let results = writer.results().clone();
        let path = results.observer_table(O::NAME);
        let column = if is_motion { "pass" } else { "step" };
        let rows = match done {
            None => 0,
            Some(_) if !path.exists() && observer.every() > 0 => {
                return Err(Error::NotResumable { path, reason: "is missing" });
            }
            Some(done) => tables::rows_up_to(&path, column, done)?,
        };
        let table = GrowingTable::open(path, rows)?;
        let identity = writer.identity().to_owned();
        let files = Some(Files { results, identity, table, kept_every, of_step: None });
        Ok(Self { files, ..Self::in_memory(observer) })
    }

    /// Adds the fields of a contact to the file of its step, which begins with the first ones.
    fn keep(&mut self, step: &Step<'_>, contact: &ObservedContact<'_>, place: Place, fields: &[NamedField]) {
        let Some(files) = &mut self.files else { return };
        let is_of_course = matches!(step, Step::Pass(_) | Step::Point { .. });
        if !is_of_course || !is_nth(place.step, files.kept_every) {
            return;
        }
        let (identity, path) = (&files.identity, files.results.observer_fields(O::NAME, step.number()));
        let file = files.of_step.get_or_insert_with(|| {
            let mut file = FieldFile::of_run(identity, &path);
            file.set(if place.pass.is_some() { "pass" } else { "point" }, step.number());
            file
        });
        for NamedField { name, values, unit } in fields {
            let name = match place.pass {
                Some(_) => format!("{name}_{:05}", place.step),
                None => (*name).to_owned(),
            };
            file.add_field(&name, unit, &contact.grid, contact.corner, values);
        }
    }

    /// Returns all rows, and the fields of the last contact of a static contact.
    ///
    /// # Errors
    /// [`Error::File`].
    fn finish(self) -> Result<(Vec<O::Record>, Vec<NamedField>)> {
        let rows = match self.files {
            Some(files) => files.results.observed(O::NAME)?,
            None => self.records,
        };
        Ok((rows, self.fields))
    }
}

/// A contact at its place in the course.
struct Seen<'a> {
    contact: ObservedContact<'a>,
    place: Place,
    /// Whether it is the last contact of a course, or the first position of a pass at which the left edges are flush.
    is_main: bool,
}

/// Looks at the contacts of a course.
trait Look {
    /// Whether it looks at the contact at a place; see [`Seen`] for `is_main`.
    fn wants(&self, place: Place, is_main: bool) -> bool;

    /// Looks at contacts in parallel; `step` is the step that they belong to, if there are several.
    ///
    /// # Errors
    /// The errors of the observer.
    fn look(&mut self, step: Option<&Step<'_>>, contacts: &[Seen<'_>]) -> Result<()>;

    /// Writes what it has found in a step.
    ///
    /// # Errors
    /// [`Error::File`], [`Error::NotFinite`].
    fn end_step(&mut self) -> Result<()>;
}

impl<O: Observer> Look for Observed<O> {
    fn wants(&self, place: Place, is_main: bool) -> bool {
        let every = self.observer.every();
        is_nth(place.step, every) || is_main && (every == 0 || place.pass.is_none())
    }

    fn look(&mut self, step: Option<&Step<'_>>, contacts: &[Seen<'_>]) -> Result<()> {
        let observer = &self.observer;
        let wanted: Vec<_> = contacts.iter().filter(|seen| self.wants(seen.place, seen.is_main)).collect();
        let found = parallel::tasks(&wanted, |seen| observer.observe(seen.place, &seen.contact));
        for (seen, found) in wanted.into_iter().zip(found) {
            let (rows, fields) = found?;
            self.rows.extend(rows);
            if let Some(step) = step {
                self.keep(step, &seen.contact, seen.place, &fields);
            }
            if seen.place.pass.is_none() {
                self.fields = fields;
            }
        }
        Ok(())
    }

    fn end_step(&mut self) -> Result<()> {
        let rows = mem::take(&mut self.rows);
        match &mut self.files {
            Some(files) => {
                files.of_step.take().map_or(Ok(()), FieldFile::write)?;
                // A table begins with its first row.
                if rows.is_empty() { Ok(()) } else { files.table.add(&rows) }
            }
            None => {
                tables::checked(&rows)?;
                self.records.extend(rows);
                Ok(())
            }
        }
    }
}

/// The observers of a case.
pub(super) struct Observers {
    conductance: Option<Observed<ConductanceObserver>>,
    flow: Option<Observed<FlowObserver>>,
    /// Index of the first position of a pass at which the left edges are flush.
    flush: Option<usize>,
}

/// Results of the observers of a case.
#[derive(Debug, Clone, Default)]
pub(super) struct Observations {
    pub(super) conductance: Vec<ConductanceRecord>,
    pub(super) flow: Vec<GapFlowRecord>,
    /// The fields of the last contact of a static contact.
    pub(super) fields: Vec<NamedField>,
}

impl Observers {
    /// Creates the observers of a `case` with these bodies and `positions` of a pass, none for a static contact. Without a `writer`
    /// their rows stay in memory; with one they go to files, after those of the steps that are `done`.
    ///
    /// # Errors
    /// The errors of the observers; [`Error::File`].
    pub(super) fn new(
        case: &Case,
        pair: &Pair,
        positions: &[Position],
        (writer, done): (Option<&Writer>, Option<usize>),
    ) -> Result<Self> {
        let every = case.output.pressure_every;
        let is_motion = case.motion.is_some();
        Ok(Self {
            conductance: ConductanceObserver::of(case, pair)?
                .map(|observer| Observed::new(observer, writer, done, every, is_motion))
                .transpose()?,
            flow: FlowObserver::of(case)
                .map(|observer| Observed::new(observer, writer, done, every, is_motion))
                .transpose()?,
            flush: positions.iter().position(|position| position.offset == 0.0),
        })
    }

    /// All of them.
    fn each(&mut self) -> impl Iterator<Item = &mut dyn Look> {
        let conductance = self.conductance.as_mut().map(|observed| observed as &mut dyn Look);
        conductance.into_iter().chain(self.flow.as_mut().map(|observed| observed as &mut dyn Look))
    }

    /// Returns the indices of the positions of a pass that an observer looks at.
    pub(super) fn wanted(&mut self, positions: usize) -> Vec<bool> {
        let flush = self.flush;
        let is_wanted = |index| {
            let place = Place { pass: Some(1), step: index + 1 };
            self.each().any(|each| each.wants(place, Some(index) == flush))
        };
        (0..positions).map(is_wanted).collect()
    }

    /// Looks at a contact that is solved in one step.
    ///
    /// # Errors
    /// The errors of the observers, [`Error::File`].
    pub(super) fn contact(&mut self, solution: &Solution) -> Result<()> {
        if self.conductance.is_none() && self.flow.is_none() {
            return Ok(());
        }
        let contact = ObservedContact::at_rest(solution);
        let seen = [Seen { contact, place: Place { pass: None, step: 1 }, is_main: true }];
        self.each().try_for_each(|each| each.look(None, &seen).and_then(|()| each.end_step()))
    }

    /// Returns what they have found.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(super) fn finish(self) -> Result<Observations> {
        let mut found = Observations::default();
        if let Some(observed) = self.conductance {
            (found.conductance, found.fields) = observed.finish()?;
        }
        if let Some(observed) = self.flow {
            let (rows, fields) = observed.finish()?;
            found.flow = rows;
            found.fields.extend(fields);
        }
        Ok(found)
    }
}

impl Output for Observers {
    fn step(&mut self, step: &Step<'_>) -> Result<()> {
        let (number, flush) = (step.number(), self.flush);
        let mut contacts = step.contacts().map(|contact| {
            let (place, is_main) = match step.pass() {
                Some(_) => {
                    let place = Place { pass: Some(number), step: contact.index + 1 };
                    (place, Some(contact.index) == flush)
                }
                None => {
                    let ends_loading = matches!(step, Step::Plastic { is_last_load: true, .. });
                    (Place { pass: None, step: number }, ends_loading || step.is_last())
                }
            };
            Seen { contact, place, is_main }
        });
        loop {
            // One for each thread: the memory of a position is that of its solver.
            let some: Vec<_> = contacts.by_ref().take(rayon::current_num_threads()).collect();
            if some.is_empty() {
                break;
            }
            self.each().try_for_each(|each| each.look(Some(step), &some))?;
        }
        self.each().try_for_each(Look::end_step)
    }
}

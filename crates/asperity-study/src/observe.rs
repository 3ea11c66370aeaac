//! Observers: they compute something from each solved contact and change nothing.
//!
//! An observer has a table of its own with a row for each contact that it looks at, and fields. The fields of
//! a static contact are those of its last contact, in `fields.h5`. The fields of points and positions that
//! are kept are in `fields/NAME-NNNN.h5`, a file for each point or pass. The rows of a step are written
//! before the row of the step itself, which marks it as done; a resumed run removes the rows of later steps.

use std::mem;

use crate::case::Case;
use crate::fields::NamedField;
use crate::finish::params;
use crate::io::fields::FieldFile;
use crate::io::fs;
use crate::results::{Results, Writer, is_nth};
use crate::tables::{self, GrowingTable};
use asperity_base::error::{Error, Result};
use asperity_base::math::parallel;
use asperity_contact::each;
use asperity_contact::motion::{
    CycleReport, ObservedContact, Output, Pair, Position, Step, StepCell, StepRow,
};
use asperity_contact::solver::Solution;
use asperity_contact::with::{BodyField, Capability, Given, Listed, Observations, Observer, Place, Reported};

/// An observer with what it has seen.
struct Observed<C: Capability> {
    asked: C,
    observer: C::Observer,
    /// The rows of the present step.
    rows: Vec<C::Row>,
    /// The rows of the steps before, if they are not in a file.
    records: Vec<C::Row>,
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

impl<C: Reported> Observed<C> {
    /// Creates the observer of a capability whose rows stay in memory.
    ///
    /// # Errors
    /// The errors of the capability.
    fn in_memory(asked: &C, given: &Given<'_>) -> Result<Self> {
        let observer = asked.begin(given)?;
        let (rows, records, fields) = (Vec::new(), Vec::new(), Vec::new());
        Ok(Self { asked: asked.clone(), observer, rows, records, fields, files: None })
    }

    /// Creates an observer that writes its table and its fields to the results of a `writer`, after `done`
    /// steps.
    ///
    /// # Errors
    /// [`Error::File`]; [`Error::NotResumable`] if the table of the finished steps is missing.
    fn in_files(
        self,
        writer: &Writer,
        done: Option<usize>,
        kept_every: usize,
        is_motion: bool,
    ) -> Result<Self> {
        let results = writer.results().clone();
        let path = results.observer_table(C::NAME);
        let column = if is_motion { "pass" } else { "step" };
        let rows = match done {
            None => 0,
            // The first load cycle may not have ended, or none of them is looked at.
            Some(_) if !fs::exists(&path) && self.asked.every() > 0 && !C::OF_LOAD_CYCLES => {
                return Err(Error::NotResumable { path, reason: "is missing" });
            }
            Some(done) => tables::rows_up_to(&path, column, done)?,
        };
        let table = GrowingTable::open(path, rows)?;
        let identity = writer.identity().to_owned();
        let files = Some(Files { results, identity, table, kept_every, of_step: None });
        Ok(Self { files, ..self })
    }

    /// Adds the fields of a contact to the file of its step, which begins with the first ones.
    fn keep(&mut self, step: &Step<'_>, contact: &ObservedContact<'_>, place: Place, fields: &[NamedField]) {
        let Some(files) = &mut self.files else { return };
        let is_of_course = matches!(step.row, StepRow::Pass(_) | StepRow::Point(_));
        if !is_of_course || !is_nth(place.step, files.kept_every) {
            return;
        }
        let (identity, path) = (&files.identity, files.results.observer_fields(C::NAME, step.number));
        let file = files.of_step.get_or_insert_with(|| {
            let mut file = FieldFile::of_run(identity, &path);
            file.set(if place.pass.is_some() { "pass" } else { "point" }, step.number);
            file
        });
        for NamedField { name, values, unit } in fields {
            let name = match place.pass {
                Some(_) => format!("{name}_{:05}", place.step),
                None => name.clone().into_owned(),
            };
            file.add_field(&name, unit, &contact.grid, contact.corner, values);
        }
    }
}

/// A contact at its place in the course.
struct Seen<'a> {
    contact: ObservedContact<'a>,
    place: Place,
    /// Whether it is the last contact of a course, or the first position of a pass at which the left edges
    /// are flush.
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

    /// Looks at the load cycle that ends with a step.
    ///
    /// # Errors
    /// The errors of the observer.
    fn look_at_cycle(&mut self, step: &Step<'_>, cycle: &CycleReport<'_>) -> Result<()>;

    /// Writes what it has found in a step, and adds what the terminal shows of it to the cells.
    ///
    /// # Errors
    /// [`Error::File`], [`Error::NotFinite`].
    fn end_step(&mut self, cells: &mut Vec<StepCell>) -> Result<()>;

    /// Adds all rows to `found`, and returns the fields of the last contact of a static contact.
    ///
    /// # Errors
    /// [`Error::File`].
    fn finish(self: Box<Self>, found: &mut Observations) -> Result<Vec<NamedField>>;
}

impl<C: Reported> Look for Observed<C> {
    fn wants(&self, place: Place, is_main: bool) -> bool {
        if C::OF_LOAD_CYCLES {
            return false;
        }
        let every = self.asked.every();
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

    fn look_at_cycle(&mut self, step: &Step<'_>, cycle: &CycleReport<'_>) -> Result<()> {
        let (rows, fields) = self.observer.after_cycle(cycle)?;
        self.rows.extend(rows);
        let Some(files) = self.files.as_mut().filter(|_| !fields.is_empty()) else { return Ok(()) };
        let path = files.results.observer_fields(C::NAME, step.number);
        let mut file = FieldFile::of_run(&files.identity, &path);
        file.set(if cycle.pass.is_some() { "pass" } else { "increment" }, step.number);
        for BodyField { name, unit, grid, values } in &fields {
            file.add_field(name, unit, grid, [0.0; 2], values);
        }
        files.of_step = Some(file);
        Ok(())
    }

    fn end_step(&mut self, cells: &mut Vec<StepCell>) -> Result<()> {
        let rows = mem::take(&mut self.rows);
        cells.extend(self.asked.cells(&rows));
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

    fn finish(self: Box<Self>, found: &mut Observations) -> Result<Vec<NamedField>> {
        let rows = match self.files {
            Some(files) => files.results.rows::<C>()?,
            None => self.records,
        };
        C::add(found, rows);
        Ok(self.fields)
    }
}

/// The observers of a case.
pub(super) struct Observers {
    each: Vec<Box<dyn Look + Send + Sync>>,
    /// Index of the first position of a pass at which the left edges are flush.
    flush: Option<usize>,
    /// Numbers of the last step for the terminal.
    cells: Vec<StepCell>,
}

impl Observers {
    /// Creates the observers of a `case` with these bodies and `positions` of a pass, none for a static
    /// contact. Without a `writer` their rows stay in memory; with one they go to files, after those of the
    /// steps that are `done`.
    ///
    /// # Errors
    /// The errors of the observers; [`Error::File`].
    pub(super) fn new(
        case: &Case,
        pair: &Pair,
        positions: &[Position],
        (writer, done): (Option<&Writer>, Option<usize>),
    ) -> Result<Self> {
        let given = Given { pair, surroundings: case.surroundings(), params: params(case) };
        let mut each: Vec<Box<dyn Look + Send + Sync>> = Vec::new();
        each!(capability C => if let Some(asked) = C::of(&case.with) {
            let observed = Observed::in_memory(asked, &given)?;
            each.push(Box::new(match writer {
                Some(writer) => {
                    let is_motion = case.motion.is_some();
                    observed.in_files(writer, done, case.output.pressure_every, is_motion)?
                }
                None => observed,
            }));
        });
        Ok(Self {
            each,
            cells: Vec::new(),
            flush: positions.iter().position(|position| position.offset == 0.0),
        })
    }

    /// Returns the indices of the positions of a pass that an observer looks at.
    pub(super) fn wanted(&self, positions: usize) -> Vec<bool> {
        let flush = self.flush;
        let is_wanted = |index| {
            let place = Place { pass: Some(1), step: index + 1 };
            self.each.iter().any(|each| each.wants(place, Some(index) == flush))
        };
        (0..positions).map(is_wanted).collect()
    }

    /// Looks at a contact that is solved in one step.
    ///
    /// # Errors
    /// The errors of the observers, [`Error::File`].
    pub(super) fn contact(&mut self, solution: &Solution) -> Result<()> {
        if self.each.is_empty() {
            return Ok(());
        }
        let contact = ObservedContact::at_rest(solution);
        let seen = [Seen { contact, place: Place { pass: None, step: 1 }, is_main: true }];
        let cells = &mut self.cells;
        self.each.iter_mut().try_for_each(|each| each.look(None, &seen).and_then(|()| each.end_step(cells)))
    }

    /// Returns the rows that they have found, and the fields of the last contact of a static contact.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(super) fn finish(self) -> Result<(Observations, Vec<NamedField>)> {
        let (mut found, mut fields) = (Observations::default(), Vec::new());
        for each in self.each {
            fields.extend(each.finish(&mut found)?);
        }
        Ok((found, fields))
    }
}

impl Output for Observers {
    fn step(&mut self, step: &Step<'_>) -> Result<()> {
        let (number, flush) = (step.number, self.flush);
        let mut contacts = step.contacts().map(|contact| {
            let (place, is_main) = match step.pass() {
                Some(_) => {
                    let place = Place { pass: Some(number), step: contact.index + 1 };
                    (place, Some(contact.index) == flush)
                }
                None => (Place { pass: None, step: number }, step.ends_loading || step.is_last()),
            };
            Seen { contact, place, is_main }
        });
        loop {
            // One for each thread: the memory of a position is that of its solver.
            let some: Vec<_> = contacts.by_ref().take(rayon::current_num_threads()).collect();
            if some.is_empty() {
                break;
            }
            self.each.iter_mut().try_for_each(|each| each.look(Some(step), &some))?;
        }
        if let Some(cycle) = step.cycle() {
            self.each.iter_mut().try_for_each(|each| each.look_at_cycle(step, cycle))?;
        }
        let Self { each, cells, .. } = self;
        cells.clear();
        each.iter_mut().try_for_each(|each| each.end_step(cells))
    }

    fn cells(&self) -> Vec<StepCell> {
        self.cells.clone()
    }
}

/// Returns reasons in what the observers of a `case` have found not to trust it.
pub(super) fn doubts(case: &Case, found: &Observations) -> Vec<String> {
    let surroundings = case.surroundings();
    let mut doubts = Vec::new();
    each!(capability C => if let Some(asked) = C::of(&case.with) {
        doubts.extend(asked.doubts(C::rows(found), &surroundings));
    });
    doubts
}

/// Returns the rows of a summary.
pub(super) fn summary(found: &Observations) -> Observations {
    let mut summary = Observations::default();
    each!(capability C => C::add(&mut summary, C::summary(C::rows(found))));
    summary
}

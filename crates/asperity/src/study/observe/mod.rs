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

use conductance::ConductanceObserver;
use flow::FlowObserver;
use serde::de::DeserializeOwned;

use crate::error::{Error, Result};
use crate::io::fields::FieldFile;
use crate::motion::{ObservedContact, Output, Pair, Position, Step};
use crate::solver::Solution;
use crate::study::case::Case;
use crate::study::fields::NamedField;
use crate::study::observed::{ConductanceRecord, GapFlowRecord};
use crate::study::results::{Results, Writer, is_kept};
use crate::study::tables::{self, GrowingTable, Record};

/// Computes something from a solved contact and changes nothing.
trait Observer {
    /// A row of its table.
    type Record: Record + DeserializeOwned + Clone;

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
        &mut self,
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
    /// The rows that are not in a file.
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
        Self { observer, records: Vec::new(), fields: Vec::new(), files: None }
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
        let files = Some(Files { results, identity, table, kept_every });
        Ok(Self { files, ..Self::in_memory(observer) })
    }

    /// Looks at the contacts of a step.
    ///
    /// # Errors
    /// The errors of the observer, [`Error::File`], [`Error::NotFinite`].
    fn step(&mut self, step: &Step<'_>) -> Result<()> {
        let number = step.number();
        let mut rows = Vec::new();
        let mut file = None;
        for contact in step.contacts() {
            let place = match step.pass() {
                Some(_) => Place { pass: Some(number), step: contact.index + 1 },
                None => Place { pass: None, step: number },
            };
            let is_wanted = match step.pass() {
                Some(report) => {
                    let position = &report.contacts[contact.index].position;
                    wants_position(self.observer.every(), contact.index, position)
                }
                None => {
                    wants_step(self.observer.every(), number)
                        || step.is_last()
                        || matches!(step, Step::Flow { is_last_load: true, .. })
                }
            };
            if !is_wanted {
                continue;
            }
            let (new, fields) = self.observer.observe(place, &contact)?;
            rows.extend(new);
            if let Some(files) = &self.files {
                let is_kept = match step {
                    Step::Pass(_) => files.kept_every > 0 && contact.index.is_multiple_of(files.kept_every),
                    Step::Point { .. } => is_kept(number, files.kept_every),
                    _ => false,
                };
                if is_kept {
                    let file =
                        file.get_or_insert_with(|| files.field_file(O::NAME, number, step.pass().is_some()));
                    for NamedField { name, values, unit } in &fields {
                        let name = match place.pass {
                            Some(_) => format!("{name}_{:05}", place.step),
                            None => (*name).to_owned(),
                        };
                        file.add_field(&name, unit, &contact.grid, contact.corner, values);
                    }
                }
            }
            if step.pass().is_none() {
                self.fields = fields;
            }
        }
        if let Some(file) = file {
            file.write()?;
        }
        self.add(rows)
    }

    /// Looks at a contact that is solved in one step.
    ///
    /// # Errors
    /// The errors of [`Observed::step`].
    fn contact(&mut self, contact: &ObservedContact<'_>) -> Result<()> {
        let (rows, fields) = self.observer.observe(Place { pass: None, step: 1 }, contact)?;
        self.fields = fields;
        self.add(rows)
    }

    fn add(&mut self, rows: Vec<O::Record>) -> Result<()> {
        match &mut self.files {
            // A table begins with its first row.
            _ if rows.is_empty() => Ok(()),
            Some(files) => files.table.add(&rows),
            None => {
                tables::checked(&rows)?;
                self.records.extend(rows);
                Ok(())
            }
        }
    }

    /// Whether it looks at a position of a pass.
    fn wants(&self, index: usize, position: &Position) -> bool {
        wants_position(self.observer.every(), index, position)
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

impl Files {
    fn field_file(&self, name: &str, number: usize, is_pass: bool) -> FieldFile {
        let mut file = FieldFile::of_run(&self.identity, &self.results.observer_fields(name, number));
        file.set(if is_pass { "pass" } else { "point" }, number);
        file
    }
}

fn wants_position(every: usize, index: usize, position: &Position) -> bool {
    match every {
        0 => position.offset == 0.0,
        every => index.is_multiple_of(every),
    }
}

fn wants_step(every: usize, number: usize) -> bool {
    every > 0 && (number + every - 1).is_multiple_of(every)
}

/// The observers of a case.
pub(super) struct Observers {
    conductance: Option<Observed<ConductanceObserver>>,
    flow: Option<Observed<FlowObserver>>,
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
    /// Creates the observers of a `case` with these bodies. Without a `writer` their rows stay in memory; with one they go to files,
    /// after those of the steps that are `done`.
    ///
    /// # Errors
    /// The errors of the observers; [`Error::File`].
    pub(super) fn new(
        case: &Case,
        pair: &Pair,
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
        })
    }

    /// Whether an observer looks at a position of a pass.
    pub(super) fn want(&self, index: usize, position: &Position) -> bool {
        self.conductance.as_ref().is_some_and(|observed| observed.wants(index, position))
            || self.flow.as_ref().is_some_and(|observed| observed.wants(index, position))
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
        if let Some(observed) = &mut self.conductance {
            observed.contact(&contact)?;
        }
        if let Some(observed) = &mut self.flow {
            observed.contact(&contact)?;
        }
        Ok(())
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
        if let Some(observed) = &mut self.conductance {
            observed.step(step)?;
        }
        if let Some(observed) = &mut self.flow {
            observed.step(step)?;
        }
        Ok(())
    }
}

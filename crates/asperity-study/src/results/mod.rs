//! A results directory: its content, and how it is read.
//!
//! ```text
//! DIR/case.json            the resolved case, SI, with the digests compared when resuming
//!     steps.csv passes.csv a motion: a row per position, a row per pass
//!     fields/initial.h5    the surfaces before the first pass
//!     fields/pass-0001.h5  surfaces after the pass, its mean pressures, and the pressures kept
//!     fields/state-0001.h5 state after that many steps, for the last step only; for a motion it stays after completion
//!     fields/subsurface-0001.h5    the stress under the surface in the pass, if requested
//!     fields/plasticity-0001.h5    plastic state of elasto-plastic bodies; after the last pass, or after each
//!     fields.h5            a static contact
//!     increments.csv       with friction or a history, a row per increment of its loading
//!     updates.csv          a contact that slides in place: a row per update
//!     CAPABILITY.csv       rows of a capability for each contact that it looks at, if requested: `flow.csv`
//!     fields/CAPABILITY-0001.h5    its fields at the positions or points kept
//!     limits.csv           a row per limit of the model that a step exceeds, if any
//!     sweep.csv            a load sweep: a row per point; `fields.h5` is that of the last
//!     fields/point-0001.h5 the pressure and the gap of the points kept
//!     fields/increment-0001.h5     the same of the increments kept, of bodies that attract each other
//!     subsurface.h5        the stress under its surface, if requested
//!     plasticity.h5        plastic state of elasto-plastic bodies
//!     *.vti                beside the fields, for ParaView, if requested
//!     results.csv          a row for each step with everything found in it, once the computation is complete
//!     summary.json         once the computation is complete
//!     report.html          a page of all of it
//!     figures/             pictures
//!     .lock                locked while a run writes here
//! ```
//!
//! A step exists once its table has its row, which is written last. The state of the step before is then
//! removed.

mod entry; // accepted content, clearing, the lock
mod bodies; // bodies in field files
mod kept_contacts; // the contacts of a course whose fields are kept
mod state; // state between two steps of a course
mod step; // the output of a course, step by step
mod write; // the output of a run

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

pub use entry::Existing;
pub(super) use entry::{CASE_FILE, NO_LOCKS, RESULTS_TABLE, is_in_use, try_acquire};
pub use step::StepWriter;
pub use write::Writer;

use serde::de::DeserializeOwned;
use serde_json::Value;
use state::Stored;

use super::case::Case;
use super::{identity, summary, tables};
use crate::io::fields::{Attribute, Fields};
use crate::io::{fs, regular};
use crate::limit::{BrokenLimit, LIMITS_TABLE};
use crate::summary::{Outcome, Summary};
use asperity_base::error::{Error, Result};
use asperity_base::grid::Grid;
use asperity_base::record::Record;
use asperity_contact::each;
use asperity_contact::motion::{
    IncrementRecord, LoadingState, Pair, PassRecord, SlidingState, State, StateReader, StepRecord,
    SweepRecord, SweepState, UpdateRecord, WarmStart,
};
use asperity_contact::plasticity::{PlasticState, TensorField, VolumeField};
use asperity_contact::stress::Component;
use asperity_contact::with::{Capability, Observations, Reported};
use asperity_surface::Topography;

/// A results directory, open for reading.
#[derive(Debug, Clone)]
pub struct Results {
    directory: PathBuf,
}

impl Results {
    /// Opens a directory that holds results.
    ///
    /// # Errors
    /// [`Error::NoResults`].
    pub fn open(directory: &Path) -> Result<Self> {
        let results = Self { directory: directory.to_owned() };
        if fs::exists(results.case_path()) {
            Ok(results)
        } else {
            Err(Error::NoResults { path: directory.to_owned() })
        }
    }

    /// The directory.
    pub fn directory(&self) -> &Path {
        &self.directory
    }

    /// Reads the case as it was computed, in SI.
    ///
    /// # Errors
    /// [`Error::File`], also if the file contains no case, or one with keys that are no longer known.
    pub fn case(&self) -> Result<Case> {
        let case = identity::without_digests(&self.case_json()?);
        serde_json::from_value(case).map_err(|error| self.failed(&self.case_path(), error.into()))
    }

    /// Reads `case.json`: the case in SI under the keys of the case file, with the digests of its files and
    /// the `identity` of the run.
    ///
    /// # Errors
    /// [`Error::File`], also if the file contains no case.
    pub fn case_json(&self) -> Result<Value> {
        let path = self.case_path();
        let text = regular::read(&path, "a case", u64::MAX).map_err(|source| self.failed(&path, source))?;
        let case: Value = serde_json::from_slice(&text).map_err(|error| self.failed(&path, error.into()))?;
        match defect_of_case(&case) {
            None => Ok(case),
            Some(defect) => Err(self.damaged(&path, defect)),
        }
    }

    /// Reads the summary, which exists once the computation is complete.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn summary(&self) -> Result<Summary> {
        summary::read(&self.summary_path())
    }

    /// Reads the records of the finished passes; empty if nothing has moved yet.
    ///
    /// # Errors
    /// [`Error::File`], also if their number differs from that in the summary.
    pub fn passes(&self) -> Result<Vec<PassRecord>> {
        let passes = self.passes_there()?;
        self.agree(&self.passes_path(), passes.len(), |summary| match &summary.outcome {
            Outcome::Passes(passes) => Some(passes.len()),
            _ => None,
        })?;
        Ok(passes)
    }

    /// Reads the rows of the table of passes, whatever the summary says.
    pub(super) fn passes_there(&self) -> Result<Vec<PassRecord>> {
        let path = self.passes_path();
        if fs::exists(&path) { tables::read_growing(&path) } else { Ok(Vec::new()) }
    }

    /// Reads the positions of the finished passes.
    ///
    /// # Errors
    /// [`Error::File`], also if positions of a pass are missing.
    pub fn steps(&self) -> Result<Vec<StepRecord>> {
        let path = self.steps_path();
        let finished = self.passes()?.len();
        if finished == 0 {
            return Ok(Vec::new());
        }
        let mut steps: Vec<StepRecord> = tables::read_growing(&path)?;
        steps.retain(|step| step.pass <= finished);
        if has_every_position(&steps, finished) {
            Ok(steps)
        } else {
            Err(self.damaged(&path, "it does not have every position of the finished passes"))
        }
    }

    /// Opens the fields of a motion after `passes` passes; 0 for those before the first.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn fields_after(&self, passes: usize) -> Result<Fields> {
        Fields::open(&self.fields_path(passes))
    }

    /// Opens the fields of an increment that is kept.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn increment_fields(&self, increment: usize) -> Result<Fields> {
        Fields::open(&self.increment_path(increment))
    }

    /// Opens the fields of a static contact.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn static_fields(&self) -> Result<Fields> {
        Fields::open(&self.static_path())
    }

    /// Reads the increments of a static contact loaded in stages; empty for other contacts.
    ///
    /// # Errors
    /// [`Error::File`], also if a finished contact that was loaded in stages has none.
    pub fn increments(&self) -> Result<Vec<IncrementRecord>> {
        let path = self.increments_path();
        let increments = self.rows_at_rest(&path)?;
        if increments.is_empty() && fs::exists(self.summary_path()) && was_loaded_in_stages(&self.summary()?)
        {
            return Err(self.incomplete(&path));
        }
        Ok(increments)
    }

    /// Reads the updates of a contact that slides in place, beginning before it slides; empty for other
    /// contacts.
    ///
    /// # Errors
    /// [`Error::File`], also if their number differs from that in the summary.
    pub fn updates(&self) -> Result<Vec<UpdateRecord>> {
        let path = self.updates_path();
        let updates: Vec<UpdateRecord> = self.rows_at_rest(&path)?;
        self.agree(&path, updates.len(), |summary| Some(summary.sliding.as_ref()?.update + 1))?;
        Ok(updates)
    }

    /// Reads the finished points of a sweep; empty for other contacts.
    ///
    /// # Errors
    /// [`Error::File`], also if their number differs from that in the summary.
    pub fn sweep(&self) -> Result<Vec<SweepRecord>> {
        let points = self.points_there()?;
        self.agree(&self.sweep_path(), points.len(), |summary| match &summary.outcome {
            Outcome::Sweep(points) => Some(points.len()),
            _ => None,
        })?;
        Ok(points)
    }

    /// Reads the rows of the table of a sweep, whatever the summary says.
    pub(super) fn points_there(&self) -> Result<Vec<SweepRecord>> {
        self.rows_at_rest(&self.sweep_path())
    }

    /// Reads the rows of the table of a static contact; only complete rows, if it is still running.
    fn rows_at_rest<T: DeserializeOwned>(&self, path: &Path) -> Result<Vec<T>> {
        match (fs::exists(path), fs::exists(self.summary_path())) {
            (false, _) => Ok(Vec::new()),
            (true, false) => tables::read_growing(path),
            (true, true) => tables::read(path),
        }
    }

    /// Returns an error if the number of `rows` in the table at `path` differs from that in the summary, if
    /// there is one.
    fn agree(&self, path: &Path, rows: usize, told: impl Fn(&Summary) -> Option<usize>) -> Result<()> {
        if !fs::exists(self.summary_path()) {
            return Ok(());
        }
        match told(&self.summary()?) {
            Some(told) if told != rows => Err(self.incomplete(path)),
            _ => Ok(()),
        }
    }

    /// Opens the kept fields of a point, from 1, of a sweep.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn point_fields(&self, point: usize) -> Result<Fields> {
        Fields::open(&self.point_path(point))
    }

    /// Opens the stress under the surface of a static contact, or of a pass, from 1, of a motion.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn subsurface_fields(&self, pass: Option<usize>) -> Result<Fields> {
        Fields::open(&self.subsurface_path(pass))
    }

    /// Reads the surfaces after `passes` passes.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn surfaces_after(&self, passes: usize) -> Result<[Topography; 2]> {
        Self::surfaces_of(&self.fields_after(passes)?)
    }

    /// Reads the surfaces of a static contact.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn static_surfaces(&self) -> Result<[Topography; 2]> {
        Self::surfaces_of(&self.static_fields()?)
    }

    /// Reads the surfaces from a field file.
    fn surfaces_of(fields: &Fields) -> Result<[Topography; 2]> {
        let topography = |name| -> Result<Topography> {
            let stored = fields.read(name)?;
            let pitch = [stored.pitch[0], stored.pitch[1]];
            let heights = stored.into_field().ok_or(Error::Unsupported("a surface that is not a matrix"))?;
            Topography::new(Grid::new([heights.nrows(), heights.ncols()], pitch)?, heights)
        };
        Ok([topography("lower")?, topography("upper")?])
    }

    /// Reads the state of laws on the lower and on the upper body after `passes` passes, by name.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn states_after(&self, passes: usize) -> Result<[BTreeMap<String, State>; 2]> {
        Self::states_of(&self.fields_after(passes)?)
    }

    /// Reads the state of laws on the lower and on the upper body, by name, from a field file.
    pub(super) fn states_of(fields: &Fields) -> Result<[BTreeMap<String, State>; 2]> {
        let attributes = fields.attributes()?;
        let states = |body: &str| {
            let names = match attributes.get(&states_attribute(body)) {
                Some(Attribute::Text(names)) => names.as_str(),
                _ => "",
            };
            let read = |name: &str| {
                let stored = fields.read(&state_name(name, body))?;
                let unit = stored.unit.clone();
                let values = stored.into_field().ok_or(Error::Unsupported("a state that is not a matrix"))?;
                Ok((name.to_owned(), State { unit, values }))
            };
            names.split(',').filter(|name| !name.is_empty()).map(read).collect::<Result<BTreeMap<_, _>>>()
        };
        let [lower, upper] = BODIES.map(states);
        Ok([lower?, upper?])
    }

    fn case_path(&self) -> PathBuf {
        self.directory.join("case.json")
    }

    /// The file of the summary.
    pub fn summary_path(&self) -> PathBuf {
        self.directory.join("summary.json")
    }

    /// Reads the state in which the pass after `passes` passes begins.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn warm_start_after(&self, passes: usize) -> Result<WarmStart> {
        WarmStart::restore(&Stored::open(&self.state_path(passes))?)
    }

    fn passes_path(&self) -> PathBuf {
        self.directory.join("passes.csv")
    }

    fn steps_path(&self) -> PathBuf {
        self.directory.join("steps.csv")
    }

    pub(super) fn increments_path(&self) -> PathBuf {
        self.directory.join("increments.csv")
    }

    pub(super) fn updates_path(&self) -> PathBuf {
        self.directory.join("updates.csv")
    }

    pub(super) fn sweep_path(&self) -> PathBuf {
        self.directory.join("sweep.csv")
    }

    /// Path of the table of an observer.
    pub(crate) fn observer_table(&self, name: &str) -> PathBuf {
        self.directory.join(format!("{name}.csv"))
    }

    /// Path of the fields of an observer in a pass, or at a point.
    pub(crate) fn observer_fields(&self, name: &str, step: usize) -> PathBuf {
        self.fields_folder().join(format!("{name}-{step:04}.h5"))
    }

    /// Reads the rows of a capability; empty if it was not requested.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn rows<C: Capability>(&self) -> Result<Vec<C::Row>> {
        self.observed(C::NAME)
    }

    /// Reads the rows of all capabilities.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn observations(&self) -> Result<Observations> {
        let mut found = Observations::default();
        each!(capability C => C::add(&mut found, self.rows::<C>()?));
        Ok(found)
    }

    /// Opens the fields of the capability of this `name`, of the positions of a pass or at a point that are
    /// kept.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn observed_fields(&self, name: &str, step: usize) -> Result<Fields> {
        Fields::open(&self.observer_fields(name, step))
    }

    /// Reads the limits of the model that the results exceed, in the order of their steps; empty if there are
    /// none.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn broken_limits(&self) -> Result<Vec<BrokenLimit>> {
        self.observed(LIMITS_TABLE)
    }

    /// Reads the rows of an observer; empty if there are none.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(crate) fn observed<T: DeserializeOwned>(&self, name: &str) -> Result<Vec<T>> {
        let path = self.observer_table(name);
        if fs::exists(&path) { tables::read_growing(&path) } else { Ok(Vec::new()) }
    }

    /// The file of the fields of an increment that is kept.
    pub fn increment_path(&self, increment: usize) -> PathBuf {
        self.fields_folder().join(format!("increment-{increment:04}.h5"))
    }

    /// The file of the fields of a point of a sweep that is kept.
    pub fn point_path(&self, point: usize) -> PathBuf {
        self.fields_folder().join(format!("point-{point:04}.h5"))
    }

    /// The file of the fields of a static contact.
    pub fn static_path(&self) -> PathBuf {
        self.directory.join("fields.h5")
    }

    /// The folder of the figures.
    pub fn figures_folder(&self) -> PathBuf {
        self.directory.join("figures")
    }

    pub(crate) fn fields_folder(&self) -> PathBuf {
        self.directory.join("fields")
    }

    fn fields_path(&self, passes: usize) -> PathBuf {
        let name = if passes == 0 { "initial.h5".to_owned() } else { format!("pass-{passes:04}.h5") };
        self.fields_folder().join(name)
    }

    /// Path of the state from which a run continues after `steps` steps.
    fn state_path(&self, steps: usize) -> PathBuf {
        self.fields_folder().join(format!("state-{steps:04}.h5"))
    }

    /// Returns the number of the last step with a state and a row; there are `rows` rows, the first with the
    /// number `first`. `None` if there is no state.
    ///
    /// # Errors
    /// [`Error::NotResumable`] if rows up to the state are missing in `table`.
    pub(super) fn last_state(&self, rows: usize, first: usize, table: &Path) -> Result<Option<usize>> {
        let Ok(entries) = fs::read_dir(self.fields_folder()) else { return Ok(None) };
        let number = |entry: std::io::Result<fs::DirEntry>| {
            let name = entry.ok()?.file_name().into_string().ok()?;
            name.strip_prefix("state-")?.strip_suffix(".h5")?.parse::<usize>().ok()
        };
        let states: Vec<usize> = entries.filter_map(number).collect();
        let last = states.iter().copied().filter(|state| *state < rows + first).max();
        match last {
            None if rows > 0 && !states.is_empty() => {
                let reason = "does not have the rows of all that is done";
                Err(Error::NotResumable { path: table.to_owned(), reason })
            }
            last => Ok(last),
        }
    }

    /// Reads the interrupted loading of the `pair` in this number of `stages`, if there is one.
    ///
    /// # Errors
    /// [`Error::File`] for unreadable files, [`Error::NotResumable`] if they do not fit together.
    pub(super) fn loading_under_way(&self, pair: &Pair, stages: usize) -> Result<Option<LoadingState>> {
        let (rows, table) = (self.increments()?, self.increments_path());
        self.under_way(pair, rows, 1, &table, |from, rows| {
            let state = LoadingState::restore(from, pair, rows)?;
            if state.next.stage < stages { Ok(state) } else { Err(from.of_another_contact()) }
        })
    }

    /// Reads the finished points of a sweep of the `pair`; none if it has not begun.
    ///
    /// # Errors
    /// [`Error::File`] for unreadable files, [`Error::NotResumable`] if they do not fit together.
    pub(super) fn sweep_under_way(&self, pair: &Pair) -> Result<SweepState> {
        let (rows, table) = (self.sweep()?, self.sweep_path());
        let state =
            self.under_way(pair, rows.clone(), 1, &table, |from, rows| SweepState::restore(from, rows))?;
        Ok(state.unwrap_or(SweepState { records: rows, ..SweepState::default() }))
    }

    /// Reads the interrupted contact of the `pair` that slides in place, if there is one.
    ///
    /// # Errors
    /// [`Error::File`] for unreadable files, [`Error::NotResumable`] if they do not fit together.
    pub(super) fn sliding_under_way(&self, pair: &Pair) -> Result<Option<SlidingState>> {
        let (rows, table) = (self.updates()?, self.updates_path());
        self.under_way(pair, rows, 0, &table, |from, rows| SlidingState::restore(from, pair, rows))
    }

    /// Restores the last state of an interrupted course of the `pair`, if there is one. It has the `rows` of
    /// a `table`, which are counted from `first`.
    fn under_way<T: Record, S>(
        &self,
        pair: &Pair,
        mut rows: Vec<T>,
        first: usize,
        table: &Path,
        restore: impl FnOnce(&Stored, Vec<T>) -> Result<S>,
    ) -> Result<Option<S>> {
        let Some(done) = self.last_state(rows.len(), first, table)? else { return Ok(None) };
        let stored = Stored::open(&self.state_path(done))?;
        if stored.holds("pressure") && stored.field("pressure")?.shape() != pair.lower_grid().shape {
            return Err(stored.of_another_contact());
        }
        rows.truncate(done + 1 - first);
        stored.has_rows(&tables::digest("", &rows), table)?;
        restore(&stored, rows).map(Some)
    }

    /// Removes a file if it exists.
    pub(super) fn remove(&self, path: &Path) -> Result<()> {
        match fs::remove_file(path) {
            Err(source) if source.kind() != ErrorKind::NotFound => {
                Err(Error::File { path: path.to_owned(), source })
            }
            _ => Ok(()),
        }
    }

    /// Removes the states of a finished static contact but that after the step `kept`, and their folder if it
    /// is then empty.
    pub(super) fn remove_states(&self, kept: Option<usize>) -> Result<()> {
        let Ok(entries) = fs::read_dir(self.fields_folder()) else { return Ok(()) };
        let states = entries.filter_map(|entry| Some(entry.ok()?.path()));
        let kept = kept.map(|step| self.state_path(step));
        for path in states.filter(|path| is_state(path) && Some(path) != kept.as_ref()) {
            self.remove(&path)?;
        }
        let _ = fs::remove_dir(self.fields_folder());
        Ok(())
    }

    /// Opens the plastic state below the surfaces, of a static contact, or after a pass, from 1, of a motion.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn plastic_fields(&self, pass: Option<usize>) -> Result<Fields> {
        Fields::open(&self.volume_path(pass))
    }

    /// Reads the plastic state of the elasto-plastic bodies, lower one first, after `passes` passes.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(super) fn plastic_states_after(&self, passes: usize) -> Result<Vec<PlasticState>> {
        let fields = self.plastic_fields(Some(passes))?;
        let attributes = fields.attributes()?;
        let flows = |body: &str| attributes.contains_key(&depths_attribute(body));
        let layers = |name: &str| -> Result<VolumeField> {
            let values = fields.read(name)?.values.into_dimensionality::<ndarray::Ix3>();
            let values = values.map_err(|_| Error::Unsupported("a volume that has no layers"))?;
            Ok(values.permuted_axes([2, 0, 1]).as_standard_layout().into_owned())
        };
        let tensor = |name: &str, body: &str| -> Result<TensorField> {
            let components = Component::ALL.map(|component| layers(&tensor_name(name, component, body)));
            let components = components.into_iter().collect::<Result<Vec<_>>>()?;
            let views: Vec<_> = components.iter().map(|values| values.view()).collect();
            Ok(ndarray::stack(ndarray::Axis(1), &views).expect("components of one shape"))
        };
        let names = fields.names()?;
        let state = |body: &str| {
            let kinematic = names.contains(&tensor_name("back_stress", Component::Xx, body));
            Ok(PlasticState {
                strain: tensor("strain", body)?,
                accumulated: layers(&state_name("accumulated", body))?,
                back_stress: kinematic.then(|| tensor("back_stress", body)).transpose()?,
            })
        };
        BODIES.into_iter().filter(|body| flows(body)).map(state).collect()
    }

    fn volume_path(&self, pass: Option<usize>) -> PathBuf {
        match pass {
            None => self.directory.join("plasticity.h5"),
            Some(pass) => self.fields_folder().join(format!("plasticity-{pass:04}.h5")),
        }
    }

    fn subsurface_path(&self, pass: Option<usize>) -> PathBuf {
        match pass {
            None => self.directory.join("subsurface.h5"),
            Some(pass) => self.fields_folder().join(format!("subsurface-{pass:04}.h5")),
        }
    }

    fn failed(&self, path: &Path, source: std::io::Error) -> Error {
        Error::File { path: path.to_owned(), source }
    }

    fn damaged(&self, path: &Path, what: &str) -> Error {
        self.failed(path, std::io::Error::new(ErrorKind::InvalidData, what))
    }

    /// Error for a missing table, or one that differs from the summary.
    fn incomplete(&self, path: &Path) -> Error {
        if fs::exists(path) {
            self.damaged(path, "it is damaged: its rows are not those in summary.json")
        } else {
            self.failed(path, std::io::Error::new(ErrorKind::NotFound, "is missing"))
        }
    }
}

/// Returns the defect of a JSON value that is not a case, as far as the readers of results need it; `None`
/// for a case.
fn defect_of_case(case: &Value) -> Option<&'static str> {
    let Some(case) = case.as_object() else { return Some("holds no case, expected an object") };
    let is_text = |key: &str| case.get(key).is_none_or(Value::is_string);
    let is_table = |key: &str| case.get(key).is_none_or(|table| table.is_object() || table.is_null());
    match case.get("motion") {
        _ if !is_text("title") => Some("holds no case: 'title' is no text"),
        _ if !is_text("identity") => Some("holds no case: 'identity' is no text"),
        None | Some(Value::Null) => {
            let tables =
                ["lower", "upper", "contact", "friction", "sliding", "plasticity", "subsurface", "output"];
            tables.into_iter().any(|key| !is_table(key)).then_some("holds no case: a table is none")
        }
        Some(motion) => {
            let passes = motion.get("passes").and_then(Value::as_u64);
            passes
                .is_none_or(|passes| passes == 0)
                .then_some("holds no case: the number of passes is missing")
        }
    }
}

/// Whether the summary describes a contact with a row for each increment of its loading.
fn was_loaded_in_stages(summary: &Summary) -> bool {
    let Outcome::Static(record) = &summary.outcome else { return false };
    let has_history =
        summary.case.get("history").and_then(Value::as_array).is_some_and(|stages| !stages.is_empty());
    let rubs = record.shear.as_ref().is_some_and(|shear| shear.creepage.is_none());
    summary.sliding.is_none() && (record.plastic.is_some() || rubs || has_history)
}

/// Whether `passes` passes have the same positions each.
pub(super) fn has_every_position(steps: &[StepRecord], passes: usize) -> bool {
    let positions = steps.len() / passes;
    let expected = (1..=passes).flat_map(|pass| (1..=positions).map(move |step| (pass, step)));
    positions > 0 && steps.iter().map(|step| (step.pass, step.step)).eq(expected)
}

/// Whether a file contains the state of a course.
fn is_state(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("state-"))
}

/// Names of the bodies in the fields of their heights.
pub(crate) const BODIES: [&str; 2] = ["lower", "upper"];

/// Name of the field of a state of a body.
pub(crate) fn state_name(state: &str, body: &str) -> String {
    format!("{state}_{body}")
}

/// Name of a component of a tensor in the layers of a body.
fn tensor_name(tensor: &str, component: Component, body: &str) -> String {
    state_name(&format!("{tensor}_{}", component.name()), body)
}

/// Name of the attribute with the depths of the layer faces of an elasto-plastic body.
fn depths_attribute(body: &str) -> String {
    format!("depths_{body}")
}

/// Name of the attribute that lists the states of a body.
fn states_attribute(body: &str) -> String {
    format!("states_{body}")
}

/// Name of the pressure field of a position, counted from 1.
pub fn pressure_name(step: usize) -> String {
    format!("pressure_{step:05}")
}

/// Name of the field with the pressure caps at a position, counted from 1; written if they differ from cell
/// to cell.
pub fn cap_name(step: usize) -> String {
    format!("cap_{step:05}")
}

/// Name of the surface temperature in contact at a position, counted from 1; written if it is computed.
pub fn temperature_name(step: usize) -> String {
    format!("temperature_{step:05}")
}

/// Name of the shear traction along x at a position, counted from 1.
pub fn traction_name(step: usize) -> String {
    format!("traction_x_{step:05}")
}

/// Whether the first of some steps or points, that of number 1, and every n-th after it include a number;
/// with n = 0 none.
pub(crate) fn is_nth(number: usize, n: usize) -> bool {
    n > 0 && (number + n - 1).is_multiple_of(n)
}

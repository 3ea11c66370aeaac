//! Entry of a run into a results directory: accepted content, clearing, and the lock against other runs.

use std::ffi::OsStr;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::kept_contacts::KeptContacts;
use super::state::{ALTERED, ROWS};
use super::{Results, has_every_position, is_nth};
use crate::identity;
use crate::io::fields::{Attribute, Fields};
use crate::io::lock::{self, Lock};
use crate::io::{atomic, fs};
use crate::limit::LIMITS_TABLE;
use crate::tables;
use asperity_base::error::{Error, Result};
use asperity_contact::each;
use asperity_contact::motion::{StepRecord, StepRow, SweepRecord};
use asperity_contact::with::Capability;
use asperity_contact::with::plasticity::Keep;
use serde_json::Value;

/// Treatment of existing results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Existing {
    /// Refuse to run.
    Keep,
    /// Replace them.
    Overwrite,
    /// Continue after the last finished pass.
    Resume,
}

/// Name of a case file that may lie beside its own results.
pub(crate) const CASE_FILE: &str = "case.toml";

/// Name of the table of all steps with everything found in them.
pub(crate) const RESULTS_TABLE: &str = "results.csv";

/// Lock file of a run. It stays when the run is over; only its lock shows that a run is active.
const LOCK: &str = ".lock";

/// How long a run waits for another one to finish.
const PATIENCE: Duration = Duration::from_secs(1);

/// Warning for results on a file system without locks.
pub(crate) const NO_LOCKS: &str =
    "the file system of the results has no locks: a second run in their directory would go unnoticed";

/// Takes the lock of a results directory, held while a run writes there.
///
/// # Errors
/// [`Error::InUse`] if another run holds it; [`Error::File`].
fn acquire(directory: &Path) -> Result<Lock> {
    let path = directory.join(LOCK);
    // A process that was just killed may take a moment to disappear.
    let lock = Lock::take(&path, PATIENCE).map_err(|source| Error::File { path, source })?;
    lock.ok_or_else(|| Error::InUse { path: directory.to_owned() })
}

/// Takes the lock of an existing results directory, if it is free.
///
/// # Errors
/// [`Error::File`].
pub(crate) fn try_acquire(directory: &Path) -> Result<Option<Lock>> {
    /// A reader holds it only for a moment.
    const MOMENT: Duration = Duration::from_millis(20);
    let path = directory.join(LOCK);
    Lock::take(&path, MOMENT).map_err(|source| Error::File { path, source })
}

/// Whether a run is writing to a results directory.
pub(crate) fn is_in_use(directory: &Path) -> bool {
    lock::is_taken(&directory.join(LOCK))
}

/// The existing results from which a run continues.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ExistingResults {
    Nothing,
    /// Number of finished passes.
    Passes(usize),
    /// Increments, updates or points of a static contact.
    Steps,
}

/// Locks `directory`, created if missing, for the results of `case`, unless its `lock` is held already.
/// Returns the results to keep. Nothing is cleared yet.
pub(super) fn enter(
    directory: &Path,
    case: &Value,
    existing: Existing,
    lock: Option<Lock>,
) -> Result<(Lock, ExistingResults)> {
    let failed = |source| Error::File { path: directory.to_owned(), source };
    outside_others(directory)?;
    fs::create_dir_all(directory).map_err(|source| {
        failed(if source.kind() == ErrorKind::AlreadyExists {
            ErrorKind::NotADirectory.into()
        } else {
            source
        })
    })?;
    // Also before the lock, so that no lock file is left in an unrelated directory.
    admit(directory, existing)?;
    let lock = lock.map_or_else(|| acquire(directory), Ok)?;
    admit(directory, existing)?;
    let results = Results { directory: directory.to_owned() };
    let kept = match existing {
        Existing::Resume if fs::exists(results.case_path()) => resumable(&results, case)?,
        _ => ExistingResults::Nothing,
    };
    Ok((lock, kept))
}

/// Returns an error if `directory` lies within the results of another run, which are cleared as a whole.
fn outside_others(directory: &Path) -> Result<()> {
    let all = fs::absolute(directory);
    let all = all.map_err(|source| Error::File { path: directory.to_owned(), source })?;
    match all.ancestors().skip(1).find(|folder| fs::exists(folder.join("case.json"))) {
        Some(results) => {
            Err(Error::WithinResults { path: directory.to_owned(), results: results.to_owned() })
        }
        None => Ok(()),
    }
}

/// Returns an error if something in `directory` must be kept.
fn admit(directory: &Path, existing: Existing) -> Result<()> {
    let failed = |source| Error::File { path: directory.to_owned(), source };
    let results = fs::exists(directory.join("case.json"));
    let vacant = is_vacant(directory).map_err(failed)?;
    match existing {
        _ if vacant => Ok(()),
        Existing::Overwrite | Existing::Resume if results => Ok(()),
        _ => Err(Error::ResultsExist { path: directory.to_owned(), results }),
    }
}

/// Whether the directory contains nothing but a case file and the files of a run that ended before its
/// `case.json`.
fn is_vacant(directory: &Path) -> io::Result<bool> {
    for entry in fs::read_dir(directory)? {
        let entry = entry?;
        let name = entry.file_name();
        let left = name == LOCK
            || name == CASE_FILE
            || atomic::is_temporary(&name)
            || name == OsStr::new("fields") && entry.file_type()?.is_dir() && is_vacant(&entry.path())?;
        if !left {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Returns the finished part, if the results belong to `case` and are complete.
fn resumable(results: &Results, case: &Value) -> Result<ExistingResults> {
    identity::compare(results.directory(), &results.case_json()?, case)?;
    let identity = identity::identity_of(case);
    if case.get("motion").is_some_and(Value::is_object) {
        return resumable_passes(results, case, &identity);
    }
    let points = results.points_there()?;
    if !points.is_empty() {
        return kept_points(results, case, &identity, &points);
    }
    for (rows, first, table) in [
        (tables::rows_there(&results.increments_path())?, 1, results.increments_path()),
        (tables::rows_there(&results.updates_path())?, 0, results.updates_path()),
    ] {
        if let Some(state) = results.last_state(rows, first, &table)? {
            whole(&results.state_path(state), &identity, None)?;
            let mut has_interface = false;
            each!(interface I => has_interface |= case.get(I::NAME).is_some_and(Value::is_object));
            let has_stages =
                case.get("history").and_then(Value::as_array).is_some_and(|stages| !stages.is_empty());
            if first == 1 && has_interface && has_stages {
                let every = kept_every(case);
                let increments = results.increments()?;
                let rows = increments.iter().take(state).map(StepRow::Increment);
                whole_contacts(every, rows, |increment| results.increment_path(increment), &identity)?;
            }
            return Ok(ExistingResults::Steps);
        }
    }
    Ok(ExistingResults::Nothing)
}

/// Returns the number of finished passes, if they are complete.
fn resumable_passes(results: &Results, case: &Value, identity: &str) -> Result<ExistingResults> {
    let passes = results.passes_there()?;
    if !passes.iter().map(|pass| pass.pass).eq(1..=passes.len()) {
        let path = results.passes_path();
        return Err(Error::NotResumable { path, reason: "does not number its passes 1, 2, 3 …" });
    }
    if passes.is_empty() {
        return Ok(ExistingResults::Nothing);
    }
    let steps = results.steps_path();
    if !fs::exists(&steps) {
        return Err(Error::NotResumable { path: steps, reason: "is missing" });
    }
    let mut positions: Vec<StepRecord> = tables::read_growing(&steps)?;
    positions.retain(|step| step.pass <= passes.len());
    if !has_every_position(&positions, passes.len()) {
        let reason = "does not have every position of the finished passes";
        return Err(Error::NotResumable { path: steps, reason });
    }
    unlike_summary(results, &passes, &results.passes_path())?;
    for pass in 0..=passes.len() {
        whole(&results.fields_path(pass), identity, Some(pass))?;
        if pass > 0 && case.get("subsurface").is_some() {
            whole(&results.subsurface_path(Some(pass)), identity, Some(pass))?;
        }
    }
    // For elasto-plastic bodies the last pass must have its plastic state; if all passes are kept, every
    // pass.
    match case.pointer("/plasticity/keep").and_then(Value::as_str) {
        Some("passes") => {
            for pass in 1..=passes.len() {
                whole(&results.volume_path(Some(pass)), identity, Some(pass))?;
            }
        }
        Some(_) => whole(&results.volume_path(Some(passes.len())), identity, Some(passes.len()))?,
        None => {}
    }
    // If no pass is left to compute, it is not needed.
    let wanted = case.pointer("/motion/passes").and_then(Value::as_u64);
    if wanted.is_some_and(|wanted| wanted > passes.len() as u64) {
        whole(&results.state_path(passes.len()), identity, Some(passes.len()))?;
    }
    let digest = tables::digest_of_passes(&passes, &positions);
    same_rows(&results.state_path(passes.len()), &digest, &results.passes_path())?;
    Ok(ExistingResults::Passes(passes.len()))
}

/// Checks that the kept fields of each point of a sweep are complete.
fn kept_points(
    results: &Results,
    case: &Value,
    identity: &str,
    points: &[SweepRecord],
) -> Result<ExistingResults> {
    if !points.iter().map(|point| point.point).eq(1..=points.len()) {
        let path = results.sweep_path();
        return Err(Error::NotResumable { path, reason: "does not number its points 1, 2, 3 …" });
    }
    unlike_summary(results, points, &results.sweep_path())?;
    if let Some(done) = results.last_state(points.len(), 1, &results.sweep_path())? {
        same_rows(&results.state_path(done), &tables::digest("", &points[..done]), &results.sweep_path())?;
    }
    let rows = points.iter().map(StepRow::Point);
    whole_contacts(kept_every(case), rows, |point| results.point_path(point), identity)?;
    Ok(ExistingResults::Steps)
}

/// Returns an error unless the fields of these contacts that are kept are undamaged fields of this run. Those
/// of the contact that the answers describe may have been removed for a later one whose row is not written.
fn whole_contacts<'a>(
    every: usize,
    rows: impl ExactSizeIterator<Item = StepRow<'a>>,
    path: impl Fn(usize) -> PathBuf,
    identity: &str,
) -> Result<()> {
    let nth = (1..=rows.len()).filter(|number| is_nth(*number, every)).map(&path);
    let answering = KeptContacts::after(every, rows).0.answering();
    let answering = answering.map(&path).filter(|path| fs::exists(path));
    nth.chain(answering).try_for_each(|path| whole(&path, identity, None))
}

/// Interval of the steps of a case whose fields are kept.
fn kept_every(case: &Value) -> usize {
    case.pointer("/output/pressure_every").and_then(Value::as_u64).unwrap_or(0) as usize
}

/// Returns an error unless `path` holds the undamaged fields of this run; for a motion, those of this pass.
fn whole(path: &Path, identity: &str, pass: Option<usize>) -> Result<()> {
    let refused = |reason| Err(Error::NotResumable { path: path.to_owned(), reason });
    if !fs::exists(path) {
        return refused("is missing");
    }
    let fields = Fields::open(path)?;
    let attributes = fields.attributes()?;
    if attributes.get("identity") != Some(&Attribute::from(identity)) {
        return refused("is of another run");
    }
    if attributes.get("pass") != pass.map(Attribute::from).as_ref() {
        return refused("is of another pass");
    }
    fields.verify()
}

/// Returns an error if the state at `path` was written with rows of another digest: the `table` of these
/// rows, or a table beside it, was then changed since.
fn same_rows(path: &Path, digest: &str, table: &Path) -> Result<()> {
    // A required state has been read in full; others may be missing.
    let Ok(attributes) = Fields::open(path).and_then(|fields| fields.attributes()) else { return Ok(()) };
    match attributes.get(ROWS) {
        Some(written) if *written != Attribute::from(digest) => {
            Err(Error::NotResumable { path: table.to_owned(), reason: ALTERED })
        }
        _ => Ok(()),
    }
}

/// Returns an error if a row of a table differs from the summary of a finished computation.
fn unlike_summary<T: serde::Serialize>(results: &Results, rows: &[T], table: &Path) -> Result<()> {
    // An unreadable summary is written again.
    let Ok(summary) = results.summary() else { return Ok(()) };
    let told = serde_json::to_value(&summary.outcome).expect("a record is JSON");
    let told = told.as_object().and_then(|outcome| outcome.values().next()).and_then(Value::as_array);
    let differs = |(told, row): (&Value, &T)| *told != serde_json::to_value(row).expect("a record is JSON");
    if told.is_some_and(|told| told.iter().zip(rows).any(differs)) {
        Err(Error::NotResumable { path: table.to_owned(), reason: ALTERED })
    } else {
        Ok(())
    }
}

/// Removes the results of an earlier computation, except the kept ones and, for elasto-plastic bodies, the
/// volumes to `keep`. Nothing else is removed.
pub(super) fn clear(results: &Results, kept: ExistingResults, keep: Keep) -> Result<()> {
    let at = |name: &str| results.directory.join(name);
    // They describe the complete results, or are absent.
    results.remove(&at("summary.json"))?;
    results.remove(&at(RESULTS_TABLE))?;
    match kept {
        ExistingResults::Nothing => {
            // Files that mark something as done go first. The file that marks the directory as results is
            // never removed.
            for name in
                ["passes.csv", "steps.csv", "increments.csv", "updates.csv", "sweep.csv", "report.html"]
                    .iter()
                    .chain(&AT_REST)
            {
                results.remove(&at(name))?;
            }
            each!(capability C => results.remove(&results.observer_table(C::NAME))?);
            results.remove(&results.observer_table(LIMITS_TABLE))?;
            let folders = [results.fields_folder(), results.figures_folder()];
            for path in folders.into_iter().filter(|path| fs::exists(path)) {
                fs::remove_dir_all(&path).map_err(|source| Error::File { path, source })?;
            }
            Ok(())
        }
        ExistingResults::Passes(passes) => clear_later(results, passes, keep),
        ExistingResults::Steps => AT_REST.iter().try_for_each(|name| results.remove(&at(name))),
    }
}

/// Files of fields of a static contact.
const AT_REST: [&str; 5] = ["fields.h5", "fields.vti", "subsurface.h5", "subsurface.vti", "plasticity.h5"];

/// Removes the fields of unfinished passes, and the states of all but the last finished one. Volumes that
/// must be kept stay.
fn clear_later(results: &Results, passes: usize, keep: Keep) -> Result<()> {
    let mut names: Vec<_> = (0..=passes).map(|pass| results.fields_path(pass)).collect();
    names.extend((1..=passes).map(|pass| results.subsurface_path(Some(pass))));
    each!(capability C => names.extend((1..=passes).map(|pass| results.observer_fields(C::NAME, pass))));
    names.push(results.state_path(passes));
    let first = if keep == Keep::Last { passes } else { 1 };
    names.extend((first..=passes).map(|pass| results.volume_path(Some(pass))));
    let folder = results.fields_folder();
    let failed = |source| Error::File { path: folder.clone(), source };
    for entry in fs::read_dir(&folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let name = path.to_string_lossy();
        let of = name.strip_suffix("-upper.vti").or(name.strip_suffix(".vti")).or(name.strip_suffix(".h5"));
        if of.is_some_and(|of| !names.contains(&PathBuf::from(format!("{of}.h5")))) {
            results.remove(&path)?;
        }
    }
    Ok(())
}

//! The directory of a study: its plan and the states of its cases.

use std::collections::{HashMap, VecDeque};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use super::files::Files;
use super::plan::Study;
use crate::io::{atomic, fs, regular};
use crate::results::is_in_use;
use asperity_base::error::{Error, Result};

/// The directory of a study.
#[derive(Debug, Clone)]
pub struct Folder {
    path: PathBuf,
}

/// State of a case.
#[derive(Debug, Clone, PartialEq)]
pub enum State {
    /// No process computes it.
    Open,
    /// A process computes it.
    Running,
    /// It failed, for this reason.
    Failed(String),
    /// It has results.
    Done,
}

/// Number of cases of a study in each state.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    /// Cases with results.
    pub done: usize,
    /// Failed cases.
    pub failed: usize,
    /// Cases being computed.
    pub running: usize,
    /// Cases without results that no process computes.
    pub open: usize,
}

impl Tally {
    /// Counts cases by state.
    pub fn from_states<'s>(states: impl IntoIterator<Item = &'s State>) -> Self {
        let mut tally = Self::default();
        for state in states {
            *match state {
                State::Done => &mut tally.done,
                State::Failed(_) => &mut tally.failed,
                State::Running => &mut tally.running,
                State::Open => &mut tally.open,
            } += 1;
        }
        tally
    }

    /// Total number of cases.
    pub fn all(self) -> usize {
        self.done + self.failed + self.left()
    }

    /// Number of unfinished cases.
    pub fn left(self) -> usize {
        self.running + self.open
    }
}

/// Content of `study.json`.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Identity {
    version: String,
    title: String,
    /// Digest of the part shared by all cases.
    digest: String,
}

/// Content of `failed.json`.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct FailedCase {
    pub(super) version: String,
    pub(super) message: String,
}

impl Folder {
    /// Numbers the cases of a study like the plan stored in the directory `path`: its cases first, all others
    /// after them. A study may so have further values on any axis, and finished cases keep their numbers.
    /// Without a stored plan, or with one of other axes, the study stays as it is.
    ///
    /// # Errors
    /// [`Error::File`] if the stored plan cannot be read.
    pub fn number(path: &Path, study: Study) -> Result<Study> {
        let there = Self { path: path.to_owned() }.plan()?;
        Ok(match order(&there, &study.csv(), study.len()) {
            Some(order) => study.in_order(&order),
            None => study,
        })
    }

    /// Opens the directory of a study with its plan; creates it if missing.
    ///
    /// The study may have more cases than when it was begun, after all others: [`Folder::number`] numbers
    /// them so.
    ///
    /// # Errors
    /// [`Error::NotThisStudy`] if the directory contains another study, or other files;
    /// [`Error::SurfaceChanged`] if finished cases were computed from other file contents; [`Error::File`].
    pub fn enter(path: &Path, study: &Study) -> Result<Self> {
        let failed = |source| Error::File { path: path.to_owned(), source };
        let folder = Self { path: path.to_owned() };
        fs::create_dir_all(path).map_err(|source| {
            failed(match source.kind() {
                ErrorKind::AlreadyExists => ErrorKind::NotADirectory.into(),
                _ => source,
            })
        })?;
        // Nothing is removed, because other processes may work here. The first file they write identifies the
        // study, so it is checked last.
        if !is_empty(path).map_err(failed)? && !fs::exists(folder.identity_path()) {
            return Err(Error::NotThisStudy {
                path: path.to_owned(),
                what: "is not empty, and holds no study of asperity",
            });
        }
        let identity = Identity {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            title: study.title().to_owned(),
            digest: study.digest(),
        };
        let text = serde_json::to_vec_pretty(&identity).expect("texts can be written");
        // If several processes begin one study, the first one writes it.
        atomic::create(&folder.identity_path(), &text)?;
        folder.admit(study)?;
        Files::keep(&folder.files_path(), study)?;
        Ok(folder)
    }

    /// Opens the directory of a study that has been begun.
    ///
    /// # Errors
    /// [`Error::NotThisStudy`] if the directory contains another study, or none; [`Error::File`].
    pub fn open(path: &Path, study: &Study) -> Result<Self> {
        let folder = Self { path: path.to_owned() };
        if !fs::exists(folder.identity_path()) {
            return Err(Error::NotThisStudy { path: path.to_owned(), what: "holds no study of asperity" });
        }
        folder.admit(study)?;
        Ok(folder)
    }

    /// The directory.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The folder of a case, from 1; it exists once a process has begun the case.
    pub fn case(&self, case: usize) -> PathBuf {
        self.path.join("cases").join(format!("{case:04}"))
    }

    /// Returns the state of each case, in order.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn states(&self, study: &Study) -> Result<Vec<State>> {
        let state = |case: usize| match self.failure(case)? {
            _ if self.is_done(case) => Ok(State::Done),
            _ if is_in_use(&self.case(case)) => Ok(State::Running),
            failure => Ok(failure.map_or(State::Open, State::Failed)),
        };
        (1..=study.len()).map(state).collect()
    }

    /// Whether the results of a case exist.
    pub fn is_done(&self, case: usize) -> bool {
        fs::exists(self.case(case).join("summary.json"))
    }

    /// Returns the reason of the failure, if the case failed.
    ///
    /// # Errors
    /// [`Error::File`] if it cannot be read.
    pub fn failure(&self, case: usize) -> Result<Option<String>> {
        let path = self.failure_path(case);
        let failed = |source| Error::File { path: path.clone(), source };
        match regular::read(&path, "the failure of a case", u64::MAX) {
            Ok(text) => {
                let told: FailedCase = serde_json::from_slice(&text).map_err(|error| failed(error.into()))?;
                Ok(Some(told.message))
            }
            Err(error) if is_missing(&error) => Ok(None),
            Err(source) => Err(failed(source)),
        }
    }

    /// Returns the time of a failure, by the clock of the file system; `None` without failure.
    pub(super) fn failed_at(&self, case: usize) -> Option<SystemTime> {
        fs::metadata(self.failure_path(case)).and_then(|about| about.modified()).ok()
    }

    pub(super) fn failure_path(&self, case: usize) -> PathBuf {
        self.case(case).join("failed.json")
    }

    /// Whether the stored plan has more cases than `study`, whose file is then older.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn has_grown(&self, study: &Study) -> Result<bool> {
        let (there, ours) = (self.plan()?, study.csv());
        Ok(there.len() > ours.len() && there.starts_with(&ours))
    }

    /// Reads the stored plan; empty before it is written.
    fn plan(&self) -> Result<String> {
        let path = self.path.join("plan.csv");
        let text = match regular::read(&path, "the plan of a study", u64::MAX) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(String::new()),
            text => text.and_then(|text| {
                String::from_utf8(text).map_err(|error| io::Error::new(ErrorKind::InvalidData, error))
            }),
        };
        text.map_err(|source| Error::File { path, source })
    }

    /// Path of the digests of the files named in the study.
    pub(super) fn files_path(&self) -> PathBuf {
        self.path.join("files.json")
    }

    fn identity_path(&self) -> PathBuf {
        self.path.join("study.json")
    }

    /// Returns an error unless the directory belongs to this study. Then stores the longer of its plan and
    /// the stored one.
    fn admit(&self, study: &Study) -> Result<()> {
        let (identity, plan) = (self.identity_path(), self.path.join("plan.csv"));
        let other = |what| Error::NotThisStudy { path: self.path.clone(), what };
        let failed = |path: &Path, source| Error::File { path: path.to_owned(), source };
        let text =
            regular::read(&identity, "a study", u64::MAX).map_err(|source| failed(&identity, source))?;
        let known: Identity =
            serde_json::from_slice(&text).map_err(|error| failed(&identity, error.into()))?;
        if known.digest != study.digest() {
            return Err(other("holds another study: its base or the keys of its axes differ"));
        }
        let there = self.plan()?;
        let ours = study.csv();
        if there.starts_with(&ours) {
            return Ok(());
        }
        if !ours.starts_with(&there) {
            return Err(other("holds another study: cases of its plan have other values"));
        }
        atomic::replace(&plan, ours.as_bytes())
    }
}

/// Returns the cases of a plan, from 0, in the order of a stored one: its cases first, then all others.
/// `None` if they have that order already, or if the plans have other axes.
fn order(stored: &str, ours: &str, cases: usize) -> Option<Vec<usize>> {
    if stored.is_empty() || ours.starts_with(stored) || stored.starts_with(ours) {
        return None;
    }
    let (mut stored, mut ours) = (stored.lines(), ours.lines());
    if stored.next() != ours.next() {
        return None;
    }
    let mut places: HashMap<&str, VecDeque<usize>> = HashMap::new();
    let mut rows = 0;
    for (n, row) in ours.enumerate() {
        places.entry(values(row)).or_default().push_back(n);
        rows += 1;
    }
    // A text with line breaks is no row.
    if rows != cases {
        return None;
    }
    let mut order: Vec<usize> = stored.filter_map(|row| places.get_mut(values(row))?.pop_front()).collect();
    let mut others: Vec<usize> = places.into_values().flatten().collect();
    others.sort_unstable();
    order.extend(others);
    Some(order)
}

/// The values of a row of a plan, without the number of the case.
fn values(row: &str) -> &str {
    row.split_once(',').map_or("", |(_, values)| values)
}

/// Whether an error means that the file does not exist.
pub(super) fn is_missing(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory)
}

/// Whether a directory contains nothing but files being written.
fn is_empty(path: &Path) -> io::Result<bool> {
    for entry in fs::read_dir(path)? {
        if !atomic::is_temporary(&entry?.file_name()) {
            return Ok(false);
        }
    }
    Ok(true)
}

#[cfg(test)]
mod tests {
    use std::thread;

    use super::*;

    #[test]
    fn a_plan_that_grew_on_any_axis_keeps_the_numbers_of_its_cases() {
        let study = |loads: &str, seeds: usize| {
            let text = format!(
                "[base]\nlower = {{ young = 1e9, poisson = 0, topography = {{ generate = \"low-pass\", sq = 1e-8, cutoff = 4e-6, seed = 1, shape = [8, 8], pitch = 1e-6 }} }}\n\
                 upper = {{ young = inf, poisson = 0, topography = {{ form = \"flat\" }} }}\ncontact = {{ load = 1 }}\n\
                 [axes]\n\"contact.load\" = [{loads}]\n\"lower.topography.seed\" = {{ seeds = {seeds} }}\n"
            );
            Study::parse(&text, Path::new("study.toml")).unwrap()
        };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("study");
        let enter = |study: Study| -> Result<(String, bool)> {
            let study = Folder::number(&path, study)?;
            let folder = Folder::enter(&path, &study)?;
            Ok((study.csv(), folder.has_grown(&study)?))
        };
        let begun = enter(study("1, 2", 2)).unwrap().0;
        // A third seed, then a load between the others.
        let grown = enter(study("1, 2", 3)).unwrap().0;
        assert!(grown.starts_with(&begun) && grown.ends_with("0005,1.0,3\n0006,2.0,3\n"), "{grown}");
        let (again, _) = enter(study("1, 1.5, 2", 3)).unwrap();
        assert!(
            again.starts_with(&grown) && again.ends_with("0007,1.5,1\n0008,1.5,2\n0009,1.5,3\n"),
            "{again}"
        );
        // Older files are still files of this study; one with other values is not.
        assert_eq!(enter(study("1, 2", 2)).unwrap(), (begun, true));
        assert_eq!(enter(study("2, 1", 3)).unwrap(), (grown, true));
        assert!(matches!(enter(study("1, 3", 2)), Err(Error::NotThisStudy { .. })));
        assert_eq!(enter(study("1, 1.5, 2", 3)).unwrap(), (again, false));
    }

    #[test]
    fn many_processes_may_begin_a_study_at_the_same_time() {
        let text = "[base]\nlower = { young = 1e9, poisson = 0, topography = { form = \"flat\", shape = [4, 4], pitch = 1e-6 } }\n\
                    upper = { young = inf, poisson = 0, topography = { form = \"flat\" } }\ncontact = { load = 1 }\n\
                    [axes]\n\"contact.load\" = [1, 2]\n";
        let study = Study::parse(text, Path::new("study.toml")).unwrap();
        let folder = tempfile::tempdir().unwrap();
        for round in 0..40 {
            let path = folder.path().join(round.to_string());
            thread::scope(|scope| {
                for _ in 0..8 {
                    scope.spawn(|| Folder::enter(&path, &study).unwrap());
                }
            });
            let names = fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().file_name());
            let mut names: Vec<_> = names.collect();
            names.sort();
            assert_eq!(names, ["plan.csv", "study.json"]);
            assert_eq!(study.axes()[0].label(), "contact.load (N)");
        }
        let folder = Folder::open(&folder.path().join("0"), &study).unwrap();
        assert_eq!(folder.states(&study).unwrap(), [State::Open, State::Open]);
    }
}

//! The directory of a study: its plan and the states of its cases.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use super::files::Files;
use super::plan::Study;
use crate::error::{Error, Result};
use crate::io::{atomic, regular};
use crate::study::results::is_in_use;

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
    pub fn of<'s>(states: impl IntoIterator<Item = &'s State>) -> Self {
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
    /// Opens the directory of a study with its plan; creates it if missing.
    ///
    /// The study may have more cases than when it was begun, after all others.
    ///
    /// # Errors
    /// [`Error::NotThisStudy`] if the directory contains another study, or other files; [`Error::SurfaceChanged`] if
    /// finished cases were computed from other file contents; [`Error::File`].
    pub fn enter(path: &Path, study: &Study) -> Result<Self> {
        let failed = |source| Error::File { path: path.to_owned(), source };
        let folder = Self { path: path.to_owned() };
        fs::create_dir_all(path).map_err(|source| {
            failed(match source.kind() {
                ErrorKind::AlreadyExists => ErrorKind::NotADirectory.into(),
                _ => source,
            })
        })?;
        // Nothing is removed, because other processes may work here. The first file they write identifies the study, so it
        // is checked last.
        if !is_empty(path).map_err(failed)? && !folder.identity_path().exists() {
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
        let done = |case| folder.is_done(case).then(|| folder.case(case));
        Files::keep(&folder.files_path(), study, &done)?;
        Ok(folder)
    }

    /// Opens the directory of a study that has been begun.
    ///
    /// # Errors
    /// [`Error::NotThisStudy`] if the directory contains another study, or none; [`Error::File`].
    pub fn open(path: &Path, study: &Study) -> Result<Self> {
        let folder = Self { path: path.to_owned() };
        if !folder.identity_path().exists() {
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
        self.case(case).join("summary.json").exists()
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
        let there = self.plan()?;
        let is_longer = |ours: String| there.len() > ours.len() && there.starts_with(&ours);
        Ok(is_longer(study.csv()) || is_longer(study.unguarded_csv()))
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

    /// Returns an error unless the directory belongs to this study. Then stores the longer of its plan and the stored one.
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
        let (ours, before) = (study.csv(), study.unguarded_csv());
        if there.starts_with(&ours)
            || ours != before && there.len() > before.len() && there.starts_with(&before)
        {
            return Ok(());
        }
        if !ours.starts_with(&there) && !before.starts_with(&there) {
            return Err(other("holds another study: cases of its plan have other values"));
        }
        atomic::replace(&plan, ours.as_bytes())
    }
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

//! What is there of a study: its directory and its cases.

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

/// How a case stands.
#[derive(Debug, Clone, PartialEq)]
pub enum State {
    /// Nobody computes it.
    Open,
    /// A process computes it.
    Running,
    /// It has no results, for this reason.
    Failed(String),
    /// Its results are there.
    Done,
}

/// How many cases of a study stand how.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    /// Their results are there.
    pub done: usize,
    /// They have no results, and a reason.
    pub failed: usize,
    /// Processes compute them.
    pub running: usize,
    /// Nobody computes them.
    pub open: usize,
}

impl Tally {
    /// Counts cases.
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

    /// How many there are.
    pub fn all(self) -> usize {
        self.done + self.failed + self.left()
    }

    /// How many are not over.
    pub fn left(self) -> usize {
        self.running + self.open
    }
}

/// What `study.json` says.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Identity {
    version: String,
    title: String,
    /// Of what all cases share.
    digest: String,
}

/// What `failed.json` says.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Failed {
    pub(super) version: String,
    pub(super) message: String,
}

impl Folder {
    /// The directory of a study, made where it is missing, with its plan.
    ///
    /// A study may have grown since it was begun: cases that come after all others.
    ///
    /// # Errors
    /// [`Error::NotThisStudy`] if there is another study, or something else; [`Error::SurfaceChanged`] if finished cases were computed
    /// from other contents of a file; [`Error::File`].
    pub fn enter(path: &Path, study: &Study) -> Result<Self> {
        let failed = |source| Error::File { path: path.to_owned(), source };
        let folder = Self { path: path.to_owned() };
        fs::create_dir_all(path).map_err(|source| {
            failed(match source.kind() {
                ErrorKind::AlreadyExists => ErrorKind::NotADirectory.into(),
                _ => source,
            })
        })?;
        // Nothing is swept: others may be at work here. What they make first says that it is a study: it is looked for last.
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
        // Of several processes that begin one study the first writes.
        atomic::create(&folder.identity_path(), &text)?;
        folder.admit(study)?;
        let done = |case| folder.is_done(case).then(|| folder.case(case));
        Files::keep(&folder.files_path(), study, &done)?;
        Ok(folder)
    }

    /// The directory of a study that has been begun.
    ///
    /// # Errors
    /// [`Error::NotThisStudy`] if there is another study, or none; [`Error::File`].
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

    /// The folder of a case, from 1, which is there once a process has had it.
    pub fn case(&self, case: usize) -> PathBuf {
        self.path.join("cases").join(format!("{case:04}"))
    }

    /// How each case stands, in their order.
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

    /// Whether the results of a case are there.
    pub fn is_done(&self, case: usize) -> bool {
        self.case(case).join("summary.json").exists()
    }

    /// Why a case has no results, if it failed.
    ///
    /// # Errors
    /// [`Error::File`] if that cannot be read.
    pub fn failure(&self, case: usize) -> Result<Option<String>> {
        let path = self.failure_path(case);
        let failed = |source| Error::File { path: path.clone(), source };
        match regular::read(&path, "the failure of a case", u64::MAX) {
            Ok(text) => {
                let told: Failed = serde_json::from_slice(&text).map_err(|error| failed(error.into()))?;
                Ok(Some(told.message))
            }
            Err(error) if is_missing(&error) => Ok(None),
            Err(source) => Err(failed(source)),
        }
    }

    /// When a case failed, by the clock of the file system; none where it did not.
    pub(super) fn failed_at(&self, case: usize) -> Option<SystemTime> {
        fs::metadata(self.failure_path(case)).and_then(|about| about.modified()).ok()
    }

    pub(super) fn failure_path(&self, case: usize) -> PathBuf {
        self.case(case).join("failed.json")
    }

    /// Whether the plan that is there has cases beyond those of `study`: its file is an older one.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn has_grown(&self, study: &Study) -> Result<bool> {
        let there = self.plan()?;
        let is_longer = |ours: String| there.len() > ours.len() && there.starts_with(&ours);
        Ok(is_longer(study.csv()) || is_longer(study.unguarded_csv()))
    }

    /// The plan that is there; nothing before it is written.
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

    /// The digests of the files that the study names.
    pub(super) fn files_path(&self) -> PathBuf {
        self.path.join("files.json")
    }

    fn identity_path(&self) -> PathBuf {
        self.path.join("study.json")
    }

    /// An error unless the directory is that of this study; then its plan is the longer one of those that were made.
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

/// Whether an error says that there is no such file.
pub(super) fn is_missing(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory)
}

/// Whether nothing is in a directory but files that are being written.
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

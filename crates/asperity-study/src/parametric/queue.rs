//! The remaining cases of a study for one process, which takes and computes them one after the other.
//!
//! A process owns a case as long as it holds the lock of its results folder, which ends with the process.

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::SystemTime;

use super::files::Files;
use super::folder::{FailedCase, Folder};
use super::plan::Study;
use crate::case::Case;
use crate::io::lock::Lock;
use crate::io::{atomic, fs, regular};
use crate::results::{CASE_FILE, Existing, try_acquire};
use crate::run::run_with;
use crate::surface_input::SurfaceInput;
use asperity_base::error::{Error, Result};
use asperity_contact::motion::Watch;

/// The cases of a process: every `of`-th, from the `number`-th on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Task {
    /// Number of the task, from 1.
    pub number: usize,
    /// Number of tasks that share the study.
    pub of: usize,
}

impl Task {
    /// All cases.
    pub const ALL: Self = Self { number: 1, of: 1 };

    /// Whether a case, from 1, belongs to the task.
    pub fn has(self, case: usize) -> bool {
        (case - 1) % self.of == self.number - 1
    }
}

/// The remaining cases of a process, which takes them one after the other.
#[derive(Debug)]
pub struct Queue<'s> {
    study: &'s Study,
    folder: &'s Folder,
    cases: Vec<usize>,
    next: AtomicUsize,
    /// Cases that other processes were computing at their turn.
    others: Mutex<Vec<usize>>,
    /// Digests of the files of the study when its plan was made.
    files: Files,
    /// Failed cases that are open again, with the time of the failure.
    retried: BTreeMap<usize, SystemTime>,
}

/// A case owned by this process.
#[derive(Debug)]
pub struct OwnedCase<'s> {
    queue: &'s Queue<'s>,
    case: usize,
    lock: Lock,
}

/// Outcome of a case.
#[derive(Debug, Clone, PartialEq)]
pub enum Computed {
    /// It has results.
    Done,
    /// It failed, for this reason, which is written to `failed.json`.
    Failed(String),
}

impl<'s> Queue<'s> {
    /// Creates the queue of the remaining cases of a study for a `task`. With `retry` it includes earlier
    /// failures.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn new(study: &'s Study, folder: &'s Folder, task: Task, retry: bool) -> Result<Self> {
        let failed = (1..=study.len()).filter(|_| retry);
        let queue = Self {
            study,
            folder,
            cases: Vec::new(),
            next: AtomicUsize::new(0),
            others: Mutex::default(),
            retried: failed.filter_map(|case| Some((case, folder.failed_at(case)?))).collect(),
            files: Files::read(&folder.files_path())?.unwrap_or_default(),
        };
        let cases = (1..=study.len()).filter(|case| task.has(*case) && !queue.is_over(*case)).collect();
        Ok(Self { cases, ..queue })
    }

    /// Number of remaining cases when the queue was created.
    pub fn len(&self) -> usize {
        self.cases.len()
    }

    /// Whether no case remained when the queue was created.
    pub fn is_empty(&self) -> bool {
        self.cases.is_empty()
    }

    /// Takes the next case; `None` if all are done, or if other processes compute the rest.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn take(&'s self) -> Result<Option<OwnedCase<'s>>> {
        while let Some(case) = self.cases.get(self.next.fetch_add(1, Ordering::Relaxed)) {
            match self.attempt(*case)? {
                Some(turn) => return Ok(Some(turn)),
                None if !self.is_over(*case) => self.others().push(*case),
                None => {}
            }
        }
        // Cases of other processes are tried once more, because some of these may have ended.
        let others = std::mem::take(&mut *self.others());
        for (n, case) in others.iter().enumerate() {
            match self.attempt(*case)? {
                Some(turn) => {
                    self.others().extend(&others[n + 1..]);
                    return Ok(Some(turn));
                }
                None if !self.is_over(*case) => self.others().push(*case),
                None => {}
            }
        }
        Ok(None)
    }

    fn attempt(&'s self, case: usize) -> Result<Option<OwnedCase<'s>>> {
        if self.is_over(case) {
            return Ok(None);
        }
        let results = self.folder.case(case);
        fs::create_dir_all(&results).map_err(|source| Error::File { path: results.clone(), source })?;
        let Some(lock) = try_acquire(&results)? else { return Ok(None) };
        // It may have been finished since.
        Ok((!self.is_over(case)).then_some(OwnedCase { queue: self, case, lock }))
    }

    /// Whether a case needs no more work.
    fn is_over(&self, case: usize) -> bool {
        let counts = |at: &SystemTime| self.retried.get(&case) != Some(at);
        self.folder.is_done(case) || self.folder.failed_at(case).as_ref().is_some_and(counts)
    }

    fn others(&self) -> std::sync::MutexGuard<'_, Vec<usize>> {
        self.others.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl OwnedCase<'_> {
    /// The number of the case, from 1.
    pub fn case(&self) -> usize {
        self.case
    }

    /// Reads the case, after writing its file.
    ///
    /// # Errors
    /// The error of the case; [`Error::File`] if its file cannot be written.
    pub fn load(&self) -> Result<Case> {
        let folder = self.queue.folder.case(self.case);
        let path = folder.join(CASE_FILE);
        let text = self.queue.study.case_file(self.case, Some(&folder))?;
        // No other process writes it, and a partial file left by a power cut is written again.
        let there = if fs::exists(&path) {
            regular::read(&path, "a case file", u64::MAX)
                .map_err(|source| Error::File { path: path.clone(), source })?
        } else {
            Vec::new()
        };
        if there != text.as_bytes() {
            fs::write(&path, text.as_bytes()).map_err(|source| Error::File { path: path.clone(), source })?;
        }
        Case::load(&path)
    }

    /// Computes the case, from where an interrupted process left it, and writes its results, or the reason of
    /// its failure. `admit` may refuse it once it is read.
    ///
    /// # Errors
    /// [`Error::Interrupted`] if `watch` requests it, [`Error::SurfaceChanged`] if a file of the study has
    /// changed since its plan was made, [`Error::File`] if the study cannot be written to. These are not
    /// recorded as failures: the case is open again.
    pub fn compute<T>(self, admit: impl FnOnce(&Case) -> Result<T>, watch: &dyn Watch) -> Result<Computed> {
        let folder = self.queue.folder.case(self.case);
        let failure = self.queue.folder.failure_path(self.case);
        let computed = self.load().and_then(|case| {
            // Left by an earlier attempt.
            let _ = fs::remove_file(&failure);
            let _admitted = admit(&case)?;
            let pinned = self.queue.files.pinned(self.queue.folder.path(), self.queue.study, self.case);
            let given = SurfaceInput { pinned: Some(pinned), ..SurfaceInput::default() };
            let go = |existing| {
                let lock = Some(self.lock.clone());
                run_with(&case, given.clone(), &folder, (existing, lock), watch).map(drop)
            };
            match go(Existing::Resume) {
                Err(Error::NotResumable { .. } | Error::OtherCase { .. } | Error::SurfaceChanged { .. }) => {
                    go(Existing::Overwrite)
                }
                ended => ended,
            }
        });
        match computed {
            Ok(()) => Ok(Computed::Done),
            Err(error) if is_of_the_place(&error, self.queue.folder.path()) => Err(error),
            Err(error) => {
                let message = error.to_string();
                let told =
                    FailedCase { version: env!("CARGO_PKG_VERSION").to_owned(), message: message.clone() };
                let text = serde_json::to_vec_pretty(&told).expect("texts can be written");
                atomic::replace(&failure, &text)?;
                Ok(Computed::Failed(message))
            }
        }
    }
}

/// Whether an error does not concern the case: a requested stop, or a study that cannot be written to.
fn is_of_the_place(error: &Error, study: &Path) -> bool {
    match error {
        Error::Interrupted => true,
        // A table would mix rows of both contents.
        Error::SurfaceChanged { path, .. } => path == study,
        Error::File { path, source } => {
            let full = [
                ErrorKind::StorageFull,
                ErrorKind::QuotaExceeded,
                ErrorKind::ReadOnlyFilesystem,
                ErrorKind::PermissionDenied,
                ErrorKind::StaleNetworkFileHandle,
                ErrorKind::FileTooLarge,
            ];
            path.starts_with(study) && full.contains(&source.kind())
        }
        _ => false,
    }
}

//! Operating system locks on a file, which end with their process.

use std::io;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use web_time::Instant;

use crate::io::fs::{self, File, TryLockError};
use crate::io::regular;

/// A lock held by this process; it is released with its last clone.
#[derive(Debug, Clone)]
pub(crate) struct Lock {
    /// The locked file; `None` if the file system has no locks.
    held: Option<Arc<File>>,
}

impl Lock {
    /// Locks the file at `path`, which is created if missing and stays when the lock is released. Returns
    /// `None` if another process holds the lock for longer than `patience`.
    pub(crate) fn take(path: &Path, patience: Duration) -> io::Result<Option<Self>> {
        if fs::exists(path) {
            regular::check(path, "a file to be locked")?;
        }
        let file = File::options().write(true).create(true).truncate(false).open(path)?;
        let began = Instant::now();
        loop {
            match file.try_lock() {
                Ok(()) => return Ok(Some(Self { held: Some(Arc::new(file)) })),
                Err(TryLockError::Error(_)) => return Ok(Some(Self { held: None })),
                Err(TryLockError::WouldBlock) if began.elapsed() < patience => fs::wait(patience / 50),
                Err(TryLockError::WouldBlock) => return Ok(None),
            }
        }
    }

    /// Whether the file system has locks.
    pub(crate) fn binds(&self) -> bool {
        self.held.is_some()
    }
}

/// Whether any process holds a lock on the file at `path`.
pub(crate) fn is_taken(path: &Path) -> bool {
    let file = regular::open(path, "a file to be locked");
    file.is_ok_and(|file| matches!(file.try_lock(), Err(TryLockError::WouldBlock)))
}

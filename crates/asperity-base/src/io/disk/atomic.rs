//! Atomic files, written completely or not at all: written to a temporary name beside the target, then
//! renamed.

use std::ffi::OsStr;
use std::fs::{File, TryLockError};
use std::hash::{BuildHasher, RandomState};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::error::{Error, Result};

/// Creates the file at `path` with `contents`, or replaces it. A process killed at any moment leaves either
/// the old file or the complete new one, and beside it at most a temporary file, which [`sweep`] removes.
///
/// # Errors
/// [`Error::File`] with `path`, if its directory does not exist or cannot be written to, or if the disk is
/// full; the file is then unchanged.
pub fn replace(path: &Path, contents: &[u8]) -> Result<()> {
    write_with(path, |file| file.write_all(contents))
}

/// Creates the file at `path` with these contents, unless it exists. Returns whether it did. If several
/// processes call it, one creates the file.
///
/// # Errors
/// The errors of [`replace`].
pub fn create(path: &Path, contents: &[u8]) -> Result<bool> {
    let failed = |source| Error::File { path: path.to_owned(), source };
    let mut temporary = create_in(path.parent().unwrap_or(Path::new("."))).map_err(failed)?;
    let _ = temporary.as_file().try_lock();
    temporary.write_all(contents).and_then(|()| temporary.as_file().sync_all()).map_err(failed)?;
    match temporary.persist_noclobber(path) {
        Ok(_) => Ok(true),
        Err(error) if error.error.kind() == ErrorKind::AlreadyExists => Ok(false),
        Err(error) => Err(failed(error.error)),
    }
}

/// Replaces the file at `path` by the output of `contents`.
///
/// The data reach the disk before the name does. A process killed at any moment leaves either the old file or
/// the complete new one, and beside it at most a temporary file, which [`sweep`] removes.
///
/// # Errors
/// [`Error::File`] with `path`, if its directory does not exist or cannot be written to, if the disk is full,
/// or if `contents` fails; the file is then unchanged.
pub fn write_with(path: &Path, contents: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    persist(path, contents).map_err(|source| Error::File { path: path.to_owned(), source })
}

/// Removes the stale temporary files of killed processes in `directory`, as far as possible; those of running
/// processes stay.
pub fn sweep(directory: &Path) {
    let entries = std::fs::read_dir(directory).into_iter().flatten().flatten();
    for path in entries.filter(|entry| is_temporary(&entry.file_name())).map(|entry| entry.path()) {
        let lock = File::options().write(true).open(&path).map(|file| file.try_lock());
        if !matches!(lock, Ok(Err(TryLockError::WouldBlock))) {
            let _ = std::fs::remove_file(path);
        }
    }
}

/// Whether a file name is that of a temporary file.
pub fn is_temporary(name: &OsStr) -> bool {
    name.as_encoded_bytes().starts_with(PREFIX.as_bytes())
}

/// Prefix of the names of temporary files.
const PREFIX: &str = ".asperity-";

fn persist(path: &Path, contents: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut draft = Draft::new(path)?;
    let mut writer = BufWriter::new(draft.temporary.as_file_mut());
    contents(&mut writer)?;
    writer.flush()?;
    drop(writer);
    draft.publish()
}

/// A file written under a temporary name, which is removed unless it is published.
pub struct Draft {
    temporary: NamedTempFile,
    directory: PathBuf,
    path: PathBuf,
}

impl Draft {
    /// Creates an empty file that is to replace the one at `path`.
    ///
    /// # Errors
    /// If its directory does not exist or cannot be written to.
    pub fn new(path: &Path) -> io::Result<Self> {
        let directory = match path.parent() {
            Some(parent) if parent != Path::new("") => parent.to_owned(),
            _ => PathBuf::from("."),
        };
        let temporary = create_in(&directory).map_err(without_temporary_name)?;
        // The lock shows `sweep` that the process is running, and ends with the file. Without locks only a
        // simultaneous sweep is harmful. If locks are mandatory, it would block writing under the temporary
        // name.
        if cfg!(unix) {
            let _ = temporary.as_file().try_lock();
        }
        Ok(Self { temporary, directory, path: path.to_owned() })
    }

    /// Path of the temporary file.
    pub fn temporary_path(&self) -> &Path {
        self.temporary.path()
    }

    /// Replaces the file at its path, once all data are on the disk.
    ///
    /// # Errors
    /// If the disk is full, or the file cannot be renamed.
    pub fn publish(self) -> io::Result<()> {
        self.temporary.as_file().sync_all()?;
        self.temporary.persist(&self.path).map_err(|failed| failed.error)?;
        // The new name survives a power cut only once its directory is on the disk, which not every system
        // supports.
        if cfg!(unix) {
            let _ = File::open(&self.directory).and_then(|directory| directory.sync_all());
        }
        Ok(())
    }
}

/// A temporary file by which other processes check that they see the same directory; it is removed with this
/// value.
pub struct Token {
    _file: NamedTempFile,
    number: u64,
}

impl Token {
    /// Creates a file with a unique number in `directory`.
    ///
    /// # Errors
    /// [`Error::File`] with `directory`.
    pub fn new(directory: &Path) -> Result<Self> {
        let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap_or_default();
        let process = (std::process::id(), now, directory);
        // As many digits as an `f64` represents exactly, because ranks exchange those.
        let number = RandomState::new().hash_one(process) >> 16;
        let file = tempfile::Builder::new().prefix(&Self::name(number)).rand_bytes(0).tempfile_in(directory);
        let file = file.map_err(|source| Error::File { path: directory.to_owned(), source })?;
        let _ = file.as_file().try_lock();
        Ok(Self { _file: file, number })
    }

    /// The number of the file.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// Whether the file of this number is in `directory`.
    pub fn is_in(directory: &Path, number: u64) -> bool {
        directory.join(Self::name(number)).exists()
    }

    fn name(number: u64) -> String {
        format!("{PREFIX}token-{number}")
    }
}

fn create_in(directory: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        // Permissions like those of any new file, according to the umask; temporary files would be private.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.prefix(PREFIX).tempfile_in(directory)
}

/// Removes the temporary name from an error, because it would only confuse.
fn without_temporary_name(error: io::Error) -> io::Error {
    match error.kind() {
        ErrorKind::NotFound => io::Error::new(ErrorKind::NotFound, "its directory does not exist"),
        ErrorKind::NotADirectory => io::Error::new(ErrorKind::NotADirectory, "its parent is not a directory"),
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            io::Error::new(error.kind(), "its directory cannot be written to")
        }
        ErrorKind::StorageFull => io::Error::new(ErrorKind::StorageFull, "no space left on the disk"),
        _ => error,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(directory: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(directory).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn a_write_that_fails_leaves_the_file_as_it_was() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("summary.json");
        replace(&path, b"first").unwrap();
        let failed = write_with(&path, |file| {
            file.write_all(b"half of the sec")?;
            Err(io::Error::new(ErrorKind::StorageFull, "no space left"))
        });
        assert!(matches!(failed, Err(Error::File { path: named, .. }) if named == path));
        assert_eq!(std::fs::read(&path).unwrap(), b"first");
        assert_eq!(names(directory.path()), ["summary.json"]);
        replace(&path, b"second").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"second");
        assert_eq!(names(directory.path()), ["summary.json"]);
    }

    #[test]
    fn what_a_killed_process_left_is_swept_away_and_nothing_else() {
        let directory = tempfile::tempdir().unwrap();
        for name in [".asperity-Zx81Qa", ".tmpZx81Qa", "summary.json"] {
            std::fs::write(directory.path().join(name), b"half").unwrap();
        }
        sweep(directory.path());
        let mut left = names(directory.path());
        left.sort();
        assert_eq!(left, [".tmpZx81Qa", "summary.json"]);
    }

    #[test]
    fn a_missing_directory_is_named_as_such() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("no").join("steps.csv");
        let message = replace(&path, b"").unwrap_err().to_string();
        assert_eq!(message, format!("{}: its directory does not exist", path.display()));
    }
}

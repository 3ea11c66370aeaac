//! Reading of regular files with a limit on their size.

use std::io::{self, ErrorKind, Read};
use std::path::Path;

use super::fs::{self, File};

/// Reads the file at `path`, of at most `most` bytes. `expected` describes it: "a case file".
///
/// # Errors
/// The error of the operating system; [`ErrorKind::IsADirectory`] or [`ErrorKind::InvalidInput`] for anything
/// but a regular file, with its kind; [`ErrorKind::InvalidInput`] also for a file larger than `most`, with
/// its size.
pub fn read(path: &Path, expected: &str, most: u64) -> io::Result<Vec<u8>> {
    let mut file = open(path, expected)?;
    let length = file.metadata()?.len();
    if length > most {
        let message = format!("holds {length} bytes, {expected} has {most} at most");
        return Err(io::Error::new(ErrorKind::InvalidInput, message));
    }
    let mut content = Vec::with_capacity(usize::try_from(length).unwrap_or(0));
    file.read_to_end(&mut content)?;
    Ok(content)
}

/// Opens the file at `path` for reading. `expected` describes it.
///
/// # Errors
/// The errors of [`read`].
pub fn open(path: &Path, expected: &str) -> io::Result<File> {
    check(path, expected)?;
    File::open(path)
}

/// Returns an error unless `path` leads to a regular file. A pipe or a device has no end, and opening one may
/// block forever.
///
/// # Errors
/// The errors of [`read`].
pub fn check(path: &Path, expected: &str) -> io::Result<()> {
    let about = fs::metadata(path)?;
    if about.is_file() {
        return Ok(());
    }
    let kind = if about.is_dir() { ErrorKind::IsADirectory } else { ErrorKind::InvalidInput };
    Err(io::Error::new(kind, format!("is {}, expected {expected}", fs::noun(&about))))
}

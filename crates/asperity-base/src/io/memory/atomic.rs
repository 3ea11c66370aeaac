//! Atomic files: in memory a file gets its content at once.

use std::ffi::OsStr;
use std::io::{self, Write};
use std::path::Path;

use super::fs;
use crate::error::{Error, Result};

/// Creates the file at `path` with `contents`, or replaces it.
///
/// # Errors
/// [`Error::File`] with `path`, if its directory does not exist.
pub fn replace(path: &Path, contents: &[u8]) -> Result<()> {
    fs::write(path, contents).map_err(|source| Error::File { path: path.to_owned(), source })
}

/// Creates the file at `path` with these contents, unless it exists. Returns whether it did.
///
/// # Errors
/// The errors of [`replace`].
pub fn create(path: &Path, contents: &[u8]) -> Result<bool> {
    if fs::exists(path) {
        return Ok(false);
    }
    replace(path, contents).map(|()| true)
}

/// Replaces the file at `path` by the output of `contents`.
///
/// # Errors
/// [`Error::File`] with `path`, if its directory does not exist, or if `contents` fails; the file is then
/// unchanged.
pub fn write_with(path: &Path, contents: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    let mut bytes = Vec::new();
    let written = contents(&mut bytes).and_then(|()| fs::write(path, bytes));
    written.map_err(|source| Error::File { path: path.to_owned(), source })
}

/// Does nothing: no file in memory is temporary.
pub fn sweep(_: &Path) {}

/// Whether a file name is that of a temporary file: none is.
pub fn is_temporary(_: &OsStr) -> bool {
    false
}

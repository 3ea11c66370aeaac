//! Files that are read as a whole: regular ones only, and none larger than it may be.

use std::fs::{FileType, Metadata};
use std::io::{self, ErrorKind};
use std::path::Path;

/// The content of the file at `path`, which is to be `expected`, "a case file", of at most so many bytes.
///
/// # Errors
/// What the operating system says; [`ErrorKind::IsADirectory`] or [`ErrorKind::InvalidInput`] with what it is instead
/// of a regular file, the latter also with its size where that is more than `most`.
pub(crate) fn read(path: &Path, expected: &str, most: u64) -> io::Result<Vec<u8>> {
    // A pipe or a device has no end, and opening one may wait for ever.
    let about = std::fs::metadata(path)?;
    if !about.is_file() {
        let kind = if about.is_dir() { ErrorKind::IsADirectory } else { ErrorKind::InvalidInput };
        return Err(io::Error::new(kind, format!("is {}, expected {expected}", noun(&about))));
    }
    if about.len() > most {
        let message = format!("holds {} bytes, {expected} has {most} at most", about.len());
        return Err(io::Error::new(ErrorKind::InvalidInput, message));
    }
    std::fs::read(path)
}

fn noun(about: &Metadata) -> &'static str {
    if about.is_dir() { "a directory" } else { special(about.file_type()) }
}

#[cfg(unix)]
fn special(kind: FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    if kind.is_fifo() {
        "a pipe (FIFO)"
    } else if kind.is_socket() {
        "a socket"
    } else {
        "a device"
    }
}

#[cfg(not(unix))]
fn special(_: FileType) -> &'static str {
    "no regular file"
}

//! The functions of [`std::fs`] that have a counterpart for files in memory.

use std::path::Path;
use std::time::Duration;

pub use std::fs::{
    DirEntry, File, Metadata, TryLockError, canonicalize, create_dir_all, metadata, read_dir, remove_dir,
    remove_dir_all, remove_file, write,
};
pub use std::path::absolute;

/// Whether there is a file or a folder at `path`.
pub fn exists(path: impl AsRef<Path>) -> bool {
    path.as_ref().exists()
}

/// Waits for another process to release a file.
pub fn wait(time: Duration) {
    std::thread::sleep(time);
}

/// Returns the kind of anything but a regular file: "a directory".
pub fn noun(about: &Metadata) -> &'static str {
    if about.is_dir() { "a directory" } else { special(about) }
}

#[cfg(unix)]
fn special(about: &Metadata) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    let kind = about.file_type();
    if kind.is_fifo() {
        "a pipe (FIFO)"
    } else if kind.is_socket() {
        "a socket"
    } else {
        "a device"
    }
}

#[cfg(not(unix))]
fn special(_: &Metadata) -> &'static str {
    "no regular file"
}

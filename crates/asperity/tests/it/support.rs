//! The crates beside this one, and their files.

use std::fs;
use std::path::{Path, PathBuf};

/// Returns the name and the folder of the source of each crate.
pub(crate) fn crates() -> Vec<(String, PathBuf)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let folders = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut crates: Vec<_> = folders
        .filter(|folder| folder.join("src").is_dir())
        .map(|folder| (folder.file_name().unwrap().to_str().unwrap().to_owned(), folder.join("src")))
        .collect();
    crates.sort();
    assert!(crates.len() > 5, "{crates:?}");
    crates
}

/// Returns the files of Rust and Python below a folder.
pub(crate) fn files_below(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries
        .flat_map(|path| if path.is_dir() { files_below(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|kind| kind == "rs" || kind == "py"))
        .collect()
}

//! Files by name.

use std::path::Path;

use asperity_base::Error;
use asperity_base::io::{fs, read_regular, replace};
use serde_json::{Value, json};

use crate::Result;

/// Creates or replaces a file, with the folders above it.
pub fn put(name: &str, bytes: &[u8]) -> Result {
    let path = Path::new(name);
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|source| Error::File { path: folder.to_owned(), source })?;
    }
    Ok(replace(path, bytes)?)
}

/// Returns the bytes of a file.
pub fn get(name: &str) -> Result<Vec<u8>> {
    let path = Path::new(name);
    let read = read_regular(path, "a file", u64::MAX);
    Ok(read.map_err(|source| Error::File { path: path.to_owned(), source })?)
}

/// Lists all files below a folder, sorted by name.
pub fn files(folder: &str) -> Value {
    let mut all = Vec::new();
    list(Path::new(folder), &mut all);
    all.into()
}

fn list(folder: &Path, all: &mut Vec<Value>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        match entry.metadata() {
            Ok(about) if about.is_file() => all.push(json!({
                "name": entry.path().to_string_lossy(),
                "bytes": about.len(),
                "version": about.version(),
            })),
            _ => list(&entry.path(), all),
        }
    }
}

/// Removes a file, or a folder with all in it, if there is one.
pub fn remove(name: &str) {
    let _ = fs::remove_file(name).or_else(|_| fs::remove_dir_all(name));
}

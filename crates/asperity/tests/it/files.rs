//! Crates that work in a browser touch the disk in one folder, which is left out there.

use std::fs;
use std::path::{Path, PathBuf};

use crate::support::crates;

/// Crates whose files may be in memory.
const CRATES: [&str; 6] = [
    "asperity-base",
    "asperity-contact",
    "asperity-elastic",
    "asperity-report",
    "asperity-study",
    "asperity-surface",
];

/// Ways to the disk, which have a counterpart in `asperity_base::io::fs`.
const WAYS: [&str; 5] = ["std::fs", "std::path::absolute", ".exists()", ".canonicalize()", "tempfile::"];

#[test]
fn the_disk_is_touched_in_one_folder() {
    let disk = Path::new("io").join("disk");
    let in_memory = Path::new("io").join("memory");
    let mut found = Vec::new();
    for (_, source) in crates().into_iter().filter(|(name, _)| CRATES.contains(&name.as_str())) {
        for file in files(&source) {
            let inside = file.strip_prefix(&source).unwrap();
            if inside.starts_with(&disk)
                || inside.starts_with(&in_memory)
                || inside.components().any(|part| part.as_os_str() == "tests")
            {
                continue;
            }
            let text = fs::read_to_string(&file).unwrap();
            let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
            for line in code.lines().filter(|line| !line.trim_start().starts_with("//")) {
                if WAYS.iter().any(|way| line.contains(way)) {
                    found.push(format!("{}: {}", file.display(), line.trim()));
                }
            }
        }
    }
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

/// Returns every Rust file under `folder`, except those with tests alone.
fn files(folder: &Path) -> Vec<PathBuf> {
    let inside = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let kept = inside.filter(|path| path.file_stem().is_none_or(|stem| stem != "tests"));
    kept.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}

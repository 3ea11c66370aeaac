//! Interpretation of a path: a case file, a study file, results, or a folder with one of them.

use std::path::{Path, PathBuf};

use asperity::Error;
use asperity::solver::Device;
use asperity::study::{Case, Results};

use crate::report::{Failure, Outcome};

/// Loads a case file for the command of that name. The error for a study file or a folder says which of them the path
/// is.
pub(crate) fn case(path: &Path, command: &str) -> Outcome<Case> {
    Case::load(path).map_err(|error| match instead_of_a_case(path, command) {
        Some((message, hint)) => Failure::usage(message, hint.as_deref()),
        None => error.into(),
    })
}

/// [`case`], as it is solved by a `device` if one is given.
pub(crate) fn case_on(path: &Path, command: &str, device: Option<Device>) -> Outcome<Case> {
    let case = case(path, command)?;
    Ok(match device {
        Some(device) => case.on(device)?,
        None => case,
    })
}

/// Returns a path as an argument of a shell.
pub(crate) fn shown(path: &Path) -> String {
    let text = path.display().to_string();
    let is_plain = |letter: char| letter.is_alphanumeric() || "/._-+:\\".contains(letter);
    if text.chars().all(is_plain) { text } else { format!("\"{text}\"") }
}

/// Opens a results directory for the command of that name. If the folder contains results, the hint names them.
pub(crate) fn results(path: &Path, command: &str) -> Outcome<Results> {
    Results::open(path).map_err(|error| {
        let inner = path.join("results");
        match (&error, Results::open(&inner)) {
            (Error::NoResults { .. }, Ok(_)) => {
                let hint = format!("the results are in `{0}`: asperity {command} {0}", inner.display());
                Failure::usage(error.to_string(), Some(&hint))
            }
            _ => error.into(),
        }
    })
}

/// Returns the message and the hint for a path that is not a case file.
fn instead_of_a_case(path: &Path, command: &str) -> Option<(String, Option<String>)> {
    if path.is_dir() {
        let inner = ["case.toml", "case/case.toml"].map(|inner| path.join(inner));
        let inner: Option<PathBuf> = inner.into_iter().find(|inner| inner.is_file());
        let hint =
            inner.map(|inner| format!("the case file is `{0}`: asperity {command} {0}", inner.display()));
        return Some((format!("`{}` is a folder, expected a case file", path.display()), hint));
    }
    // Reading a pipe would wait for its writer.
    let text = path.is_file().then(|| std::fs::read_to_string(path).ok())??;
    let table: toml::Table = toml::from_str(&text).ok()?;
    let is_study = table.contains_key("base") && !table.contains_key("lower");
    let path = path.display();
    is_study.then(|| {
        let hint =
            format!("`asperity study {path}` computes its cases, `asperity study {path} --list` prints them");
        (format!("`{path}` is a study, expected a case file"), Some(hint))
    })
}

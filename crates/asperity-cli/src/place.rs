//! Interpretation of a path: a case file, a study file, results, a folder with one of them, or a topography
//! instead.

use std::path::{Path, PathBuf};

use asperity::Error;
use asperity::solver::Device;
use asperity::study::parametric::Study;
use asperity::study::{Case, Results};
use asperity::surface::ReadOptions;

use crate::report::{Failure, Outcome};

/// Loads a case file for the command of that name. The error for a study file or a folder says which of them
/// the path is.
pub(crate) fn case(path: &Path, command: &str) -> Outcome<Case> {
    Case::load(path).map_err(|error| match instead_of_a_case(path, command) {
        Some((message, hint)) => Failure::usage(message, hint.as_deref()),
        None => error.into(),
    })
}

/// Loads a study file. The error for a topography says what it is.
pub(crate) fn study(path: &Path) -> Outcome<Study> {
    Study::load(path).map_err(|error| {
        let content = path.is_file().then(|| std::fs::read(path).ok()).flatten();
        let is_toml = |content: &Vec<u8>| toml::from_slice::<toml::Table>(content).is_ok();
        let other = content.filter(|content| !is_toml(content));
        match other.and_then(|content| instead_of_text(path, &content, "a study file")) {
            Some((message, hint)) => Failure::usage(message, hint.as_deref()),
            None => error.into(),
        }
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
pub(crate) fn quoted(path: &Path) -> String {
    let text = path.display().to_string();
    let is_plain = |letter: char| letter.is_alphanumeric() || "/._-+:\\".contains(letter);
    if text.chars().all(is_plain) { text } else { format!("\"{text}\"") }
}

/// Opens a results directory for the command of that name. If the folder contains results, the hint names
/// them.
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
    let content = path.is_file().then(|| std::fs::read(path).ok())??;
    let text = std::str::from_utf8(&content).ok();
    let Some(table) = text.and_then(|text| toml::from_str::<toml::Table>(text).ok()) else {
        return instead_of_text(path, &content, "a case file");
    };
    let is_study = table.contains_key("base") && !table.contains_key("lower");
    let path = path.display();
    is_study.then(|| {
        let hint =
            format!("`asperity study {path}` computes its cases, `asperity study {path} --list` prints them");
        (format!("`{path}` is a study, expected a case file"), Some(hint))
    })
}

/// Returns the message and the hint for a file that is a topography, or one of another program, where a text
/// is `expected`.
fn instead_of_text(path: &Path, content: &[u8], expected: &str) -> Option<(String, Option<String>)> {
    let name = path.display();
    let (format, heights) = match ReadOptions::default().scan_bytes(path, content) {
        Ok(scan) => (scan.format, format!(", {} × {} heights", scan.heights.nrows(), scan.heights.ncols())),
        Err(Error::CorruptTopography { format, .. }) if !["text", "csv"].contains(&format) => {
            (format, String::new())
        }
        Err(Error::NoChannel { available, .. }) => {
            ("several channels", format!(": {}", available.join(", ")))
        }
        Err(Error::NotATopography { reason, .. }) => {
            return Some((format!("`{name}` is not {expected}: {reason}"), None));
        }
        Err(_) => return None,
    };
    let file = quoted(path);
    let hint = format!(
        "`asperity surface info {file}` describes it, `asperity contact {file} OTHER --load \"1 N\" --material steel` presses it against \
         another one; a case file names it: `topography = {{ file = \"{name}\" }}`"
    );
    Some((format!("`{name}` is a topography ({format}{heights}), expected {expected}"), Some(hint)))
}

//! `python/asperity/errors.py`: an exception for each variant of the library's error, with its fields as
//! attributes.

use asperity_base::error::Error;

use super::{agrees, annotated, wrapped};

const SOURCE: &str = include_str!("../../../../asperity-base/src/error/mod.rs");

const HEAD: &str = r#""""Exceptions of asperity: one for each cause, with its numbers as attributes.

Every exception is an :class:`AsperityError`. Bad input is a :class:`ValueError`, a computation that failed a
:class:`RuntimeError`, and a problem with a file or a directory an :class:`OSError`. A hint, if there is one, is a note
(:pep:`678`), which tracebacks show.

This file is made from the variants of the library's error: ``UPDATE=1 cargo test -p asperity-study``.
"""

from __future__ import annotations

from typing import Annotated

from ._described import described
from ._exceptions import AsperityError, BadInput, CaseError, Failed, FailedCases, FileProblem, InternalError, ModelWarning
"#;

/// Names that the file has from its import.
const IMPORTED: [&str; 8] = [
    "AsperityError",
    "BadInput",
    "CaseError",
    "Failed",
    "FailedCases",
    "FileProblem",
    "InternalError",
    "ModelWarning",
];

const MISSING_FILE: &str = r#"

class MissingFile(File, FileNotFoundError):
    """A file does not exist."""
"#;

/// Variants of a computation that failed.
const FAILED: &[&str] = &[
    "AtIncrement",
    "AtPass",
    "AtPoint",
    "AtPosition",
    "AtUpdate",
    "BeyondFriction",
    "BeyondPass",
    "BeyondPlasticLimit",
    "DeviceFailed",
    "DeviceMemory",
    "Interrupted",
    "LoadNotReached",
    "Memory",
    "NotConverged",
    "NotFinite",
    "PeriodicFullContact",
    "FilmNotConverged",
    "PlasticNotConverged",
    "PullOff",
    "Threads",
    "WornAway",
];

/// Variants of a problem with a file or a directory. All others are bad input.
const OF_FILES: &[&str] = &[
    "File",
    "InUse",
    "NoResults",
    "NotResumable",
    "NotThisStudy",
    "OtherRows",
    "ResultsExist",
    "WithinResults",
];

/// A variant of the error: its name, its documentation, and the documentation and type of each field.
struct Variant {
    name: &'static str,
    about: String,
    fields: Vec<Field>,
}

struct Field {
    name: &'static str,
    about: String,
    kind: &'static str,
}

#[test]
fn the_exceptions_of_python_are_the_errors_of_the_library() {
    let variants = variants();
    let read: Vec<_> = variants
        .iter()
        .map(|each| (each.name, each.fields.iter().map(|field| field.name).collect()))
        .collect();
    let declared: Vec<(&str, Vec<&str>)> =
        Error::VARIANTS.iter().map(|(name, fields)| (*name, fields.to_vec())).collect();
    assert_eq!(read, declared);
    agrees("errors.py", |_| file(&variants));
}

/// Reads the variants with their documentation from the source of the error.
fn variants() -> Vec<Variant> {
    let declaration =
        SOURCE.split_once("pub enum Error {").expect("the error").1.split_once("\n}\n").expect("its end").0;
    let (mut variants, mut about, mut is_inside) = (Vec::<Variant>::new(), String::new(), false);
    for line in declaration.lines() {
        let (text, depth) = (line.trim_start(), line.len() - line.trim_start().len());
        if let Some(words) = text.strip_prefix("/// ") {
            about += if about.is_empty() { "" } else { " " };
            about += words;
        } else if depth == 4 && text.starts_with(char::is_alphabetic) {
            let name = text.split(|c: char| !c.is_alphanumeric()).next().expect("a name");
            variants.push(Variant { name, about: std::mem::take(&mut about), fields: Vec::new() });
            is_inside = text.ends_with('{');
        } else if depth == 4 && text == "}," {
            is_inside = false;
        } else if let (true, 8, Some((name, kind))) = (is_inside, depth, text.split_once(": ")) {
            let field = Field { name, about: std::mem::take(&mut about), kind: kind.trim_end_matches(',') };
            variants.last_mut().expect("a variant").fields.push(field);
        }
    }
    variants
}

fn file(variants: &[Variant]) -> String {
    let own = variants.iter().map(|each| each.name).filter(|name| *name != "Case");
    let mut names: Vec<&str> = own.chain(IMPORTED).chain(["MissingFile"]).collect();
    names.sort_unstable();
    let names: Vec<String> = names.iter().map(|name| format!("    \"{name}\",\n")).collect();
    let mut file = format!("{HEAD}\n__all__ = [\n{}]\n", names.concat());
    for each in variants.iter().filter(|each| each.name != "Case") {
        file += &class(each);
    }
    file + MISSING_FILE + "\n\ndef __dir__() -> list[str]:\n    return __all__\n"
}

fn class(Variant { name, about, fields }: &Variant) -> String {
    let base = match name {
        name if FAILED.contains(name) => "Failed",
        &"ResultsExist" => "FileProblem, FileExistsError",
        name if OF_FILES.contains(name) => "FileProblem",
        _ => "BadInput",
    };
    let more = if *name == "PullOff" { " Adhesion holds no more than `least`." } else { "" };
    let about = wrapped(&format!("{about}{more}"), 4);
    let class = format!("class {name}({base}):\n    \"\"\"{}\"\"\"\n", about.trim_start());
    let attributes: String =
        fields.iter().flat_map(attributes).map(|(name, kind, about)| annotated(name, kind, &about)).collect();
    if attributes.is_empty() {
        format!("\n\n{class}")
    } else {
        format!("\n\n@described\n{class}\n{attributes}")
    }
}

/// The attributes of an exception that a field becomes: name, type and meaning of each.
fn attributes(Field { name, about, kind }: &Field) -> Vec<(&'static str, &'static str, String)> {
    // The name of the field is a keyword of Python.
    let name = if *name == "pass" { "pass_number" } else { name };
    let of_unit = |unit: &str| {
        let end = about.find(';').unwrap_or(about.len() - 1);
        format!("{}, {unit}{}", &about[..end], &about[end..])
    };
    match *kind {
        "&'static str" | "String" | "Cow<'static, str>" | "Defect" | "LoadLimit" | "PathBuf" => {
            vec![(name, "str", about.clone())]
        }
        "f64" => vec![(name, "float", about.clone())],
        "Newton" => vec![(name, "float", of_unit("N"))],
        "Metre" => vec![(name, "float", of_unit("m"))],
        "usize" => vec![(name, "int", about.clone())],
        "bool" => vec![(name, "bool", about.clone())],
        "Vec<String>" => vec![(name, "list[str]", about.clone())],
        "[usize; 2]" | "[usize; 4]" | "Vec<usize>" => vec![(name, "list[int]", about.clone())],
        "Box<Error>" => vec![("cause", "AsperityError", about.clone())],
        "std::io::Error" => vec![
            ("errno", "int | None", "Number of the error of the operating system.".to_owned()),
            ("reason", "str", "Message of the operating system.".to_owned()),
        ],
        // The message has the unit of the value.
        "Option<Dimension>" => Vec::new(),
        other => panic!("{name}: no type of Python for {other}"),
    }
}

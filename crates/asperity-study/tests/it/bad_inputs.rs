//! Bad inputs are tables: in the files of `tests/inputs/bad`, each row is a case with the message that it
//! must get.
//!
//! A row begins with `### name`. Its tables take the place of those of [`BALL`] and come after the others;
//! one as `[lower.wear]` is added to the body of the ball, and `#- [contact]` leaves a table out. Below the
//! faulty line is `#^ message`, with its caret under the faulty place, then `#= hint: …` if the error has a
//! hint. A row of `studies.toml` is a study of a good case, unless it names its own.

use std::path::{Path, PathBuf};

use asperity_base::Error;
use asperity_base::error::CaseError;
use asperity_study::Case;
use asperity_study::parametric::Study;

use crate::ball::good_cases;

/// A good case, a ball on a plane.
const BALL: [(&str, &str); 3] = [
    (
        "lower",
        r#"
young = "210 GPa"
poisson = 0.3
topography = { form = "flat", shape = [64, 64], pitch = "1 um" }
"#,
    ),
    (
        "upper",
        r#"
young = "210 GPa"
poisson = 0.3
topography = { form = "sphere", radius = "1 mm", shape = [64, 64], pitch = "1 um" }
"#,
    ),
    ("contact", "\nload = \"2 N\"\n"),
];

const STUDIES: &str = "studies";

#[test]
fn every_bad_input_is_refused_with_the_message_it_holds() {
    let rows: Vec<_> = rows().into_iter().filter(|row| row.file != STUDIES).collect();
    assert!(rows.len() > 180, "only {} bad inputs found", rows.len());
    every_row_is_refused(&rows, |row| Case::parse(&of_ball(&row.text), &row.path(), &folder()).err());
}

#[test]
fn every_bad_study_is_refused_with_the_message_it_holds() {
    let rows: Vec<_> = rows().into_iter().filter(|row| row.file == STUDIES).collect();
    assert!(rows.len() > 25, "only {} bad studies found", rows.len());
    every_row_is_refused(&rows, |row| {
        let names_its_base = row.text.lines().any(|line| line.starts_with("base = "));
        let base = if names_its_base { "" } else { "base = \"../good/ellipsoid.toml\"\n" };
        Study::parse(&format!("{base}{}", row.text), &row.path()).err()
    });
}

fn every_row_is_refused(rows: &[Row], refusal: impl Fn(&Row) -> Option<Error>) {
    let wrong: Vec<_> = rows.iter().filter_map(|row| check(row, refusal(row)).err()).collect();
    assert!(wrong.is_empty(), "{} of {} rows:\n{}", wrong.len(), rows.len(), wrong.join("\n"));
}

/// A case or study that is refused.
struct Row {
    /// Name of the file that it is in.
    file: String,
    name: String,
    text: String,
}

impl Row {
    /// The file that its error names.
    fn path(&self) -> PathBuf {
        folder().join(format!("{}.toml", self.file))
    }
}

fn rows() -> Vec<Row> {
    let mut rows = Vec::new();
    for path in files() {
        let file = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let text = std::fs::read_to_string(&path).unwrap();
        let text = text.strip_prefix("### ").unwrap_or_else(|| panic!("{file} does not begin with a row"));
        for row in text.split("\n### ") {
            let (name, text) = row.split_once('\n').unwrap();
            rows.push(Row { file: file.clone(), name: name.to_owned(), text: text.to_owned() });
        }
    }
    rows
}

/// Returns the case of a row: its keys outside tables, what it lacks of [`BALL`], and its tables.
fn of_ball(row: &str) -> String {
    let tables = row.find("\n[").map_or(row.len(), |at| at + 1);
    let (outside, tables) = row.split_at(if row.starts_with('[') { 0 } else { tables });
    let has = |starts: [String; 3]| {
        row.lines().any(|line| starts.iter().any(|start| line.starts_with(start.as_str())))
    };
    let mut case = outside.to_owned();
    for (name, keys) in BALL {
        if has([format!("[{name}]"), format!("{name} ="), format!("#- [{name}]")]) {
            continue;
        }
        case += &format!("[{name}]\n");
        for line in keys.trim().lines() {
            let key = line.split(' ').next().unwrap();
            let of_row = [format!("[{name}.{key}]"), format!("[{name}.{key}."), format!("[[{name}.{key}.")];
            if !has(of_row) {
                case += &format!("{line}\n");
            }
        }
    }
    case += tables;
    case.lines().filter(|line| !line.starts_with("#- ")).map(|line| line.to_owned() + "\n").collect()
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let error = Case::load(Path::new("nowhere/case.toml")).unwrap_err();
    assert!(matches!(&error, Error::File { .. }), "{error:?}");
    assert!(error.to_string().starts_with("nowhere/case.toml: "), "{error}");
}

/// Pieces of good cases are cut out, doubled and exchanged. Most of these cases are rejected, none causes a
/// panic, and the place of each error can be shown.
#[test]
fn a_damaged_case_never_panics() {
    let good: Vec<_> = good_cases().into_iter().map(|(_, text)| text).collect();
    arbtest::arbtest(|u| {
        let mut text = u.choose(&good)?.clone();
        for _ in 0..u.int_in_range(1..=3)? {
            let place = |u: &mut arbtest::arbitrary::Unstructured<'_>, text: &str| {
                let mut place = u.int_in_range(0..=text.len())?;
                while !text.is_char_boundary(place) {
                    place -= 1;
                }
                Ok(place)
            };
            let (a, b) = (place(u, &text)?, place(u, &text)?);
            let piece: String = match u.int_in_range(0..=2)? {
                0 => String::new(),
                1 => (*u.choose(&["µ", "\"", "[", "=", "-", "1e999", "inf", "{", "\r\n", ".", "0"])?)
                    .to_owned(),
                _ => text[a.min(b)..a.max(b)].repeat(2),
            };
            let end = a.max(b).min(a.min(b) + 40);
            let end = (a.min(b)..=end).rev().find(|end| text.is_char_boundary(*end)).unwrap();
            text.replace_range(a.min(b)..end, &piece);
        }
        if let Err(error) = Case::parse(&text, Path::new("case.toml"), Path::new("")) {
            let Error::Case(error) = error else { panic!("{error:?}") };
            assert!(error.text.get(error.span.clone()).is_some(), "{error:?}");
            assert!(error.line >= 1 && error.line <= text.lines().count() + 1, "{error:?}");
        }
        Ok(())
    });
}

fn check(row: &Row, error: Option<Error>) -> Result<(), String> {
    let name = format!("{}: {}", row.file, row.name);
    let found = match error {
        Some(Error::Case(error)) => error,
        Some(other) => return Err(format!("{name}: {other:?}")),
        None => return Err(format!("{name}: accepted")),
    };
    let expected = Expected::of(&found.text);
    // Files are relative to the working directory.
    let folder = format!("{}/", env!("CARGO_MANIFEST_DIR"));
    let same = found.message.replace(&folder, "") == expected.message
        && found.hint == expected.hint
        && found.line == expected.line
        && columns(&found).contains(&expected.column);
    let CaseError { line, message, hint, .. } = &*found;
    let columns = columns(&found);
    if same {
        assert_eq!(found.to_string(), format!("{}:{line}: {message}", row.path().display()));
        Ok(())
    } else {
        Err(format!(
            "{name}\n  found line {line} columns {columns:?}: {message}\n    {hint:?}\n  {expected:?}"
        ))
    }
}

#[derive(Debug)]
struct Expected {
    line: usize,
    column: usize,
    message: String,
    hint: Option<String>,
}

impl Expected {
    fn of(text: &str) -> Self {
        let lines: Vec<_> = text.lines().collect();
        let is_mark = |line: &&str| line.starts_with('#') && line[1..].trim_start().starts_with('^');
        let mark = lines.iter().position(is_mark).expect("a line `#^ message`");
        let (before, message) = lines[mark].split_once('^').unwrap();
        Self {
            line: mark, // counted from 1, the line above the mark
            column: before.chars().count() + 1,
            message: message.trim().to_owned(),
            hint: lines.get(mark + 1).and_then(|line| line.strip_prefix("#= hint: ")).map(str::to_owned),
        }
    }
}

/// Returns the columns of the place; at the start of a line also the second, because the caret follows a `#`.
fn columns(error: &CaseError) -> std::ops::RangeInclusive<usize> {
    let width = error.text[error.span.clone()].chars().count().max(1);
    error.column..=(error.column + width - 1).max(2)
}

/// Paths in rows are relative to it.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/bad")
}

fn files() -> Vec<PathBuf> {
    let mut files: Vec<_> = std::fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

//! Study file: base, axes, table, filters.

use std::path::{Path, PathBuf};

use toml::Value;

use super::axis::{Axis, ValueInFile, axes};
use super::base_case::Base;
use super::filter::Exclusion;
use crate::case::MAX_CASE_BYTES;
use crate::case::cursor::{Entry, Table};
use crate::case::document::Document;
use crate::case::schema::tables::{self as keys, is_of_root};
use crate::cell::unguarded;
use crate::io::text_of;
use asperity_base::error::{Error, Result};

/// Content of a study file.
#[derive(Debug)]
pub(super) struct StudyFile {
    pub(super) title: String,
    pub(super) document: Document,
    pub(super) base: Base,
    /// The axes of the grid, then those of the table.
    pub(super) axes: Vec<Axis>,
    pub(super) rows: Option<Rows>,
    pub(super) exclusions: Vec<Exclusion>,
}

/// Rows of a given table: axes that change together.
#[derive(Debug)]
pub(super) struct Rows {
    /// Its text, with the places of its cells.
    pub(super) document: Document,
    /// The first of its axes.
    pub(super) first: usize,
    /// For each row, the index of a value of each of its axes.
    pub(super) rows: Vec<Vec<u32>>,
}

/// Largest size of a table, bytes.
const MAX_TABLE_BYTES: u64 = 1 << 30;

/// Reads a study file. Paths of files are relative to its folder.
pub(super) fn load(path: &Path) -> Result<StudyFile> {
    let text = text_of(path, "a study file", MAX_CASE_BYTES)?;
    read(&text, path)
}

pub(super) fn read(text: &str, path: &Path) -> Result<StudyFile> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut document = Document::named("the study", path.to_owned(), text);
    let entries = document.parse(text)?;
    let root = Table::root(&document, entries.get_ref());
    root.known(&["title", "base", "axes", "table", "exclude"], belongs)?;
    let title = match root.get("title") {
        Some(title) => title.text()?.to_owned(),
        None => path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default(),
    };
    let base = base(&root, folder, &document, text)?;
    let mut all = root.table("axes")?.map(|table| axes(&table)).transpose()?.unwrap_or_default();
    let rows = root.get("table").map(|entry| rows(&entry, folder, &mut all)).transpose()?;
    if all.is_empty() {
        let hint = "give [axes] for a grid of cases, or `table = \"plan.csv\"` for a row per case".to_owned();
        return Err(root.error("the study has neither [axes] nor 'table'".to_owned(), Some(hint)));
    }
    let exclusions = root.get("exclude").map(|entry| entry.tables()).transpose()?.unwrap_or_default();
    let exclusions =
        exclusions.iter().map(|table| Exclusion::read(table, &all)).collect::<Result<Vec<_>>>()?;
    Ok(StudyFile { title, document: document.clone(), base, axes: all, rows, exclusions })
}

/// Makes the content of a study of these cases of a case file.
pub(super) fn of_cases(
    path: &Path,
    keys: Vec<(String, Vec<Value>)>,
    change: impl FnOnce(&mut toml::Table),
) -> Result<StudyFile> {
    let text = text_of(path, "a case file", MAX_CASE_BYTES)?;
    let mut document = Document::named("the case", path.to_owned(), &text);
    document.parse(&text)?;
    let mut table = toml::from_str(&text).expect("what has been parsed once is TOML");
    change(&mut table);
    let title = table.get("title").and_then(Value::as_str).map(str::to_owned);
    let title =
        title.or(path.file_stem().map(|stem| stem.to_string_lossy().into_owned())).unwrap_or_default();
    let cases = keys.iter().map(|(_, values)| values.len()).min().unwrap_or(0);
    let rows = (0..cases).map(|case| vec![case as u32; keys.len()]).collect();
    let axis = |(key, values): (String, Vec<Value>)| {
        let values = values.into_iter().map(|value| ValueInFile { value, span: 0..0 }).collect();
        Axis::new(key, values)
    };
    let folder = path.parent().unwrap_or(Path::new(""));
    Ok(StudyFile {
        title,
        base: Base::new(table, [folder; 2], document.clone(), ""),
        axes: keys.into_iter().map(axis).collect(),
        rows: Some(Rows { document: document.clone(), first: 0, rows }),
        document,
        exclusions: Vec::new(),
    })
}

/// Returns a message and a hint for a table of a case that is misplaced in a study file.
fn belongs(key: &str) -> Option<(String, Option<String>)> {
    let unknown = |hint| Some((format!("unknown key '{key}' in the study"), Some(hint)));
    if key == "stale_after" {
        return unknown("leave it out: a case is free again as soon as its process has gone".to_owned());
    }
    if is_of_root(key) {
        return unknown(format!("a case that stands in the study file is its base: [base.{key}]"));
    }
    // A key of an axis, or a key of a table of a case.
    let hint = keys::belongs(key, "").and_then(|(_, hint)| hint);
    match key.split_once('.').map(|(table, _)| table) {
        Some(table) if is_of_root(table) => unknown(format!("an axis stands in [axes]: `\"{key}\" = [...]`")),
        _ => hint.and_then(|hint| unknown(format!("{hint} of the base"))),
    }
}

/// Reads the base: a case file, or the tables of one.
fn base(root: &Table<'_>, folder: &Path, document: &Document, text: &str) -> Result<Base> {
    let entry = root.required("base", "\"case.toml\"")?;
    if entry.is_table() {
        let mut study: toml::Table = toml::from_str(text).expect("what has been parsed once is TOML");
        let Some(Value::Table(table)) = study.remove("base") else { unreachable!("it is a table") };
        return Ok(Base::new(table, [folder, folder], document.clone(), "base"));
    }
    let name = entry.text()?;
    let path = folder.join(name);
    let text = text_of(&path, "a case file", MAX_CASE_BYTES).map_err(|error| at(&entry, &error))?;
    let mut document = Document::named("the case", path.clone(), &text);
    document.parse(&text)?;
    let table = toml::from_str(&text).expect("what has been parsed once is TOML");
    Ok(Base::new(table, [path.parent().unwrap_or(Path::new("")), folder], document, ""))
}

/// Error of a file named here.
fn at(entry: &Entry<'_>, error: &Error) -> Error {
    entry.error(error.to_string(), error.hint())
}

/// Reads the rows of a table in a file. Its columns, which are keys of the case, become axes. A column `case`
/// is ignored.
fn rows(entry: &Entry<'_>, folder: &Path, axes: &mut Vec<Axis>) -> Result<Rows> {
    let path: PathBuf = folder.join(entry.text()?);
    let text = text_of(&path, "a table of cases", MAX_TABLE_BYTES).map_err(|error| at(entry, &error))?;
    let document = Document::named("the table", path.clone(), &text);
    let wrong = |error: csv::Error| {
        let at = error.position().map_or(0, |position| position.byte() as usize);
        document.error("", line_from(&text, at), error.to_string(), None)
    };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_bytes());
    let columns: Vec<String> = reader.headers().map_err(wrong)?.iter().map(str::to_owned).collect();
    let used: Vec<usize> = (0..columns.len()).filter(|n| columns[*n] != "case").collect();
    let mut keys = Vec::new();
    for n in &used {
        let (key, unit) = columns[*n]
            .split_once(" (")
            .map_or((columns[*n].as_str(), ""), |(key, unit)| (key, unit.strip_suffix(')').unwrap_or(unit)));
        let twice = axes.iter().any(|axis| axis.key() == key) || keys.iter().any(|(known, _)| *known == key);
        if key.is_empty() || twice {
            let message = match key {
                "" => format!("column {} of the table has no name, expected a key of the case", n + 1),
                _ => format!("'{key}' is an axis twice"),
            };
            return Err(document.error("", line_from(&text, 0), message, None));
        }
        keys.push((key, unit));
    }
    let mut values: Vec<Vec<ValueInFile>> = keys.iter().map(|_| Vec::new()).collect();
    let mut known = vec![std::collections::HashMap::new(); keys.len()];
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(wrong)?;
        let start = record.position().map_or(0, |position| position.byte() as usize);
        let mut row = Vec::with_capacity(keys.len());
        for (column, n) in used.iter().enumerate() {
            let cell = &record[*n];
            let next = values[column].len() as u32;
            let index = *known[column].entry(cell.to_owned()).or_insert(next);
            if index == next {
                let span = cell_in(&text, start, cell);
                let (key, unit) = keys[column];
                let value = value(cell, unit).ok_or_else(|| {
                    let hint = Some("what all cases share stands in the base".to_owned());
                    document.error(key, span.clone(), format!("no value of '{key}' in this row"), hint)
                })?;
                values[column].push(ValueInFile { value, span });
            }
            row.push(index);
        }
        rows.push(row);
    }
    if rows.is_empty() || keys.is_empty() {
        let message = format!("'table' names {}, which has no rows of values", path.display());
        return Err(entry.error(message, Some("its first line has keys such as contact.load".to_owned())));
    }
    let first = axes.len();
    axes.extend(keys.iter().zip(values).map(|((key, _), values)| Axis::new((*key).to_owned(), values)));
    Ok(Rows { document, first, rows })
}

/// Returns the value of a cell: a number, true or false, a list, or a text; `None` for an empty cell. A
/// number under a header with a unit is a quantity.
fn value(cell: &str, unit: &str) -> Option<Value> {
    if cell.is_empty() {
        return None;
    }
    let cell = unguarded(cell);
    let parsed =
        format!("value = {cell}").parse::<toml::Table>().ok().and_then(|mut table| table.remove("value"));
    let plain = parsed.filter(|value| {
        matches!(value, Value::Integer(_) | Value::Float(_) | Value::Boolean(_) | Value::Array(_))
    });
    Some(match plain {
        Some(Value::Integer(_) | Value::Float(_)) if !unit.is_empty() => {
            Value::String(format!("{cell} {unit}"))
        }
        Some(value) => value,
        None => Value::String(cell.to_owned()),
    })
}

/// Returns the line that begins at a byte.
fn line_from(text: &str, start: usize) -> std::ops::Range<usize> {
    let start = start.min(text.len());
    start..text[start..].find('\n').map_or(text.len(), |end| start + end)
}

/// Returns the place of a cell in the line that begins at a byte, or the whole line.
fn cell_in(text: &str, start: usize, cell: &str) -> std::ops::Range<usize> {
    let line = line_from(text, start);
    match text[line.clone()].find(cell) {
        Some(at) if !cell.is_empty() => line.start + at..line.start + at + cell.len(),
        _ => line,
    }
}

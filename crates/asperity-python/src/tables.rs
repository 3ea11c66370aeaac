//! Conversion of dictionaries to the tables of a case.

use std::path::PathBuf;

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyByteArray, PyBytes, PyDict, PyFloat, PyInt, PyString};
use toml::{Table, Value};

use crate::errors;

/// Keys with texts that may look like numbers.
const TEXTS: [&str; 4] = ["title", "file", "channel", "given"];

/// Writes the text of a case, or of a part of one, from these tables. A key with the value `None` is omitted.
pub(crate) fn text(tables: &Bound<'_, PyDict>) -> PyResult<String> {
    toml::to_string(&table(tables, "")?).map_err(|error| PyValueError::new_err(error.to_string()))
}

fn table(entries: &Bound<'_, PyDict>, path: &str) -> PyResult<Table> {
    let mut table = Table::new();
    for (key, value) in entries {
        let key: String = key.extract()?;
        if !value.is_none() {
            let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            table.insert(key, entry(&value, &path)?);
        }
    }
    Ok(table)
}

/// Returns the number or text in a zero-dimensional array; any other value unchanged.
pub(crate) fn scalar<'py>(value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let dimensions = value.getattr_opt("ndim")?.and_then(|ndim| ndim.extract::<usize>().ok());
    match dimensions == Some(0) && value.hasattr("item")? {
        true => value.call_method0("item"),
        false => Ok(value.clone()),
    }
}

/// Converts a value. Number-like and list-like objects, such as NumPy scalars and arrays, are treated as
/// numbers and lists.
fn entry(value: &Bound<'_, PyAny>, path: &str) -> PyResult<Value> {
    let value = &scalar(value)?;
    if let Ok(entries) = value.cast::<PyDict>() {
        return Ok(Value::Table(table(entries, path)?));
    }
    if let Ok(text) = value.cast::<PyString>() {
        let text = text.to_string();
        return if is_bare(&text) && !TEXTS.contains(&key(path)) {
            Err(errors::bad_input(value.py(), path, &bare(key(path), &text), None))
        } else {
            Ok(Value::String(text))
        };
    }
    if let Ok(flag) = value.cast::<PyBool>() {
        return Ok(Value::Boolean(flag.is_true()));
    }
    if let Ok(whole) = value.cast::<PyInt>() {
        return Ok(match whole.extract() {
            Ok(whole) => Value::Integer(whole),
            Err(_) => Value::Float(whole.extract()?),
        });
    }
    if value.cast::<PyFloat>().is_ok() {
        return Ok(Value::Float(value.extract()?));
    }
    if value.hasattr("__fspath__")? {
        let path: PathBuf = value.extract()?;
        return Ok(Value::String(path.to_string_lossy().into_owned()));
    }
    let is_bytes = value.cast::<PyBytes>().is_ok() || value.cast::<PyByteArray>().is_ok();
    if !is_bytes && let Ok(items) = value.try_iter() {
        let items = items.map(|item| entry(&item?, path)).collect::<PyResult<_>>()?;
        return Ok(Value::Array(items));
    }
    if value.hasattr("__index__")? {
        return value.extract().map(Value::Integer);
    }
    if value.hasattr("__float__")? {
        return value.extract().map(Value::Float);
    }
    let key = key(path);
    let found = value.get_type().name()?;
    Err(PyTypeError::new_err(format!(
        "'{key}' is of type {found}, expected a number, a text or a sequence of them"
    )))
}

/// Last part of a dotted path.
fn key(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or_default()
}

/// Whether a text is a number without a unit, which is ambiguous.
pub(crate) fn is_bare(text: &str) -> bool {
    text.trim().parse::<f64>().is_ok_and(f64::is_finite)
}

/// Message for a number in quotes without a unit.
pub(crate) fn bare(key: &str, text: &str) -> String {
    format!(
        "'{key}' is {text:?}, a text without a unit, expected a number in SI units, or a text with a unit"
    )
}

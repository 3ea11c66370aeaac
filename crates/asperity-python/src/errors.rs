//! Exceptions: one for each variant of the library's error, in `asperity.errors`, with its fields as
//! attributes.

use asperity::Error;
use asperity::error::Detail;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Creates the exception for an error of the library.
pub(crate) fn exception(py: Python<'_>, error: &Error) -> PyErr {
    raised(py, error).map(PyErr::from_value).unwrap_or_else(|failure| failure)
}

/// Creates the exception for an internal error.
pub(crate) fn internal(py: Python<'_>, message: &str) -> PyErr {
    let made = make(py, "InternalError", message, &PyDict::new(py), None);
    made.map(PyErr::from_value).unwrap_or_else(|failure| failure)
}

/// Creates the exception for an invalid argument, reported as a key of a case.
pub(crate) fn bad_input(py: Python<'_>, key: &str, message: &str, hint: Option<String>) -> PyErr {
    let attributes = PyDict::new(py);
    let made =
        attributes.set_item("key", key).and_then(|()| make(py, "CaseError", message, &attributes, hint));
    made.map(PyErr::from_value).unwrap_or_else(|failure| failure)
}

fn make<'py>(
    py: Python<'py>,
    name: &str,
    message: &str,
    attributes: &Bound<'py, PyDict>,
    hint: Option<String>,
) -> PyResult<Bound<'py, PyAny>> {
    py.import("asperity._raise")?.getattr("exception")?.call1((name, message, attributes, hint))
}

fn raised<'py>(py: Python<'py>, error: &Error) -> PyResult<Bound<'py, PyAny>> {
    let attributes = PyDict::new(py);
    if let Error::Case(case) = error {
        attributes.set_item("key", &case.key)?;
        // A call has no file, so the name of an argument also gives the place.
        if case.file.as_os_str().is_empty() {
            return make(py, "CaseError", &case.message, &attributes, case.hint.clone());
        }
        attributes.set_item("path", &case.file)?;
        attributes.set_item("line", case.line)?;
        attributes.set_item("column", case.column)?;
        return make(py, "CaseError", &error.to_string(), &attributes, case.hint.clone());
    }
    for (field, detail) in error.details() {
        // The field is a Python keyword.
        let field = if field == "pass" { "pass_number" } else { field };
        match detail {
            Detail::Text(text) => attributes.set_item(field, text)?,
            Detail::Path(path) => attributes.set_item(field, path)?,
            Detail::Number(number) => attributes.set_item(field, number)?,
            Detail::Count(count) => attributes.set_item(field, count)?,
            Detail::Counts(counts) => attributes.set_item(field, counts)?,
            Detail::Texts(texts) => attributes.set_item(field, texts)?,
            Detail::Flag(flag) => attributes.set_item(field, flag)?,
            Detail::Cause(cause) => attributes.set_item("cause", raised(py, cause)?)?,
            Detail::System(error) => {
                attributes.set_item("errno", error.raw_os_error())?;
                attributes.set_item("reason", error.to_string())?;
            }
            // The message contains the unit.
            _ => {}
        }
    }
    make(py, error.name(), &error.to_string(), &attributes, hint(error))
}

/// Returns advice in Python terms, if the library has none.
fn hint(error: &Error) -> Option<String> {
    let words = match error {
        Error::Threads { .. } => "one needs none: threads=1",
        Error::ResultsExist { results: true, .. } => {
            "overwrite=True replaces them, resume=True goes on from them"
        }
        Error::NotThisStudy { .. } => "out= names another directory",
        _ => return error.hint(),
    };
    Some(words.to_owned())
}

//! Conversion of matrices and records between Rust and Python.

use asperity::operator::{Boundary, Edge};
use asperity::{Choice, Field, Result};
use numpy::{IntoPyArray, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyList};
use serde::Serialize;
use serde_json::Value;

/// Copies a matrix, row by row.
pub(crate) fn field(array: &PyReadonlyArray2<'_, f64>) -> Field {
    array.as_array().as_standard_layout().into_owned()
}

/// Converts a field without a copy.
pub(crate) fn array(py: Python<'_>, field: Field) -> Bound<'_, PyArray2<f64>> {
    field.into_pyarray(py)
}

/// Returns the boundary along x and y with these words, which the Python package has checked.
pub(crate) fn boundary(edges: &[String; 2]) -> Boundary {
    Boundary(edges.each_ref().map(|word| Edge::of_word(word).expect("a boundary is one of the words")))
}

/// Converts a serialisable value to dictionaries, lists and numbers; NaN becomes `None`.
pub(crate) fn record<'py>(py: Python<'py>, record: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    object(py, &serde_json::to_value(record).expect("a record can be written as JSON"))
}

/// Converts a JSON value to an object.
pub(crate) fn object<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::Null => py.None().into_bound(py),
        Value::Bool(flag) => PyBool::new(py, *flag).to_owned().into_any(),
        Value::Number(number) => match number.as_i64() {
            Some(whole) => whole.into_pyobject(py)?.into_any(),
            // A force without contact is 0, never −0.
            None => (number.as_f64().unwrap_or(f64::NAN) + 0.0).into_pyobject(py)?.into_any(),
        },
        Value::String(text) => text.into_pyobject(py)?.into_any(),
        Value::Array(items) => {
            let items = items.iter().map(|item| object(py, item)).collect::<PyResult<Vec<_>>>()?;
            PyList::new(py, items)?.into_any()
        }
        Value::Object(entries) => {
            let dictionary = PyDict::new(py);
            for (key, value) in entries {
                dictionary.set_item(key, object(py, value)?)?;
            }
            dictionary.into_any()
        }
    })
}

/// Converts a result of the library, with its error as an exception.
pub(crate) fn ok<T>(result: Result<T>, py: Python<'_>) -> PyResult<T> {
    result.map_err(|error| crate::errors::exception(py, &error))
}

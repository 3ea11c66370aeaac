//! Exceptions: one for each variant of the library's error, in `asperity.errors`, with its numbers as attributes.

use asperity::Error;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The name of the variant and its fields, for the exception of that name.
macro_rules! variant {
    ($attributes:ident, $name:literal $(, $field:ident = $value:expr)* $(,)?) => {{
        $($attributes.set_item(stringify!($field), $value)?;)*
        $name
    }};
}

/// The exception of an error of the library.
pub(crate) fn exception(py: Python<'_>, error: &Error) -> PyErr {
    raised(py, error).map(PyErr::from_value).unwrap_or_else(|failure| failure)
}

/// The exception of a mistake of ours.
pub(crate) fn internal(py: Python<'_>, message: &str) -> PyErr {
    let made = make(py, "InternalError", message, &PyDict::new(py), None);
    made.map(PyErr::from_value).unwrap_or_else(|failure| failure)
}

fn make<'py>(
    py: Python<'py>,
    name: &str,
    message: &str,
    attributes: &Bound<'py, PyDict>,
    hint: Option<String>,
) -> PyResult<Bound<'py, PyAny>> {
    py.import("asperity.errors")?.getattr("_make")?.call1((name, message, attributes, hint))
}

fn raised<'py>(py: Python<'py>, error: &Error) -> PyResult<Bound<'py, PyAny>> {
    let a = PyDict::new(py);
    let mut message = error.to_string();
    let mut hint = error.hint();
    let name = match error {
        Error::OutOfRange { quantity, value, expected, .. } => {
            variant!(a, "OutOfRange", quantity = quantity, value = value, expected = expected)
        }
        Error::GridMismatch { what, left, right } => {
            variant!(a, "GridMismatch", what = what, left = left, right = right)
        }
        Error::Unsupported(_) => "Unsupported",
        Error::NotATopography { path, reason } => variant!(a, "NotATopography", path = path, reason = reason),
        Error::CorruptTopography { path, format, reason } => {
            variant!(a, "CorruptTopography", path = path, format = format, reason = reason.to_string())
        }
        Error::NoChannel { path, channel, available } => {
            variant!(a, "NoChannel", path = path, channel = channel, available = available)
        }
        Error::OwnUnit { path, format } => variant!(a, "OwnUnit", path = path, format = format),
        Error::NoPitch { path, format } => variant!(a, "NoPitch", path = path, format = format),
        Error::NoFormat { path } => variant!(a, "NoFormat", path = path),
        Error::UndefinedSamples { undefined, samples } => {
            variant!(a, "UndefinedSamples", undefined = undefined, samples = samples)
        }
        Error::NothingDefined { samples } => variant!(a, "NothingDefined", samples = samples),
        Error::WindowOutside { window, shape } => {
            variant!(a, "WindowOutside", window = window.to_vec(), shape = shape.to_vec())
        }
        Error::Case(case) => {
            // Of a call there is no file; what names one names the place, too.
            if case.file.as_os_str().is_empty() {
                message.clone_from(&case.message);
            } else {
                a.set_item("path", &case.file)?;
                a.set_item("line", case.line)?;
                a.set_item("column", case.column)?;
            }
            hint.clone_from(&case.hint);
            variant!(a, "CaseError", key = &case.key)
        }
        Error::BeyondPlasticLimit { load, limit } => {
            variant!(a, "BeyondPlasticLimit", load = load, limit = limit)
        }
        Error::BeyondFriction { force, limit } => variant!(a, "BeyondFriction", force = force, limit = limit),
        Error::NotConverged { iterations, residual, tolerance } => {
            variant!(a, "NotConverged", iterations = iterations, residual = residual, tolerance = tolerance)
        }
        Error::PeriodicFullContact { approach, mean_gap } => {
            variant!(a, "PeriodicFullContact", approach = approach, mean_gap = mean_gap)
        }
        Error::LoadNotReached { load, below, trials, approach } => {
            variant!(a, "LoadNotReached", load = load, below = below, trials = trials, approach = approach)
        }
        Error::BeyondPass { load, most, approach, .. } => {
            variant!(a, "BeyondPass", load = load, most = most, approach = approach)
        }
        Error::AtPosition { pass, position, positions, source } => {
            a.set_item("pass_number", pass)?;
            hint = hint.or(source.hint());
            a.set_item("cause", raised(py, source)?)?;
            variant!(a, "AtPosition", position = position, positions = positions)
        }
        Error::AtPoint { point, points, source } => {
            hint = hint.or(source.hint());
            a.set_item("cause", raised(py, source)?)?;
            variant!(a, "AtPoint", point = point, points = points)
        }
        Error::AtIncrement { increment, source } => {
            hint = hint.or(source.hint());
            a.set_item("cause", raised(py, source)?)?;
            variant!(a, "AtIncrement", increment = increment)
        }
        Error::AtPass { pass, source } => {
            a.set_item("pass_number", pass)?;
            hint = hint.or(source.hint());
            a.set_item("cause", raised(py, source)?)?;
            "AtPass"
        }
        Error::AtUpdate { update, source } => {
            hint = hint.or(source.hint());
            a.set_item("cause", raised(py, source)?)?;
            variant!(a, "AtUpdate", update = update)
        }
        Error::NotFinite { field, cell } => variant!(a, "NotFinite", field = field, cell = cell),
        Error::FlowNotConverged { products, mismatch, tolerance } => {
            variant!(a, "FlowNotConverged", products = products, mismatch = mismatch, tolerance = tolerance)
        }
        Error::Memory { needed, available } => variant!(a, "Memory", needed = needed, available = available),
        Error::Threads { reason } => {
            hint = Some("one needs none: threads=1".to_owned());
            variant!(a, "Threads", reason = reason)
        }
        Error::Interrupted => "Interrupted",
        Error::ResultsExist { path, results } => {
            hint = Some("overwrite=True replaces them, resume=True goes on from them".to_owned())
                .filter(|_| *results);
            variant!(a, "ResultsExist", path = path)
        }
        Error::WithinResults { path, results } => {
            variant!(a, "WithinResults", path = path, results = results)
        }
        Error::OtherCase { path, key, before, now } => {
            variant!(a, "OtherCase", path = path, key = key, before = before, now = now)
        }
        Error::SurfaceChanged { path, file } => variant!(a, "SurfaceChanged", path = path, file = file),
        Error::NotResumable { path, reason } => variant!(a, "NotResumable", path = path, reason = reason),
        Error::OtherRows { path, rows, ranks, expected, expected_ranks } => variant!(
            a,
            "OtherRows",
            path = path,
            rows = rows.to_vec(),
            ranks = ranks,
            expected = expected.to_vec(),
            expected_ranks = expected_ranks
        ),
        Error::InUse { path } => variant!(a, "InUse", path = path),
        Error::TooManyRanks { ranks, rows } => variant!(a, "TooManyRanks", ranks = ranks, rows = rows),
        Error::RanksDiffer { rank, what } => variant!(a, "RanksDiffer", rank = rank, what = what),
        Error::NotThisStudy { path, what } => {
            hint = Some("out= names another directory".to_owned());
            variant!(a, "NotThisStudy", path = path, what = what)
        }
        Error::NoResults { path } => variant!(a, "NoResults", path = path),
        Error::File { path, source } => {
            variant!(a, "File", path = path, errno = source.raw_os_error(), reason = source.to_string())
        }
        Error::NoField { path, name, available } => {
            variant!(a, "NoField", path = path, name = name, available = available)
        }
        // The library may grow variants; its message is whole in any case.
        _ => "AsperityError",
    };
    make(py, name, &message, &a, hint)
}

/// The exception of an argument that has no meaning, as of a key of a case.
pub(crate) fn bad_input(py: Python<'_>, key: &str, message: &str, hint: Option<String>) -> PyErr {
    let attributes = PyDict::new(py);
    let made =
        attributes.set_item("key", key).and_then(|()| make(py, "CaseError", message, &attributes, hint));
    made.map(PyErr::from_value).unwrap_or_else(|failure| failure)
}

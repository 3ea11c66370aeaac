//! A results directory, open for reading.

use std::path::PathBuf;

use asperity::Error;
use asperity::io::fields::{Attribute, Fields};
use asperity::study::Results;
use numpy::{IntoPyArray, PyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{object, ok, record};
use crate::work;

/// A stored array: values, unit, names of the axes, pitch and origin along each.
type StoredArray<'py> = (Bound<'py, PyArrayDyn<f64>>, String, Vec<String>, Vec<f64>, Vec<f64>);

/// Returns the SI unit of a column of a table or of a number of a summary: "1" for a pure number, an empty
/// text for a text; `None` if there is no such column.
#[pyfunction]
pub(crate) fn unit_of_column(column: &str) -> Option<&'static str> {
    asperity::study::unit_of_column(column)
}

#[pyclass(name = "Results", frozen)]
pub(crate) struct CoreResults {
    results: Results,
}

#[pymethods]
impl CoreResults {
    #[new]
    fn new(py: Python<'_>, directory: PathBuf) -> PyResult<Self> {
        Ok(Self { results: ok(Results::open(&directory), py)? })
    }

    fn case<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        object(py, &ok(self.results.case_json(), py)?)
    }

    /// Returns the summary; `None` until the computation is complete.
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        match self.results.summary() {
            Err(Error::File { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => Ok(None),
            summary => record(py, &ok(summary, py)?).map(Some),
        }
    }

    /// Writes the page and returns its path.
    fn report(&self, py: Python<'_>, out: Option<PathBuf>) -> PyResult<PathBuf> {
        let directory = self.results.directory();
        work::run(py, 0, None, |_| asperity_cli::write_report(directory, out.as_deref()))
    }

    /// Returns the rows of a table: "passes", "steps", "increments", "updates", "sweep"; or "found", those of
    /// each capability by its name.
    fn rows<'py>(&self, py: Python<'py>, table: &str) -> PyResult<Bound<'py, PyAny>> {
        let results = &self.results;
        match table {
            "passes" => record(py, &ok(results.passes(), py)?),
            "steps" => record(py, &ok(results.steps(), py)?),
            "increments" => record(py, &ok(results.increments(), py)?),
            "updates" => record(py, &ok(results.updates(), py)?),
            "sweep" => record(py, &ok(results.sweep(), py)?),
            _ => record(py, &ok(results.observations(), py)?),
        }
    }

    /// Returns the names of the fields of a kind: "contact", "pass", "point", "increment", "subsurface",
    /// "plasticity".
    fn names(&self, py: Python<'_>, kind: &str, number: Option<usize>) -> PyResult<Vec<String>> {
        ok(self.fields(kind, number).and_then(|fields| fields.names()), py)
    }

    fn attributes<'py>(
        &self,
        py: Python<'py>,
        kind: &str,
        number: Option<usize>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let attributes = PyDict::new(py);
        for (name, value) in ok(self.fields(kind, number).and_then(|fields| fields.attributes()), py)? {
            match value {
                Attribute::Text(text) => attributes.set_item(name, text)?,
                Attribute::Number(number) => attributes.set_item(name, number)?,
                Attribute::Integer(number) => attributes.set_item(name, number)?,
                Attribute::Numbers(numbers) => attributes.set_item(name, numbers)?,
            }
        }
        Ok(attributes)
    }

    fn read<'py>(
        &self,
        py: Python<'py>,
        kind: &str,
        number: Option<usize>,
        name: &str,
    ) -> PyResult<StoredArray<'py>> {
        let stored = py.detach(|| self.fields(kind, number).and_then(|fields| fields.read(name)));
        let stored = ok(stored, py)?;
        let axes = stored.axes.split(',').map(str::to_owned).collect();
        Ok((stored.values.into_pyarray(py), stored.unit, axes, stored.pitch, stored.origin))
    }
}

impl CoreResults {
    fn fields(&self, kind: &str, number: Option<usize>) -> asperity::Result<Fields> {
        match kind {
            "pass" => self.results.fields_after(number.unwrap_or(0)),
            "point" => self.results.point_fields(number.unwrap_or(1)),
            "increment" => self.results.increment_fields(number.unwrap_or(1)),
            "subsurface" => self.results.subsurface_fields(number),
            "plasticity" => self.results.plastic_fields(number),
            _ => self.results.static_fields(),
        }
    }
}

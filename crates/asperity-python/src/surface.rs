//! Surfaces: reading, generation, preparation, writing; quantities with units.

use std::path::{Path, PathBuf};

use asperity::Grid;
use asperity::motion::Watch;
use asperity::study::{self, PreparedTopography, SurfaceInput};
use asperity::surface::{ReadOptions, Round, Topography};
use asperity::units::{self, Dimension};
use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{array, field, ok};
use crate::{errors, tables, work};

/// Heights of a caller, and their pitch.
pub(crate) type Heights<'py> = (PyReadonlyArray2<'py, f64>, [f64; 2]);

/// Copies these heights to a topography.
pub(crate) fn topography(py: Python<'_>, (heights, pitch): &Heights<'_>) -> PyResult<Topography> {
    let heights = field(heights);
    let made =
        Grid::new([heights.nrows(), heights.ncols()], *pitch).and_then(|grid| Topography::new(grid, heights));
    ok(made, py)
}

/// Makes the topography described by a table, with the keys of `[lower.topography]` of a case; also returns
/// the findings of its preparation. `given` are the heights named by `given = "heights"`.
#[pyfunction]
#[pyo3(signature = (table, given=None))]
pub(crate) fn surface<'py>(
    py: Python<'py>,
    table: &Bound<'py, PyDict>,
    given: Option<Heights<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let whole = PyDict::new(py);
    whole.set_item("topography", table)?;
    let text = tables::text(&whole)?;
    let mut handed = SurfaceInput::default();
    if let Some(heights) = &given {
        handed.topographies.insert("heights".to_owned(), topography(py, heights)?);
    }
    let PreparedTopography { topography, origin, findings, .. } = work::run(py, 0, None, |looking| {
        study::topography_until(&text, Path::new(""), handed, &|| looking.stop())
    })?;
    let made = PyDict::new(py);
    made.set_item("pitch", topography.grid().pitch)?;
    made.set_item("underside", origin.is_some_and(|origin| origin.is_underside))?;
    made.set_item("undefined", findings.undefined)?;
    made.set_item("spikes", findings.spikes)?;
    made.set_item("radius", findings.form.map(|Round { radius, .. }| radius))?;
    made.set_item("heights", array(py, topography.into_heights()))?;
    Ok(made)
}

/// Checks a table as far as possible without its files.
#[pyfunction]
pub(crate) fn check_surface(py: Python<'_>, table: &Bound<'_, PyDict>) -> PyResult<()> {
    let whole = PyDict::new(py);
    whole.set_item("topography", table)?;
    ok(study::topography_spec(&tables::text(&whole)?, Path::new("")), py).map(|_| ())
}

/// Returns the names of the height channels of a file, the default one first.
#[pyfunction]
pub(crate) fn channels(py: Python<'_>, path: PathBuf) -> PyResult<Vec<String>> {
    work::run(py, 1, None, |_| Ok(ReadOptions::default().scan(path)?.channels))
}

/// Writes heights to a file, in the format given by its extension.
#[pyfunction]
pub(crate) fn write_surface(py: Python<'_>, path: PathBuf, heights: Heights<'_>) -> PyResult<()> {
    let topography = topography(py, &heights)?;
    work::run(py, 1, None, |_| topography.write(path))
}

/// Returns the dimension with this noun: "length".
fn dimension(name: &str) -> PyResult<Dimension> {
    let is_it = |known: &Dimension| known.noun().split_once(' ').is_some_and(|(_, noun)| noun == name);
    let unknown = || PyTypeError::new_err(format!("no dimension is called {name}"));
    Dimension::ALL.into_iter().find(is_it).ok_or_else(unknown)
}

/// Converts a quantity to SI, from a number or a text with a unit. `positive` requires it to be above 0,
/// `infinite` allows infinity. Errors name the `key`.
#[pyfunction]
#[pyo3(signature = (key, value, dimension, positive=true, infinite=false))]
pub(crate) fn quantity(
    py: Python<'_>,
    key: &str,
    value: &Bound<'_, PyAny>,
    dimension: &str,
    positive: bool,
    infinite: bool,
) -> PyResult<f64> {
    let dimension = self::dimension(dimension)?;
    let expected = || {
        let range = if positive { " above 0" } else { "" };
        format!("{}{range} such as \"{}\"", dimension.noun(), dimension.example())
    };
    let refused = |expected: &str, hint| {
        let written = value.repr().map_or_else(|_| String::new(), |text| text.to_string());
        errors::bad_input(py, key, &format!("'{key}' is {written}, expected {expected}"), hint)
    };
    let value = &tables::scalar(value)?;
    let number = match value.extract::<String>() {
        Ok(text) if text == "inf" => f64::INFINITY,
        Ok(text) if tables::is_bare(&text) => {
            return Err(errors::bad_input(py, key, &tables::bare(key, &text), None));
        }
        Ok(text) => units::parse(&text, dimension)
            .map_err(|error| errors::bad_input(py, key, &error.for_key(key), error.hint()))?,
        Err(_) => match value.extract() {
            Ok(number) => number,
            Err(_) => {
                let found = value.get_type().name()?;
                return Err(PyTypeError::new_err(format!(
                    "'{key}' is of type {found}, expected {}",
                    expected()
                )));
            }
        },
    };
    let range = dimension.range();
    let number = if positive { number } else { range.without_dust(number) };
    match number {
        f64::INFINITY if infinite => Ok(number),
        number if positive && range.holds(number) || !positive && range.holds_signed(number) => Ok(number),
        number if number.is_finite() && (number > 0.0 || !positive) => {
            Err(refused(&format!("a magnitude of {range}"), None))
        }
        _ => Err(refused(&expected(), None)),
    }
}

/// Formats a quantity for people.
#[pyfunction]
pub(crate) fn format(value: f64, dimension: &str) -> PyResult<String> {
    Ok(units::format(value, self::dimension(dimension)?))
}

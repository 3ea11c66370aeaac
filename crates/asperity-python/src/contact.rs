//! A static contact, in memory.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use asperity::motion::PlasticResult;
use asperity::study::case::Case;
use asperity::study::{self, NamedField, Outcome, StaticResult, SurfaceInput};
use numpy::ndarray::{Array4, ArrayD};
use numpy::{IntoPyArray, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{array, field, ok, record};
use crate::surface::{Heights, topography};
use crate::{tables, work};

/// Arguments of a call: surfaces by name, maps of the hardness by name.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct CallArguments<'py> {
    topographies: HashMap<String, Heights<'py>>,
    hardness: HashMap<String, PyReadonlyArray2<'py, f64>>,
}

impl CallArguments<'_> {
    /// Copies all of them.
    fn given(&self, py: Python<'_>) -> PyResult<SurfaceInput> {
        let mut given = SurfaceInput::default();
        for (name, heights) in &self.topographies {
            given.topographies.insert(name.clone(), topography(py, heights)?);
        }
        for (name, map) in &self.hardness {
            given.hardness.insert(name.clone(), field(map));
        }
        Ok(given)
    }
}

/// Source of a case.
#[derive(FromPyObject)]
pub(crate) enum Source<'py> {
    /// The tables of a case.
    Tables(Bound<'py, PyDict>),
    /// A case file.
    File(PathBuf),
}

impl Source<'_> {
    fn case(&self, py: Python<'_>, has_custom_laws: bool) -> PyResult<Case> {
        let nowhere = Path::new("");
        let case = match self {
            Self::Tables(tables) if has_custom_laws => {
                Case::parse_with_custom_laws(&tables::text(tables)?, nowhere, nowhere)
            }
            Self::Tables(tables) => Case::parse(&tables::text(tables)?, nowhere, nowhere),
            Self::File(path) => Case::load(path),
        };
        ok(case, py)
    }
}

/// Returns the case of a call with its surfaces; an error if it needs more memory than is available. Custom
/// laws may change the bodies of a motion.
pub(crate) fn asked(
    py: Python<'_>,
    source: &Source<'_>,
    handed: &CallArguments<'_>,
    threads: usize,
    has_custom_laws: bool,
) -> PyResult<(Case, SurfaceInput)> {
    let (case, given) = (source.case(py, has_custom_laws)?, handed.given(py)?);
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    let threads = if threads == 0 { cores() } else { threads };
    let demand = study::demand(&case, &given, threads);
    ok(demand.and_then(|demand| demand.fits(asperity_cli::available_memory())), py)?;
    Ok((case, given))
}

/// Computes a static contact.
#[pyfunction]
pub(crate) fn rest<'py>(
    py: Python<'py>,
    source: Source<'py>,
    handed: CallArguments<'py>,
    threads: usize,
    progress: Option<Bound<'py, PyAny>>,
    warn: Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyDict>> {
    let (case, given) = asked(py, &source, &handed, threads, false)?;
    let StaticResult {
        outcome,
        increments,
        updates,
        fields,
        interface,
        closed_form,
        plastic_result,
        found,
        warnings,
        ..
    } = work::run_warning(py, threads, progress.as_ref(), Some(&warn), |watch| {
        study::static_contact(&case, given, watch)
    })?;
    let contact = PyDict::new(py);
    match outcome {
        Outcome::Static(numbers) => contact.set_item("record", record(py, &numbers)?)?,
        Outcome::Sweep(points) => contact.set_item("sweep", record(py, &points)?)?,
        Outcome::Passes(_) => unreachable!("a static contact has no passes"),
    }
    contact.set_item("case", record(py, &case)?)?;
    contact.set_item("increments", record(py, &increments)?)?;
    contact.set_item("updates", record(py, &updates)?)?;
    contact.set_item("found", record(py, &found)?)?;
    contact.set_item("closed_form", record(py, &closed_form)?)?;
    contact.set_item("interface", record(py, &interface)?)?;
    contact.set_item("warnings", warnings)?;
    contact.set_item("pitch", fields.grid.pitch)?;
    contact.set_item("approach", fields.approach)?;
    let arrays = PyDict::new(py);
    for NamedField { name, unit, values, .. } in fields.fields {
        arrays.set_item(name, (array(py, values), unit))?;
    }
    contact.set_item("fields", arrays)?;
    if let Some(plastic_result) = plastic_result {
        contact.set_item("plastic_state", plastic_state(py, plastic_result)?)?;
    }
    Ok(contact)
}

/// Returns the plastic state below the surfaces: the arrays of each body, by their names in files.
fn plastic_state<'py>(py: Python<'py>, plastic_result: PlasticResult) -> PyResult<Bound<'py, PyDict>> {
    let bodies = PyDict::new(py);
    let layers_last = |values: ArrayD<f64>, axes: &[usize]| {
        values.permuted_axes(axes).as_standard_layout().into_owned().into_pyarray(py)
    };
    // From [layer, component, ix, iy] and [layer, ix, iy].
    let tensor = |values: Array4<f64>| layers_last(values.into_dyn(), &[1, 2, 3, 0]);
    let left = plastic_result.residual.into_iter().map(Some).chain(std::iter::repeat_with(|| None));
    for (volume, left) in plastic_result.volumes.into_iter().zip(left) {
        let body = PyDict::new(py);
        let left = left.unwrap_or_else(|| volume.clone());
        body.set_item("depths", volume.faces)?;
        body.set_item("strain", tensor(volume.state.strain))?;
        body.set_item("accumulated", layers_last(volume.state.accumulated.into_dyn(), &[1, 2, 0]))?;
        if let Some(back) = volume.state.back_stress {
            body.set_item("back_stress", tensor(back))?;
        }
        body.set_item("displacement", array(py, volume.displacement))?;
        body.set_item("residual_stress", tensor(left.residual_stress))?;
        body.set_item("residual_displacement", array(py, left.displacement))?;
        bodies.set_item(["lower", "upper"][volume.body], body)?;
    }
    Ok(bodies)
}

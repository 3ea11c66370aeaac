//! Conductance of a contact.

use asperity::conductance::{Gas, Joint, Kind, composite_conductivity, full_resistance, solve};
use asperity::operator::{Boundary, Edge, Operators};
use asperity::solver::Params;
use asperity::{Choice, Field, Grid};
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{array, field, ok};
use crate::work;

/// Solves a joint: cells in contact and pitch, boundary along both axes, kind, conductivities of both bodies, film,
/// conductivity and jump distance of the gas, gap, tolerance, number of threads.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "all of the physics of one call")]
pub(crate) fn conductance<'py>(
    py: Python<'py>,
    touching: (PyReadonlyArray2<'py, bool>, [f64; 2]),
    edges: [String; 2],
    kind: &str,
    conductivities: [f64; 2],
    film: f64,
    gas: Option<(f64, f64)>,
    gap: Option<PyReadonlyArray2<'py, f64>>,
    tolerance: f64,
    threads: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let (touching, pitch) = touching;
    let grid = ok(Grid::new([touching.shape()[0], touching.shape()[1]], pitch), py)?;
    let touching = touching.as_array().as_standard_layout().into_owned();
    let gap: Option<Field> = gap.as_ref().map(field);
    let edge = |word: &String| Edge::of_word(word).expect("a boundary is one of the words");
    let boundary = Boundary([edge(&edges[0]), edge(&edges[1])]);
    let kind = Kind::of_word(kind).expect("a kind is one of the words");
    let composite = ok(composite_conductivity(conductivities[0], conductivities[1]), py)?;
    let mut joint = Joint::new(kind, composite).with_film(film);
    if let Some((conductivity, jump)) = gas {
        joint = joint.with_gas(Gas { conductivity, jump });
    }
    let params = Params::default().with_tolerance(tolerance);
    let (found, full) = work::run(py, threads, None, |_| {
        let mut operator = Operators::new(grid, composite, boundary).on(grid.shape);
        let found = solve(operator.as_mut(), &touching, gap.as_ref(), &joint, None, &params)?;
        Ok((found, full_resistance(operator.as_mut(), &params)?))
    })?;
    let answer = PyDict::new(py);
    answer.set_item("conductance", found.conductance)?;
    answer.set_item("joint_conductance", found.joint_conductance())?;
    answer.set_item("resistance", found.resistance())?;
    answer.set_item("full_resistance", full)?;
    answer.set_item("holm_greenwood", found.holm_greenwood)?;
    answer.set_item("shares", [found.shares.spots, found.shares.gas, found.shares.film])?;
    answer.set_item("spots", found.spots.count())?;
    answer.set_item("median_cells", found.spots.median_cells)?;
    answer.set_item("iterations", found.stats.iterations)?;
    answer.set_item("residual", found.residual)?;
    answer.set_item("flux", found.flux.map(|flux| array(py, flux)))?;
    Ok(answer)
}

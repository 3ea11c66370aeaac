//! Computations from a map of a contact, or of a gap.

use asperity::conductance::{Joint, Kind, composite_conductivity, full_resistance};
use asperity::flow::{Along, Ends, Faces, FlowAlong, Fluid, Settings, Sides, memory};
use asperity::operator::Operators;
use asperity::solver::Params;
use asperity::{Choice, Error, Field, Grid};
use numpy::{IntoPyArray, PyArray2, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{array, boundary, field, ok};
use crate::surface::Heights;
use crate::work;

/// Adds the functions to the module.
pub(crate) fn add(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(conductance, module)?)?;
    module.add_function(wrap_pyfunction!(flow, module)?)
}

/// Solves a joint: cells in contact and pitch, boundary along both axes, kind, conductivities of both bodies,
/// film, conductivity and jump distance of the gas, gap, tolerance, number of threads.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "all of the physics of one call")]
fn conductance<'py>(
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
    let kind = Kind::of_word(kind).expect("a kind is one of the words");
    let composite = ok(composite_conductivity(conductivities[0], conductivities[1]), py)?;
    let mut joint = Joint::new(kind).with_film(film);
    if let Some((conductivity, jump)) = gas {
        joint = joint.with_gas(conductivity, jump);
    }
    let params = Params::default().with_tolerance(tolerance);
    let (found, full) = work::run(py, threads, None, |_| {
        let mut operator = Operators::new(grid, composite, boundary(&edges)).on(grid.shape);
        let found =
            asperity::conductance::solve(operator.as_mut(), &touching, gap.as_ref(), &joint, None, &params)?;
        Ok((found, full_resistance(operator.as_mut(), &params)?))
    })?;
    let answer = PyDict::new(py);
    answer.set_item("conductance", found.conductance)?;
    answer.set_item("joint_conductance", found.joint_conductance(full))?;
    answer.set_item("resistance", found.resistance())?;
    answer.set_item("full_resistance", full)?;
    answer.set_item("holm_greenwood", found.holm_greenwood(composite))?;
    answer.set_item("shares", [found.shares.spots, found.shares.gas, found.shares.film])?;
    answer.set_item("spots", found.spots.count())?;
    answer.set_item("median_cells", found.spots.median_cells)?;
    answer.set_item("iterations", found.stats.iterations)?;
    answer.set_item("residual", found.residual)?;
    answer.set_item("flux", found.flux.map(|flux| array(py, flux)))?;
    Ok(answer)
}

/// Numbers of a flow along an axis by their names; leakage is `None` without viscosity.
type Numbers = Vec<(&'static str, f64)>;

/// Numbers, bounds for the other faces, cell of the critical constriction, leakage, pressure, flux along x
/// and y, cells that flow.
type AlongAxis<'py> = (
    Numbers,
    [f64; 2],
    Option<[usize; 2]>,
    Option<f64>,
    Bound<'py, PyArray2<f64>>,
    [Bound<'py, PyArray2<f64>>; 2],
    Bound<'py, PyArray2<bool>>,
);

/// Solves for the flow through a gap along both axes; a fluid has a viscosity, a drop of its pressure, and
/// the absolute pressure of the outlet of a gas. Ends and sides are those of the flow along each axis.
/// Returns numbers of the gap, the coupling of both directions, and the flow along each.
#[pyfunction]
fn flow<'py>(
    py: Python<'py>,
    gap: Heights<'py>,
    ends: [String; 2],
    sides: [String; 2],
    faces: &str,
    fluid: Option<(f64, f64, Option<f64>)>,
    threads: usize,
) -> PyResult<(Numbers, Option<f64>, Vec<AlongAxis<'py>>)> {
    let (gap, pitch) = (field(&gap.0), gap.1);
    let grid = ok(Grid::new([gap.nrows(), gap.ncols()], pitch), py)?;
    let fluid = fluid.map(|(viscosity, drop, outlet)| Fluid { viscosity, drop, outlet });
    let ends = ends.map(|word| Ends::of_word(&word).expect("ends are one of the words"));
    let sides = sides.map(|word| Sides::of_word(&word).expect("sides are one of the words"));
    let faces = Faces::of_word(faces).expect("faces are one of the words");
    let settings = Settings::of_axes(ends, sides, faces, Along::Both);
    let (needed, available) = (memory(grid.shape), asperity_cli::available_memory());
    if needed > available {
        return ok(Err(Error::Memory { needed, available }), py);
    }
    let (flow, leakage) = work::run(py, threads, None, |_| {
        let flows = settings.iter().map(|settings| asperity::flow::solve(&gap, &grid, settings));
        let mut flows = flows.collect::<asperity::Result<Vec<_>>>()?;
        let mut flow = flows.swap_remove(0);
        // Ends that differ between the axes take a solution for each.
        if let Some(along_y) = flows.pop() {
            let [_, along_y] = along_y.along;
            flow.along[1] = along_y;
        }
        let leakage = |along: &FlowAlong| fluid.map(|fluid| along.leakage(&fluid)).transpose();
        let leakage = flow.along.iter().flatten().map(leakage).collect::<asperity::Result<Vec<_>>>()?;
        Ok((flow, leakage))
    })?;
    let numbers = vec![
        ("mean_gap", flow.mean_gap),
        ("closed_share", flow.closed_share),
        ("effective_medium", flow.effective_medium),
    ];
    let coupling = flow.coupling;
    let along = flow.along.into_iter().flatten().zip(leakage);
    let along = along.map(|(along, leakage)| {
        let numbers = vec![
            ("permeability", along.permeability),
            ("hydraulic_gap", along.hydraulic_gap),
            ("flow_factor", along.flow_factor),
            ("critical_gap", along.critical_gap),
            ("flowing_share", along.flowing_share),
            ("trapped_volume", along.trapped_volume),
            ("estimate", along.estimate),
            ("residual", along.residual),
            ("dissipation", along.dissipation),
        ];
        let flux = along.flux_at_centres().map(|flux| array(py, flux));
        let FlowAlong { other_faces, critical_cell, pressure, flowing, .. } = along;
        (numbers, other_faces, critical_cell, leakage, array(py, pressure), flux, flowing.into_pyarray(py))
    });
    Ok((numbers, coupling, along.collect()))
}

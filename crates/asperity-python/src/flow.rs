//! Flow through a gap.

use asperity::Choice;
use asperity::flow::{Along, Ends, Faces, FlowAlong, Settings, Sides, memory, solve};
use asperity::{Error, Grid};
use numpy::{IntoPyArray, PyArray2};
use pyo3::prelude::*;

use crate::arrays::{array, field, ok};
use crate::surface::Heights;
use crate::work;

/// Numbers of a flow along an axis by their names; leakage is `None` without viscosity.
type Numbers = Vec<(&'static str, f64)>;

/// Numbers, bounds for the other faces, cell of the critical constriction, leakage, pressure, flux along x and y, cells that flow.
type AlongAxis<'py> = (
    Numbers,
    [f64; 2],
    Option<[usize; 2]>,
    Option<f64>,
    Bound<'py, PyArray2<f64>>,
    [Bound<'py, PyArray2<f64>>; 2],
    Bound<'py, PyArray2<bool>>,
);

/// A fluid: its viscosity, the drop of its pressure, and the absolute pressure of the outlet of a gas.
type Fluid = (f64, f64, Option<f64>);

/// Solves for the flow through a gap along both axes. Returns numbers of the gap, the coupling of both directions, and the flow along each.
#[pyfunction]
pub(crate) fn flow<'py>(
    py: Python<'py>,
    gap: Heights<'py>,
    ends: &str,
    sides: &str,
    faces: &str,
    fluid: Option<Fluid>,
    threads: usize,
) -> PyResult<(Numbers, Option<f64>, Vec<AlongAxis<'py>>)> {
    let (gap, pitch) = (field(&gap.0), gap.1);
    let grid = ok(Grid::new([gap.nrows(), gap.ncols()], pitch), py)?;
    let settings = Settings {
        ends: Ends::of_word(ends).expect("ends are one of the words"),
        sides: Sides::of_word(sides).expect("sides are one of the words"),
        faces: Faces::of_word(faces).expect("faces are one of the words"),
        along: Along::Both,
    };
    let (needed, available) = (memory(grid.shape), asperity_cli::available_memory());
    if needed > available {
        return ok(Err(Error::Memory { needed, available }), py);
    }
    let (flow, leakage) = work::run(py, threads, None, |_| {
        let flow = solve(&gap, &grid, &settings)?;
        let leakage = |along: &FlowAlong| match fluid {
            None => Ok(None),
            Some((viscosity, drop, None)) => along.leakage(drop, viscosity).map(Some),
            Some((viscosity, drop, Some(outlet))) => {
                along.gas_leakage(outlet + drop, outlet, viscosity).map(Some)
            }
        };
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

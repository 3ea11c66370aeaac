//! Fatigue of a body that contacts pass over.

use asperity::fatigue::{AtDepth, Basquin, DangVan, StressHistory, critical_depths};
use asperity::kernel::Stack;
use asperity::motion::Watch;
use asperity::ndarray::{Array3, Axis, Ix3};
use asperity::subsurface::Tractions;
use asperity::{Field, Grid};
use numpy::{IntoPyArray, PyArray2, PyArray3, PyReadonlyArray3};
use pyo3::prelude::*;

use crate::arrays::{boundary, ok};
use crate::reference::{Constants, material};
use crate::work;

/// A pass: the pressure at each position `[it, ix, iy]`, the pitch, the ratio of the shear along x to the
/// pressure at each position, the boundary along both axes, and elastic constants.
type Pass<'py> = (PyReadonlyArray3<'py, f64>, [f64; 2], Vec<f64>, [String; 2], Constants);

/// Arrays `[iz, ix, iy]`.
type Planes<'py> = Vec<Bound<'py, PyArray3<f64>>>;

/// Computes Dang Van's f, the radius of the smallest ball and the amplitude of the shear, each
/// `[iz, ix, iy]`, and a and b of the criterion.
#[pyfunction]
pub(crate) fn fatigue<'py>(
    py: Python<'py>,
    pass_: Pass<'py>,
    limits: [f64; 2],
    depths: Vec<f64>,
    threads: usize,
) -> PyResult<(Planes<'py>, [f64; 2])> {
    let (pressures, pitch, friction, edges, constants) = pass_;
    let material = ok(material(constants), py)?;
    let pressures = pressures.as_array().as_standard_layout().into_owned();
    let (positions, nx, ny) = pressures.dim();
    let grid = ok(Grid::new([nx, ny], pitch), py)?;
    let boundary = boundary(&edges);
    let criterion = ok(DangVan::new(limits[0], limits[1]), py)?;
    let found = work::run(py, threads, None, |watch| {
        let at = |position: usize| {
            let pressure = pressures.index_axis(Axis(0), position).to_owned();
            let shear = (friction[position] != 0.0).then(|| friction[position] * &pressure);
            Tractions { pressure, shear: [shear, None] }
        };
        let stop = || watch.stop();
        let history = StressHistory::new(grid, boundary, material.poisson, positions, at);
        let history = history.with_layers(Stack::of(&material)).until(&stop);
        history.dang_van(&criterion, &depths)
    })?;
    let together = |field: fn(&AtDepth) -> &Field| {
        let values: Vec<f64> = found.iter().flat_map(|at| field(at).iter().copied()).collect();
        let shape = Ix3(depths.len(), nx, ny);
        Array3::from_shape_vec(shape, values).expect("planes of one grid").into_pyarray(py)
    };
    let fields = vec![together(|at| &at.f), together(|at| &at.radius), together(|at| &at.shear_amplitude)];
    Ok((fields, [criterion.weight(), criterion.limit()]))
}

/// The damage of a pass at each depth, and the critical depth of each column.
type Damage<'py> = (Bound<'py, PyArray3<f64>>, Bound<'py, PyArray2<f64>>);

/// Computes the damage of a pass at each depth `[iz, ix, iy]`, and the depth that a column must lose in a
/// pass for it not to pit, from f over its limit.
#[pyfunction]
pub(crate) fn damage<'py>(
    py: Python<'py>,
    over_limit: PyReadonlyArray3<'py, f64>,
    depths: Vec<f64>,
    law: (f64, f64, bool),
) -> PyResult<Damage<'py>> {
    let (exponent, cycles, endurance) = law;
    let law = ok(Basquin::new(exponent, cycles, endurance), py)?;
    let damage = over_limit.as_array().mapv(|over| law.damage(over));
    let critical = critical_depths(&depths, &damage);
    Ok((damage.into_pyarray(py), critical.into_pyarray(py)))
}

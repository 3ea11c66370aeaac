//! Stress below a surface.

use asperity::kernel::Stack;
use asperity::motion::Watch;
use asperity::stress::Stress;
use asperity::subsurface::{Extreme, Maximum, Subsurface, Tractions};
use asperity::{Error, Field, Grid};
use numpy::{IntoPyArray, PyArray1, PyArray3, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::arrays::{boundary, field, ok};
use crate::reference::{Constants, material};
use crate::surface::Heights;
use crate::work;

/// Loading of a body: pressure and pitch, shear along x and y on the lower body, boundary along both axes,
/// elastic constants, and whether it is the upper body.
type LoadedBody<'py> = (Heights<'py>, [Option<PyReadonlyArray2<'py, f64>>; 2], [String; 2], Constants, bool);

/// Creates the body on any thread.
fn body(py: Python<'_>, given: &LoadedBody<'_>) -> PyResult<(impl Fn() -> Subsurface + Send + use<>, Grid)> {
    let ((pressure, pitch), shear, edges, constants, is_upper) = given;
    let pressure = field(pressure);
    let grid = ok(Grid::new([pressure.nrows(), pressure.ncols()], *pitch), py)?;
    let boundary = boundary(edges);
    let tractions = Tractions { pressure, shear: shear.each_ref().map(|shear| shear.as_ref().map(field)) };
    let tractions = if *is_upper { tractions.on_upper() } else { tractions };
    let material = ok(material(constants.clone()), py)?;
    let body = move || {
        Subsurface::new(grid, boundary, material.poisson, &tractions).with_layers(Stack::of(&material))
    };
    Ok((body, grid))
}

/// Computes the components of the stress at the depths, each `[iz, ix, iy]`.
#[pyfunction]
pub(crate) fn stress<'py>(
    py: Python<'py>,
    given: LoadedBody<'py>,
    depths: Vec<f64>,
    threads: usize,
) -> PyResult<Vec<Bound<'py, PyArray3<f64>>>> {
    let (body, grid) = body(py, &given)?;
    // Six components of all planes, twice while they are joined.
    let needed = 12.0 * 8.0 * depths.len() as f64 * grid.cells() as f64;
    let available = asperity_cli::available_memory();
    if needed > available {
        return ok(Err(Error::Memory { needed, available }), py);
    }
    let shape = [depths.len(), grid.shape[0], grid.shape[1]];
    let components = work::run(py, threads, None, |watch| {
        let body = body();
        let plane = |depth: &f64| {
            if watch.stop() { Err(Error::Interrupted) } else { Ok(body.plane(*depth).stress) }
        };
        let planes = depths.par_iter().map(plane).collect::<Result<Vec<[Field; 6]>, _>>()?;
        let together = |component: usize| {
            let values: Vec<f64> = planes.iter().flat_map(|plane| plane[component].iter().copied()).collect();
            asperity::ndarray::Array3::from_shape_vec(shape, values).expect("planes of one grid")
        };
        Ok((0..6).map(together).collect::<Vec<_>>())
    })?;
    Ok(components.into_iter().map(|component| component.into_pyarray(py)).collect())
}

/// A value, its cell and its depth.
type Most = (f64, [usize; 2], f64);

/// Computes the largest von Mises stress and the largest shear, on planes at the depths and between them.
#[pyfunction]
pub(crate) fn most_stressed(
    py: Python<'_>,
    given: LoadedBody<'_>,
    depths: Vec<f64>,
    threads: usize,
) -> PyResult<(Most, Most)> {
    let (body, _) = body(py, &given)?;
    let Maximum { von_mises, shear, .. } = work::run(py, threads, None, |_| Ok(body().maximum(&depths)))?;
    let most = |Extreme { value, cell, depth, .. }: Extreme| (value, cell, depth);
    Ok((most(von_mises), most(shear)))
}

/// Computes von Mises' stress, the largest shear, or the concatenated principal stresses, from these
/// components.
#[pyfunction]
pub(crate) fn invariants<'py>(
    py: Python<'py>,
    which: &str,
    components: [PyReadonlyArray1<'py, f64>; 6],
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let components = components.map(|component| component.as_array().to_vec());
    let count = components[0].len();
    let at = |i: usize| Stress::from_components(components.each_ref().map(|component| component[i]));
    let values: Vec<f64> = work::run(py, 0, None, |_| {
        Ok(match which {
            "von_mises" => (0..count).into_par_iter().map(|i| at(i).von_mises()).collect(),
            "max_shear" => (0..count).into_par_iter().map(|i| at(i).max_shear()).collect(),
            _ => {
                let all: Vec<_> = (0..count).into_par_iter().map(|i| at(i).principal()).collect();
                (0..3).flat_map(|k| all.iter().map(move |principal| principal[k])).collect()
            }
        })
    })?;
    Ok(values.into_pyarray(py))
}

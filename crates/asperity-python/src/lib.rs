//! Private module of the Python package: arrays and tables in, arrays and records out.
//!
//! It contains no physics, and checks only types. The library defines what a case may contain, and the public
//! classes are written in Python, in `python/asperity`.

mod arrays; // conversion of matrices and records
mod cases; // a study: many cases made from one
mod command; // the command `asperity`
mod contact; // a static contact
mod describe; // description of surfaces
mod errors; // exceptions
mod maps; // what is computed from a map of a contact or of a gap
mod fatigue;
mod joint;
mod passes; // a motion, pass after pass
mod reference; // closed forms
mod results; // reading of a results directory
mod stress; // the stress below a surface
mod surface; // surfaces: reading, generation, preparation, writing
mod tables; // dictionaries to the tables of a case
mod verify; // comparison with closed forms
mod work; // a computation on separate threads

use asperity::reference::rough;
use asperity::study;
use asperity::surface::WOLF_PRUNING;
use pyo3::prelude::*;

#[pymodule(gil_used = false)]
mod _core {
    #[pymodule_export]
    use super::cases::CoreStudy;
    #[pymodule_export]
    use super::command::main;
    #[pymodule_export]
    use super::contact::rest;
    #[pymodule_export]
    use super::describe::{
        CoreBearingCurve, CoreCorrelation, CoreSpectrum, distribution, feature_parameters,
        height_differences, line_heights, line_parameters, moments_by_differences, parameters, profile,
        profile_parameters, segments, self_affinity_of_differences, summits,
    };
    #[pymodule_export]
    use super::fatigue::{damage, fatigue};
    #[pymodule_export]
    use super::joint::joint;
    #[pymodule_export]
    use super::passes::{CorePasses, run};
    #[pymodule_export]
    use super::reference::{closed_form, compliances, named_materials, named_oils};
    #[pymodule_export]
    use super::results::{CoreResults, unit_of_column};
    #[pymodule_export]
    use super::stress::{invariants, most_stressed, stress};
    #[pymodule_export]
    use super::surface::{channels, check_surface, format, quantity, surface, write_surface};
    #[pymodule_export]
    use super::verify::{verdict, verification_cases, verify};

    use super::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        crate::maps::add(module)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        module.add("STEP_COLUMNS", study::STEP_COLUMNS)?;
        module.add("PASS_COLUMNS", study::PASS_COLUMNS)?;
        module.add("INCREMENT_COLUMNS", study::INCREMENT_COLUMNS)?;
        module.add("SWEEP_COLUMNS", study::SWEEP_COLUMNS)?;
        let units: Vec<_> = study::columns().iter().map(|column| (column.name, column.unit)).collect();
        module.add("COLUMN_UNITS", units)?;
        module.add("MAX_THREADS", asperity_cli::MAX_THREADS)?;
        module.add("COUPLED_PUNCHES", crate::reference::coupled_punches())?;
        module.add("AREA_COEFFICIENTS", [rough::BGT_COEFFICIENT, rough::PERSSON_COEFFICIENT])?;
        module.add("WOLF_PRUNING", WOLF_PRUNING)?;
        module.add("ERRORS", asperity::Error::VARIANTS.to_vec())
    }
}

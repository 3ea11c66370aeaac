//! The private module of the Python package: arrays and tables in, arrays and records out.
//!
//! It holds no physics, and no checks but those of types: what a case may say, the library tells, and the classes that users
//! meet are Python, in `python/asperity`.

mod arrays; // matrices and records, there and back
mod command; // the command `asperity`
mod contact; // a contact at rest
mod errors; // exceptions
mod passes; // a motion, pass after pass
mod results; // a results directory, to be read
mod surface; // surfaces: read, made, prepared, written
mod tables; // dictionaries as the tables of a case
mod work; // a computation on threads of its own

use asperity::study;
use pyo3::prelude::*;

#[pymodule(gil_used = false)]
mod _core {
    #[pymodule_export]
    use super::command::main;
    #[pymodule_export]
    use super::contact::rest;
    #[pymodule_export]
    use super::passes::{CorePasses, run};
    #[pymodule_export]
    use super::results::CoreResults;
    #[pymodule_export]
    use super::surface::{channels, check_surface, format, quantity, surface, write_surface};

    use super::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        module.add("STEP_COLUMNS", study::STEP_COLUMNS)?;
        module.add("PASS_COLUMNS", study::PASS_COLUMNS)?;
        module.add("INCREMENT_COLUMNS", study::INCREMENT_COLUMNS)?;
        module.add("SWEEP_COLUMNS", study::SWEEP_COLUMNS)
    }
}

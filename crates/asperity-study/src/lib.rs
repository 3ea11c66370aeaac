//! A study of a case: from a case file to its results.
//!
//! [`Case::load`] reads the case file. [`bodies`] reads or generates its surfaces and prepares them. [`demand`] and
//! [`estimate`] return cost and warnings in advance. [`run()`] does all of this and writes a [`Results`] directory with a
//! [`Summary`].

mod adhesion; // adhesion of a case in numbers
pub mod case; // the case file, checked key by key
mod closed_form; // closed forms beside computed contacts
mod estimate; // cost and warnings of a case in advance
mod fields; // the fields of a static contact
mod finish; // beginning and end of every run
mod flow; // elasto-plastic bodies of a case
mod given; // surfaces in memory that a case names
mod identity; // identity of a run, to resume it
pub mod io; // fields in HDF5 and for ParaView, digests, locks
mod json; // records as JSON
mod limits; // the limits of the model, compared with results
mod columns; // the dictionary of columns and numbers
pub mod many; // many cases made from one, each in its folder
mod observe; // observers of solved contacts
mod observed; // records of what they have found
mod passes; // a motion, pass after pass
mod prepare; // from a case to its two surfaces
mod rest; // a static contact
mod results; // the results directory
mod review; // warnings about a result
mod run; // from a case to its results
mod slabs; // a static contact distributed over ranks
mod subsurface; // the stress under the surface: plan and file
mod summary; // summary.json
mod tables; // steps.csv, passes.csv, increments.csv, sweep.csv

pub use adhesion::AdhesionSummary;
pub use case::Case;
pub use case::rules::rules;
pub use case::schema::keys;
pub use case::schema::tables::dimension as dimension_of_key;
pub use closed_form::{ClosedForm, ClosedFormRecord, Theory};
pub use columns::{
    INCREMENT_COLUMNS, PASS_COLUMNS, RECORDS, STEP_COLUMNS, SWEEP_COLUMNS, column, columns,
    dimension_of_column, unit_of_column,
};
pub use estimate::{Demand, Estimate, demand, estimate};
pub use fields::{NamedField, RestFields};
pub use given::SurfaceInput;
pub use identity::resolved;
pub use observed::{BrokenLimit, ConductanceRecord, ElectricalRecord, GapFlowRecord, Limit, ThermalRecord};
pub use passes::Passes;
pub use prepare::{
    Bodies, MountedSurface, Origin, PreparedTopography, bodies, bodies_until, exact_pitch, grids, topography,
    topography_spec, topography_until,
};
pub use rest::{StaticResult, rest};
pub use results::{
    Existing, Results, StepWriter, Writer, cap_name, pressure_name, temperature_name, traction_name,
};
pub use run::run;
pub use slabs::{DemandOfRank, collect, demand_of_collecting, demand_on_ranks, run_on_ranks};
pub use subsurface::{Plan, SubsurfaceRecord};
pub use summary::{Outcome, RunningIn, Summary};

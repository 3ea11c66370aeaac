//! A study of a case: from a case file to its results.
//!
//! [`Case::load`] reads the case file, [`bodies`] reads or makes and prepares its surfaces, [`demand`] and [`estimate`] tell
//! what is to be expected, [`run()`] does all of it and leaves a [`Results`] directory with a [`Summary`].

pub mod case; // case.toml, checked to the key
mod estimate; // what a case will take, and what to be wary of
mod fields; // the fields of a static contact
mod finish; // what every run begins with and ends with
mod flow; // bodies that flow below their surfaces, as a case has them
mod given; // surfaces in memory that a case names
mod identity; // what a run is known by, to resume it
mod json; // records as JSON
mod columns; // the dictionary of columns and numbers
pub mod many; // many cases made of one, in folders of their own
mod passes; // a motion, pass after pass
mod prepare; // from a case to the two surfaces that meet
mod rest; // a static contact
mod results; // the results directory
mod review; // what to be wary of in a result
mod run; // from a case to its results
mod slabs; // a contact at rest on ranks, each with a slab of it
mod subsurface; // the stress under the surface: where it is wanted, its file
mod summary; // summary.json
mod tables; // steps.csv, passes.csv, increments.csv, sweep.csv

pub use case::Case;
pub use case::rules::rules;
pub use case::schema::keys;
pub use case::schema::tables::dimension as dimension_of_key;
pub use columns::{
    INCREMENT_COLUMNS, PASS_COLUMNS, RECORDS, STEP_COLUMNS, SWEEP_COLUMNS, column, columns,
    dimension_of_column, unit_of_column,
};
pub use estimate::{Demand, Estimate, demand, estimate};
pub use fields::{NamedField, RestFields};
pub use given::Given;
pub use identity::resolved;
pub use passes::Passes;
pub use prepare::{
    Bodies, Made, Origin, Prepared, bodies, bodies_until, exact_pitch, grids, topography, topography_spec,
    topography_until,
};
pub use rest::{Rest, rest};
pub use results::{
    Existing, Results, StepWriter, Writer, cap_name, pressure_name, temperature_name, traction_name,
};
pub use run::run;
pub use slabs::{DemandOfRank, collect, demand_of_collecting, demand_on_ranks, run_on_ranks};
pub use subsurface::{Plan, SubsurfaceRecord};
pub use summary::{Outcome, RunningIn, Summary};

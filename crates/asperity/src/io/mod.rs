//! Files: topographies and case files in, results out.

pub mod atomic; // a file is there in full or not at all
pub mod case; // case.toml, checked to the key
pub mod engine; // from a case to its results
pub mod fields; // HDF5: named fields with unit, axes, pitch
pub mod identity; // what a run is known by, to resume it
pub mod loading; // increments of a loading, kept one by one
pub mod outlook; // what a case will take, and what to be wary of
pub mod prepare; // from a case to the two surfaces that meet
mod regular; // regular files, read as a whole
pub mod results; // the results directory
mod review; // what to be wary of in a result
pub mod subsurface; // the stress under the surface: where it is wanted, its file
pub mod summary; // summary.json
pub mod sweep; // points of a sweep, kept one by one
pub mod tables; // steps.csv, passes.csv, increments.csv
pub mod topography; // x3p, npy, sur, text in; x3p, npy, vtk out
mod warm_start; // where the next pass begins
pub mod vti; // fields for ParaView

//! Files: topographies in, results out.

/// Files that are there in full or not at all.
pub mod atomic;
/// Named fields with units and axes: the HDF5 container of the results.
pub mod fields;
/// `summary.json`: what was computed, in numbers.
pub mod summary;
/// `steps.csv` and `passes.csv`: a row per position, a row per pass.
pub mod tables;
/// Measured topographies: x3p, npy, sur, text; npy, x3p and vtk are also written.
pub mod topography;

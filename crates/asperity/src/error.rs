//! The one error of the library: each variant carries the numbers needed to act on it.

use std::path::PathBuf;

use crate::units::{Metre, Newton};

/// `Result` with this library's [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

/// Everything that can go wrong, by cause.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    // ---- input of any kind -------------------------------------------------------------------------------
    /// A quantity lies outside the range in which it has a meaning.
    #[error("{quantity} is {value:e}, expected {expected}")]
    OutOfRange {
        /// The quantity's name, as the user knows it.
        quantity: &'static str,
        /// The value given, SI.
        value: f64,
        /// What would have been accepted.
        expected: &'static str,
    },
    /// Two grids that must agree do not.
    #[error("{what}: {left} and {right} differ")]
    GridMismatch {
        /// What must agree, for example "pitch of the two bodies".
        what: &'static str,
        /// Of the first.
        left: String,
        /// Of the second.
        right: String,
    },
    /// A combination that has no meaning.
    #[error("{0}")]
    Unsupported(&'static str),

    // ---- topography files --------------------------------------------------------------------------------
    /// A topography has undefined samples where every one is needed.
    #[error("{undefined} of {samples} samples are undefined: set fill = \"nearest\" or fill = \"harmonic\"")]
    UndefinedSamples {
        /// Number of undefined samples.
        undefined: usize,
        /// Number of all samples.
        samples: usize,
    },
    /// A topography without any defined sample, from which nothing can be filled.
    #[error("none of the {samples} samples is defined")]
    NothingDefined {
        /// Number of all samples.
        samples: usize,
    },
    /// A window that does not lie within the topography.
    #[error("window = {window:?} ([x0, y0, nx, ny]) is not a part of the {} × {} samples", shape[0], shape[1])]
    WindowOutside {
        /// First sample and number of samples, `[x0, y0, nx, ny]`.
        window: [usize; 4],
        /// Samples of the topography along x and y.
        shape: [usize; 2],
    },
    // ---- case file ---------------------------------------------------------------------------------------
    // ---- contact -----------------------------------------------------------------------------------------
    /// The load is more than the bodies can carry when every cell is at the hardness.
    #[error("load {load:.6e} N exceeds the plastic limit {limit:.6e} N (every facing cell at the hardness)")]
    BeyondPlasticLimit {
        /// The load asked for.
        load: Newton,
        /// The largest load that can be carried.
        limit: Newton,
    },
    /// The iteration ended above the tolerance.
    #[error(
        "no equilibrium after {iterations} iterations: residual {residual:.2e}, tolerance {tolerance:.2e}"
    )]
    NotConverged {
        /// Iterations spent.
        iterations: usize,
        /// Scale-free complementarity residual η reached.
        residual: f64,
        /// η asked for.
        tolerance: f64,
    },
    /// An approach at which a periodic contact has no solution: the mean displacement is free there.
    #[error("approach {approach:.6e} m closes the whole periodic gap (mean gap {mean_gap:.6e} m)")]
    PeriodicFullContact {
        /// The approach asked for.
        approach: Metre,
        /// The mean undeformed gap, the limit of the approach.
        mean_gap: Metre,
    },
    /// The caller asked for the computation to stop.
    #[error("interrupted")]
    Interrupted,

    // ---- results -----------------------------------------------------------------------------------------
    /// A file could not be read or written.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        source: std::io::Error,
    },
}

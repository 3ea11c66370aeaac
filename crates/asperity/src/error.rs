//! The one error of the library: each variant carries the numbers needed to act on it.

mod case;
mod detail;

use std::path::PathBuf;

pub use case::CaseError;
pub use detail::Detail;

use crate::units::{Dimension, Metre, Newton, bytes, format, format_distinct, format_number};

/// `Result` with this library's [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

/// [`Error::OutOfRange`] of a pure number unless `good`.
pub(crate) fn check(quantity: &'static str, value: f64, good: bool, expected: &'static str) -> Result<()> {
    if good { Ok(()) } else { Err(Error::OutOfRange { quantity, value, dimension: None, expected }) }
}

/// [`Error::OutOfRange`] of a value of `dimension`, SI, unless `good`.
pub(crate) fn check_in(
    dimension: Dimension,
    quantity: &'static str,
    value: f64,
    good: bool,
    expected: &'static str,
) -> Result<()> {
    let dimension = Some(dimension);
    if good { Ok(()) } else { Err(Error::OutOfRange { quantity, value, dimension, expected }) }
}

// The macro also gives the name and the fields of each variant.
detail::causes! {
/// Everything that can go wrong, by cause.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    // ---- input of any kind -------------------------------------------------------------------------------
    /// A quantity lies outside the range in which it has a meaning.
    #[error("{quantity} is {}, expected {expected}", dimension.map_or_else(|| format_number(*value), |d| format(*value, d)))]
    OutOfRange {
        /// The quantity's name, as the user knows it.
        quantity: &'static str,
        /// The value given, SI.
        value: f64,
        /// What it measures; none for a pure number.
        dimension: Option<Dimension>,
        /// What would have been accepted.
        expected: &'static str,
    },
    /// Two grids that must agree do not.
    #[error("{what}: {left} and {right} differ")]
    GridMismatch {
        /// What must agree, for example "pitch of the two bodies".
        what: &'static str,
        /// What it is on the first grid.
        left: String,
        /// What it is on the second grid.
        right: String,
    },
    /// More ranks than rows of the grid that is divided among them.
    #[error("{ranks} ranks are too many for a grid of {rows} rows along x")]
    TooManyRanks {
        /// Number of ranks.
        ranks: usize,
        /// Number of rows.
        rows: usize,
    },
    /// Ranks that are to compute one contact together have not the same.
    #[error("rank {rank} has another {what} than rank 0")]
    RanksDiffer {
        /// The first rank that differs.
        rank: usize,
        /// What it has, for example "version of asperity".
        what: &'static str,
    },
    /// A combination that has no meaning.
    #[error("{0}")]
    Unsupported(&'static str),

    // ---- topography files --------------------------------------------------------------------------------
    /// A file that is in none of the formats read.
    #[error("{path} is not a topography: {reason}")]
    NotATopography {
        /// The file.
        path: PathBuf,
        /// What it looks like instead.
        reason: &'static str,
    },
    /// A file of a known format that is damaged, or uses a part of the format that is not read.
    #[error("{path}: {format}: {reason}")]
    CorruptTopography {
        /// The file.
        path: PathBuf,
        /// The format it was recognised as.
        format: &'static str,
        /// What is wrong, and where.
        reason: Defect,
    },
    /// A channel that the file does not have, or none where one is to be chosen.
    #[error("{}", no_channel(path, channel))]
    NoChannel {
        /// The file.
        path: PathBuf,
        /// The channel asked for; empty if none was.
        channel: String,
        /// The channels there are.
        available: Vec<String>,
    },
    /// A unit given to a file whose heights have one.
    #[error("{path}: {format}: its heights have a unit of their own, expected none to be given")]
    OwnUnit {
        /// The file.
        path: PathBuf,
        /// The format it was recognised as.
        format: &'static str,
    },
    /// A topography file without a pitch, where none is given.
    #[error("{path} ({format}) has no pitch")]
    NoPitch {
        /// The file.
        path: PathBuf,
        /// The format it was recognised as.
        format: &'static str,
    },
    /// A name of a file that tells no format to write a topography in.
    #[error("no format to write `{path}` in")]
    NoFormat {
        /// The file.
        path: PathBuf,
    },
    /// A topography has undefined samples where every one is needed.
    #[error("{undefined} of {samples} samples are undefined")]
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
    #[error("the window {window:?} ([x0, y0, nx, ny]) is not a part of the {} × {} samples", shape[0], shape[1])]
    WindowOutside {
        /// First sample and number of samples, `[x0, y0, nx, ny]`.
        window: [usize; 4],
        /// Samples of the topography along x and y.
        shape: [usize; 2],
    },
    // ---- case file ---------------------------------------------------------------------------------------
    /// A case file says what has no meaning.
    #[error(transparent)]
    Case(Box<CaseError>),

    // ---- contact -----------------------------------------------------------------------------------------
    /// The load is more than the bodies can carry when every cell is at the hardness.
    #[error(
        "load {} exceeds the plastic limit {} (every facing cell at the hardness)",
        forces(*load, *limit)[0],
        forces(*load, *limit)[1]
    )]
    BeyondPlasticLimit {
        /// The load asked for.
        load: Newton,
        /// The largest load that can be carried.
        limit: Newton,
    },
    /// The tangential force is more than friction can hold: the bodies slide.
    #[error(
        "tangential force {} is not below what friction holds, {}: the bodies slide",
        forces(*force, *limit)[0],
        forces(*force, *limit)[1]
    )]
    BeyondFriction {
        /// The force asked for.
        force: Newton,
        /// What it must stay below.
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
    #[error(
        "approach {} closes the whole periodic gap (mean gap {})",
        format_distinct([*approach, *mean_gap], Dimension::Length)[0],
        format_distinct([*approach, *mean_gap], Dimension::Length)[1]
    )]
    PeriodicFullContact {
        /// The approach asked for.
        approach: Metre,
        /// The mean undeformed gap, the limit of the approach.
        mean_gap: Metre,
    },
    /// No approach gives the load wanted as the mean over a pass.
    #[error(
        "no approach found for the pass-mean load {} in {trials} trials (last approach {})",
        format(*load, Dimension::Force),
        format(*approach, Dimension::Length)
    )]
    LoadNotReached {
        /// The pass-mean load asked for.
        load: Newton,
        /// The largest found that is less.
        below: Newton,
        /// Approaches tried.
        trials: usize,
        /// The last of them.
        approach: Metre,
    },
    /// One approach for a whole pass bears no such load up to one at which there is no more to be had.
    #[error(
        "one approach for the whole pass bears {} in the mean up to {}, not {}: there {cause}",
        forces(*most, *load)[0],
        format(*approach, Dimension::Length),
        forces(*most, *load)[1]
    )]
    BeyondPass {
        /// The pass-mean load asked for.
        load: Newton,
        /// The load at the approach.
        most: Newton,
        /// The approach beyond which none is sought.
        approach: Metre,
        /// Why.
        cause: LoadLimit,
    },
    /// A position of a motion could not be solved.
    #[error("pass {pass}, position {position} of {positions}: {source}")]
    AtPosition {
        /// The pass, from 1.
        pass: usize,
        /// The position, from 1.
        position: usize,
        /// Positions of the pass.
        positions: usize,
        /// What is wrong there.
        source: Box<Error>,
    },
    /// A point of a sweep could not be solved.
    #[error("point {point} of {points}: {source}")]
    AtPoint {
        /// The point, from 1.
        point: usize,
        /// Points of the sweep.
        points: usize,
        /// What is wrong there.
        source: Box<Error>,
    },
    /// An increment of a load could not be solved.
    #[error("increment {increment}: {source}")]
    AtIncrement {
        /// The increment, from 1.
        increment: usize,
        /// What is wrong there.
        source: Box<Error>,
    },
    /// The answer of a pass has no meaning.
    #[error("pass {pass}: {source}")]
    AtPass {
        /// The computed pass, from 1.
        pass: usize,
        /// What is wrong there.
        source: Box<Error>,
    },
    /// The answer of an update of a contact that wears in place has no meaning.
    #[error("update {update}: {source}")]
    AtUpdate {
        /// The update, from 1; 0 before the first.
        update: usize,
        /// What is wrong there.
        source: Box<Error>,
    },
    /// An answer is NaN or infinite.
    #[error("`{field}` is not a finite number{}", in_cell(cell))]
    NotFinite {
        /// The field, column or number.
        field: String,
        /// The index of the first such cell along each axis, from 0; empty for a single number.
        cell: Vec<usize>,
    },
    /// Plastic strain and stress did not come to agree.
    #[error(
        "plastic flow does not settle in {products} products: mismatch {mismatch:.2e} of the yield stress, tolerance {tolerance:.2e}"
    )]
    FlowNotConverged {
        /// Applications of the residual-stress operator.
        products: usize,
        /// Mismatch of the stress over the yield stress.
        mismatch: f64,
        /// What was asked for.
        tolerance: f64,
    },
    /// A computation takes more memory than there is.
    #[error("about {} of memory are needed, {} are free", bytes(*needed), bytes(*available))]
    Memory {
        /// The memory it takes, bytes.
        needed: f64,
        /// The memory there is, bytes.
        available: f64,
    },
    /// Threads to compute on cannot be made.
    #[error("threads cannot be made: {reason}")]
    Threads {
        /// What the operating system said.
        reason: String,
    },
    /// The caller asked for the computation to stop.
    #[error("interrupted")]
    Interrupted,

    // ---- results -----------------------------------------------------------------------------------------
    /// A directory that is to take results is not empty.
    #[error("{path} {}", if *results { "already holds results" } else { "is not empty, and holds no results of asperity" })]
    ResultsExist {
        /// The directory.
        path: PathBuf,
        /// Whether it holds results of this program.
        results: bool,
    },
    /// A directory that is to take results lies within other results.
    #[error("{path} lies within the results in {results}")]
    WithinResults {
        /// The directory.
        path: PathBuf,
        /// The directory of the other results.
        results: PathBuf,
    },
    /// Results that are to be resumed belong to another case.
    #[error("{path} holds the results of another case: '{key}' was {before}, now it is {now}")]
    OtherCase {
        /// The directory.
        path: PathBuf,
        /// The first key that differs, dotted.
        key: String,
        /// The key's value in the results, JSON.
        before: String,
        /// The key's value in the case, JSON.
        now: String,
    },
    /// A surface of the results that are to be resumed is no longer the one in its file.
    #[error("{file} has changed since the results in {path} were begun")]
    SurfaceChanged {
        /// The directory.
        path: PathBuf,
        /// The surface file.
        file: PathBuf,
    },
    /// Results that are to be resumed are not whole.
    #[error("{path} {reason}")]
    NotResumable {
        /// The file at fault.
        path: PathBuf,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// The file of a rank holds other rows than the index of the run says.
    #[error(
        "{path} holds rows {} to {} of a run on {ranks} ranks, expected rows {} to {} of one on {expected_ranks}",
        rows[0], rows[1], expected[0], expected[1]
    )]
    OtherRows {
        /// The file at fault.
        path: PathBuf,
        /// The first and the last row that it holds.
        rows: [usize; 2],
        /// Number of ranks of its run.
        ranks: usize,
        /// The first and the last row that it should hold.
        expected: [usize; 2],
        /// Number of ranks that the index has.
        expected_ranks: usize,
    },
    /// Another process writes its results to the directory.
    #[error("{path} is in use: another run is writing its results there")]
    InUse {
        /// The directory.
        path: PathBuf,
    },
    /// A directory without results.
    #[error("{path} holds no results of asperity (there is no case.json)")]
    NoResults {
        /// The directory.
        path: PathBuf,
    },
    /// A directory that is to take a study holds something else.
    #[error("{path} {what}")]
    NotThisStudy {
        /// The directory.
        path: PathBuf,
        /// What it holds: "holds another study".
        what: &'static str,
    },
    /// A file could not be read or written.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        source: std::io::Error,
    },
    /// A field that a results file does not have.
    #[error("no field `{name}` in {path}")]
    NoField {
        /// The file.
        path: PathBuf,
        /// The field asked for.
        name: String,
        /// The fields there are.
        available: Vec<String>,
    },
}
}

/// Why the load of a pass under one approach has a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum LoadLimit {
    /// Bodies that yield at each position fit together: from there on they bear no more where one of them takes all of the
    /// plastic deformation, and hardly more, growing as the logarithm of the approach, where both do.
    #[error("every cell yields where it first meets another, and bears less at the positions that follow")]
    Yielded,
    /// Periodic bodies in full contact: their mean displacement is free.
    #[error(
        "the whole periodic gap closes, and how the positions share a greater load is not determined (their mean displacement is free)"
    )]
    FullContact,
}

impl Error {
    /// The same error, wrapped by `at` if an answer is NaN or infinite.
    pub(crate) fn if_not_finite(self, at: impl FnOnce(Box<Self>) -> Self) -> Self {
        match self {
            Self::NotFinite { .. } => at(Box::new(self)),
            other => other,
        }
    }

    /// What the user can do about it, where that is known: a sentence to print after the error.
    pub fn hint(&self) -> Option<String> {
        match self {
            Self::NoChannel { available, .. } => {
                Some(format!("it holds {}; choose one of them", quoted(available)))
            }
            Self::NoField { available, .. } => Some(format!("it holds {}", quoted(available))),
            Self::NotATopography { .. } => Some(
                "x3p, sdf, gwy, sur, mnt, opd, opdx, MetroPro dat, plu, al3d, frt, tmd, nms, vk4 to vk7, NanoScope spm, \
                     ibw, nid, WSxM stp, mi, bcr, tiff, NetCDF 3, HDF5, npy, csv, text and tables (also gzipped) are read; \
                     export as one of these"
                    .into(),
            ),
            Self::NoFormat { .. } => {
                Some("the end of the name tells the format: .npy, .x3p, .sdf, .gwy or .vtk".into())
            }
            Self::CorruptTopography { reason: Defect::NotANumber { .. }, .. } => Some(
                "a text topography is a matrix of heights in metres; header lines start with # or %".into(),
            ),
            Self::UndefinedSamples { .. } => {
                Some("fill them, from the nearest sample or by a membrane over each hole".into())
            }
            Self::FlowNotConverged { .. } => {
                Some("take more increments, so that each of them flows less".into())
            }
            Self::NotFinite { .. } => Some(
                "a quantity of the input is far too large or too small, for example one whose unit is missing".into(),
            ),
            Self::AtPosition { source, .. }
            | Self::AtIncrement { source, .. }
            | Self::AtPass { source, .. }
            | Self::AtUpdate { source, .. }
            | Self::AtPoint { source, .. } => source.hint(),
            Self::TooManyRanks { .. } => Some("start fewer: each holds a row or more".into()),
            Self::RanksDiffer { .. } => {
                Some("start the same program on every machine, where it finds the same files".into())
            }
            Self::OtherRows { .. } => {
                Some("bring back the file that the rank has written, or compute the contact anew".into())
            }
            Self::Memory { .. } => Some("fewer cells take less, and so do fewer threads".into()),
            _ => None,
        }
    }
}

fn in_cell(cell: &[usize]) -> String {
    if cell.is_empty() { String::new() } else { format!(" in cell {cell:?}") }
}

/// Two forces that can be told apart.
fn forces(one: Newton, other: Newton) -> [String; 2] {
    format_distinct([one, other], Dimension::Force)
}

fn no_channel(path: &std::path::Path, channel: &str) -> String {
    match channel {
        "" => format!("{} holds several data sets, none of which is chosen", path.display()),
        _ => format!("no height channel `{channel}` in {}", path.display()),
    }
}

fn quoted(names: &[String]) -> String {
    let names: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
    names.join(", ")
}

/// What is wrong with a topography file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Defect {
    /// A part of the file has not the length that the header gives it.
    #[error("{what} holds {found} bytes, expected {expected}")]
    Length {
        /// Which part.
        what: &'static str,
        /// Bytes that the header calls for.
        expected: u64,
        /// Bytes there are.
        found: u64,
    },
    /// A part of the file has changed since it was written.
    #[error("{what} has the MD5 checksum {found}, but the file was written with {expected}")]
    Checksum {
        /// Which part.
        what: &'static str,
        /// The checksum stored in the file.
        expected: String,
        /// The checksum of what is there.
        found: String,
    },
    /// Something that the format requires is not there.
    #[error("no {0}")]
    Missing(&'static str),
    /// An entry of the header has a value that cannot be used.
    #[error("{what} is `{found}`, expected {expected}")]
    Value {
        /// Which entry.
        what: &'static str,
        /// The entry's value as the file has it.
        found: String,
        /// What would have been accepted.
        expected: &'static str,
    },
    /// More cells than any contact can be solved on; most likely a damaged header.
    #[error("{cells} heights, at most {limit} are read")]
    TooLarge {
        /// Heights that the header calls for.
        cells: u128,
        /// The limit.
        limit: usize,
    },
    /// A line of a text matrix that is longer or shorter than the others.
    #[error("line {line} has {found} values, the lines before it have {expected}")]
    Ragged {
        /// Line, from 1.
        line: usize,
        /// Values in the lines before.
        expected: usize,
        /// Values in this line.
        found: usize,
    },
    /// Text where a height should stand.
    #[error("line {line}: `{token}` is not a height")]
    NotANumber {
        /// Line, from 1.
        line: usize,
        /// What stands there.
        token: String,
    },
    /// What the decoder of the container said.
    #[error("{0}")]
    Container(String),
}

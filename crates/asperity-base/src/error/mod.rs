//! The error type of the library. Each variant carries the numbers needed to act on it.

mod case;
mod detail;

use std::borrow::Cow;
use std::path::PathBuf;

pub use case::CaseError;
pub use detail::Detail;

use crate::units::{Dimension, Metre, Newton, bytes, format, format_distinct, format_number};

/// `Result` with this library's [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

/// Returns [`Error::OutOfRange`] for a pure number unless `good`.
pub fn check(quantity: &'static str, value: f64, good: bool, expected: &'static str) -> Result<()> {
    let expected = expected.into();
    if good { Ok(()) } else { Err(Error::OutOfRange { quantity, value, dimension: None, expected }) }
}

/// Returns [`Error::OutOfRange`] for a value of `dimension`, SI, unless `good`.
pub fn check_in(
    dimension: Dimension,
    quantity: &'static str,
    value: f64,
    good: bool,
    expected: &'static str,
) -> Result<()> {
    let (dimension, expected) = (Some(dimension), expected.into());
    if good { Ok(()) } else { Err(Error::OutOfRange { quantity, value, dimension, expected }) }
}

// The macro also lists the name and the fields of each variant.
detail::causes! {
/// Everything that can go wrong, by cause.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    // ---- input of any kind -------------------------------------------------------------------------------
    /// A quantity lies outside its valid range.
    #[error("{quantity} is {}, expected {expected}", dimension.map_or_else(|| format_number(*value), |d| format(*value, d)))]
    OutOfRange {
        /// The quantity's name, as the user knows it.
        quantity: &'static str,
        /// The value given, SI.
        value: f64,
        /// Dimension of the quantity; `None` for a pure number.
        dimension: Option<Dimension>,
        /// The accepted values.
        expected: Cow<'static, str>,
    },
    /// Two grids that must agree do not.
    #[error("{what}: {left} and {right} differ")]
    GridMismatch {
        /// The property that must agree, for example "pitch of the two bodies".
        what: &'static str,
        /// Its value on the first grid.
        left: String,
        /// Its value on the second grid.
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
    /// Ranks that compute one contact together differ in something that must be the same.
    #[error("rank {rank} has another {what} than rank 0")]
    RanksDiffer {
        /// The first rank that differs.
        rank: usize,
        /// The differing property, for example "version of asperity".
        what: &'static str,
    },
    /// A combination that is not supported.
    #[error("{0}")]
    Unsupported(&'static str),

    // ---- topography files --------------------------------------------------------------------------------
    /// A file in none of the supported formats.
    #[error("{path} is not a topography: {reason}")]
    NotATopography {
        /// The file.
        path: PathBuf,
        /// The apparent kind of the file.
        reason: &'static str,
        /// Advice on an export that is read; empty if any format that is read will do.
        export: &'static str,
    },
    /// A file of a known format that is damaged, or that uses an unsupported part of the format.
    #[error("{path}: {format}: {reason}")]
    CorruptTopography {
        /// The file.
        path: PathBuf,
        /// The format it was recognised as.
        format: &'static str,
        /// The defect and its place.
        reason: Defect,
    },
    /// A channel that the file does not have, or no channel given for a file with several.
    #[error("{}", no_channel(path, channel))]
    NoChannel {
        /// The file.
        path: PathBuf,
        /// The requested channel; empty if none was given.
        channel: String,
        /// The channels of the file.
        available: Vec<String>,
    },
    /// A unit given for a file that states the unit of its heights.
    #[error("{path}: {format}: its heights have a unit of their own, expected none to be given")]
    OwnUnit {
        /// The file.
        path: PathBuf,
        /// The format it was recognised as.
        format: &'static str,
    },
    /// An option for text or for a matrix of open order, given for a file of another format.
    #[error("{path}: {format}: {}", needless(option))]
    OptionOfText {
        /// The file.
        path: PathBuf,
        /// The format it was recognised as.
        format: &'static str,
        /// `lines` or `skip`.
        option: &'static str,
    },
    /// A topography file without a pitch, and no pitch given.
    #[error("{path} ({format}) has no pitch")]
    NoPitch {
        /// The file.
        path: PathBuf,
        /// The format it was recognised as.
        format: &'static str,
    },
    /// A file name whose extension names no format for writing a topography.
    #[error("no format to write `{path}` in")]
    NoFormat {
        /// The file.
        path: PathBuf,
    },
    /// A topography with undefined samples where every sample is needed.
    #[error("{undefined} of {samples} samples are undefined")]
    UndefinedSamples {
        /// Number of undefined samples.
        undefined: usize,
        /// Number of all samples.
        samples: usize,
    },
    /// A topography without any defined sample, so that nothing can be filled.
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
    /// A mistake in a case file.
    #[error(transparent)]
    Case(Box<CaseError>),

    // ---- contact -----------------------------------------------------------------------------------------
    /// The load exceeds what the bodies can carry with every cell at the hardness.
    #[error(
        "load {} exceeds the plastic limit {} (every facing cell at the hardness)",
        forces(*load, *limit)[0],
        forces(*load, *limit)[1]
    )]
    BeyondPlasticLimit {
        /// The requested load.
        load: Newton,
        /// The largest load that can be carried.
        limit: Newton,
    },
    /// The tangential force exceeds the friction limit: the bodies slide.
    #[error(
        "tangential force {} is not below what friction holds, {}: the bodies slide",
        forces(*force, *limit)[0],
        forces(*force, *limit)[1]
    )]
    BeyondFriction {
        /// The requested force.
        force: Newton,
        /// The friction limit; the force must be smaller.
        limit: Newton,
    },
    /// No device of the requested kind.
    #[error("no device for `{device}`: looked for {}, found {found}", looked_for(device))]
    NoDevice {
        /// The device, as the user named it.
        device: &'static str,
        /// The devices or libraries that are there, or what is missing.
        found: String,
    },
    /// A device has too little memory.
    #[error("{device} has {} of free memory, needed are {}", bytes(*free), bytes(*needed))]
    DeviceMemory {
        /// Name of the device.
        device: String,
        /// Memory that the contact takes, bytes.
        needed: f64,
        /// Memory that is free, bytes.
        free: f64,
    },
    /// A device, its driver or one of its libraries failed.
    #[error("{device} failed: {reason}")]
    DeviceFailed {
        /// Name of the device.
        device: String,
        /// The message of the driver or of the library.
        reason: String,
    },
    /// The iteration stopped above the tolerance.
    #[error(
        "no equilibrium after {iterations} iterations: residual {residual:.2e}, tolerance {tolerance:.2e}"
    )]
    NotConverged {
        /// Iterations spent.
        iterations: usize,
        /// Scale-free complementarity residual η reached.
        residual: f64,
        /// The requested η.
        tolerance: f64,
    },
    /// The iteration for a film of oil stopped above the tolerance.
    #[error(
        "no film in equilibrium after {iterations} iterations: residual {residual:.2e}, tolerance {tolerance:.2e}"
    )]
    FilmNotConverged {
        /// Iterations spent.
        iterations: usize,
        /// Scale-free residual reached.
        residual: f64,
        /// The requested residual.
        tolerance: f64,
    },
    /// An approach at which a periodic contact has no solution: the mean displacement is free there.
    #[error(
        "approach {} closes the whole periodic gap (mean gap {})",
        format_distinct([*approach, *mean_gap], Dimension::Length)[0],
        format_distinct([*approach, *mean_gap], Dimension::Length)[1]
    )]
    PeriodicFullContact {
        /// The requested approach.
        approach: Metre,
        /// The mean undeformed gap, the limit of the approach.
        mean_gap: Metre,
    },
    /// A load that pulls the bodies apart.
    #[error(
        "the load {} pulls the bodies apart: adhesion holds at most {}",
        forces(*load, *least)[0],
        forces(*load, *least)[1]
    )]
    PullOff {
        /// The requested load.
        load: Newton,
        /// The least load found on the way apart, the pull-off force.
        least: Newton,
    },
    /// No approach was found that gives the requested pass-mean load.
    #[error(
        "no approach found for the pass-mean load {} in {trials} trials (last approach {})",
        format(*load, Dimension::Force),
        format(*approach, Dimension::Length)
    )]
    LoadNotReached {
        /// The requested pass-mean load.
        load: Newton,
        /// The largest load found that is smaller.
        below: Newton,
        /// Approaches tried.
        trials: usize,
        /// The last approach tried.
        approach: Metre,
    },
    /// The requested load exceeds the largest that one approach for a whole pass can carry.
    #[error(
        "with one approach for the whole pass, the mean load is at most {} (at an approach of {}), less than {}: {cause}",
        forces(*most, *load)[0],
        format(*approach, Dimension::Length),
        forces(*most, *load)[1]
    )]
    BeyondPass {
        /// The requested pass-mean load.
        load: Newton,
        /// The load at the approach.
        most: Newton,
        /// The upper limit of the search for an approach.
        approach: Metre,
        /// The reason for the limit.
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
        /// The cause.
        source: Box<Error>,
    },
    /// A point of a load sweep could not be solved.
    #[error("point {point} of {points}: {source}")]
    AtPoint {
        /// The point, from 1.
        point: usize,
        /// Points of the sweep.
        points: usize,
        /// The cause.
        source: Box<Error>,
    },
    /// An increment of a load could not be solved.
    #[error("increment {increment}: {source}")]
    AtIncrement {
        /// The increment, from 1.
        increment: usize,
        /// The cause.
        source: Box<Error>,
    },
    /// A pass as a whole could not be solved, or its result is no longer a surface or not finite.
    #[error("pass {pass}: {source}")]
    AtPass {
        /// The computed pass, from 1.
        pass: usize,
        /// The cause.
        source: Box<Error>,
    },
    /// An update of a contact that slides in place could not be solved, or its result is no longer a surface
    /// or not finite.
    #[error("update {update}: {source}")]
    AtUpdate {
        /// The update, from 1; 0 before the first.
        update: usize,
        /// The cause.
        source: Box<Error>,
    },
    /// A result is NaN or infinite.
    #[error("`{field}` is not a finite number{}", in_cell(cell))]
    NotFinite {
        /// Name of the field, column or number.
        field: String,
        /// Index of the first such cell along each axis, from 0; empty for a single number.
        cell: Vec<usize>,
    },
    /// A body loses more material than it is long: it is no longer a surface.
    #[error(
        "the {body} body loses {} of its height, and the longer side of its grid is {}: it is no longer a surface",
        format(*depth, Dimension::Length),
        format(*length, Dimension::Length)
    )]
    WornAway {
        /// The body: "lower" or "upper".
        body: &'static str,
        /// The height that it loses.
        depth: Metre,
        /// The longer side of its grid.
        length: Metre,
    },
    /// The return mapping did not converge: plastic strain and stress do not agree.
    #[error(
        "the plastic strain did not converge in {products} operator applications: return-mapping residual {mismatch:.2e} of the yield stress, tolerance {tolerance:.2e}"
    )]
    PlasticNotConverged {
        /// Applications of the residual-stress operator.
        products: usize,
        /// Return-mapping residual over the yield stress.
        mismatch: f64,
        /// The requested tolerance.
        tolerance: f64,
    },
    /// A computation needs more memory than is free.
    #[error("about {} of memory are needed, {} are free", bytes(*needed), bytes(*available))]
    Memory {
        /// The memory needed, bytes.
        needed: f64,
        /// The free memory, bytes.
        available: f64,
    },
    /// Threads could not be created.
    #[error("threads cannot be made: {reason}")]
    Threads {
        /// Message of the operating system.
        reason: String,
    },
    /// The caller asked the computation to stop.
    #[error("interrupted")]
    Interrupted,

    // ---- results -----------------------------------------------------------------------------------------
    /// The directory for the results is not empty.
    #[error("{path} {}", if *results { "already holds results" } else { "is not empty, and holds no results of asperity" })]
    ResultsExist {
        /// The directory.
        path: PathBuf,
        /// Whether it holds results of this program.
        results: bool,
    },
    /// The directory for the results lies within other results.
    #[error("{path} lies within the results in {results}")]
    WithinResults {
        /// The directory.
        path: PathBuf,
        /// The directory of the other results.
        results: PathBuf,
    },
    /// The results to resume belong to another case.
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
    /// A surface file has changed since the results to resume were begun.
    #[error("{file} has changed since the results in {path} were begun")]
    SurfaceChanged {
        /// The directory.
        path: PathBuf,
        /// The surface file.
        file: PathBuf,
    },
    /// The results to resume are incomplete.
    #[error("{path} {reason}")]
    NotResumable {
        /// The file at fault.
        path: PathBuf,
        /// The defect.
        reason: &'static str,
    },
    /// The file of a rank holds other rows than the index of the run states.
    #[error(
        "{path} holds rows {} to {} of a run on {ranks} ranks, expected rows {} to {} of one on {expected_ranks}",
        rows[0], rows[1], expected[0], expected[1]
    )]
    OtherRows {
        /// The file at fault.
        path: PathBuf,
        /// First and last row in the file.
        rows: [usize; 2],
        /// Number of ranks of the run that wrote it.
        ranks: usize,
        /// First and last row expected.
        expected: [usize; 2],
        /// Number of ranks in the index.
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
    /// The directory for a study holds something else.
    #[error("{path} {what}")]
    NotThisStudy {
        /// The directory.
        path: PathBuf,
        /// Its content: "holds another study".
        what: &'static str,
    },
    /// A file could not be read or written.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// A field that a results file does not have.
    #[error("no field `{name}` in {path}")]
    NoField {
        /// The file.
        path: PathBuf,
        /// The requested field.
        name: String,
        /// The fields of the file.
        available: Vec<String>,
    },
}
}

/// Reason why the load of a pass under one approach is limited.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum LoadLimit {
    /// Yielding bodies conform to each other at each position. From there the load no longer grows if one of
    /// them takes all of the plastic deformation. It grows only as the logarithm of the approach if both do.
    #[error("every cell yields at its first position and carries less load later")]
    Yielded,
    /// Periodic bodies in full contact: their mean displacement is free.
    #[error(
        "the whole periodic gap closes, and how the positions share a greater load is not determined (their mean displacement is free)"
    )]
    FullContact,
}

impl Error {
    /// Returns the same error, wrapped by `at` if it says that a step has no result, but not which step.
    pub fn if_of_step(self, at: impl FnOnce(Box<Self>) -> Self) -> Self {
        match self {
            Self::NotFinite { .. }
            | Self::WornAway { .. }
            | Self::NotConverged { .. }
            | Self::FilmNotConverged { .. }
            | Self::PlasticNotConverged { .. } => at(Box::new(self)),
            other => other,
        }
    }

    /// Returns the same error, wrapped by `at` unless it is an interruption.
    pub fn unless_interrupted(self, at: impl FnOnce(Box<Self>) -> Self) -> Self {
        match self {
            Self::Interrupted => self,
            other => at(Box::new(other)),
        }
    }

    /// Returns the cause of an error that says at which step of a computation it occurred.
    pub fn cause_in_step(&self) -> Option<&Self> {
        match self {
            Self::AtPosition { source, .. }
            | Self::AtPoint { source, .. }
            | Self::AtIncrement { source, .. }
            | Self::AtPass { source, .. }
            | Self::AtUpdate { source, .. } => Some(source),
            _ => None,
        }
    }

    /// Returns advice for the user, if there is any: a sentence to print after the error.
    pub fn hint(&self) -> Option<String> {
        match self {
            Self::NoChannel { available, .. } => {
                Some(format!("it holds {}; choose one of them", quoted(available)))
            }
            Self::NoField { available, .. } => Some(format!("it holds {}", quoted(available))),
            Self::NotATopography { export, .. } if !export.is_empty() => Some((*export).to_owned()),
            Self::NotATopography { .. } => Some(
                "x3p, sdf, gwy, sur, mnt, opd, opdx, MetroPro dat, datx, plu, al3d, frt, tmd, nms, vk4 to vk7, NanoScope spm, \
                     ibw, nid, WSxM stp, mi, bcr, gsf, asc, tiff, NetCDF 3, HDF5, mat, npy, npz, csv, text and tables (also gzipped) are \
                     read; \
                     export as one of these"
                    .into(),
            ),
            Self::NoFormat { .. } => {
                Some("the file extension selects the format: .npy, .x3p, .sdf, .gwy or .vtk".into())
            }
            Self::CorruptTopography { reason, .. } => reason.hint(),
            Self::UndefinedSamples { .. } => {
                Some("fill them, from the nearest sample or by a membrane over each hole".into())
            }
            Self::PlasticNotConverged { .. } => {
                Some("use more increments, with less plastic strain in each".into())
            }
            Self::NotFinite { .. } => Some(
                "a quantity of the input is far too large or too small, for example one whose unit is missing".into(),
            ),
            Self::WornAway { .. } => Some(
                "check the coefficient of the law that removes so much, a volume over load and distance, in 1/Pa, and not Archard's dimensionless number".into(),
            ),
            Self::TooManyRanks { .. } => Some("start fewer ranks: each needs a row or more".into()),
            Self::RanksDiffer { .. } => {
                Some("start the same program on every machine, with the same files".into())
            }
            Self::OtherRows { .. } => {
                Some("restore the file that the rank wrote, or compute the contact again".into())
            }
            Self::Memory { .. } => Some("use fewer cells or fewer threads".into()),
            _ => self.cause_in_step().and_then(Self::hint),
        }
    }
}

fn in_cell(cell: &[usize]) -> String {
    if cell.is_empty() { String::new() } else { format!(" in cell {cell:?}") }
}

/// Formats two forces with enough digits to differ.
fn forces(one: Newton, other: Newton) -> [String; 2] {
    format_distinct([one, other], Dimension::Force)
}

fn looked_for(device: &str) -> &'static str {
    match device {
        "cuda" => "a GPU of NVIDIA with its driver, NVRTC and cuFFT",
        _ => "a device of this name",
    }
}

fn needless(option: &str) -> &'static str {
    match option {
        "skip" => "it is no text, expected no lines to be skipped",
        _ => "its format determines the order of the heights, expected none to be given",
    }
}

fn no_channel(path: &std::path::Path, channel: &str) -> String {
    match channel {
        "" => format!("{} holds several data sets: choose one", path.display()),
        _ => format!("no height channel `{channel}` in {}", path.display()),
    }
}

fn quoted(names: &[String]) -> String {
    let names: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
    names.join(", ")
}

/// Defect of a topography file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Defect {
    /// The length of a part of the file differs from the one in the header.
    #[error("{what} holds {found} bytes, expected {expected}")]
    Length {
        /// The part.
        what: &'static str,
        /// Bytes expected by the header.
        expected: u64,
        /// Bytes found.
        found: u64,
    },
    /// A part of the file has changed since it was written.
    #[error("{what} has the MD5 checksum {found}, but the file was written with {expected}")]
    Checksum {
        /// The part.
        what: &'static str,
        /// The checksum stored in the file.
        expected: String,
        /// The checksum of the data.
        found: String,
    },
    /// Something that the format requires is missing.
    #[error("no {0}")]
    Missing(&'static str),
    /// An entry of the header has an unusable value.
    #[error("{what} is `{found}`, expected {expected}")]
    Value {
        /// The entry.
        what: &'static str,
        /// The value in the file.
        found: String,
        /// The accepted values.
        expected: &'static str,
    },
    /// More cells than any contact can be solved on, most likely from a damaged header.
    #[error("{cells} heights, at most {limit} are read")]
    TooLarge {
        /// Heights expected by the header.
        cells: u128,
        /// The limit.
        limit: usize,
    },
    /// A line of a text matrix that is longer or shorter than the lines before.
    #[error("line {line} has {found} values, the lines before it have {expected}")]
    Ragged {
        /// Line, from 1.
        line: usize,
        /// Values in the lines before.
        expected: usize,
        /// Values in this line.
        found: usize,
    },
    /// Text in place of a height.
    #[error("line {line}: `{token}` is not a height")]
    NotANumber {
        /// Line, from 1.
        line: usize,
        /// The text.
        token: String,
    },
    /// Lines above a matrix of text that are not all words, or may be its labels.
    #[error("line {line}: `{token}` is no height; the matrix begins at line {first}")]
    Preamble {
        /// Line, from 1, that is not understood.
        line: usize,
        /// Its text.
        token: String,
        /// First line of the matrix, from 1.
        first: usize,
    },
    /// A table that looks like points or a line scan, which are on no grid.
    #[error("{count} lines of {columns} numbers look like {what}, expected {expected}")]
    Points {
        /// Number of lines.
        count: usize,
        /// Numbers in a line.
        columns: usize,
        /// Kind of table that the lines look like.
        what: &'static str,
        /// The accepted tables.
        expected: &'static str,
        /// Whether a line of names calls them points.
        named: bool,
    },
    /// A first column of a matrix that looks like labels.
    #[error("the first of {columns} columns, {found}, looks like labels, expected heights alone")]
    Labels {
        /// Number of columns.
        columns: usize,
        /// The first numbers of the column.
        found: String,
    },
    /// Message of the container's decoder.
    #[error("{0}")]
    Container(String),
}

impl Defect {
    fn hint(&self) -> Option<String> {
        Some(match self {
            Self::NotANumber { .. } => {
                "a text topography is a matrix of heights in metres; header lines start with # or %, or are skipped".into()
            }
            Self::Preamble { first: 2, .. } => "skip the line above the matrix".into(),
            Self::Preamble { first, .. } => format!("skip the {} lines above the matrix", first - 1),
            Self::Points { named, .. } => {
                let way = "bring points onto a regular grid, for example with scipy.interpolate.griddata or Gwyddion's \
                           import of XYZ data";
                let matrix = "if they are a matrix of heights, say along which axis its lines lie";
                if *named { way.to_owned() } else { format!("{way}; {matrix}") }
            }
            Self::Labels { .. } => {
                "remove the labels; if they are heights, say along which axis the lines of the matrix lie".into()
            }
            _ => return None,
        })
    }

    /// Returns the option of `asperity_surface::ReadOptions` that its hint asks for, and the value.
    pub fn option(&self) -> Option<(&'static str, String)> {
        match self {
            Self::Preamble { first, .. } => Some(("skip", (first - 1).to_string())),
            Self::Points { named: false, .. } | Self::Labels { .. } => Some(("lines", "x".to_owned())),
            _ => None,
        }
    }
}

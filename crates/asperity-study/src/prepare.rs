//! From a case to its two surfaces: reads or generates them, prepares them, and turns the upper one over.

use std::path::Path;

use ndarray::s;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::case::document::Document;
use super::case::{
    Body, Case, GridMatch, Hardness, HardnessMap, Mount, Source, TopographySpec, topography_alone,
};
use super::surface_input::SurfaceInput;
use crate::io::{sha256, sha256_of};
use crate::master_curve::{self, MasterCurve};
use asperity_base::error::{Error, Result};
use asperity_base::grid::{CellValues, Field, Grid};
use asperity_base::units::{self, Dimension, Metre};
use asperity_contact::motion::Strategy;
use asperity_surface::{
    self, Findings, LengthUnit, NEVER, Preparation, ReadOptions, Resample, Scan, Stop, Topography,
};

/// Largest relative difference of two equal pitches.
const SAME_PITCH: f64 = 1e-9;

/// The two surfaces of a case, with one width and with the same pitch to the last bit.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Bodies {
    /// The lower body, with the heights of its surface.
    pub lower: MountedSurface,
    /// The upper body, with the heights of its underside.
    pub upper: MountedSurface,
    /// The master curves of viscoelastic bodies, lower one first: those of the layers from the surface down, then that of the
    /// body below them.
    pub master_curves: [Vec<Option<MasterCurve>>; 2],
}

/// A surface as used in the contact, with every height defined.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct MountedSurface {
    /// The heights. An approach is relative to these heights.
    pub topography: Topography,
    /// The file that the heights were read from; `None` if they were generated.
    pub origin: Option<Origin>,
    /// Hardness of the cells. A map is turned over with the heights.
    pub hardness: CellValues,
    /// Digest of the file of a map of the hardness, hexadecimal.
    pub hardness_sha256: Option<String>,
    /// How the heights were mounted.
    pub mount: Mount,
    /// Missing samples that were filled, and samples that were removed.
    pub findings: Findings,
}

/// Data about a source file.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Origin {
    /// The format of the file, see [`Scan::format`].
    pub format: &'static str,
    /// The channel.
    pub channel: String,
    /// Whether the heights describe an underside, see [`Scan::is_underside`].
    pub is_underside: bool,
    /// Number of samples along x and y in the file.
    pub shape: [usize; 2],
    /// Digest of the file, hexadecimal.
    pub sha256: String,
}

impl Origin {
    /// Creates the origin of heights that the caller supplies under a name.
    fn supplied(name: &str, topography: &Topography) -> Self {
        let Grid { shape, pitch } = *topography.grid();
        let numbers = pitch.into_iter().chain(topography.heights().iter().copied());
        let sha256 = sha256_of(numbers);
        Self { format: "given", channel: name.to_owned(), is_underside: false, shape, sha256 }
    }
}

/// A single prepared topography. Missing heights that no step fills are undefined.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct PreparedTopography {
    /// The heights.
    pub topography: Topography,
    /// The file they were read from; `None` if they were generated.
    pub origin: Option<Origin>,
    /// Missing samples, and samples that were removed.
    pub findings: Findings,
}

/// Reads or generates the topography described by a table `[topography]` in `text`, with the keys of
/// `[lower.topography]` in a case file. Paths of files are relative to `folder`.
///
/// # Errors
/// [`Error::Case`] at the key with the mistake, as for [`bodies`].
pub fn topography(text: &str, folder: &Path, given: SurfaceInput) -> Result<PreparedTopography> {
    topography_until(text, folder, given, NEVER)
}

/// [`topography()`] that can be stopped by `stop`.
///
/// # Errors
/// The errors of [`topography()`]; [`Error::Interrupted`].
pub fn topography_until(
    text: &str,
    folder: &Path,
    mut given: SurfaceInput,
    stop: Stop<'_>,
) -> Result<PreparedTopography> {
    let (spec, document) = topography_alone(text, folder)?;
    if let Some(key) = spec.lacks().next() {
        let message = format!("missing key '{key}': what is made alone has no other body to take it from");
        return Err(document.error_at(&format!("topography.{key}"), message, None));
    }
    prepare_topography(
        Place { document: &document, table: "topography", spec: &spec, pitch: None },
        None,
        &mut given,
        stop,
    )
}

/// Reads the table `[topography]` in `text`, and checks it as far as possible without its files.
///
/// # Errors
/// [`Error::Case`].
pub fn topography_spec(text: &str, folder: &Path) -> Result<TopographySpec> {
    topography_alone(text, folder).map(|(spec, _)| spec)
}

/// Reads or generates both topographies of `case`, or uses the `given` ones, and prepares them according to
/// [`TopographySpec`].
///
/// # Errors
/// [`Error::Case`] at the key with the mistake. Mistakes are unreadable files, parameters that are invalid on
/// this grid, missing heights that no step fills, and surfaces that do not fit together. Both surfaces need
/// the same pitch and the same number of cells along y. Without motion, or if both are shifted, they also
/// need the same number along x.
pub fn bodies(case: &Case, given: SurfaceInput) -> Result<Bodies> {
    bodies_until(case, given, NEVER)
}

/// [`bodies`] that can be stopped by `stop`.
///
/// # Errors
/// The errors of [`bodies`]; [`Error::Interrupted`].
pub fn bodies_until(case: &Case, mut given: SurfaceInput, stop: Stop<'_>) -> Result<Bodies> {
    let grid_of = |body: &MountedSurface| *body.topography.grid();
    let pitch = common_pitch(case, &given)?;
    let make = |name: &str, body: &Body, other| prepared(case, name, body, other, pitch, &mut given, stop);
    let [mut lower, mut upper] = in_turn(case, grid_of, make)?;
    let axes = shared_axes(case);
    if case.contact.grid == GridMatch::Common {
        let common = common_shape(axes, [&lower, &upper].map(|body| grid_of(body).shape));
        lower = lower.cropped(common[0])?;
        upper = upper.cropped(common[1])?;
    }
    let both = [&lower, &upper];
    let (grids, origins) = (both.map(grid_of), both.map(|body| body.origin.as_ref()));
    Fit { case, grids, origins }.check(axes)?;
    let grid = Grid::new(upper.topography.grid().shape, lower.topography.grid().pitch)?;
    upper.topography = Topography::new(grid, upper.topography.into_heights())?;
    let master_curves = [
        master_curve::of_body(case, "lower", &case.lower, &given)?,
        master_curve::of_body(case, "upper", &case.upper, &given)?,
    ];
    Ok(Bodies { lower, upper, master_curves })
}

/// Axes along which both bodies have the same number of cells: an overlap joins bodies of any length.
fn shared_axes(case: &Case) -> &'static [usize] {
    let overlap = matches!(case.motion, Some(motion) if motion.strategy() == Strategy::Overlap);
    if overlap { &[1] } else { &[1, 0] }
}

/// Returns the coarser pitch of both prepared surfaces along each axis, to which they are resampled; `None`
/// if they must fit by themselves.
fn common_pitch(case: &Case, given: &SurfaceInput) -> Result<Option<[Metre; 2]>> {
    if case.contact.grid == GridMatch::AsPrepared {
        return Ok(None);
    }
    let [lower, upper] = grids_as_prepared(case, given, None)?.map(|grid| grid.pitch);
    Ok(Some([0, 1].map(|axis| lower[axis].max(upper[axis]))))
}

/// Returns the shapes of both bodies with the smaller number of cells along each of these axes.
fn common_shape(axes: &[usize], shapes: [[usize; 2]; 2]) -> [[usize; 2]; 2] {
    let least = [0, 1].map(|axis| shapes[0][axis].min(shapes[1][axis]));
    shapes.map(|shape| [0, 1].map(|axis| if axes.contains(&axis) { least[axis] } else { shape[axis] }))
}

impl MountedSurface {
    /// Returns the body with the cells about its centre that this shape leaves.
    fn cropped(self, shape: [usize; 2]) -> Result<Self> {
        let whole = self.topography.grid().shape;
        let first = [0, 1].map(|axis| (whole[axis] - shape[axis]) / 2);
        let window = [first[0], first[1], shape[0], shape[1]];
        let hardness = match self.hardness {
            CellValues::Field(map) => {
                let part = s![first[0]..first[0] + shape[0], first[1]..first[1] + shape[1]];
                CellValues::Field(map.slice(part).to_owned())
            }
            uniform @ CellValues::Uniform(_) => uniform,
        };
        Ok(Self { topography: self.topography.window(window)?, hardness, ..self })
    }
}

/// Generates the heights of the upper body of a `pass` after the first, like those of the first but from
/// another seed, on the `grid` of the lower body.
///
/// # Errors
/// [`Error::Case`] as for [`bodies`].
pub(super) fn fresh_heights(case: &Case, lower: Grid, pass: usize) -> Result<Field> {
    let mut body = case.upper.clone();
    if let Source::Generate { seed, .. } = &mut body.topography.source {
        *seed = seed_of_pass(*seed, pass);
    }
    let given = &mut SurfaceInput::default();
    let pitch = (case.contact.grid == GridMatch::Common).then_some(lower.pitch);
    let topography = turned(case, "upper", &body, Some(lower), pitch, given, NEVER)?.0.topography;
    Ok(topography.into_heights())
}

/// Seed of a `pass` after the first: the first number in the random stream of the pass.
fn seed_of_pass(seed: u64, pass: usize) -> u64 {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(pass as u64);
    random.next_u64()
}

/// Returns the grids of [`bodies`], from the case and from the sizes in its files alone.
///
/// # Errors
/// [`Error::Case`] as for [`bodies`], for files and for preparation steps that are invalid on their grid.
pub fn grids(case: &Case, given: &SurfaceInput) -> Result<[Grid; 2]> {
    let Some(pitch) = common_pitch(case, given)? else { return grids_as_prepared(case, given, None) };
    let both = grids_as_prepared(case, given, Some(pitch))?;
    let [lower, upper] = common_shape(shared_axes(case), both.map(|grid| grid.shape));
    Ok([Grid::new(lower, both[0].pitch)?, Grid::new(upper, both[1].pitch)?])
}

/// Returns the grids of both prepared surfaces, resampled to a `pitch` if one is given.
fn grids_as_prepared(case: &Case, given: &SurfaceInput, pitch: Option<[Metre; 2]>) -> Result<[Grid; 2]> {
    in_turn(case, |grid| *grid, |name, body, other| grid(case, name, body, other, pitch, given))
}

/// Processes both bodies; the one that takes its shape or pitch from the other comes second.
fn in_turn<T>(
    case: &Case,
    grid_of: impl Fn(&T) -> Grid,
    mut make: impl FnMut(&str, &Body, Option<Grid>) -> Result<T>,
) -> Result<[T; 2]> {
    if case.lower.topography.lacks().next().is_some() {
        let upper = make("upper", &case.upper, None)?;
        let lower = make("lower", &case.lower, Some(grid_of(&upper)))?;
        Ok([lower, upper])
    } else {
        let lower = make("lower", &case.lower, None)?;
        let upper = make("upper", &case.upper, Some(grid_of(&lower)))?;
        Ok([lower, upper])
    }
}

fn grid(
    case: &Case,
    name: &str,
    body: &Body,
    other: Option<Grid>,
    pitch: Option<[Metre; 2]>,
    given: &SurfaceInput,
) -> Result<Grid> {
    let table = topography_of(name);
    let spec = &body.topography;
    let at = Place { document: case.document(), table: &table, spec, pitch };
    let (grid, preparation) = match &spec.source {
        Source::File { file, .. } => {
            let (scan, sha256) = read(file, &spec.source.reading()).map_err(|error| at.reading(error))?;
            let (topography, _, preparation) = measured(at, file, scan, sha256)?;
            (*topography.grid(), preparation)
        }
        Source::Given { given: name } => {
            let topography = given.topography(name).map_err(|error| at.not_supplied(error))?;
            (*topography.grid(), with_pitch(at, topography.grid().pitch)?)
        }
        Source::Generate { .. } | Source::Form { .. } => {
            (spec.made_on(other).map_err(|error| at.parameter(error))?, spec.preparation)
        }
    };
    at.resampled(preparation).grid(grid).map_err(|error| at.preparing(error))
}

/// Name of the table of a body's topography.
pub fn topography_of(body: &str) -> String {
    format!("{body}.topography")
}

fn prepared(
    case: &Case,
    name: &str,
    body: &Body,
    other: Option<Grid>,
    pitch: Option<[Metre; 2]>,
    given: &mut SurfaceInput,
    stop: Stop<'_>,
) -> Result<MountedSurface> {
    let (PreparedTopography { topography, origin, findings }, mount) =
        turned(case, name, body, other, pitch, given, stop)?;
    let (hardness, hardness_sha256) = hardness(case, name, body, topography.grid(), mount, given)?;
    Ok(MountedSurface { topography, hardness, hardness_sha256, origin, mount, findings })
}

/// Returns the surface of a body, mounted and with every height defined.
fn turned(
    case: &Case,
    name: &str,
    body: &Body,
    other: Option<Grid>,
    pitch: Option<[Metre; 2]>,
    given: &mut SurfaceInput,
    stop: Stop<'_>,
) -> Result<(PreparedTopography, Mount)> {
    let table = topography_of(name);
    let at = Place { document: case.document(), table: &table, spec: &body.topography, pitch };
    let PreparedTopography { topography, origin, findings } = prepare_topography(at, other, given, stop)?;
    if topography.undefined() > 0 {
        return Err(at.missing(&findings));
    }
    at.measurable(&topography)?;
    let of_file = || match &origin {
        Some(origin) if origin.is_underside => Mount::AsIs,
        _ => Mount::TurnedOver,
    };
    let mount = body.mount.unwrap_or_else(of_file);
    let topography = match mount {
        Mount::TurnedOver => topography.underside(),
        Mount::AsIs => topography,
    };
    Ok((PreparedTopography { topography, origin, findings }, mount))
}

/// Makes the topography described at a place, with all its steps, and completes it from the `other` body.
fn prepare_topography(
    at: Place<'_>,
    other: Option<Grid>,
    given: &mut SurfaceInput,
    stop: Stop<'_>,
) -> Result<PreparedTopography> {
    let spec = at.spec;
    let grid = || spec.made_on(other);
    let (topography, origin, preparation) = match &spec.source {
        Source::File { file, .. } => {
            let (scan, sha256) = read(file, &spec.source.reading()).map_err(|error| at.reading(error))?;
            given.admit(&format!("{}.file", at.table), &sha256)?;
            let (topography, origin, preparation) = measured(at, file, scan, sha256)?;
            (Ok(topography), Some(origin), preparation)
        }
        Source::Given { given: name } => {
            let topography = given.take_topography(name).map_err(|error| at.not_supplied(error))?;
            let preparation = with_pitch(at, topography.grid().pitch)?;
            let origin = Origin::supplied(name, &topography);
            (Ok(topography), Some(origin), preparation)
        }
        Source::Generate { generate, seed, .. } => {
            (grid().and_then(|grid| generate.generate(&grid, *seed)), None, spec.preparation)
        }
        Source::Form { form, .. } => (grid().and_then(|grid| form.on(&grid)), None, spec.preparation),
    };
    let topography = topography.map_err(|error| at.parameter(error))?;
    let (mut topography, findings) =
        at.resampled(preparation).apply_until(topography, stop).map_err(|error| at.preparing(error))?;
    for (n, layer) in spec.plus.iter().enumerate() {
        let added =
            layer.on(topography.grid()).map_err(|error| at.parameter_of(&format!("plus.{n}."), error))?;
        topography = topography.plus(&added)?;
    }
    Ok(PreparedTopography { topography, origin, findings })
}

/// Returns the hardness of a body on `grid`, and the digest of its file.
pub fn hardness(
    case: &Case,
    name: &str,
    body: &Body,
    grid: &Grid,
    mount: Mount,
    given: &mut SurfaceInput,
) -> Result<(CellValues, Option<String>)> {
    let error = |key: &str, message: String, hint: Option<String>| {
        case.error_at(&format!("{name}.hardness.{key}"), message, hint)
    };
    let (mut values, sha256, file, key) = match &body.hardness {
        Hardness::Uniform(value) => return Ok((CellValues::Uniform(*value), None)),
        Hardness::Map(map @ HardnessMap::File { file, unit, .. }) => {
            let (scan, sha256) = read(file, &map.reading()).map_err(|source| {
                let key = match &source {
                    Error::NoChannel { .. } => "channel",
                    Error::OptionOfText { option, .. } => option,
                    _ => "file",
                };
                error(key, source.to_string(), hint_for_key(&source))
            })?;
            given.admit(&format!("{name}.hardness.file"), &sha256)?;
            let file = file.display().to_string();
            if scan.unit == LengthUnit::Known {
                let hint = "give a file of numbers alone, such as npy or csv".to_owned();
                return Err(error("file", format!("{file} holds lengths, expected a hardness"), Some(hint)));
            }
            (scan.heights * *unit, sha256, file, "file")
        }
        Hardness::Map(HardnessMap::Given { given: name }) => {
            let values = given
                .take_hardness(name)
                .map_err(|source| error("given", source.to_string(), source.hint()))?;
            let sha256 = sha256_of(values.iter().copied());
            (values, sha256, format!("the hardness of the {name} body"), "given")
        }
    };
    let (found, expected) = (values.dim(), (grid.shape[0], grid.shape[1]));
    if found != expected {
        let message = format!(
            "{file} has {} × {} values, the body as it is prepared {} × {} cells",
            found.0, found.1, expected.0, expected.1
        );
        return Err(error(key, message, Some("a map has a value for each cell".to_owned())));
    }
    if let Some(((i, j), &value)) =
        values.indexed_iter().find(|(_, value)| !Dimension::Pressure.range().holds(**value))
    {
        let found = if value.is_nan() {
            "no number".to_owned()
        } else {
            format!("a hardness of {}", units::format(value, Dimension::Pressure))
        };
        let message =
            format!("{file} has {found} in cell [{i}, {j}], expected a pressure above 0 of a solid");
        let hint = if value > 0.0 {
            "give the unit of its numbers, for example `unit = \"GPa\"`"
        } else {
            "every cell has a hardness; for one that never yields give more than any pressure"
        };
        return Err(error(key, message, Some(hint.to_owned())));
    }
    if mount == Mount::TurnedOver {
        values.invert_axis(ndarray::Axis(0));
        values = values.as_standard_layout().into_owned();
    }
    Ok((CellValues::Field(values), Some(sha256)))
}

/// Returns the hint of an error, with the key that it asks for.
fn hint_for_key(error: &Error) -> Option<String> {
    let option = match error {
        Error::CorruptTopography { reason, .. } => reason.option(),
        _ => None,
    };
    let key = option.map(|(key, value)| match key {
        "lines" => format!(": `{key} = \"{value}\"`"),
        _ => format!(": `{key} = {value}`"),
    });
    error.hint().map(|hint| hint + &key.unwrap_or_default())
}

/// Returns the number of samples along x and y in the file of a source.
pub(crate) fn samples_in_file(path: &Path, source: &Source) -> Result<[usize; 2]> {
    let (scan, _) = read(path, &source.reading())?;
    Ok([scan.heights.nrows(), scan.heights.ncols()])
}

/// Reads a file; also returns its digest.
fn read(path: &Path, options: &ReadOptions) -> Result<(Scan, String)> {
    let bytes = asperity_surface::contents(path)?;
    Ok((options.scan_bytes(path, &bytes)?, sha256(&bytes)))
}

/// Returns the preparation of heights from a file.
fn measured(
    at: Place<'_>,
    path: &Path,
    scan: Scan,
    sha256: String,
) -> Result<(Topography, Origin, Preparation)> {
    let spec = at.spec;
    let is_underside = scan.is_underside();
    let Scan { format, channel, pitch: carried, heights, .. } = scan;
    let shape = [heights.nrows(), heights.ncols()];
    let preparation = match carried {
        Some(carried) => with_pitch(at, carried)?,
        None => spec.preparation,
    };
    let pitch = carried.or(spec.pitch).ok_or_else(|| {
        at.error(
            "file",
            Error::NoPitch { path: path.to_owned(), format }.to_string(),
            Some("add the distance of its heights, for example `pitch = \"0.5 um\"`".to_owned()),
        )
    })?;
    let grid = Grid::new(shape, pitch).map_err(|error| at.parameter(error))?;
    let topography = Topography::new(grid, heights).map_err(|error| at.reading(error))?;
    Ok((topography, Origin { format, channel, is_underside, shape, sha256 }, preparation))
}

/// Returns the preparation of heights with their own pitch, `carried`. For another pitch they are resampled.
fn with_pitch(at: Place<'_>, carried: [Metre; 2]) -> Result<Preparation> {
    let spec = at.spec;
    let Some(pitch) = spec.pitch else { return Ok(spec.preparation) };
    if spec.preparation.resample.is_some() {
        return Err(at.error(
            "resample",
            format!(
                "both 'resample' and 'pitch' are given, but the heights have their own pitch, {}",
                lengths(carried)
            ),
            Some("leave one of them out: each resamples the heights".to_owned()),
        ));
    }
    Ok(Preparation { resample: Some(Resample::Pitch(pitch)), ..spec.preparation })
}

/// The place of a topography in the case, for error messages.
#[derive(Clone, Copy)]
pub struct Place<'a> {
    document: &'a Document,
    /// The dotted name of the topography's table.
    table: &'a str,
    spec: &'a TopographySpec,
    /// The pitch of the common grid; `None` if the surface keeps its own.
    pitch: Option<[Metre; 2]>,
}

impl<'a> Place<'a> {
    /// A topography that keeps its own pitch, described in the table of this dotted name.
    pub fn new(case: &'a Case, table: &'a str, spec: &'a TopographySpec) -> Self {
        Self { document: case.document(), table, spec, pitch: None }
    }
}

impl Place<'_> {
    /// Returns the preparation with the pitch of the common grid.
    fn resampled(&self, preparation: Preparation) -> Preparation {
        let resample = self.pitch.map(Resample::Pitch).or(preparation.resample);
        Preparation { resample, ..preparation }
    }

    fn error(&self, key: &str, message: String, hint: Option<String>) -> Error {
        self.document.error_at(&format!("{}.{key}", self.table), message, hint)
    }

    /// Error for a name under which nothing is supplied.
    fn not_supplied(&self, error: Error) -> Error {
        self.error("given", error.to_string(), error.hint())
    }

    /// Error for a file that could not be read: the message of its reader, at the key of the file or of its
    /// channel.
    fn reading(&self, error: Error) -> Error {
        match &error {
            Error::NoChannel { available, .. } => {
                let names: Vec<_> = available.iter().map(|name| format!("`{name}`")).collect();
                let hint = format!("it holds {}; choose one with `channel`", names.join(", "));
                self.error("channel", error.to_string(), Some(hint))
            }
            Error::OwnUnit { .. } => self.error("unit", error.to_string(), None),
            Error::OptionOfText { option, .. } => self.error(option, error.to_string(), None),
            Error::File { source, .. } if source.kind() == std::io::ErrorKind::NotFound => {
                let hint = "the files of a case are looked for in the case file's folder".to_owned();
                self.error("file", error.to_string(), Some(hint))
            }
            _ => self.error("file", error.to_string(), hint_for_key(&error)),
        }
    }

    /// Error for missing heights that no step fills.
    fn missing(&self, findings: &Findings) -> Error {
        let samples = findings.samples;
        let missing = findings.undefined + findings.spikes;
        let spikes = match findings.spikes {
            0 => String::new(),
            spikes => format!(", {spikes} of them removed as spikes"),
        };
        self.error(
            self.source(),
            format!("{missing} of {samples} heights of {} are missing{spikes}", self.file()),
            Some("set `fill = \"harmonic\"`, a membrane over each hole, or `fill = \"nearest\"`".to_owned()),
        )
    }

    /// Returns an error for heights outside the accepted lengths.
    pub fn measurable(&self, topography: &Topography) -> Result<()> {
        let range = Dimension::Length.range();
        let highest = topography.heights().iter().fold(0.0, |highest: f64, z| highest.max(z.abs()));
        if highest <= range.most {
            return Ok(());
        }
        let [highest, most] = [highest, range.most].map(|z| units::format(z, Dimension::Length));
        let message = format!("heights reach {highest}, expected magnitudes up to {most}");
        Err(self.error(self.source(), message, Some("check the units".to_owned())))
    }

    /// The key of the source.
    fn source(&self) -> &'static str {
        if let Source::Given { .. } = self.spec.source { "given" } else { "file" }
    }

    /// The file as named in the case, or the supplied name; empty for a generated surface.
    fn file(&self) -> String {
        match &self.spec.source {
            Source::File { file, .. } => file.display().to_string(),
            Source::Given { given } => given.clone(),
            _ => String::new(),
        }
    }

    /// Error of a preparation step, at its key.
    fn preparing(&self, error: Error) -> Error {
        match error {
            Error::Interrupted => error,
            Error::WindowOutside { .. } => self.error("window", error.to_string(), None),
            Error::NothingDefined { .. } => {
                self.error(self.source(), format!("{}: {error}", self.file()), error.hint())
            }
            other => self.parameter(other),
        }
    }

    /// Error for a parameter that is invalid on this grid, at its key.
    pub fn parameter(&self, error: Error) -> Error {
        self.parameter_of("", error)
    }

    /// Error for a parameter that is invalid on this grid, at its key in a `table` within that of the
    /// topography, `"plus.0."`.
    pub fn parameter_of(&self, table: &str, error: Error) -> Error {
        match error {
            Error::OutOfRange { quantity, value, dimension, expected } => {
                let value =
                    dimension.map_or_else(|| value.to_string(), |dimension| units::format(value, dimension));
                let message = format!("'{quantity}' is {value}, expected {expected}");
                self.error(&format!("{table}{quantity}"), message, None)
            }
            other => self.error("", other.to_string(), other.hint()),
        }
    }
}

/// Two surfaces that must fit together, and advice on how to make them fit.
pub struct Fit<'a> {
    case: &'a Case,
    grids: [Grid; 2],
    /// The source files.
    origins: [Option<&'a Origin>; 2],
}

/// Names of the bodies in messages.
const NAMES: [&str; 2] = ["lower", "upper"];

impl<'a> Fit<'a> {
    /// The surfaces of a case on these grids, not read from files.
    pub fn new(case: &'a Case, grids: [Grid; 2]) -> Self {
        Self { case, grids, origins: [None; 2] }
    }
}

impl Fit<'_> {
    /// Returns an error if the surfaces differ in pitch, or in the number of cells along one of these axes.
    pub fn check(&self, axes: &[usize]) -> Result<()> {
        self.check_pitches()?;
        axes.iter().try_for_each(|&axis| self.check_shapes(axis))
    }

    fn specs(&self) -> [&TopographySpec; 2] {
        [&self.case.lower.topography, &self.case.upper.topography]
    }

    fn check_pitches(&self) -> Result<()> {
        let [lower, upper] = self.grids;
        if (0..2).all(|axis| same(lower.pitch[axis], upper.pitch[axis])) {
            return Ok(());
        }
        // A generated surface can be made on any grid. Of two measured surfaces the finer one loses the
        // least.
        let changed = match self.origins.map(|origin| origin.is_some()) {
            [false, true] => 0,
            [true, false] => 1,
            _ => usize::from(upper.cell_area() < lower.cell_area()),
        };
        let other = self.grids[1 - changed];
        let one_extent = (0..2).all(|axis| same(lower.extent()[axis], upper.extent()[axis]));
        let setting = if one_extent && self.origins[changed].is_some() {
            format!("resample = {:?}", other.shape)
        } else if other.pitch[0] == other.pitch[1] {
            format!("pitch = {}", quoted(other.pitch[0]))
        } else {
            format!("pitch = [{}, {}]", quoted(other.pitch[0]), quoted(other.pitch[1]))
        };
        let message = format!(
            "the bodies have different pitches: lower {}, upper {}",
            lengths(lower.pitch),
            lengths(upper.pitch)
        );
        Err(self.error("pitch", changed, message, &[setting]))
    }

    fn check_shapes(&self, axis: usize) -> Result<()> {
        let shapes = self.grids.map(|grid| grid.shape);
        let [lower, upper] = shapes;
        if lower[axis] == upper[axis] {
            return Ok(());
        }
        let changed = usize::from(upper[axis] > lower[axis]);
        let (mut shape, kept) = (shapes[changed], lower[axis].min(upper[axis]));
        let spec = self.specs()[changed];
        let message = format!(
            "the bodies have different numbers of cells along {}: lower {}, upper {}",
            ["x", "y"][axis],
            by(lower),
            by(upper)
        );
        let preparation = &spec.preparation;
        if preparation.rotate != 0.0 {
            let name = NAMES[changed];
            let hint = format!(
                "a smaller `window` in [{name}.topography], in samples before `rotate`, leaves fewer; or set `grid = \"common\"` in [contact]"
            );
            return Err(self.case.error_at(&format!("{name}.topography.window"), message, Some(hint)));
        }
        let source = match self.origins[changed] {
            Some(origin) => origin.shape,
            None => spec.source.shape().unwrap_or(shapes[1 - changed]),
        };
        let [x0, y0, nx, ny] = preparation.window.unwrap_or([0, 0, source[0], source[1]]);
        let mut samples = [nx, ny];
        // In samples of the source, if those are not the cells.
        samples[axis] = (samples[axis] * kept).div_ceil(shape[axis]);
        shape[axis] = kept;
        let is_made = self.origins[changed].is_none();
        let mut settings = if is_made && preparation.window.is_none() && preparation.resample.is_none() {
            vec![format!("shape = {shape:?}")]
        } else {
            vec![format!("window = {:?}", [x0, y0, samples[0], samples[1]])]
        };
        if preparation.resample.is_some() {
            settings.push(format!("resample = {shape:?}"));
        }
        let key = if settings[0].starts_with("shape") { "shape" } else { "window" };
        Err(self.error(key, changed, message, &settings))
    }

    fn error(&self, key: &str, body: usize, message: String, settings: &[String]) -> Error {
        let settings: Vec<_> = settings.iter().map(|setting| format!("`{setting}`")).collect();
        let hint = format!(
            "set `grid = \"common\"` in [contact], or {} in [{}.topography]",
            settings.join(" and "),
            NAMES[body]
        );
        self.case.error_at(&format!("{}.topography.{key}", NAMES[body]), message, Some(hint))
    }
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME_PITCH * a.abs().max(b.abs())
}

/// Writes a length as in a case file.
fn quoted(length: Metre) -> String {
    format!("\"{}\"", exact_pitch(length).replace('µ', "u"))
}

fn lengths([x, y]: [Metre; 2]) -> String {
    format!("{} × {}", exact_pitch(x), exact_pitch(y))
}

/// Writes a pitch with enough digits for a body with that pitch to fit this one.
pub fn exact_pitch(pitch: Metre) -> String {
    units::format_within(pitch, Dimension::Length, 0.1 * SAME_PITCH)
}

fn by([nx, ny]: [usize; 2]) -> String {
    format!("{nx} × {ny}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::fields::FieldFile;

    #[test]
    fn a_fresh_counter_body_is_made_like_the_first_from_a_seed_of_its_pass() {
        let text = "[lower]\nyoung = \"210 GPa\"\npoisson = 0.3\ntopography = { form = \"flat\", shape = [24, 16], pitch = \"1 um\" }\n\
            [upper]\nyoung = \"210 GPa\"\npoisson = 0.3\n[upper.topography]\ngenerate = \"self-affine\"\nseed = 6\nsq = \"0.1 um\"\n\
            hurst = 0.8\nlevel = \"plane\"\n[contact]\nload = \"1 mN\"\n[motion]\ncounter = \"fresh\"\npasses = 3\n";
        let case = |text: &str| Case::parse(text, Path::new("case.toml"), Path::new("")).unwrap();
        let made = |text: &str| bodies(&case(text), SurfaceInput::default()).unwrap().upper.topography;
        let first = made(text);
        let lower = Grid::new([24, 16], [1e-6; 2]).unwrap();
        let of = |pass| fresh_heights(&case(text), lower, pass).unwrap();
        let (second, third) = (of(2), of(3));
        assert!(second != third && second != *first.heights() && second == of(2));
        // Frozen: a change of these numbers changes how a resumed motion continues.
        let seeds = [seed_of_pass(5, 2), seed_of_pass(5, 3), seed_of_pass(6, 2)];
        assert_eq!(
            seeds,
            [18_227_308_612_529_490_622, 14_334_089_863_870_952_822, 5_263_930_057_923_644_503]
        );
        // It is the surface that a case file would generate with that seed.
        let other = text.replace("seed = 6", &format!("seed = {}", seeds[2]));
        assert_eq!(made(&other).heights(), &second);
        let sq = |heights: &Field| heights.std(0.0);
        assert!((sq(&second) / sq(first.heights()) - 1.0).abs() < 0.5);
    }

    #[test]
    fn the_underside_in_results_is_mounted_as_it_is_unless_the_case_says_otherwise() {
        let directory = tempfile::tempdir().unwrap();
        let grid = Grid::new([4, 3], [1e-6; 2]).unwrap();
        let lower = Field::from_shape_fn(grid.shape, |(ix, iy)| 1e-9 * (ix * ix + 2 * iy) as f64);
        let upper = &lower * 3.0 + 5e-9;
        let mut file = FieldFile::new(&directory.path().join("pass-0005.h5"));
        file.set("version", "0.1.0").set("pass", 5).set("identity", "a digest");
        file.add_field("lower", "m", &grid, [0.0; 2], &lower)
            .add_field("upper", "m", &grid, [0.0; 2], &upper);
        file.write().unwrap();
        let mounted = |channel: &str, mount: &str| {
            let body = |name: &str, more: &str, channel: &str| {
                format!(
                    "[{name}]\nyoung = \"210 GPa\"\npoisson = 0.3\n{more}\n[{name}.topography]\nfile = \"pass-0005.h5\"\n\
                     channel = \"{channel}\"\n"
                )
            };
            let path = directory.path().join("case.toml");
            let text =
                body("lower", "", "lower") + &body("upper", mount, channel) + "[contact]\nload = \"1 mN\"\n";
            std::fs::write(&path, text).unwrap();
            bodies(&Case::load(&path).unwrap(), SurfaceInput::default()).unwrap()
        };
        let by_default = mounted("upper", "");
        assert_eq!(by_default.lower.topography.heights(), &lower);
        assert_eq!(by_default.upper.topography.heights(), &upper);
        assert_eq!(by_default.upper.mount, Mount::AsIs);
        assert!(by_default.upper.origin.unwrap().is_underside);
        let turned = mounted("upper", "mount = \"turned-over\"").upper;
        assert_eq!(turned.topography.heights()[[0, 0]], -upper[[3, 0]]);
        // The surface of a lower body is turned over, like any measured surface.
        let lower_as_upper = mounted("lower", "").upper;
        assert_eq!(lower_as_upper.topography.heights()[[0, 0]], -lower[[3, 0]]);
        assert_eq!(lower_as_upper.mount, Mount::TurnedOver);
    }
}

//! From a case to the two surfaces that meet: read or made, prepared, the upper one turned over.

use std::path::Path;

use super::case::{Body, Case, Mount, Source, TopographySpec};
use super::topography::{self, Scan};
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::motion::Strategy;
use crate::surface::Topography;
use crate::units::{self, Dimension, Metre};

/// Relative difference up to which two pitches are one.
const SAME: f64 = 1e-9;

/// The two surfaces of a case, on one pitch, which is the same to the last bit, and one width.
#[derive(Debug, Clone)]
pub struct Bodies {
    /// Its heights are those of the lower body's surface.
    pub lower: Prepared,
    /// Its heights are those of the upper body's underside.
    pub upper: Prepared,
}

/// A surface as it goes into the contact, every height defined.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// The heights; an approach counts from them as they are here.
    pub topography: Topography,
    /// Where they were read; none if they were made.
    pub origin: Option<Origin>,
}

/// What was read.
#[derive(Debug, Clone, PartialEq)]
pub struct Origin {
    /// See [`Scan::format`].
    pub format: &'static str,
    /// The channel.
    pub channel: String,
    /// Number of samples along x and y in the file.
    pub shape: [usize; 2],
    /// Missing heights within the window, since filled.
    pub undefined: usize,
}

/// Reads or makes both topographies of `case` and prepares them as [`TopographySpec`] says.
///
/// # Errors
/// [`Error::Case`] at the key that is to blame: a file that cannot be read, a parameter without meaning on this grid,
/// missing heights that nothing fills, and surfaces that do not fit together. They must have one pitch and one number
/// of cells along y; where nothing moves, and where both are shifted, also along x.
pub fn bodies(case: &Case) -> Result<Bodies> {
    let lower = prepared(case, "lower", &case.lower)?;
    let mut upper = prepared(case, "upper", &case.upper)?;
    let fit = Fit { case, bodies: [&lower, &upper] };
    fit.check_pitches()?;
    let overlap = matches!(case.motion, Some(motion) if motion.strategy == Strategy::Overlap);
    let axes: &[usize] = if overlap { &[1] } else { &[1, 0] };
    axes.iter().try_for_each(|&axis| fit.check_shapes(axis))?;
    let grid = Grid::new(upper.topography.grid().shape, lower.topography.grid().pitch)?;
    upper.topography = Topography::new(grid, upper.topography.into_heights())?;
    Ok(Bodies { lower, upper })
}

fn prepared(case: &Case, name: &str, body: &Body) -> Result<Prepared> {
    let at = Place { case, body: name };
    let spec = &body.topography;
    let (topography, origin) = match &spec.source {
        Source::File { path, channel, .. } => {
            let (topography, origin) = measured(at, path, channel.as_deref(), spec)?;
            (topography, Some(origin))
        }
        Source::Generate { generate, shape, seed } => {
            let topography = grid(*shape, spec).and_then(|grid| generate.generate(&grid, *seed));
            (cut(at, topography.map_err(|error| at.parameter(error))?, spec)?, None)
        }
        Source::Form { form, shape } => {
            let topography = grid(*shape, spec).and_then(|grid| form.on(&grid));
            (cut(at, topography.map_err(|error| at.parameter(error))?, spec)?, None)
        }
    };
    let topography = topography.level(spec.level);
    let topography = match (spec.resample, spec.pitch, &origin) {
        (Some(shape), ..) => topography.resample_to_shape(shape),
        (None, Some(pitch), Some(_)) if pitch != topography.grid().pitch => {
            topography.resample_to_pitch(pitch)
        }
        _ => Ok(topography),
    };
    let mut topography = topography.map_err(|error| at.parameter(error))?;
    for (n, layer) in spec.plus.iter().enumerate() {
        let added =
            layer.on(topography.grid()).map_err(|error| at.parameter_of(&format!("plus.{n}."), error))?;
        topography = topography.plus(&added)?;
    }
    let topography = match body.mount {
        Mount::TurnedOver => topography.underside(),
        Mount::AsIs => topography,
    };
    Ok(Prepared { topography, origin })
}

/// Read, cut and filled.
fn measured(
    at: Place<'_>,
    path: &Path,
    channel: Option<&str>,
    spec: &TopographySpec,
) -> Result<(Topography, Origin)> {
    let scan = topography::read(path, channel).map_err(|error| at.reading(error))?;
    let Scan { format, channel, pitch: carried, heights, .. } = scan;
    let shape = [heights.nrows(), heights.ncols()];
    if let (Some(_), Some(carried)) = (spec.pitch.and(spec.resample), carried) {
        return Err(at.error(
            "resample",
            format!(
                "both 'resample' and 'pitch' are given, but the file has its own pitch, {}",
                lengths(carried)
            ),
            Some("leave one of them out: each resamples the heights".to_owned()),
        ));
    }
    let pitch = carried.or(spec.pitch).ok_or_else(|| {
        at.error(
            "file",
            format!("{} ({format}) has no pitch", path.display()),
            Some("add the distance of its heights, for example `pitch = \"0.5 um\"`".to_owned()),
        )
    })?;
    let grid = Grid::new(shape, pitch).map_err(|error| at.parameter(error))?;
    let scanned = Topography::new(grid, heights).map_err(|error| at.reading(error))?;
    let part = cut(at, scanned, spec)?;
    let origin = Origin { format, channel, shape, undefined: part.undefined() };
    let fill = match &spec.source {
        Source::File { fill, .. } => *fill,
        _ => Default::default(),
    };
    let filled = part.fill(fill).map_err(|error| match error {
        Error::UndefinedSamples { undefined, samples } => at.error(
            "file",
            format!("{undefined} of {samples} heights of {} are missing", path.display()),
            Some("set `fill = \"harmonic\"`, a membrane over each hole, or `fill = \"nearest\"`".to_owned()),
        ),
        other => at.error("file", format!("{}: {other}", path.display()), other.hint()),
    })?;
    Ok((filled, origin))
}

fn grid(shape: [usize; 2], spec: &TopographySpec) -> Result<Grid> {
    Grid::new(shape, spec.pitch.expect("the case has the pitch of what is made"))
}

fn cut(at: Place<'_>, topography: Topography, spec: &TopographySpec) -> Result<Topography> {
    let Some(window) = spec.window else { return Ok(topography) };
    topography.window(window).map_err(|error| at.error("window", error.to_string(), None))
}

/// Where the mistakes of one body's topography are shown.
#[derive(Clone, Copy)]
struct Place<'a> {
    case: &'a Case,
    body: &'a str,
}

impl Place<'_> {
    fn error(&self, key: &str, message: String, hint: Option<String>) -> Error {
        self.case.error_at(&format!("{}.topography.{key}", self.body), message, hint)
    }

    /// A file that could not be read: what its reader said, at the key that names the file or its channel.
    fn reading(&self, error: Error) -> Error {
        match &error {
            Error::NoChannel { available, .. } => {
                let names: Vec<_> = available.iter().map(|name| format!("`{name}`")).collect();
                let hint = format!("it holds {}; choose one with `channel`", names.join(", "));
                self.error("channel", error.to_string(), Some(hint))
            }
            Error::File { source, .. } if source.kind() == std::io::ErrorKind::NotFound => {
                let hint = "the files of a case are looked for in the case file's folder".to_owned();
                self.error("file", error.to_string(), Some(hint))
            }
            _ => self.error("file", error.to_string(), error.hint()),
        }
    }

    /// A parameter that turned out to have no meaning on this grid, at its key.
    fn parameter(&self, error: Error) -> Error {
        self.parameter_of("", error)
    }

    /// The same of a `table` within the topography's, `"plus.0."`.
    fn parameter_of(&self, table: &str, error: Error) -> Error {
        match error {
            Error::OutOfRange { quantity, value, expected } => {
                let value = match quantity {
                    "hurst" | "sdq" | "ssk" | "sku" | "shape" | "resample" => value.to_string(),
                    _ => units::format(value, Dimension::Length),
                };
                let message = format!("'{quantity}' is {value}, expected {expected}");
                self.error(&format!("{table}{quantity}"), message, None)
            }
            other => self.error("", other.to_string(), other.hint()),
        }
    }
}

/// Two surfaces that must fit together, and what would make them.
struct Fit<'a> {
    case: &'a Case,
    bodies: [&'a Prepared; 2],
}

const NAMES: [&str; 2] = ["lower", "upper"];

impl Fit<'_> {
    fn grids(&self) -> [Grid; 2] {
        self.bodies.map(|body| *body.topography.grid())
    }

    fn specs(&self) -> [&TopographySpec; 2] {
        [&self.case.lower.topography, &self.case.upper.topography]
    }

    fn check_pitches(&self) -> Result<()> {
        let [lower, upper] = self.grids();
        if (0..2).all(|axis| same(lower.pitch[axis], upper.pitch[axis])) {
            return Ok(());
        }
        // What was made can be made on any grid; of two measured surfaces the finer one loses the least.
        let changed = match self.bodies.map(|body| body.origin.is_some()) {
            [false, true] => 0,
            [true, false] => 1,
            _ => usize::from(upper.cell_area() < lower.cell_area()),
        };
        let other = self.grids()[1 - changed];
        let one_extent = (0..2).all(|axis| same(lower.extent()[axis], upper.extent()[axis]));
        let setting = if one_extent && self.bodies[changed].origin.is_some() {
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
        let shapes = self.grids().map(|grid| grid.shape);
        let [lower, upper] = shapes;
        if lower[axis] == upper[axis] {
            return Ok(());
        }
        let changed = usize::from(upper[axis] > lower[axis]);
        let (mut shape, kept) = (shapes[changed], lower[axis].min(upper[axis]));
        let spec = self.specs()[changed];
        let source = match (&spec.source, &self.bodies[changed].origin) {
            (Source::Generate { shape, .. } | Source::Form { shape, .. }, _) => *shape,
            (_, Some(origin)) => origin.shape,
            (Source::File { .. }, None) => shape,
        };
        let [x0, y0, nx, ny] = spec.window.unwrap_or([0, 0, source[0], source[1]]);
        let mut samples = [nx, ny];
        // In samples of the source, where those are not the cells.
        samples[axis] = (samples[axis] * kept).div_ceil(shape[axis]);
        shape[axis] = kept;
        let is_made = self.bodies[changed].origin.is_none();
        let mut settings = if is_made && spec.window.is_none() && spec.resample.is_none() {
            vec![format!("shape = {shape:?}")]
        } else {
            vec![format!("window = {:?}", [x0, y0, samples[0], samples[1]])]
        };
        if spec.resample.is_some() {
            settings.push(format!("resample = {shape:?}"));
        }
        let message = format!(
            "the bodies have different numbers of cells along {}: lower {}, upper {}",
            ["x", "y"][axis],
            by(lower),
            by(upper)
        );
        let key = if settings[0].starts_with("shape") { "shape" } else { "window" };
        Err(self.error(key, changed, message, &settings))
    }

    fn error(&self, key: &str, body: usize, message: String, settings: &[String]) -> Error {
        let settings: Vec<_> = settings.iter().map(|setting| format!("`{setting}`")).collect();
        let hint = format!("set {} in [{}.topography]", settings.join(" and "), NAMES[body]);
        Place { case: self.case, body: NAMES[body] }.error(key, message, Some(hint))
    }
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME * a.abs().max(b.abs())
}

/// As a case file has it, to the last digit.
fn quoted(length: Metre) -> String {
    let short = units::format(length, Dimension::Length);
    match units::parse(&short, Dimension::Length) {
        Ok(value) if same(value, length) => format!("\"{}\"", short.replace('µ', "u")),
        _ => format!("{length:e}"),
    }
}

fn lengths([x, y]: [Metre; 2]) -> String {
    // As many digits as it takes to see that two pitches differ.
    let digits = |length| {
        let short = units::format(length, Dimension::Length);
        let exact = units::parse(&short, Dimension::Length).is_ok_and(|value| same(value, length));
        if exact { short } else { units::format_digits(length, Dimension::Length, 10) }
    };
    format!("{} × {}", digits(x), digits(y))
}

fn by([nx, ny]: [usize; 2]) -> String {
    format!("{nx} × {ny}")
}

//! Heat, current and fluid through a contact, in words for the terminal and the page.

use std::path::{Path, PathBuf};

use asperity::conductance::{Kind, MAX_CORRELATED_FRACTION};
use asperity::flow::Along;
use asperity::io;
use asperity::study::{Case, ConductanceRecord, GapFlowRecord};
use asperity::surface::Topography;
use asperity::units::{Dimension, Metre, format, format_number};
use asperity::{Choice, Grid};

use crate::args::{Input, Writing};
use crate::draw::{self, Caption, Figure, Paper};
use crate::report::{Failure, Outcome};
use crate::surface;

/// Returns the requested conductance and flow of a case, as `asperity check` prints them: name and value.
pub(crate) fn asked(case: &Case) -> Vec<(&'static str, String)> {
    let mut rows = Vec::new();
    if let Some(spec) = case.conductance {
        let film = spec.film.map_or(String::new(), |film| {
            let dimension = match spec.kind {
                Kind::Thermal => Dimension::ThermalInsulance,
                Kind::Electrical => Dimension::ElectricalInsulance,
            };
            format!(", film {}", format(film, dimension))
        });
        let gas = spec.gas.map_or(String::new(), |gas| {
            let jump = format(spec.jump, Dimension::Length);
            format!(", gas {} with a jump distance of {jump}", format(gas, Dimension::Conductivity))
        });
        rows.push(("conducts", format!("{}{film}{gas}; {}", spec.kind.word(), often(case, spec.every))));
    }
    if let Some(spec) = case.flow {
        let (viscosity, pressure) =
            (format(spec.viscosity, Dimension::Viscosity), format(spec.pressure, Dimension::Pressure));
        let kind = if spec.gas { "a gas" } else { "a liquid" };
        let ends = |axis| spec.ends_along(axis, case.contact.boundary).word();
        let ends = match spec.along {
            Along::X => ends(0).to_owned(),
            Along::Y => ends(1).to_owned(),
            Along::Both if ends(0) == ends(1) => ends(0).to_owned(),
            Along::Both => format!("{} along x and {} along y", ends(0), ends(1)),
        };
        rows.push((
            "leaks",
            format!("{kind} of {viscosity} under {pressure}, ends {ends}; {}", often(case, spec.every)),
        ));
    }
    rows
}

/// Describes the observed contacts.
fn often(case: &Case, every: usize) -> String {
    match (case.motion.is_some(), every) {
        (true, 0) => "once a pass".to_owned(),
        (true, 1) => "at each position".to_owned(),
        (true, every) => format!("at every {every}th position"),
        (false, 0) => "of the last contact".to_owned(),
        (false, 1) => "of each contact".to_owned(),
        (false, every) => format!("of every {every}th contact"),
    }
}

/// The rows of a conductance: name and value.
pub(crate) fn conductance(row: &ConductanceRecord) -> Vec<(String, String)> {
    let kind = if row.thermal.is_some() { Kind::Thermal } else { Kind::Electrical };
    let [joint, correlation] = row.joint();
    let mut rows = conducts(kind, row.conductance(), joint);
    if let (Some(joint), Some((_, value))) = (joint.filter(|joint| *joint > 0.0), rows.get_mut(1)) {
        if row.gas_share > 0.0 {
            *value += &format!(", of which the spots {}", of_area(kind, joint * row.spot_share));
        }
        match correlation {
            Some(h) if row.film_share == 0.0 => {
                *value += &format!(", spots by the correlation {}", of_area(kind, h));
            }
            None if row.contact_fraction() > MAX_CORRELATED_FRACTION => {
                *value += &format!(
                    " ({:.0} % of the area touch: beyond the {:.0} % of the correlations)",
                    100.0 * row.contact_fraction(),
                    100.0 * MAX_CORRELATED_FRACTION
                );
            }
            _ => {}
        }
    }
    rows
}

/// A conductance of an area with its unit.
fn of_area(kind: Kind, value: f64) -> String {
    let dimension = match kind {
        Kind::Thermal => Dimension::ThermalConductanceOfArea,
        Kind::Electrical => Dimension::ElectricalConductanceOfArea,
    };
    format(value, dimension)
}

/// The rows of a conductance and of a joint conductance.
pub(crate) fn conducts(kind: Kind, conductance: Option<f64>, joint: Option<f64>) -> Vec<(String, String)> {
    let whole = match kind {
        Kind::Thermal => Dimension::ThermalConductance,
        Kind::Electrical => Dimension::ElectricalConductance,
    };
    let Some(conductance) = conductance else {
        return vec![("conductance".to_owned(), "no resistance: all cells touch without a film".to_owned())];
    };
    let mut value = format(conductance, whole);
    if conductance > 0.0 {
        value += &format!(", resistance {}", resistance(kind, conductance.recip()));
    }
    let mut rows = vec![("conductance".to_owned(), value)];
    rows.extend(joint.map(|joint| ("joint conductance".to_owned(), of_area(kind, joint))));
    rows
}

/// A resistance with its unit.
pub(crate) fn resistance(kind: Kind, value: f64) -> String {
    let dimension = match kind {
        Kind::Thermal => Dimension::ThermalResistance,
        Kind::Electrical => Dimension::ElectricalResistance,
    };
    format(value, dimension)
}

/// The rows of a flow along one axis: name and value.
pub(crate) fn flow(row: &GapFlowRecord) -> Vec<(String, String)> {
    let name = format!("leakage along {}", row.along.word());
    let place = row.critical_x.zip(row.critical_y).map(|(x, y)| [x, y]);
    leaks(name, format(row.leakage, Dimension::VolumeFlow), row.critical_gap, place, row.estimate)
}

/// The row of a leakage or a permeability, and that of the critical constriction and its place.
pub(crate) fn leaks(
    name: String,
    value: String,
    critical_gap: Metre,
    place: Option<[Metre; 2]>,
    estimate: f64,
) -> Vec<(String, String)> {
    if critical_gap == 0.0 {
        return vec![(name, "none: no path through the gap".to_owned())];
    }
    let length = |value| format(value, Dimension::Length);
    let place = place.map_or(String::new(), |[x, y]| format!(" at x = {}, y = {}", length(x), length(y)));
    let within = format_number((1000.0 * estimate).ceil() / 10.0);
    let constriction = format!("gap {}{place}; permeability within {within} %", length(critical_gap));
    vec![(name, value), ("constriction".to_owned(), constriction)]
}

/// Reads and prepares the map of a command. It needs a pitch, and all of its samples.
pub(crate) fn read(input: &Input) -> Outcome<Topography> {
    let read = surface::read_prepared(input)?;
    if read.pitch.is_none() {
        let message = format!("the cells of `{}` need a pitch, which the file has not", input.file.display());
        return Err(surface::without_pitch(message));
    }
    defined(read.topography)
}

/// Reads and prepares a map of the gap on the cells of a `contact`.
pub(crate) fn read_gap(path: &Path, input: &Input, contact: &Topography) -> Outcome<Topography> {
    let gap = surface::read_beside(path, input, contact.grid().pitch)?.topography;
    let [own, other] = [gap.grid(), contact.grid()];
    let alike = (0..2).all(|axis| (own.pitch[axis] / other.pitch[axis] - 1.0).abs() < SAME_PITCH);
    if own.shape != other.shape || !alike {
        let message =
            format!("--gap `{}` has {}, the contact has {}", path.display(), cells(own), cells(other));
        return Err(Failure::usage(message, Some("both maps need the same cells")));
    }
    defined(gap)
}

/// Relative difference of pitches that are alike, as files store them with some digits.
const SAME_PITCH: f64 = 1e-5;

/// Checks that a map has all of its samples.
fn defined(map: Topography) -> Outcome<Topography> {
    match map.undefined() {
        0 => Ok(map),
        undefined => Err(asperity::Error::UndefinedSamples { undefined, samples: map.grid().cells() }.into()),
    }
}

/// Returns the number and the size of the cells of a map.
pub(crate) fn cells(grid: &Grid) -> String {
    let ([nx, ny], [x, y]) = (grid.shape, grid.pitch.map(|pitch| format(pitch, Dimension::Length)));
    format!("{nx} × {ny} cells of {x} × {y}")
}

/// The folder for the files of a command.
pub(crate) struct Files {
    folder: PathBuf,
    paper: Paper,
    /// The file that was read.
    of: String,
}

impl Files {
    /// Returns the requested folder; none if nothing is written.
    ///
    /// # Errors
    /// It exists, and is not to be overwritten.
    pub(crate) fn new(writing: &Writing, file: &Path, paper: Paper) -> Outcome<Option<Self>> {
        let Some(folder) = &writing.out else { return Ok(None) };
        if folder.exists() && !writing.overwrite {
            let message = format!("`{}` exists", folder.display());
            return Err(Failure::usage(message, Some("--overwrite replaces the files in it")));
        }
        let of = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Some(Self { folder: folder.clone(), paper, of }))
    }

    /// The path of a file in the folder.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Writes a file, the first one of the folder.
    pub(crate) fn write(&self, name: &str, content: &[u8]) -> Outcome {
        let failed = |source| asperity::Error::File { path: self.folder.clone(), source };
        std::fs::create_dir_all(&self.folder).map_err(failed)?;
        io::sweep(&self.folder);
        Ok(io::replace(&self.path(name), content)?)
    }

    /// Draws a figure.
    pub(crate) fn draw(&self, name: &str, title: &str, figure: &dyn Figure) -> Outcome {
        let path = self.path(&format!("{name}.{}", self.paper.format.extension()));
        let caption = Caption { title: title.to_owned(), of: self.of.clone() };
        Ok(draw::save(&path, figure, &caption, &self.paper)?)
    }
}

/// A line of a name and a value.
pub(crate) fn line(name: &str, value: &str) -> String {
    format!("{name:<17} {value}\n")
}

//! `asperity surface`: generates, describes, draws and converts topographies.

mod convert;
mod generate;
mod info;
mod output;
mod plot;

use std::path::Path;

use asperity::grid::Grid;
use asperity::surface::{LengthUnit, Scan, Topography};
use asperity::units::{self, Dimension, Metre};

use asperity_report::describe::{findings_in_words, prevailing_form};

use crate::args::{Input, ReadingArguments, Surface};
use crate::report::{Failure, Outcome, note};

pub(crate) fn surface(arguments: Surface) -> Outcome {
    match arguments {
        Surface::Generate(arguments) => generate::generate(arguments),
        Surface::Info(arguments) => info::info(&arguments),
        Surface::Plot(arguments) => plot::plot(&arguments),
        Surface::Convert(arguments) => convert::convert(&arguments),
    }
}

/// Heights of a file, its other data, and the pitch: its own, or else the given one.
pub(crate) struct ReadSurface {
    pub(crate) topography: Topography,
    pub(crate) pitch: Option<[Metre; 2]>,
    scan: Scan,
}

/// Without any pitch the heights stand on cells of 1 m.
fn read(path: &Path, reading: &ReadingArguments) -> Outcome<ReadSurface> {
    let mut scan = reading.options().scan(path)?;
    if let (Some(own), Some(_)) = (scan.pitch, &reading.pitch) {
        return Err(has_pitch(path, own, &scan));
    }
    let pitch = scan.pitch.or(reading.pitch);
    let heights = std::mem::take(&mut scan.heights);
    let grid = Grid::new([heights.nrows(), heights.ncols()], pitch.unwrap_or([1.0; 2]))?;
    Ok(ReadSurface { topography: Topography::new(grid, heights)?, pitch, scan })
}

/// Reads a file ([`read`]) and prepares it according to the arguments, with notes on the steps.
pub(crate) fn read_prepared(input: &Input) -> Outcome<ReadSurface> {
    let read = read(&input.file, &input.reading)?;
    if let (None, Some(argument)) = (read.pitch, input.preparing.needs_pitch()) {
        let message = format!("{argument} needs a pitch, which `{}` has not", input.file.display());
        return Err(without_pitch(message));
    }
    let (topography, findings) = input.preparing.preparation().apply(read.topography)?;
    findings_in_words(&findings, &topography).iter().for_each(|finding| note(finding));
    Ok(ReadSurface { pitch: read.pitch.map(|_| topography.grid().pitch), topography, scan: read.scan })
}

/// Reads and prepares a second file with the arguments of a first one, whose pitch it has unless it has its
/// own.
pub(crate) fn read_beside(path: &Path, input: &Input, pitch: [Metre; 2]) -> Outcome<ReadSurface> {
    let mut scan = input.reading.options().scan(path)?;
    let pitch = scan.pitch.or(input.reading.pitch).unwrap_or(pitch);
    let heights = std::mem::take(&mut scan.heights);
    let topography = Topography::new(Grid::new([heights.nrows(), heights.ncols()], pitch)?, heights)?;
    let (topography, _) = input.preparing.preparation().apply(topography)?;
    Ok(ReadSurface { pitch: Some(topography.grid().pitch), topography, scan })
}

/// Returns the failure for a pitch if the file has its own.
fn has_pitch(path: &Path, [x, y]: [Metre; 2], scan: &Scan) -> Failure {
    let [x, y] = [x, y].map(|pitch| units::format(pitch, Dimension::Length));
    let hint = match scan.unit {
        LengthUnit::Known => "--resample brings it onto another pitch",
        _ => "its lengths have no unit and are taken as metres; give the unit: --unit um",
    };
    Failure::usage(
        format!("`{}` has a pitch of its own, {x} × {y}: --pitch would be ignored", path.display()),
        Some(hint),
    )
}

/// Returns the failure of a step that needs a pitch, if neither the file nor an argument gives one.
pub(crate) fn without_pitch(message: impl Into<String>) -> Failure {
    Failure::usage(message, Some("give it: --pitch 0.5um"))
}

/// Writes a note if most of the variance of the heights is tilt or form.
fn suggest_level(topography: &Topography) {
    if let Some((cause, share, level)) = prevailing_form(topography) {
        note(&format!("note: {cause} {:.1} % of Sq²; `--level {level}` removes it", 100.0 * share));
    }
}

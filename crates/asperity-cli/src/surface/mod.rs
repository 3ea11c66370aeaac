//! `asperity surface`: topographies made, described, drawn, converted.

mod convert;
mod description;
mod generate;
mod info;
mod output;
mod plot;

use std::path::Path;

use asperity::grid::Grid;
use asperity::io::topography::{self, Scan};
use asperity::surface::Topography;
use asperity::units::Metre;

use crate::args::{Reading, Surface};
use crate::report::Outcome;

pub(crate) fn surface(arguments: Surface) -> Outcome {
    match arguments {
        Surface::Generate(arguments) => generate::generate(arguments),
        Surface::Info(arguments) => info::info(&arguments),
        Surface::Plot(arguments) => plot::plot(&arguments),
        Surface::Convert(arguments) => convert::convert(&arguments),
    }
}

/// A file's heights, what else it says, and the pitch: its own, or else the one given.
struct Read {
    topography: Topography,
    pitch: Option<[Metre; 2]>,
    scan: Scan,
}

/// Without any pitch the heights stand on cells of 1 m.
fn read(path: &Path, reading: &Reading) -> Outcome<Read> {
    let mut scan = topography::read(path, reading.channel.as_deref())?;
    let pitch = scan.pitch.or(reading.pitch.map(|pitch| pitch.0));
    let heights = std::mem::take(&mut scan.heights);
    let grid = Grid::new([heights.nrows(), heights.ncols()], pitch.unwrap_or([1.0; 2]))?;
    Ok(Read { topography: Topography::new(grid, heights)?, pitch, scan })
}

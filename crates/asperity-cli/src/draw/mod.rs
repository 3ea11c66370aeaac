//! Figures: maps of fields, curves, matrices, animations.
//!
//! A figure is a value; a function draws it into a file. Lengths, pressures and all else come in SI and are
//! shown in the unit that suits them. A field is indexed `[ix, iy]`, x to the right, y up. Undefined (NaN) cells
//! are light grey. The same figure gives the same bytes on every machine: the font is part of the program.

mod animation;
mod axis;
mod canvas;
mod lines;
mod map;
#[cfg(test)]
mod tests;

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

pub(crate) use animation::{Animation, Frame, animation};
pub(crate) use axis::{Quantity, Unit};
pub(crate) use lines::{Axis, LineFigure, Mark, Series, lines};
pub(crate) use map::{
    Colours, MapFigure, MatrixFigure, PlaneFigure, SectionFigure, map, maps, matrix, plane, section,
};

/// A figure that could not be drawn, or not be written.
#[derive(Debug)]
pub(crate) struct Error {
    /// The file that was to be written.
    pub(crate) path: PathBuf,
    /// The reason.
    pub(crate) source: io::Error,
}

/// The result of drawing a figure.
pub(crate) type Result<T> = std::result::Result<T, Error>;

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot draw `{}`: {}", self.path.display(), self.source)
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.source)
    }
}

/// Adds the file's path to an error.
fn at(path: &Path) -> impl FnOnce(io::Error) -> Error {
    let path = path.to_owned();
    move |source| Error { path, source }
}

/// An error of the caller: the figure makes no sense.
fn invalid(path: &Path, message: String) -> Error {
    Error { path: path.to_owned(), source: io::Error::new(io::ErrorKind::InvalidInput, message) }
}

/// Writes `bytes` under a temporary name beside `path`, then renames.
fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    asperity::io::atomic::write(path, bytes).map_err(|error| match error {
        asperity::Error::File { source, .. } => at(path)(source),
        other => at(path)(io::Error::other(other.to_string())),
    })
}

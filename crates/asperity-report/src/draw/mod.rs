//! Figures: maps of fields, curves, reliefs, matrices, animations.
//!
//! A figure is a value; it draws itself as a [`Scene`] of shapes, images and text, which becomes a PNG, SVG
//! or PDF file. Lengths, pressures and all else come in SI and are shown in the unit that suits them. A field
//! is indexed `[ix, iy]`, x to the right, y up. Undefined (NaN) cells are light grey. The same figure gives
//! the same bytes on every machine: the font is part of the program.

mod animation;
mod axis;
mod chart;
mod colour;
mod contour;
mod frame;
mod image;
mod legend;
mod map;
mod output;
mod pdf;
mod raster;
mod relief;
mod scene;
mod sheet;
mod svg;
#[cfg(test)]
mod tests;
mod text;

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

pub(crate) use animation::animation;
pub use axis::{Quantity, Unit};
pub use chart::{Axis, Chart, Charts, Mark, Series};
pub use colour::Colours;
pub(crate) use colour::palette;
pub use map::Map;
pub use output::{Caption, Figure, Format, Paper, save};
pub(crate) use output::{captioned, captioned_alike, picture, write as write_scene};
pub use relief::Relief;
pub use scene::Scene;
pub(crate) use sheet::range_of_heights;
pub use sheet::{Maps, heights};

/// A figure that could not be drawn, or not be written.
#[derive(Debug)]
pub struct Error {
    /// The file that was to be written.
    pub path: PathBuf,
    /// The reason.
    pub source: io::Error,
}

/// The result of drawing a figure.
pub type Result<T> = std::result::Result<T, Error>;

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
    asperity_base::io::replace(path, bytes).map_err(|error| match error {
        asperity_base::Error::File { source, .. } => at(path)(source),
        other => at(path)(io::Error::other(other.to_string())),
    })
}

//! Maps in files from which a command begins, and the files that it writes.

use std::path::{Path, PathBuf};

use asperity::Grid;
use asperity::io;
use asperity::surface::Topography;
use asperity::units::{Dimension, format};

use crate::args::{Input, Writing};
use crate::report::{Failure, Outcome};
use crate::surface;
use asperity_report::draw::{self, Caption, Figure, Paper};

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
    papers: Vec<Paper>,
    /// The file that was read.
    of: String,
}

impl Files {
    /// Returns the requested folder; none if nothing is written.
    ///
    /// # Errors
    /// It exists, and is not to be overwritten.
    pub(crate) fn new(writing: &Writing, file: &Path, papers: Vec<Paper>) -> Outcome<Option<Self>> {
        let Some(folder) = &writing.out else { return Ok(None) };
        if folder.exists() && !writing.overwrite {
            let message = format!("`{}` exists", folder.display());
            return Err(Failure::usage(message, Some("--overwrite replaces the files in it")));
        }
        let of = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Some(Self { folder: folder.clone(), papers, of }))
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
        let caption = Caption { title: title.to_owned(), of: self.of.clone() };
        for paper in &self.papers {
            let path = self.path(&format!("{name}.{}", paper.format.extension()));
            draw::save(&path, figure, &caption, paper)?;
        }
        Ok(())
    }
}

/// A line of a name and a value.
pub(crate) fn line(name: &str, value: &str) -> String {
    format!("{name:<17} {value}\n")
}

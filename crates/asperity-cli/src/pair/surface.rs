//! A topography file as a body needs it: its holes, its tilt, its pitch.

use std::fmt::Write as _;
use std::path::{Component, Path, PathBuf};

use asperity::grid::Grid;
use asperity::surface::{LengthUnit, Level, ReadOptions, Scan, Topography};
use asperity::units::{self, Dimension, Metre, format_number};

use crate::args::ReadingArguments;
use crate::report::{Failure, Outcome};

/// A file with what its table in a case has to say.
pub(super) struct FileSurface {
    body: &'static str,
    file: PathBuf,
    format: &'static str,
    grid: Grid,
    /// Keys that say how the file is read, with their values as TOML.
    reading: Vec<(&'static str, String)>,
    undefined: usize,
    /// Share of the variance of the heights that is tilt.
    tilt: f64,
}

impl FileSurface {
    /// Reads the file of a body. What the arguments say counts where the file does not say it itself.
    pub(super) fn read(body: &'static str, file: &Path, arguments: &ReadingArguments) -> Outcome<Self> {
        let asked = arguments.options();
        let mut own = ReadOptions::default();
        own.channel.clone_from(&asked.channel);
        let (scan, is_told) = match own.scan(file) {
            Ok(scan) if scan.unit == LengthUnit::Known && scan.lines.is_none() => (scan, false),
            Ok(_) => (asked.scan(file)?, true),
            Err(error) => (asked.scan(file).map_err(|_| error)?, true),
        };
        let Scan { format, pitch: own_pitch, heights, .. } = scan;
        let Some(pitch) = own_pitch.or(arguments.pitch) else {
            let message = format!("`{}` does not say how far its samples are apart", file.display());
            return Err(Failure::usage(message, Some("give their distance: --pitch 0.5um")));
        };
        let grid = Grid::new([heights.nrows(), heights.ncols()], pitch)?;
        let topography = Topography::new(grid, heights)?;
        let undefined = topography.undefined();
        if undefined == grid.cells() {
            let message = format!("`{}` has no heights: all its samples are missing", file.display());
            return Err(Failure::usage(message, None));
        }
        let left = |level| topography.clone().level(level).map_or(f64::NAN, |left| left.sq().powi(2));
        let tilt = 1.0 - left(Level::Plane) / left(Level::Mean);
        let mut reading = Vec::new();
        let mut tell = |key, value: Option<String>| reading.extend(value.map(|value| (key, value)));
        tell("channel", arguments.channel.as_deref().map(quoted));
        if is_told {
            tell("unit", arguments.unit.map(|unit| unit.to_string()));
            tell("lines", arguments.lines.map(|axis| quoted(asperity::Choice::word(axis))));
            tell("skip", Some(arguments.skip).filter(|skip| *skip > 0).map(|skip| skip.to_string()));
        }
        if own_pitch.is_none() {
            tell("pitch", Some(format!("[{:?}, {:?}]", pitch[0], pitch[1])));
        }
        Ok(Self { body, file: file.to_owned(), format, grid, reading, undefined, tilt })
    }

    /// Whether both files have the same grid.
    pub(super) fn fits(&self, other: &Self) -> bool {
        let alike = |one: Metre, other: Metre| (one - other).abs() <= 1e-9 * one;
        let [one, two] = [self.grid, other.grid];
        one.shape == two.shape && alike(one.pitch[0], two.pitch[0]) && alike(one.pitch[1], two.pitch[1])
    }

    /// Returns an error if it is too small for the cells of the other surface, to which it would be brought.
    pub(super) fn meets(&self, other: &Self) -> Outcome {
        /// Cells along an axis of a contact, at least.
        const LEAST: f64 = 4.0;
        let extent = self.grid.extent();
        match (0..2).find(|axis| extent[*axis] < LEAST * other.grid.pitch[*axis]) {
            None => Ok(()),
            Some(axis) => {
                let length = |value| units::format(value, Dimension::Length);
                let message = format!(
                    "`{}` is {} wide along {}, which is less than {LEAST} cells of `{}`, of {}",
                    self.file.display(),
                    length(extent[axis]),
                    ["x", "y"][axis],
                    other.file.display(),
                    length(other.grid.pitch[axis])
                );
                let hint = "the surfaces have to be measured on like scales; a line profile has no area";
                Err(Failure::usage(message, Some(hint)))
            }
        }
    }

    /// Returns the keys of its table in a case in this folder, each with its value as TOML.
    pub(super) fn keys(&self, folder: &Path) -> Vec<(&'static str, String)> {
        let file = seen_from(folder, &self.file).to_string_lossy().replace('\\', "/");
        let mut keys = vec![("file", quoted(&file))];
        keys.extend(self.reading.iter().cloned());
        if self.undefined > 0 {
            keys.push(("fill", quoted("harmonic")));
        }
        keys.push(("level", quoted("plane")));
        keys
    }

    /// Returns what became of the file on the `grid` of its body.
    pub(super) fn story(&self, grid: &Grid) -> String {
        let size = |grid: &Grid| {
            let [x, y] = grid.pitch.map(|pitch| units::format(pitch, Dimension::Length));
            let pitch = if x == y { x } else { format!("{x} × {y}") };
            format!("{} × {} of {pitch}", grid.shape[0], grid.shape[1])
        };
        let mut story =
            format!("{}: {}, {}, samples {}", self.body, self.file.display(), self.format, size(&self.grid));
        if self.undefined > 0 {
            let share = format_number(100.0 * self.undefined as f64 / self.grid.cells() as f64);
            let _ = write!(story, "; {} missing heights ({share} %) filled", self.undefined);
        }
        let tilt = format_number((1000.0 * self.tilt.max(0.0)).round() / 10.0);
        let _ = write!(story, "; tilt removed ({tilt} % of Sq²)");
        if grid.shape != self.grid.shape {
            let _ = write!(story, "; brought to {}", size(grid));
        }
        story
    }
}

/// Returns a text as TOML.
pub(super) fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

/// Returns the path of a file as it is seen from a folder; both may be relative to the present folder.
pub(super) fn seen_from(folder: &Path, file: &Path) -> PathBuf {
    if file.is_absolute() {
        return file.to_owned();
    }
    let is_plain =
        |path: &Path| path.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    if is_plain(folder) {
        let parts = folder.components().filter(|part| matches!(part, Component::Normal(_)));
        parts.map(|_| "..").collect::<PathBuf>().join(file)
    } else {
        std::path::absolute(file).unwrap_or_else(|_| file.to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_found_from_the_folder_of_its_case() {
        let from = |folder: &str, file: &str| seen_from(Path::new(folder), Path::new(file));
        assert_eq!(from("out", "disc.x3p"), Path::new("../disc.x3p"));
        assert_eq!(from("./runs/out", "data/disc.x3p"), Path::new("../../data/disc.x3p"));
        assert_eq!(from("", "disc.x3p"), Path::new("disc.x3p"));
        assert_eq!(from("out", "/data/disc.x3p"), Path::new("/data/disc.x3p"));
        assert!(from("../out", "disc.x3p").is_absolute());
    }
}

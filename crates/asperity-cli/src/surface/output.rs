//! The file that a topography is written to.

use std::path::{Path, PathBuf};

use asperity::io::atomic;
use asperity::io::topography::{gwy, npy, sdf, vtk, x3p};
use asperity::surface::Topography;
use asperity::units::Metre;

use super::without_pitch;
use crate::draw::{self, Caption, Paper};
use crate::report::{Failure, Outcome};

/// A file that may be written, of a format that its name tells.
pub(super) struct Output {
    path: PathBuf,
    format: Format,
}

#[derive(Clone, Copy, PartialEq)]
enum Format {
    Npy,
    X3p,
    Sdf,
    Gwy,
    Vtk,
    Png,
}

impl Output {
    /// Refuses a name that tells no format, and an existing file unless `overwrite`.
    pub(super) fn new(path: &Path, overwrite: bool) -> Outcome<Self> {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        let format = match extension.as_deref() {
            Some("npy") => Format::Npy,
            Some("x3p") => Format::X3p,
            Some("sdf") => Format::Sdf,
            Some("gwy") => Format::Gwy,
            Some("vtk") => Format::Vtk,
            Some("png") => Format::Png,
            _ => {
                let hint = "the end of its name tells the format: .npy, .x3p, .sdf, .gwy, .vtk or .png";
                return Err(Failure::usage(
                    format!("no format to write `{}` in", path.display()),
                    Some(hint),
                ));
            }
        };
        if path.exists() && !overwrite {
            let message = format!("`{}` exists", path.display());
            return Err(Failure::usage(message, Some("--overwrite replaces it")));
        }
        Ok(Self { path: path.to_owned(), format })
    }

    /// Writes the heights, or draws them.
    pub(super) fn write(&self, topography: &Topography, pitch: Option<[Metre; 2]>) -> Outcome {
        let (grid, heights) = (topography.grid(), topography.heights());
        if pitch.is_none() && self.format != Format::Npy {
            let message = format!("`{}` needs a pitch, which the heights have not", self.path.display());
            return Err(without_pitch(message));
        }
        atomic::sweep(self.path.parent().filter(|parent| *parent != Path::new("")).unwrap_or(Path::new(".")));
        match self.format {
            Format::Npy => npy::write(&self.path, heights)?,
            Format::X3p => x3p::write(&self.path, grid, heights)?,
            Format::Sdf => sdf::write(&self.path, grid, heights)?,
            Format::Gwy => gwy::write(&self.path, grid, heights)?,
            Format::Vtk => vtk::write(&self.path, grid, &[("height", heights)])?,
            Format::Png => {
                let title = self.path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                let caption = Caption { title, of: String::new() };
                draw::save(&self.path, &draw::heights(heights, grid), &caption, &Paper::default())?;
            }
        }
        Ok(())
    }
}

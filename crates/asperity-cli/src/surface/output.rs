//! Output file of a topography.

use std::path::{Path, PathBuf};

use asperity::io;
use asperity::surface::{Format, Topography};
use asperity::units::Metre;

use super::without_pitch;
use crate::report::{Failure, Outcome};
use asperity_report::draw::{self, Caption, Paper};

/// An output file, with the format of its name.
pub(super) struct Output {
    path: PathBuf,
    /// None for a picture.
    format: Option<Format>,
}

impl Output {
    /// Returns an error for a name without a known format, and for an existing file unless `overwrite`.
    pub(super) fn new(path: &Path, overwrite: bool) -> Outcome<Self> {
        let format = Format::from_path(path);
        let is_picture = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
        if format.is_none() && !is_picture {
            let hint = "the end of its name gives the format: .npy, .x3p, .sdf, .gwy, .vtk or .png";
            return Err(Failure::usage(format!("no format to write `{}` in", path.display()), Some(hint)));
        }
        if path.exists() && !overwrite {
            let message = format!("`{}` exists", path.display());
            return Err(Failure::usage(message, Some("--overwrite replaces it")));
        }
        Ok(Self { path: path.to_owned(), format })
    }

    /// Writes the heights, or draws them.
    pub(super) fn write(&self, topography: &Topography, pitch: Option<[Metre; 2]>) -> Outcome {
        if pitch.is_none() && self.format.is_none_or(Format::has_pitch) {
            let message = format!("`{}` needs a pitch, which the heights have not", self.path.display());
            return Err(without_pitch(message));
        }
        io::sweep(self.path.parent().filter(|parent| *parent != Path::new("")).unwrap_or(Path::new(".")));
        match self.format {
            Some(_) => topography.write(&self.path)?,
            None => {
                let title = self.path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                let caption = Caption { title, of: String::new() };
                let picture = draw::heights(topography.heights(), topography.grid());
                draw::save(&self.path, &picture, &caption, &Paper::default())?;
            }
        }
        Ok(())
    }
}

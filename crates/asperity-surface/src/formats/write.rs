//! Formats that can be written.

use std::path::Path;

#[cfg(feature = "zip")]
use super::x3p;
use super::{gwy, npy, sdf, vtk};
use crate::Topography;
use asperity_base::error::{Error, Result};

/// A file format for writing topographies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// NumPy's `.npy`: the heights without their pitch.
    Npy,
    /// `.x3p` of ISO 25178-72.
    #[cfg(feature = "zip")]
    X3p,
    /// `.sdf` of ISO 25178-71, in text.
    Sdf,
    /// `.gwy` of Gwyddion.
    Gwy,
    /// Legacy `.vtk`, for ParaView and similar programs; not read.
    Vtk,
}

impl Format {
    /// Returns the format for the extension of the file name, in any case; `None` if there is none.
    pub fn from_path(path: impl AsRef<Path>) -> Option<Self> {
        Some(match path.as_ref().extension()?.to_string_lossy().to_lowercase().as_str() {
            "npy" => Self::Npy,
            #[cfg(feature = "zip")]
            "x3p" => Self::X3p,
            "sdf" => Self::Sdf,
            "gwy" => Self::Gwy,
            "vtk" => Self::Vtk,
            _ => return None,
        })
    }

    /// Whether the format stores the pitch.
    pub fn has_pitch(self) -> bool {
        self != Self::Npy
    }
}

impl Topography {
    /// Writes the heights to the file at `path`, in the [`Format`] given by its extension. The file is
    /// written completely or not at all.
    ///
    /// # Errors
    /// [`Error::NoFormat`] if the extension belongs to no format, [`Error::File`] if the file cannot be
    /// written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        let (grid, heights) = (self.grid(), self.heights());
        match Format::from_path(path).ok_or_else(|| Error::NoFormat { path: path.to_owned() })? {
            Format::Npy => npy::write(path, heights),
            #[cfg(feature = "zip")]
            Format::X3p => x3p::write(path, grid, heights),
            Format::Sdf => sdf::write(path, grid, heights),
            Format::Gwy => gwy::write(path, grid, heights),
            Format::Vtk => vtk::write(path, grid, heights),
        }
    }
}

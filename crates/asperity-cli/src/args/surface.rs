//! The arguments of `asperity surface`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::drawing::RangedDrawing;
use super::generate::Generate;
use super::preparation::PreparationArguments;
use asperity::surface::{Axis, ReadOptions};

use super::values::{choice, lengths, positive_length, unit_of_length};

/// Generate, describe, draw and convert topographies
#[derive(Debug, Subcommand)]
pub(crate) enum Surface {
    Generate(Generate),
    Info(Info),
    Plot(PlotSurface),
    Convert(Convert),
}

/// Print the content of a topography file and its roughness
///
/// Reads x3p, sdf, gwy, npy, text and the files of many instruments, and detects the format from the content.
/// Roughness refers to the heights after the given preparation: --level plane removes a tilt.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  asperity surface info heights.npy --pitch 0.5um --level plane")]
pub(crate) struct Info {
    /// Print JSON, in SI
    #[arg(long)]
    pub(crate) json: bool,
    /// Add ISO 21920-2 parameters of the roughness profiles along x and y, with this cut-off λc
    #[arg(long, value_name = "LENGTH", value_parser = positive_length)]
    pub(crate) cutoff: Option<f64>,
    #[command(flatten)]
    pub(crate) input: Input,
}

/// Draw a topography, its material ratio curve, distributions, spectrum, autocorrelation and hills
///
/// Writes the figures to DIR, and the curves as numbers in SI to DIR/curves.json.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  asperity surface plot disc.sur --level plane --out disc")]
pub(crate) struct PlotSurface {
    /// Folder for the figures, by default the file's name with `-figures`
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Replace the figures that are there
    #[arg(long)]
    pub(crate) overwrite: bool,
    #[command(flatten)]
    pub(crate) drawing: RangedDrawing,
    #[command(flatten)]
    pub(crate) input: Input,
}

/// Read any topography, prepare it, and write it as npy, x3p, sdf, gwy, vtk or png
///
/// The steps are applied in the order of this list. Missing heights stay missing without --fill.
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  asperity surface convert disc.sur disc.x3p --fill harmonic --level plane \
--resample 256x256"
)]
pub(crate) struct Convert {
    /// File to write; its name ends in .npy, .x3p, .sdf, .gwy, .vtk or .png
    #[arg(value_name = "OUT", index = 2)]
    pub(crate) output: PathBuf,
    /// Replace the file if it exists
    #[arg(long)]
    pub(crate) overwrite: bool,
    #[command(flatten)]
    pub(crate) input: Input,
}

/// A topography to read and prepare. Keep it last, because the help would list later arguments among its
/// steps.
#[derive(Debug, Args)]
pub(crate) struct Input {
    /// Topography to read
    #[arg(index = 1)]
    pub(crate) file: PathBuf,
    #[command(flatten)]
    pub(crate) reading: ReadingArguments,
    #[command(flatten)]
    pub(crate) preparing: PreparationArguments,
}

#[derive(Debug, Default, Args)]
pub(crate) struct ReadingArguments {
    /// Height channel; default: the first
    #[arg(long, value_name = "NAME")]
    pub(crate) channel: Option<String>,
    /// Unit of the numbers in a file without units (npy, npz, mat, text, csv, asc, tiff): nm
    #[arg(long, value_name = "UNIT", value_parser = unit_of_length)]
    pub(crate) unit: Option<f64>,
    /// Pitch of a file without one: 0.5um, or 0.5um,1um
    #[arg(long, value_name = "LENGTH[,LENGTH]", value_parser = lengths)]
    pub(crate) pitch: Option<[f64; 2]>,
    /// Direction of a line of a matrix; default: x for text, y for arrays [ix, iy] (npy, npz, mat, HDF5)
    #[arg(long, value_name = "AXIS", value_parser = choice::<Axis>())]
    pub(crate) lines: Option<Axis>,
    /// Lines of a text above its numbers
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub(crate) skip: usize,
}

impl ReadingArguments {
    /// Returns the options for reading the file, without the pitch.
    pub(crate) fn options(&self) -> ReadOptions {
        let mut options = ReadOptions::default();
        options.channel.clone_from(&self.channel);
        (options.unit, options.lines, options.skip) = (self.unit, self.lines, self.skip);
        options
    }
}

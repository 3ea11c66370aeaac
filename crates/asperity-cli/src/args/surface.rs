//! The arguments of `asperity surface`.

use std::path::PathBuf;

use asperity::surface::{Fill, Level};
use clap::{Args, Subcommand};

use super::generate::Generate;
use super::values::{
    Pair, Shape, Window, fill_parser, lengths, level_parser, positive_length, shape, window,
};

/// Make, describe, draw and convert topographies
#[derive(Debug, Subcommand)]
pub(crate) enum Surface {
    Generate(Generate),
    Info(Info),
    Plot(PlotSurface),
    Convert(Convert),
}

/// Print what a topography file holds, and its roughness
///
/// Reads x3p, sdf, gwy, npy, text and the files of many instruments; the content tells the format. Roughness is that
/// of the heights as they are: --level plane removes a tilt first.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  asperity surface info heights.npy --pitch 0.5um --level plane")]
pub(crate) struct Info {
    /// Topography
    pub(crate) file: PathBuf,
    /// Print JSON, in SI
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) reading: Reading,
    /// What is subtracted first
    #[arg(long, default_value = "none", value_parser = level_parser())]
    pub(crate) level: Level,
    /// Cut-off λc of the roughness profiles along x and along y: adds their parameters, ISO 21920-2
    #[arg(long, value_name = "LENGTH", value_parser = positive_length)]
    pub(crate) cutoff: Option<f64>,
}

/// Draw a topography, its material ratio curve, distributions, spectrum, autocorrelation and hills
///
/// The figures (png) go into DIR, the curves as numbers in SI into curves.json beside them.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  asperity surface plot disc.sur --level plane --out disc")]
pub(crate) struct PlotSurface {
    /// Topography
    pub(crate) file: PathBuf,
    /// Folder for the figures
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) reading: Reading,
    /// What is subtracted first
    #[arg(long, default_value = "none", value_parser = level_parser())]
    pub(crate) level: Level,
    /// Replace the figures that are there
    #[arg(long)]
    pub(crate) overwrite: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Reading {
    /// Height channel; by default the first
    #[arg(long, value_name = "NAME")]
    pub(crate) channel: Option<String>,
    /// Distance of the heights where the file has none: 0.5um, or 0.5um,1um
    #[arg(long, value_name = "LENGTH[,LENGTH]", value_parser = lengths)]
    pub(crate) pitch: Option<Pair>,
}

/// Read any topography, prepare it, and write it as npy, x3p, sdf, gwy, vtk or png
///
/// The steps act in this order: --window, --fill, --level, --resample. Missing heights stay missing without --fill.
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  asperity surface convert disc.sur disc.x3p --fill harmonic --level plane \
--resample 256x256"
)]
pub(crate) struct Convert {
    /// Topography to read
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,
    /// File to write; its name ends in .npy, .x3p, .sdf, .gwy, .vtk or .png
    #[arg(value_name = "OUT")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) reading: Reading,
    /// Part to keep, in samples
    #[arg(long, value_name = "X0,Y0,NX,NY", value_parser = window)]
    pub(crate) window: Option<Window>,
    /// Where the heights of missing samples come from
    #[arg(long, default_value = "none", value_parser = fill_parser())]
    pub(crate) fill: Fill,
    /// What is subtracted
    #[arg(long, default_value = "none", value_parser = level_parser())]
    pub(crate) level: Level,
    /// Number of cells to bring it to
    #[arg(long, value_name = "NXxNY", value_parser = shape)]
    pub(crate) resample: Option<Shape>,
    /// Replace the file if it exists
    #[arg(long)]
    pub(crate) overwrite: bool,
}

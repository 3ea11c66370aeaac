//! The arguments of every command.

mod drawing;
mod generate;
mod joint;
mod pair;
mod preparation;
mod study;
mod surface;
pub(crate) mod values;
mod writing;

use std::path::PathBuf;

use asperity::solver::Device;
use clap::Args;
use clap_complete::Shell;

use values::{choice, threads};

pub(crate) use drawing::{Drawing, RangedDrawing};
pub(crate) use generate::Generate;
pub(crate) use joint::Joint;
pub(crate) use pair::{Bodies, Contact, Init, Load, Materials, PairWriting, Slide, load, pair_of_materials};
pub(crate) use study::Study;
pub(crate) use surface::{Convert, Info, Input, PlotSurface, ReadingArguments, Surface};
pub(crate) use writing::{Writing, within};

/// Compute a case: a static contact, or a motion
///
/// Prints progress to stderr and a short table to stdout. Writes everything else to the results directory:
/// summary.json, steps.csv, passes.csv, fields (HDF5), figures and the page report.html. Ctrl-C keeps the
/// finished passes; --resume continues.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  asperity run --example quickstart\n  asperity run surfaces/disc.toml --out disc"
)]
pub(crate) struct Run {
    /// Case file
    #[arg(value_name = "CASE.toml", required_unless_present = "example", conflicts_with = "example")]
    pub(crate) case: Option<PathBuf>,
    /// Run an example; its files are written to DIR/case
    #[arg(long, value_name = "NAME")]
    pub(crate) example: Option<String>,
    /// Results directory; default: case file name with `-results`. For an example: folder for `case` and
    /// `results`; default: its name
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Continue from the last finished pass of existing results
    #[arg(long, conflicts_with = "overwrite")]
    pub(crate) resume: bool,
    /// Replace existing results
    #[arg(long)]
    pub(crate) overwrite: bool,
    /// Number of threads, at most 1024; default: the limit of a scheduler or container, otherwise all cores
    #[arg(long, value_name = "N", value_parser = threads)]
    pub(crate) threads: Option<usize>,
    /// Device that solves the contact, in place of `device` in [contact]: cpu, cuda (a GPU of NVIDIA) or host
    #[arg(long, value_name = "DEVICE", value_parser = choice::<Device>())]
    pub(crate) device: Option<Device>,
    /// Print only warnings and errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// Draw the figures of a results directory again
///
/// Draws all figures, or those of --only, into DIR/figures. Common widths for pages with two columns are 85mm
/// and 170mm.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  asperity plot results --format pdf\n  asperity plot results --only pressure --range 0,2GPa \
--width 85mm --overwrite"
)]
pub(crate) struct Plot {
    /// Results directory
    #[arg(value_name = "DIR")]
    pub(crate) directory: PathBuf,
    /// Name of a figure, such as pressure; may be repeated; required by --range
    #[arg(long, value_name = "NAME")]
    pub(crate) only: Vec<String>,
    /// Replace existing figures
    #[arg(long)]
    pub(crate) overwrite: bool,
    #[command(flatten)]
    pub(crate) drawing: RangedDrawing,
}

/// Write the page of a results directory: maps, curves and tables in one HTML file
///
/// The page opens in any browser without a network. `asperity run` writes it too, also during the run.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  asperity report results --out disc.html")]
pub(crate) struct Report {
    /// Results directory
    #[arg(value_name = "DIR")]
    pub(crate) directory: PathBuf,
    /// File to write; default: DIR/report.html
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
}

/// Reproduce the paper's figures 1, 2, 8, 9, 10 and its claim on cost
///
/// Prints the size of the influence matrix over a pass, and the cost of sub-matrices compared with circular
/// shifting: with dense matrices up to 48 cells per side, by FFT up to --largest. Each size is measured five
/// times, alternately. Takes some minutes.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  asperity paper --format pdf --width 85mm --no-title")]
pub(crate) struct Paper {
    /// Folder for the figures and cost.csv
    #[arg(long, value_name = "DIR", default_value = "paper")]
    pub(crate) out: PathBuf,
    /// Largest number of cells per side for the cost by FFT
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u16).range(16..=2048))]
    pub(crate) largest: u16,
    /// Replace existing files
    #[arg(long)]
    pub(crate) overwrite: bool,
    /// No progress
    #[arg(long)]
    pub(crate) quiet: bool,
    #[command(flatten)]
    pub(crate) drawing: Drawing,
}

/// Validate a case and print what would be solved
///
/// Reads both surfaces and prints the grid, the pair, positions, passes, memory and warnings. Solves nothing.
/// The exit code is 1 if no pressure up to the hardness can carry the load, and 2 if the case has a mistake.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  asperity check case.toml\n  asperity check --schema > case.schema.json")]
pub(crate) struct Check {
    /// Case file
    #[arg(value_name = "CASE.toml", required_unless_present = "schema")]
    pub(crate) case: Option<PathBuf>,
    /// Print the JSON schema of case files, by which an editor completes and checks their keys
    #[arg(long, conflicts_with_all = ["case", "device"])]
    pub(crate) schema: bool,
    /// Device that would solve the contact, in place of `device` in [contact]: cpu, cuda (a GPU of NVIDIA) or
    /// host
    #[arg(long, value_name = "DEVICE", value_parser = choice::<Device>())]
    pub(crate) device: Option<Device>,
}

/// Print the completions of a shell: bash, zsh, fish, elvish or powershell
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  asperity completions bash > ~/.local/share/bash-completion/completions/asperity"
)]
pub(crate) struct Completions {
    /// Shell
    pub(crate) shell: Shell,
}

/// List the examples, or write the files of one
///
/// Without a name it prints one line per example. With a name it writes the case file and data to a new
/// folder.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  asperity example quickstart --out my-case")]
pub(crate) struct Example {
    /// Name of the example
    pub(crate) name: Option<String>,
    /// New folder; default: the name of the example
    #[arg(long, value_name = "DIR", requires = "name")]
    pub(crate) out: Option<PathBuf>,
}

//! The arguments of every command.

mod drawing;
mod generate;
mod preparation;
mod study;
mod surface;
mod values;

use std::path::PathBuf;

use clap::error::Error;
use clap::{Args, Parser, Subcommand};

use crate::report::{Failure, Outcome, written};
use values::threads;

pub(crate) use drawing::{Drawing, RangedDrawing};
pub(crate) use generate::{Generate, Recipe};
pub(crate) use study::Study;
pub(crate) use surface::{Convert, Info, Input, PlotSurface, ReadingArguments, Surface};

/// Contact of two rough surfaces that press together and move
///
/// A case file says which bodies meet, under what load, and how they move.
#[derive(Debug, Parser)]
#[command(name = "asperity", version, subcommand_required = true, arg_required_else_help = true)]
#[command(after_help = BEGIN, after_long_help = [BEGIN, EXIT_CODES].concat())]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

const BEGIN: &str = "\
To begin:
  asperity run --example quickstart
  asperity check quickstart/case/case.toml";

const EXIT_CODES: &str = "

Data go to stdout, all else to stderr.

Exit code:
  0    done; also where the reader of stdout has closed it
  1    the computation failed: not converged, load unreachable, nothing can be written
  2    bad input or usage
  130  interrupted";

/// Prints the help that was asked for, or what is wrong with the arguments.
pub(crate) fn unparsed(error: &Error) -> Outcome {
    if !error.use_stderr() {
        return written(error.print());
    }
    let text = error.render().to_string();
    if text.chars().nth(MAX_CHARACTERS).is_none() {
        error.exit()
    }
    Err(Failure::usage(text.trim_start_matches("error: "), None))
}

/// The longest text about wrong arguments that is shown in full, characters.
const MAX_CHARACTERS: usize = 2000;

#[derive(Debug, Subcommand)]
#[expect(clippy::large_enum_variant, reason = "there is one in a process")]
pub(crate) enum Command {
    Run(Run),
    Study(Study),
    Check(Check),
    Example(Example),
    #[command(subcommand)]
    Surface(Surface),
    Plot(Plot),
    Report(Report),
    /// Compare the solvers with closed forms
    ///
    /// Prints for each case the errors on finer and finer grids and the order of convergence. Exit code 1 if one fails.
    Verify,
    Paper(Paper),
}

/// Compute a case: a static contact, or a motion
///
/// Progress goes to stderr, a short table to stdout, all else into the results directory: summary.json, steps.csv,
/// passes.csv, fields (HDF5), figures and a page to look at, report.html. Ctrl-C leaves the finished passes; --resume goes on from them.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  asperity run --example quickstart\n  asperity run surfaces/disc.toml --out disc"
)]
pub(crate) struct Run {
    /// Case file
    #[arg(value_name = "CASE.toml", required_unless_present = "example", conflicts_with = "example")]
    pub(crate) case: Option<PathBuf>,
    /// An example instead: its files are written to DIR/case
    #[arg(long, value_name = "NAME")]
    pub(crate) example: Option<String>,
    /// Results directory, by default the case file's name with `-results`; of an example the folder of `case` and `results`, by default its name
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Go on from the last finished pass of the results that are there
    #[arg(long, conflicts_with = "overwrite")]
    pub(crate) resume: bool,
    /// Replace the results that are there
    #[arg(long)]
    pub(crate) overwrite: bool,
    /// Threads over the positions of a pass, at most 1024; by default the share of a scheduler or container, else all cores
    #[arg(long, value_name = "N", value_parser = threads)]
    pub(crate) threads: Option<usize>,
    /// No progress and no table, only warnings and errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// Draw the figures of a results directory again
///
/// All of them, or those of --only, into DIR/figures. Widths suit a page of two columns: 85mm and 170mm are common.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  asperity plot results --format pdf\n  asperity plot results --only pressure --range 0,2GPa \
--width 85mm --overwrite"
)]
pub(crate) struct Plot {
    /// Results directory
    #[arg(value_name = "DIR")]
    pub(crate) directory: PathBuf,
    /// Name of a figure, as pressure; may be given several times, and is needed by --range
    #[arg(long, value_name = "NAME")]
    pub(crate) only: Vec<String>,
    /// Replace the figures that are there
    #[arg(long)]
    pub(crate) overwrite: bool,
    #[command(flatten)]
    pub(crate) drawing: RangedDrawing,
}

/// Write the page of a results directory: maps, curves and tables in one HTML file
///
/// It opens in any browser, needs no network and holds all that it shows. `asperity run` writes it too, and while it runs.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  asperity report results --out disc.html")]
pub(crate) struct Report {
    /// Results directory
    #[arg(value_name = "DIR")]
    pub(crate) directory: PathBuf,
    /// Where the page goes; by default DIR/report.html
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
}

/// Reproduce the paper's figures 1, 2, 8, 9, 10 and its claim on cost
///
/// Prints the size of the influence matrix over a pass, and what sub-matrices cost against circular shifting: with dense
/// matrices up to 48 cells along a side, by FFT up to --largest; each size five times, in turns. Takes some minutes.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  asperity paper --format pdf --width 85mm --no-title")]
pub(crate) struct Paper {
    /// Folder for the figures and cost.csv
    #[arg(long, value_name = "DIR", default_value = "paper")]
    pub(crate) out: PathBuf,
    /// Most cells along a side for the cost by FFT
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u16).range(16..=2048))]
    pub(crate) largest: u16,
    /// Replace the files that are there
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
/// Reads both surfaces and reports the grid, the pair, positions, passes, memory and what to be wary of. Nothing is
/// solved. Exit code 1 if no pressure within the hardness can carry the load, 2 if the case has a mistake.
#[derive(Debug, Args)]
pub(crate) struct Check {
    /// Case file
    #[arg(value_name = "CASE.toml")]
    pub(crate) case: PathBuf,
}

/// List the examples, or write one out
///
/// Without a name: one line per example. With a name: its case file and data go into a new folder.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  asperity example quickstart --out my-case")]
pub(crate) struct Example {
    /// Which one
    pub(crate) name: Option<String>,
    /// Folder to make; by default the example's name
    #[arg(long, value_name = "DIR", requires = "name")]
    pub(crate) out: Option<PathBuf>,
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_commands_are_well_formed() {
        Arguments::command().debug_assert();
    }
}

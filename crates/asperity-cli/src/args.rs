//! The arguments of every command.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use asperity::surface::{
    Amplitude, Autocorrelation, Axis, Fill, Form, Generator, Level, LowPass, SelfAffine,
};
use asperity::units::{self, Dimension};
use clap::builder::PossibleValuesParser;
use clap::builder::TypedValueParser;
use clap::{Args, Parser, Subcommand};

/// Contact of two rough surfaces that press together and move
///
/// A case file says which bodies meet, under what load, and how they move.
#[derive(Debug, Parser)]
#[command(version, subcommand_required = true, arg_required_else_help = true)]
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
  0    done
  1    the computation failed: not converged, load unreachable
  2    bad input or usage
  130  interrupted";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Run(Run),
    Check(Check),
    Example(Example),
    #[command(subcommand)]
    Surface(Surface),
    Plot(Plot),
    /// Compare the solvers with closed forms
    ///
    /// Prints for each case the errors on finer and finer grids and the order of convergence. Exit code 1 if one fails.
    Verify,
    Paper(Paper),
}

/// Compute a case: a static contact, or a motion
///
/// Progress goes to stderr, a short table to stdout, all else into the results directory: summary.json, steps.csv,
/// passes.csv, fields (HDF5) and figures. Ctrl-C leaves the finished passes; --resume goes on from them.
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
    /// Threads over the positions of a pass; by default as many as the machine has cores
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,
    /// No progress on stderr
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// Draw the figures of a results directory again
#[derive(Debug, Args)]
pub(crate) struct Plot {
    /// Results directory
    #[arg(value_name = "DIR")]
    pub(crate) directory: PathBuf,
}

/// Reproduce the paper's figures 1, 2, 8, 9, 10 and its claim on cost
///
/// Prints the size of the influence matrix over a pass, and the measured cost of sub-matrices against circular
/// shifting: dense for 12 to 32 cells along a side, by FFT up to --largest.
#[derive(Debug, Args)]
pub(crate) struct Paper {
    /// Folder for the figures
    #[arg(long, value_name = "DIR", default_value = "paper")]
    pub(crate) out: PathBuf,
    /// Most cells along a side for the cost by FFT
    #[arg(long, value_name = "N", default_value_t = 256)]
    pub(crate) largest: usize,
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

/// Make, describe and convert topographies
#[derive(Debug, Subcommand)]
pub(crate) enum Surface {
    Generate(Generate),
    Info(Info),
    Convert(Convert),
}

/// Make a random topography or an ideal form
///
/// Quantities are in SI or carry a unit: 0.5um, "0.5 um", 2e-7.
#[derive(Debug, Args)]
#[command(arg_required_else_help = true)]
#[command(after_help = "Example:\n  asperity surface generate low-pass --shape 256x256 --pitch 0.5um \\
    --sq 0.2um --cutoff 8um --seed 7 --out z.npy")]
pub(crate) struct Generate {
    #[command(subcommand)]
    pub(crate) source: Source,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Source {
    /// Random: white noise without the waves shorter than a cut-off (Hu & Tonder)
    LowPass {
        /// Rms height
        #[arg(long, value_parser = positive_length)]
        sq: f64,
        /// Shortest wavelength, one or along x and y: 8um, or 8um,16um
        #[arg(long, value_name = "LENGTH[,LENGTH]", value_parser = lengths)]
        cutoff: Pair,
        #[command(flatten)]
        seed: Seed,
        #[command(flatten)]
        target: Target,
    },
    /// Random: exponential autocorrelation, not periodic
    Autocorrelation {
        /// Rms height
        #[arg(long, value_parser = positive_length)]
        sq: f64,
        /// Where the autocorrelation falls to 10 %, one length or two along x and y
        #[arg(long, value_name = "LENGTH[,LENGTH]", value_parser = lengths)]
        correlation_length: Pair,
        #[command(flatten)]
        seed: Seed,
        #[command(flatten)]
        target: Target,
    },
    /// Random: power-law spectrum, periodic
    SelfAffine {
        #[command(flatten)]
        amplitude: Roughness,
        /// Hurst exponent H, 0 to 1
        #[arg(long, default_value_t = 0.8)]
        hurst: f64,
        /// Wavelength above which the spectrum is flat; by default none
        #[arg(long, value_name = "LENGTH", value_parser = positive_length)]
        rolloff: Option<f64>,
        /// Shortest wavelength; by default two pitches
        #[arg(long, value_name = "LENGTH", value_parser = positive_length)]
        shortest: Option<f64>,
        #[command(flatten)]
        seed: Seed,
        #[command(flatten)]
        target: Target,
    },
    /// Form: a sphere, its apex in the centre at height 0
    Sphere {
        /// Radius of curvature
        #[arg(long, value_name = "LENGTH", value_parser = positive_length)]
        radius: f64,
        #[command(flatten)]
        target: Target,
    },
    /// Form: a cylinder
    Cylinder {
        /// Radius of curvature
        #[arg(long, value_name = "LENGTH", value_parser = positive_length)]
        radius: f64,
        /// Direction of its axis; x is the direction of motion
        #[arg(long, default_value = "y", value_parser = axis_parser())]
        axis: Axis,
        #[command(flatten)]
        target: Target,
    },
    /// Form: a cone
    Cone {
        /// Slope of its flank against the plane: 5deg, or in radians
        #[arg(long, value_name = "ANGLE", value_parser = angle)]
        angle: f64,
        #[command(flatten)]
        target: Target,
    },
    /// Form: a plane
    Flat {
        #[command(flatten)]
        target: Target,
    },
    /// Form: waves along x and y
    Sinusoid {
        /// From mean to crest
        #[arg(long, value_name = "LENGTH", value_parser = positive_length)]
        amplitude: f64,
        /// Wavelength, one or along x and y; inf for none: 8um, or 8um,inf
        #[arg(long, value_name = "LENGTH[,LENGTH]", value_parser = wavelengths)]
        wavelength: Pair,
        #[command(flatten)]
        target: Target,
    },
}

#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
pub(crate) struct Roughness {
    /// Rms height
    #[arg(long, value_name = "LENGTH", value_parser = positive_length)]
    sq: Option<f64>,
    /// Rms slope
    #[arg(long, value_name = "NUMBER")]
    sdq: Option<f64>,
}

#[derive(Debug, Args)]
pub(crate) struct Seed {
    /// Same seed, same heights
    #[arg(long, value_name = "NUMBER", default_value_t = 0)]
    seed: u64,
}

#[derive(Debug, Args)]
pub(crate) struct Target {
    /// Number of cells along x and y: 256x256
    #[arg(long, value_name = "NXxNY", value_parser = shape)]
    pub(crate) shape: Shape,
    /// Size of a cell, one or along x and y: 0.5um, or 0.5um,1um
    #[arg(long, value_name = "LENGTH[,LENGTH]", value_parser = lengths)]
    pub(crate) pitch: Pair,
    #[command(flatten)]
    pub(crate) out: Out,
}

#[derive(Debug, Args)]
pub(crate) struct Out {
    /// File to write; its name ends in .npy, .x3p, .sdf, .gwy, .vtk or .png
    #[arg(long = "out", value_name = "FILE")]
    pub(crate) path: PathBuf,
    /// Replace the file if it exists
    #[arg(long)]
    pub(crate) overwrite: bool,
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

/// What a [`Source`] makes.
pub(crate) enum Recipe {
    Random(Generator, u64),
    Form(Form),
}

impl Source {
    pub(crate) fn recipe(self) -> (Recipe, Target) {
        match self {
            Self::LowPass { sq, cutoff, seed, target } => {
                (Recipe::Random(Generator::LowPass(LowPass { sq, cutoff: cutoff.0 }), seed.seed), target)
            }
            Self::Autocorrelation { sq, correlation_length, seed, target } => {
                let method = Autocorrelation { sq, correlation_length: correlation_length.0 };
                (Recipe::Random(Generator::Autocorrelation(method), seed.seed), target)
            }
            Self::SelfAffine { amplitude, hurst, rolloff, shortest, seed, target } => {
                let amplitude = amplitude.amplitude();
                let method = SelfAffine { hurst, rolloff, shortest, amplitude };
                (Recipe::Random(Generator::SelfAffine(method), seed.seed), target)
            }
            Self::Sphere { radius, target } => (Recipe::Form(Form::Sphere { radius }), target),
            Self::Cylinder { radius, axis, target } => {
                (Recipe::Form(Form::Cylinder { radius, axis }), target)
            }
            Self::Cone { angle, target } => (Recipe::Form(Form::Cone { angle }), target),
            Self::Flat { target } => (Recipe::Form(Form::Flat), target),
            Self::Sinusoid { amplitude, wavelength, target } => {
                (Recipe::Form(Form::Sinusoid { amplitude, wavelength: wavelength.0 }), target)
            }
        }
    }
}

impl Roughness {
    fn amplitude(&self) -> Amplitude {
        // The parser lets exactly one pass.
        match (self.sq, self.sdq) {
            (Some(sq), _) => Amplitude::Sq(sq),
            (None, sdq) => Amplitude::Sdq(sdq.unwrap_or(f64::NAN)),
        }
    }
}

/// Two lengths, along x and y.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pair(pub(crate) [f64; 2]);

/// Two numbers of cells.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shape(pub(crate) [usize; 2]);

/// x0, y0, nx, ny.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Window(pub(crate) [usize; 4]);

fn quantity(text: &str, dimension: Dimension) -> Result<f64, String> {
    units::parse(text, dimension).map_err(|error| match error.hint() {
        Some(hint) => format!("{error}; {hint}"),
        None => error.to_string(),
    })
}

fn positive_length(text: &str) -> Result<f64, String> {
    match quantity(text, Dimension::Length)? {
        length if length > 0.0 => Ok(length),
        _ => Err("expected a length above 0 such as 0.25um".to_owned()),
    }
}

fn angle(text: &str) -> Result<f64, String> {
    quantity(text, Dimension::Angle)
}

fn pair(text: &str, read: impl Fn(&str) -> Result<f64, String>) -> Result<Pair, String> {
    match text.split(',').collect::<Vec<_>>()[..] {
        [both] => read(both).map(|both| Pair([both; 2])),
        [x, y] => Ok(Pair([read(x)?, read(y)?])),
        _ => Err("expected one length, or two with a comma between".to_owned()),
    }
}

fn lengths(text: &str) -> Result<Pair, String> {
    pair(text, positive_length)
}

fn wavelengths(text: &str) -> Result<Pair, String> {
    pair(text, |text| if text.trim() == "inf" { Ok(f64::INFINITY) } else { positive_length(text) })
}

fn counts<const N: usize>(text: &str, separators: &[char], expected: &str) -> Result<[usize; N], String> {
    let counts: Option<Vec<usize>> = text.split(separators).map(|count| count.trim().parse().ok()).collect();
    counts.and_then(|counts| counts.try_into().ok()).ok_or_else(|| format!("expected {expected}"))
}

fn shape(text: &str) -> Result<Shape, String> {
    const EXPECTED: &str = "two whole numbers of at least 1, such as 256x256, and at most 2²⁸ cells";
    const MOST_CELLS: usize = 1 << 28;
    let shape: [usize; 2] = counts(text, &['x', '×', ','], EXPECTED)?;
    match shape[0].checked_mul(shape[1]) {
        Some(1..=MOST_CELLS) => Ok(Shape(shape)),
        _ => Err(format!("expected {EXPECTED}")),
    }
}

fn window(text: &str) -> Result<Window, String> {
    counts(text, &[','], "four whole numbers x0,y0,nx,ny").map(Window)
}

fn words<T: Clone + Send + Sync + 'static>(
    words: &'static [(&'static str, T)],
) -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(words.iter().map(|(word, _)| *word)).map(|given| {
        let found = words.iter().find(|(word, _)| *word == given);
        found.expect("only these words pass").1.clone()
    })
}

fn level_parser() -> impl TypedValueParser<Value = Level> {
    words(&[
        ("none", Level::None),
        ("mean", Level::Mean),
        ("plane", Level::Plane),
        ("quadratic", Level::Quadratic),
    ])
}

fn fill_parser() -> impl TypedValueParser<Value = Fill> {
    words(&[("none", Fill::None), ("nearest", Fill::Nearest), ("harmonic", Fill::Harmonic)])
}

fn axis_parser() -> impl TypedValueParser<Value = Axis> {
    words(&[("x", Axis::X), ("y", Axis::Y)])
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_commands_are_well_formed() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn lists_of_numbers_are_read_in_full_or_not_at_all() {
        assert_eq!(shape("256x128").unwrap().0, [256, 128]);
        assert_eq!(window("1, 2,3,4").unwrap().0, [1, 2, 3, 4]);
        assert_eq!(wavelengths("8um,inf").unwrap().0, [8e-6, f64::INFINITY]);
        for text in ["256", "0x4", "4x-4", "4x4x4", "99999999x99999999", ""] {
            assert!(shape(text).is_err(), "{text}");
        }
        assert!(lengths("8um,inf").is_err() && lengths("1um,2um,3um").is_err() && lengths("0").is_err());
    }
}

//! The arguments of `asperity surface generate`.

use std::path::PathBuf;

use asperity::surface::{Amplitude, Autocorrelation, Axis, Form, Generator, LowPass, SelfAffine};
use clap::{Args, Subcommand};

use super::values::{Pair, Shape, angle, axis_parser, lengths, positive_length, shape, wavelengths};

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

//! The arguments of `asperity surface generate`.

use std::path::PathBuf;

use asperity::study::case::Layer;
use asperity::surface::{
    Amplitude, Autocorrelation, Axis, Band, Decay, Form, Generator, Groove, HeightDistribution, LowPass,
    SelfAffine,
};
use clap::{Args, Subcommand};

use super::values::{angle, choice, default, factor, lengths, positive_length, shape, wavelengths};

/// Generate a random topography or an ideal form
///
/// Quantities are in SI or carry a unit: 0.5um, "0.5 um", 2e-7.
#[derive(Debug, Args)]
#[command(arg_required_else_help = true)]
#[command(after_help = "Examples:\n  asperity surface generate low-pass --shape 256x256 --pitch 0.5um \\
    --sq 0.2um --cutoff 8um --seed 7 --out z.npy\n
A rough ball: a sphere, and roughness added to it:
  asperity surface generate sphere --shape 256x256 --pitch 0.5um --radius 1mm --out ball.npy
  asperity surface generate low-pass --shape 256x256 --pitch 0.5um \\
    --sq 20nm --cutoff 8um --plus ball.npy --out rough.npy\n
A ground surface, its lay 30 degrees from x, its valleys deeper than its peaks are high:
  asperity surface generate autocorrelation --shape 256x256 --pitch 0.5um --sq 0.2um \\
    --correlation-length 60um,4um --lay 30deg --ssk=-1 --sku 4.5 --out ground.npy")]
pub(crate) struct Generate {
    #[command(subcommand)]
    pub(crate) source: Source,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Source {
    /// Random: low-pass filtered white noise (Hu & Tonder)
    LowPass {
        /// Rms height
        #[arg(long, value_parser = positive_length)]
        sq: f64,
        /// Shortest wavelength, one value or two along x and y: 8um, or 8um,16um
        #[arg(long, value_name = "LENGTH[,LENGTH]", value_parser = lengths)]
        cutoff: [f64; 2],
        /// Shape of the pass band; elliptic is circular with a single cut-off
        #[arg(long, default_value = default::<Band>(), value_parser = choice::<Band>())]
        band: Band,
        #[command(flatten)]
        heights: Heights,
        #[command(flatten)]
        seed: Seed,
        #[command(flatten)]
        target: Target,
    },
    /// Random: prescribed autocorrelation, not periodic; --lay gives a ground surface
    Autocorrelation {
        /// Rms height
        #[arg(long, value_parser = positive_length)]
        sq: f64,
        /// Length over which the autocorrelation decays to 10 %, one value or two (along and across the lay)
        #[arg(long, value_name = "LENGTH[,LENGTH]", value_parser = lengths)]
        correlation_length: [f64; 2],
        /// Decay of the autocorrelation
        #[arg(long, default_value = default::<Decay>(), value_parser = choice::<Decay>())]
        decay: Decay,
        #[command(flatten)]
        lay: Lay,
        #[command(flatten)]
        heights: Heights,
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
    /// Form: a sphere with its apex in the centre at height 0
    Sphere {
        /// Radius of curvature
        #[arg(long, value_name = "LENGTH", value_parser = positive_length)]
        radius: f64,
        #[command(flatten)]
        target: Target,
    },
    /// Form: an ellipsoid with its apex in the centre at height 0
    Ellipsoid {
        /// Principal radii of curvature, in the planes along x and along y: 1mm,2mm
        #[arg(long, value_name = "LENGTH,LENGTH", value_parser = lengths)]
        radius: [f64; 2],
        #[command(flatten)]
        target: Target,
    },
    /// Form: a cylinder
    Cylinder {
        /// Radius of curvature
        #[arg(long, value_name = "LENGTH", value_parser = positive_length)]
        radius: f64,
        /// Direction of its axis; x is the direction of motion
        #[arg(long, default_value = default::<Axis>(), value_parser = choice::<Axis>())]
        axis: Axis,
        #[command(flatten)]
        target: Target,
    },
    /// Form: a cone
    Cone {
        /// Slope angle of the flank from the plane: 5deg, or in radians
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
        /// Amplitude, from mean to crest
        #[arg(long, value_name = "LENGTH", value_parser = positive_length)]
        amplitude: f64,
        /// Wavelength, one value or two along x and y; inf for no wave: 8um, or 8um,inf
        #[arg(long, value_name = "LENGTH[,LENGTH]", value_parser = wavelengths)]
        wavelength: [f64; 2],
        #[command(flatten)]
        target: Target,
    },
    /// Form: parallel grooves, as left by turning
    Grooves {
        /// Distance between ridges; the feed in turning
        #[arg(long, value_name = "LENGTH", value_parser = positive_length)]
        period: f64,
        /// Depth below the ridges; feed²/8r for a tool of nose radius r
        #[arg(long, value_name = "LENGTH", value_parser = positive_length)]
        depth: f64,
        /// Shape of a groove, from a round or a pointed tool
        #[arg(long, default_value = default::<Groove>(), value_parser = choice::<Groove>())]
        profile: Groove,
        #[command(flatten)]
        lay: Lay,
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
    #[arg(long, value_name = "NUMBER", value_parser = factor)]
    sdq: Option<f64>,
}

const GAUSSIAN: HeightDistribution = HeightDistribution::GAUSSIAN;

/// The distribution of heights.
#[derive(Debug, Args)]
pub(crate) struct Heights {
    /// Skewness Ssk
    #[arg(long, value_name = "NUMBER", default_value_t = GAUSSIAN.ssk, requires = "sku")]
    #[arg(allow_negative_numbers = true)]
    ssk: f64,
    /// Kurtosis Sku, from 1.1 (Ssk² + 1) to 50; 3 for Gaussian heights
    #[arg(long, value_name = "NUMBER", default_value_t = GAUSSIAN.sku)]
    sku: f64,
}

#[derive(Debug, Args)]
pub(crate) struct Lay {
    /// Angle of the lay from x towards y: 30deg, or in radians
    #[arg(long, value_name = "ANGLE", default_value = "0", value_parser = angle, allow_hyphen_values = true)]
    lay: f64,
}

#[derive(Debug, Args)]
pub(crate) struct Seed {
    /// Seed of the random numbers; equal seeds give equal heights
    #[arg(long, value_name = "NUMBER", default_value_t = 0)]
    seed: u64,
}

#[derive(Debug, Args)]
pub(crate) struct Target {
    /// Number of cells along x and y: 256x256
    #[arg(long, value_name = "NXxNY", value_parser = shape)]
    pub(crate) shape: [usize; 2],
    /// Size of a cell, one value or two along x and y: 0.5um, or 0.5um,1um
    #[arg(long, value_name = "LENGTH[,LENGTH]", value_parser = lengths)]
    pub(crate) pitch: [f64; 2],
    /// Add the heights of this topography, of the same shape; may be repeated
    #[arg(long, value_name = "FILE")]
    pub(crate) plus: Vec<PathBuf>,
    /// File to write; its name ends in .npy, .x3p, .sdf, .gwy, .vtk or .png
    #[arg(long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    /// Replace the file if it exists
    #[arg(long)]
    pub(crate) overwrite: bool,
}

impl Source {
    /// Returns the heights that it generates, and the grid and the file for them.
    pub(crate) fn layer(self) -> (Layer, Target) {
        let random = |generate, seed: Seed| Layer::Generate { generate, seed: seed.seed };
        let (form, target) = match self {
            Self::LowPass { sq, cutoff, band, heights, seed, target } => {
                let method = LowPass { sq, cutoff, band, heights: heights.distribution() };
                return (random(Generator::LowPass(method), seed), target);
            }
            Self::Autocorrelation { sq, correlation_length, decay, lay, heights, seed, target } => {
                let (Lay { lay }, heights) = (lay, heights.distribution());
                let method = Autocorrelation { sq, correlation_length, decay, lay, heights };
                return (random(Generator::Autocorrelation(method), seed), target);
            }
            Self::SelfAffine { amplitude, hurst, rolloff, shortest, seed, target } => {
                let method = SelfAffine { hurst, rolloff, shortest, amplitude: amplitude.amplitude() };
                return (random(Generator::SelfAffine(method), seed), target);
            }
            Self::Sphere { radius, target } => (Form::Sphere { radius }, target),
            Self::Ellipsoid { radius, target } => (Form::Ellipsoid { radius }, target),
            Self::Cylinder { radius, axis, target } => (Form::Cylinder { radius, axis }, target),
            Self::Cone { angle, target } => (Form::Cone { angle }, target),
            Self::Flat { target } => (Form::Flat, target),
            Self::Sinusoid { amplitude, wavelength, target } => {
                (Form::Sinusoid { amplitude, wavelength }, target)
            }
            Self::Grooves { period, depth, profile, lay: Lay { lay }, target } => {
                (Form::Grooves { period, depth, profile, lay }, target)
            }
        };
        (Layer::Form { form }, target)
    }
}

impl Heights {
    fn distribution(&self) -> HeightDistribution {
        HeightDistribution { ssk: self.ssk, sku: self.sku }
    }
}

impl Roughness {
    fn amplitude(&self) -> Amplitude {
        let amplitude = self.sq.map(Amplitude::Sq).or(self.sdq.map(Amplitude::Sdq));
        amplitude.expect("the parser accepts exactly one")
    }
}

//! Surface topography: files of profilometers and microscopes, roughness parameters of ISO 25178, ISO 21920
//! and ISO 13565, filters, generated surfaces.
//!
//! ```
//! # #[cfg(feature = "zip")] {
//! use asperity_surface::{Level, Parameters, Topography};
//!
//! # let disc = concat!(env!("CARGO_MANIFEST_DIR"), "/../asperity-cli/examples/measured/disc.x3p");
//! let disc = Topography::read(disc)?; // "disc.x3p", or .sur, .opd, .plu, .sdf, …: recognised by its content
//! let disc = disc.level(Level::Plane)?;
//! let height = Parameters::new(&disc).height;
//! println!("Sa {:.1} nm, Sq {:.1} nm", 1e9 * height.sa, 1e9 * height.sq);
//! # assert!(height.sa < height.sq && (1e-9..1e-5).contains(&height.sq));
//! # }
//! # Ok::<(), asperity_surface::Error>(())
//! ```
//!
//! # Conventions
//!
//! Heights are in metres, a matrix indexed `[ix, iy]`, with the material below and z up, as they are
//! measured. Everything else is SI, too. A missing height is NaN. Parameters take the defined heights as they
//! are: level and filter first.
//!
//! | you have | use | you get |
//! |---|---|---|
//! | a file | [`Topography::read`]; [`ReadOptions`] for a channel, a unit or a pitch that the file lacks | a [`Topography`] |
//! | a file to look at first | [`ReadOptions::scan`] | a [`Scan`]: format, channels, heights, pitch |
//! | heights of your own | [`Grid::new`], [`Topography::new`] | a [`Topography`] |
//! | statistics or a shape | [`LowPass`], [`Autocorrelation`], [`SelfAffine`], [`Form`] | a [`Topography`] |
//! | spikes, holes, tilt, form, waviness | [`Preparation`], or its steps one by one | a [`Topography`] |
//! | a topography | [`Parameters`], [`BearingCurve`], [`Segmentation`] | ISO 25178: heights, space, slopes, bearing, hills and dales |
//! | a line of it | [`Profile`], [`ProfileParameters`] | ISO 21920 |
//! | a topography | [`Spectrum`], [`Correlation`], [`SelfAffinity`], [`Summits`] | spectrum, autocorrelation, Hurst exponent, Greenwood and Williamson's summits |
//! | a topography to keep | [`Topography::write`] | x3p, sdf, gwy, npy, vtk |
//!
//! # Features
//!
//! | feature | reads | depends on |
//! |---|---|---|
//! | `formats`, the default | all | |
//! | `files` | what needs nothing more: sur, sdf, gwy, opd, plu, text and twenty others; gzipped, too | flate2 |
//! | `zip` | x3p, npz, VK6, VK7 | zip, roxmltree, md-5 |
//! | `hdf5` | HDF5, NetCDF 4, mat 7.3 | hdf5-pure |
//! | `tiff` | TIFF | tiff |
//! | `compound` | mnt | cfb |
//!
//! A file of a format that is left out is an error that names the feature. Without any of them, all but files
//! remains.
//!
//! # Errors
//!
//! [`Error`] is shared with the crates of contact mechanics above. Functions here return those of its
//! variants that concern input ([`Error::OutOfRange`], [`Error::UndefinedSamples`], …), files
//! ([`Error::NotATopography`], [`Error::CorruptTopography`], [`Error::NoChannel`], [`Error::NoPitch`],
//! [`Error::File`], …) and [`Error::Interrupted`]. [`Error::hint`] says what to do. No file makes a reader
//! panic.
//!
//! # References
//!
//! - ISO 25178-2:2021, parameters of areas; ISO 25178-71 and -72, sdf and x3p.
//! - ISO 21920-2:2021, parameters of profiles; ISO 13565-2, stratified surfaces.
//! - ISO 16610, filters: Gaussian for profiles (-21) and areas (-61), robust for areas (-71).
//!
//! Each formula names its own source.

mod correlation;
mod form;
#[cfg(feature = "files")]
mod formats;
mod fractal;
mod generate;
mod moments;
mod parameters;
mod process;
mod profile;
mod segmentation;
mod spectrum;
mod stop;
mod summits;
mod topography;

pub use asperity_base::{
    CellValues, Choice, Error, Field, Grid, Result, choice, error, grid, ndarray, units,
};

pub use correlation::Correlation;
pub use form::{Axis, Form, Groove};
#[cfg(feature = "files")]
pub use formats::{Format, LengthUnit, ReadOptions, Scan, UNDERSIDE, contents};
pub use fractal::SelfAffinity;
pub use generate::{
    Amplitude, Autocorrelation, Band, Decay, Generator, HeightDistribution, LowPass, SelfAffine,
};
// For surfaces that are generated in parts.
#[doc(hidden)]
pub use generate::{check_cells, white_noise};
pub use moments::SpectralMoments;
pub use parameters::{
    BearingCurve, Classes, Core, Distribution, FeatureParameters, FunctionalParameters, HeightParameters,
    HybridParameters, Parameter, Parameters, Slope, SpatialParameters, Unit,
};
pub use process::{Fill, Filter, Findings, Interpolation, Level, LevelError, Preparation, Resample, Round};
pub use profile::{Profile, ProfileParameters};
pub use segmentation::{Motif, Segmentation, WOLF_PRUNING};
pub use spectrum::{Bins, SpectralPoint, Spectrum, Window};
pub use stop::NEVER;
pub use stop::Stop;
pub(crate) use stop::{check_stop, check_stop_at};
pub use summits::{GreenwoodWilliamson, Summit, Summits};
pub use topography::Topography;

//! Topographies of single bodies: generation, reading, preparation, writing and roughness parameters.
//!
//! A topography has the material's side up, as it is measured. Only [`Topography::underside`] turns one over, to mount it
//! as the upper body.

mod correlation;
mod form;
#[cfg(feature = "formats")]
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
#[cfg(feature = "formats")]
pub use formats::{Format, LengthUnit, ReadOptions, Scan, UNDERSIDE, contents};
pub use fractal::SelfAffinity;
pub use generate::{
    Amplitude, Autocorrelation, Band, Decay, Generator, HeightDistribution, LowPass, SelfAffine, check_cells,
    white_noise,
};
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

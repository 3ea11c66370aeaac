//! Topographies of single bodies: made, measured, prepared and described by their roughness.
//!
//! A topography is given with the material's side up, as it is measured. Only [`Topography::underside`] turns
//! one over, when it is mounted as the upper body.

mod feature;
mod form;
mod generate;
mod parameters;
mod process;
mod segmentation;
mod topography;

pub use feature::FeatureParameters;
pub use form::{Axis, Form};
pub use generate::{Amplitude, Autocorrelation, Generator, LowPass, SelfAffine};
pub use parameters::Parameters;
pub use process::{Fill, Level};
pub use segmentation::{Motif, Segmentation, WOLF_PRUNING};
pub use topography::Topography;

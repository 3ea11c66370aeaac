//! Topographies of single bodies: made, measured, prepared and described by their roughness.
//!
//! A topography is given with the material's side up, as it is measured. Only [`Topography::underside`] turns
//! one over, when it is mounted as the upper body.

mod form;
mod generate;
mod parameters;
mod process;
mod topography;

pub use form::{Axis, Form};
pub use generate::{Amplitude, Autocorrelation, Generator, LowPass, SelfAffine};
pub use parameters::Parameters;
pub use process::{Fill, Filter, Findings, Interpolation, Level, LevelError, Preparation, Resample, Round};
pub use topography::Topography;

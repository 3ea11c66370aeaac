//! Preparation of a measured topography for mounting: windowing, despiking, filling, form removal, rotation,
//! filters, resampling, taper. [`Preparation`] applies all steps in a fixed order.

mod despike;
mod fill;
mod filter;
mod harmonic;
mod level;
mod median;
mod normal_equations;
mod polynomial;
mod preparation;
mod resample;
mod round;
mod spline;
mod taper;
mod turn;
mod window;

pub use fill::Fill;
pub use filter::Filter;
pub use level::{Level, LevelError};
pub use preparation::{Findings, Preparation, Resample};
pub use resample::Interpolation;
pub use round::Round;

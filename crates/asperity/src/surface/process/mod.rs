//! From a measured topography to one that can be mounted: cut, cleared of spikes and holes, freed of its form, turned,
//! filtered, resampled, tapered. [`Preparation`] does it all in one order.

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

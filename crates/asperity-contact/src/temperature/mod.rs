//! Flash temperature: frictional heating of two bodies in contact.
//!
//! A body is a half-space with constant thermal properties. It is heated only through its surface, and has a
//! bulk temperature far away. Each cell in contact is heated uniformly by the frictional flux q, which is
//! divided so that both bodies have the same temperature there:
//!
//! ```text
//! q₁ + q₂ = q,   T_b1 + G₁ q₁ = T_b2 + G₂ q₂        on the cells in contact
//! ```
//!
//! G is the temperature under a unit flux. [`FlashTemperature`] follows the bodies over a pass, each in its
//! own frame. [`SteadyTemperature`] is the steady state of a stationary contact with bodies moving through
//! it.

mod flash;
mod history;
mod material;
mod memory;
mod partition;
mod present;
mod source;
mod steady;
mod table;

pub use flash::FlashTemperature;
pub use material::Thermal;
pub use source::moving_source_temperature;
pub use steady::SteadyTemperature;
pub use table::Temperature;

use crate::units::{Kelvin, Watt};

/// Temperature of the cells in contact, and the heat partition.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FlashStep {
    /// Absolute temperature of each cell in contact, K.
    pub temperature: Vec<Kelvin>,
    /// Heat flow into the lower and into the upper body; their sum is the frictional heat. It is negative if
    /// heat flows from a hot body into a cold one.
    pub heat: [Watt; 2],
    /// Number of iterations of the heat partition.
    pub iterations: usize,
}

impl FlashStep {
    /// Largest temperature of the cells in contact, K; `None` without contact.
    pub fn max_temperature(&self) -> Option<Kelvin> {
        self.temperature.iter().copied().reduce(f64::max)
    }
}

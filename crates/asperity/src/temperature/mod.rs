//! Flash temperature: what friction heats where two bodies touch.
//!
//! A body is a half-space of constant thermal properties that is heated through its surface alone, at a bulk temperature far
//! away. Each cell in contact is heated evenly by the flux q of friction, of which each body takes so much that both have one
//! temperature there:
//!
//! ```text
//! q₁ + q₂ = q,   T_b1 + G₁ q₁ = T_b2 + G₂ q₂        on the cells in contact
//! ```
//!
//! G is the temperature under a unit flux. [`FlashTemperature`] follows the bodies over a pass, each in a frame of its own;
//! [`SteadyTemperature`] is what a contact comes to that stays where it is while the bodies move through it.

mod flash;
mod history;
mod material;
mod memory;
mod partition;
mod present;
mod source;
mod steady;

pub use flash::FlashTemperature;
pub use material::Thermal;
pub use source::moving_source_temperature;
pub use steady::SteadyTemperature;

use crate::units::{Kelvin, Watt};

/// The temperature of the cells in contact, and where their heat goes.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FlashStep {
    /// Absolute temperature of each cell in contact, K.
    pub temperature: Vec<Kelvin>,
    /// Heat that flows into the lower and into the upper body; their sum is that of friction. Below 0 where heat of a warm body
    /// flows into a cold one.
    pub heat: [Watt; 2],
    /// Iterations of the partition.
    pub iterations: usize,
}

impl FlashStep {
    /// The largest temperature of the cells in contact, K; none without contact.
    pub fn max_temperature(&self) -> Option<Kelvin> {
        self.temperature.iter().copied().reduce(f64::max)
    }
}

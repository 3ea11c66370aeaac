//! The table `[temperature]`.

use serde::Serialize;

use crate::error::Result;
use crate::units::{Dimension, Kelvin};
use asperity_base::exists::TEMPERATURE;
use asperity_base::table::{Bounds, Key, Kind, Value, two};
use asperity_derive::Table;

/// Temperatures of the bodies.
#[derive(Table, Debug, Clone, Copy, PartialEq, Serialize)]
#[table("temperature")]
#[non_exhaustive]
pub struct Temperature {
    /// Temperature of the bodies far from the contact; a number without a unit is in kelvin.
    ///
    /// The lower body is first.
    #[key(
        special = both,
        form = "temperature > 0 K, or two: `[lower, upper]`",
        dimension = Temperature,
        example = "\"100 °C\"",
        exists = TEMPERATURE
    )]
    pub bulk: [Kelvin; 2],
    /// Computes the flash temperature at each position of every n-th computed pass, from the first on, for
    /// films and results; in other passes each cell has its mean temperature over the contacts of the last of
    /// these. It requires the thermal constants of both bodies, \[friction\] and a speed. 0: the surfaces
    /// have the temperatures of the bodies.
    #[key(count = 0, absent = "1 with thermal constants, else 0", example = "10")]
    pub every: Option<usize>,
}

impl Temperature {
    /// Returns the temperatures, with the flash temperature at each position if the table leaves it open and
    /// the bodies have thermal constants.
    #[must_use]
    pub fn resolved(self, have_thermal_constants: bool) -> Self {
        Self { every: self.every.or(Some(usize::from(have_thermal_constants))), ..self }
    }

    /// Interval of the computed passes with a computed flash temperature; 0 for none.
    pub fn every(&self) -> usize {
        self.every.unwrap_or(0)
    }
}

fn both(value: &dyn Value, key: &Key) -> Result<[Kelvin; 2]> {
    const EXPECTED: &str =
        "a temperature above 0 K such as \"100 °C\", or two: of the lower and of the upper body";
    let kelvin =
        |value: &dyn Value| value.real(key, &Kind::Quantity(Dimension::Temperature, Bounds::AboveZero));
    if value.is_array() { two(value, EXPECTED, kelvin) } else { kelvin(value).map(|both| [both; 2]) }
}

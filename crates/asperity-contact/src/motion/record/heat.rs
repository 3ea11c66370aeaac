//! Frictional heat: further columns of the positions of a pass, and of increments.

use serde::{Deserialize, Serialize};

use crate::units::{Kelvin, Watt};
use asperity_base::record::columns;

columns! {
    /// Frictional heat at a position, or of the last computed cycle: further columns of `steps.csv` and
    /// `increments.csv`.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    pub struct HeatRecord {
        /// Frictional power; of a cycle its mean.
        pub friction_power: Watt,
        /// Largest absolute temperature of the surfaces.
        pub max_flash_temperature: Kelvin,
    }
}

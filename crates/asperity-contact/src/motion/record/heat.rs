//! Frictional heat: further columns of the positions of a pass.

use serde::{Deserialize, Serialize};

use crate::units::{Kelvin, Watt};
use asperity_base::record::columns;

columns! {
    /// Frictional heat at a position: further columns of `steps.csv`.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    pub struct HeatRecord {
        /// Frictional power.
        pub friction_power: Watt,
        /// Largest absolute temperature of the surfaces.
        pub max_flash_temperature: Kelvin,
    }
}

//! Steady sliding of viscoelastic bodies.

use serde::{Deserialize, Serialize};

use crate::units::{Newton, Watt};
use asperity_base::record::columns;

columns! {
    /// Drag of viscoelastic bodies in steady sliding.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
    pub struct SteadyRecord {
        /// Force with which the bodies resist the motion: what the viscoelastic body dissipates over a
        /// distance.
        pub drag: Newton,
        /// Drag over load: the coefficient of friction of the dissipation.
        pub drag_coefficient: f64,
        /// Power that is dissipated.
        pub drag_power: Watt,
    }
}

//! Time of a loading of viscoelastic bodies.

use serde::{Deserialize, Serialize};

use crate::units::Second;
use asperity_base::record::columns;

columns! {
    /// Time of an increment of viscoelastic bodies.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
    pub struct CreepRecord {
        /// Time since the first load.
        pub time: Second,
    }
}

//! Time and drag of viscoelastic bodies.

use serde::{Deserialize, Serialize};

use crate::units::{Newton, Second};
use asperity_base::record::{columns, number_or_none};

columns! {
    /// Time of an increment of viscoelastic bodies.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
    pub struct CreepRecord {
        /// Time since the first load.
        pub time: Second,
    }
}

columns! {
    /// Drag of viscoelastic bodies at a position of a pass.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    pub struct DragRecord {
        /// Force against the motion since the position before, without friction: the work on the bodies over
        /// the distance. Its mean over the positions is the force of the dissipation; rough bodies also store
        /// work at some positions and give it back at others. It is unknown at the position where the bodies
        /// are first pressed together.
        #[serde(deserialize_with = "number_or_none")]
        pub drag: Newton,
    }
}

columns! {
    /// Drag of viscoelastic bodies in a pass.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    pub struct PassDragRecord {
        /// Mean drag over the way to the positions at which it is known, with what bodies that come apart
        /// give back.
        pub mean_drag: Newton,
        /// Mean drag over the mean load at these positions; unknown without contact.
        #[serde(deserialize_with = "number_or_none")]
        pub drag_coefficient: f64,
    }
}

impl PassDragRecord {
    /// Creates the record of a pass from the drag and the load of its positions, with the cells of the way to
    /// each, and the drag times the cells of the way on which the bodies come apart after them.
    pub(in crate::motion) fn from_positions(
        positions: impl Iterator<Item = (Newton, Newton, f64)>,
        leaving: Newton,
    ) -> Self {
        let (mut way, mut drags, mut loads) = (0.0, leaving, 0.0);
        for (drag, load, cells) in positions.filter(|(drag, ..)| drag.is_finite()) {
            way += cells;
            drags += cells * drag;
            loads += cells * load;
        }
        Self { mean_drag: drags / f64::max(way, 1.0), drag_coefficient: drags / loads }
    }
}

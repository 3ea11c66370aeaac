//! Operators of every size that a motion needs.

use std::sync::Arc;

use crate::grid::Grid;
use crate::operator::{FreeFamily, Operator, PeriodicFft};
use crate::units::{Metre, Pascal};

/// What lies beyond the edges of the contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Boundary {
    /// An unloaded half-space.
    #[default]
    Free,
    /// The contact itself, over and over.
    Periodic,
}

/// Makes operators of one cell size, composite modulus and boundary.
///
/// With a free boundary the coefficients of a smaller contact are the leading block of those of the larger one, so
/// that the operators of all overlaps share their spectra.
pub struct Operators {
    pitch: [Metre; 2],
    modulus: Pascal,
    free: Option<Arc<FreeFamily>>,
}

impl Operators {
    /// For cells of size `pitch`, the composite `modulus` E* and `boundary`.
    pub fn new(pitch: [Metre; 2], modulus: Pascal, boundary: Boundary) -> Self {
        let free = (boundary == Boundary::Free).then(|| FreeFamily::new(pitch, modulus));
        Self { pitch, modulus, free }
    }

    /// The operator on `shape` cells.
    pub fn on(&self, shape: [usize; 2]) -> Box<dyn Operator> {
        match &self.free {
            Some(family) => Box::new(family.operator(shape)),
            None => Box::new(PeriodicFft::new(Grid { shape, pitch: self.pitch }, self.modulus)),
        }
    }
}

//! Operators of every size that a motion needs.

use std::collections::HashMap;
use std::sync::{Arc, Mutex};

use crate::grid::Grid;
use crate::operator::{FreeFamily, Operator, PeriodicKernel};
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

/// Makes operators of one cell size, composite modulus and boundary, which share the spectra of their coefficients.
///
/// With a free boundary the coefficients of a smaller contact are the leading block of those of the larger one, so
/// that the operators of all overlaps need but a few spectra; a periodic contact has its own.
pub struct Operators {
    pitch: [Metre; 2],
    modulus: Pascal,
    shared: Shared,
}

enum Shared {
    Free(Arc<FreeFamily>),
    Periodic(Mutex<HashMap<[usize; 2], Arc<PeriodicKernel>>>),
}

impl Operators {
    /// For cells of size `pitch`, the composite `modulus` E* and `boundary`.
    pub fn new(pitch: [Metre; 2], modulus: Pascal, boundary: Boundary) -> Self {
        let shared = match boundary {
            Boundary::Free => Shared::Free(FreeFamily::new(pitch, modulus)),
            Boundary::Periodic => Shared::Periodic(Mutex::default()),
        };
        Self { pitch, modulus, shared }
    }

    /// The operator on `shape` cells.
    pub fn on(&self, shape: [usize; 2]) -> Box<dyn Operator> {
        match &self.shared {
            Shared::Free(family) => Box::new(family.operator(shape)),
            Shared::Periodic(kernels) => {
                let mut kernels = kernels.lock().expect("no holder panics");
                let grid = Grid { shape, pitch: self.pitch };
                let kernel = kernels.entry(shape).or_insert_with(|| PeriodicKernel::new(grid, self.modulus));
                Box::new(kernel.operator())
            }
        }
    }
}

//! Operators of every size that a motion needs.

use std::collections::HashMap;
use std::sync::{Arc, Mutex};

use crate::grid::Grid;
use crate::material::Compliances;
use crate::math::good_size;
use crate::operator::coupled::CoupledKernel;
use crate::operator::{CoupledOperator, FreeFamily, Operator, PeriodicKernel};
use crate::units::Metre;

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

/// Makes operators of one cell size, pair of materials and boundary, which share the spectra of their coefficients.
///
/// With a free boundary the coefficients of a smaller contact are the leading block of those of the larger one, so
/// that the operators of all overlaps need but a few spectra; a periodic contact has its own.
pub struct Operators {
    pitch: [Metre; 2],
    compliances: Compliances,
    shared: Shared,
    /// By the size of the transforms.
    coupled: Mutex<HashMap<[usize; 2], Arc<CoupledKernel>>>,
}

enum Shared {
    Free(Arc<FreeFamily>),
    Periodic(Mutex<HashMap<[usize; 2], Arc<PeriodicKernel>>>),
}

impl Operators {
    /// For cells of size `pitch`, a pair's `compliances` and `boundary`.
    pub fn new(pitch: [Metre; 2], compliances: Compliances, boundary: Boundary) -> Self {
        let shared = match boundary {
            Boundary::Free => Shared::Free(FreeFamily::new(pitch, compliances.modulus())),
            Boundary::Periodic => Shared::Periodic(Mutex::default()),
        };
        Self { pitch, compliances, shared, coupled: Mutex::default() }
    }

    /// The normal operator on `shape` cells.
    pub fn on(&self, shape: [usize; 2]) -> Box<dyn Operator> {
        match &self.shared {
            Shared::Free(family) => Box::new(family.operator(shape)),
            Shared::Periodic(kernels) => {
                let mut kernels = kernels.lock().expect("no holder panics");
                let kernel = kernels
                    .entry(shape)
                    .or_insert_with(|| PeriodicKernel::new(self.grid(shape), self.compliances.modulus()));
                Box::new(kernel.operator())
            }
        }
    }

    /// The coupled operator on `shape` cells.
    pub fn coupled_on(&self, shape: [usize; 2]) -> Box<dyn CoupledOperator> {
        let mut kernels = self.coupled.lock().expect("no holder panics");
        let kernel = match &self.shared {
            Shared::Free(_) => {
                let padded = shape.map(|n| good_size(2 * n - 1));
                kernels
                    .entry(padded)
                    .or_insert_with(|| CoupledKernel::free(padded, self.pitch, &self.compliances))
            }
            Shared::Periodic(_) => kernels
                .entry(shape)
                .or_insert_with(|| CoupledKernel::periodic(&self.grid(shape), &self.compliances)),
        };
        Box::new(kernel.operator(self.grid(shape), self.compliances, self.on(shape)))
    }

    fn grid(&self, shape: [usize; 2]) -> Grid {
        Grid { shape, pitch: self.pitch }
    }
}

//! Operators of every size that a motion needs.

use std::collections::HashMap;
use std::sync::{Arc, Mutex};

use crate::grid::{Field, Grid};
use crate::kernel::{CoupledResponse, SharedResponse};
use crate::operator::coupled::CoupledKernel;
use crate::operator::{Boundary, CoupledOperator, FreeFamily, Operator, PeriodicKernel};

/// Makes operators of one cell size, pair of bodies and boundary, which share the spectra of their coefficients.
///
/// Along a free axis the coefficients of a smaller contact are the leading block of those of the larger one, so
/// that the operators of all overlaps need but a few spectra; a period has its own.
pub struct Operators {
    largest: Grid,
    response: SharedResponse,
    boundary: Boundary,
    shared: Shared,
    /// Coupled kernels by the size of their transforms.
    coupled: Mutex<HashMap<[usize; 2], Arc<CoupledKernel>>>,
}

enum Shared {
    Free(Arc<FreeFamily>),
    Periodic(Mutex<HashMap<[usize; 2], Arc<PeriodicKernel>>>),
}

impl Operators {
    /// Operators for contacts on the cells of a `largest` grid, bodies of this `response`, such as the
    /// [`crate::material::Compliances`] of two half-spaces, and `boundary`. Where that is periodic along one axis, r₀ is the
    /// length of the grid along the other, and smaller contacts share it.
    ///
    /// # Panics
    /// An operator, if the boundary is periodic along one axis and the response knows no line.
    pub fn new(largest: Grid, response: impl Into<SharedResponse>, boundary: Boundary) -> Self {
        let response = response.into();
        let shared = if boundary.leaves_mean_free() {
            Shared::Periodic(Mutex::default())
        } else {
            Shared::Free(FreeFamily::new(&largest, response.clone(), boundary))
        };
        Self { largest, response, boundary, shared, coupled: Mutex::default() }
    }

    /// The normal operator on `shape` cells.
    pub fn on(&self, shape: [usize; 2]) -> Box<dyn Operator> {
        match &self.shared {
            Shared::Free(family) => Box::new(family.operator(shape)),
            Shared::Periodic(kernels) => {
                let mut kernels = kernels.lock().expect("no holder panics");
                let kernel = kernels
                    .entry(shape)
                    .or_insert_with(|| PeriodicKernel::new(self.grid(shape), self.response.clone()));
                Box::new(kernel.operator())
            }
        }
    }

    /// The coupled operator on `shape` cells.
    ///
    /// # Panics
    /// If the response is known in the normal direction only.
    pub fn coupled_on(&self, shape: [usize; 2]) -> Box<dyn CoupledOperator> {
        let mut kernels = self.coupled.lock().expect("no holder panics");
        let grid = self.grid(shape);
        let padded = self.boundary.padded(shape);
        let response = self.coupled_response();
        let kernel = kernels.entry(padded).or_insert_with(|| match &self.shared {
            Shared::Free(_) => {
                let line = self.boundary.line(&grid, self.boundary.datum(&self.largest));
                CoupledKernel::free(padded, grid.pitch, response, line.as_ref())
            }
            Shared::Periodic(_) => CoupledKernel::periodic(&grid, response),
        });
        Box::new(kernel.operator(grid, response.couples(), self.on(shape)))
    }

    /// Largest displacement under a uniform unit pressure on `shape` cells, m/Pa.
    pub(crate) fn most_under_uniform(&self, shape: [usize; 2]) -> f64 {
        let mut displacement = Field::zeros(shape);
        self.on(shape).apply(&Field::ones(shape), &mut displacement);
        displacement.iter().fold(0.0, |most, u| most.max(*u))
    }

    fn coupled_response(&self) -> &dyn CoupledResponse {
        self.response.coupled().expect("a response to shear")
    }

    fn grid(&self, shape: [usize; 2]) -> Grid {
        Grid { shape, pitch: self.largest.pitch }
    }
}

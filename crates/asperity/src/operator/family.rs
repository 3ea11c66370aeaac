//! Operators of every size that a motion needs.

use std::collections::HashMap;
use std::sync::{Arc, Mutex};

use crate::grid::Grid;
use crate::kernel::{Line, normal_displacement};
use crate::material::Compliances;
use crate::operator::coupled::CoupledKernel;
use crate::operator::{Boundary, CoupledOperator, FreeFamily, Operator, PeriodicKernel};

/// Makes operators of one cell size, pair of materials and boundary, which share the spectra of their coefficients.
///
/// Along a free axis the coefficients of a smaller contact are the leading block of those of the larger one, so
/// that the operators of all overlaps need but a few spectra; a period has its own.
pub struct Operators {
    largest: Grid,
    compliances: Compliances,
    boundary: Boundary,
    shared: Shared,
    /// By the size of the transforms.
    coupled: Mutex<HashMap<[usize; 2], Arc<CoupledKernel>>>,
}

enum Shared {
    Free(Arc<FreeFamily>),
    Periodic(Mutex<HashMap<[usize; 2], Arc<PeriodicKernel>>>),
}

impl Operators {
    /// For contacts on the cells of a `largest` grid, a pair's `compliances` and `boundary`. Where that is periodic along
    /// one axis, r₀ is the length of the grid along the other, and smaller contacts share it.
    pub fn new(largest: Grid, compliances: Compliances, boundary: Boundary) -> Self {
        let shared = if boundary.leaves_mean_free() {
            Shared::Periodic(Mutex::default())
        } else {
            Shared::Free(FreeFamily::new(&largest, compliances.modulus(), boundary))
        };
        Self { largest, compliances, boundary, shared, coupled: Mutex::default() }
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
        let grid = self.grid(shape);
        let padded = self.boundary.padded(shape);
        let kernel = kernels.entry(padded).or_insert_with(|| match &self.shared {
            Shared::Free(_) => {
                CoupledKernel::free(padded, grid.pitch, &self.compliances, self.line(&grid).as_ref())
            }
            Shared::Periodic(_) => CoupledKernel::periodic(&grid, &self.compliances),
        });
        Box::new(kernel.operator(grid, self.compliances, self.on(shape)))
    }

    /// Largest displacement, that in the middle, under a uniform unit pressure on `shape` cells, m/Pa.
    pub(crate) fn most_under_uniform(&self, shape: [usize; 2]) -> f64 {
        let (grid, modulus) = (self.grid(shape), self.compliances.modulus());
        let extent = grid.extent();
        match self.line(&grid) {
            Some(line) => line.normal_displacement(0.0, 0.0, extent, modulus),
            None if self.boundary.leaves_mean_free() => 0.0,
            None => normal_displacement(0.0, 0.0, extent, modulus),
        }
    }

    fn line(&self, grid: &Grid) -> Option<Line> {
        self.boundary.line(grid, self.boundary.datum(&self.largest))
    }

    fn grid(&self, shape: [usize; 2]) -> Grid {
        Grid { shape, pitch: self.largest.pitch }
    }
}

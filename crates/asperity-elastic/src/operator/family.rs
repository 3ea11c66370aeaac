//! Operators of all sizes in a motion.

use std::sync::Arc;

use crate::grid::{Field, Grid};
use crate::kernel::SharedResponse;
use crate::operator::coupled::CoupledKernel;
use crate::operator::shared::Shared;
use crate::operator::{
    Boundary, CoupledOperator, Deferred, Definition, FreeFamily, Operator, PeriodicKernel,
};

/// Creates operators for one cell size, pair of bodies and boundary. They share the spectra of their
/// coefficients.
///
/// Along a free axis the coefficients of a smaller contact are the leading block of those of a larger one, so
/// that the operators of all overlaps need only a few spectra. Each period has its own spectrum.
pub struct Operators {
    largest: Grid,
    response: SharedResponse,
    boundary: Boundary,
    normal: Normal,
    /// Coupled kernels by the size of their transforms.
    coupled: Shared<[usize; 2], CoupledKernel>,
}

enum Normal {
    Free(Arc<FreeFamily>),
    Periodic(Shared<[usize; 2], PeriodicKernel>),
}

impl Operators {
    /// Creates the operators for contacts on the cells of a `largest` grid, for bodies with this `response`,
    /// such as the [`crate::material::Compliances`] of two half-spaces, and this `boundary`. If only one axis
    /// is periodic, r₀ is the length of the grid along the other, also for smaller contacts.
    ///
    /// # Panics
    /// On use of an operator, if the boundary is periodic along one axis and the response has no line.
    pub fn new(largest: Grid, response: impl Into<SharedResponse>, boundary: Boundary) -> Self {
        let response = response.into();
        let normal = if boundary.leaves_mean_free() {
            Normal::Periodic(Shared::default())
        } else {
            Normal::Free(FreeFamily::new(&largest, response.clone(), boundary))
        };
        Self { largest, response, boundary, normal, coupled: Shared::default() }
    }

    /// Returns the normal operator on `shape` cells.
    pub fn on(&self, shape: [usize; 2]) -> Box<dyn Operator> {
        match &self.normal {
            Normal::Free(family) => Box::new(family.operator(shape)),
            Normal::Periodic(kernels) => {
                let make = || PeriodicKernel::new(self.grid(shape), self.response.clone());
                Box::new(kernels.get(shape, make).operator())
            }
        }
    }

    /// Returns the normal operator on `shape` cells, whose transforms and coefficients are computed when they
    /// are needed.
    pub fn deferred_on(&self, shape: [usize; 2]) -> Box<dyn Operator> {
        Box::new(Deferred::new(self.definition(shape)))
    }

    /// Returns the definition of the normal operator on `shape` cells.
    pub fn definition(&self, shape: [usize; 2]) -> Definition {
        let datum = self.boundary.datum(&self.largest);
        Definition { grid: self.grid(shape), boundary: self.boundary, response: self.response.clone(), datum }
    }

    /// Returns the coupled operator on `shape` cells.
    ///
    /// # Panics
    /// If the response is known in the normal direction only.
    pub fn coupled_on(&self, shape: [usize; 2]) -> Box<dyn CoupledOperator> {
        let grid = self.grid(shape);
        let padded = self.boundary.padded(shape);
        let response = self.response.coupled().expect("a response to shear");
        let kernel = self.coupled.get(padded, || match &self.normal {
            Normal::Free(_) => {
                let influence = match self.boundary.line(&grid, self.boundary.datum(&self.largest)) {
                    None => response.coupled_influence(grid.pitch),
                    Some(line) => response
                        .coupled_line_influence(&line, grid.pitch)
                        .expect("a response that knows lines"),
                };
                CoupledKernel::free(padded, grid.pitch, influence.as_ref())
            }
            Normal::Periodic(_) => CoupledKernel::periodic(&grid, response),
        });
        Box::new(kernel.operator(grid, response.couples(), self.on(shape)))
    }

    /// Returns the largest displacement under a uniform unit pressure on `shape` cells, m/Pa.
    pub fn most_under_uniform(&self, shape: [usize; 2]) -> f64 {
        let mut displacement = Field::zeros(shape);
        self.on(shape).apply(&Field::ones(shape), &mut displacement);
        displacement.iter().fold(0.0, |most, u| most.max(*u))
    }

    fn grid(&self, shape: [usize; 2]) -> Grid {
        Grid { shape, pitch: self.largest.pitch }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;
    use std::thread;
    use std::time::Duration;

    use super::*;
    use crate::kernel::{Influence, Response};

    /// Bodies whose coefficients are computed in parallel, by threads that perform other tasks meanwhile.
    #[derive(Debug)]
    struct InParallel;

    impl Response for InParallel {
        fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64 {
            rayon::yield_now();
            if qx == 0.0 && qy == 0.0 { 0.0 } else { 2.0 / qx.hypot(qy) }
        }

        fn influence(&self, _: [f64; 2]) -> Box<dyn Influence> {
            rayon::yield_now();
            Box::new(|x: f64, y: f64| {
                rayon::yield_now();
                1.0 / (1.0 + x.hypot(y))
            })
        }
    }

    #[test]
    fn positions_may_ask_for_an_operator_while_its_coefficients_are_computed() {
        for boundary in [Boundary::FREE, Boundary::PERIODIC] {
            let (done, is_done) = mpsc::channel();
            thread::spawn(move || {
                let operators = Operators::new(Grid::new([4, 4], [1.0; 2]).unwrap(), InParallel, boundary);
                let displacement = || {
                    let mut displacement = Field::zeros([4, 4]);
                    let mut operator = operators.on([4, 4]);
                    operator.apply(&Field::ones([4, 4]), &mut displacement);
                    let mut coarse = Field::zeros([2, 2]);
                    operator.coarse().apply(&Field::ones([2, 2]), &mut coarse);
                    [displacement, coarse]
                };
                let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
                done.send(pool.install(|| rayon::join(displacement, displacement))).expect("somebody waits");
            });
            let (one, other) = is_done.recv_timeout(Duration::from_secs(60)).expect("no deadlock");
            assert_eq!(one, other);
        }
    }
}

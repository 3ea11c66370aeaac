//! Cells with an additional compliance under their own pressure.

use std::ops::DerefMut;

use crate::error::{Result, check};
use crate::grid::{CellValues, Field, Grid, SingleField};
use crate::operator::{Boundary, Operator};
use crate::ranks::Slab;

/// An operator with an additional compliance κ of each cell: `u = C p + κ p`. Examples are bodies whose cells
/// lose height or creep by κ p under pressure, and a layer of springs between bodies.
pub struct Compliant<P> {
    grid: Grid,
    operator: P,
    compliance: CellValues,
    mean: f64,
}

impl<'o, P: DerefMut<Target = dyn Operator + 'o>> Compliant<P> {
    /// Creates cells with this additional `compliance`, m/Pa, ≥ 0, a number or a field, on an `operator`,
    /// borrowed or boxed.
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] for a compliance that is not finite and at least 0.
    ///
    /// # Panics
    /// If a field has another shape than the operator's grid.
    pub fn new(operator: P, compliance: impl Into<CellValues>) -> Result<Self> {
        let compliance = compliance.into();
        let grid = *operator.grid();
        assert!(compliance.fits(grid.shape), "shape of the compliance");
        for value in [compliance.min(), compliance.max()] {
            check(
                "compliance",
                value,
                value >= 0.0 && value.is_finite(),
                "a finite compliance of at least 0",
            )?;
        }
        let mean = compliance.mean(grid.cells());
        Ok(Self { grid, operator, compliance, mean })
    }

    /// Adds κ p to a displacement in single precision.
    fn add_to(&self, pressure: &SingleField, displacement: &mut SingleField) {
        match &self.compliance {
            CellValues::Uniform(compliance) => displacement.scaled_add(*compliance as f32, pressure),
            CellValues::Field(compliance) => {
                let add = |u: &mut f32, p: &f32, compliance: &f64| *u += *compliance as f32 * p;
                ndarray::Zip::from(displacement).and(pressure).and(compliance).for_each(add);
            }
        }
    }
}

impl<'o, P: DerefMut<Target = dyn Operator + 'o> + Send> Operator for Compliant<P> {
    fn grid(&self) -> &Grid {
        &self.grid
    }

    fn slab(&self) -> Slab {
        self.operator.slab()
    }

    fn boundary(&self) -> Boundary {
        self.operator.boundary()
    }

    fn leaves_mean_free(&self) -> bool {
        self.operator.leaves_mean_free() && self.compliance.max() == 0.0
    }

    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64 {
        self.operator.harmonic_displacement(qx, qy) + self.mean
    }

    fn influence(&self, i: usize, j: usize) -> f64 {
        let influence = self.operator.influence(i, j);
        if [i, j] == [0, 0] { influence + self.mean } else { influence }
    }

    fn self_influence(&self) -> CellValues {
        let own = self.operator.self_influence();
        match &self.compliance {
            CellValues::Uniform(compliance) => own.map(|own| own + compliance),
            CellValues::Field(compliance) => {
                let mut cells = compliance.clone();
                cells.iter_mut().enumerate().for_each(|(cell, value)| *value += own.value(cell));
                cells.into()
            }
        }
    }

    fn apply(&mut self, pressure: &Field, displacement: &mut Field) {
        self.operator.apply(pressure, displacement);
        match &self.compliance {
            CellValues::Uniform(compliance) => displacement.scaled_add(*compliance, pressure),
            CellValues::Field(compliance) => {
                let add = |u: &mut f64, p: &f64, compliance: &f64| *u += compliance * p;
                ndarray::Zip::from(displacement).and(pressure).and(compliance).for_each(add);
            }
        }
    }

    fn apply_single(&mut self, pressure: &SingleField, displacement: &mut SingleField) {
        self.operator.apply_single(pressure, displacement);
        self.add_to(pressure, displacement);
    }

    fn has_near_copy(&self) -> bool {
        self.operator.has_near_copy()
    }

    fn apply_near(&mut self, pressure: &SingleField, displacement: &mut SingleField) {
        self.operator.apply_near(pressure, displacement);
        self.add_to(pressure, displacement);
    }

    fn release(&mut self) {
        self.operator.release();
    }

    fn coarse(&self) -> Box<dyn Operator> {
        let (operator, compliance) = (self.operator.coarse(), self.compliance.coarse());
        let grid = *operator.grid();
        let mean = compliance.mean(grid.cells());
        Box::new(Compliant { grid, operator, compliance, mean })
    }
}

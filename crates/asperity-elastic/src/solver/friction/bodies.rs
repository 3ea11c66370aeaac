//! Displacements of two bodies under pressure and shear, with a prescribed coupling.

use crate::grid::Field;
use crate::operator::CoupledOperator;
use crate::solver::friction::Coupling;
use crate::solver::friction::transport::History;

/// Two bodies under pressure and shear, with a prescribed coupling.
pub(super) struct Bodies<'a> {
    pub(super) operator: &'a mut dyn CoupledOperator,
    pub(super) coupling: Coupling,
    /// Number of convolutions for coupling terms and for total displacements.
    pub(super) convolutions: f64,
}

impl Bodies<'_> {
    /// Whether shear displaces the surface normally.
    pub(super) fn shear_displaces_normally(&self) -> bool {
        self.coupling.shear_displaces_normally(self.operator.couples())
    }

    /// Whether pressure displaces the surface tangentially.
    pub(super) fn pressure_displaces_tangentially(&self) -> bool {
        self.coupling.pressure_displaces_tangentially(self.operator.couples())
    }

    /// Computes the normal displacement of the surface under shear alone; none without coupling.
    pub(super) fn normal_displacement(&mut self, shear: &[Field; 2]) -> Option<Field> {
        if !self.shear_displaces_normally() {
            return None;
        }
        let mut displacement = self.operator.grid().zeros();
        self.operator.apply([Some(&shear[0]), Some(&shear[1]), None], [None, None, Some(&mut displacement)]);
        self.convolutions += 1.0;
        Some(displacement)
    }

    /// Computes the slip without shear and without rigid displacement.
    pub(super) fn free_slip(&mut self, pressure: &Field, history: &History) -> [Field; 2] {
        let grid = *self.operator.grid();
        let mut displacement = [grid.zeros(), grid.zeros()];
        if self.pressure_displaces_tangentially() {
            let [x, y] = displacement.each_mut();
            self.operator.apply([None, None, Some(pressure)], [Some(x), Some(y), None]);
            self.convolutions += 1.0;
        }
        history.slip([0.0; 2], &displacement)
    }

    /// Computes the tangential displacement under both tractions.
    pub(super) fn displacement(&mut self, shear: &[Field; 2], pressure: &Field) -> [Field; 2] {
        let grid = *self.operator.grid();
        let mut u = [grid.zeros(), grid.zeros()];
        let pressure = self.pressure_displaces_tangentially().then_some(pressure);
        let [x, y] = u.each_mut();
        self.operator.apply([Some(&shear[0]), Some(&shear[1]), pressure], [Some(x), Some(y), None]);
        self.convolutions += 1.0;
        u
    }
}

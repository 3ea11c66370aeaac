//! The two bodies as they displace each other, coupled as is asked for.

use crate::grid::Field;
use crate::operator::CoupledOperator;
use crate::solver::friction::Coupling;

/// The two bodies, coupled as is asked for.
pub(super) struct Bodies<'a> {
    pub(super) operator: &'a mut dyn CoupledOperator,
    pub(super) coupling: Coupling,
    /// Of coupling terms and whole displacements.
    pub(super) convolutions: f64,
}

impl Bodies<'_> {
    pub(super) fn shear_lifts(&self) -> bool {
        self.coupling.lifts(self.operator.couples())
    }

    fn pressure_slips(&self) -> bool {
        self.coupling.slips(self.operator.couples())
    }

    /// Normal displacement under shear.
    pub(super) fn lift(&mut self, shear: &[Field; 2]) -> Option<Field> {
        if !self.shear_lifts() {
            return None;
        }
        let mut lift = self.operator.grid().zeros();
        self.operator.apply([Some(&shear[0]), Some(&shear[1]), None], [None, None, Some(&mut lift)]);
        self.convolutions += 1.0;
        Some(lift)
    }

    /// The slip that there would be without shear, but for the rigid displacement: −u(0, p) − s₀.
    pub(super) fn free_slip(&mut self, pressure: &Field, before: Option<&[Field; 2]>) -> [Field; 2] {
        let grid = *self.operator.grid();
        let mut slip = [grid.zeros(), grid.zeros()];
        if self.pressure_slips() {
            let [x, y] = slip.each_mut();
            self.operator.apply([None, None, Some(pressure)], [Some(x), Some(y), None]);
            self.convolutions += 1.0;
        }
        for (axis, slip) in slip.iter_mut().enumerate() {
            match before {
                Some(before) => slip.zip_mut_with(&before[axis], |u, s| *u = -*u - s),
                None => slip.mapv_inplace(|u| -u),
            }
        }
        slip
    }

    /// Tangential displacement under both tractions.
    pub(super) fn displacement(&mut self, shear: &[Field; 2], pressure: &Field) -> [Field; 2] {
        let grid = *self.operator.grid();
        let mut u = [grid.zeros(), grid.zeros()];
        let pressure = self.pressure_slips().then_some(pressure);
        let [x, y] = u.each_mut();
        self.operator.apply([Some(&shear[0]), Some(&shear[1]), pressure], [Some(x), Some(y), None]);
        self.convolutions += 1.0;
        u
    }
}

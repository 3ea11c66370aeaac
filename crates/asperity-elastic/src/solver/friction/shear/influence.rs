//! Tangential displacement of cells under their shear, and its approximate inverse.

use crate::grid::{Field, SingleField};
use crate::operator::CoupledOperator;
use crate::solver::SINGLE_PRECISION;
use crate::solver::friction::disc::{Vector, length};
use crate::solver::friction::self_compliance;
use crate::solver::friction::shear::state::State;
use crate::solver::preconditioner::Preconditioner;
use crate::solver::sets::Sets;
use crate::units::Metre;

/// The cells of one grid under shear.
pub(super) struct Influence {
    /// The displacement c of a cell per unit shear on itself.
    pub(super) compliance: f64,
    preconditioner: Preconditioner,
    /// The cells that the preconditioner couples, as free cells.
    sets: Sets,
    /// Input and output of the preconditioner along one axis, in single precision.
    single: [Vec<f32>; 2],
    /// Shear on the grid, input of the convolution.
    loaded: [Field; 2],
    /// Displacement of the grid under that shear.
    displaced: [Field; 2],
    /// Shear on the grid, input of the convolution in single precision.
    loaded_single: [SingleField; 2],
    /// Displacement of the grid under that shear.
    displaced_single: [SingleField; 2],
}

impl Influence {
    pub(super) fn new(operator: &mut dyn CoupledOperator) -> Self {
        let grid = *operator.grid();
        Self {
            compliance: self_compliance(operator),
            preconditioner: Preconditioner::new(operator.normal()),
            sets: Sets::new(grid.shape),
            single: [vec![0.0; grid.cells()], vec![0.0; grid.cells()]],
            loaded: [grid.zeros(), grid.zeros()],
            displaced: [grid.zeros(), grid.zeros()],
            loaded_single: [0, 1].map(|_| SingleField::zeros(grid.shape)),
            displaced_single: [0, 1].map(|_| SingleField::zeros(grid.shape)),
        }
    }

    /// Sets the shear of all cells to zero, because other cells are loaded next.
    pub(super) fn unload(&mut self) {
        self.loaded.iter_mut().for_each(|field| field.fill(0.0));
        self.loaded_single.iter_mut().for_each(|field| field.fill(0.0));
    }

    /// Computes the displacement T q of the grid under a shear on the `cells`, by one convolution.
    pub(super) fn displace(
        &mut self,
        operator: &mut dyn CoupledOperator,
        cells: &[usize],
        shear: &[Vector],
    ) -> &[Field; 2] {
        for (axis, field) in self.loaded.iter_mut().enumerate() {
            let field = field.as_slice_mut().expect("standard layout");
            cells.iter().zip(shear).for_each(|(cell, q)| field[*cell] = q[axis]);
        }
        let ([x, y], [u, v]) = (&self.loaded, &mut self.displaced);
        operator.apply([Some(x), Some(y), None], [Some(u), Some(v), None]);
        &self.displaced
    }

    /// Computes the displacement of the `cells` under a shear on them in single precision, and its largest
    /// error.
    pub(super) fn displace_in_single(
        &mut self,
        operator: &mut dyn CoupledOperator,
        cells: &[usize],
        shear: &[Vector],
    ) -> (Vec<Vector>, Metre) {
        for (axis, field) in self.loaded_single.iter_mut().enumerate() {
            let field = field.as_slice_mut().expect("standard layout");
            cells.iter().zip(shear).for_each(|(cell, q)| field[*cell] = q[axis] as f32);
        }
        operator.apply_shear_single(&self.loaded_single, &mut self.displaced_single);
        let [u, v] = self.displaced_single.each_ref().map(|field| field.as_slice().expect("standard layout"));
        let displaced: Vec<Vector> = cells.iter().map(|cell| [u[*cell], v[*cell]].map(f64::from)).collect();
        let largest = displaced.iter().flatten().fold(0.0f64, |most, u| most.max(u.abs()));
        (displaced, SINGLE_PRECISION * largest)
    }

    /// Adapts the approximate inverse to the cells whose predicted freedoms are coupled.
    pub(super) fn adapt(&mut self, state: &State) {
        let mut is_free = vec![false; self.single[0].len()];
        for (k, (cell, freedom)) in state.cells.iter().zip(&state.freedom).enumerate() {
            is_free[*cell] = !freedom.is_diagonal(self.compliance) && !state.is_unyielding(k);
        }
        self.sets.free_where(|cell| is_free[cell]);
        self.preconditioner.adapt(&self.sets);
    }

    /// Computes a shear that displaces the coupled cells approximately by the given displacement, by the
    /// preconditioner of the normal problem along each axis. The shear is zero for the other cells.
    pub(super) fn invert(&mut self, cells: &[usize], displacement: &[Vector]) -> Vec<Vector> {
        let mut shear = vec![[0.0; 2]; displacement.len()];
        let largest = displacement.iter().map(|u| length(*u)).fold(0.0, f64::max);
        if largest == 0.0 {
            return shear;
        }
        let scale = largest.recip();
        let [given, found] = &mut self.single;
        for axis in 0..2 {
            cells.iter().zip(displacement).for_each(|(cell, u)| given[*cell] = (scale * u[axis]) as f32);
            self.preconditioner.apply(&self.sets, |cell| given[cell], found);
            for (cell, q) in cells.iter().zip(&mut shear) {
                q[axis] = f64::from(found[*cell]) / scale;
            }
        }
        shear
    }
}

/// Returns the vectors of two fields at some cells.
pub(super) fn vectors_at(fields: &[Field; 2], cells: &[usize]) -> Vec<Vector> {
    let [x, y] = fields.each_ref().map(|field| field.as_slice().expect("standard layout"));
    cells.iter().map(|cell| [x[*cell], y[*cell]]).collect()
}

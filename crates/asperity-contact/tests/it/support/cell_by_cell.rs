//! A slow and simple solution of the contact with friction, for comparison with the solver.

use asperity_base::Field;
use asperity_contact::operator::CoupledOperator;
use asperity_contact::solver::{Coupling, Friction};

/// Iterates cell by cell, each for the tractions of all others.
pub(crate) struct CellByCell {
    matrix: Vec<[[f64; 3]; 3]>,
    cells: usize,
}

impl CellByCell {
    pub(crate) fn new(operator: &mut dyn CoupledOperator, coupling: Coupling) -> Self {
        let grid = *operator.grid();
        let cells = grid.cells();
        let mut matrix = vec![[[0.0; 3]; 3]; cells * cells];
        for source in 0..cells {
            for axis in 0..3 {
                let mut unit = grid.zeros();
                unit.as_slice_mut().unwrap()[source] = 1.0;
                let mut u: [Field; 3] = std::array::from_fn(|_| grid.zeros());
                let loaded = std::array::from_fn(|n| (n == axis).then_some(&unit));
                operator.apply(loaded, u.each_mut().map(Some));
                let under_unit = |cell: usize| {
                    let at = u.each_ref().map(|u| u.as_slice().unwrap()[cell]);
                    match (coupling, axis) {
                        (Coupling::Full, _) | (Coupling::Goodman, 2) => at,
                        (Coupling::None, 2) => [0.0, 0.0, at[2]],
                        _ => [at[0], at[1], 0.0],
                    }
                };
                for (cell, at) in matrix.iter_mut().skip(source).step_by(cells).enumerate() {
                    at.iter_mut().zip(under_unit(cell)).for_each(|(row, u)| row[axis] = u);
                }
            }
        }
        Self { matrix, cells }
    }

    /// Pressure and shear at an approach and a rigid displacement; `slip_before` is s₀.
    pub(crate) fn solve(
        &self,
        gap: &Field,
        hardness: f64,
        friction: &Friction,
        approach: f64,
        shift: [f64; 2],
        slip_before: &[[f64; 2]],
    ) -> Vec<[f64; 3]> {
        let gap = gap.as_slice().unwrap();
        let mut traction = vec![[0.0; 3]; self.cells];
        for _ in 0..20_000 {
            let mut change = 0.0f64;
            for cell in 0..self.cells {
                let own = self.matrix[cell * self.cells + cell];
                let u = self.displacement(&traction, cell);
                let old = traction[cell];
                let w = approach - gap[cell] - u[2];
                let p = (old[2] + w / own[2][2]).clamp(0.0, hardness);
                let c = 1.05 * own[0][0].max(own[1][1]);
                let bound = friction.shear_limit(p);
                let mut q = [0, 1].map(|k| old[k] + (shift[k] - slip_before[cell][k] - u[k]) / c);
                let length = q[0].hypot(q[1]);
                if length > bound {
                    q = q.map(|v| v * bound / length);
                }
                traction[cell] = [q[0], q[1], p];
                change = (0..3).map(|k| (traction[cell][k] - old[k]).abs()).fold(change, f64::max);
            }
            if change < 1e-13 {
                return traction;
            }
        }
        panic!("no convergence");
    }

    pub(crate) fn displacement(&self, traction: &[[f64; 3]], cell: usize) -> [f64; 3] {
        let mut u = [0.0; 3];
        for (at, t) in self.matrix[cell * self.cells..][..self.cells].iter().zip(traction) {
            for (u, at) in u.iter_mut().zip(at) {
                *u += at[0] * t[0] + at[1] * t[1] + at[2] * t[2];
            }
        }
        u
    }
}

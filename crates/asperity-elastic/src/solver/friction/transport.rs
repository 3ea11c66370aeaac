//! History of the material of a cell: the reference of its slip.

use crate::grid::Field;
use crate::operator::CoupledOperator;
use crate::solver::friction::FrictionalSolution;
use crate::units::Metre;

/// Reference of the slip Δs of each cell.
#[derive(Clone, Default)]
pub(super) enum History {
    /// The bodies have not touched yet.
    #[default]
    None,
    /// The slip s₀ of the cell before the increment, m.
    Increment([Field; 2]),
    /// Steady rolling: the material comes from the cell ahead, with the displacement of that cell.
    Rolling(Transport),
}

/// Transport of material through a contact that moves by one cell.
#[derive(Clone)]
pub(super) struct Transport {
    /// The cells from which the material arrives.
    pub(super) ahead: ShiftByCell,
    /// Displacement of the upper body by the spin meanwhile, m.
    pub(super) turn: [Field; 2],
    /// Method of computing the steady state.
    pub(super) method: SteadyMethod,
}

/// Method of computing the steady state of rolling bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SteadyMethod {
    /// Newton's iteration.
    Newton,
    /// The proximal point method. It is slower, but converges if Newton's iteration does not.
    ProximalPoint,
}

impl Transport {
    /// Computes the displacement of the material that arrives at each cell, including the spin, from the
    /// displacement u of the surfaces.
    pub(super) fn arriving(&self, displacement: &[Field; 2]) -> [Field; 2] {
        [0, 1].map(|axis| self.ahead.field(&displacement[axis]) + &self.turn[axis])
    }
}

impl History {
    /// Returns the reference of the slip after a contact, with a `drift` of the lower surface relative to the
    /// upper one since then that is no slip.
    pub(super) fn since(before: Option<&FrictionalSolution>, drift: Option<&[Field; 2]>) -> Self {
        let slip = before.map(FrictionalSolution::whole_slip);
        match (slip, drift) {
            (None, None) => Self::None,
            (Some(slip), None) => Self::Increment(slip),
            (None, Some(drift)) => Self::Increment(drift.clone()),
            (Some([x, y]), Some([dx, dy])) => Self::Increment([x + dx, y + dy]),
        }
    }

    /// Computes the slip Δs under a rigid displacement D of surfaces with the displacement u: D − u − s₀; in
    /// rolling, D − u + S u plus the spin.
    pub(super) fn slip(&self, rigid: [Metre; 2], displacement: &[Field; 2]) -> [Field; 2] {
        let [mut x, mut y] = [0, 1].map(|axis| displacement[axis].mapv(|u| rigid[axis] - u));
        match self {
            Self::None => {}
            Self::Increment([before_x, before_y]) => {
                x -= before_x;
                y -= before_y;
            }
            Self::Rolling(transport) => {
                let [arriving_x, arriving_y] = transport.arriving(displacement);
                x += &arriving_x;
                y += &arriving_y;
            }
        }
        [x, y]
    }
}

/// The shift S by a cell along the rolling direction x. The last column keeps its values, or takes those of
/// the first column on a periodic surface.
#[derive(Clone, Copy)]
pub(super) struct ShiftByCell {
    cells: usize,
    columns: usize,
    repeats: bool,
}

impl ShiftByCell {
    pub(super) fn on(operator: &mut dyn CoupledOperator) -> Self {
        let grid = *operator.grid();
        let repeats = operator.normal().boundary().repeats(0);
        Self { cells: grid.cells(), columns: grid.shape[1], repeats }
    }

    /// Returns the flat index of the cell whose material arrives at a `cell`.
    pub(super) fn source(&self, cell: usize) -> usize {
        match (cell + self.columns, self.repeats) {
            (next, _) if next < self.cells => next,
            (next, true) => next - self.cells,
            (_, false) => cell,
        }
    }

    /// Returns the values that arrive at each cell.
    pub(super) fn field(&self, field: &Field) -> Field {
        let values = field.as_slice().expect("standard layout");
        let mut ahead = field.clone();
        ahead.iter_mut().enumerate().for_each(|(cell, value)| *value = values[self.source(cell)]);
        ahead
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_column_stays_or_is_followed_by_the_first() {
        let field = Field::from_shape_fn([3, 2], |(i, j)| (10 * i + j) as f64);
        for (repeats, last) in [(false, [20.0, 21.0]), (true, [0.0, 1.0])] {
            let ahead = ShiftByCell { cells: 6, columns: 2, repeats }.field(&field);
            assert_eq!(ahead.into_raw_vec_and_offset().0, [10.0, 11.0, 20.0, 21.0, last[0], last[1]]);
        }
    }
}

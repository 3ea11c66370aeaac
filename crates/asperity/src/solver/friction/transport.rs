//! What the material of a cell has gone through: what its slip is counted from.

use crate::grid::Field;
use crate::operator::CoupledOperator;
use crate::units::Metre;

/// What the slip Δs of each cell is counted from.
#[derive(Clone, Default)]
pub(crate) enum History {
    /// The bodies have not touched yet.
    #[default]
    None,
    /// The slip s₀ of the cell before the increment, m.
    Increment([Field; 2]),
    /// Steady rolling: the material comes from the cell ahead, as it is there.
    Rolling(Transport),
}

/// How material passes through a contact that moves on by a cell.
#[derive(Clone)]
pub(crate) struct Transport {
    /// The cells whose material comes.
    pub(super) ahead: ShiftByCell,
    /// What the spin turns the upper body by meanwhile, m.
    pub(super) turn: [Field; 2],
    /// The method by which the steady state is found.
    pub(super) method: SteadyMethod,
}

/// A method by which the steady state of rolling bodies is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SteadyMethod {
    /// Newton's iteration.
    Newton,
    /// The proximal point method: slower, but it converges where Newton's iteration does not.
    ProximalPoint,
}

impl Transport {
    /// The displacement of the material that arrives at each cell, after the turn, where the surfaces are displaced by u.
    pub(super) fn arriving(&self, displacement: &[Field; 2]) -> [Field; 2] {
        [0, 1].map(|axis| self.ahead.field(&displacement[axis]) + &self.turn[axis])
    }
}

impl History {
    /// The slip Δs under a rigid displacement D of surfaces that are displaced by u: D − u − s₀, in rolling D − u + S u and the
    /// turn.
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

/// The shift S by a cell along the rolling, x: the last column stays, or is followed by the first where the surface repeats itself.
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

    /// The flat index of the cell whose material comes to a `cell`.
    pub(super) fn of(&self, cell: usize) -> usize {
        match (cell + self.columns, self.repeats) {
            (next, _) if next < self.cells => next,
            (next, true) => next - self.cells,
            (_, false) => cell,
        }
    }

    /// The values that come to each cell.
    pub(super) fn field(&self, field: &Field) -> Field {
        let values = field.as_slice().expect("standard layout");
        let mut ahead = field.clone();
        ahead.iter_mut().enumerate().for_each(|(cell, value)| *value = values[self.of(cell)]);
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

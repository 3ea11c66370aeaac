//! The cells in contact, and the freedoms of their shear in a Newton step.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::solver::friction::disc::{
    Symmetric, Vector, add, dot, length, minus, offset_for_sum, onto_disc, times,
};
use crate::solver::friction::shear::{Answer, Rigid, Task};
use crate::units::{Metre, SquareMetre};

/// Shear below this fraction of its limit is inside its disc, not on the rim.
const INSIDE_RIM: f64 = 1.0 - 1e-12;
/// A slipping cell whose [`Freedom::slip_compliance`] exceeds this multiple of its own compliance hardly
/// turns. Its block of the Newton matrix is treated as diagonal.
const DIAGONAL_DOMINANCE: f64 = 3.0;
/// Complementarity parameter of a cell whose slip does not depend on its shear, relative to the compliance of
/// a cell. It is so small that any slip takes the cell to its limit.
const UNYIELDING_SHARE: f64 = 1e-9;
/// Relative tolerance of the sum of the shear after a projection.
const SUM_ACCURACY: f64 = 1e-12;

/// Freedom of the shear of a cell in a Newton step.
#[derive(Clone, Copy)]
pub(super) enum Freedom {
    /// The shear may change in both directions: the cell sticks.
    Stick,
    /// The shear may change along the rim of its disc: the cell slips.
    Slip {
        /// Unit vector along the rim.
        rim: Vector,
        /// Slip over shear |s|/g > 0, m/Pa: the diagonal term of the Newton matrix due to the condition that
        /// the slip points along the shear.
        slip_compliance: f64,
    },
}

impl Freedom {
    /// Returns the component of a vector along which the shear may change.
    pub(super) fn part(&self, a: Vector) -> Vector {
        match self {
            Self::Stick => a,
            Self::Slip { rim, .. } => times(dot(*rim, a), *rim),
        }
    }

    /// Returns the projector onto these directions.
    fn projector(&self) -> Symmetric {
        match self {
            Self::Stick => Symmetric::identity(1.0),
            Self::Slip { rim, .. } => Symmetric::outer_product(1.0, *rim),
        }
    }

    /// Whether the block of a cell with this `compliance` in the Newton matrix is treated as diagonal.
    pub(super) fn is_diagonal(&self, compliance: f64) -> bool {
        self.slip_compliance() > DIAGONAL_DOMINANCE * compliance
    }

    /// Returns the slip compliance of a slipping cell, and 0 for a sticking cell.
    pub(super) fn slip_compliance(&self) -> f64 {
        match self {
            Self::Stick => 0.0,
            Self::Slip { slip_compliance, .. } => *slip_compliance,
        }
    }
}

/// The shear of the cells in contact, and their displacement.
#[derive(Clone)]
pub(super) struct State {
    /// Flat indices of the cells.
    pub(super) cells: Vec<usize>,
    /// Largest shear g of each cell.
    limit: Vec<f64>,
    /// The slip b without shear and without the rigid-body displacement.
    free_slip: Vec<Vector>,
    /// The sum Σ q under force control.
    pub(super) wanted: Option<Vector>,
    /// Rigid-body displacement D.
    pub(super) rigid: Vector,
    /// The shear q of each cell.
    pub(super) shear: Vec<Vector>,
    /// The displacement T q of the cells under their shear.
    pub(super) response: Vec<Vector>,
    /// Error bound of this displacement due to single precision.
    pub(super) rounding: Metre,
    /// The predicted freedom of each cell.
    pub(super) freedom: Vec<Freedom>,
    /// Whether the slip of each cell is independent of the shear; none if no cell is.
    pub(super) unyielding: Option<Vec<bool>>,
}

impl State {
    pub(super) fn new(task: &Task, start: &[Field; 2], area: SquareMetre) -> Result<Self> {
        let cells: Vec<usize> =
            task.limit.iter().enumerate().filter(|(_, g)| **g > 0.0).map(|(cell, _)| cell).collect();
        let values = |field: &Field| -> Vec<f64> {
            let field = field.as_slice().expect("standard layout");
            cells.iter().map(|cell| field[*cell]).collect()
        };
        let vectors = |fields: &[Field; 2]| -> Vec<Vector> {
            values(&fields[0]).into_iter().zip(values(&fields[1])).map(|(x, y)| [x, y]).collect()
        };
        let limit = values(task.limit);
        let (wanted, rigid) = match task.control {
            Rigid::Displacement(displacement) => (None, displacement),
            Rigid::Force(force) => (Some(force.map(|f| f / area)), [0.0; 2]),
        };
        if let Rigid::Force(force) = task.control {
            let most = area * limit.iter().sum::<f64>();
            if length(force) >= most && force != [0.0; 2] {
                return Err(Error::BeyondFriction { force: length(force), limit: most });
            }
        }
        let shear = vectors(start).into_iter().zip(&limit).map(|(q, g)| onto_disc(q, *g)).collect();
        Ok(Self {
            free_slip: vectors(task.free_slip),
            response: vec![[0.0; 2]; limit.len()],
            rounding: 0.0,
            freedom: vec![Freedom::Stick; limit.len()],
            cells,
            limit,
            wanted,
            rigid,
            shear,
            unyielding: None,
        })
    }

    /// Whether the slip of a cell does not depend on the shear.
    pub(super) fn is_unyielding(&self, k: usize) -> bool {
        self.unyielding.as_ref().is_some_and(|cells| cells[k])
    }

    /// Returns the complementarity parameter of a cell: the compliance of a single cell, or a small value if
    /// its slip does not depend on the shear.
    fn parameter(&self, k: usize, compliance: f64) -> f64 {
        if self.is_unyielding(k) { UNYIELDING_SHARE * compliance } else { compliance }
    }

    /// Iterates over the freedom of each cell, its shear and its limit.
    pub(super) fn cells(&self) -> impl Iterator<Item = (&Freedom, Vector, f64)> {
        self.freedom.iter().zip(&self.shear).zip(&self.limit).map(|((f, q), g)| (f, *q, *g))
    }

    /// Returns the slip s = D + b − T q of a cell.
    pub(super) fn slip(&self, k: usize) -> Vector {
        minus(add(self.rigid, self.free_slip[k]), self.response[k])
    }

    /// Returns the proposed shear q + s/c of a cell, inside or outside its disc.
    fn proposed(&self, k: usize, compliance: f64) -> Vector {
        add(self.shear[k], times(1.0 / self.parameter(k, compliance), self.slip(k)))
    }

    /// Returns the proposed shear of a cell, projected onto its disc.
    pub(super) fn projected(&self, k: usize, compliance: f64) -> Vector {
        onto_disc(self.proposed(k, compliance), self.limit[k])
    }

    /// Under force control, sets the rigid-body displacement D at which the projected shear carries the
    /// force. No cell is unyielding.
    pub(super) fn find_rigid_displacement(&mut self, compliance: f64) {
        let Some(wanted) = self.wanted else { return };
        let start = times(1.0 / compliance, self.rigid);
        self.rigid = [0.0; 2];
        let proposed: Vec<(Vector, f64)> =
            (0..self.cells.len()).map(|k| (self.proposed(k, compliance), self.limit[k])).collect();
        let offset = offset_for_sum(|| proposed.iter().copied(), wanted, start);
        self.rigid = times(compliance, offset);
    }

    /// Returns the complementarity residual max|φ|, φ = c (q − P(q + s/c)), of the cells.
    pub(super) fn residual(&self, compliance: f64) -> Metre {
        let phi = |k| compliance * length(minus(self.shear[k], self.projected(k, compliance)));
        // A NaN is no solution, although a maximum would ignore it.
        (0..self.cells.len()).map(phi).fold(0.0, |m, phi| if phi > m || phi.is_nan() { phi } else { m })
    }

    /// Returns the larger of two relative residuals: max|q − P(q + s/c)| over the largest shear, and the
    /// missing force over the sum of the shears of all cells.
    pub(super) fn relative_residual(&self, compliance: f64) -> f64 {
        let largest =
            |most: f64, k| most.max(length(self.shear[k])).max(length(self.projected(k, compliance)));
        let share = |part: f64, whole: f64| if part == 0.0 { 0.0 } else { part / whole };
        let most = (0..self.cells.len()).fold(0.0, largest);
        let residual = share(self.residual(compliance), compliance * most);
        let Some(wanted) = self.wanted else { return residual };
        let sum = self.shear.iter().fold([0.0; 2], |sum, q| add(sum, *q));
        let size = self.shear.iter().map(|q| length(*q)).fold(length(wanted), |sum, q| sum + q);
        residual.max(share(length(minus(wanted, sum)), size))
    }

    /// Sets the shear of all cells to the proposed shear, projected onto their discs.
    pub(super) fn take_projected(&mut self, compliance: f64) {
        self.shear = (0..self.cells.len()).map(|k| self.projected(k, compliance)).collect();
    }

    /// Returns the largest difference from another shear, relative to the largest shear.
    pub(super) fn relative_change(&self, from: &[Vector]) -> f64 {
        let most = self.shear.iter().map(|q| length(*q)).fold(0.0, f64::max);
        let change =
            self.shear.iter().zip(from).map(|(q, from)| length(minus(*q, *from))).fold(0.0, f64::max);
        if change == 0.0 { 0.0 } else { change / most.max(change) }
    }

    /// Projects the tractions onto their discs, and under force control onto the force. Returns whether any
    /// has changed.
    pub(super) fn project(&mut self) -> bool {
        let mut moved = false;
        for (q, limit) in self.shear.iter_mut().zip(&self.limit) {
            let inside = onto_disc(*q, *limit);
            moved |= inside != *q;
            *q = inside;
        }
        if let Some(wanted) = self.wanted {
            // The cells inside their rims take the difference; the cells on their rims stay there.
            let within: Vec<usize> = (0..self.shear.len())
                .filter(|k| length(self.shear[*k]) < INSIDE_RIM * self.limit[*k])
                .collect();
            let sum = self.shear.iter().fold([0.0; 2], |sum, q| add(sum, *q));
            let missing = minus(wanted, sum);
            let size = self.shear.iter().map(|q| length(*q)).sum::<f64>();
            if length(missing) > SUM_ACCURACY * size {
                let theirs = within.iter().fold(missing, |sum, k| add(sum, self.shear[*k]));
                let cells = || within.iter().map(|k| (self.shear[*k], self.limit[*k]));
                let offset = offset_for_sum(cells, theirs, [0.0; 2]);
                for k in within {
                    self.shear[k] = onto_disc(add(self.shear[k], offset), self.limit[k]);
                }
                moved = true;
            }
        }
        moved
    }

    /// Predicts which cells stick and which slip, from one diagonal Newton step with this compliance.
    pub(super) fn predict_freedoms(&mut self, compliance: f64) {
        for k in 0..self.cells.len() {
            let y = self.proposed(k, compliance);
            let (length, limit) = (length(y), self.limit[k]);
            self.freedom[k] = if length <= limit {
                Freedom::Stick
            } else {
                Freedom::Slip {
                    rim: [-y[1] / length, y[0] / length],
                    slip_compliance: self.parameter(k, compliance) * (length / limit - 1.0),
                }
            };
        }
    }

    /// Returns the step that takes the cells predicted to slip to the rims of their discs, in the direction
    /// of their slip. Under force control all freedoms compensate the change of the force. Returns none if
    /// all cells are already there.
    pub(super) fn direction_to_rims(&self) -> Option<Vec<Vector>> {
        let mut direction: Vec<Vector> = self
            .cells()
            .map(|(freedom, q, limit)| match freedom {
                Freedom::Stick => [0.0; 2],
                Freedom::Slip { rim, .. } => {
                    let outward = [rim[1], -rim[0]];
                    times(limit - dot(outward, q), outward)
                }
            })
            .collect();
        if let Some(wanted) = self.wanted {
            let sum = self.shear.iter().zip(&direction).fold([0.0; 2], |s, (q, d)| add(s, add(*q, *d)));
            let each = self.mobility().solve(minus(wanted, sum));
            direction.iter_mut().zip(&self.freedom).for_each(|(d, f)| *d = add(*d, f.part(each)));
        }
        direction.iter().any(|d| *d != [0.0; 2]).then_some(direction)
    }

    /// Returns the residual of the Newton equations along the freedoms; under force control without its net
    /// force.
    pub(super) fn newton_residual(&self) -> Vec<Vector> {
        let mut left: Vec<Vector> = (0..self.cells.len()).map(|k| self.newton_residual_of(k)).collect();
        self.balance(&mut left);
        left
    }

    /// Returns the residual of the Newton equations of a cell.
    fn newton_residual_of(&self, k: usize) -> Vector {
        let freedom = &self.freedom[k];
        let along_shear = times(freedom.slip_compliance(), self.shear[k]);
        freedom.part(minus(self.slip(k), along_shear))
    }

    /// Under force control, moves the rigid bodies so that the residual of the Newton equations has no net
    /// force.
    pub(super) fn balance_rigid_displacement(&mut self) {
        if self.wanted.is_some() {
            let net = (0..self.cells.len()).fold([0.0; 2], |sum, k| add(sum, self.newton_residual_of(k)));
            self.rigid = minus(self.rigid, self.mobility().solve(net));
        }
    }

    /// Returns the sum of the projectors of all freedoms: the shear sum per unit vector added to all cells.
    pub(super) fn mobility(&self) -> Symmetric {
        self.freedom.iter().fold(Symmetric::default(), |sum, f| sum.and(f.projector()))
    }

    /// Under force control, projects `values` along the freedoms so that they preserve the force.
    pub(super) fn balance(&self, values: &mut [Vector]) {
        if self.wanted.is_some() {
            let sum = values.iter().fold([0.0; 2], |sum, v| add(sum, *v));
            let each = self.mobility().solve(sum);
            values.iter_mut().zip(&self.freedom).for_each(|(v, f)| *v = minus(*v, f.part(each)));
        }
    }

    /// Returns the norm of the violation of the limits by sticking cells, as a displacement.
    pub(super) fn violation(&self, compliance: f64) -> Metre {
        let beyond = self.cells().map(|(freedom, q, limit)| match freedom {
            Freedom::Stick => (length(q) - limit).max(0.0),
            Freedom::Slip { .. } => 0.0,
        });
        compliance * beyond.map(|b| b * b).sum::<f64>().sqrt()
    }

    /// Moves by `step` times a direction, with the displacement `response` and its error bound.
    pub(super) fn advance(&mut self, step: f64, direction: &[Vector], response: &[Vector], error: Metre) {
        self.rounding += step.abs() * error;
        self.shear.iter_mut().zip(direction).for_each(|(q, d)| *q = add(*q, times(step, *d)));
        self.response.iter_mut().zip(response).for_each(|(t, r)| *t = add(*t, times(step, *r)));
    }

    pub(super) fn into_answer(self, shape: ndarray::Ix2, residual: f64) -> Answer {
        let mut shear = [Field::zeros(shape), Field::zeros(shape)];
        for (axis, field) in shear.iter_mut().enumerate() {
            let field = field.as_slice_mut().expect("standard layout");
            self.cells.iter().zip(&self.shear).for_each(|(cell, q)| field[*cell] = q[axis]);
        }
        Answer { shear, rigid: self.rigid, residual }
    }
}

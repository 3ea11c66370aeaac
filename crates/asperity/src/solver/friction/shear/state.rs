//! The cells in contact and how they may move.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::solver::friction::disc::{
    Symmetric, Vector, add, dot, length, minus, offset_for_sum, onto_disc, times,
};
use crate::solver::friction::shear::{Answer, Rigid, Task};
use crate::units::{Metre, SquareMetre};

/// Shear below this share of its limit is not on the rim.
const INSIDE: f64 = 1.0 - 1e-12;

/// How a cell may move.
#[derive(Clone, Copy)]
pub(super) enum Freedom {
    /// In both directions.
    Stick,
    /// Along the rim of its disc.
    Slip {
        /// Direction of the rim.
        rim: Vector,
        /// |s|/g > 0, m/Pa: how strongly the slip holds the direction of the shear.
        hold: f64,
    },
}

impl Freedom {
    /// The part of a vector along which the cell may move.
    pub(super) fn part(&self, a: Vector) -> Vector {
        match self {
            Self::Stick => a,
            Self::Slip { rim, .. } => times(dot(*rim, a), *rim),
        }
    }

    fn projector(&self) -> Symmetric {
        match self {
            Self::Stick => Symmetric::identity(1.0),
            Self::Slip { rim, .. } => Symmetric::square(1.0, *rim),
        }
    }

    pub(super) fn hold(&self) -> f64 {
        match self {
            Self::Stick => 0.0,
            Self::Slip { hold, .. } => *hold,
        }
    }
}

/// The cells in contact, by number.
pub(super) struct State {
    pub(super) cells: Vec<usize>,
    limit: Vec<f64>,
    free_slip: Vec<Vector>,
    /// Σ q under force control.
    pub(super) wanted: Option<Vector>,
    /// Rigid-body displacement D.
    rigid: Vector,
    pub(super) shear: Vec<Vector>,
    /// T q.
    pub(super) response: Vec<Vector>,
    pub(super) freedom: Vec<Freedom>,
}

impl State {
    pub(super) fn new(task: &Task, start: &[Field; 2], cells: Vec<usize>, area: SquareMetre) -> Result<Self> {
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
            freedom: vec![Freedom::Stick; limit.len()],
            cells,
            limit,
            wanted,
            rigid,
            shear,
        })
    }

    pub(super) fn cells(&self) -> impl Iterator<Item = (&Freedom, Vector, f64)> {
        self.freedom.iter().zip(&self.shear).zip(&self.limit).map(|((f, q), g)| (f, *q, *g))
    }

    /// s = D + b − T q.
    pub(super) fn slip(&self, k: usize) -> Vector {
        minus(add(self.rigid, self.free_slip[k]), self.response[k])
    }

    /// q + s/c.
    fn predicted(&self, k: usize, compliance: f64) -> Vector {
        add(self.shear[k], times(1.0 / compliance, self.slip(k)))
    }

    pub(super) fn projected(&self, k: usize, compliance: f64) -> Vector {
        onto_disc(self.predicted(k, compliance), self.limit[k])
    }

    /// Under force control: the D at which the projections bear the force.
    pub(super) fn find_rigid_displacement(&mut self, compliance: f64) {
        let Some(wanted) = self.wanted else { return };
        let start = times(1.0 / compliance, self.rigid);
        self.rigid = [0.0; 2];
        let cells = || (0..self.cells.len()).map(|k| (self.predicted(k, compliance), self.limit[k]));
        let offset = offset_for_sum(cells, wanted, start);
        self.rigid = times(compliance, offset);
    }

    /// max|φ|.
    pub(super) fn residual(&self, compliance: f64) -> Metre {
        let phi = |k| compliance * length(minus(self.shear[k], self.projected(k, compliance)));
        // What is not a number is no answer, though a maximum would pass over it.
        (0..self.cells.len()).map(phi).fold(0.0, |m, phi| if phi > m || phi.is_nan() { phi } else { m })
    }

    /// Brings the tractions into their discs; whether any had to move.
    pub(super) fn project(&mut self) -> bool {
        let mut moved = false;
        for (q, limit) in self.shear.iter_mut().zip(&self.limit) {
            let inside = onto_disc(*q, *limit);
            moved |= inside != *q;
            *q = inside;
        }
        if let Some(wanted) = self.wanted {
            // What the rims have taken away the cells within bear: those on them stay there.
            let within: Vec<usize> =
                (0..self.shear.len()).filter(|k| length(self.shear[*k]) < INSIDE * self.limit[*k]).collect();
            let sum = self.shear.iter().fold([0.0; 2], |sum, q| add(sum, *q));
            let missing = minus(wanted, sum);
            let size = self.shear.iter().map(|q| length(*q)).sum::<f64>();
            if length(missing) > 1e-12 * size {
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

    /// Which cells stick and which slip, as one step of the diagonal tells.
    pub(super) fn divide(&mut self, compliance: f64) {
        for k in 0..self.cells.len() {
            let y = self.predicted(k, compliance);
            let (length, limit) = (length(y), self.limit[k]);
            self.freedom[k] = if length <= limit {
                Freedom::Stick
            } else {
                Freedom::Slip {
                    rim: [-y[1] / length, y[0] / length],
                    hold: compliance * (length / limit - 1.0),
                }
            };
        }
    }

    /// What is left of the equations of the freedoms, but for the rigid displacement under force control.
    pub(super) fn equations(&self) -> Vec<Vector> {
        let mut left: Vec<Vector> = (0..self.cells.len())
            .map(|k| {
                let freedom = &self.freedom[k];
                let held = times(freedom.hold(), self.shear[k]);
                freedom.part(minus(self.slip(k), held))
            })
            .collect();
        self.balance(&mut left);
        left
    }

    /// Σ of the freedoms' projectors.
    pub(super) fn mobility(&self) -> Symmetric {
        self.freedom.iter().fold(Symmetric::default(), |sum, f| sum.and(f.projector()))
    }

    /// Under force control: takes out of `values`, which obey the freedoms, what would change the force.
    pub(super) fn balance(&self, values: &mut [Vector]) {
        if self.wanted.is_some() {
            let sum = values.iter().fold([0.0; 2], |sum, v| add(sum, *v));
            let each = self.mobility().solve(sum);
            values.iter_mut().zip(&self.freedom).for_each(|(v, f)| *v = minus(*v, f.part(each)));
        }
    }

    /// Root of the sum of squares of what sticking cells bear beyond their limit, as a displacement.
    pub(super) fn violation(&self, compliance: f64) -> Metre {
        let beyond = self.cells().map(|(freedom, q, limit)| match freedom {
            Freedom::Stick => (length(q) - limit).max(0.0),
            Freedom::Slip { .. } => 0.0,
        });
        compliance * beyond.map(|b| b * b).sum::<f64>().sqrt()
    }

    pub(super) fn advance(&mut self, step: f64, direction: &[Vector], response: &[Vector]) {
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

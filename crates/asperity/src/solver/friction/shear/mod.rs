//! The tangential problem: shear tractions that hold the surfaces where they stick, under given pressures.

mod state;

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::operator::CoupledOperator;
use crate::solver::friction::disc::{Vector, add, dot, length, minus, times};
use crate::solver::friction::self_compliance;
use crate::solver::preconditioner::Preconditioner;
use crate::solver::sets::Sets;
use crate::solver::watch::go_on;
use crate::solver::{Stats, Watch};
use crate::units::{Metre, SquareMetre};

use state::{Freedom, State};

/// How much softer than a cell alone the contact is taken to be when it is divided: what slips far moves its neighbours
/// too. With 1 nearly all of a smooth contact on a fine grid is at first taken to slip, and the division swings.
const CAUTION: f64 = 8.0;
/// Conjugate gradient steps on one division into stick and slip, at the most.
const MAX_CG_STEPS: usize = 60;
/// They are left when the equations are below so many times the violation of the limits.
const CG_EXIT: f64 = 3.0;
/// They are left when the equations are below so much of what they were.
const REDUCTION: f64 = 2e-2;
/// The equations are met when they are below so much of what is asked of the answer.
const NEARLY: f64 = 0.5;
/// Held so many times as strongly as by its own compliance, a cell hardly turns: it is left to itself.
const FIRM: f64 = 3.0;
/// Steps along the projected gradient at a time.
const DESCENTS: usize = 5;

/// What is asked: |q| ≤ g in each cell, and where it is less the slip s = D + b − T q is zero; where it is not, s points
/// along q. It minimises ½ qᵀTq − qᵀ(D + b) over the discs.
pub(super) struct Task<'a> {
    /// g.
    pub(super) limit: &'a Field,
    /// b: the slip without shear, but for the rigid displacement D.
    pub(super) free_slip: &'a [Field; 2],
    pub(super) control: Rigid,
    /// A displacement: the residual is a share of it.
    pub(super) scale: Metre,
    /// Residual at which the answer is accepted.
    pub(super) tolerance: f64,
}

/// What is prescribed of the rigid bodies.
#[derive(Clone, Copy)]
pub(super) enum Rigid {
    /// D.
    Displacement(Vector),
    /// Σ q ΔA.
    Force(Vector),
}

/// The tractions that are asked for.
pub(super) struct Answer {
    pub(super) shear: [Field; 2],
    /// D.
    pub(super) rigid: Vector,
    /// max|φ| as a share of the scale, φ = c (q − P(q + s/c)) with P the projection onto the discs.
    pub(super) residual: f64,
}

/// Solves tangential problems on one grid, by a semismooth Newton iteration: a division of the contact into cells that
/// stick, and cells that slip and may only turn; then preconditioned conjugate gradients on these freedoms. The tractions
/// are brought into their discs when the next division is made.
pub(super) struct ShearSolver {
    cell_area: SquareMetre,
    /// c, displacement of a cell per unit shear on itself.
    compliance: f64,
    preconditioner: Preconditioner,
    sets: Sets,
    single: [Vec<f32>; 2],
    loaded: [Field; 2],
    response: [Field; 2],
    pub(super) stats: Stats,
}

impl ShearSolver {
    pub(super) fn new(operator: &mut dyn CoupledOperator) -> Self {
        let grid = *operator.grid();
        Self {
            cell_area: grid.cell_area(),
            compliance: self_compliance(operator),
            preconditioner: Preconditioner::new(operator.normal()),
            sets: Sets::new(grid.shape),
            single: [vec![0.0; grid.cells()], vec![0.0; grid.cells()]],
            loaded: [grid.zeros(), grid.zeros()],
            response: [grid.zeros(), grid.zeros()],
            stats: Stats::default(),
        }
    }

    /// Solves from the tractions `start`.
    ///
    /// # Errors
    /// [`Error::BeyondFriction`], [`Error::NotConverged`], [`Error::Interrupted`].
    pub(super) fn solve(
        &mut self,
        operator: &mut dyn CoupledOperator,
        task: &Task,
        start: &[Field; 2],
        max_convolutions: usize,
        watch: &dyn Watch,
    ) -> Result<Answer> {
        let cells: Vec<usize> =
            task.limit.iter().enumerate().filter(|(_, g)| **g > 0.0).map(|(cell, _)| cell).collect();
        let mut state = State::new(task, start, cells, self.cell_area)?;
        self.loaded.iter_mut().for_each(|field| field.fill(0.0));
        state.response = self.respond(operator, &state.cells, &state.shear);
        let (mut best, mut strikes, mut caution, mut sharpen): (f64, usize, f64, f64) =
            (f64::INFINITY, 0, CAUTION, 1.0);
        loop {
            go_on(watch)?;
            state.find_rigid_displacement(self.compliance);
            let mut residual = state.residual(self.compliance) / task.scale;
            if residual < sharpen * task.tolerance {
                if state.project() {
                    state.response = self.respond(operator, &state.cells, &state.shear);
                    state.find_rigid_displacement(self.compliance);
                    residual = state.residual(self.compliance) / task.scale;
                }
                if residual < task.tolerance {
                    return Ok(state.into_answer(task.limit.raw_dim(), residual));
                }
                sharpen *= 0.3;
            }
            if self.stats.convolutions as usize >= max_convolutions {
                let (iterations, tolerance) = (self.stats.iterations, task.tolerance);
                return Err(Error::NotConverged { iterations, residual, tolerance });
            }
            if residual < 0.7 * best {
                (best, strikes, caution) = (residual, 0, (0.5 * caution).max(CAUTION));
            } else {
                (strikes, caution) = (strikes + 1, 2.0 * caution);
            }
            if strikes > 4 {
                self.descend(operator, &mut state);
                (best, strikes, caution) = (2.0 * best, 0, CAUTION);
                self.stats.restarts += 1;
                continue;
            }
            state.divide(caution * self.compliance);
            self.lift(operator, &mut state);
            self.conjugate_gradients(operator, &mut state, NEARLY * sharpen * task.tolerance * task.scale);
        }
    }

    /// T q of the cells.
    fn respond(
        &mut self,
        operator: &mut dyn CoupledOperator,
        cells: &[usize],
        shear: &[Vector],
    ) -> Vec<Vector> {
        for (axis, field) in self.loaded.iter_mut().enumerate() {
            let field = field.as_slice_mut().expect("standard layout");
            cells.iter().zip(shear).for_each(|(cell, q)| field[*cell] = q[axis]);
        }
        let ([x, y], [u, v]) = (&self.loaded, &mut self.response);
        operator.apply([Some(x), Some(y), None], [Some(u), Some(v), None]);
        self.stats.convolutions += 1.0;
        let [u, v] = self.response.each_ref().map(|field| field.as_slice().expect("standard layout"));
        cells.iter().map(|cell| [u[*cell], v[*cell]]).collect()
    }

    /// Brings the cells that slip to the rims of their discs, in the direction of their slip; those that are free bear
    /// what that leaves of the force.
    fn lift(&mut self, operator: &mut dyn CoupledOperator, state: &mut State) {
        let mut lift: Vec<Vector> = state
            .cells()
            .map(|(freedom, q, limit)| match freedom {
                Freedom::Stick => [0.0; 2],
                Freedom::Slip { rim, .. } => {
                    let outward = [rim[1], -rim[0]];
                    times(limit - dot(outward, q), outward)
                }
            })
            .collect();
        if let Some(wanted) = state.wanted {
            let sum = state.shear.iter().zip(&lift).fold([0.0; 2], |s, (q, d)| add(s, add(*q, *d)));
            let each = state.mobility().solve(minus(wanted, sum));
            lift.iter_mut().zip(&state.freedom).for_each(|(d, f)| *d = add(*d, f.part(each)));
        }
        if lift.iter().any(|d| *d != [0.0; 2]) {
            let response = self.respond(operator, &state.cells, &lift);
            state.advance(1.0, &lift, &response);
        }
    }

    /// Preconditioned conjugate gradients on the freedoms of the division, to the largest residual `wanted` or until the
    /// limits are violated more.
    fn conjugate_gradients(&mut self, operator: &mut dyn CoupledOperator, state: &mut State, wanted: f64) {
        let free = state.freedom.iter().map(|f| !self.is_firm(f));
        let mut is_free = vec![false; self.single[0].len()];
        state.cells.iter().zip(free).for_each(|(cell, free)| is_free[*cell] = free);
        self.sets.free_where(is_free.into_iter());
        self.preconditioner.adapt(&self.sets);

        let mut residual = state.equations();
        let mut direction = vec![[0.0; 2]; residual.len()];
        let mut product_before = f64::INFINITY;
        let size = |residual: &[Vector]| residual.iter().map(|r| dot(*r, *r)).sum::<f64>().sqrt();
        let first = size(&residual);
        for _ in 0..MAX_CG_STEPS {
            let left = size(&residual);
            let largest = residual.iter().map(|r| length(*r)).fold(0.0, f64::max);
            if largest < wanted
                || left < REDUCTION * first
                || left < CG_EXIT * state.violation(self.compliance)
            {
                break;
            }
            let z = self.precondition(state, &residual);
            let product: f64 = z.iter().zip(&residual).map(|(z, r)| dot(*z, *r)).sum();
            let conjugate = product / product_before;
            product_before = product;
            direction.iter_mut().zip(&z).for_each(|(d, z)| *d = add(*z, times(conjugate, *d)));
            let response = self.respond(operator, &state.cells, &direction);
            let stiffness = |freedom: &Freedom, d: &Vector, response: &Vector| {
                add(freedom.part(*response), times(freedom.hold(), *d))
            };
            let applied: Vec<Vector> = state
                .freedom
                .iter()
                .zip(&direction)
                .zip(&response)
                .map(|((freedom, d), response)| stiffness(freedom, d, response))
                .collect();
            let curvature: f64 = direction.iter().zip(&applied).map(|(d, a)| dot(*d, *a)).sum();
            if !(curvature > 0.0 && product > 0.0) {
                break;
            }
            let step = product / curvature;
            state.advance(step, &direction, &response);
            residual.iter_mut().zip(&applied).for_each(|(r, a)| *r = minus(*r, times(step, *a)));
            state.balance(&mut residual);
            self.stats.iterations += 1;
        }
    }

    fn precondition(&mut self, state: &State, residual: &[Vector]) -> Vec<Vector> {
        let mut z = vec![[0.0; 2]; residual.len()];
        let [mut r, mut out] = std::mem::take(&mut self.single);
        let scale = residual.iter().map(|r| length(*r)).fold(0.0, f64::max).recip();
        for axis in 0..2 {
            for ((cell, freedom), residual) in state.cells.iter().zip(&state.freedom).zip(residual) {
                r[*cell] = (scale * residual[axis] * self.weight(freedom)) as f32;
            }
            self.preconditioner.apply(&self.sets, &r, &mut out);
            for ((cell, freedom), z) in state.cells.iter().zip(&state.freedom).zip(&mut z) {
                z[axis] = self.weight(freedom) * f64::from(out[*cell]) / scale;
            }
        }
        self.single = [r, out];
        for ((freedom, z), r) in state.freedom.iter().zip(&mut z).zip(residual) {
            *z = match self.is_firm(freedom) {
                false => freedom.part(*z),
                true => times(1.0 / (self.compliance + freedom.hold()), *r),
            };
        }
        state.balance(&mut z);
        z
    }

    /// How much softer than its own compliance a held cell is, as a root.
    fn weight(&self, freedom: &Freedom) -> f64 {
        1.0 / (1.0 + freedom.hold() / self.compliance).sqrt()
    }

    fn is_firm(&self, freedom: &Freedom) -> bool {
        freedom.hold() > FIRM * self.compliance
    }

    /// One step that never fails: from the tractions in their discs, along the projected gradient, to the least energy.
    fn descend(&mut self, operator: &mut dyn CoupledOperator, state: &mut State) {
        if state.project() {
            state.response = self.respond(operator, &state.cells, &state.shear);
        }
        for _ in 0..DESCENTS {
            state.find_rigid_displacement(self.compliance);
            let direction: Vec<Vector> = (0..state.shear.len())
                .map(|k| minus(state.projected(k, self.compliance), state.shear[k]))
                .collect();
            let response = self.respond(operator, &state.cells, &direction);
            let slope: f64 = (0..direction.len()).map(|k| dot(state.slip(k), direction[k])).sum();
            let curvature: f64 = direction.iter().zip(&response).map(|(d, t)| dot(*d, *t)).sum();
            if !(slope > 0.0 && curvature > 0.0) {
                return;
            }
            state.advance((slope / curvature).min(1.0), &direction, &response);
        }
    }
}

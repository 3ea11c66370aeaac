//! The tangential problem: shear tractions that hold sticking surfaces, under given pressures.

mod influence;
mod state;
mod steady;

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::operator::CoupledOperator;
use crate::solver::friction::disc::{Vector, add, dot, length, minus, times};
use crate::solver::friction::transport::History;
use crate::solver::{Stats, Watch};
use crate::units::{Metre, SquareMetre};
use asperity_base::math::active_set::TOLERANCE_REDUCTION;
use asperity_base::watch::check_stop;

use influence::{Influence, vectors_at};
use state::{Freedom, State};
use steady::SteadySolver;

/// Compliance in the prediction of stick and slip, as a multiple of the compliance of a single cell: the
/// smallest complementarity parameter of a primal–dual active set. A cell with a large slip moves its
/// neighbours too. With the value 1, nearly all of a smooth contact on a fine grid is first predicted to
/// slip, and the prediction oscillates.
const COMPLIANCE_FACTOR: f64 = 8.0;
/// With each outer step without progress the factor is multiplied by this.
const COMPLIANCE_GROWTH: f64 = 2.0;
/// With each outer step with progress the factor is multiplied by this, down to [`COMPLIANCE_FACTOR`].
const COMPLIANCE_REDUCTION: f64 = 0.5;
/// An outer step makes progress if its residual is below this fraction of the smallest residual so far.
const PROGRESS: f64 = 0.7;
/// Number of consecutive outer steps without progress before projected gradient steps.
const MAX_STAGNATIONS: usize = 4;
/// After the projected gradient steps the smallest residual is multiplied by this factor, so that the next
/// outer step may increase it a little.
const BEST_AFTER_GRADIENT: f64 = 2.0;
/// The displacement is computed again in double precision if its rounding exceeds this fraction of the
/// residual.
const ROUNDING_SHARE: f64 = 0.01;
/// Largest number of conjugate gradient steps on one prediction of stick and slip.
const MAX_CG_STEPS: usize = 60;
/// Conjugate gradients stop when their residual is below this multiple of the violation of the limits.
const CG_EXIT: f64 = 3.0;
/// Conjugate gradients stop when their residual is below this fraction of the first one.
const CG_REDUCTION: f64 = 2e-2;
/// Conjugate gradients stop when their largest residual is below this fraction of the target residual.
const CG_TOLERANCE: f64 = 0.5;
/// Number of consecutive projected gradient steps.
const GRADIENT_STEPS: usize = 5;

/// The tangential problem: |q| ≤ g in each cell. If |q| < g, the slip s = D + b − T q is zero; otherwise s
/// points along q. The solution minimises ½ qᵀTq − qᵀ(D + b) over the discs.
#[derive(Clone, Copy)]
pub(super) struct Task<'a> {
    /// Largest shear g of each cell, Pa.
    pub(super) limit: &'a Field,
    /// The slip b without shear and without the rigid-body displacement D, m.
    pub(super) free_slip: &'a [Field; 2],
    /// Prescribed displacement or force of the rigid bodies.
    pub(super) control: Rigid,
    /// Scale of the residual, a displacement.
    pub(super) scale: Metre,
    /// Residual at which the solution is accepted.
    pub(super) tolerance: f64,
}

/// Prescribed displacement or force of the rigid bodies in the plane.
#[derive(Clone, Copy)]
pub(super) enum Rigid {
    /// The rigid-body displacement D.
    Displacement(Vector),
    /// The tangential force ΔA Σ q.
    Force(Vector),
}

/// The solution of a tangential problem.
pub(super) struct Answer {
    /// The shear tractions q, Pa.
    pub(super) shear: [Field; 2],
    /// The rigid-body displacement D.
    pub(super) rigid: Vector,
    /// max|φ| over the scale, φ = c (q − P(q + s/c)) with P the projection onto the discs.
    pub(super) residual: f64,
}

/// Solves tangential problems of one kind on one grid.
pub(super) trait Method {
    /// Solves from the tractions `start`.
    ///
    /// # Errors
    /// [`Error::BeyondFriction`], [`Error::NotConverged`], [`Error::Interrupted`].
    fn solve(
        &mut self,
        operator: &mut dyn CoupledOperator,
        task: &Task,
        start: &[Field; 2],
        max_convolutions: usize,
        watch: &dyn Watch,
    ) -> Result<Answer>;

    /// Returns the total cost.
    fn stats(&self) -> &Stats;
}

/// Creates the method for contacts with this `history`.
pub(super) fn method(history: &History, operator: &mut dyn CoupledOperator) -> Box<dyn Method> {
    match history {
        History::None | History::Increment(_) => Box::new(ShearSolver::new(operator)),
        History::Rolling(transport) => {
            Box::new(SteadySolver::new(operator, transport.ahead, transport.method))
        }
    }
}

/// Solves tangential problems on one grid by a semismooth Newton iteration. It predicts the cells that stick,
/// and the cells that slip, whose shear may only turn. Preconditioned conjugate gradients then solve for
/// these freedoms. The projection of the tractions onto their discs is deferred to the next prediction.
///
/// Directions and their responses are in single precision, and their sums in double precision. The residual
/// includes the possible error of single precision.
struct ShearSolver {
    cell_area: SquareMetre,
    influence: Influence,
    stats: Stats,
}

impl ShearSolver {
    fn new(operator: &mut dyn CoupledOperator) -> Self {
        Self {
            cell_area: operator.grid().cell_area(),
            influence: Influence::new(operator),
            stats: Stats::default(),
        }
    }
}

impl Method for ShearSolver {
    fn solve(
        &mut self,
        operator: &mut dyn CoupledOperator,
        task: &Task,
        start: &[Field; 2],
        max_convolutions: usize,
        watch: &dyn Watch,
    ) -> Result<Answer> {
        let mut state = State::new(task, start, self.cell_area)?;
        self.influence.unload();
        if state.shear.iter().any(|q| *q != [0.0; 2]) {
            self.respond(operator, &mut state);
        }
        let (mut best, mut stagnations, mut factor, mut tightening): (f64, usize, f64, f64) =
            (f64::INFINITY, 0, COMPLIANCE_FACTOR, 1.0);
        loop {
            check_stop(watch)?;
            state.find_rigid_displacement(self.influence.compliance);
            let mut residual = state.residual(self.influence.compliance) / task.scale;
            let feasible = residual < tightening * task.tolerance;
            let moved = feasible && state.project();
            if moved || state.rounding > ROUNDING_SHARE * residual * task.scale {
                self.respond(operator, &mut state);
                state.find_rigid_displacement(self.influence.compliance);
                residual = state.residual(self.influence.compliance) / task.scale;
            }
            if feasible {
                residual += state.rounding / task.scale;
                if residual < task.tolerance {
                    return Ok(state.into_answer(task.limit.raw_dim(), residual));
                }
                tightening *= TOLERANCE_REDUCTION;
            }
            if self.stats.convolutions as usize >= max_convolutions {
                let (iterations, tolerance) = (self.stats.iterations, task.tolerance);
                return Err(Error::NotConverged { iterations, residual, tolerance });
            }
            if residual < PROGRESS * best {
                (best, stagnations) = (residual, 0);
                factor = (COMPLIANCE_REDUCTION * factor).max(COMPLIANCE_FACTOR);
            } else {
                (stagnations, factor) = (stagnations + 1, COMPLIANCE_GROWTH * factor);
            }
            if stagnations > MAX_STAGNATIONS {
                self.projected_gradient(operator, &mut state);
                (best, stagnations, factor) = (BEST_AFTER_GRADIENT * best, 0, COMPLIANCE_FACTOR);
                self.stats.restarts += 1;
                continue;
            }
            state.predict_freedoms(factor * self.influence.compliance);
            self.step_to_rims(operator, &mut state);
            self.conjugate_gradients(
                operator,
                &mut state,
                CG_TOLERANCE * tightening * task.tolerance * task.scale,
            );
        }
    }

    fn stats(&self) -> &Stats {
        &self.stats
    }
}

impl ShearSolver {
    /// Computes the displacement of the cells under their total shear, in double precision.
    fn respond(&mut self, operator: &mut dyn CoupledOperator, state: &mut State) {
        self.stats.convolutions += 1.0;
        state.response =
            vectors_at(self.influence.displace(operator, &state.cells, &state.shear), &state.cells);
        state.rounding = 0.0;
    }

    /// Computes the displacement of the cells under a `direction` of their shear, in single precision, and
    /// its largest error.
    fn convolve(
        &mut self,
        operator: &mut dyn CoupledOperator,
        cells: &[usize],
        direction: &[Vector],
    ) -> (Vec<Vector>, Metre) {
        self.stats.convolutions += 1.0;
        self.influence.displace_in_single(operator, cells, direction)
    }

    /// Moves the cells predicted to slip to the rims of their discs.
    fn step_to_rims(&mut self, operator: &mut dyn CoupledOperator, state: &mut State) {
        if let Some(direction) = state.direction_to_rims() {
            let (response, error) = self.convolve(operator, &state.cells, &direction);
            state.advance(1.0, &direction, &response, error);
        }
    }

    /// Performs preconditioned conjugate gradients on the predicted freedoms, until the largest residual is
    /// `wanted` or the violation of the limits is larger.
    fn conjugate_gradients(&mut self, operator: &mut dyn CoupledOperator, state: &mut State, wanted: f64) {
        self.influence.adapt(state);

        let mut residual = state.newton_residual();
        let mut direction = vec![[0.0; 2]; residual.len()];
        let mut product_before = f64::INFINITY;
        let norm = |residual: &[Vector]| residual.iter().map(|r| dot(*r, *r)).sum::<f64>().sqrt();
        let first = norm(&residual);
        for _ in 0..MAX_CG_STEPS {
            let left = norm(&residual);
            let largest = residual.iter().map(|r| length(*r)).fold(0.0, f64::max);
            if largest < wanted
                || left < CG_REDUCTION * first
                || left < CG_EXIT * state.violation(self.influence.compliance)
            {
                break;
            }
            let z = self.precondition(state, &residual);
            let product: f64 = z.iter().zip(&residual).map(|(z, r)| dot(*z, *r)).sum();
            let beta = product / product_before;
            product_before = product;
            direction.iter_mut().zip(&z).for_each(|(d, z)| *d = add(*z, times(beta, *d)));
            let (response, error) = self.convolve(operator, &state.cells, &direction);
            let newton_matrix = |freedom: &Freedom, d: &Vector, response: &Vector| {
                add(freedom.part(*response), times(freedom.slip_compliance(), *d))
            };
            let applied: Vec<Vector> = state
                .freedom
                .iter()
                .zip(&direction)
                .zip(&response)
                .map(|((freedom, d), response)| newton_matrix(freedom, d, response))
                .collect();
            let curvature: f64 = direction.iter().zip(&applied).map(|(d, a)| dot(*d, *a)).sum();
            if !(curvature > 0.0 && product > 0.0) {
                break;
            }
            let step = product / curvature;
            state.advance(step, &direction, &response, error);
            residual.iter_mut().zip(&applied).for_each(|(r, a)| *r = minus(*r, times(step, *a)));
            state.balance(&mut residual);
            self.stats.iterations += 1;
        }
    }

    /// Computes the preconditioned residual by the inverse of the influence. Slipping cells are scaled on
    /// both sides by the square root of their own compliance over the compliance including slip. If the slip
    /// compliance dominates, the diagonal is used.
    fn precondition(&mut self, state: &State, residual: &[Vector]) -> Vec<Vector> {
        let compliance = self.influence.compliance;
        let weight = |freedom: &Freedom| 1.0 / (1.0 + freedom.slip_compliance() / compliance).sqrt();
        let weighted: Vec<Vector> =
            state.freedom.iter().zip(residual).map(|(freedom, r)| times(weight(freedom), *r)).collect();
        let mut z = self.influence.invert(&state.cells, &weighted);
        for ((freedom, z), r) in state.freedom.iter().zip(&mut z).zip(residual) {
            *z = if freedom.is_diagonal(compliance) {
                times(1.0 / (compliance + freedom.slip_compliance()), *r)
            } else {
                freedom.part(times(weight(freedom), *z))
            };
        }
        state.balance(&mut z);
        z
    }

    /// Performs projected gradient steps with an exact line search, from the tractions in their discs. Each
    /// step lowers the energy.
    fn projected_gradient(&mut self, operator: &mut dyn CoupledOperator, state: &mut State) {
        if state.project() {
            self.respond(operator, state);
        }
        for _ in 0..GRADIENT_STEPS {
            state.find_rigid_displacement(self.influence.compliance);
            let direction: Vec<Vector> = (0..state.shear.len())
                .map(|k| minus(state.projected(k, self.influence.compliance), state.shear[k]))
                .collect();
            let (response, error) = self.convolve(operator, &state.cells, &direction);
            let slope: f64 = (0..direction.len()).map(|k| dot(state.slip(k), direction[k])).sum();
            let curvature: f64 = direction.iter().zip(&response).map(|(d, t)| dot(*d, *t)).sum();
            if !(slope > 0.0 && curvature > 0.0) {
                return;
            }
            state.advance((slope / curvature).min(1.0), &direction, &response, error);
        }
    }
}

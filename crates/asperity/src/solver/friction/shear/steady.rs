//! The tangential problem of steady rolling: shear tractions under which the material that passes through the contact sticks or
//! slips.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::math::gmres;
use crate::operator::CoupledOperator;
use crate::solver::friction::disc::{Vector, add, combination, minus, times};
use crate::solver::friction::shear::influence::{Influence, at};
use crate::solver::friction::shear::state::State;
use crate::solver::friction::shear::{Answer, Method, PROGRESS, Task};
use crate::solver::friction::transport::Ahead;
use crate::solver::watch::go_on;
use crate::solver::{Stats, TOLERANCE_REDUCTION, Watch};
use crate::units::SquareMetre;

/// Newton steps without progress, one after another, of which one more ends the iteration. The first ones may lose: where all sticks at
/// first, the shear is large at the trailing edge.
const MAX_STAGNATIONS: usize = 8;
/// The Newton equations are solved to this share of their residual,
const REDUCTION: f64 = 0.1;
/// less where the last step has reduced the residual much, down to this,
const MIN_REDUCTION: f64 = 1e-6;
/// and no further than to this share of what is asked of the answer.
const RESIDUAL_SHARE: f64 = 0.3;
/// Products in one Newton step, at the most.
const MAX_PRODUCTS: usize = 60;

/// Solves tangential problems of steady rolling on one grid. As the contact moves on by a cell, the material of the next cell arrives
/// with the displacement that it has there, S T q, and slips by
///
/// ```text
/// Δs = D + b − (1 − S) T q
/// ```
///
/// which is zero where |q| is less than g, and points along q where it is not. The matrix (1 − S) T is not symmetric, but its
/// symmetric part is positive: a variational inequality with one answer. The iteration is that of [`ShearSolver`], a prediction of
/// stick and slip after each of which Newton's equations are solved, here by minimal residuals.
///
/// The preconditioner follows the material: without other cells a Newton step Δq displaces by u = c Δq, and (u − S u) + κ Δq = r along
/// a line from the leading edge; with that u the shear is that of the [`Influence`]'s approximate inverse.
pub(super) struct SteadySolver {
    cell_area: SquareMetre,
    influence: Influence,
    ahead: Ahead,
    stats: Stats,
}

impl SteadySolver {
    pub(super) fn new(operator: &mut dyn CoupledOperator, ahead: Ahead) -> Self {
        Self {
            cell_area: operator.grid().cell_area(),
            influence: Influence::new(operator),
            ahead,
            stats: Stats::default(),
        }
    }
}

impl Method for SteadySolver {
    /// The residual is max|q − P(q + Δs/c)| as a share of the largest shear.
    fn solve(
        &mut self,
        operator: &mut dyn CoupledOperator,
        task: &Task,
        start: &[Field; 2],
        max_convolutions: usize,
        watch: &dyn Watch,
    ) -> Result<Answer> {
        let compliance = self.influence.compliance;
        let mut state = State::new(task, start, self.cell_area)?;
        self.influence.unload();
        let coming = self.cells_ahead(&state);
        self.respond(operator, &mut state);
        state.find_rigid_displacement(compliance);
        let (mut best, mut last, mut stagnations, mut tightening) = (f64::INFINITY, f64::INFINITY, 0, 1.0);
        loop {
            go_on(watch)?;
            let mut residual = state.relative_residual(compliance);
            if residual < tightening * task.tolerance {
                if state.project() {
                    self.respond(operator, &mut state);
                    residual = state.relative_residual(compliance);
                }
                if residual < task.tolerance {
                    return Ok(state.into_answer(task.limit.raw_dim(), residual));
                }
                tightening *= TOLERANCE_REDUCTION;
            }
            if residual < PROGRESS * best {
                (best, stagnations) = (residual, 0);
            } else {
                stagnations += 1;
            }
            if stagnations > MAX_STAGNATIONS || self.stats.convolutions as usize >= max_convolutions {
                return Err(self.not_converged(residual, task));
            }
            // As good as the quadratic convergence of the last step lets the next one be.
            let wanted = RESIDUAL_SHARE * tightening * task.tolerance / residual;
            let reduction =
                (residual / last).powi(2).clamp(MIN_REDUCTION, REDUCTION).max(wanted.min(REDUCTION));
            last = residual;
            state.predict_freedoms(compliance);
            if let Some(direction) = state.direction_to_rims() {
                let response = self.convolve(operator, &state.cells, &direction);
                state.advance(1.0, &direction, &response, 0.0);
            }
            if !self.newton_step(operator, &mut state, &coming, reduction) {
                return Err(self.not_converged(residual, task));
            }
            self.respond(operator, &mut state);
            state.balance_rigid_displacement();
        }
    }

    fn stats(&self) -> &Stats {
        &self.stats
    }
}

impl SteadySolver {
    /// Computes (1 − S) T q of the cells under a shear on them, by one convolution.
    fn convolve(
        &mut self,
        operator: &mut dyn CoupledOperator,
        cells: &[usize],
        shear: &[Vector],
    ) -> Vec<Vector> {
        self.stats.convolutions += 1.0;
        let displaced = self.influence.displace(operator, cells, shear);
        let arriving = cells.iter().map(|cell| self.ahead.of(*cell)).collect::<Vec<_>>();
        at(displaced, cells).iter().zip(at(displaced, &arriving)).map(|(u, next)| minus(*u, next)).collect()
    }

    fn not_converged(&self, residual: f64, task: &Task) -> Error {
        Error::NotConverged { iterations: self.stats.iterations, residual, tolerance: task.tolerance }
    }

    /// Computes the response of the cells to their shear.
    fn respond(&mut self, operator: &mut dyn CoupledOperator, state: &mut State) {
        state.response = self.convolve(operator, &state.cells, &state.shear);
    }

    /// For each cell the place in the list of that whose material arrives there, if that is in contact and comes later.
    fn cells_ahead(&self, state: &State) -> Vec<Option<usize>> {
        state
            .cells
            .iter()
            .enumerate()
            .map(|(k, cell)| {
                let next = self.ahead.of(*cell);
                let place = state.cells[k + 1..].binary_search(&next).ok()?;
                Some(k + 1 + place)
            })
            .collect()
    }

    /// Solves the Newton equations of the predicted freedoms to that `reduction` of their residual. Returns whether they have a
    /// solution.
    fn newton_step(
        &mut self,
        operator: &mut dyn CoupledOperator,
        state: &mut State,
        coming: &[Option<usize>],
        reduction: f64,
    ) -> bool {
        self.influence.adapt(state);
        // What the preconditioner makes of a rigid displacement, by which it leaves the force as it is.
        let under_rigid = state.wanted.map(|_| {
            [[1.0, 0.0], [0.0, 1.0]].map(|rigid| {
                let residual: Vec<Vector> = state.freedom.iter().map(|f| f.part(rigid)).collect();
                self.precondition(state, coming, &residual)
            })
        });
        let preconditioned = |solver: &mut Self, residual: &[Vector]| {
            let mut z = solver.precondition(state, coming, residual);
            if let Some([x, y]) = &under_rigid {
                let [rigid_x, rigid_y] = combination([sum(x), sum(y)], sum(&z));
                z.iter_mut().zip(x).zip(y).for_each(|((z, x), y)| {
                    *z = minus(*z, add(times(rigid_x, *x), times(rigid_y, *y)));
                });
                state.balance(&mut z);
            }
            z
        };
        let residual = state.newton_residual();
        let product = |v: &[f64]| {
            let z = preconditioned(self, v.as_chunks().0);
            let response = self.convolve(operator, &state.cells, &z);
            let mut applied: Vec<Vector> = state
                .freedom
                .iter()
                .zip(&z)
                .zip(&response)
                .map(|((freedom, z), u)| add(freedom.part(*u), times(freedom.slip_compliance(), *z)))
                .collect();
            state.balance(&mut applied);
            applied.into_flattened()
        };
        let (solution, products) = gmres(product, residual.into_flattened(), reduction, MAX_PRODUCTS);
        self.stats.iterations += products;
        let step = preconditioned(self, solution.as_chunks().0);
        let solved = step.iter().flatten().all(|d| d.is_finite());
        if solved {
            state.shear.iter_mut().zip(&step).for_each(|(q, d)| *q = add(*q, *d));
        }
        solved
    }

    /// An approximate solution of the Newton equations without regard to the force.
    fn precondition(&mut self, state: &State, coming: &[Option<usize>], residual: &[Vector]) -> Vec<Vector> {
        let compliance = self.influence.compliance;
        let mut displacement = residual.to_vec();
        for (k, freedom) in state.freedom.iter().enumerate().rev() {
            let arriving = coming[k].map_or([0.0; 2], |next| displacement[next]);
            let damping = 1.0 / (1.0 + freedom.slip_compliance() / compliance);
            displacement[k] = times(damping, freedom.part(add(residual[k], arriving)));
        }
        let mut shear = self.influence.invert(&state.cells, &displacement);
        for ((freedom, q), r) in state.freedom.iter().zip(&mut shear).zip(residual) {
            *q = match freedom.is_diagonal(compliance) {
                false => freedom.part(*q),
                true => times(1.0 / (compliance + freedom.slip_compliance()), *r),
            };
        }
        shear
    }
}

/// The sum of vectors.
fn sum(vectors: &[Vector]) -> Vector {
    vectors.iter().fold([0.0; 2], |sum, v| add(sum, *v))
}

//! The tangential problem of steady rolling: shear tractions under which the material that passes through the
//! contact sticks or slips.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::math::{Gmres, gmres};
use crate::operator::CoupledOperator;
use crate::solver::friction::disc::{Vector, add, combination, dot, minus, times};
use crate::solver::friction::shear::influence::{Influence, vectors_at};
use crate::solver::friction::shear::state::{Freedom, State};
use crate::solver::friction::shear::{Answer, Method, PROGRESS, Task};
use crate::solver::friction::transport::{ShiftByCell, SteadyMethod};
use crate::solver::{Stats, Watch};
use crate::units::SquareMetre;
use asperity_base::math::active_set::TOLERANCE_REDUCTION;
use asperity_base::watch::check_stop;

/// Largest number of consecutive Newton steps without progress. The first steps may increase the residual: in
/// initial full stick the shear is large at the trailing edge.
const MAX_STAGNATIONS: usize = 8;
/// The Newton equations are solved to this fraction of their residual.
const REDUCTION: f64 = 0.1;
/// Smallest fraction, after a step with a large reduction of the residual.
const MIN_REDUCTION: f64 = 1e-6;
/// Fraction of the target residual that is always sufficient.
const RESIDUAL_SHARE: f64 = 0.3;
/// Largest number of operator applications in one Newton step.
const MAX_PRODUCTS: usize = 60;
/// Initial weight of the proximal terms, relative to the compliance of a cell.
const FIRST_WEIGHT: f64 = 0.1;
/// Factor of the weight after a converged proximal step, down to [`MIN_WEIGHT`].
const WEIGHT_REDUCTION: f64 = 0.1;
/// Smallest weight.
const MIN_WEIGHT: f64 = 1e-8;
/// Factor of the weight after a proximal step that has not converged, up to [`MAX_WEIGHT`].
const WEIGHT_GROWTH: f64 = 10.0;
/// Largest weight.
const MAX_WEIGHT: f64 = 1e4;
/// Above this weight the Newton matrix of a proximal step is treated as diagonal.
const DOMINANT_WEIGHT: f64 = 0.3;
/// Number of proximal steps with a constant weight after one that has not converged.
const STEPS_AT_WEIGHT: usize = 3;
/// Two consecutive proximal steps are extrapolated if their changes have at least this cosine.
const MIN_COSINE: f64 = 0.9;
/// Longest extrapolation, in steps.
const MAX_EXTRAPOLATION: f64 = 1e3;
/// Largest number of proximal steps.
const MAX_PROXIMAL_STEPS: usize = 300;
/// A proximal step is solved until its residual is below this fraction of the change of the shear in it.
const PROXIMAL_REDUCTION: f64 = 0.1;
/// Fraction of the target residual that is always sufficient.
const PROXIMAL_SHARE: f64 = 0.1;
/// The Newton equations of a proximal step are solved to this fraction of their residual.
const PROXIMAL_NEWTON_REDUCTION: f64 = 1e-2;
/// Above this weight projected steps are a contraction.
const CONTRACTING_WEIGHT: f64 = 3.0;
/// Largest number of projected steps in a proximal step.
const MAX_PROJECTED_STEPS: usize = 50;

/// Solves tangential problems of steady rolling on one grid. While the contact moves by one cell, the
/// material of the next cell arrives with its displacement S T q, and slips by
///
/// ```text
/// Δs = D + b − (1 − S) T q
/// ```
///
/// The slip is zero if |q| < g, and otherwise points along q. The matrix (1 − S) T is not symmetric, but its
/// symmetric part is positive, so that this variational inequality has a unique solution. The iteration is
/// that of
/// [`ShearSolver`]: after each prediction of stick and slip it solves Newton's equations, here by GMRES.
///
/// The preconditioner follows the material. For single cells a Newton step Δq causes the displacement u = c
/// Δq, and (u − S u) + κ Δq = r is solved along each line from the leading edge. The approximate inverse of
/// the [`Influence`] gives the shear for this u.
///
/// Newton's iteration may not converge. It never converges if all cells of a line along the rolling touch
/// under a periodic boundary, because their uniform shear causes no slip and the matrix is singular. The
/// proximal point method (Rockafellar, SIAM J. Control Optim. 14, 877 (1976)) converges for any monotone
/// matrix. It adds a weight times c (q − q₀) to the displacement and solves this problem. The solution is the
/// next q₀, until the added term vanishes.
pub(super) struct SteadySolver {
    cell_area: SquareMetre,
    influence: Influence,
    ahead: ShiftByCell,
    method: SteadyMethod,
    /// The proximal term added to the displacement, if any.
    proximal: Option<Proximal>,
    stats: Stats,
}

/// The displacement w (q − q₀) that is added to the displacement of the cells.
struct Proximal {
    /// The compliance w relative to the compliance of a cell.
    weight: f64,
    /// The shear q₀ of each cell in contact.
    from: Vec<Vector>,
}

impl SteadySolver {
    pub(super) fn new(operator: &mut dyn CoupledOperator, ahead: ShiftByCell, method: SteadyMethod) -> Self {
        Self {
            cell_area: operator.grid().cell_area(),
            influence: Influence::new(operator),
            ahead,
            method,
            proximal: None,
            stats: Stats::default(),
        }
    }
}

impl Method for SteadySolver {
    /// The residual is max|q − P(q + Δs/c)| over the largest shear.
    fn solve(
        &mut self,
        operator: &mut dyn CoupledOperator,
        task: &Task,
        start: &[Field; 2],
        max_convolutions: usize,
        watch: &dyn Watch,
    ) -> Result<Answer> {
        let state = State::new(task, start, self.cell_area)?;
        let contact = Contact { task, coming: self.cells_ahead(&state), max_convolutions, watch };
        self.influence.unload();
        self.proximal = None;
        match self.method {
            SteadyMethod::Newton => self.newton(operator, state, &contact),
            SteadyMethod::ProximalPoint => self.proximal_point(operator, state, &contact),
        }
    }

    fn stats(&self) -> &Stats {
        &self.stats
    }
}

/// Data that are the same in all steps of a solution.
struct Contact<'a> {
    task: &'a Task<'a>,
    /// Index of the cell whose material arrives at each cell.
    coming: Vec<Option<usize>>,
    max_convolutions: usize,
    watch: &'a dyn Watch,
}

impl SteadySolver {
    /// Solves by Newton's iteration.
    ///
    /// # Errors
    /// [`Error::NotConverged`], [`Error::Interrupted`].
    fn newton(
        &mut self,
        operator: &mut dyn CoupledOperator,
        mut state: State,
        contact: &Contact,
    ) -> Result<Answer> {
        let (task, compliance) = (contact.task, self.influence.compliance);
        // Its rigid displacement assumes identical cells.
        self.respond(operator, &mut state);
        state.find_rigid_displacement(compliance);
        self.mark_unyielding(&mut state);
        let (mut best, mut last, mut stagnations, mut tightening) = (f64::INFINITY, f64::INFINITY, 0, 1.0);
        loop {
            check_stop(contact.watch)?;
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
            if stagnations > MAX_STAGNATIONS || self.has_cost_too_much(contact) {
                return Err(self.not_converged(residual, task));
            }
            // The accuracy follows from the quadratic convergence of the last step.
            let wanted = RESIDUAL_SHARE * tightening * task.tolerance / residual;
            let reduction =
                (residual / last).powi(2).clamp(MIN_REDUCTION, REDUCTION).max(wanted.min(REDUCTION));
            last = residual;
            if !self.newton_step(operator, &mut state, &contact.coming, reduction) {
                return Err(self.not_converged(residual, task));
            }
        }
    }

    /// Solves by the proximal point method.
    ///
    /// # Errors
    /// [`Error::NotConverged`], [`Error::Interrupted`].
    fn proximal_point(
        &mut self,
        operator: &mut dyn CoupledOperator,
        mut state: State,
        contact: &Contact,
    ) -> Result<Answer> {
        let (task, compliance) = (contact.task, self.influence.compliance);
        self.respond(operator, &mut state);
        let (mut weight, mut held, mut residual) = (FIRST_WEIGHT, 0, f64::INFINITY);
        let mut last_change: Option<Vec<Vector>> = None;
        for _ in 0..MAX_PROXIMAL_STEPS {
            let before = state.clone();
            self.proximal = Some(Proximal { weight, from: state.shear.clone() });
            let converged = self.proximal_step(operator, &mut state, contact)?;
            self.proximal = None;
            if self.has_cost_too_much(contact) {
                break;
            }
            if converged {
                state.project();
                self.respond(operator, &mut state);
                self.mark_unyielding(&mut state);
                residual = state.relative_residual(compliance);
                if residual < task.tolerance {
                    return Ok(state.into_answer(task.limit.raw_dim(), residual));
                }
                let change: Vec<Vector> =
                    state.shear.iter().zip(&before.shear).map(|(q, from)| minus(*q, *from)).collect();
                // A shear that causes no slip grows by the same amount in each step until cells slip.
                let steps = last_change.as_ref().map_or(0.0, |last| extrapolation(last, &change));
                if steps > 0.0 {
                    state.shear.iter_mut().zip(&change).for_each(|(q, d)| *q = add(*q, times(steps, *d)));
                    state.project();
                    self.respond(operator, &mut state);
                }
                last_change = (steps == 0.0).then_some(change);
                if held > 0 {
                    held -= 1;
                } else {
                    (weight, last_change) = ((WEIGHT_REDUCTION * weight).max(MIN_WEIGHT), None);
                }
            } else if weight < MAX_WEIGHT {
                (weight, held, last_change) = (WEIGHT_GROWTH * weight, STEPS_AT_WEIGHT, None);
                state = before;
            } else {
                break;
            }
        }
        Err(self.not_converged(residual, task))
    }

    /// Solves the problem with its proximal term by Newton's iteration. If this stagnates under a large
    /// weight, projected steps follow, which are then a contraction. Returns whether it has converged.
    fn proximal_step(
        &mut self,
        operator: &mut dyn CoupledOperator,
        state: &mut State,
        contact: &Contact,
    ) -> Result<bool> {
        let Proximal { weight, from } = self.proximal.as_ref().expect("a proximal term");
        let (weight, from) = (*weight, from.clone());
        let compliance = (1.0 + weight) * self.influence.compliance;
        let is_enough = |state: &State, residual: f64| {
            let share = PROXIMAL_REDUCTION * state.relative_change(&from);
            residual < share.max(PROXIMAL_SHARE * contact.task.tolerance)
        };
        // Under the proximal term the slip of every cell depends on its shear.
        state.unyielding = None;
        state.find_rigid_displacement(compliance);
        let before = state.clone();
        let (mut best, mut stagnations) = (state.relative_residual(compliance), 0);
        while stagnations <= MAX_STAGNATIONS && !self.has_cost_too_much(contact) {
            check_stop(contact.watch)?;
            if !self.newton_step(operator, state, &contact.coming, PROXIMAL_NEWTON_REDUCTION) {
                break;
            }
            let residual = state.relative_residual(compliance);
            if is_enough(state, residual) {
                return Ok(true);
            }
            if residual < PROGRESS * best {
                (best, stagnations) = (residual, 0);
            } else {
                stagnations += 1;
            }
        }
        *state = before;
        if weight < CONTRACTING_WEIGHT {
            return Ok(false);
        }
        for _ in 0..MAX_PROJECTED_STEPS {
            check_stop(contact.watch)?;
            state.take_projected(compliance);
            self.respond(operator, state);
            state.find_rigid_displacement(compliance);
            let residual = state.relative_residual(compliance);
            if is_enough(state, residual) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Whether the number of convolutions exceeds its limit.
    fn has_cost_too_much(&self, contact: &Contact) -> bool {
        self.stats.convolutions as usize >= contact.max_convolutions
    }

    /// Marks the cells that receive their own material. Their slip does not depend on the shear.
    fn mark_unyielding(&self, state: &mut State) {
        let stays = state.cells.iter().map(|cell| self.ahead.source(*cell) == *cell).collect::<Vec<_>>();
        state.unyielding = stays.contains(&true).then_some(stays);
    }

    /// Computes (1 − S) T q of the cells under a shear on them, by one convolution.
    fn convolve(
        &mut self,
        operator: &mut dyn CoupledOperator,
        cells: &[usize],
        shear: &[Vector],
    ) -> Vec<Vector> {
        self.stats.convolutions += 1.0;
        let displaced = self.influence.displace(operator, cells, shear);
        let arriving = cells.iter().map(|cell| self.ahead.source(*cell)).collect::<Vec<_>>();
        let mut response: Vec<Vector> = vectors_at(displaced, cells)
            .iter()
            .zip(vectors_at(displaced, &arriving))
            .map(|(u, next)| minus(*u, next))
            .collect();
        if let Some(Proximal { weight, .. }) = &self.proximal {
            let compliance = weight * self.influence.compliance;
            response.iter_mut().zip(shear).for_each(|(u, q)| *u = add(*u, times(compliance, *q)));
        }
        response
    }

    fn not_converged(&self, residual: f64, task: &Task) -> Error {
        Error::NotConverged { iterations: self.stats.iterations, residual, tolerance: task.tolerance }
    }

    /// Computes the response of the cells to their shear.
    fn respond(&mut self, operator: &mut dyn CoupledOperator, state: &mut State) {
        state.response = self.convolve(operator, &state.cells, &state.shear);
        if let Some(Proximal { weight, from }) = &self.proximal {
            let compliance = weight * self.influence.compliance;
            state.response.iter_mut().zip(from).for_each(|(u, q)| *u = minus(*u, times(compliance, *q)));
        }
    }

    /// Returns, for each cell, the index in the list of the cell whose material arrives there, if this cell
    /// is in contact and later in the list.
    fn cells_ahead(&self, state: &State) -> Vec<Option<usize>> {
        state
            .cells
            .iter()
            .enumerate()
            .map(|(k, cell)| {
                let next = self.ahead.source(*cell);
                let place = state.cells[k + 1..].binary_search(&next).ok()?;
                Some(k + 1 + place)
            })
            .collect()
    }

    /// Predicts the freedoms of the cells, solves their Newton equations to this `reduction` of their
    /// residual, and computes the response to the new shear. Returns whether the equations have a solution.
    fn newton_step(
        &mut self,
        operator: &mut dyn CoupledOperator,
        state: &mut State,
        coming: &[Option<usize>],
        reduction: f64,
    ) -> bool {
        state.predict_freedoms(self.influence.compliance);
        if let Some(direction) = state.direction_to_rims() {
            let response = self.convolve(operator, &state.cells, &direction);
            state.advance(1.0, &direction, &response, 0.0);
        }
        self.influence.adapt(state);
        // The preconditioned rigid displacement, with which the step preserves the force.
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
        let Gmres { solution, products, .. } =
            gmres(product, residual.into_flattened(), reduction, MAX_PRODUCTS);
        self.stats.iterations += products;
        let step = preconditioned(self, solution.as_chunks().0);
        let solved = step.iter().flatten().all(|d| d.is_finite());
        if solved {
            state.shear.iter_mut().zip(&step).for_each(|(q, d)| *q = add(*q, *d));
            self.respond(operator, state);
            state.balance_rigid_displacement();
        }
        solved
    }

    /// Computes an approximate solution of the Newton equations without the force condition.
    fn precondition(&mut self, state: &State, coming: &[Option<usize>], residual: &[Vector]) -> Vec<Vector> {
        let compliance = self.influence.compliance;
        if let Some(Proximal { weight, .. }) = self.proximal.as_ref().filter(|p| p.weight > DOMINANT_WEIGHT) {
            let diagonal = |freedom: &Freedom| (1.0 + weight) * compliance + freedom.slip_compliance();
            return state.freedom.iter().zip(residual).map(|(f, r)| times(1.0 / diagonal(f), *r)).collect();
        }
        let mut displacement = residual.to_vec();
        for (k, freedom) in state.freedom.iter().enumerate().rev() {
            let arriving = coming[k].map_or([0.0; 2], |next| displacement[next]);
            let damping = 1.0 / (1.0 + freedom.slip_compliance() / compliance);
            displacement[k] = if state.is_unyielding(k) {
                [0.0; 2]
            } else {
                times(damping, freedom.part(add(residual[k], arriving)))
            };
        }
        let mut shear = self.influence.invert(&state.cells, &displacement);
        for (k, ((freedom, q), r)) in state.freedom.iter().zip(&mut shear).zip(residual).enumerate() {
            *q = match (freedom.slip_compliance(), state.is_unyielding(k)) {
                (slips, true) if slips > 0.0 => times(1.0 / slips, *r),
                (slips, _) if freedom.is_diagonal(compliance) => times(1.0 / (compliance + slips), *r),
                _ => freedom.part(*q),
            };
        }
        shear
    }
}

/// Returns the number of further steps in the sum of a geometric series, from its last and its present term;
/// 0 for none.
fn extrapolation(last: &[Vector], present: &[Vector]) -> f64 {
    let product = |a: &[Vector], b: &[Vector]| a.iter().zip(b).map(|(a, b)| dot(*a, *b)).sum::<f64>();
    let (along, last, present) = (product(last, present), product(last, last), product(present, present));
    let is_straight = along > MIN_COSINE * (last * present).sqrt();
    if !is_straight {
        return 0.0;
    }
    let ratio = along / last;
    if ratio < 1.0 { (ratio / (1.0 - ratio)).min(MAX_EXTRAPOLATION) } else { MAX_EXTRAPOLATION }
}

/// Returns the sum of vectors.
fn sum(vectors: &[Vector]) -> Vector {
    vectors.iter().fold([0.0; 2], |sum, v| add(sum, *v))
}

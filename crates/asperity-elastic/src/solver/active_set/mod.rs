//! Conjugate gradients on a predicted active set. The projection onto the bounds is deferred and combined
//! with a preconditioned step, so that every convolution improves the solution.
//!
//! The method solves one contact, or many contacts that share an approach and carry a load together. Their
//! influence matrix is block-diagonal, and the blocks exchange only a few sums.

mod block;

use asperity_base::math::active_set::{
    CG_TOLERANCE, Caution, FIRST_PRESSURE, MAX_CG_STEPS, MIN_SEARCH_STEP, TOLERANCE_REDUCTION,
};

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::math::parallel;
use crate::ranks::{Largest, Merged, Slab};
use crate::solver::bounds::Interval;
use crate::solver::feasible::{Cells, Range, make_feasible, offset_for_sum};
use crate::solver::residual::Residual;
use crate::solver::site::Site;
use crate::solver::{Control, Settings, Stats, finite};
use crate::units::{Metre, Pascal};
use asperity_base::watch::check_stop;

use block::{Block, ResidualNorms};

/// Initial damping of the preconditioned step that is combined with the step to the bounds. Later it is a
/// running mean of the step lengths of conjugate gradients.
const FIRST_DAMPING: f64 = 0.8;
/// Weights of the mean so far and of a new step length in the running mean of the damping.
const DAMPING_WEIGHTS: [f64; 2] = [0.7, 0.3];
/// Largest step length in the running mean of the damping.
const MAX_STEP_IN_DAMPING: f64 = 1.2;

/// Fewest cells of a contact that is solved with the near copy.
const MIN_NEAR_CELLS: usize = 1 << 19;
/// η before the first convolution of a grid with a near copy.
const FIRST_TARGET: f64 = 1e-2;
/// Reduction of η with the near copy between two convolutions.
const REDUCTION: f64 = 0.05;
/// With the near copy η falls to this fraction of the tolerance, not further.
const LAST_TARGET: f64 = 0.5;
/// Largest number of outer steps with the near copy between two convolutions.
const MAX_NEAR_STEPS: usize = 40;
/// A correction makes progress if η is below this fraction of the least η so far.
const CORRECTION_PROGRESS: f64 = 0.5;
/// Number of corrections without progress before the near copy is given up.
const MAX_POOR_CORRECTIONS: usize = 3;

/// Largest error of the displacement due to single precision, as a fraction of the target residual.
const MAX_ROUNDING: f64 = 0.1;

/// Stage of a solution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stage {
    /// On a coarse grid, for a first guess. Its displacement need not be exact.
    Guess,
    /// On the grid itself, from a guess.
    Cold,
    /// From a given start.
    Warm,
}

/// Contacts that are solved with near copies of their operators, from a cold start.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NearCopies {
    /// Large ones with a free axis. On other grids a convolution takes no more than a third of a step, and
    /// the near copy gains nothing.
    Large,
    /// All whose operators have a near copy.
    #[cfg(test)]
    All,
}

impl NearCopies {
    fn serve(self, site: &dyn Site) -> bool {
        let mut serve = false;
        site.with_operator(&mut |operator| {
            let asked = match self {
                Self::Large => {
                    operator.grid().cells() >= MIN_NEAR_CELLS && !operator.boundary().leaves_mean_free()
                }
                #[cfg(test)]
                Self::All => true,
            };
            serve = asked && operator.has_near_copy();
        });
        serve
    }
}

/// Contacts in equilibrium under one approach.
pub(super) struct Answer {
    /// Pressure and displacement of each contact.
    pub(super) fields: Vec<(Field, Field)>,
    /// Residual of all contacts together.
    pub(super) residual: Residual,
    /// Cost of the solution; convolutions are averaged over the contacts.
    pub(super) stats: Stats,
}

/// Solves from the `start` of each contact to the `tolerance` of η for a state. Without a start it uses a
/// uniform pressure, or the interference under approach control.
///
/// The sets are predicted as in a primal–dual active set method (Hintermüller, Ito and Kunisch, SIAM J.
/// Optim. 13, 865 (2003)). Its complementarity parameter is the compliance of a cell, initially
/// `compliance_factor` times its self-influence.
///
/// If near copies of the operators serve, search directions are convolved with these, and the operators only
/// correct the displacement when the residual has fallen; see [`NearCopies`].
pub(super) fn solve(
    sites: &[&dyn Site],
    settings: &Settings,
    start: Option<Vec<Field>>,
    compliance_factor: f64,
    tolerance: &dyn Fn(&Residual) -> f64,
    max_convolutions: usize,
    stage: Stage,
) -> Result<Answer> {
    let mut iteration = Iteration::new(sites, settings, start, compliance_factor, stage);
    let mut state = iteration.residual();
    if let Some(pressure) = settings.pressure_sum() {
        // The periodic displacement of a uniform pressure is no scale for later displacements.
        let cells: usize = sites.iter().map(|site| site.slab().whole_grid().cells()).sum();
        state.scale = state.scale.max(settings.self_influence * settings.sum_scale(pressure) / cells as f64);
    }
    // The rounding must not hide that the start is a solution, which is returned unchanged.
    let rounding = iteration.rounding() / state.scale;
    if stage == Stage::Warm && state.eta < tolerance(&state) + rounding && iteration.is_feasible() {
        iteration.each(Block::convolve);
        state = iteration.residual();
    }
    if iteration.near {
        match iteration.solve_near(state, tolerance, max_convolutions, stage)? {
            Near::Solved(residual) => return Ok(iteration.into_answer(residual)),
            Near::Poor => {
                iteration.leave_near_copy();
                state = iteration.residual();
            }
        }
    }
    let mut tightening = 1.0;
    loop {
        let mut wanted = tolerance(&state);
        settings.watch.iteration(state.eta, wanted);
        check_stop(settings.watch)?;
        // A feasible solution without significant rounding is returned unchanged.
        let exact = state.eta < wanted && iteration.rounding() == 0.0 && iteration.is_feasible();
        if exact || state.eta < tightening * wanted {
            // The solution is the nearest feasible pressure, and its own residual decides.
            let max_rounding = MAX_ROUNDING * wanted * state.scale;
            if iteration.rounding() > max_rounding || !iteration.is_feasible() {
                iteration.become_feasible(max_rounding);
                state = iteration.residual();
                wanted = tolerance(&state);
            }
            state.eta += iteration.rounding() / state.scale;
            if state.eta < wanted {
                return Ok(iteration.into_answer(state));
            }
            tightening *= TOLERANCE_REDUCTION;
        }
        finite("residual", state.eta.min(f64::MAX))?;
        let Stats { iterations, convolutions, .. } = iteration.stats();
        if convolutions >= max_convolutions as f64 {
            return Err(Error::NotConverged { iterations, residual: state.eta, tolerance: wanted });
        }
        state = match iteration.outer_step(state, tightening * wanted) {
            // If the residual of the free cells alone is far too large, the full residual is not needed.
            Some(left) if left.max_residual > wanted * state.scale => {
                Residual { eta: left.max_residual / state.scale, approach: left.datum, ..state }
            }
            _ => iteration.residual(),
        };
    }
}

/// Result of the iteration with near copies.
enum Near {
    /// The residual of the solution.
    Solved(Residual),
    /// The corrections make no progress.
    Poor,
}

struct Iteration<'a> {
    settings: Settings<'a>,
    /// Whether search directions are convolved with near copies of the operators.
    near: bool,
    blocks: Vec<Block<'a>>,
    /// The slab of the first block, if its grid is divided among ranks. Several blocks are whole grids.
    slab: Slab,
    /// Number of free cells of all blocks.
    free_cells: f64,
    /// Caution against cycles of the predicted sets.
    caution: Caution,
    /// Damping of the preconditioned step that is combined with the step to the bounds.
    damping: f64,
    /// Number of consecutive outer steps from pressures that are all at their bounds.
    bound_steps: usize,
    iterations: usize,
    restarts: usize,
}

impl<'a> Iteration<'a> {
    fn new(
        sites: &[&'a dyn Site],
        settings: &Settings<'a>,
        start: Option<Vec<Field>>,
        compliance_factor: f64,
        stage: Stage,
    ) -> Self {
        let cells: usize = sites.iter().map(|site| site.slab().whole_grid().cells()).sum();
        let far = start.is_none();
        let pressures = start.unwrap_or_else(|| {
            let guess = |site: &&dyn Site| match settings.control {
                Control::Load(load) => {
                    Field::from_elem(site.grid().shape, load / settings.cell_area / cells as f64)
                }
                Control::Approach(approach) => {
                    site.initial_gap().mapv(|h| FIRST_PRESSURE * (approach - h) / settings.self_influence)
                }
            };
            sites.iter().map(guess).collect()
        });
        let near = stage != Stage::Warm && sites.iter().all(|site| settings.near_copies.serve(*site));
        let blocks =
            parallel::tasks(pressures.into_iter().zip(sites), |(p, site)| Block::new(*site, p, near));
        let mut iteration = Self {
            settings: *settings,
            near,
            blocks,
            slab: sites[0].slab(),
            free_cells: 0.0,
            caution: Caution::new(compliance_factor),
            damping: FIRST_DAMPING,
            bound_steps: 0,
            iterations: 0,
            restarts: 0,
        };
        make_feasible(&mut iteration, settings);
        iteration.each(Block::convolve_in_single);
        if let (true, Control::Approach(approach)) = (far, settings.control) {
            iteration.scale_to_least_energy(approach);
        }
        iteration.each(Block::keep_feasible);
        iteration
    }

    /// Performs a task on each block, in parallel for several blocks.
    fn each(&mut self, task: impl Fn(&mut Block<'a>) + Sync) {
        match self.blocks.as_mut_slice() {
            [block] => task(block),
            blocks => {
                parallel::tasks(blocks, task);
            }
        }
    }

    /// Performs a task on each block. Returns the results, merged in the order of the blocks and of the
    /// ranks.
    fn merged<M: Merged + Send>(&mut self, task: impl Fn(&mut Block<'a>) -> M + Sync) -> M {
        let part = match self.blocks.as_mut_slice() {
            [block] => task(block),
            blocks => M::of_parts(parallel::tasks(blocks, task)),
        };
        self.slab.merged(part)
    }

    /// Cost so far.
    fn stats(&self) -> Stats {
        let convolutions: usize = self.blocks.iter().map(Block::convolutions).sum();
        let near: usize = self.blocks.iter().map(Block::near_applications).sum();
        Stats {
            iterations: self.iterations,
            convolutions: convolutions as f64 / self.blocks.len() as f64,
            near_applications: near as f64 / self.blocks.len() as f64,
            restarts: self.restarts,
        }
    }

    /// Returns the error bound of the displacements due to single precision.
    fn rounding(&self) -> Metre {
        self.blocks.iter().map(Block::rounding).fold(0.0, f64::max)
    }

    /// Returns the mean over the free cells of values with this sum. Under load control a direction without
    /// this mean preserves the load. Returns 0 under approach control.
    fn mean(&self, sum: f64) -> f64 {
        match self.settings.control {
            Control::Load(_) => sum / self.free_cells,
            Control::Approach(_) => 0.0,
        }
    }

    fn into_answer(self, residual: Residual) -> Answer {
        let stats = self.stats();
        let fields = self.blocks.into_iter().map(Block::into_fields).collect();
        Answer { fields, residual, stats }
    }

    /// Under approach control, scales the guess to the multiple with the least energy, without a convolution.
    fn scale_to_least_energy(&mut self, approach: Metre) {
        let [work, twice_energy] = self.merged(|block| block.work(approach));
        if twice_energy > 0.0 {
            let factor = (work / twice_energy).clamp(0.0, 1.0);
            self.each(|block| block.scale(factor));
        }
    }

    /// Returns the residual of all blocks, at the prescribed approach or at the multiplier of the load.
    fn residual(&mut self) -> Residual {
        let settings = self.settings;
        let approach = match settings.control {
            Control::Approach(approach) => approach,
            Control::Load(_) => self.merged(|block| block.multiplier()).approach(),
        };
        let sums = self.merged(|block| block.residual_sums(approach, &settings));
        sums.residual(approach, settings.self_influence)
    }

    /// Whether all pressures are within their bounds and carry the load.
    fn is_feasible(&mut self) -> bool {
        if self.merged(|block| !block.is_within_bounds()) {
            return false;
        }
        let [sum] = self.sum(|p, _| [p]);
        self.settings.carries_the_load(sum)
    }

    /// Iterates with the near copies, and corrects the displacement by the operators when the residual has
    /// fallen.
    fn solve_near(
        &mut self,
        mut state: Residual,
        tolerance: &dyn Fn(&Residual) -> f64,
        max_convolutions: usize,
        stage: Stage,
    ) -> Result<Near> {
        let settings = self.settings;
        let mut target = FIRST_TARGET.max(LAST_TARGET * tolerance(&state));
        let mut steps = 0;
        let (mut least, mut poor) = (f64::INFINITY, 0);
        loop {
            let mut wanted = tolerance(&state);
            settings.watch.iteration(state.eta, wanted);
            check_stop(settings.watch)?;
            if state.eta < target || steps >= MAX_NEAR_STEPS {
                if stage == Stage::Guess && state.eta < wanted {
                    make_feasible(self, &settings);
                    return Ok(Near::Solved(state));
                }
                self.correct(MAX_ROUNDING * wanted * state.scale);
                state = self.residual();
                state.eta += self.rounding() / state.scale;
                wanted = tolerance(&state);
                if state.eta < wanted {
                    return Ok(Near::Solved(state));
                }
                poor = if state.eta < CORRECTION_PROGRESS * least { 0 } else { poor + 1 };
                if poor >= MAX_POOR_CORRECTIONS {
                    return Ok(Near::Poor);
                }
                least = least.min(state.eta);
                let last = if stage == Stage::Guess { wanted } else { LAST_TARGET * wanted };
                target = last.max(REDUCTION * state.eta);
                steps = 0;
            }
            finite("residual", state.eta.min(f64::MAX))?;
            let Stats { iterations, convolutions, .. } = self.stats();
            if convolutions >= max_convolutions as f64 {
                return Err(Error::NotConverged { iterations, residual: state.eta, tolerance: wanted });
            }
            steps += 1;
            state = match self.outer_step(state, target) {
                // The violation of the bounds counts when the operator corrects the displacement.
                Some(left)
                    if left.max_residual > target * state.scale || left.violation < target * state.scale =>
                {
                    Residual { eta: left.max_residual / state.scale, approach: left.datum, ..state }
                }
                _ => self.residual(),
            };
        }
    }

    /// Corrects the displacement by the operators at the nearest feasible pressure.
    fn correct(&mut self, max_rounding: Metre) {
        let settings = self.settings;
        make_feasible(self, &settings);
        self.each(|block| block.correct(max_rounding));
        self.caution.forget_norms();
        self.bound_steps = 0;
    }

    /// Continues without near copies from the last correction.
    fn leave_near_copy(&mut self) {
        self.near = false;
        self.each(Block::leave_near_copy);
    }

    /// Moves to the nearest feasible pressure, with one convolution. It is in single precision if its error
    /// is below `max_rounding`. With near copies these compute the displacement.
    fn become_feasible(&mut self, max_rounding: Metre) {
        let settings = self.settings;
        make_feasible(self, &settings);
        if self.near {
            self.each(Block::convolve_change);
            return;
        }
        let Largest(rounding) = self.merged(|block| Largest(block.rounding_in_single()));
        if rounding < max_rounding {
            self.each(Block::convolve_in_single);
        } else {
            self.each(Block::convolve);
        }
    }

    /// Performs an outer step: predicts the sets, moves the other cells to their bounds, and solves for the
    /// free cells by conjugate gradients. Returns the norms, unless the pressure has changed since.
    fn outer_step(&mut self, state: Residual, wanted: f64) -> Option<ResidualNorms> {
        self.predict_sets(state.approach);
        if self.free_cells == 0.0 {
            self.become_feasible(0.0);
            self.step_from_bounds(state.approach);
            return None;
        }
        self.bound_steps = 0;
        let share = self.step_to_bounds(state.approach, MAX_ROUNDING * wanted * state.scale);
        let left = self.conjugate_gradients(state, wanted, share);
        self.restore_the_sum();
        let searched = self.safeguard(left.residual.hypot(left.violation), state.approach);
        (!searched).then_some(left)
    }

    /// Handles pressures that are all at their bounds without equilibrium. One step along the gap frees some
    /// cells. If it only moves cells to the other bound, a line search limits the step.
    fn step_from_bounds(&mut self, approach: Metre) {
        self.bound_steps += 1;
        if self.bound_steps == 1 {
            self.step_along_gap(approach);
            return;
        }
        self.each(|block| {
            block.keep_feasible();
            block.convolve_feasible();
        });
        self.step_along_gap(approach);
        let share = self.line_search(approach);
        self.each(|block| {
            block.step_from_feasible(share);
            block.end_line_search();
        });
    }

    /// Performs one diagonal step along the gap, to a feasible pressure.
    fn step_along_gap(&mut self, approach: Metre) {
        let compliance = 2.0 * self.settings.self_influence;
        self.each(|block| block.step_along_gap(approach, compliance));
        self.become_feasible(0.0);
    }

    /// Predicts the sets by one diagonal Newton step: a cell whose proposed pressure is beyond a bound
    /// belongs to it. Under load control the approach is chosen so that the clipped proposed pressures carry
    /// the load.
    fn predict_sets(&mut self, approach: Metre) {
        let stiffness = 1.0 / (self.caution.compliance_factor * self.settings.self_influence);
        let settings = self.settings;
        let offset = match settings.pressure_sum() {
            Some(wanted) => {
                let range = self.merged(|block| block.propose(approach, stiffness));
                offset_for_sum(range, wanted, settings.sum_accuracy(wanted), |offset| {
                    self.merged(|block| block.proposed_sum(offset))
                })
            }
            None => 0.0,
        };
        [self.free_cells] = self.merged(|block| {
            block.predict_sets(approach, stiffness, offset);
            [block.free_cells() as f64]
        });
    }

    /// Moves the cells predicted at a bound to it, and the free cells by one preconditioned step, in one
    /// convolution. The convolution is of the step, or of the total pressure in double precision if the error
    /// bound exceeds `max_rounding`. Returns the multiple of the response, 1 or 0, that the displacement
    /// lacks.
    fn step_to_bounds(&mut self, approach: Metre, max_rounding: Metre) -> f64 {
        let [moving, to_bounds] = self.merged(Block::move_to_bounds);
        if moving == 0.0 {
            return 0.0;
        }
        let [sum] = self.merged(|block| [block.predict_residual(approach)]);
        let mean = self.mean(sum);
        let [sum, ..] = self.merged(|block| block.precondition_predicted(mean));
        let (mean, damping) = (self.mean(sum), self.damping);
        let [by_free, borne] = self.merged(|block| block.direct_free_cells(mean, damping));
        if let Control::Load(_) = self.settings.control {
            // The load does not change: the free cells take the difference in proportion to their pressures.
            let added = to_bounds + by_free;
            let (each, per_pressure) =
                if borne > 0.0 { (0.0, added / borne) } else { (added / self.free_cells, 0.0) };
            self.each(|block| block.balance_direction(each, per_pressure));
        }
        let in_double = !self.near && self.rounding() > max_rounding;
        self.each(|block| block.move_free_cells(!in_double));
        if in_double {
            self.restore_the_sum();
            self.each(Block::convolve);
            return 0.0;
        }
        1.0
    }

    /// Restores the load exactly. The rounding of the directions causes errors of the same order in the load
    /// as in the displacement.
    fn restore_the_sum(&mut self) {
        let Some(wanted) = self.settings.pressure_sum() else { return };
        let [sum] = self.sum(|p, _| [p]);
        let pressure = (wanted - sum) / self.free_cells;
        self.each(|block| block.add_to_free_cells(pressure));
    }

    /// Performs preconditioned conjugate gradients on the free cells until the violation of the bounds
    /// exceeds the residual, after adding a `share` of the last response to the displacement. Returns both
    /// norms.
    fn conjugate_gradients(&mut self, state: Residual, wanted: f64, share: f64) -> ResidualNorms {
        let [sum] = self.merged(|block| [block.reset_direction(share)]);
        let mut datum = match self.settings.control {
            Control::Approach(approach) => approach,
            Control::Load(_) => self.mean(sum),
        };
        let mut left = self.step_along_direction(share, datum);
        let mut product_before = f64::INFINITY;
        for _ in 0..MAX_CG_STEPS {
            if self.settings.watch.stop() {
                break;
            }
            let [sum, drift, product] = self.merged(|block| block.precondition());
            let mean = self.mean(sum);
            let product = product - mean * drift;
            let beta = product / product_before;
            product_before = product;
            let [curvature, sum] = self.merged(|block| block.update_direction(mean, beta));
            if !(curvature > 0.0 && product > 0.0) {
                break;
            }
            let step = product / curvature;
            datum += step * self.mean(sum);
            left = self.step_along_direction(step, datum);
            self.iterations += 1;
            let [old, new] = DAMPING_WEIGHTS;
            self.damping = old * self.damping + new * step.min(MAX_STEP_IN_DAMPING);
            if left.residual <= self.caution.cg_exit * left.violation
                || left.max_residual < CG_TOLERANCE * wanted * state.scale
            {
                break;
            }
        }
        left
    }

    /// Moves along the direction. Returns the norms of residual and violation: roots of the sums of squares.
    fn step_along_direction(&mut self, step: f64, datum: Metre) -> ResidualNorms {
        let settings = self.settings;
        let sums = self.merged(|block| block.step_along_direction(step, datum, &settings));
        ResidualNorms { residual: sums.residual.sqrt(), violation: sums.violation.sqrt(), ..sums }
    }

    /// Safeguards the iteration against cycles of the predicted sets. After some outer steps without progress
    /// it returns to a feasible pressure, from which an exact line search lowers the energy. Returns whether
    /// it did so.
    fn safeguard(&mut self, norm: f64, approach: Metre) -> bool {
        if !self.caution.demands_a_search(norm) {
            return false;
        }
        self.become_feasible(0.0);
        self.each(Block::convolve_feasible);
        let mut share = self.line_search(approach);
        if share <= MIN_SEARCH_STEP {
            // If this makes no progress, it searches along the gap of the feasible pressure.
            self.each(|block| block.step_from_feasible(0.0));
            let datum = self.residual().approach;
            self.step_along_gap(datum);
            share = self.line_search(approach);
        }
        self.each(|block| {
            block.step_from_feasible(share);
            block.end_line_search();
        });
        self.caution.after_search();
        self.restarts += 1;
        true
    }

    /// Returns the step in [0, 1] from the last feasible pressure to the present one with the least energy.
    fn line_search(&mut self, approach: Metre) -> f64 {
        let datum = match self.settings.control {
            Control::Load(_) => 0.0,
            Control::Approach(_) => approach,
        };
        let [slope, curvature] = self.merged(|block| block.descent(datum));
        if slope > 0.0 && curvature > 0.0 { (slope / curvature).min(1.0) } else { 0.0 }
    }
}

impl Cells for Iteration<'_> {
    fn sum<const N: usize>(
        &mut self,
        terms: impl Fn(Pascal, Interval) -> [f64; N] + Sync + Send,
    ) -> [f64; N] {
        self.merged(|block| block.sum(&terms))
    }

    fn map(&mut self, change: impl Fn(Pascal, Interval) -> Pascal + Sync + Send) {
        self.each(|block| block.map(&change));
    }

    fn range(&mut self) -> Range {
        self.merged(|block| block.range())
    }
}

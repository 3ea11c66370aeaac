//! Conjugate gradients on a predicted active set, with the projection onto the bounds deferred and folded into a
//! preconditioned step, so that every convolution advances the answer.
//!
//! One contact, or many that share an approach and bear a load together: their influence matrix is block-diagonal, and
//! nothing but a few sums passes between the blocks.

mod block;

use rayon::prelude::*;

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::math::sum::sums;
use crate::solver::bounds::{self, Cells, Range};
use crate::solver::residual::{Multiplier, Residual, Tally};
use crate::solver::site::Site;
use crate::solver::{Control, Stats, Terms, finite};
use crate::units::{Metre, Pascal};

use block::{Block, LeftOver};

/// The conjugate gradients are left when the residual on the free cells is below so many times the violation of
/// the bounds: more would be spent on a set that is about to change.
const LEAVE: f64 = 3.0;
/// Conjugate gradient steps on one active set, at the most.
const MOST_INNER: usize = 60;
/// The equations are met when they are below so much of what is asked of the answer, which is taken at its bounds.
const NEARLY: f64 = 0.9;
/// What single precision leaves in the displacement may be so much of the residual that is wanted.
const TRUSTED: f64 = 0.1;

/// Contacts in equilibrium under one approach.
pub(super) struct Equilibrium {
    /// Pressure and displacement of each.
    pub(super) fields: Vec<(Field, Field)>,
    pub(super) residual: Residual,
    /// The convolutions are those of one contact, in the mean.
    pub(super) stats: Stats,
}

/// Solves from the `start` of each contact (uniform pressure, or the interference under approach control, where there
/// is none), with some caution when the sets are predicted, to the `tolerance` on η that belongs to a state.
pub(super) fn solve(
    sites: &[&dyn Site],
    terms: &Terms,
    start: Option<Vec<Field>>,
    caution: f64,
    tolerance: &dyn Fn(&Residual) -> f64,
    max_convolutions: usize,
) -> Result<Equilibrium> {
    let mut iteration = Iteration::new(sites, terms, start, caution);
    let mut sharpen = 1.0;
    let mut state = iteration.residual();
    if let Some(pressure) = terms.pressure_sum() {
        // What a uniform pressure leaves of a periodic displacement says nothing of that to come.
        let cells: usize = sites.iter().map(|site| site.grid().cells()).sum();
        state.scale = state.scale.max(terms.self_influence * pressure / cells as f64);
    }
    loop {
        let mut wanted = tolerance(&state);
        // Nothing is left to sharpen where the answer is as it will be handed out.
        let exact = state.eta < wanted && iteration.rounding() == 0.0 && iteration.is_feasible();
        if exact || state.eta < sharpen * wanted {
            // The answer is the feasible pressure nearby; its own residual decides.
            let trusted = TRUSTED * wanted * state.scale;
            if iteration.rounding() > trusted || !iteration.is_feasible() {
                iteration.become_feasible(trusted);
                state = iteration.residual();
                wanted = tolerance(&state);
            }
            state.eta += iteration.rounding() / state.scale;
            if state.eta < wanted {
                return Ok(iteration.into_equilibrium(state));
            }
            sharpen *= 0.3;
        }
        finite("residual", state.eta.min(f64::MAX))?;
        let Stats { iterations, convolutions, .. } = iteration.stats();
        if convolutions >= max_convolutions as f64 {
            return Err(Error::NotConverged { iterations, residual: state.eta, tolerance: wanted });
        }
        state = match iteration.outer_step(state, sharpen * wanted) {
            // Where the equations alone are far from being met there is no need to look further.
            Some(left) if left.largest > wanted * state.scale => {
                Residual { eta: left.largest / state.scale, approach: left.datum, ..state }
            }
            _ => iteration.residual(),
        };
    }
}

struct Iteration<'a> {
    terms: Terms,
    blocks: Vec<Block<'a>>,
    leave: f64,
    /// Running mean of the step length: the damping of the folded step.
    damping: f64,
    /// How much stiffer than its own diagonal a cell is taken to be when the sets are predicted.
    caution: f64,
    best: f64,
    strikes: usize,
    /// Steps in a row from pressures all at their bounds.
    bound_steps: usize,
    iterations: usize,
    restarts: usize,
}

impl<'a> Iteration<'a> {
    fn new(sites: &[&'a dyn Site], terms: &Terms, start: Option<Vec<Field>>, caution: f64) -> Self {
        let cells: usize = sites.iter().map(|site| site.grid().cells()).sum();
        let far = start.is_none();
        let pressures = start.unwrap_or_else(|| {
            let guess = |site: &&dyn Site| match terms.control {
                Control::Load(load) => {
                    Field::from_elem(site.grid().shape, load / terms.cell_area / cells as f64)
                }
                Control::Approach(approach) => {
                    site.initial_gap().mapv(|h| 0.3 * (approach - h) / terms.self_influence)
                }
            };
            sites.iter().map(guess).collect()
        });
        let blocks = pressures.into_par_iter().zip(sites).map(|(p, site)| Block::new(*site, p)).collect();
        let mut iteration = Self {
            terms: *terms,
            blocks,
            leave: LEAVE,
            damping: 0.8,
            caution,
            best: f64::INFINITY,
            strikes: 0,
            bound_steps: 0,
            iterations: 0,
            restarts: 0,
        };
        bounds::make_feasible(&mut iteration, terms);
        iteration.each(Block::respond_in_single);
        if let (true, Control::Approach(approach)) = (far, terms.control) {
            iteration.scale_to_least_energy(approach);
        }
        iteration.each(Block::keep);
        iteration
    }

    /// Does something to each block, in parallel where there are several.
    fn each(&mut self, task: impl Fn(&mut Block<'a>) + Sync) {
        self.all(task, |(), ()| ());
    }

    /// What comes of something done to each block, put together in the order of the blocks.
    fn all<R: Send>(&mut self, task: impl Fn(&mut Block<'a>) -> R + Sync, and: impl Fn(R, R) -> R) -> R {
        match self.blocks.as_mut_slice() {
            [block] => task(block),
            blocks => {
                let parts: Vec<R> = blocks.par_iter_mut().map(&task).collect();
                parts.into_iter().reduce(and).expect("a block")
            }
        }
    }

    /// The sums over the blocks of what comes of something done to each.
    fn sum<const N: usize>(&mut self, task: impl Fn(&mut Block<'a>) -> [f64; N] + Sync) -> [f64; N] {
        self.all(task, |a, b| std::array::from_fn(|n| a[n] + b[n]))
    }

    fn stats(&self) -> Stats {
        let convolutions: usize = self.blocks.iter().map(Block::convolutions).sum();
        Stats {
            iterations: self.iterations,
            convolutions: convolutions as f64 / self.blocks.len() as f64,
            restarts: self.restarts,
        }
    }

    /// Bound on the error of the displacements by single precision.
    fn rounding(&self) -> Metre {
        self.blocks.iter().map(Block::rounding).fold(0.0, f64::max)
    }

    fn free_cells(&self) -> f64 {
        self.blocks.iter().map(Block::free_cells).sum::<usize>() as f64
    }

    /// Under load control directions keep the sum: the mean over the free cells is taken out.
    fn mean(&self, sum: f64) -> f64 {
        match self.terms.control {
            Control::Load(_) => sum / self.free_cells(),
            Control::Approach(_) => 0.0,
        }
    }

    fn into_equilibrium(self, residual: Residual) -> Equilibrium {
        let stats = self.stats();
        let fields = self.blocks.into_iter().map(Block::into_fields).collect();
        Equilibrium { fields, residual, stats }
    }

    /// Under approach control a guess is only as good as its size: the multiple of least energy, at no cost.
    fn scale_to_least_energy(&mut self, approach: Metre) {
        let [work, twice_energy] = self.sum(|block| block.work(approach));
        if twice_energy > 0.0 {
            let factor = (work / twice_energy).clamp(0.0, 1.0);
            self.each(|block| block.scale(factor));
        }
    }

    fn residual(&mut self) -> Residual {
        let terms = self.terms;
        let approach = match terms.control {
            Control::Approach(approach) => approach,
            Control::Load(_) => {
                self.all(|block| block.multiplier(terms.hardness), Multiplier::and).approach()
            }
        };
        let tally = self.all(|block| block.tally(approach, &terms), Tally::and);
        tally.residual(approach, terms.self_influence)
    }

    fn is_feasible(&mut self) -> bool {
        let hardness = self.terms.hardness;
        let inside = |block: &Block| block.pressure().iter().all(|p| (0.0..=hardness).contains(p));
        if !self.blocks.iter().all(inside) {
            return false;
        }
        let [sum] = Cells::sum(self, |p| [p]);
        self.terms.bears_the_load(sum)
    }

    /// The feasible pressure nearby, at the cost of a convolution: in single precision where `trusted` is more than
    /// what that leaves in the displacement.
    fn become_feasible(&mut self, trusted: Metre) {
        let terms = self.terms;
        bounds::make_feasible(self, &terms);
        let rounding = self.all(|block| block.rounding_in_single(), f64::max);
        if rounding < trusted {
            self.each(Block::respond_in_single);
        } else {
            self.each(Block::respond);
        }
    }

    /// One set of free cells, solved as far as it is worth. Returns what that leaves, unless the pressure is another since.
    fn outer_step(&mut self, state: Residual, wanted: f64) -> Option<LeftOver> {
        self.predict_sets(state.approach);
        if self.free_cells() == 0.0 {
            self.become_feasible(0.0);
            self.step_from_bounds(state.approach);
            return None;
        }
        self.bound_steps = 0;
        self.lift_to_bounds(state.approach, TRUSTED * wanted * state.scale);
        let left = self.conjugate_gradients(state, wanted);
        self.restore_the_sum();
        let restarted = self.safeguard(left.equations.hypot(left.bounds), state.approach);
        (!restarted).then_some(left)
    }

    /// Every cell at a bound and no equilibrium: one step along the gap frees some; where it has only taken them to the other
    /// bound, as much of it as lowers the energy most.
    fn step_from_bounds(&mut self, approach: Metre) {
        self.bound_steps += 1;
        if self.bound_steps == 1 {
            self.step_along_gap(approach);
            return;
        }
        self.each(|block| {
            block.keep();
            block.recall();
        });
        self.step_along_gap(approach);
        let share = self.line_search(approach);
        self.each(|block| {
            block.go_back(share);
            block.keep();
            block.forget();
        });
    }

    /// One step along the gap.
    fn step_along_gap(&mut self, approach: Metre) {
        let compliance = 2.0 * self.terms.self_influence;
        self.each(|block| block.step_along_gap(approach, compliance));
        self.become_feasible(0.0);
    }

    /// Cells are predicted at a bound where one diagonal Newton step takes them there. Under load control its datum is
    /// the one at which the pressures of the step, in their bounds, bear the load.
    fn predict_sets(&mut self, approach: Metre) {
        let hardness = self.terms.hardness;
        let stiffness = 1.0 / (self.caution * self.terms.self_influence);
        let shift = match self.terms.pressure_sum() {
            Some(wanted) => {
                let range = self.all(|block| block.propose(approach, stiffness), Range::and);
                bounds::shift_for_sum(range, wanted, |shift| {
                    self.sum(|block| block.proposed_sum(shift, hardness))
                })
            }
            None => 0.0,
        };
        self.each(|block| block.predict(approach, stiffness, shift, hardness));
    }

    /// Takes the cells at a bound there, and the free cells one preconditioned step further, in one convolution: of the
    /// step, or where single precision has left more than is `trusted`, of the whole pressure in double.
    fn lift_to_bounds(&mut self, approach: Metre, trusted: Metre) {
        let Terms { hardness, control, .. } = self.terms;
        if !self.all(|block| block.direct_to_bounds(hardness), |a, b| a || b) {
            return;
        }
        let [sum] = self.sum(|block| [block.foresee(approach)]);
        let mean = self.mean(sum);
        let [sum, ..] = self.sum(|block| {
            block.centre(mean);
            block.precondition()
        });
        let (mean, damping) = (self.mean(sum), self.damping);
        let [added, bearing] = self.sum(|block| block.direct(mean, damping, hardness));
        if let Control::Load(_) = control {
            // The load does not change: the free cells take up the difference, in proportion.
            let (each, per_pressure) =
                if bearing > 0.0 { (0.0, added / bearing) } else { (added / self.free_cells(), 0.0) };
            self.each(|block| block.take_up(each, per_pressure, hardness));
        }
        let afresh = self.rounding() > trusted;
        self.each(|block| {
            if !afresh {
                block.follow();
            }
            block.lift(hardness);
        });
        if afresh {
            self.restore_the_sum();
            self.each(Block::respond);
        }
    }

    /// Exactly the load, whatever the rounding of the directions: what they have left of it is in the order of what
    /// they have left in the displacement.
    fn restore_the_sum(&mut self) {
        let Some(wanted) = self.terms.pressure_sum() else { return };
        let [sum] = Cells::sum(self, |p| [p]);
        let pressure = (wanted - sum) / self.free_cells();
        self.each(|block| block.raise(pressure));
    }

    /// Preconditioned conjugate gradients on the free cells until the bounds are violated more than the equations.
    /// Returns what is left of both.
    fn conjugate_gradients(&mut self, state: Residual, wanted: f64) -> LeftOver {
        let [sum] = self.sum(|block| [block.halt()]);
        let mut datum = match self.terms.control {
            Control::Approach(approach) => approach,
            Control::Load(_) => self.mean(sum),
        };
        let mut left = self.advance(0.0, datum);
        let mut product_before = f64::INFINITY;
        for _ in 0..MOST_INNER {
            let [sum, drift, product] = self.sum(Block::precondition);
            let mean = self.mean(sum);
            let product = product - mean * drift;
            let conjugate = product / product_before;
            product_before = product;
            let [curvature, sum] = self.sum(|block| block.conjugate(mean, conjugate));
            if !(curvature > 0.0 && product > 0.0) {
                break;
            }
            let step = product / curvature;
            datum += step * self.mean(sum);
            left = self.advance(step, datum);
            self.iterations += 1;
            self.damping = 0.7 * self.damping + 0.3 * step.min(1.2);
            if left.equations <= self.leave * left.bounds || left.largest < NEARLY * wanted * state.scale {
                break;
            }
        }
        left
    }

    /// Moves along the direction and takes stock: roots of the sums of squares, and the largest equation.
    fn advance(&mut self, step: f64, datum: Metre) -> LeftOver {
        let terms = self.terms;
        let sum = self.all(|block| block.advance(step, datum, &terms), LeftOver::and);
        LeftOver { equations: sum.equations.sqrt(), bounds: sum.bounds.sqrt(), ..sum }
    }

    /// Two outer steps without progress: back to a feasible pressure, from which an exact line search lowers the
    /// energy. It makes the iteration safe where the predicted sets cycle.
    /// Returns whether it had to.
    fn safeguard(&mut self, size: f64, approach: Metre) -> bool {
        if size < 0.7 * self.best {
            self.best = size;
            self.strikes = 0;
            self.leave = LEAVE.min(1.5 * self.leave);
            self.caution = (0.5 * self.caution).max(1.0);
            return false;
        }
        self.strikes += 1;
        self.leave = (self.leave / 3.0).max(0.05);
        self.caution *= 4.0;
        if self.strikes < 2 {
            return false;
        }
        self.become_feasible(0.0);
        self.each(Block::recall);
        let mut share = self.line_search(approach);
        if share <= 1e-3 {
            // That way leads nowhere: along the gap of the feasible pressure itself.
            self.each(|block| block.go_back(0.0));
            let datum = self.residual().approach;
            self.step_along_gap(datum);
            share = self.line_search(approach);
        }
        self.each(|block| {
            block.go_back(share);
            block.keep();
            block.forget();
        });
        self.best *= 2.0;
        self.restarts += 1;
        true
    }

    /// The step in [0, 1] from the last feasible pressure to this one at which the energy is least.
    fn line_search(&mut self, approach: Metre) -> f64 {
        let datum = match self.terms.control {
            Control::Load(_) => 0.0,
            Control::Approach(_) => approach,
        };
        let [slope, curvature] = self.sum(|block| block.descent(datum));
        if slope > 0.0 && curvature > 0.0 { (slope / curvature).min(1.0) } else { 0.0 }
    }
}

impl Cells for Iteration<'_> {
    fn sum<const N: usize>(&mut self, terms: impl Fn(Pascal) -> [f64; N] + Sync) -> [f64; N] {
        self.sum(|block| sums(block.pressure_mut(), &terms))
    }

    fn map(&mut self, change: impl Fn(Pascal) -> Pascal + Sync) {
        self.each(|block| block.pressure_mut().iter_mut().for_each(|p| *p = change(*p)));
    }

    fn range(&mut self) -> Range {
        self.all(|block| Range::of(block.pressure_mut()), Range::and)
    }
}

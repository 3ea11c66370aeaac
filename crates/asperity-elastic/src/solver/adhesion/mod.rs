//! The contact of bodies that attract each other across their gap.
//!
//! The lower bound of each pressure is the tension at its gap, which the solution itself determines. Each
//! round solves a contact with the bounds at the gap of the round before. The energy of the attraction is
//! concave, and lies below its tangents: hence each round lowers the energy, and the rounds converge to an
//! equilibrium. Without positive influence between cells in the inverse of the operator, the gaps of all
//! rounds change in one direction, and the equilibrium is the first one that bodies on their way reach.
//! Rounds are slow near an instability. Newton's iteration then continues, with rounds that replace the bounds
//! by the tangents of the tension. A round after which the bodies may have left their path is undone.

mod law;
mod newton;
mod record;
#[cfg(test)]
mod tests;
mod wave_stiffness;

pub use law::{Adhesion, History, Potential, RESOLVED_CELLS};
pub use record::{AdhesionPassRecord, AdhesionRecord};

use std::mem;

use ndarray::Zip;

use crate::error::{Error, Result};
use crate::grid::{CellValues, Field, in_rows};
use crate::operator::Operator;
use crate::solver::{
    Before, Bounds, Control, Interface, InterfaceCost, NormalProblem, Params, Solution, Stats, Watch,
    residual, self_influence, solve_normal_watched,
};
use crate::units::{JoulePerSquareMetre, Metre, Newton, Pascal};
use asperity_base::watch::check_stop;

use newton::NewtonIteration;
use wave_stiffness::WaveStiffness;

/// Tolerance of the contact of a round, as a fraction of the residual of the round before.
const ROUND_TOLERANCE: f64 = 0.2;
/// Largest and smallest tolerance of a round; the smallest is a fraction of the tolerance of the solution.
const ROUND_TOLERANCES: [f64; 2] = [1e-2, 0.3];
/// Residual below which Newton's iteration is attempted. Above it the bodies are on a jump.
const MAX_RESIDUAL: f64 = 0.1;
/// Number of rounds of lagged bounds after an attempt of Newton's iteration that fails. It doubles with each
/// failure, up to a limit.
const ROUNDS_AFTER_FAILURE: [usize; 2] = [2, 16];
/// Factor by which the share of the softening falls after a round without a stable solution.
const SHARE_AFTER_FAILURE: f64 = 0.7;
/// Least share of the softening. Rounds of lagged bounds are cheaper than rounds with a smaller share.
const LEAST_SHARE: f64 = 0.6;
/// Factor by which the omitted part of the softening falls after a round with a solution.
const LEFT_AFTER_SUCCESS: f64 = 0.7;
/// Omitted part of the softening below which the whole softening is used.
const LEAST_LEFT: f64 = 0.03;

/// Solves the frictionless contact of a pair of bodies that attract each other: with the tension σ(g) of the
/// `adhesion`,
///
/// ```text
/// g ≥ 0,   −σ(g) ≤ p,   (p + σ(g)) g = 0   where p is below its `upper` bound;   g = h + C p − δ
/// ```
///
/// Cells in contact have g = 0 and p > −σ(0). The answer is an ordinary solution whose lower bounds are the
/// tensions, so that [`Solution::contact_cells`] and the like keep their meaning. Its residual is that of
/// these equations.
///
/// There may be several equilibria. Bodies that come from afar, without a `last` solution, reach the one with
/// the largest gaps. From the `last` solution, the bodies move on to the next equilibrium that is stable
/// under the `control`; only the gap and the pressure of the `last` solution count. A load may be negative if
/// there is a `last` solution.
///
/// # Errors
/// The errors of [`solve_normal`](crate::solver::solve_normal), [`Error::PullOff`] if no equilibrium carries
/// a load that pulls, and [`Error::Unsupported`] on several ranks.
///
/// # Panics
/// If a field has another shape than the operator's grid.
pub fn solve_adhesive(
    operator: &mut dyn Operator,
    initial_gap: &Field,
    adhesion: &Adhesion,
    upper: &CellValues,
    control: Control,
    last: Option<&Solution>,
    params: &Params,
) -> Result<Solution> {
    let (initial_gap, upper) = (in_rows(initial_gap), upper.clone().in_rows());
    let problem = Problem { initial_gap: &initial_gap, adhesion, upper: &upper, control, params, watch: &() };
    problem.checked(operator)?.solve(operator, last)
}

impl Adhesion {
    /// Cost of a contact with Tabor's parameter from 0.1 to 1, as measured (docs/performance.md). The memory
    /// is that of the directions of a step of Newton's iteration, usually 10 or less and 20 at most, and of
    /// the fields of two states.
    pub const COST: InterfaceCost = InterfaceCost { convolutions: 45.0, work: 3.5, memory: 40.0 };
}

impl Interface for Adhesion {
    fn solve(&self, operator: &mut dyn Operator, problem: &NormalProblem<'_>) -> Result<Solution> {
        let NormalProblem { gap, bounds, control, before, params, watch } = *problem;
        let last = match before {
            Before::Contact(last) => Some(last),
            Before::Apart | Before::Guess(_) => None,
        };
        let upper = bounds.upper();
        let problem = Problem { initial_gap: gap, adhesion: self, upper, control, params, watch };
        problem.checked(operator)?.solve(operator, last)
    }

    fn tension(&self, gap: Metre) -> Pascal {
        self.tension(gap)
    }

    fn energy(&self, gap: Metre) -> JoulePerSquareMetre {
        self.energy(gap)
    }

    fn is_hard(&self) -> bool {
        false
    }

    fn follows_path(&self) -> bool {
        self.history == History::Path
    }

    fn check_combined(&self) -> Result<()> {
        Err(Error::Unsupported(
            "adhesion is not solved together with sliding in place, plastic flow or ranks",
        ))
    }

    fn check_passes(&self, is_shift: bool, displaces: bool, params: &Params) -> Result<()> {
        params.device.only_processor(NOT_ON_A_DEVICE)?;
        if self.follows_path() && !is_shift {
            return Err(Error::Unsupported("adhesion follows the path of the bodies only in a shift"));
        }
        if displaces {
            return Err(Error::Unsupported(
                "adhesion is not solved together with shear that displaces the bodies normally",
            ));
        }
        Ok(())
    }
}

/// Message for a device.
const NOT_ON_A_DEVICE: &str = "a device does not solve adhesive contacts";

/// A contact with adhesion to be solved.
struct Problem<'a> {
    initial_gap: &'a Field,
    adhesion: &'a Adhesion,
    upper: &'a CellValues,
    control: Control,
    params: &'a Params,
    watch: &'a dyn Watch,
}

impl Problem<'_> {
    /// Returns [`Error::Unsupported`] if a device or several ranks are to solve it.
    fn checked(self, operator: &dyn Operator) -> Result<Self> {
        if !operator.slab().is_whole() {
            return Err(Error::Unsupported("adhesion is not solved on several ranks"));
        }
        self.params.device.only_processor(NOT_ON_A_DEVICE)?;
        Ok(self)
    }

    fn solve(&self, operator: &mut dyn Operator, last: Option<&Solution>) -> Result<Solution> {
        let Self { initial_gap, control, params, .. } = *self;
        let tolerance = params.tolerance;
        let influence = self_influence(operator);
        let mut bounds = match last {
            Some(last) => self.bounds_at(&last.gap()),
            None => Bounds::up_to(self.upper.clone()),
        };
        let mut start = last.map(|last| last.pressure.clone());
        let mut stats = Stats::default();
        let mut eta = 1.0;
        let mut attempts = Attempts::new();
        let mut preconditioner = None;
        loop {
            check_stop(self.watch)?;
            if let (Control::Load(load), true) = (control, last.is_some() || stats.iterations > 0) {
                let held = operator.grid().cell_area() * bounds.lower().sum(initial_gap.len());
                if load <= held {
                    return Err(self.pull_off(operator, load, last));
                }
            }
            let of_round = Params { tolerance: self.round_tolerance(eta), ..*params };
            let solution = solve_normal_watched(
                operator,
                initial_gap,
                &bounds,
                control,
                start.as_ref(),
                &of_round,
                self.watch,
            )?;
            stats = stats.and(&solution.stats);
            let gap = solution.gap();
            let next = self.bounds_at(&gap);
            let Solution { pressure, displacement, approach, .. } = &solution;
            let state = residual(pressure, displacement, initial_gap, &next, influence, Some(*approach));
            eta = state.eta.max(solution.residual);
            if eta < tolerance {
                let bounds = self.bounds_of(&solution, &gap, influence);
                return Ok(Solution { bounds, residual: eta, stats, ..solution });
            }
            if stats.convolutions >= params.max_convolutions as f64 {
                return Err(Error::NotConverged { iterations: stats.iterations, residual: eta, tolerance });
            }
            if attempts.is_due() && eta < MAX_RESIDUAL && self.is_smooth() {
                let preconditioner = preconditioner.get_or_insert_with(|| WaveStiffness::new(operator));
                let mut cells = 0..gap.len();
                let change = |cell| bounds.lower().value(cell) - next.lower().value(cell);
                let change = Field::from_shape_simple_fn(gap.raw_dim(), || cells.next().map_or(0.0, change));
                let mut newton = NewtonIteration::new(self, preconditioner, influence, &solution, change);
                let left = newton.solve(operator, &mut attempts)?;
                stats = stats.and(&newton.stats);
                if newton.rounds > 0 {
                    eta = left;
                    bounds = self.bounds_at(&newton.gap());
                    start = Some(newton.state.pressure);
                    continue;
                }
            }
            bounds = next;
            start = Some(solution.pressure);
        }
    }

    /// Returns the residual at which a round ends, from the residual before it.
    fn round_tolerance(&self, eta: f64) -> f64 {
        let [most, least] = ROUND_TOLERANCES;
        (ROUND_TOLERANCE * eta).min(most).max(least * self.params.tolerance)
    }

    /// Returns the bounds of the pressures at a gap.
    fn bounds_at(&self, gap: &Field) -> Bounds {
        Bounds::up_to(self.upper.clone()).above(gap.mapv(|g| -self.adhesion.tension(g)))
    }

    /// Returns the bounds of a solution: the pressure itself on open cells, which differs from their tension
    /// by less than the tolerance, and the largest tension on the cells in contact.
    fn bounds_of(&self, solution: &Solution, gap: &Field, influence: f64) -> Bounds {
        let closed = -self.adhesion.max_tension();
        let lower = Zip::from(&solution.pressure).and(gap).map_collect(|p, g| {
            let is_open = p - g / influence <= -self.adhesion.tension(*g);
            if is_open { p.min(0.0) } else { closed.min(*p) }
        });
        Bounds::up_to(self.upper.clone()).above(lower)
    }

    /// Whether the tension has a derivative.
    fn is_smooth(&self) -> bool {
        self.adhesion.potential == Potential::Exponential
    }

    /// Creates the error for a load that no equilibrium carries. The bodies are drawn apart from their `last`
    /// contact to find the least load that adhesion carries.
    fn pull_off(&self, operator: &mut dyn Operator, load: Newton, last: Option<&Solution>) -> Error {
        match last.map(|last| self.least_load(operator, last)) {
            Some(Ok(least)) => Error::PullOff { load, least },
            Some(Err(error)) => error,
            None => Error::PullOff { load, least: 0.0 },
        }
    }

    /// Returns the least load on the way apart from a contact.
    fn least_load(&self, operator: &mut dyn Operator, last: &Solution) -> Result<Newton> {
        let range = self.adhesion.range;
        let (mut before, mut state, mut step) = (last.clone(), last.clone(), FIRST_STEP * range);
        let mut least = last.load();
        while step > LAST_STEP * range {
            let control = Control::Approach(state.approach - step);
            let next = Problem { control, ..*self }.solve(operator, Some(&state))?;
            if next.load() < state.load() {
                least = least.min(next.load());
                before = mem::replace(&mut state, next);
                step *= STEP_GROWTH;
            } else {
                // The least load may lie before the present state, or between it and the next.
                state = before.clone();
                step *= STEP_REDUCTION;
            }
        }
        Ok(least)
    }
}

/// First step apart in the search for the pull-off force, in ranges of the attraction.
const FIRST_STEP: f64 = 0.5;
/// Step at which the search ends, in ranges.
const LAST_STEP: f64 = 0.01;
/// Factor of the step while the load falls.
const STEP_GROWTH: f64 = 1.4;
/// Factor of the step when the load rises.
const STEP_REDUCTION: f64 = 0.4;

/// Schedule of the rounds of Newton's iteration, and their share of the softening.
struct Attempts {
    /// Rounds of lagged bounds to wait.
    wait: usize,
    /// Rounds to wait after the next failure.
    next: usize,
    /// Share of the softening.
    share: f64,
}

impl Attempts {
    fn new() -> Self {
        let [few, _] = ROUNDS_AFTER_FAILURE;
        Self { wait: 1, next: few, share: 1.0 }
    }

    /// Counts a round of lagged bounds. Returns whether an attempt is due.
    fn is_due(&mut self) -> bool {
        let due = self.wait == 0;
        self.wait = self.wait.saturating_sub(1);
        due
    }

    /// Records a round of Newton's iteration that has a solution.
    fn succeed(&mut self) {
        [self.next, _] = ROUNDS_AFTER_FAILURE;
        let left = LEFT_AFTER_SUCCESS * (1.0 - self.share);
        self.share = if left < LEAST_LEFT { 1.0 } else { 1.0 - left };
    }

    /// Records a round without a stable solution. Returns whether a smaller share of the softening is to be
    /// tried at once.
    fn fail(&mut self) -> bool {
        self.share *= SHARE_AFTER_FAILURE;
        if self.share >= LEAST_SHARE {
            return true;
        }
        self.share = LEAST_SHARE;
        self.wait = self.next;
        let [_, most] = ROUNDS_AFTER_FAILURE;
        self.next = (2 * self.next).min(most);
        false
    }
}

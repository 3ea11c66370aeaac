//! Rounds of Newton's iteration, in which the tension falls with the gap.

use ndarray::Zip;

use crate::error::Result;
use crate::grid::{Field, SingleField, flat, flat_mut};
use crate::math::{Gmres, gmres, parallel};
use crate::operator::Operator;
use crate::solver::adhesion::wave_stiffness::WaveStiffness;
use crate::solver::adhesion::{Adhesion, Attempts, Problem};
use crate::solver::sets::{Set, Sets};
use crate::solver::{Bounds, Control, Params, Solution, Stats, residual};
use crate::units::Metre;
use asperity_base::watch::check_stop;

/// Largest number of steps of a round.
const MAX_STEPS: usize = 12;
/// Number of products with the matrix of a step at which the step counts as one without a stable solution.
const MAX_PRODUCTS: usize = 20;
/// Residual of the equations of a step, as a fraction of their right-hand side.
const STEP_REDUCTION: f64 = 0.3;
/// Largest sum of the differences σ − τ over the gaps that have risen, as a fraction of the sum of all changes of
/// the tension in the round.
const MAX_EXCESS: f64 = 0.05;
/// Largest sum of the changes of the tension that have another sign than in the round before, as a fraction of
/// all changes of that round. If no stable equilibrium is near, the equations of a step lead the bodies back.
const MAX_OPPOSED: f64 = 0.05;
/// Residual of a step above which a round has no solution.
const MAX_STEP_RESIDUAL: f64 = 1e3;
/// Residual at which the iteration ends, as a fraction of the tolerance of the solution.
const LAST_RESIDUAL: f64 = 0.5;

/// Newton's iteration from the solution of a round of lagged bounds. Its rounds replace the constant tension of
/// these bounds by a [`Tangent`]. The contact of a round is solved in steps. With the cells in contact C, capped
/// cells U and open cells O, the equations of a step are
///
/// ```text
/// C: C dp − dδ = −g      U: dp = H − p      O: dp − D (C dp − dδ) = −(p + τ),   D = −dτ/dg
/// ```
///
/// with the tension τ of the round. Under a load Σ dp = 0, and dδ is the mean over C of C dp + g.
pub(super) struct NewtonIteration<'a> {
    problem: &'a Problem<'a>,
    influence: f64,
    preconditioner: &'a mut WaveStiffness,
    sets: Sets,
    /// The state after the last round that has a solution.
    pub(super) state: State,
    /// Change of the tension in the last round.
    change: Field,
    /// Number of rounds that have a solution.
    pub(super) rounds: usize,
    /// Cost so far.
    pub(super) stats: Stats,
}

/// Pressure, displacement and approach.
#[derive(Clone)]
pub(super) struct State {
    pub(super) pressure: Field,
    displacement: Field,
    approach: Metre,
}

/// Tension of a round, which falls by a share θ of the softening from the tension at the gap g₀ of the round
/// before:
///
/// ```text
/// τ(g) = max(0, σ(g₀) + θ σ′(g₀) (g − g₀))
/// ```
///
/// σ is convex. At gaps below g₀, τ is therefore nowhere above σ, and falling gaps do not pass the equilibrium
/// that the bodies reach. Rising gaps do not pass it either if τ is nowhere below σ. For a given θ this limits
/// their rise. With θ = 0 a round is one of lagged bounds, with θ = 1 one of Newton's iteration.
struct Tangent {
    gap: Field,
    /// The tension σ(g₀).
    tension: Field,
    /// The softening −θ σ′(g₀).
    softening: Field,
}

impl Tangent {
    fn new(adhesion: &Adhesion, gap: Field, share: f64) -> Self {
        let gap = gap.mapv_into(|g| g.max(0.0));
        let tension = gap.mapv(|g| adhesion.tension(g));
        let softening = gap.mapv(|g| share * adhesion.softening(g));
        Self { gap, tension, softening }
    }

    /// Returns the tension τ at a gap.
    fn tension(&self, gap: &Field) -> Field {
        let Self { gap: before, tension, softening } = self;
        Zip::from(gap)
            .and(before)
            .and(tension)
            .and(softening)
            .map_collect(|g, before, tension, softening| (tension + softening * (before - g)).max(0.0))
    }

    /// Returns the change of σ in a round that ends at this `gap` with the tension τ, after a `change` in the
    /// round before. Returns `None` if the bodies may have left their path.
    fn change_of_round(
        &self,
        adhesion: &Adhesion,
        gap: &Field,
        tau: &Field,
        change: &Field,
    ) -> Option<Field> {
        let sigma = gap.mapv(|g| adhesion.tension(g));
        let cells = Zip::from(gap).and(&self.gap).and(&sigma).and(tau);
        let excess = cells.fold(0.0, |sum, g, before, sigma, tau| {
            sum + if g > before { (sigma - tau).max(0.0) } else { 0.0 }
        });
        let now = sigma - &self.tension;
        let opposed = Zip::from(&now)
            .and(change)
            .fold(0.0, |sum, now: &f64, before| sum + if now * before < 0.0 { now.abs() } else { 0.0 });
        let [size, size_before] = [&now, change].map(|change| change.iter().map(|s| s.abs()).sum::<f64>());
        (excess <= MAX_EXCESS * size && opposed <= MAX_OPPOSED * size_before).then_some(now)
    }
}

/// Linear equations of a step, cell by cell.
struct Step {
    /// Under load control, a change of the pressures with the sum 1: the preconditioned unit displacement of
    /// the cells in contact.
    unit: Option<SingleField>,
    /// D of the open cells.
    softening: SingleField,
}

impl<'a> NewtonIteration<'a> {
    /// Creates the iteration from the solution of a round of lagged bounds with this change of the tension.
    pub(super) fn new(
        problem: &'a Problem<'a>,
        preconditioner: &'a mut WaveStiffness,
        influence: f64,
        from: &Solution,
        change: Field,
    ) -> Self {
        let Solution { grid, pressure, displacement, approach, .. } = from;
        let (pressure, displacement) = (pressure.clone(), displacement.clone());
        Self {
            problem,
            influence,
            preconditioner,
            sets: Sets::new(grid.shape),
            state: State { pressure, displacement, approach: *approach },
            change,
            rounds: 0,
            stats: Stats::default(),
        }
    }

    /// Performs rounds until the bodies are in equilibrium, or until rounds have no stable solution. Returns
    /// the residual of the last state.
    pub(super) fn solve(&mut self, operator: &mut dyn Operator, attempts: &mut Attempts) -> Result<f64> {
        let Params { tolerance, max_convolutions, .. } = *self.problem.params;
        loop {
            let gap = self.gap();
            let eta = self.residual(&self.problem.bounds_at(&gap));
            if eta < LAST_RESIDUAL * tolerance || self.stats.convolutions >= max_convolutions as f64 {
                return Ok(eta);
            }
            let before = self.state.clone();
            let tangent = Tangent::new(self.problem.adhesion, gap, attempts.share);
            if self.round(operator, &tangent, self.problem.round_tolerance(eta))? {
                self.rounds += 1;
                attempts.succeed();
                continue;
            }
            self.state = before;
            if !attempts.fail() {
                return Ok(eta);
            }
        }
    }

    /// Returns the gap.
    pub(super) fn gap(&self) -> Field {
        self.problem.initial_gap + &self.state.displacement - self.state.approach
    }

    /// Solves the contact of a round to this residual. Returns false if it has no stable solution, or if the
    /// bodies may have left their path.
    fn round(&mut self, operator: &mut dyn Operator, tangent: &Tangent, residual: f64) -> Result<bool> {
        for _ in 0..MAX_STEPS {
            check_stop(self.problem.watch)?;
            let gap = self.gap();
            let tension = tangent.tension(&gap);
            let bounds = Bounds::up_to(self.problem.upper.clone()).above(-&tension);
            let eta = self.residual(&bounds);
            if eta < residual {
                let adhesion = self.problem.adhesion;
                let change = tangent.change_of_round(adhesion, &gap, &tension, &self.change);
                return Ok(change.map(|change| self.change = change).is_some());
            }
            let (pressure, gaps, stiffness) = (flat(&self.state.pressure), flat(&gap), 1.0 / self.influence);
            self.sets.assign(|cells| cells.map(|cell| pressure[cell] - gaps[cell] * stiffness), &bounds);
            let floats = matches!(self.problem.control, Control::Load(_)) && self.sets.free_cells() == 0;
            // A residual that is not a number is too large, too.
            let diverges = eta > MAX_STEP_RESIDUAL || eta.is_nan();
            if floats || diverges || !self.step(operator, &gap, &tension, tangent) {
                return Ok(false);
            }
        }
        Ok(false)
    }

    /// Returns the residual η within these bounds.
    fn residual(&self, bounds: &Bounds) -> f64 {
        let State { pressure, displacement, approach } = &self.state;
        let gap = self.problem.initial_gap;
        residual(pressure, displacement, gap, bounds, self.influence, Some(*approach)).eta
    }

    /// Performs a step. Its equations are solved in single precision, and the displacement of the solution is
    /// computed in double precision. Returns false if the step has no stable solution.
    fn step(&mut self, operator: &mut dyn Operator, gap: &Field, tension: &Field, tangent: &Tangent) -> bool {
        let shape = gap.raw_dim();
        let unit = matches!(self.problem.control, Control::Load(_)).then(|| {
            let mut unit = SingleField::zeros(shape);
            let sum = self.preconditioner.apply(&self.sets, |_| 1.0, &mut unit);
            unit.mapv_inplace(|p| (f64::from(p) / sum) as f32);
            unit
        });
        let step = Step { unit, softening: self.softening(tangent, tension) };
        let right = self.right(&step, tension, gap);
        let (mut change, mut response) = (SingleField::zeros(shape), SingleField::zeros(shape));
        let product = |unknowns: &[f32]| {
            self.change(&step, unknowns, &mut change);
            operator.apply_single(&change, &mut response);
            self.left(&step, &change, &response)
        };
        let Gmres { solution, products, is_positive } = gmres(product, right, STEP_REDUCTION, MAX_PRODUCTS);
        self.stats.iterations += products;
        self.stats.convolutions += products as f64;
        if !is_positive || products == MAX_PRODUCTS {
            return false;
        }
        self.change(&step, &solution, &mut change);
        if !change.iter().all(|p| p.is_finite()) {
            return false;
        }
        let mut change = change.mapv(f64::from);
        if let Some(unit) = &step.unit {
            // Rounding must not change the load.
            let sum = change.sum();
            change.zip_mut_with(unit, |p, unit| *p -= sum * f64::from(*unit));
        }
        let mut response = Field::zeros(shape);
        operator.apply(&change, &mut response);
        self.stats.convolutions += 1.0;
        self.state.pressure += &change;
        self.state.displacement += &response;
        if step.unit.is_some() {
            response += gap;
            self.state.approach += self.mean_in_contact(flat(&response));
        }
        true
    }

    /// Returns D of the open cells with this tension.
    fn softening(&self, tangent: &Tangent, tension: &Field) -> SingleField {
        let bands = self.sets.bands();
        let mut softening = SingleField::zeros(tension.raw_dim());
        let parts = bands.cut_mut(flat_mut(&mut softening)).zip(bands.cut(self.sets.by_cell()));
        let parts = parts.zip(bands.cut(flat(&tangent.softening))).zip(bands.cut(flat(tension)));
        parallel::map(parts, |(((softening, sets), from), tension)| {
            for (((d, set), from), tension) in softening.iter_mut().zip(sets).zip(from).zip(tension) {
                *d = if *set == Set::Lower && *tension > 0.0 { *from as f32 } else { 0.0 };
            }
        });
        softening
    }

    /// Returns the right-hand side of the equations.
    fn right(&self, step: &Step, tension: &Field, gap: &Field) -> Vec<f32> {
        let (bands, influence) = (self.sets.bands(), self.influence);
        let upper = self.problem.upper;
        // The approach changes by the mean gap first; the open cells follow.
        let mean = if step.unit.is_some() { self.mean_in_contact(flat(gap)) } else { 0.0 };
        let mut right = vec![0.0; gap.len()];
        let parts = bands.cut_mut(&mut right).zip(bands.cut(self.sets.by_cell())).zip(bands.cut(flat(gap)));
        let parts = parts.zip(bands.cut(flat(&self.state.pressure))).zip(bands.cut(flat(&step.softening)));
        let parts = parts.zip(bands.cut(flat(tension))).enumerate();
        parallel::map(parts, |(band, (((((right, sets), gap), pressure), softening), tension))| {
            let cells =
                right.iter_mut().zip(sets).zip(gap).zip(pressure).zip(softening).zip(tension).enumerate();
            for (cell, (((((right, set), g), p), d), tension)) in cells {
                let value = match set {
                    Set::Free => mean - g,
                    Set::Upper => influence * (upper.value(bands.first(band) + cell) - p),
                    Set::Lower => -influence * (p + tension + f64::from(*d) * mean),
                };
                *right = value as f32;
            }
        });
        right
    }

    /// Computes the change of the pressures for preconditioned unknowns.
    fn change(&mut self, step: &Step, unknowns: &[f32], change: &mut SingleField) {
        let contact = self.preconditioner.apply(&self.sets, |cell| unknowns[cell], change);
        let (bands, stiffness) = (self.sets.bands(), (1.0 / self.influence) as f32);
        let parts =
            bands.cut_mut(flat_mut(change)).zip(bands.cut(unknowns)).zip(bands.cut(self.sets.by_cell()));
        let others = parallel::map(parts, |((change, unknowns), sets)| {
            let mut sum = 0.0;
            for ((p, y), set) in change.iter_mut().zip(unknowns).zip(sets) {
                if *set != Set::Free {
                    *p = y * stiffness;
                    sum += f64::from(*p);
                }
            }
            sum
        });
        if let Some(unit) = &step.unit {
            let sum = (contact + others.iter().sum::<f64>()) as f32;
            let parts = bands.cut_mut(flat_mut(change)).zip(bands.cut(flat(unit)));
            parallel::map(parts, |(change, unit)| {
                change.iter_mut().zip(unit).for_each(|(p, unit)| *p -= sum * unit);
            });
        }
    }

    /// Returns the left-hand side of the equations for a change of the pressures and its response.
    fn left(&self, step: &Step, change: &SingleField, response: &SingleField) -> Vec<f32> {
        let mean = if step.unit.is_some() { self.mean_in_contact(flat(response)) as f32 } else { 0.0 };
        let (bands, influence) = (self.sets.bands(), self.influence as f32);
        let mut left = vec![0.0; change.len()];
        let parts = bands.cut_mut(&mut left).zip(bands.cut(self.sets.by_cell())).zip(bands.cut(flat(change)));
        let parts = parts.zip(bands.cut(flat(response))).zip(bands.cut(flat(&step.softening)));
        parallel::map(parts, |((((left, sets), change), response), softening)| {
            let cells = left.iter_mut().zip(sets).zip(change).zip(response).zip(softening);
            for ((((left, set), p), u), d) in cells {
                *left = match set {
                    Set::Free => u - mean,
                    Set::Upper => influence * p,
                    Set::Lower => influence * (p - d * (u - mean)),
                };
            }
        });
        left
    }

    /// Returns the mean of some values over the cells in contact.
    fn mean_in_contact<T: Copy + Into<f64> + Sync>(&self, values: &[T]) -> f64 {
        let parts = self.sets.bands().cut(values).zip(self.sets.in_bands());
        let sums =
            parallel::map(parts, |(values, free)| free.cells().map(|cell| values[cell].into()).sum::<f64>());
        sums.iter().sum::<f64>() / self.sets.free_cells() as f64
    }
}

//! Newton's iteration for contact and attraction at once.

use std::mem;

use crate::error::Result;
use crate::grid::{Field, SingleField, flat, flat_mut};
use crate::math::{Gmres, gmres, parallel};
use crate::operator::Operator;
use crate::solver::adhesion::Problem;
use crate::solver::adhesion::forecast::Forecast;
use crate::solver::preconditioner::Preconditioner;
use crate::solver::sets::{Set, Sets};
use crate::solver::{Control, Solution, Stats, residual};
use crate::units::Metre;
use asperity_base::watch::check_stop;

/// Largest number of steps.
const MAX_STEPS: usize = 12;
/// Largest number of products with the matrix of a step.
const MAX_PRODUCTS: usize = 60;
/// A step makes progress if its residual is below this fraction of the smallest so far.
const PROGRESS: f64 = 0.7;
/// Number of steps without progress after which the iteration is given up.
const MAX_STAGNATIONS: usize = 4;
/// Residual at which the iteration ends, as a fraction of the tolerance of the solution.
const LAST_RESIDUAL: f64 = 0.5;
/// Residual from which on the matrix of a step is that of the equilibrium.
const CLOSE: f64 = 1e-2;
/// Largest reduction of the residual that a step aims at.
const MAX_REDUCTION: f64 = 0.1;

/// The unknowns of the iteration: pressure, displacement and approach. With the cells in contact C, capped
/// cells U and open cells O, the equations of a step are
///
/// ```text
/// C: C dp − dδ = −g      U: dp = H − p      O: dp − D (C dp − dδ) = −(p + σ),   D = −dσ/dg
/// ```
///
/// Under a load Σ dp = 0, and dδ is the mean over C of C dp + g.
pub(super) struct NewtonIteration<'a> {
    problem: &'a Problem<'a>,
    influence: f64,
    pressure: Field,
    displacement: Field,
    approach: Metre,
    preconditioner: Preconditioner,
    sets: Sets,
    /// Whether the last steps show no negative eigenvalue: a stable equilibrium has none.
    is_stable: bool,
    /// Cost so far.
    pub(super) stats: Stats,
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
    /// Begins at the solution of a round.
    pub(super) fn new(
        operator: &dyn Operator,
        problem: &'a Problem<'a>,
        influence: f64,
        from: &Solution,
    ) -> Self {
        let shape = operator.grid().shape;
        Self {
            problem,
            influence,
            pressure: from.pressure.clone(),
            displacement: from.displacement.clone(),
            approach: from.approach,
            preconditioner: Preconditioner::new(operator),
            sets: Sets::new(shape),
            is_stable: true,
            stats: Stats::default(),
        }
    }

    /// Returns pressure and gap of the stable equilibrium that the iteration finds, if the rounds lead there.
    pub(super) fn solve(
        &mut self,
        operator: &mut dyn Operator,
        forecast: &Forecast,
    ) -> Result<Option<(Field, Field)>> {
        let tolerance = LAST_RESIDUAL * self.problem.params.tolerance;
        let (mut best, mut stagnations) = (f64::INFINITY, 0);
        for _ in 0..MAX_STEPS {
            check_stop(self.problem.watch)?;
            let gap = self.problem.initial_gap + &self.displacement - self.approach;
            let bounds = self.problem.bounds_at(&gap);
            let state = residual(
                &self.pressure,
                &self.displacement,
                self.problem.initial_gap,
                &bounds,
                self.influence,
                Some(self.approach),
            );
            if state.eta < tolerance {
                let is_right = self.is_stable && forecast.leads_to(&gap);
                return Ok(is_right.then(|| (mem::take(&mut self.pressure), gap)));
            }
            if forecast.is_beyond(&gap) {
                return Ok(None);
            }
            if state.eta < PROGRESS * best {
                (best, stagnations) = (state.eta, 0);
            } else {
                stagnations += 1;
            }
            if stagnations > MAX_STAGNATIONS {
                return Ok(None);
            }
            let (pressure, gaps, stiffness) = (flat(&self.pressure), flat(&gap), 1.0 / self.influence);
            self.sets.assign(|cells| cells.map(|cell| pressure[cell] - gaps[cell] * stiffness), &bounds);
            if matches!(self.problem.control, Control::Load(_)) && self.sets.free_cells() == 0 {
                return Ok(None);
            }
            self.preconditioner.adapt(&self.sets);
            self.is_stable |= state.eta > CLOSE;
            let aim = (tolerance / state.eta).max(state.eta.sqrt().min(MAX_REDUCTION));
            if !self.step(operator, &gap, aim) {
                return Ok(None);
            }
        }
        Ok(None)
    }

    /// Performs a step whose equations hold to a fraction `aim` of their right-hand side. They are solved in
    /// single precision, and the displacement of the solution is computed in double precision. Returns false
    /// if the step has no solution.
    fn step(&mut self, operator: &mut dyn Operator, gap: &Field, aim: f64) -> bool {
        let shape = gap.raw_dim();
        let unit = matches!(self.problem.control, Control::Load(_)).then(|| {
            let mut unit = SingleField::zeros(shape);
            let [sum, ..] = self.preconditioner.apply(&self.sets, |_| 1.0, flat_mut(&mut unit));
            unit.mapv_inplace(|p| (f64::from(p) / sum) as f32);
            unit
        });
        let step = Step { unit, softening: self.softening(gap) };
        let right = self.right(&step, gap);
        let (mut change, mut response) = (SingleField::zeros(shape), SingleField::zeros(shape));
        let product = |unknowns: &[f32]| {
            self.change(&step, unknowns, &mut change);
            operator.apply_single(&change, &mut response);
            self.left(&step, &change, &response)
        };
        let Gmres { solution, products, is_positive } = gmres(product, right, aim, MAX_PRODUCTS);
        self.is_stable &= is_positive;
        self.change(&step, &solution, &mut change);
        self.stats.iterations += products;
        self.stats.convolutions += (products + 1) as f64;
        if !change.iter().all(|p| p.is_finite()) {
            return false;
        }
        let mut change = change.mapv(f64::from);
        if let Some(unit) = &step.unit {
            // The load does not change by the rounding.
            let sum = change.sum();
            change.zip_mut_with(unit, |p, unit| *p -= sum * f64::from(*unit));
        }
        let mut response = Field::zeros(shape);
        operator.apply(&change, &mut response);
        self.pressure += &change;
        self.displacement += &response;
        if step.unit.is_some() {
            response += gap;
            self.approach += self.mean_in_contact(flat(&response));
        }
        true
    }

    /// Returns D of the open cells.
    fn softening(&self, gap: &Field) -> SingleField {
        let (bands, adhesion) = (self.sets.bands(), self.problem.adhesion);
        let mut softening = SingleField::zeros(gap.raw_dim());
        let parts = bands.cut_mut(flat_mut(&mut softening)).zip(bands.cut(flat(gap)));
        parallel::map(parts.zip(bands.cut(self.sets.by_cell())), |((softening, gap), sets)| {
            let open = softening.iter_mut().zip(gap).zip(sets).filter(|(_, set)| **set == Set::Lower);
            open.for_each(|((d, g), _)| *d = adhesion.softening(*g) as f32);
        });
        softening
    }

    /// Returns the right-hand side of the equations.
    fn right(&self, step: &Step, gap: &Field) -> Vec<f32> {
        let (bands, influence) = (self.sets.bands(), self.influence);
        let Problem { adhesion, upper, .. } = self.problem;
        // The approach changes by the mean gap first; the open cells follow.
        let mean = if step.unit.is_some() { self.mean_in_contact(flat(gap)) } else { 0.0 };
        let mut right = vec![0.0; gap.len()];
        let parts = bands.cut_mut(&mut right).zip(bands.cut(self.sets.by_cell())).zip(bands.cut(flat(gap)));
        let parts = parts.zip(bands.cut(flat(&self.pressure))).zip(bands.cut(flat(&step.softening)));
        parallel::map(parts.enumerate(), |(band, ((((right, sets), gap), pressure), softening))| {
            let cells = right.iter_mut().zip(sets).zip(gap).zip(pressure).zip(softening).enumerate();
            for (cell, ((((right, set), g), p), d)) in cells {
                let value = match set {
                    Set::Free => mean - g,
                    Set::Upper => influence * (upper.value(bands.first(band) + cell) - p),
                    Set::Lower => -influence * (p + adhesion.tension(*g) + f64::from(*d) * mean),
                };
                *right = value as f32;
            }
        });
        right
    }

    /// Computes the change of the pressures for preconditioned unknowns.
    fn change(&mut self, step: &Step, unknowns: &[f32], change: &mut SingleField) {
        let [contact, ..] = self.preconditioner.apply(&self.sets, |cell| unknowns[cell], flat_mut(change));
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

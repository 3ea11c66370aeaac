//! Newton's iteration for contact and attraction at once.

use std::mem;

use crate::error::Result;
use crate::grid::{Field, SingleField};
use crate::math::{Gmres, gmres};
use crate::operator::Operator;
use crate::solver::adhesive::Problem;
use crate::solver::adhesive::forecast::Forecast;
use crate::solver::preconditioner::Preconditioner;
use crate::solver::sets::{Set, Sets};
use crate::solver::watch::check_stop;
use crate::solver::{Control, Solution, Stats, residual};
use crate::units::Metre;

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

/// The unknowns of the iteration: pressure, displacement and approach. With the cells in contact C, capped cells U and open cells O,
/// the equations of a step are
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
    single: SingleField,
    preconditioned: SingleField,
    /// Whether the last steps show no negative eigenvalue: a stable equilibrium has none.
    is_stable: bool,
    /// Cost so far.
    pub(super) stats: Stats,
}

/// Linear equations of a step, cell by cell.
struct Step {
    /// Under load control, a change of the pressures with the sum 1: the preconditioned unit displacement of the cells in contact.
    unit: Option<Field>,
    /// D of the open cells.
    softening: Field,
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
            single: SingleField::zeros(shape),
            preconditioned: SingleField::zeros(shape),
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
            let (pressure, stiffness) = (&self.pressure, 1.0 / self.influence);
            let flat = |field: &'_ Field, cell: usize| field.as_slice().expect("standard layout")[cell];
            self.sets.assign(
                |cells| cells.map(|cell| flat(pressure, cell) - flat(&gap, cell) * stiffness),
                &bounds,
            );
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

    /// Performs a step whose equations hold to a fraction `aim` of their right-hand side. Returns false if the step has no solution in
    /// double precision.
    fn step(&mut self, operator: &mut dyn Operator, gap: &Field, aim: f64) -> bool {
        let shape = gap.raw_dim();
        let (adhesion, influence) = (self.problem.adhesion, self.influence);
        let mut cells = self.sets.of().iter().zip(gap);
        let softening = Field::from_shape_simple_fn(shape, || {
            let (set, g) = cells.next().expect("a cell");
            if *set == Set::Lower { adhesion.softening(*g) } else { 0.0 }
        });
        let unit = matches!(self.problem.control, Control::Load(_)).then(|| {
            let mut unit = self.on_contact(&Field::ones(shape));
            unit /= unit.sum();
            unit
        });
        let step = Step { unit, softening };
        let upper = self.problem.upper;
        let mut right: Vec<f64> = self
            .sets
            .of()
            .iter()
            .zip(gap)
            .zip(&self.pressure)
            .enumerate()
            .map(|(cell, ((set, g), p))| match set {
                Set::Free => -g,
                Set::Upper => influence * (upper.at(cell) - p),
                Set::Lower => -influence * (p + adhesion.tension(*g)),
            })
            .collect();
        if step.unit.is_some() {
            let mean = self.mean_in_contact(&right);
            let of = self.sets.of().iter().zip(&step.softening);
            // The approach changes by the mean gap first; the open cells follow.
            right.iter_mut().zip(of).for_each(|(r, (set, d))| match set {
                Set::Free => *r -= mean,
                Set::Lower => *r += influence * d * mean,
                Set::Upper => {}
            });
        }
        let mut response = Field::zeros(shape);
        let product = |v: &[f64]| {
            let change = self.change(&step, v);
            operator.apply(&change, &mut response);
            self.left(&step, &change, &response)
        };
        let Gmres { solution, products, is_positive } = gmres(product, right, aim, MAX_PRODUCTS);
        self.is_stable &= is_positive;
        let change = self.change(&step, &solution);
        operator.apply(&change, &mut response);
        self.stats.iterations += products;
        self.stats.convolutions += (products + 1) as f64;
        if !change.iter().all(|p| p.is_finite()) {
            return false;
        }
        self.pressure += &change;
        self.displacement += &response;
        if step.unit.is_some() {
            let gaps = (&response + gap).into_iter().collect::<Vec<_>>();
            self.approach += self.mean_in_contact(&gaps);
        }
        true
    }

    /// Returns the change of the pressures for preconditioned unknowns.
    fn change(&mut self, step: &Step, unknowns: &[f64]) -> Field {
        let shape = self.pressure.raw_dim();
        let unknowns = Field::from_shape_vec(shape, unknowns.to_vec()).expect("an unknown for each cell");
        let mut change = self.on_contact(&unknowns);
        let cells = change.iter_mut().zip(&unknowns).zip(self.sets.of());
        cells.filter(|(_, set)| **set != Set::Free).for_each(|((p, y), _)| *p = y / self.influence);
        if let Some(unit) = &step.unit {
            let sum = change.sum();
            change.scaled_add(-sum, unit);
        }
        change
    }

    /// Returns the left-hand side of the equations for a change of the pressures and its response.
    fn left(&self, step: &Step, change: &Field, response: &Field) -> Vec<f64> {
        let mean = match step.unit {
            Some(_) => self.mean_in_contact(response.as_slice().expect("standard layout")),
            None => 0.0,
        };
        let cells = self.sets.of().iter().zip(change).zip(response).zip(&step.softening);
        let left = cells.map(|(((set, p), u), d)| match set {
            Set::Free => u - mean,
            Set::Upper => self.influence * p,
            Set::Lower => self.influence * (p - d * (u - mean)),
        });
        left.collect()
    }

    /// Returns the mean of some values over the cells in contact.
    fn mean_in_contact(&self, values: &[f64]) -> f64 {
        let cells = values.iter().zip(self.sets.of()).filter(|(_, set)| **set == Set::Free);
        cells.map(|(value, _)| value).sum::<f64>() / self.sets.free_cells() as f64
    }

    /// Applies the preconditioner of the contact to the cells in contact; the others are 0.
    fn on_contact(&mut self, values: &Field) -> Field {
        let Self { sets, preconditioner, single, preconditioned, .. } = self;
        let cells = single.iter_mut().zip(values).zip(sets.of());
        cells.for_each(|((r, value), set)| *r = if *set == Set::Free { *value as f32 } else { 0.0 });
        let [r, z] = [&mut *single, &mut *preconditioned].map(|f| f.as_slice_mut().expect("standard layout"));
        z.fill(0.0);
        preconditioner.apply(sets, r, z);
        preconditioned.mapv(f64::from)
    }
}

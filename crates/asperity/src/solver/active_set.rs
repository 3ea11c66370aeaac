//! Conjugate gradients on a predicted active set, with the projection onto the bounds deferred and folded into a
//! preconditioned step, so that every convolution advances the answer.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::operator::Operator;
use crate::solver::bounds::shift_for_sum;
use crate::solver::preconditioner::Preconditioner;
use crate::solver::{Control, Problem, Residual, Solution, Stats};

/// The conjugate gradients are left when the residual on the free cells is below so many times the violation of
/// the bounds: more would be spent on a set that is about to change.
const LEAVE: f64 = 3.0;
/// Conjugate gradient steps on one active set, at the most.
const MOST_INNER: usize = 60;
/// The equations are met when they are below so much of what is asked of the answer, which is taken at its bounds.
const NEARLY: f64 = 0.9;
/// Radius, in cells, within which the effect of lifted cells is foreseen without a convolution.
const FORESIGHT: usize = 4;

/// Residual η below which rounding in the displacement, kept up by recurrence, would count.
const ROUNDING: f64 = 1e-9;

/// Solves from `start` (uniform pressure, or the interference under approach control, where there is none), to the
/// `tolerance` on η that belongs to a state.
pub(super) fn solve(
    operator: &mut dyn Operator,
    problem: &Problem,
    start: Option<&Field>,
    tolerance: impl Fn(&Residual) -> f64,
    max_convolutions: usize,
) -> Result<Solution> {
    let mut iteration = Iteration::new(operator, problem, start);
    let mut sharpen = 1.0;
    loop {
        let mut state = iteration.residual();
        let mut wanted = tolerance(&state);
        if state.eta < sharpen * wanted {
            // The answer is the feasible pressure nearby; its own residual decides.
            if wanted < ROUNDING || !problem.is_feasible(&iteration.pressure) {
                iteration.become_feasible();
                state = iteration.residual();
                wanted = tolerance(&state);
            }
            if state.eta < wanted {
                return Ok(iteration.into_solution(state));
            }
            sharpen *= 0.3;
        }
        if iteration.stats.convolutions as usize >= max_convolutions {
            return Err(Error::NotConverged {
                iterations: iteration.stats.iterations,
                residual: state.eta,
                tolerance: wanted,
            });
        }
        iteration.outer_step(state, sharpen * wanted);
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Set {
    Zero,
    Free,
    Hardness,
}

struct Iteration<'a, 'b> {
    operator: &'a mut dyn Operator,
    problem: &'a Problem<'b>,
    preconditioner: Preconditioner,
    /// Current pressure, possibly a little outside its bounds, and its displacement.
    pressure: Field,
    displacement: Field,
    /// The last feasible pressure and its displacement, from which the energy only falls.
    feasible: (Field, Field),
    sets: Vec<Set>,
    /// Flat indices of the free cells, increasing.
    free: Vec<u32>,
    /// Scratch: a direction and its response.
    direction: Field,
    response: Field,
    /// Scratch at the free cells: what is left of their equations, and a step to meet them.
    equations: Vec<f64>,
    step: Vec<f64>,
    /// Influence coefficients up to [`FORESIGHT`] cells away.
    near: Field,
    leave: f64,
    /// Running mean of the step length: the damping of the folded step.
    damping: f64,
    /// How much stiffer than its own diagonal a cell is taken to be when the sets are predicted.
    caution: f64,
    best: f64,
    strikes: usize,
    stats: Stats,
}

impl<'a, 'b> Iteration<'a, 'b> {
    fn new(operator: &'a mut dyn Operator, problem: &'a Problem<'b>, start: Option<&Field>) -> Self {
        let gap = problem.initial_gap;
        let mut pressure = match (start, problem.control) {
            (Some(start), _) => start.clone(),
            (None, Control::Load(load)) => {
                Field::from_elem(gap.raw_dim(), load / problem.cell_area / gap.len() as f64)
            }
            (None, Control::Approach(approach)) => {
                gap.mapv(|h| 0.3 * (approach - h) / problem.self_influence)
            }
        };
        problem.make_feasible(&mut pressure);
        let zeros = Field::zeros(gap.raw_dim());
        let reach = operator.grid().shape.map(|n| FORESIGHT.min((n - 1) / 2) + 1);
        let near = Field::from_shape_fn(reach, |(i, j)| operator.influence(i, j));
        let mut iteration = Self {
            preconditioner: Preconditioner::new(operator),
            operator,
            problem,
            displacement: zeros.clone(),
            feasible: (zeros.clone(), zeros.clone()),
            sets: vec![Set::Zero; gap.len()],
            free: Vec::new(),
            direction: zeros.clone(),
            response: zeros,
            equations: Vec::new(),
            step: Vec::new(),
            near,
            leave: LEAVE,
            damping: 0.8,
            caution: 1.0,
            best: f64::INFINITY,
            strikes: 0,
            stats: Stats::default(),
            pressure,
        };
        iteration.respond();
        if let Control::Approach(approach) = problem.control {
            iteration.scale_to_least_energy(approach);
        }
        iteration.feasible = (iteration.pressure.clone(), iteration.displacement.clone());
        iteration
    }

    fn respond(&mut self) {
        self.operator.apply(&self.pressure, &mut self.displacement);
        self.stats.convolutions += 1.0;
    }

    /// Moves by `step` times the direction, in the pressure and its displacement.
    fn advance(&mut self, step: f64) {
        self.pressure.scaled_add(step, &self.direction);
        self.displacement.scaled_add(step, &self.response);
    }

    fn respond_to_direction(&mut self) {
        self.operator.apply(&self.direction, &mut self.response);
        self.stats.convolutions += 1.0;
    }

    /// Under approach control a guess is only as good as its size: the multiple of least energy, at no cost.
    fn scale_to_least_energy(&mut self, approach: f64) {
        let (mut work, mut twice_energy) = (0.0, 0.0);
        ndarray::Zip::from(&self.pressure).and(&self.displacement).and(self.problem.initial_gap).for_each(
            |p, u, h| {
                work += p * (approach - h);
                twice_energy += p * u;
            },
        );
        if twice_energy > 0.0 {
            let factor = (work / twice_energy).clamp(0.0, 1.0);
            self.pressure *= factor;
            self.displacement *= factor;
        }
    }

    fn residual(&self) -> Residual {
        self.problem.residual(&self.pressure, &self.displacement)
    }

    /// The feasible pressure nearby, at the cost of a convolution.
    fn become_feasible(&mut self) {
        self.problem.make_feasible(&mut self.pressure);
        self.respond();
    }

    fn into_solution(self, state: Residual) -> Solution {
        Solution {
            pressure: self.pressure,
            displacement: self.displacement,
            approach: state.approach,
            residual: state.eta,
            stats: self.stats,
        }
    }

    fn outer_step(&mut self, state: Residual, tolerance: f64) {
        self.predict_sets(state.approach);
        if self.free.is_empty() {
            self.become_feasible();
            self.step_along_gap(state.approach);
            return;
        }
        self.preconditioner.adapt(&self.free, |cell| self.sets[cell] == Set::Free);
        self.lift_to_bounds(state.approach);
        let residual = self.conjugate_gradients(state, tolerance);
        self.safeguard(residual, state.approach);
    }

    /// Every cell at a bound and no equilibrium: one step along the gap frees some.
    fn step_along_gap(&mut self, approach: f64) {
        let c0 = self.problem.self_influence;
        ndarray::Zip::from(&mut self.pressure)
            .and(&self.displacement)
            .and(self.problem.initial_gap)
            .for_each(|p, u, h| *p += 0.5 * (approach - h - u) / c0);
        self.become_feasible();
    }

    /// Cells are predicted at a bound where one diagonal Newton step takes them there. Under load control its datum is
    /// the one at which the pressures of the step, in their bounds, bear the load.
    fn predict_sets(&mut self, approach: f64) {
        let Problem { initial_gap, hardness, self_influence: c0, .. } = *self.problem;
        let (p, u, h) = (flat(&self.pressure), flat(&self.displacement), flat(initial_gap));
        let stiffness = 1.0 / (self.caution * c0);
        let step = p.iter().zip(u).zip(h).map(|((p, u), h)| p + (approach - h - u) * stiffness);
        let shift = match self.problem.pressure_sum() {
            Some(wanted) => shift_for_sum(step.clone(), hardness, wanted),
            None => 0.0,
        };
        self.free.clear();
        for (cell, (step, set)) in step.zip(&mut self.sets).enumerate() {
            *set = match step + shift {
                p if p <= 0.0 => Set::Zero,
                p if p >= hardness => Set::Hardness,
                _ => Set::Free,
            };
            if *set == Set::Free {
                self.free.push(cell as u32);
            }
        }
    }

    /// Takes the cells at a bound there, and the free cells one preconditioned step further, in one convolution.
    fn lift_to_bounds(&mut self, approach: f64) {
        if !self.direct_to_bounds() {
            return;
        }
        self.foresee();
        let (u, h) = (flat(&self.displacement), flat(self.problem.initial_gap));
        let foreseen = flat(&self.response);
        self.equations.resize(self.free.len(), 0.0);
        self.step.resize(self.free.len(), 0.0);
        for (r, &cell) in self.equations.iter_mut().zip(&self.free) {
            let cell = cell as usize;
            *r = approach - h[cell] - u[cell] - foreseen[cell];
        }
        self.precondition();
        let direction = self.direction.as_slice_mut().expect("standard layout");
        self.free.iter().zip(&self.step).for_each(|(&cell, z)| direction[cell as usize] = self.damping * z);
        if let Control::Load(_) = self.problem.control {
            self.keep_the_sum();
        }
        self.respond_to_direction();
        self.advance(1.0);
        self.settle_at_bounds();
    }

    /// Sets the direction to what takes the cells at a bound there; whether there is anything to move.
    fn direct_to_bounds(&mut self) -> bool {
        let hardness = self.problem.hardness;
        let direction = self.direction.as_slice_mut().expect("standard layout");
        let mut any = false;
        for ((d, set), p) in direction.iter_mut().zip(&self.sets).zip(flat(&self.pressure)) {
            *d = match set {
                Set::Zero => -p,
                Set::Hardness => hardness - p,
                Set::Free => 0.0,
            };
            any |= *d != 0.0;
        }
        any
    }

    /// The direction must not change the load: the free cells take up the difference, in proportion.
    fn keep_the_sum(&mut self) {
        let hardness = self.problem.hardness;
        let excess = self.direction.sum();
        let p = flat(&self.pressure);
        let bearing: f64 = self.free.iter().map(|&cell| p[cell as usize].clamp(0.0, hardness)).sum();
        let direction = self.direction.as_slice_mut().expect("standard layout");
        for &cell in &self.free {
            let share = if bearing > 0.0 {
                p[cell as usize].clamp(0.0, hardness) / bearing
            } else {
                1.0 / self.free.len() as f64
            };
            direction[cell as usize] -= excess * share;
        }
    }

    /// Exactly at the bounds, whatever the rounding of the sum.
    fn settle_at_bounds(&mut self) {
        let p = self.pressure.as_slice_mut().expect("standard layout");
        for (p, set) in p.iter_mut().zip(&self.sets) {
            match set {
                Set::Zero => *p = 0.0,
                Set::Hardness => *p = self.problem.hardness,
                Set::Free => {}
            }
        }
    }

    /// Response to the direction within [`FORESIGHT`] cells of where it is not zero, without a convolution.
    fn foresee(&mut self) {
        let shape = self.operator.grid().shape;
        let reach = [self.near.nrows() - 1, self.near.ncols() - 1];
        self.response.fill(0.0);
        for ((ix, iy), &pressure) in self.direction.indexed_iter().filter(|(_, d)| **d != 0.0) {
            for i in ix.saturating_sub(reach[0])..shape[0].min(ix + reach[0] + 1) {
                for j in iy.saturating_sub(reach[1])..shape[1].min(iy + reach[1] + 1) {
                    self.response[[i, j]] += self.near[[i.abs_diff(ix), j.abs_diff(iy)]] * pressure;
                }
            }
        }
    }

    /// `step = M equations`, both without their mean under load control.
    fn precondition(&mut self) {
        project(self.problem, &mut self.equations);
        self.preconditioner.apply(&self.equations, &mut self.step);
        project(self.problem, &mut self.step);
    }

    /// Preconditioned conjugate gradients on the free cells until the bounds are violated more than the equations.
    /// Returns the size of what is left, of the equations and the bounds together.
    fn conjugate_gradients(&mut self, state: Residual, tolerance: f64) -> f64 {
        self.equations.resize(self.free.len(), 0.0);
        self.step.resize(self.free.len(), 0.0);
        self.direction.fill(0.0);
        let mut left = self.left_over(state.approach);
        let mut product_before = f64::INFINITY;
        for _ in 0..MOST_INNER {
            self.precondition();
            let product = dot(&self.equations, &self.step);
            let conjugate = product / product_before;
            product_before = product;
            let direction = self.direction.as_slice_mut().expect("standard layout");
            for (&cell, z) in self.free.iter().zip(&self.step) {
                let d = &mut direction[cell as usize];
                *d = z + conjugate * *d;
            }
            self.respond_to_direction();
            let curvature = dot(flat(&self.direction), flat(&self.response));
            if !(curvature > 0.0 && product > 0.0) {
                break;
            }
            let step = product / curvature;
            self.advance(step);
            self.stats.iterations += 1;
            self.damping = 0.7 * self.damping + 0.3 * step.min(1.2);
            left = self.left_over(state.approach);
            if left.equations <= self.leave * left.bounds || left.largest < NEARLY * tolerance * state.scale {
                break;
            }
        }
        left.equations.hypot(left.bounds)
    }

    /// Takes stock: the equations at the free cells, and how far the bounds are violated.
    fn left_over(&mut self, approach: f64) -> LeftOver {
        let Problem { initial_gap, hardness, self_influence: c0, .. } = *self.problem;
        let (p, u, h) = (flat(&self.pressure), flat(&self.displacement), flat(initial_gap));
        let datum = match self.problem.control {
            Control::Approach(_) => approach,
            Control::Load(_) => {
                let sum: f64 = self.free.iter().map(|&cell| h[cell as usize] + u[cell as usize]).sum();
                sum / self.free.len() as f64
            }
        };
        let mut left = LeftOver { equations: 0.0, bounds: 0.0, largest: 0.0 };
        let mut equations = self.equations.iter_mut();
        for (cell, set) in self.sets.iter().enumerate() {
            let w = datum - h[cell] - u[cell];
            let violation = match set {
                Set::Zero => w.max(0.0),
                Set::Hardness => w.min(0.0),
                Set::Free => {
                    *equations.next().expect("one for each free cell") = w;
                    left.equations += w * w;
                    left.largest = left.largest.max(w.abs());
                    c0 * (p[cell] - p[cell].clamp(0.0, hardness))
                }
            };
            left.bounds += violation * violation;
        }
        LeftOver { equations: left.equations.sqrt(), bounds: left.bounds.sqrt(), ..left }
    }

    /// Two outer steps without progress: back to a feasible pressure, from which an exact line search lowers the
    /// energy. It makes the iteration safe where the predicted sets cycle.
    fn safeguard(&mut self, size: f64, approach: f64) {
        if size < 0.7 * self.best {
            self.best = size;
            self.strikes = 0;
            self.leave = LEAVE.min(1.5 * self.leave);
            self.caution = (0.5 * self.caution).max(1.0);
            return;
        }
        self.strikes += 1;
        self.leave = (self.leave / 3.0).max(0.05);
        self.caution *= 4.0;
        if self.strikes < 2 {
            return;
        }
        self.become_feasible();
        let mut step = self.line_search(approach);
        if step <= 1e-3 {
            let (p, u) = &self.feasible;
            let datum = self.problem.residual(p, u).approach;
            self.pressure.assign(p);
            self.displacement.assign(u);
            self.step_along_gap(datum);
            step = self.line_search(approach);
        }
        let (p, u) = &mut self.feasible;
        ndarray::Zip::from(&mut *p).and(&mut self.pressure).for_each(|from, to| {
            *from += step * (*to - *from);
            *to = *from;
        });
        ndarray::Zip::from(&mut *u).and(&mut self.displacement).for_each(|from, to| {
            *from += step * (*to - *from);
            *to = *from;
        });
        self.best *= 2.0;
        self.stats.restarts += 1;
    }

    /// The step in [0, 1] from the last feasible pressure to this one at which the energy is least.
    fn line_search(&self, approach: f64) -> f64 {
        let datum = match self.problem.control {
            Control::Load(_) => 0.0,
            Control::Approach(_) => approach,
        };
        let (p, u) = &self.feasible;
        let (mut slope, mut curvature) = (0.0, 0.0);
        let cells = flat(p)
            .iter()
            .zip(flat(u))
            .zip(flat(&self.pressure))
            .zip(flat(&self.displacement))
            .zip(flat(self.problem.initial_gap));
        for ((((p, u), target), response), h) in cells {
            slope += (datum - h - u) * (target - p);
            curvature += (target - p) * (response - u);
        }
        if slope > 0.0 && curvature > 0.0 { (slope / curvature).min(1.0) } else { 0.0 }
    }
}

/// What a set of free cells leaves undone, as displacements: root of the sum of squares of w at the free cells, of
/// the violations of the bounds, and the largest w.
struct LeftOver {
    equations: f64,
    bounds: f64,
    largest: f64,
}

/// Under load control directions keep the sum: the mean over the free cells is taken out.
fn project(problem: &Problem, values: &mut [f64]) {
    if let Control::Load(_) = problem.control {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        values.iter_mut().for_each(|v| *v -= mean);
    }
}

fn flat(field: &Field) -> &[f64] {
    field.as_slice().expect("standard layout")
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

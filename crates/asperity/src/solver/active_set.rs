//! Conjugate gradients on a predicted active set, with the projection onto the bounds deferred and folded into a
//! preconditioned step, so that every convolution advances the answer.

use crate::error::{Error, Result};
use crate::grid::{Field, SingleField};
use crate::math::sum::sums;
use crate::operator::Operator;
use crate::solver::bounds::shift_for_sum;
use crate::solver::preconditioner::Preconditioner;
use crate::solver::sets::{Set, Sets};
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
/// Error of a displacement in single precision, of its largest value.
const SINGLE: f64 = 4e-7;
/// What single precision leaves in the displacement may be so much of the residual that is wanted.
const TRUSTED: f64 = 0.1;

/// Solves from `start` (uniform pressure, or the interference under approach control, where there is none), to the
/// `tolerance` on η that belongs to a state.
pub(super) fn solve(
    operator: &mut dyn Operator,
    problem: &Problem,
    start: Option<Field>,
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
            let trusted = TRUSTED * wanted * state.scale;
            if iteration.rounding > trusted || !problem.is_feasible(&iteration.pressure) {
                iteration.become_feasible(trusted);
                state = iteration.residual();
                wanted = tolerance(&state);
            }
            if state.eta + iteration.rounding / state.scale < wanted {
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

/// Pressure and displacement are kept in double precision. What moves them from step to step, directions and their
/// responses, is computed in single, which is as good as long as the steps are small against what they correct; the
/// error that this leaves in the displacement is kept count of, and the displacement computed afresh, in double,
/// where it could be felt.
struct Iteration<'a, 'b> {
    operator: &'a mut dyn Operator,
    problem: &'a Problem<'b>,
    preconditioner: Preconditioner,
    /// Current pressure, possibly a little outside its bounds, and its displacement.
    pressure: Field,
    displacement: Field,
    /// Bound on the error of the displacement by single precision.
    rounding: f64,
    /// The last feasible pressure, from which the energy only falls.
    feasible: Field,
    sets: Sets,
    /// Scratch: a direction and its response.
    direction: SingleField,
    response: SingleField,
    /// What is left of the equations of the free cells, and a step to meet them; zero elsewhere.
    equations: SingleField,
    step: SingleField,
    /// Influence coefficients up to [`FORESIGHT`] cells away: 0, 1 … along x, … −1, 0, 1 … along y.
    near: SingleField,
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
    fn new(operator: &'a mut dyn Operator, problem: &'a Problem<'b>, start: Option<Field>) -> Self {
        let gap = problem.initial_gap;
        let mut pressure = match (start, problem.control) {
            (Some(start), _) => start,
            (None, Control::Load(load)) => {
                Field::from_elem(gap.raw_dim(), load / problem.cell_area / gap.len() as f64)
            }
            (None, Control::Approach(approach)) => {
                gap.mapv(|h| 0.3 * (approach - h) / problem.self_influence)
            }
        };
        problem.make_feasible(&mut pressure);
        let shape = operator.grid().shape;
        let reach = shape.map(|n| FORESIGHT.min((n - 1) / 2));
        let mut iteration = Self {
            preconditioner: Preconditioner::new(operator),
            problem,
            displacement: Field::zeros(shape),
            rounding: 0.0,
            feasible: Field::zeros(shape),
            sets: Sets::new(shape),
            direction: SingleField::zeros(shape),
            response: SingleField::zeros(shape),
            equations: SingleField::zeros(shape),
            step: SingleField::zeros(shape),
            near: SingleField::from_shape_fn([reach[0] + 1, 2 * reach[1] + 1], |(i, j)| {
                operator.influence(i, j.abs_diff(reach[1])) as f32
            }),
            operator,
            leave: LEAVE,
            damping: 0.8,
            caution: 1.0,
            best: f64::INFINITY,
            strikes: 0,
            stats: Stats::default(),
            pressure,
        };
        iteration.respond_in_single();
        if let Control::Approach(approach) = problem.control {
            iteration.scale_to_least_energy(approach);
        }
        iteration.feasible.assign(&iteration.pressure);
        iteration
    }

    /// The displacement of the whole pressure.
    fn respond(&mut self) {
        self.operator.apply(&self.pressure, &mut self.displacement);
        self.stats.convolutions += 1.0;
        self.rounding = 0.0;
    }

    fn respond_in_single(&mut self) {
        self.direction.zip_mut_with(&self.pressure, |d, p| *d = *p as f32);
        self.respond_to_direction();
        self.displacement.zip_mut_with(&self.response, |u, r| *u = f64::from(*r));
        self.rounding = SINGLE * largest(&self.response);
    }

    fn respond_to_direction(&mut self) {
        self.operator.apply_single(&self.direction, &mut self.response);
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

    /// The feasible pressure nearby, at the cost of a convolution: in single precision where `trusted` is more than
    /// what that leaves in the displacement.
    fn become_feasible(&mut self, trusted: f64) {
        self.problem.make_feasible(&mut self.pressure);
        let largest = self.displacement.iter().fold(0.0f64, |m, u| m.max(u.abs()));
        if SINGLE * largest < trusted { self.respond_in_single() } else { self.respond() }
    }

    fn into_solution(self, state: Residual) -> Solution {
        Solution {
            pressure: self.pressure,
            displacement: self.displacement,
            approach: state.approach,
            residual: state.eta + self.rounding / state.scale,
            stats: self.stats,
        }
    }

    fn outer_step(&mut self, state: Residual, wanted: f64) {
        self.predict_sets(state.approach);
        if self.sets.free().len() == 0 {
            self.become_feasible(0.0);
            self.step_along_gap(state.approach);
            return;
        }
        self.preconditioner.adapt(&self.sets);
        self.lift_to_bounds(state.approach, TRUSTED * wanted * state.scale);
        let left = self.conjugate_gradients(state, wanted);
        self.restore_the_sum();
        self.safeguard(left, state.approach);
    }

    /// Every cell at a bound and no equilibrium: one step along the gap frees some.
    fn step_along_gap(&mut self, approach: f64) {
        let c0 = self.problem.self_influence;
        ndarray::Zip::from(&mut self.pressure)
            .and(&self.displacement)
            .and(self.problem.initial_gap)
            .for_each(|p, u, h| *p += 0.5 * (approach - h - u) / c0);
        self.become_feasible(0.0);
    }

    /// Cells are predicted at a bound where one diagonal Newton step takes them there. Under load control its datum is
    /// the one at which the pressures of the step, in their bounds, bear the load.
    fn predict_sets(&mut self, approach: f64) {
        let Problem { initial_gap, hardness, self_influence: c0, .. } = *self.problem;
        let (p, u, h) = (flat(&self.pressure), flat(&self.displacement), flat(initial_gap));
        let stiffness = 1.0 / (self.caution * c0);
        let newton = p.iter().zip(u).zip(h).map(|((p, u), h)| p + (approach - h - u) * stiffness);
        let shift = match self.problem.pressure_sum() {
            Some(wanted) => {
                let kept = flat_mut(&mut self.response);
                kept.iter_mut().zip(newton.clone()).for_each(|(kept, p)| *kept = p as f32);
                shift_for_sum(kept, hardness, wanted)
            }
            None => 0.0,
        };
        self.sets.assign(newton.map(|p| p + shift), hardness);
        self.equations.fill(0.0);
    }

    /// Takes the cells at a bound there, and the free cells one preconditioned step further, in one convolution: of the
    /// step, or where single precision has left more than is `trusted`, of the whole pressure in double.
    fn lift_to_bounds(&mut self, approach: f64, trusted: f64) {
        if !self.direct_to_bounds() {
            return;
        }
        self.foresee();
        let (u, h) = (flat(&self.displacement), flat(self.problem.initial_gap));
        let foreseen = flat(&self.response);
        let equations = flat_mut(&mut self.equations);
        let mut sum = 0.0;
        for cell in self.sets.free() {
            let w = approach - h[cell] - u[cell] - f64::from(foreseen[cell]);
            sum += w;
            equations[cell] = w as f32;
        }
        if let Control::Load(_) = self.problem.control {
            let mean = (sum / self.sets.free().len() as f64) as f32;
            self.sets.free().for_each(|cell| equations[cell] -= mean);
        }
        let Preconditioned { mean, .. } = self.precondition();
        let step = flat(&self.step);
        let direction = flat_mut(&mut self.direction);
        self.sets.free().for_each(|cell| direction[cell] = self.damping as f32 * (step[cell] - mean));
        if let Control::Load(_) = self.problem.control {
            self.keep_the_sum();
        }
        let afresh = self.rounding > trusted;
        if !afresh {
            self.respond_to_direction();
            self.displacement.zip_mut_with(&self.response, |u, r| *u += f64::from(*r));
            self.rounding += SINGLE * largest(&self.response);
        }
        self.pressure.zip_mut_with(&self.direction, |p, d| *p += f64::from(*d));
        self.settle_at_bounds();
        if afresh {
            self.restore_the_sum();
            self.respond();
        }
    }

    /// Sets the direction to what takes the cells at a bound there; whether there is anything to move.
    fn direct_to_bounds(&mut self) -> bool {
        let hardness = self.problem.hardness;
        let mut any = false;
        let cells = flat_mut(&mut self.direction).iter_mut().zip(self.sets.of()).zip(flat(&self.pressure));
        for ((d, set), p) in cells {
            let distance = match set {
                Set::Zero => -p,
                Set::Hardness => hardness - p,
                Set::Free => 0.0,
            };
            any |= distance != 0.0;
            *d = distance as f32;
        }
        any
    }

    /// The direction must not change the load: the free cells take up the difference, in proportion.
    fn keep_the_sum(&mut self) {
        let hardness = self.problem.hardness;
        let p = flat(&self.pressure);
        let direction = flat_mut(&mut self.direction);
        let [excess] = sums(direction, |d| [f64::from(d)]);
        let bearing: f64 = self.sets.free().map(|cell| p[cell].clamp(0.0, hardness)).sum();
        let cells = self.sets.free().len() as f64;
        for cell in self.sets.free() {
            let share = if bearing > 0.0 { p[cell].clamp(0.0, hardness) / bearing } else { 1.0 / cells };
            direction[cell] -= (excess * share) as f32;
        }
    }

    /// Exactly at the bounds, whatever the rounding of the sum.
    fn settle_at_bounds(&mut self) {
        for (p, set) in flat_mut(&mut self.pressure).iter_mut().zip(self.sets.of()) {
            match set {
                Set::Zero => *p = 0.0,
                Set::Hardness => *p = self.problem.hardness,
                Set::Free => {}
            }
        }
    }

    /// Exactly the load, whatever the rounding of the directions: what they have left of it is in the order of what
    /// they have left in the displacement.
    fn restore_the_sum(&mut self) {
        let Some(wanted) = self.problem.pressure_sum() else { return };
        let shift = (wanted - self.pressure.sum()) / self.sets.free().len() as f64;
        let p = flat_mut(&mut self.pressure);
        self.sets.free().for_each(|cell| p[cell] += shift);
    }

    /// Response to the direction within [`FORESIGHT`] cells of where it is not zero, without a convolution.
    fn foresee(&mut self) {
        let [nx, ny] = self.operator.grid().shape;
        let reach = [self.near.nrows() - 1, self.near.ncols() / 2];
        self.response.fill(0.0);
        let response = flat_mut(&mut self.response);
        for (cell, &pressure) in flat(&self.direction).iter().enumerate().filter(|(_, d)| **d != 0.0) {
            let (ix, iy) = (cell / ny, cell % ny);
            let (first, last) = (iy.saturating_sub(reach[1]), ny.min(iy + reach[1] + 1));
            for i in ix.saturating_sub(reach[0])..nx.min(ix + reach[0] + 1) {
                let near = self.near.row(i.abs_diff(ix)).to_slice().expect("rows are contiguous");
                let near = &near[first + reach[1] - iy..];
                let row = &mut response[i * ny..][first..last];
                row.iter_mut().zip(near).for_each(|(u, influence)| *u += influence * pressure);
            }
        }
    }

    /// `step = M equations`.
    fn precondition(&mut self) -> Preconditioned {
        let (r, z) = (flat(&self.equations), flat_mut(&mut self.step));
        self.preconditioner.apply(&self.sets, r, z);
        let (mut sum, mut product, mut drift) = (0.0, 0.0, 0.0);
        for cell in self.sets.free() {
            let (r, z) = (f64::from(r[cell]), f64::from(z[cell]));
            sum += z;
            product += r * z;
            drift += r;
        }
        match self.problem.control {
            Control::Approach(_) => Preconditioned { mean: 0.0, product },
            Control::Load(_) => {
                let mean = sum / self.sets.free().len() as f64;
                Preconditioned { mean: mean as f32, product: product - mean * drift }
            }
        }
    }

    /// Preconditioned conjugate gradients on the free cells until the bounds are violated more than the equations.
    /// Returns the size of what is left, of the equations and the bounds together.
    fn conjugate_gradients(&mut self, state: Residual, wanted: f64) -> f64 {
        self.direction.fill(0.0);
        let cells = self.sets.free().len() as f64;
        let mut datum = match self.problem.control {
            Control::Approach(approach) => approach,
            Control::Load(_) => {
                let (u, h) = (flat(&self.displacement), flat(self.problem.initial_gap));
                self.sets.free().map(|cell| h[cell] + u[cell]).sum::<f64>() / cells
            }
        };
        let mut left = self.advance(0.0, datum);
        let mut product_before = f64::INFINITY;
        for _ in 0..MOST_INNER {
            let Preconditioned { mean, product } = self.precondition();
            let conjugate = (product / product_before) as f32;
            product_before = product;
            let (z, d) = (flat(&self.step), flat_mut(&mut self.direction));
            self.sets.free().for_each(|cell| d[cell] = z[cell] - mean + conjugate * d[cell]);
            self.respond_to_direction();
            let (d, c) = (flat(&self.direction), flat(&self.response));
            let (mut curvature, mut sum, mut largest) = (0.0, 0.0, 0.0f32);
            for cell in self.sets.free() {
                curvature += f64::from(d[cell]) * f64::from(c[cell]);
                sum += f64::from(c[cell]);
                largest = if c[cell].abs() > largest { c[cell].abs() } else { largest };
            }
            if !(curvature > 0.0 && product > 0.0) {
                break;
            }
            let step = product / curvature;
            if let Control::Load(_) = self.problem.control {
                datum += step * sum / cells;
            }
            left = self.advance(step, datum);
            self.rounding += SINGLE * step * f64::from(largest);
            self.stats.iterations += 1;
            self.damping = 0.7 * self.damping + 0.3 * step.min(1.2);
            if left.equations <= self.leave * left.bounds || left.largest < NEARLY * wanted * state.scale {
                break;
            }
        }
        left.equations.hypot(left.bounds)
    }

    /// Moves by `step` times the direction, in the pressure and its displacement, and takes stock: the equations at
    /// the free cells, where the gap is to close at `datum`, and how far the bounds are violated.
    fn advance(&mut self, step: f64, datum: f64) -> LeftOver {
        let Problem { initial_gap, hardness, self_influence: c0, .. } = *self.problem;
        let mut left = LeftOver { equations: 0.0, bounds: 0.0, largest: 0.0 };
        let cells =
            self.sets.of().iter().zip(flat(initial_gap)).zip(flat(&self.direction)).zip(flat(&self.response));
        let cells = cells.zip(flat_mut(&mut self.pressure)).zip(flat_mut(&mut self.displacement));
        for ((((((set, h), d), c), p), u), r) in cells.zip(flat_mut(&mut self.equations)) {
            *u += step * f64::from(*c);
            let w = datum - h - *u;
            let violation = match set {
                Set::Zero => w.max(0.0),
                Set::Hardness => w.min(0.0),
                Set::Free => {
                    *p += step * f64::from(*d);
                    *r = w as f32;
                    left.equations += w * w;
                    left.largest = left.largest.max(w.abs());
                    c0 * (*p - p.clamp(0.0, hardness))
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
        self.become_feasible(0.0);
        let mut before = Field::zeros(self.feasible.raw_dim());
        self.operator.apply(&self.feasible, &mut before);
        self.stats.convolutions += 1.0;
        let mut step = self.line_search(&before, approach);
        if step <= 1e-3 {
            let datum = self.problem.residual(&self.feasible, &before).approach;
            self.pressure.assign(&self.feasible);
            self.displacement.assign(&before);
            self.step_along_gap(datum);
            step = self.line_search(&before, approach);
        }
        ndarray::Zip::from(&mut self.pressure).and(&mut self.feasible).for_each(|to, from| {
            *to = *from + step * (*to - *from);
            *from = *to;
        });
        self.displacement.zip_mut_with(&before, |to, from| *to = from + step * (*to - from));
        self.best *= 2.0;
        self.stats.restarts += 1;
    }

    /// The step in [0, 1] from the last feasible pressure, with the displacement `before`, to this one at which the
    /// energy is least.
    fn line_search(&self, before: &Field, approach: f64) -> f64 {
        let datum = match self.problem.control {
            Control::Load(_) => 0.0,
            Control::Approach(_) => approach,
        };
        let (mut slope, mut curvature) = (0.0, 0.0);
        let cells = flat(&self.feasible)
            .iter()
            .zip(flat(before))
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

/// A preconditioned step z, and what conjugate directions need of it: its mean over the free cells, which under load
/// control is to be taken out, and its product with the equations without that mean.
struct Preconditioned {
    mean: f32,
    product: f64,
}

/// What a set of free cells leaves undone, as displacements: root of the sum of squares of w at the free cells, of
/// the violations of the bounds, and the largest w.
struct LeftOver {
    equations: f64,
    bounds: f64,
    largest: f64,
}

fn largest(field: &SingleField) -> f64 {
    f64::from(field.iter().fold(0.0f32, |m, u| if u.abs() > m { u.abs() } else { m }))
}

fn flat<T>(field: &ndarray::Array2<T>) -> &[T] {
    field.as_slice().expect("standard layout")
}

fn flat_mut<T>(field: &mut ndarray::Array2<T>) -> &mut [T] {
    field.as_slice_mut().expect("standard layout")
}

//! Conjugate gradients on a predicted active set, with the projection onto the bounds deferred and folded into a
//! preconditioned step, so that every convolution advances the answer.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::operator::Operator;
use crate::solver::preconditioner::Preconditioner;
use crate::solver::{Control, Params, Problem, Residual, Solution, Stats};

/// The conjugate gradients are left when the residual on the free cells is below so many times the violation of
/// the bounds: more would be spent on a set that is about to change.
const LEAVE: f64 = 3.0;
/// Conjugate gradient steps on one active set, at the most.
const MOST_INNER: usize = 60;
/// Radius, in cells, within which the effect of lifted cells is foreseen without a convolution.
const FORESIGHT: usize = 4;

/// Solves from `start` (uniform pressure, or the interference under approach control, where there is none).
pub(super) fn solve(
    operator: &mut dyn Operator,
    problem: &Problem,
    start: Option<&Field>,
    params: &Params,
) -> Result<Solution> {
    let mut iteration = Iteration::new(operator, problem, start);
    let mut target = params.tolerance;
    loop {
        let state = problem.residual(&iteration.pressure, &iteration.displacement);
        if state.eta < target {
            // The answer is the feasible pressure nearby; its own residual decides.
            let (pressure, displacement) = iteration.feasible_nearby();
            let state = problem.residual(&pressure, &displacement);
            if state.eta < params.tolerance {
                return Ok(Solution {
                    pressure,
                    displacement,
                    approach: state.approach,
                    residual: state.eta,
                    stats: iteration.stats,
                });
            }
            (iteration.pressure, iteration.displacement) = (pressure, displacement);
            target *= 0.3;
        }
        if iteration.stats.convolutions as usize >= params.max_convolutions {
            return Err(Error::NotConverged {
                iterations: iteration.stats.iterations,
                residual: state.eta,
                tolerance: params.tolerance,
            });
        }
        let state = problem.residual(&iteration.pressure, &iteration.displacement);
        iteration.outer_step(state, target);
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
            leave: LEAVE,
            damping: 0.8,
            caution: 1.0,
            best: f64::INFINITY,
            strikes: 0,
            stats: Stats::default(),
            pressure,
        };
        iteration.displacement = iteration.respond(&iteration.pressure.clone());
        if let Control::Approach(approach) = problem.control {
            iteration.scale_to_least_energy(approach);
        }
        iteration.feasible = (iteration.pressure.clone(), iteration.displacement.clone());
        iteration
    }

    fn respond(&mut self, pressure: &Field) -> Field {
        let mut displacement = Field::zeros(pressure.raw_dim());
        self.operator.apply(pressure, &mut displacement);
        self.stats.convolutions += 1.0;
        displacement
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

    fn feasible_nearby(&mut self) -> (Field, Field) {
        let mut pressure = self.pressure.clone();
        self.problem.make_feasible(&mut pressure);
        let displacement = self.respond(&pressure);
        (pressure, displacement)
    }

    fn outer_step(&mut self, state: Residual, tolerance: f64) {
        self.stats.iterations += 1;
        self.predict_sets(state.approach);
        if self.free.is_empty() {
            (self.pressure, self.displacement) = self.feasible_nearby();
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
        (self.pressure, self.displacement) = self.feasible_nearby();
    }

    /// Cells are predicted at a bound where one diagonal Newton step takes them there.
    fn predict_sets(&mut self, approach: f64) {
        let Problem { initial_gap, hardness, self_influence: c0, .. } = *self.problem;
        let (p, u, h) = (flat(&self.pressure), flat(&self.displacement), flat(initial_gap));
        self.free.clear();
        for cell in 0..p.len() {
            let step = p[cell] + (approach - h[cell] - u[cell]) / (self.caution * c0);
            self.sets[cell] = if step <= 0.0 && p[cell] < hardness {
                Set::Zero
            } else if step >= hardness && p[cell] > 0.0 {
                Set::Hardness
            } else {
                self.free.push(cell as u32);
                Set::Free
            };
        }
    }

    /// Takes the cells at a bound there, and the free cells one preconditioned step further, in one convolution.
    fn lift_to_bounds(&mut self, approach: f64) {
        let hardness = self.problem.hardness;
        let mut moved = Vec::new();
        let direction = self.direction.as_slice_mut().expect("standard layout");
        direction.fill(0.0);
        for (cell, (&set, &p)) in self.sets.iter().zip(flat(&self.pressure)).enumerate() {
            let lift = match set {
                Set::Zero => -p,
                Set::Hardness => hardness - p,
                Set::Free => 0.0,
            };
            if lift != 0.0 {
                direction[cell] = lift;
                moved.push((cell, lift));
            }
        }
        if moved.is_empty() {
            return;
        }
        let (u, h) = (flat(&self.displacement), flat(self.problem.initial_gap));
        let foreseen = near_response(self.operator, &moved);
        let mut residual: Vec<f64> = self
            .free
            .iter()
            .map(|&cell| approach - h[cell as usize] - u[cell as usize] - foreseen[cell as usize])
            .collect();
        self.project(&mut residual);
        let mut step = vec![0.0; residual.len()];
        self.preconditioner.apply(&residual, &mut step);
        self.project(&mut step);
        let direction = self.direction.as_slice_mut().expect("standard layout");
        self.free.iter().zip(&step).for_each(|(&cell, z)| direction[cell as usize] = self.damping * z);
        if let Control::Load(_) = self.problem.control {
            // The lift must not change the load: the free cells take up the difference, in proportion.
            let excess: f64 = direction.iter().sum();
            let p = flat(&self.pressure);
            let bearing: f64 = self.free.iter().map(|&cell| p[cell as usize].clamp(0.0, hardness)).sum();
            for &cell in &self.free {
                let share = if bearing > 0.0 {
                    p[cell as usize].clamp(0.0, hardness) / bearing
                } else {
                    1.0 / self.free.len() as f64
                };
                direction[cell as usize] -= excess * share;
            }
        }
        self.operator.apply(&self.direction, &mut self.response);
        self.stats.convolutions += 1.0;
        self.pressure += &self.direction;
        self.displacement += &self.response;
        // Exactly at the bounds, whatever the rounding of the sum.
        let p = self.pressure.as_slice_mut().expect("standard layout");
        for (cell, _) in moved {
            p[cell] = if self.sets[cell] == Set::Hardness { hardness } else { 0.0 };
        }
    }

    /// Under load control directions keep the sum: the mean over the free cells is taken out.
    fn project(&self, values: &mut [f64]) {
        if let Control::Load(_) = self.problem.control {
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            values.iter_mut().for_each(|v| *v -= mean);
        }
    }

    /// Preconditioned conjugate gradients on the free cells until the bounds are violated more than the equations.
    /// Returns the size of what is left, of the equations and the bounds together.
    fn conjugate_gradients(&mut self, state: Residual, tolerance: f64) -> f64 {
        let Problem { initial_gap, hardness, self_influence: c0, .. } = *self.problem;
        let load_controlled = matches!(self.problem.control, Control::Load(_));
        let n = self.free.len();
        let mut residual = vec![0.0; n];
        let mut z = vec![0.0; n];
        let mut conjugate: Vec<f64> = Vec::new();
        let mut product_before = 1.0;
        let (h, mut inner) = (flat(initial_gap), 0);
        self.direction.fill(0.0);
        {
            let u = flat(&self.displacement);
            for (r, &cell) in residual.iter_mut().zip(&self.free) {
                *r = state.approach - h[cell as usize] - u[cell as usize];
            }
        }
        self.project(&mut residual);
        let mut size_before = f64::INFINITY;
        loop {
            self.preconditioner.apply(&residual, &mut z);
            self.project(&mut z);
            let product: f64 = residual.iter().zip(&z).map(|(r, z)| r * z).sum();
            if conjugate.is_empty() {
                conjugate.clone_from(&z);
            } else {
                let beta = product / product_before;
                conjugate.iter_mut().zip(&z).for_each(|(d, z)| *d = z + beta * *d);
            }
            product_before = product;
            let direction = self.direction.as_slice_mut().expect("standard layout");
            self.free.iter().zip(&conjugate).for_each(|(&cell, d)| direction[cell as usize] = *d);
            self.operator.apply(&self.direction, &mut self.response);
            self.stats.convolutions += 1.0;
            let response = flat(&self.response);
            let curvature: f64 =
                self.free.iter().zip(&conjugate).map(|(&c, d)| response[c as usize] * d).sum();
            if !(curvature > 0.0 && product > 0.0) {
                return size_before;
            }
            let step = product / curvature;
            self.pressure.scaled_add(step, &self.direction);
            self.displacement.scaled_add(step, &self.response);
            self.damping = 0.7 * self.damping + 0.3 * step.min(1.2);
            inner += 1;

            let (p, u) = (flat(&self.pressure), flat(&self.displacement));
            let mut mean = state.approach;
            if load_controlled {
                mean =
                    self.free.iter().map(|&cell| h[cell as usize] + u[cell as usize]).sum::<f64>() / n as f64;
            }
            let (mut equations, mut bounds, mut largest) = (0.0, 0.0, 0.0f64);
            for (r, &cell) in residual.iter_mut().zip(&self.free) {
                let cell = cell as usize;
                *r = mean - h[cell] - u[cell];
                equations += *r * *r;
                largest = largest.max(r.abs());
                let outside = c0 * (p[cell] - p[cell].clamp(0.0, hardness));
                bounds += outside * outside;
            }
            for (cell, set) in self.sets.iter().enumerate() {
                let w = mean - h[cell] - u[cell];
                let wrong = match set {
                    Set::Zero => w.max(0.0),
                    Set::Hardness => w.min(0.0),
                    Set::Free => 0.0,
                };
                bounds += wrong * wrong;
            }
            let (equations, bounds) = (equations.sqrt(), bounds.sqrt());
            size_before = equations.hypot(bounds);
            if equations <= self.leave * bounds
                || largest < 0.3 * tolerance * state.scale
                || inner >= MOST_INNER
            {
                return size_before;
            }
        }
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
        let (mut target, mut response) = self.feasible_nearby();
        let mut step = self.line_search(&target, &response, approach);
        if step <= 1e-3 {
            let (p, u) = &self.feasible;
            let datum = self.problem.residual(p, u).approach;
            target.assign(p);
            ndarray::Zip::from(&mut target).and(u).and(self.problem.initial_gap).for_each(|p, u, h| {
                *p += 0.5 * (datum - h - u) / self.problem.self_influence;
            });
            self.problem.make_feasible(&mut target);
            response = self.respond(&target);
            step = self.line_search(&target, &response, approach);
        }
        let (p, u) = &mut self.feasible;
        ndarray::Zip::from(&mut *p).and(&target).for_each(|p, t| *p += step * (t - *p));
        ndarray::Zip::from(&mut *u).and(&response).for_each(|u, t| *u += step * (t - *u));
        self.pressure.assign(p);
        self.displacement.assign(u);
        self.best *= 2.0;
    }

    /// The step in [0, 1] from the last feasible pressure to `target` at which the energy is least.
    fn line_search(&self, target: &Field, response: &Field, approach: f64) -> f64 {
        let datum = match self.problem.control {
            Control::Load(_) => 0.0,
            Control::Approach(_) => approach,
        };
        let (p, u) = &self.feasible;
        let (mut slope, mut curvature) = (0.0, 0.0);
        let cells = flat(p)
            .iter()
            .zip(flat(u))
            .zip(flat(target))
            .zip(flat(response))
            .zip(flat(self.problem.initial_gap));
        for ((((p, u), target), response), h) in cells {
            slope += (datum - h - u) * (target - p);
            curvature += (target - p) * (response - u);
        }
        if slope > 0.0 && curvature > 0.0 { (slope / curvature).min(1.0) } else { 0.0 }
    }
}

fn flat(field: &Field) -> &[f64] {
    field.as_slice().expect("standard layout")
}

/// Displacement, within [`FORESIGHT`] cells, of pressures at a few cells.
fn near_response(operator: &dyn Operator, moved: &[(usize, f64)]) -> Vec<f64> {
    let [nx, ny] = operator.grid().shape;
    let reach = [nx, ny].map(|n| FORESIGHT.min((n - 1) / 2));
    let table = Field::from_shape_fn([reach[0] + 1, reach[1] + 1], |(i, j)| operator.influence(i, j));
    let mut response = vec![0.0; nx * ny];
    for &(cell, pressure) in moved {
        let (ix, iy) = (cell / ny, cell % ny);
        for i in ix.saturating_sub(reach[0])..nx.min(ix + reach[0] + 1) {
            for j in iy.saturating_sub(reach[1])..ny.min(iy + reach[1] + 1) {
                response[i * ny + j] += table[[i.abs_diff(ix), j.abs_diff(iy)]] * pressure;
            }
        }
    }
    response
}

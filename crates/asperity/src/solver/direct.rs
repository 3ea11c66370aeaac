//! Dense quadratic programming: exact to round-off, for contacts of up to a few thousand cells.

use faer::Mat;
use faer::linalg::solvers::{Llt, Solve};

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::operator::Operator;
use crate::solver::bounds::make_feasible;
use crate::solver::{Control, Params, Problem, Solution, Stats, Terms};
use crate::units::Metre;

/// Cells between the bounds above which the dense matrix would be out of proportion (3 GB).
const MAX_FREE_CELLS: usize = 20_000;

/// Solves by block principal pivoting (Júdice and Pires, Comput. Oper. Res. 21, 587 (1994)) with a Cholesky
/// factorisation of the block between the bounds; under load control inside a bracketed Newton iteration on the
/// approach, which ends exactly because the load is piecewise linear in it.
pub(super) fn solve(
    operator: &mut dyn Operator,
    problem: &Problem,
    start: Option<&Field>,
    params: &Params,
) -> Result<Solution> {
    let mut pivoting = Pivoting::new(operator, problem);
    let mut bounds = start.map(|p| p.mapv(|p| Bound::of(p, problem.terms.hardness)));
    let (mut answer, approach) = match problem.terms.control {
        Control::Approach(approach) => {
            let first = bounds.take().unwrap_or_else(|| pivoting.first_guess(approach));
            (pivoting.solve(approach, first)?, approach)
        }
        Control::Load(load) => pivoting.solve_load(load / problem.terms.cell_area, bounds)?,
    };
    if !problem.terms.bears_the_load(answer.pressure.sum()) {
        // Between one approach and the next in double precision.
        make_feasible(&mut answer.pressure, &problem.terms);
        pivoting.respond(&answer.pressure, &mut answer.displacement);
    }
    let stats = Stats {
        iterations: pivoting.factorisations,
        convolutions: pivoting.convolutions as f64,
        restarts: 0,
    };
    let mean = pivoting.stiffening * answer.pressure.sum();
    let displacement = answer.displacement.mapv(|u| u - mean);
    let approach = approach - mean;
    let residual = problem.residual_at(&answer.pressure, &displacement, approach);
    if residual.is_nan() || residual > params.tolerance {
        return Err(Error::NotConverged {
            iterations: stats.iterations,
            residual,
            tolerance: params.tolerance,
        });
    }
    Ok(Solution { pressure: answer.pressure, displacement, approach, residual, stats })
}

impl Problem<'_> {
    /// η at a known approach, also under load control.
    fn residual_at(&self, pressure: &Field, displacement: &Field, approach: Metre) -> f64 {
        let terms = Terms { control: Control::Approach(approach), ..self.terms };
        let problem = Problem { terms, ..*self };
        problem.residual(pressure, displacement).eta
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Bound {
    Zero,
    Free,
    Hardness,
}

impl Bound {
    fn of(pressure: f64, hardness: f64) -> Self {
        match pressure {
            p if p <= 0.0 => Self::Zero,
            p if p >= hardness => Self::Hardness,
            _ => Self::Free,
        }
    }
}

/// The exact answer at one approach.
struct Answer {
    pressure: Field,
    displacement: Field,
    bounds: ndarray::Array2<Bound>,
    /// dΣp/dδ = 1ᵀ C_FF⁻¹ 1 over the cells between the bounds.
    slope: f64,
}

struct Pivoting<'a, 'b> {
    operator: &'a mut dyn Operator,
    problem: &'a Problem<'b>,
    influence: Field,
    /// A multiple of 1 1ᵀ added to C where the boundary is periodic: it makes C positive definite and only shifts
    /// the approach, by itself times Σ p.
    stiffening: f64,
    factorisations: usize,
    convolutions: usize,
}

impl<'a, 'b> Pivoting<'a, 'b> {
    fn new(operator: &'a mut dyn Operator, problem: &'a Problem<'b>) -> Self {
        let shape = operator.grid().shape;
        let influence = Field::from_shape_fn(shape, |(i, j)| operator.influence(i, j));
        let load_controlled = matches!(problem.terms.control, Control::Load(_));
        let free_mean = operator.boundary().leaves_mean_free() && load_controlled;
        let stiffening = if free_mean { stiffening(operator, problem) } else { 0.0 };
        Self { operator, problem, influence, stiffening, factorisations: 0, convolutions: 0 }
    }

    fn first_guess(&self, approach: Metre) -> ndarray::Array2<Bound> {
        self.problem.initial_gap.mapv(|h| if h < approach { Bound::Free } else { Bound::Zero })
    }

    fn solve(&mut self, approach: Metre, mut bounds: ndarray::Array2<Bound>) -> Result<Answer> {
        const MOST_BLOCK_STEPS_WITHOUT_PROGRESS: usize = 10;
        let hardness = self.problem.terms.hardness;
        let (mut best, mut stalled) = (usize::MAX, 0);
        let mut displacement = Field::zeros(bounds.raw_dim());
        let mut pivots = 0;
        loop {
            self.anchor(approach, &mut bounds)?;
            let (pressure, slope) = self.between_bounds(approach, &bounds)?;
            self.respond(&pressure, &mut displacement);
            let largest = |field: &Field| field.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            let (tiny_p, most_u) = (1e-14 * largest(&pressure), largest(&displacement));
            let mut next = bounds.clone();
            let mut wrong = Vec::new();
            for (index, bound) in next.indexed_iter_mut() {
                let p = pressure[index];
                let interference = approach - self.problem.initial_gap[index];
                let w = interference - displacement[index];
                let tiny_w = 1e-14 * interference.abs().max(most_u);
                let better = match *bound {
                    Bound::Free if p < -tiny_p => Bound::Zero,
                    Bound::Free if p > hardness + tiny_p => Bound::Hardness,
                    Bound::Zero if w > tiny_w => Bound::Free,
                    Bound::Hardness if w < -tiny_w => Bound::Free,
                    same => same,
                };
                if better != *bound {
                    *bound = better;
                    wrong.push(index);
                }
            }
            pivots += 1;
            let last = match wrong.last() {
                Some(last) if pivots < MAX_PIVOTS => *last,
                // Where the pivots are given up the residual tells how far they have come.
                given_up => {
                    let given_up = given_up.is_some();
                    let pressure = pressure.mapv(|p| p.clamp(0.0, hardness));
                    if given_up {
                        self.respond(&pressure, &mut displacement);
                    }
                    return Ok(Answer { pressure, displacement, bounds, slope });
                }
            };
            if wrong.len() < best {
                (best, stalled) = (wrong.len(), 0);
            } else {
                stalled += 1;
            }
            if stalled > MOST_BLOCK_STEPS_WITHOUT_PROGRESS {
                bounds[last] = next[last];
            } else {
                bounds = next;
            }
        }
    }

    /// A periodic contact whose cells are all between their bounds has no stiffness against a change of their mean: under an
    /// approach beyond the mean gap it rises until the cell with the most pressure is at the hardness, under a lesser one it
    /// falls until the cell with the least opens.
    fn anchor(&mut self, approach: Metre, bounds: &mut ndarray::Array2<Bound>) -> Result<()> {
        let free_mean = self.operator.boundary().leaves_mean_free() && self.stiffening == 0.0;
        let floats = free_mean && bounds.iter().all(|b| *b == Bound::Free);
        if !floats {
            return Ok(());
        }
        let mean_gap = self.problem.initial_gap.mean().unwrap_or(0.0);
        let hardness = self.problem.terms.hardness;
        let (side, bound) = match approach > mean_gap {
            true if hardness.is_finite() => (1.0, Bound::Hardness),
            false if approach < mean_gap => (-1.0, Bound::Zero),
            _ => return Err(Error::PeriodicFullContact { approach, mean_gap }),
        };
        self.stiffening = stiffening(self.operator, self.problem);
        let found = self.between_bounds(mean_gap, bounds);
        self.stiffening = 0.0;
        let (pressure, _) = found?;
        let most = pressure.indexed_iter().max_by(|a, b| (side * a.1).total_cmp(&(side * b.1)));
        bounds[most.expect("a cell").0] = bound;
        Ok(())
    }

    fn respond(&mut self, pressure: &Field, displacement: &mut Field) {
        self.operator.apply(pressure, displacement);
        self.convolutions += 1;
        if self.stiffening > 0.0 {
            *displacement += self.stiffening * pressure.sum();
        }
    }

    /// The pressure that closes the gap at the free cells while the others stay at their bounds.
    fn between_bounds(&mut self, approach: Metre, bounds: &ndarray::Array2<Bound>) -> Result<(Field, f64)> {
        let hardness = self.problem.terms.hardness;
        let mut pressure = bounds.mapv(|b| if b == Bound::Hardness { hardness } else { 0.0 });
        let cells_at = |wanted| -> Vec<(usize, usize)> {
            bounds.indexed_iter().filter(|(_, b)| **b == wanted).map(|(index, _)| index).collect()
        };
        let (free, capped) = (cells_at(Bound::Free), cells_at(Bound::Hardness));
        if free.is_empty() {
            return Ok((pressure, 0.0));
        }
        if free.len() > MAX_FREE_CELLS {
            return Err(Error::Unsupported(
                "the direct method is for contacts of up to 20000 cells: choose method = \"active-set\"",
            ));
        }
        let coefficient = |a: (usize, usize), b: (usize, usize)| {
            self.influence[[a.0.abs_diff(b.0), a.1.abs_diff(b.1)]] + self.stiffening
        };
        let matrix = Mat::from_fn(free.len(), free.len(), |i, j| coefficient(free[i], free[j]));
        let right = Mat::from_fn(free.len(), 2, |i, column| match column {
            0 => {
                let capped: f64 = capped.iter().map(|c| coefficient(free[i], *c)).sum();
                let lift = if capped == 0.0 { 0.0 } else { hardness * capped };
                approach - self.problem.initial_gap[free[i]] - lift
            }
            _ => 1.0,
        });
        self.factorisations += 1;
        let factor = Llt::new(matrix.as_ref(), faer::Side::Lower).map_err(|_| {
            // Only the mean of a periodic surface has no stiffness.
            Error::PeriodicFullContact { approach, mean_gap: self.problem.initial_gap.mean().unwrap_or(0.0) }
        })?;
        let solved = factor.solve(&right);
        free.iter().enumerate().for_each(|(i, cell)| pressure[*cell] = solved[(i, 0)]);
        Ok((pressure, (0..free.len()).map(|i| solved[(i, 1)]).sum()))
    }

    fn solve_load(
        &mut self,
        wanted: f64,
        mut bounds: Option<ndarray::Array2<Bound>>,
    ) -> Result<(Answer, Metre)> {
        let gap = self.problem.initial_gap;
        let lowest = gap.iter().copied().fold(f64::INFINITY, f64::min);
        // A cell that bears the whole load alone is an upper start; the slope then leads back.
        let mut approach = lowest
            + self.problem.terms.self_influence * (wanted / 4.0).min(self.problem.terms.hardness)
            + self.stiffening * wanted;
        let (mut low, mut high) = (lowest, f64::INFINITY);
        let mut trials = 0;
        loop {
            trials += 1;
            let first = bounds.take().unwrap_or_else(|| self.first_guess(approach));
            let answer = self.solve(approach, first)?;
            let excess = answer.pressure.sum() - wanted;
            if excess < 0.0 {
                low = approach;
            } else {
                high = approach;
            }
            let newton = approach - excess / answer.slope;
            let exhausted = high.is_finite() && high - low <= 4.0 * f64::EPSILON * high.abs().max(low.abs());
            if excess.abs() <= 1e-13 * wanted || exhausted || trials == MAX_TRIALS {
                return Ok((answer, approach));
            }
            approach = if answer.slope > 0.0 && low < newton && newton < high {
                newton
            } else if high.is_finite() {
                0.5 * (low + high)
            } else {
                approach + (approach - lowest).max(self.problem.terms.self_influence * wanted)
            };
            bounds = Some(answer.bounds);
        }
    }
}

/// As much as makes the stiffness of the mean one among those of the waves.
fn stiffening(operator: &dyn Operator, problem: &Problem) -> f64 {
    problem.terms.self_influence / (operator.grid().cells() as f64).sqrt()
}

const MAX_PIVOTS: usize = 2000;
const MAX_TRIALS: usize = 200;

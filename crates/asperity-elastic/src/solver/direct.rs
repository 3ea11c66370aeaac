//! Dense quadratic programming: exact to round-off, for contacts of up to a few thousand cells.

use ndarray::Array2;

use crate::error::{Error, Result};
use crate::grid::{CellValues, Field};
use crate::math::Cholesky;
use crate::operator::Operator;
use crate::solver::feasible::{Bounded, make_feasible};
use crate::solver::sets::Set;
use crate::solver::{Answer, Control, Params, Problem, Settings, Stats};
use crate::units::Metre;
use asperity_base::watch::check_stop;

/// Largest number of cells between the bounds; the dense matrix then takes 3 GB.
const MAX_FREE_CELLS: usize = 20_000;

/// Solves by block principal pivoting (Júdice and Pires, Comput. Oper. Res. 21, 587 (1994)) with a Cholesky
/// factorisation of the block between the bounds. Under load control a bracketed Newton iteration finds the
/// approach. It ends exactly, because the load is piecewise linear in the approach.
pub(super) fn solve(
    operator: &mut dyn Operator,
    problem: &Problem,
    start: Option<&Field>,
    params: &Params,
) -> Result<Answer> {
    let mut pivoting = Pivoting::new(operator, problem);
    let sets = start.map(|start| problem.sets_of(start));
    let (mut answer, approach) = match problem.settings.control {
        Control::Approach(approach) => {
            let first = sets.unwrap_or_else(|| problem.sets_at(approach));
            (pivoting.solve(approach, first)?, approach)
        }
        Control::Load(load) => pivoting.solve_load(load / problem.settings.cell_area, sets)?,
    };
    if !problem.settings.carries_the_load(answer.pressure.sum()) {
        // The bracket is at the rounding of double precision.
        let mut cells = Bounded { pressure: &mut answer.pressure, bounds: problem.bounds };
        make_feasible(&mut cells, &problem.settings);
        pivoting.convolve(&answer.pressure, &mut answer.displacement);
    }
    let stats = Stats {
        iterations: pivoting.factorisations,
        convolutions: pivoting.convolutions as f64,
        ..Stats::default()
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
    Ok(Answer { pressure: answer.pressure, displacement, approach, residual, stats })
}

impl Problem<'_> {
    /// Computes the residual η at a known approach, also under load control.
    fn residual_at(&self, pressure: &Field, displacement: &Field, approach: Metre) -> f64 {
        let settings = Settings { control: Control::Approach(approach), ..self.settings };
        let problem = Problem { settings, ..*self };
        problem.residual(pressure, displacement).eta
    }

    /// Returns the set of each cell under a pressure.
    fn sets_of(&self, pressure: &Field) -> Array2<Set> {
        let sets =
            pressure.iter().enumerate().map(|(cell, p)| Set::from_pressure(*p, self.bounds.interval(cell)));
        Array2::from_shape_vec(pressure.raw_dim(), sets.collect()).expect("a set for each cell")
    }

    /// Returns the sets of undeformed bodies at an approach: the overlapping cells are free.
    fn sets_at(&self, approach: Metre) -> Array2<Set> {
        self.initial_gap.mapv(|h| if h < approach { Set::Free } else { Set::Lower })
    }

    /// Returns the pressure of the cells at their bounds, and 0 for free cells.
    fn pressure_at_bounds(&self, sets: &Array2<Set>) -> Field {
        let at_bound = |(cell, set): (usize, &Set)| match set {
            Set::Lower => self.bounds.interval(cell).lower,
            Set::Upper => self.bounds.interval(cell).upper,
            Set::Free => 0.0,
        };
        let pressures = sets.iter().enumerate().map(at_bound).collect();
        Field::from_shape_vec(sets.raw_dim(), pressures).expect("a pressure for each cell")
    }
}

/// The exact solution at one approach.
struct SolutionAtApproach {
    pressure: Field,
    displacement: Field,
    sets: Array2<Set>,
    /// Slope dΣp/dδ = 1ᵀ C_FF⁻¹ 1 over the cells between the bounds.
    slope: f64,
}

struct Pivoting<'a, 'b> {
    operator: &'a mut dyn Operator,
    problem: &'a Problem<'b>,
    influence: Field,
    /// Displacement of each cell per unit pressure on itself.
    self_influence: CellValues,
    /// The factor s of the matrix s 1 1ᵀ that is added to C for a periodic boundary. It makes C positive
    /// definite, and changes only the approach, by s Σ p.
    stiffening: f64,
    factorisations: usize,
    convolutions: usize,
}

impl<'a, 'b> Pivoting<'a, 'b> {
    fn new(operator: &'a mut dyn Operator, problem: &'a Problem<'b>) -> Self {
        let shape = operator.grid().shape;
        let influence = Field::from_shape_fn(shape, |(i, j)| operator.influence(i, j));
        let load_controlled = matches!(problem.settings.control, Control::Load(_));
        let free_mean = operator.leaves_mean_free() && load_controlled;
        let stiffening = if free_mean { stiffening(operator, problem) } else { 0.0 };
        let self_influence = operator.self_influence();
        Self { operator, problem, influence, self_influence, stiffening, factorisations: 0, convolutions: 0 }
    }

    fn solve(&mut self, approach: Metre, mut sets: Array2<Set>) -> Result<SolutionAtApproach> {
        let (mut best, mut stalled) = (usize::MAX, 0);
        let mut displacement = Field::zeros(sets.raw_dim());
        let mut pivots = 0;
        loop {
            check_stop(self.problem.settings.watch)?;
            self.anchor(approach, &mut sets)?;
            let (pressure, slope) = self.between_bounds(approach, &sets)?;
            self.convolve(&pressure, &mut displacement);
            let largest = |field: &Field| field.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            let (tiny_p, most_u) = (ROUNDING * largest(&pressure), largest(&displacement));
            let mut next = sets.clone();
            let mut wrong = Vec::new();
            for (cell, (index, set)) in next.indexed_iter_mut().enumerate() {
                let (p, bounds) = (pressure[index], self.problem.bounds.interval(cell));
                let interference = approach - self.problem.initial_gap[index];
                let w = interference - displacement[index];
                let tiny_w = ROUNDING * interference.abs().max(most_u);
                let better = match *set {
                    Set::Free if p < bounds.lower - tiny_p => Set::Lower,
                    Set::Free if p > bounds.upper + tiny_p => Set::Upper,
                    Set::Lower if w > tiny_w => Set::Free,
                    Set::Upper if w < -tiny_w => Set::Free,
                    same => same,
                };
                if better != *set {
                    *set = better;
                    wrong.push(index);
                }
            }
            pivots += 1;
            let last = match wrong.last() {
                Some(last) if pivots < MAX_PIVOTS => *last,
                // If pivoting stops early, the residual shows its error.
                given_up => {
                    let given_up = given_up.is_some();
                    let mut pressure = pressure;
                    let cells = pressure.iter_mut().enumerate();
                    cells.for_each(|(cell, p)| *p = self.problem.bounds.interval(cell).clamp(*p));
                    if given_up {
                        self.convolve(&pressure, &mut displacement);
                    }
                    return Ok(SolutionAtApproach { pressure, displacement, sets, slope });
                }
            };
            if wrong.len() < best {
                (best, stalled) = (wrong.len(), 0);
            } else {
                stalled += 1;
            }
            if stalled > MAX_STALLED_BLOCKS {
                sets[last] = next[last];
            } else {
                sets = next;
            }
        }
    }

    /// Puts one cell at a bound if all cells of a periodic contact are free. Such a contact has no stiffness
    /// against a change of its mean pressure. At an approach beyond the mean gap the mean rises until a cell
    /// reaches its upper bound. At a smaller approach it falls until a cell reaches its lower bound.
    fn anchor(&mut self, approach: Metre, sets: &mut Array2<Set>) -> Result<()> {
        let free_mean = self.operator.leaves_mean_free() && self.stiffening == 0.0;
        let floats = free_mean && sets.iter().all(|set| *set == Set::Free);
        if !floats {
            return Ok(());
        }
        let mean_gap = self.problem.initial_gap.mean().unwrap_or(0.0);
        let bounds = self.problem.bounds;
        let (rises, set) = match approach > mean_gap {
            true if bounds.upper().min().is_finite() => (true, Set::Upper),
            false if approach < mean_gap => (false, Set::Lower),
            _ => return Err(Error::PeriodicFullContact { approach, mean_gap }),
        };
        self.stiffening = stiffening(self.operator, self.problem);
        let found = self.between_bounds(mean_gap, sets);
        self.stiffening = 0.0;
        let (pressure, _) = found?;
        let way = |cell: usize, p: f64| {
            if rises { bounds.interval(cell).upper - p } else { p - bounds.interval(cell).lower }
        };
        let ways = pressure.indexed_iter().enumerate().map(|(cell, (index, p))| (index, way(cell, *p)));
        let nearest = ways.min_by(|a, b| a.1.total_cmp(&b.1));
        sets[nearest.expect("a cell").0] = set;
        Ok(())
    }

    /// Computes the displacement of a pressure with the stiffened matrix.
    fn convolve(&mut self, pressure: &Field, displacement: &mut Field) {
        self.operator.apply(pressure, displacement);
        self.convolutions += 1;
        if self.stiffening > 0.0 {
            *displacement += self.stiffening * pressure.sum();
        }
    }

    /// Computes the pressure that closes the gap at the free cells while the others stay at their bounds, and
    /// the slope of its sum.
    fn between_bounds(&mut self, approach: Metre, sets: &Array2<Set>) -> Result<(Field, f64)> {
        let mut pressure = self.problem.pressure_at_bounds(sets);
        let cells = |is: fn(&Set, f64) -> bool| -> Vec<(usize, usize)> {
            let cells = sets.indexed_iter().filter(|(index, set)| is(set, pressure[*index]));
            cells.map(|(index, _)| index).collect()
        };
        let free = cells(|set, _| *set == Set::Free);
        let loaded = cells(|set, p| *set != Set::Free && p != 0.0);
        if free.is_empty() {
            return Ok((pressure, 0.0));
        }
        if free.len() > MAX_FREE_CELLS {
            return Err(Error::Unsupported(
                "the direct method is for contacts of up to 20000 cells; the active set is for larger ones",
            ));
        }
        let width = sets.ncols();
        let coefficient = |a: (usize, usize), b: (usize, usize)| {
            let influence = if a == b {
                self.self_influence.value(a.0 * width + a.1)
            } else {
                self.influence[[a.0.abs_diff(b.0), a.1.abs_diff(b.1)]]
            };
            influence + self.stiffening
        };
        // The factorisation reads only the lower triangle.
        let lower = |(i, j)| if j <= i { coefficient(free[i], free[j]) } else { 0.0 };
        let matrix = Field::from_shape_fn([free.len(); 2], lower);
        let interference = |cell: &(usize, usize)| {
            let given: f64 = loaded.iter().map(|other| coefficient(*cell, *other) * pressure[*other]).sum();
            approach - self.problem.initial_gap[*cell] - given
        };
        let interference: Vec<f64> = free.iter().map(interference).collect();
        self.factorisations += 1;
        let factor = Cholesky::new(matrix).ok_or_else(|| {
            // Only the mean of a periodic surface has no stiffness.
            Error::PeriodicFullContact { approach, mean_gap: self.problem.initial_gap.mean().unwrap_or(0.0) }
        })?;
        let solved = factor.solve(&interference);
        free.iter().zip(solved).for_each(|(cell, p)| pressure[*cell] = p);
        Ok((pressure, factor.solve(&vec![1.0; free.len()]).iter().sum()))
    }

    /// Computes the solution under a load, and its approach, by a bracketed Newton iteration on the approach.
    fn solve_load(
        &mut self,
        wanted: f64,
        mut sets: Option<Array2<Set>>,
    ) -> Result<(SolutionAtApproach, Metre)> {
        let Settings { self_influence, .. } = self.problem.settings;
        let scale = self.problem.settings.sum_scale(wanted);
        let lowest = self.first_touch();
        // A single cell under the whole load gives an upper start; the slope then leads back.
        let mut approach = lowest
            + self_influence * (scale / 4.0).min(self.problem.bounds.upper().max())
            + self.stiffening * wanted;
        let (mut low, mut high) = (lowest, f64::INFINITY);
        let mut trials = 0;
        loop {
            trials += 1;
            let first = sets.take().unwrap_or_else(|| self.problem.sets_at(approach));
            let answer = self.solve(approach, first)?;
            let excess = answer.pressure.sum() - wanted;
            if excess < 0.0 {
                low = approach;
            } else {
                high = approach;
            }
            let newton = approach - excess / answer.slope;
            let exhausted = high.is_finite() && high - low <= BRACKET_ROUNDING * high.abs().max(low.abs());
            if excess.abs() <= self.problem.settings.sum_accuracy(wanted) || exhausted || trials == MAX_TRIALS
            {
                return Ok((answer, approach));
            }
            approach = if answer.slope > 0.0 && low < newton && newton < high {
                newton
            } else if high.is_finite() {
                0.5 * (low + high)
            } else {
                approach + (approach - lowest).max(self_influence * scale)
            };
            sets = Some(answer.sets);
        }
    }

    /// Computes the approach up to which all cells are at their lower bounds.
    fn first_touch(&mut self) -> Metre {
        let gap = self.problem.initial_gap;
        let lowest = |touch: &Field| touch.iter().copied().fold(f64::INFINITY, f64::min);
        if self.problem.settings.attraction == 0.0 {
            return lowest(gap);
        }
        let pressure = self.problem.pressure_at_bounds(&gap.mapv(|_| Set::Lower));
        let mut touch = Field::zeros(gap.raw_dim());
        self.convolve(&pressure, &mut touch);
        touch += gap;
        lowest(&touch)
    }
}

/// Returns the factor s of s 1 1ᵀ for which the compliance of the mean is comparable to those of the waves.
fn stiffening(operator: &dyn Operator, problem: &Problem) -> f64 {
    problem.settings.self_influence / (operator.grid().cells() as f64).sqrt()
}

/// Largest number of pivoting steps at one approach.
const MAX_PIVOTS: usize = 2000;
/// Block steps without progress after which a single cell changes its set at a time.
const MAX_STALLED_BLOCKS: usize = 10;
/// Largest number of approaches tried for a load.
const MAX_TRIALS: usize = 200;
/// Relative width of a bracket of approaches at the rounding of double precision.
const BRACKET_ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Rounding of pressures and displacements, relative to the largest.
const ROUNDING: f64 = 1e-14;

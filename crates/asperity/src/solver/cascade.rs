//! A first guess from coarser and coarser grids.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::operator::Operator;
use crate::solver::{Params, Problem, Residual, Solution, active_set};

/// Residual to which the coarse grids are solved: of std(u), or of what the hardness does to a cell where that is
/// less, for φ never exceeds it.
const COARSE_TOLERANCE: f64 = 1e-2;
/// Convolutions after which a coarse grid is given up.
const COARSE_CONVOLUTIONS: usize = 100;
/// A grid with fewer cells than this along either axis is not coarsened.
const LEAST_CELLS: usize = 32;

/// Solves on a cascade of grids, each with twice the pitch of the one above it, from the coarsest upwards; the
/// pressure of each is the first guess of the next.
pub(super) fn solve(operator: &mut dyn Operator, problem: &Problem, params: &Params) -> Result<Solution> {
    let (start, spent) = first_guess(operator, problem, params)?;
    let mut solution =
        active_set::solve(operator, problem, start, |_| params.tolerance, params.max_convolutions)?;
    solution.stats.convolutions += spent;
    Ok(solution)
}

/// The prolonged pressure of the next coarser grid and its cost in convolutions of this one.
fn first_guess(operator: &dyn Operator, problem: &Problem, params: &Params) -> Result<(Option<Field>, f64)> {
    let shape = operator.grid().shape;
    if shape.iter().any(|n| *n < 2 * LEAST_CELLS) {
        return Ok((None, 0.0));
    }
    let mut coarse = operator.coarse();
    let gap = restrict(problem.initial_gap);
    let share = coarse.grid().cells() as f64 / operator.grid().cells() as f64;
    let coarse_problem = Problem {
        initial_gap: &gap,
        self_influence: coarse.influence(0, 0),
        cell_area: coarse.grid().cell_area(),
        ..*problem
    };
    if problem.hardness * gap.len() as f64 <= coarse_problem.pressure_sum().unwrap_or(0.0) {
        return Ok((None, 0.0));
    }
    let (start, spent) = first_guess(coarse.as_ref(), &coarse_problem, params)?;
    let saturation = coarse_problem.self_influence * problem.hardness;
    let loose =
        |state: &Residual| params.tolerance.max(COARSE_TOLERANCE * (saturation / state.scale).min(1.0));
    match active_set::solve(coarse.as_mut(), &coarse_problem, start, loose, COARSE_CONVOLUTIONS) {
        Ok(solution) => {
            let spent = share * (spent + solution.stats.convolutions);
            Ok((Some(prolong(&solution.pressure, shape)), spent))
        }
        // A guess that cannot be had is no guess.
        Err(Error::NotConverged { .. }) => Ok((None, share * (spent + COARSE_CONVOLUTIONS as f64))),
        Err(other) => Err(other),
    }
}

/// Means of 2 × 2 cells (of what is there, at the end of an odd number).
fn restrict(fine: &Field) -> Field {
    let (nx, ny) = fine.dim();
    Field::from_shape_fn([nx.div_ceil(2), ny.div_ceil(2)], |(i, j)| {
        let block = fine.slice(ndarray::s![2 * i..nx.min(2 * i + 2), 2 * j..ny.min(2 * j + 2)]);
        block.sum() / block.len() as f64
    })
}

/// Each coarse value on the cells that it covers.
fn prolong(coarse: &Field, shape: [usize; 2]) -> Field {
    Field::from_shape_fn(shape, |(i, j)| coarse[[i / 2, j / 2]])
}

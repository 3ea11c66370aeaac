//! Steady tractive rolling.

use crate::error::{Error, Result, check};
use crate::grid::{Field, Grid};
use crate::operator::{Boundary, CoupledOperator};
use crate::solver::friction::{Friction, FrictionalSolution, Loading, Tangential, solve_frictional_watched};
use crate::solver::watch::Within;
use crate::solver::{Bounds, Control, Params, Watch};
use crate::units::Newton;

/// Steady rolling as it is prescribed. The contact moves towards +x over both bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rolling {
    /// What is prescribed in the plane: creepage or force.
    pub creep: Creep,
    /// Spin φ, 1/m: angular velocity of the upper body against the lower one over the rolling velocity, about z through the
    /// middle of the grid, positive from +x towards +y.
    pub spin: f64,
}

/// What is prescribed of the rolling in the plane, along x and y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Creep {
    /// Creepage ξ: velocity of the upper body against the lower one, as a share of the rolling velocity.
    Creepage([f64; 2]),
    /// Force of the upper body on the lower one.
    Force([Newton; 2]),
}

/// Bodies in steady rolling.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct RollingSolution {
    /// The contact, whose slip is that while it moves on by a cell.
    pub contact: FrictionalSolution,
    /// Creepage ξ along x and y: velocity of the upper body against the lower one, as a share of the rolling velocity.
    pub creepage: [f64; 2],
}

/// Tolerance on the residual in the first steps.
const FIRST_TOLERANCE: f64 = 1e-3;
/// Each step is solved to this share of the change of the shear in the one before.
const TOLERANCE_REDUCTION: f64 = 0.1;

/// Solves the steady state of bodies that roll along x under friction: their gap stays, and their material passes
/// through it.
///
/// In the time in which the contact moves on by a cell, material that was a cell ahead arrives, and slips by
///
/// ```text
/// Δs = [ξ + φ (−y, x)] Δx − u(x) + u₀(x + Δx)
/// ```
///
/// with u₀ the displacement before, and x and y from the middle of the grid. From the state without creepage this is repeated until the shear changes by less than
/// the tolerance, as a share of the largest, which takes a few lengths of the contact. The traction grows from the leading edge, where the bodies stick.
/// Carter, Proc. R. Soc. A 112, 151 (1926); Kalker, Three-dimensional elastic bodies in rolling contact (1990).
///
/// # Errors
/// Those of [`crate::solver::solve_frictional`]; [`Error::Unsupported`] for a spin on a boundary that is not free all around.
///
/// # Panics
/// If a field has another shape than the operator's grid.
pub fn solve_rolling(
    operator: &mut dyn CoupledOperator,
    initial_gap: &Field,
    bounds: &Bounds,
    friction: &Friction,
    normal: Control,
    rolling: Rolling,
    params: &Params,
) -> Result<RollingSolution> {
    solve_rolling_watched(operator, initial_gap, bounds, friction, normal, rolling, params, &())
}

/// As [`solve_rolling`], while somebody looks on.
#[expect(clippy::too_many_arguments, reason = "the contact, what is asked of it, and who looks on")]
pub(crate) fn solve_rolling_watched(
    operator: &mut dyn CoupledOperator,
    initial_gap: &Field,
    bounds: &Bounds,
    friction: &Friction,
    normal: Control,
    rolling: Rolling,
    params: &Params,
    watch: &dyn Watch,
) -> Result<RollingSolution> {
    let grid = *operator.grid();
    let pitch = grid.pitch[0];
    let boundary = operator.normal().boundary();
    check("spin", rolling.spin, rolling.spin.is_finite(), "a finite number")?;
    if rolling.spin != 0.0 && boundary != Boundary::FREE {
        return Err(Error::Unsupported("what spins does not repeat itself: its boundary is free"));
    }
    // What the spin turns the upper body by while the contact moves on by a cell.
    let turn = [-lever(&grid, 1), lever(&grid, 0)].map(|arm| arm * (rolling.spin * pitch));
    let tangential = match rolling.creep {
        Creep::Creepage(creepage) => {
            for xi in creepage {
                check("creepage", xi, xi.is_finite(), "a finite number")?;
            }
            Tangential::Displacement(creepage.map(|xi| xi * pitch))
        }
        Creep::Force(force) => Tangential::Force(force),
    };
    let mut solve = |tangential, before: Option<&FrictionalSolution>, tolerance| {
        let loading = Loading { normal, tangential };
        let params = Params { tolerance, ..*params };
        let within = Within(watch);
        solve_frictional_watched(operator, initial_gap, bounds, friction, loading, before, &params, &within)
    };
    let mut tolerance = FIRST_TOLERANCE.max(params.tolerance);
    let mut state = solve(Tangential::Force([0.0; 2]), None, tolerance)?;
    let mut stats = state.normal.stats;
    let most = MAX_LENGTHS * initial_gap.nrows();
    for _ in 0..most {
        let arrived = FrictionalSolution {
            displacement: [0, 1].map(|axis| a_cell_ahead(&state.displacement[axis], boundary) + &turn[axis]),
            rigid_displacement: [0.0; 2],
            ..state.clone()
        };
        let next = solve(tangential, Some(&arrived), tolerance)?;
        stats = stats.and(&next.normal.stats);
        let change = change(&next, &state);
        watch.iteration(change, params.tolerance);
        let steady = change < params.tolerance && tolerance <= params.tolerance;
        tolerance =
            (TOLERANCE_REDUCTION * change).clamp(params.tolerance, FIRST_TOLERANCE.max(params.tolerance));
        state = next;
        if steady {
            state.normal.stats = stats;
            let creepage = state.rigid_displacement.map(|displacement| displacement / pitch);
            return Ok(RollingSolution { contact: state, creepage });
        }
    }
    Err(Error::NotConverged {
        iterations: stats.iterations,
        residual: state.normal.residual,
        tolerance: params.tolerance,
    })
}

/// Cells of rolling after which the iteration is given up, in lengths of the grid.
const MAX_LENGTHS: usize = 50;

/// Each column of a field replaced by the next one; the last stays, or is followed by the first where the field repeats.
fn a_cell_ahead(field: &Field, boundary: Boundary) -> Field {
    let last = field.nrows() - 1;
    let ahead = |i: usize| match (i < last, boundary.repeats(0)) {
        (true, _) => i + 1,
        (false, true) => 0,
        (false, false) => last,
    };
    Field::from_shape_fn(field.raw_dim(), |(i, j)| field[[ahead(i), j]])
}

/// Coordinate of each cell along an axis, from the middle of the grid.
fn lever(grid: &Grid, axis: usize) -> Field {
    let middle = 0.5 * grid.extent()[axis];
    Field::from_shape_fn(grid.shape, |(i, j)| grid.centre(axis, [i, j][axis]) - middle)
}

impl FrictionalSolution {
    /// Moment M = ΔA Σ (x q_y − y q_x) of the upper body on the lower one about z through the middle of the grid, N·m.
    pub fn moment(&self) -> f64 {
        let [x, y] = [0, 1].map(|axis| lever(&self.normal.grid, axis));
        self.normal.grid.cell_area() * ((x * &self.shear[1]).sum() - (y * &self.shear[0]).sum())
    }
}

/// Largest change of the shear from one state to the next, as a share of the largest shear.
fn change(next: &FrictionalSolution, state: &FrictionalSolution) -> f64 {
    let pairs = next.shear.iter().flatten().zip(state.shear.iter().flatten());
    let most = pairs.fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    if most == 0.0 { 0.0 } else { most / next.max_shear() }
}

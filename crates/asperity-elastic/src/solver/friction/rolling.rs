//! Steady tractive rolling.

use crate::error::{Error, Result, check};
use crate::grid::{Field, Grid, in_rows};
use crate::operator::{Boundary, CoupledOperator};
use crate::solver::friction::alternate::Start;
use crate::solver::friction::bodies::Bodies;
use crate::solver::friction::stick_slip::solve_increment;
use crate::solver::friction::transport::{History, ShiftByCell, SteadyMethod, Transport};
use crate::solver::friction::{Friction, FrictionalProblem, FrictionalSolution, Tangential};
use crate::solver::{Before, Bounds, Control, HardWall, Interface, NormalProblem, Params, Stats, Watch};
use crate::units::{Joule, Newton};
use asperity_base::watch::InnerWatch;

/// Largest distance of rolling cell by cell, in lengths of the grid.
const MAX_LENGTHS: usize = 50;
/// Rolling cell by cell stops without convergence if the change of the shear over a length of the grid, at
/// least [`MIN_LENGTH`] cells, exceeds this fraction of the previous change.
const SLOW_CONTRACTION: f64 = 0.5;
/// Smallest number of cells of rolling in which a change of the shear is expected.
const MIN_LENGTH: usize = 10;
/// Tolerance on the residual of the first cells of rolling.
const FIRST_TOLERANCE: f64 = 1e-3;
/// Each further cell is solved to this fraction of the change of the shear in the previous one.
const TOLERANCE_REDUCTION: f64 = 0.1;

/// Prescribed steady rolling. The contact moves towards +x over both bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rolling {
    /// Prescribed creepage or force.
    pub creep: Creep,
    /// Spin φ, 1/m: angular velocity of the upper body relative to the lower one, over the rolling velocity.
    /// Its axis is z through the middle of the grid, positive from +x towards +y.
    pub spin: f64,
}

/// Prescribed creepage or force of the rolling, along x and y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Creep {
    /// Creepage ξ: velocity of the upper body relative to the lower one, over the rolling velocity.
    Creepage([f64; 2]),
    /// Force of the upper body on the lower one.
    Force([Newton; 2]),
}

/// Bodies in steady rolling.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct RollingSolution {
    /// The contact. Its slip is the slip while the contact moves by one cell.
    pub contact: FrictionalSolution,
    /// Creepage ξ along x and y: velocity of the upper body relative to the lower one, over the rolling
    /// velocity.
    pub creepage: [f64; 2],
    /// Prescribed spin φ, 1/m.
    pub spin: f64,
    /// Energy dissipated by friction while the contact moves by one cell, from the work of the force Q and
    /// the moment M:
    ///
    /// ```text
    /// (ξ·Q + φM) Δx + ΔA Σ q·[v(x + Δx) − v(x − Δx)]/2
    /// ```
    ///
    /// with v the tangential displacement under pressure, which is 0 between identical bodies. Between
    /// dissimilar bodies the last term is the work of the pressure, which shifts to one side of the gap and
    /// resists the rolling. The energy is exact except for the error of the tractions. Without slip, under an
    /// infinite coefficient of friction, the energy is lost at the trailing edge.
    pub dissipation: Joule,
}

impl RollingSolution {
    /// Work ΔA Σ q·Δs of the shear on the slip of the cells while the contact moves by one cell. It is the
    /// [`RollingSolution::dissipation`] without the discretisation error of a step by one cell. This error is
    /// of first order in Δx, and may be the larger part if little slips.
    pub fn slip_work(&self) -> Joule {
        let FrictionalSolution { shear, slip, normal, .. } = &self.contact;
        normal.grid.cell_area() * (0..2).map(|axis| (&shear[axis] * &slip[axis]).sum()).sum::<f64>()
    }
}

/// Solves the steady state of bodies that roll along x under friction. Their gap is constant, and their
/// material passes through it.
///
/// While the contact moves by one cell, material that was a cell ahead arrives, and slips by
///
/// ```text
/// Δs = [ξ + φ (−y, x)] Δx − u(x) + u₀(x + Δx)
/// ```
///
/// with u₀ the displacement before, and x and y from the middle of the grid. In the steady state u₀ = u. This
/// problem is solved directly for the shear, like an increment of [`crate::solver::solve_frictional`]. The
/// residual of the tangential problem is
///
/// ```text
/// max |q − P(q + Δs/c)| / max |q|,   P onto |q| ≤ g,   c = ½(C^xx + C^yy) of a cell
/// ```
///
/// If the iteration does not converge, as in some contacts of one or two cells, the bodies roll cell by cell,
/// with u₀ from the cell before, until the relative change of the shear is below the tolerance. If this does
/// not converge either, the proximal point method follows. The cost includes all attempts.
///
/// The traction grows from the leading edge, where the bodies stick. Carter, Proc. R. Soc. A 112, 151 (1926);
/// Kalker, Three-dimensional elastic bodies in rolling contact (1990).
///
/// # Errors
/// Returns the errors of [`crate::solver::solve_frictional`]; [`Error::Unsupported`] for a spin on a boundary
/// that is not free all around.
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
    let gap = in_rows(initial_gap);
    let (control, before) = (normal, Before::Apart);
    let normal = NormalProblem { gap: &gap, bounds, control, before, params, watch: &() };
    let problem = FrictionalProblem { normal, tangential: Tangential::Force([0.0; 2]), compliance: None };
    roll(operator, &HardWall, friction, rolling, &problem)
}

/// Solves the steady state of bodies that roll under the normal loading of a `problem`.
pub(in crate::solver) fn roll(
    operator: &mut dyn CoupledOperator,
    interface: &dyn Interface,
    friction: &Friction,
    rolling: Rolling,
    problem: &FrictionalProblem<'_>,
) -> Result<RollingSolution> {
    let grid = *operator.grid();
    let pitch = grid.pitch[0];
    let boundary = operator.normal().boundary();
    let params = problem.normal.params;
    params.device.only_processor("a device does not solve rolling")?;
    check("spin", rolling.spin, rolling.spin.is_finite(), "a finite number")?;
    if rolling.spin != 0.0 && boundary != Boundary::FREE {
        return Err(Error::Unsupported("spin needs a free boundary"));
    }
    let tangential = match rolling.creep {
        Creep::Creepage(creepage) => {
            for xi in creepage {
                check("creepage", xi, xi.is_finite(), "a finite number")?;
            }
            Tangential::Displacement(creepage.map(|xi| xi * pitch))
        }
        Creep::Force(force) => Tangential::Force(force),
    };
    let turn = [-lever(&grid, 1), lever(&grid, 0)].map(|arm| arm * (rolling.spin * pitch));
    let transport = Transport { ahead: ShiftByCell::on(operator), turn, method: SteadyMethod::Newton };
    let mut spent = Stats::default();
    let mut solve = |tangential, start, tolerance, watch: &dyn Watch| {
        let params = &Params { tolerance, ..*params };
        let normal = NormalProblem { params, watch, ..problem.normal };
        let problem = FrictionalProblem { normal, tangential, ..*problem };
        let found = solve_increment(operator, interface, friction, &problem, start, &mut spent)?;
        spent = spent.and(&found.normal.stats);
        Ok(found)
    };
    let steady = |method| {
        let history = History::Rolling(Transport { method, ..transport.clone() });
        Start { history, ..Start::default() }
    };
    let watch = problem.normal.watch;
    let mut found = solve(tangential, steady(SteadyMethod::Newton), params.tolerance, watch);
    if matches!(found, Err(Error::NotConverged { .. })) {
        found = cell_by_cell(&mut solve, tangential, &transport, grid.shape[0], params.tolerance, watch);
    }
    if matches!(found, Err(Error::NotConverged { .. })) {
        found = solve(tangential, steady(SteadyMethod::ProximalPoint), params.tolerance, watch);
    }
    let mut contact = found?;
    contact.normal.stats = spent;
    let creepage = contact.rigid_displacement.map(|displacement| displacement / pitch);
    let given: f64 = creepage.iter().zip(contact.force()).map(|(xi, force)| xi * force).sum();
    let given = pitch * (given + rolling.spin * contact.moment());
    let dissipation = given + work_of_pressure(operator, friction, &mut contact);
    Ok(RollingSolution { contact, creepage, spin: rolling.spin, dissipation })
}

/// Computes the work ΔA Σ q·[v(x + Δx) − v(x − Δx)]/2 while the contact moves by one cell, with v the
/// tangential displacement under pressure.
fn work_of_pressure(
    operator: &mut dyn CoupledOperator,
    friction: &Friction,
    contact: &mut FrictionalSolution,
) -> Joule {
    let grid = *operator.grid();
    let repeats = operator.normal().boundary().repeats(0);
    let [columns, _] = grid.shape;
    let bodies = Bodies { operator, coupling: friction.coupling, convolutions: 0.0 };
    if !bodies.pressure_displaces_tangentially() {
        return 0.0;
    }
    // The shear does no work on the central difference of its own displacement, if both neighbouring cells
    // are on the grid.
    let at_end = |i: usize| contact.shear_limit.row(i).iter().any(|limit| *limit > 0.0);
    let under_pressure = (!repeats && (at_end(0) || at_end(columns - 1))).then(|| {
        let mut v = [grid.zeros(), grid.zeros()];
        let [x, y] = v.each_mut();
        bodies.operator.apply([None, None, Some(&contact.normal.pressure)], [Some(x), Some(y), None]);
        contact.normal.stats.convolutions += 1.0;
        v
    });
    let displacement = under_pressure.as_ref().unwrap_or(&contact.displacement);
    let mut work = 0.0;
    for i in 0..columns {
        let (ahead, behind) = if repeats {
            ((i + 1) % columns, (i + columns - 1) % columns)
        } else {
            ((i + 1).min(columns - 1), i.saturating_sub(1))
        };
        // At an end the difference is one-sided.
        let steps = usize::from(ahead != i) + usize::from(behind != i);
        if steps > 0 {
            for (q, v) in contact.shear.iter().zip(displacement) {
                let strained = &v.row(ahead) - &v.row(behind);
                work += q.row(i).dot(&strained) / steps as f64;
            }
        }
    }
    grid.cell_area() * work
}

/// Rolls cell by cell from the state without creepage until the relative change of the shear is below the
/// tolerance. `solve` computes the increment of each cell.
fn cell_by_cell(
    solve: &mut impl FnMut(Tangential, Start, f64, &dyn Watch) -> Result<FrictionalSolution>,
    tangential: Tangential,
    transport: &Transport,
    length: usize,
    tolerance: f64,
    watch: &dyn Watch,
) -> Result<FrictionalSolution> {
    let within = InnerWatch(watch);
    let mut present = FIRST_TOLERANCE.max(tolerance);
    let unloaded = Tangential::Force([0.0; 2]);
    let mut state = solve(unloaded, Start::default(), present, &within)?;
    let mut iterations = state.normal.stats.iterations;
    let (mut left, mut before) = (f64::INFINITY, f64::INFINITY);
    for cell in 1..=MAX_LENGTHS * length {
        let slip = transport.arriving(&state.displacement).map(|u| -u);
        let start = Start::near(&state).with_history(History::Increment(slip));
        let next = solve(tangential, start, present, &within)?;
        iterations += next.normal.stats.iterations;
        left = change(&next, &state);
        watch.iteration(left, tolerance);
        if left < tolerance && present <= tolerance {
            return Ok(next);
        }
        if cell % length.max(MIN_LENGTH) == 0 {
            if left > SLOW_CONTRACTION * before {
                break;
            }
            before = left;
        }
        present = (TOLERANCE_REDUCTION * left).clamp(tolerance, FIRST_TOLERANCE.max(tolerance));
        state = next;
    }
    Err(Error::NotConverged { iterations, residual: left, tolerance })
}

/// Returns the largest change of the shear between two states, relative to the largest shear.
fn change(next: &FrictionalSolution, state: &FrictionalSolution) -> f64 {
    let pairs = next.shear.iter().flatten().zip(state.shear.iter().flatten());
    let most = pairs.fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    if most == 0.0 { 0.0 } else { most / next.max_shear() }
}

/// Returns the coordinate of each cell along an axis, from the middle of the grid.
fn lever(grid: &Grid, axis: usize) -> Field {
    let middle = 0.5 * grid.extent()[axis];
    Field::from_shape_fn(grid.shape, |(i, j)| grid.centre(axis, [i, j][axis]) - middle)
}

impl FrictionalSolution {
    /// Computes the moment M = ΔA Σ (x q_y − y q_x) of the upper body on the lower one about z through the
    /// middle of the grid, N·m.
    pub fn moment(&self) -> f64 {
        let [x, y] = [0, 1].map(|axis| lever(&self.normal.grid, axis));
        self.normal.grid.cell_area() * ((x * &self.shear[1]).sum() - (y * &self.shear[0]).sum())
    }
}

//! Stick and slip: each cell sticks until its shear reaches the limit of friction.

use crate::error::{Result, check, check_in};
use crate::grid::{Field, in_rows};
use crate::operator::CoupledOperator;
use crate::solver::friction::alternate::{Start, alternate};
use crate::solver::friction::transport::History;
use crate::solver::friction::{Friction, FrictionalProblem, FrictionalSolution, Loading, Tangential};
use crate::solver::{Before, Bounds, HardWall, Interface, NormalProblem, Params, Stats};
use crate::units::Dimension;

/// Solves one implicit increment of a contact with friction: the normal contact of
/// [`crate::solver::solve_normal`] together with
///
/// ```text
/// |q| ≤ g = min(μp, τ);   |q| < g ⇒ Δs = 0;   |q| = g ⇒ Δs = λ q, λ ≥ 0
/// s = D − u(q, p),   Δs = s − s₀
/// ```
///
/// s₀ is the slip of the solution `before`; none for bodies that have not touched yet. Normal and tangential
/// problems are solved alternately, each for the tractions of the other (Panagiotopoulos 1975), until both
/// are solved. One round is enough if shear neither displaces the surface normally nor lowers its caps.
/// Residuals are η of [`crate::solver::residual()`] and
///
/// ```text
/// max |c (q − P(q + Δs/c))| / (f std(u_z)),   P onto |q| ≤ g,   f = min(1, Σg/Σp),   c = ½(C^xx + C^yy) of a cell
/// ```
///
/// # Errors
/// Returns the errors of [`crate::solver::solve_normal`]; [`crate::Error::BeyondFriction`] for a force that
/// friction cannot hold.
///
/// # Panics
/// If a field has another shape than the operator's grid.
pub fn solve_frictional(
    operator: &mut dyn CoupledOperator,
    initial_gap: &Field,
    bounds: &Bounds,
    friction: &Friction,
    loading: Loading,
    before: Option<&FrictionalSolution>,
    params: &Params,
) -> Result<FrictionalSolution> {
    let gap = in_rows(initial_gap);
    let (control, before_it) = (loading.normal, Before::Apart);
    let normal = NormalProblem { gap: &gap, bounds, control, before: before_it, params, watch: &() };
    let problem = FrictionalProblem { normal, tangential: loading.tangential, compliance: None };
    solve_stick_slip(operator, &HardWall, friction, &problem, [before; 2], None)
}

/// Solves one increment after the contact `before`, beginning with the tractions of the `nearest` one, with a
/// `drift` of the lower surface relative to the upper one since then that is no slip.
pub(in crate::solver) fn solve_stick_slip(
    operator: &mut dyn CoupledOperator,
    interface: &dyn Interface,
    friction: &Friction,
    problem: &FrictionalProblem<'_>,
    [before, nearest]: [Option<&FrictionalSolution>; 2],
    drift: Option<&[Field; 2]>,
) -> Result<FrictionalSolution> {
    let history = History::since(before, drift);
    let start = nearest.map_or_else(Start::default, Start::near).with_history(history);
    solve_increment(operator, interface, friction, problem, start, &mut Stats::default())
}

/// Solves one increment from a given state. If it fails, it adds its cost to `failed`.
pub(super) fn solve_increment(
    operator: &mut dyn CoupledOperator,
    interface: &dyn Interface,
    friction: &Friction,
    problem: &FrictionalProblem<'_>,
    start: Start,
    failed: &mut Stats,
) -> Result<FrictionalSolution> {
    let normal = problem.normal;
    normal.params.device.only_processor("a device does not solve friction with stick")?;
    let friction = friction.checked()?;
    validate(&problem.tangential)?;
    let sliding = match problem.tangential {
        Tangential::Sliding(_) => Some(friction.sliding_bounds(normal.bounds)),
        _ => None,
    };
    let normal = NormalProblem { bounds: sliding.as_ref().unwrap_or(normal.bounds), ..normal };
    alternate(operator, interface, friction, &FrictionalProblem { normal, ..*problem }, start, failed)
}

/// Returns an error if the tangential loading is out of range.
fn validate(tangential: &Tangential) -> Result<()> {
    match *tangential {
        Tangential::Displacement(displacement) => displacement.into_iter().try_for_each(|d| {
            check_in(Dimension::Length, "tangential displacement", d, d.is_finite(), "a finite length")
        }),
        Tangential::Force(force) => force.into_iter().try_for_each(|f| {
            check_in(Dimension::Force, "tangential force", f, f.is_finite(), "a finite force")
        }),
        Tangential::Sliding([x, y]) => {
            let length = x.hypot(y);
            check("length of the sliding direction", length, (length - 1.0).abs() < 1e-9, "a unit vector")
        }
    }
}

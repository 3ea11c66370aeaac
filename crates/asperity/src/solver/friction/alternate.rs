//! Normal and tangential problems in turn, each for the tractions of the other.

use std::borrow::Cow;

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::operator::CoupledOperator;
use crate::solver::friction::bodies::Bodies;
use crate::solver::friction::shear::{Answer, Rigid, ShearSolver, Task};
use crate::solver::friction::yielding::{bounds_beside, carried, shear_limits};
use crate::solver::friction::{Friction, FrictionalSolution, Loading, Tangential, self_compliance};
use crate::solver::residual::{Residual, residual, scale};
use crate::solver::watch::Within;
use crate::solver::{Bounds, Params, Solution, Stats, Watch, solve_normal_watched};
use crate::units::Metre;

/// Residual of the first round where pressure and shear influence each other.
const FIRST: f64 = 3e-2;
/// Each round is solved to so much of the residual that the last one left.
const SHARPER: f64 = 0.1;
/// The last round is solved to so much of the tolerance.
const LAST: f64 = 0.5;
/// After a round that has not lowered the residual the next one takes up half as much of the change of the normal
/// displacement under shear, but no less than this; after one that has, [`RISE`] times as much.
const MIN_SHARE: f64 = 0.2;
const RISE: f64 = 1.2;
/// Rounds after which the iteration is given up.
const MAX_ROUNDS: usize = 200;

/// Where an increment begins.
#[derive(Default)]
pub(super) struct Start {
    /// A pressure near the answer, the bounds that it has, and the shear beside it.
    pub(super) pressure: Option<Field>,
    pub(super) bounds: Option<Bounds>,
    pub(super) shear: Option<[Field; 2]>,
    /// s₀.
    pub(super) slip: Option<[Field; 2]>,
}

/// Solves one increment. The `virgin` bounds are those of cells without shear, in sliding those beside the shear.
#[expect(clippy::too_many_arguments, reason = "the contact, where it begins, and who looks on")]
pub(super) fn alternate(
    operator: &mut dyn CoupledOperator,
    initial_gap: &Field,
    virgin: Bounds,
    friction: Friction,
    loading: Loading,
    start: Start,
    params: &Params,
    watch: &dyn Watch,
) -> Result<FrictionalSolution> {
    let shape = initial_gap.raw_dim();
    let slides = matches!(loading.tangential, Tangential::Sliding(_));
    let softens = friction.softens(virgin.upper().min()) && !slides;
    let mut increment = Increment {
        bodies: Bodies { operator, coupling: friction.coupling, convolutions: 0.0 },
        initial_gap,
        friction,
        softens,
        loading,
        slip_before: start.slip,
        params,
        watch: &Within(watch),
        virgin: &virgin,
        solver: None,
        stats: Stats::default(),
    };
    let mut pressure = start.pressure;
    let mut bounds = start.bounds.unwrap_or_else(|| virgin.clone());
    let mut lift = start.shear.as_ref().and_then(|shear| increment.bodies.lift(shear));
    let mut shear = start.shear.unwrap_or_else(|| [Field::zeros(shape), Field::zeros(shape)]);
    let mut softer = pressure.as_ref().and_then(|pressure| increment.softer(pressure, &shear));
    let alternates = increment.bodies.shear_lifts() || softens;
    let mut tolerance = if alternates { FIRST.max(LAST * params.tolerance) } else { params.tolerance };
    let (mut last, mut share, mut sharpen) = (f64::INFINITY, 1.0, 1.0);
    for _ in 0..MAX_ROUNDS {
        let mut normal = increment.press(lift.as_ref(), pressure.as_ref(), softer, &mut bounds, tolerance)?;
        let untouched = normal.stats.iterations == 0;
        let limit = shear_limits(&friction, virgin.upper(), softens, &normal.pressure);
        let answer = increment.push(&normal, &limit, &shear, tolerance)?;
        shear = answer.shear;
        let supposed = lift;
        lift = increment.bodies.lift(&shear);
        if let Some(lift) = &lift {
            normal.displacement += lift;
        }
        softer = increment.softer(&normal.pressure, &shear);
        if alternates {
            let state = increment.residual(&normal, softer.as_ref().unwrap_or(&bounds));
            (normal.residual, normal.approach) = (state.eta, state.approach);
        }
        normal.residual = normal.residual.max(answer.residual);
        watch.iteration(normal.residual, params.tolerance);
        if normal.residual <= params.tolerance {
            return Ok(increment.finish(normal, bounds, limit, shear, answer.rigid));
        }
        let reached = normal.residual;
        share = if reached < last { f64::min(RISE * share, 1.0) } else { f64::max(0.5 * share, MIN_SHARE) };
        if untouched && (reached > LAST * last || !softens) {
            // Good enough by its own displacement, which may be much more than what the shear leaves of it.
            sharpen *= SHARPER;
        }
        last = reached;
        if let (Some(lift), Some(supposed)) = (&mut lift, supposed) {
            *lift = &supposed + share * (&*lift - &supposed);
        }
        tolerance = sharpen * (SHARPER * reached).min(FIRST).max(LAST * params.tolerance);
        pressure = Some(normal.pressure);
    }
    let (iterations, tolerance) = (increment.stats.iterations, params.tolerance);
    Err(Error::NotConverged { iterations, residual: last, tolerance })
}

/// What stays the same from round to round, and what they cost.
struct Increment<'a> {
    bodies: Bodies<'a>,
    initial_gap: &'a Field,
    /// Of cells without shear.
    virgin: &'a Bounds,
    friction: Friction,
    /// Whether the shear takes from the pressure of plastic cells.
    softens: bool,
    loading: Loading,
    /// s₀.
    slip_before: Option<[Field; 2]>,
    params: &'a Params,
    watch: &'a dyn Watch,
    solver: Option<ShearSolver>,
    stats: Stats,
}

impl Increment<'_> {
    /// The bounds that the `shear` leaves to the pressure, where it takes from them.
    fn softer(&self, pressure: &Field, shear: &[Field; 2]) -> Option<Bounds> {
        self.softens.then(|| bounds_beside(&self.friction, self.virgin, pressure, shear))
    }

    /// The pressure beside a shear that lifts the surface and leaves it `softer` bounds.
    fn press(
        &mut self,
        lift: Option<&Field>,
        pressure: Option<&Field>,
        softer: Option<Bounds>,
        bounds: &mut Bounds,
        tolerance: f64,
    ) -> Result<Solution> {
        let lifted = lift.map(|lift| self.initial_gap + lift);
        let gap = lifted.as_ref().unwrap_or(self.initial_gap);
        let params = Params { tolerance, ..*self.params };
        let start = match (pressure, softer) {
            (Some(pressure), Some(softer)) => {
                let start = carried(pressure, bounds, &softer);
                *bounds = softer;
                Some(Cow::Owned(start))
            }
            (start, _) => {
                *bounds = self.virgin.clone();
                start.map(Cow::Borrowed)
            }
        };
        let operator = self.bodies.operator.normal();
        let solution = solve_normal_watched(
            operator,
            gap,
            bounds,
            self.loading.normal,
            start.as_deref(),
            &params,
            self.watch,
        )?;
        self.stats = self.stats.and(&solution.stats);
        Ok(solution)
    }

    /// The shear under a pressure.
    fn push(
        &mut self,
        normal: &Solution,
        limit: &Field,
        shear: &[Field; 2],
        tolerance: f64,
    ) -> Result<Answer> {
        let control = match self.loading.tangential {
            Tangential::Displacement(displacement) => Rigid::Displacement(displacement),
            Tangential::Force(force) => Rigid::Force(force),
            Tangential::Sliding(direction) => {
                let shear = direction.map(|n| limit * n);
                return Ok(Answer { shear, rigid: [0.0; 2], residual: 0.0 });
            }
        };
        let free_slip = self.bodies.free_slip(&normal.pressure, self.slip_before.as_ref());
        let scale = shear_scale(normal, limit, self.bodies.operator);
        let solver = self.solver.get_or_insert_with(|| ShearSolver::new(self.bodies.operator));
        let task = Task { limit, free_slip: &free_slip, control, scale, tolerance };
        solver.solve(self.bodies.operator, &task, shear, self.params.max_convolutions, self.watch)
    }

    /// How far the pressure is from equilibrium beside the shear that it has led to.
    fn residual(&self, normal: &Solution, bounds: &Bounds) -> Residual {
        // Of cells that come off their upper bounds by a little the multiplier of the load knows nothing.
        let approach = match self.softens {
            true => Some(normal.approach),
            false => self.loading.normal.approach(),
        };
        residual(
            &normal.pressure,
            &normal.displacement,
            self.initial_gap,
            bounds,
            self.bodies.operator.self_influence().zz,
            approach,
        )
    }

    fn finish(
        mut self,
        mut normal: Solution,
        bounds: Bounds,
        shear_limit: Field,
        shear: [Field; 2],
        rigid: [Metre; 2],
    ) -> FrictionalSolution {
        let displacement = self.bodies.displacement(&shear, &normal.pressure);
        normal.initial_gap.assign(self.initial_gap);
        normal.bounds = bounds;
        normal.stats = self.stats;
        normal.stats.convolutions += self.bodies.convolutions;
        if let Some(solver) = &self.solver {
            normal.stats = normal.stats.and(&solver.stats);
        }
        let (slip, stick) = match self.loading.tangential {
            Tangential::Sliding(_) => {
                let none = || Field::zeros(shear_limit.raw_dim());
                ([none(), none()], none())
            }
            _ => {
                let slip = slip(&normal.pressure, rigid, &displacement, self.slip_before.as_ref());
                let stick = stick(&shear, &slip, &shear_limit, self_compliance(self.bodies.operator));
                (slip, stick)
            }
        };
        FrictionalSolution {
            normal,
            shear,
            shear_limit,
            displacement,
            rigid_displacement: rigid,
            slip,
            stick,
        }
    }
}

/// What a residual of the tangential problem is a share of.
fn shear_scale(normal: &Solution, limit: &Field, operator: &dyn CoupledOperator) -> Metre {
    let local = operator.self_influence().zz * normal.max_pressure();
    let deviation = normal.displacement.std(0.0);
    let share = (limit.sum() / normal.pressure.sum()).min(1.0);
    let largest = normal.displacement.iter().fold(local, |most, u| most.max(u.abs()));
    let scale = share * scale(deviation, largest);
    // Without contact, or without friction, nothing is left to be a share of.
    if scale > 0.0 { scale } else { 1.0 }
}

/// Δs where the bodies touch.
fn slip(
    pressure: &Field,
    rigid: [Metre; 2],
    displacement: &[Field; 2],
    before: Option<&[Field; 2]>,
) -> [Field; 2] {
    [0, 1].map(|axis| {
        let mut slip = displacement[axis].mapv(|u| rigid[axis] - u);
        if let Some(before) = before {
            slip -= &before[axis];
        }
        slip.zip_mut_with(pressure, |s, p| *s = if *p > 0.0 { *s } else { 0.0 });
        slip
    })
}

/// 1 where |q + Δs/c| ≤ g > 0.
fn stick(shear: &[Field; 2], slip: &[Field; 2], limit: &Field, compliance: f64) -> Field {
    let mut stick = limit.clone();
    let predicted = |axis: usize| &shear[axis] + &slip[axis] / compliance;
    ndarray::Zip::from(&mut stick).and(&predicted(0)).and(&predicted(1)).for_each(|g, x, y| {
        *g = if *g > 0.0 && x.hypot(*y) <= *g { 1.0 } else { 0.0 };
    });
    stick
}

//! Normal and tangential problems in turn, each for the tractions of the other.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::operator::CoupledOperator;
use crate::solver::friction::bodies::Bodies;
use crate::solver::friction::shear::{Answer, Rigid, ShearSolver, Task};
use crate::solver::friction::yielding::{AtCaps, caps, solve_capped};
use crate::solver::friction::{Friction, FrictionalSolution, Loading, Tangential, self_compliance};
use crate::solver::residual::{Residual, residual_under, scale};
use crate::solver::{Params, Solution, Stats, solve_normal};
use crate::units::{Metre, Pascal};

/// Residual of the first round where pressure and shear influence each other.
const FIRST: f64 = 3e-2;
/// Each round is solved to so much of the residual that the last one left.
const SHARPER: f64 = 0.1;
/// The last round is solved to so much of the tolerance.
const LAST: f64 = 0.5;
/// After a round that has not lowered the residual the next one takes up half as much of the change of the normal
/// displacement under shear, but no less than this; after one that has, [`RISE`] times as much.
const LEAST: f64 = 0.2;
const RISE: f64 = 1.2;
/// Rounds after which the iteration is given up.
const MOST_ROUNDS: usize = 200;

/// Where an increment begins.
#[derive(Default)]
pub(super) struct Start {
    /// Near the answer.
    pub(super) pressure: Option<Field>,
    pub(super) cap: Option<Field>,
    pub(super) shear: Option<[Field; 2]>,
    /// s₀.
    pub(super) slip: Option<[Field; 2]>,
}

/// Solves one increment.
pub(super) fn alternate(
    operator: &mut dyn CoupledOperator,
    initial_gap: &Field,
    hardness: Pascal,
    friction: Friction,
    loading: Loading,
    start: Start,
    params: &Params,
) -> Result<FrictionalSolution> {
    let shape = initial_gap.raw_dim();
    let slides = matches!(loading.tangential, Tangential::Sliding(_));
    let softens = friction.softens(hardness) && !slides;
    let mut increment = Increment {
        bodies: Bodies { operator, coupling: friction.coupling, convolutions: 0.0 },
        initial_gap,
        hardness,
        friction: if softens { friction.within(hardness) } else { friction },
        softens,
        loading,
        slip_before: start.slip,
        params,
        solver: None,
        stats: Stats::default(),
    };
    let mut pressure = start.pressure;
    let mut cap = start.cap.unwrap_or_else(|| Field::from_elem(shape, hardness));
    let mut lift = start.shear.as_ref().and_then(|shear| increment.bodies.lift(shear));
    let mut shear = start.shear.unwrap_or_else(|| [Field::zeros(shape), Field::zeros(shape)]);
    let mut softer = pressure.as_ref().and_then(|pressure| increment.softer(pressure, &shear));
    let alternates = increment.bodies.shear_lifts() || softens;
    let mut tolerance = if alternates { FIRST.max(LAST * params.tolerance) } else { params.tolerance };
    let (mut last, mut share, mut sharpen) = (f64::INFINITY, 1.0, 1.0);
    for _ in 0..MOST_ROUNDS {
        let mut normal = increment.press(lift.as_ref(), pressure.as_ref(), softer, &mut cap, tolerance)?;
        if normal.stats.iterations == 0 {
            // Good enough by its own displacement, which may be much more than what the shear leaves of it.
            sharpen *= SHARPER;
        }
        let bound = normal.pressure.mapv(|p| increment.friction.bound(p));
        let answer = increment.push(&normal, &bound, &shear, tolerance)?;
        shear = answer.shear;
        let supposed = lift;
        lift = increment.bodies.lift(&shear);
        if let Some(lift) = &lift {
            normal.displacement += lift;
        }
        softer = increment.softer(&normal.pressure, &shear);
        if alternates {
            let state = increment.residual(&normal, softer.as_ref().unwrap_or(&cap));
            (normal.residual, normal.approach) = (state.eta, state.approach);
        }
        normal.residual = normal.residual.max(answer.residual);
        if normal.residual <= params.tolerance {
            return Ok(increment.finish(normal, cap, bound, shear, answer.shift));
        }
        let reached = normal.residual;
        share = if reached < last { f64::min(RISE * share, 1.0) } else { f64::max(0.5 * share, LEAST) };
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
    hardness: Pascal,
    friction: Friction,
    /// Whether the shear takes from the pressure of plastic cells.
    softens: bool,
    loading: Loading,
    /// s₀.
    slip_before: Option<[Field; 2]>,
    params: &'a Params,
    solver: Option<ShearSolver>,
    stats: Stats,
}

impl Increment<'_> {
    /// The caps that the `shear` leaves to the pressure, where it takes from it.
    fn softer(&self, pressure: &Field, shear: &[Field; 2]) -> Option<Field> {
        self.softens.then(|| caps(&self.friction, self.hardness, pressure, shear))
    }

    /// The pressure beside a shear that lifts the surface and leaves it `softer` caps.
    fn press(
        &mut self,
        lift: Option<&Field>,
        pressure: Option<&Field>,
        softer: Option<Field>,
        cap: &mut Field,
        tolerance: f64,
    ) -> Result<Solution> {
        let lifted = lift.map(|lift| self.initial_gap + lift);
        let gap = lifted.as_ref().unwrap_or(self.initial_gap);
        let params = Params { tolerance, ..*self.params };
        let operator = self.bodies.operator.normal();
        let solution = match (pressure, softer) {
            (Some(pressure), Some(softer)) => {
                let start = AtCaps::of(pressure, cap, &softer);
                *cap = softer;
                solve_capped(operator, gap, cap, self.loading.normal, start, &params)?
            }
            (start, _) => solve_normal(operator, gap, self.hardness, self.loading.normal, start, &params)?,
        };
        self.stats = self.stats.and(&solution.stats);
        Ok(solution)
    }

    /// The shear under a pressure.
    fn push(
        &mut self,
        normal: &Solution,
        bound: &Field,
        shear: &[Field; 2],
        tolerance: f64,
    ) -> Result<Answer> {
        let control = match self.loading.tangential {
            Tangential::Displacement(shift) => Rigid::Shift(shift),
            Tangential::Force(force) => Rigid::Force(force),
            Tangential::Sliding(direction) => {
                let shear = direction.map(|n| bound * n);
                return Ok(Answer { shear, shift: [0.0; 2], residual: 0.0 });
            }
        };
        let free_slip = self.bodies.free_slip(&normal.pressure, self.slip_before.as_ref());
        let scale = shear_scale(normal, bound, self.bodies.operator);
        let solver = self.solver.get_or_insert_with(|| ShearSolver::new(self.bodies.operator));
        let task = Task { bound, free_slip: &free_slip, control, scale, tolerance };
        solver.solve(self.bodies.operator, &task, shear, self.params.max_convolutions)
    }

    /// How far the pressure is from equilibrium beside the shear that it has led to.
    fn residual(&self, normal: &Solution, cap: &Field) -> Residual {
        // Of cells that come off their caps by a little the multiplier of the load knows nothing.
        let approach = match self.softens {
            true => Some(normal.approach),
            false => self.loading.normal.approach(),
        };
        residual_under(
            || cap.iter().copied(),
            &normal.pressure,
            &normal.displacement,
            self.initial_gap,
            self.bodies.operator.self_influence().zz,
            approach,
        )
    }

    fn finish(
        mut self,
        mut normal: Solution,
        cap: Field,
        bound: Field,
        shear: [Field; 2],
        shift: [Metre; 2],
    ) -> FrictionalSolution {
        let displacement = self.bodies.displacement(&shear, &normal.pressure);
        normal.stats = self.stats;
        normal.stats.convolutions += self.bodies.convolutions;
        if let Some(solver) = &self.solver {
            normal.stats = normal.stats.and(&solver.stats);
        }
        let (slip, stick) = match self.loading.tangential {
            Tangential::Sliding(_) => {
                let none = || Field::zeros(cap.raw_dim());
                ([none(), none()], none())
            }
            _ => {
                let slip = slip(&normal.pressure, shift, &displacement, self.slip_before.as_ref());
                let stick = stick(&shear, &slip, &bound, self_compliance(self.bodies.operator));
                (slip, stick)
            }
        };
        FrictionalSolution { normal, cap, shear, bound, displacement, shift, slip, stick }
    }
}

/// What a residual of the tangential problem is a share of.
fn shear_scale(normal: &Solution, bound: &Field, operator: &dyn CoupledOperator) -> Metre {
    let local = operator.self_influence().zz * normal.max_pressure();
    let deviation = normal.displacement.std(0.0);
    let share = (bound.sum() / normal.pressure.sum()).min(1.0);
    let largest = normal.displacement.iter().fold(local, |most, u| most.max(u.abs()));
    let scale = share * scale(deviation, largest);
    // Without contact, or without friction, nothing is left to be a share of.
    if scale > 0.0 { scale } else { 1.0 }
}

/// Δs where the bodies touch.
fn slip(
    pressure: &Field,
    shift: [Metre; 2],
    displacement: &[Field; 2],
    before: Option<&[Field; 2]>,
) -> [Field; 2] {
    [0, 1].map(|axis| {
        let mut slip = displacement[axis].mapv(|u| shift[axis] - u);
        if let Some(before) = before {
            slip -= &before[axis];
        }
        slip.zip_mut_with(pressure, |s, p| *s = if *p > 0.0 { *s } else { 0.0 });
        slip
    })
}

/// 1 where |q + Δs/c| ≤ g > 0.
fn stick(shear: &[Field; 2], slip: &[Field; 2], bound: &Field, compliance: f64) -> Field {
    let mut stick = bound.clone();
    let predicted = |axis: usize| &shear[axis] + &slip[axis] / compliance;
    ndarray::Zip::from(&mut stick).and(&predicted(0)).and(&predicted(1)).for_each(|g, x, y| {
        *g = if *g > 0.0 && x.hypot(*y) <= *g { 1.0 } else { 0.0 };
    });
    stick
}

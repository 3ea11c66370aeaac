//! Alternates between the normal and the tangential problem, each under the tractions of the other: a block
//! Gauss–Seidel iteration (Panagiotopoulos 1975), under-relaxed if they influence each other.

use std::borrow::Cow;

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::operator::CoupledOperator;
use crate::solver::friction::bodies::Bodies;
use crate::solver::friction::shear::{Answer, Method, Rigid, Task, method};
use crate::solver::friction::transport::History;
use crate::solver::friction::yielding::{bounds_under_shear, shear_limits, start_within};
use crate::solver::friction::{Friction, FrictionalProblem, FrictionalSolution, Tangential, self_compliance};
use crate::solver::residual::{Residual, residual};
use crate::solver::{Before, Bounds, Interface, NormalProblem, Params, Solution, Stats, Watch};
use crate::units::Metre;
use asperity_base::math::active_set::residual_scale;
use asperity_base::watch::InnerWatch;

/// Tolerance of the first round if pressure and shear influence each other.
const FIRST_TOLERANCE: f64 = 3e-2;
/// Each round is solved to this fraction of the residual after the previous round.
const TOLERANCE_REDUCTION: f64 = 0.1;
/// No round is solved to less than this fraction of the tolerance of the solution.
const MIN_TOLERANCE_SHARE: f64 = 0.5;
/// Factor of the relaxation after a round that has not lowered the residual. The relaxation is the fraction
/// of the change of the normal displacement under shear that the next round applies.
const RELAXATION_REDUCTION: f64 = 0.5;
/// Factor of the relaxation after a round that has lowered the residual, up to 1.
const RELAXATION_GROWTH: f64 = 1.2;
/// Smallest relaxation.
const MIN_RELAXATION: f64 = 0.2;
/// A round converges slowly if it leaves more than this fraction of the previous residual.
const SLOW_CONTRACTION: f64 = 0.5;
/// Largest number of rounds.
const MAX_ROUNDS: usize = 200;

/// The state in which an increment begins.
#[derive(Default)]
pub(super) struct Start {
    /// A pressure near the solution.
    pub(super) pressure: Option<Field>,
    /// The bounds of that pressure.
    pub(super) bounds: Option<Bounds>,
    /// The shear with this pressure.
    pub(super) shear: Option<[Field; 2]>,
    /// Reference of the slip.
    pub(super) history: History,
}

impl Start {
    /// Begins with the tractions of a contact, without its history.
    pub(super) fn near(contact: &FrictionalSolution) -> Self {
        Self {
            pressure: Some(contact.normal.pressure.clone()),
            bounds: Some(contact.normal.bounds.clone()),
            shear: Some(contact.shear.clone()),
            history: History::None,
        }
    }

    /// Sets the reference of the slip.
    pub(super) fn with_history(self, history: History) -> Self {
        Self { history, ..self }
    }
}

/// Solves one increment. The bounds of the `problem` are those of cells without shear; in sliding, those
/// under shear. If it fails, it adds its cost to `failed`.
pub(super) fn alternate(
    operator: &mut dyn CoupledOperator,
    interface: &dyn Interface,
    friction: Friction,
    problem: &FrictionalProblem<'_>,
    start: Start,
    failed: &mut Stats,
) -> Result<FrictionalSolution> {
    let slides = matches!(problem.tangential, Tangential::Sliding(_));
    let grows_junctions = friction.grows_junctions(problem.normal.bounds.upper().min()) && !slides;
    let mut increment = Increment {
        bodies: Bodies { operator, coupling: friction.coupling, convolutions: 0.0 },
        interface,
        friction,
        grows_junctions,
        problem,
        history: start.history,
        within: &InnerWatch(problem.normal.watch),
        shear_method: None,
        stats: Stats::default(),
    };
    if increment.alternates() && !interface.is_hard() {
        return Err(Error::Unsupported(
            "shear that changes the pressures, by its normal displacement or by growing junctions, needs hard walls without attraction",
        ));
    }
    let solution = increment.alternate(start.pressure, start.bounds, start.shear);
    if solution.is_err() {
        *failed = failed.and(&increment.cost());
    }
    solution
}

/// An increment of the loading: data that are the same in all rounds, and the cost of the rounds.
struct Increment<'a> {
    bodies: Bodies<'a>,
    interface: &'a dyn Interface,
    friction: Friction,
    /// Whether shear lowers the pressure of plastic cells, so that their junctions grow.
    grows_junctions: bool,
    problem: &'a FrictionalProblem<'a>,
    history: History,
    /// The watch of the solutions within a round.
    within: &'a dyn Watch,
    shear_method: Option<Box<dyn Method>>,
    stats: Stats,
}

impl Increment<'_> {
    /// Solves the two problems alternately, from a pressure within these bounds and a shear, if they are
    /// known.
    fn alternate(
        &mut self,
        mut pressure: Option<Field>,
        bounds: Option<Bounds>,
        shear: Option<[Field; 2]>,
    ) -> Result<FrictionalSolution> {
        let NormalProblem { gap: initial_gap, bounds: unsheared, params, watch, .. } = self.problem.normal;
        let mut bounds = bounds.unwrap_or_else(|| unsheared.clone());
        let mut shear_displacement = shear.as_ref().and_then(|shear| self.bodies.normal_displacement(shear));
        let shape = initial_gap.raw_dim();
        let mut shear = shear.unwrap_or_else(|| [Field::zeros(shape), Field::zeros(shape)]);
        let mut combined = pressure.as_ref().and_then(|pressure| self.combined_bounds(pressure, &shear));
        let alternates = self.alternates();
        let mut tolerance = if alternates {
            FIRST_TOLERANCE.max(MIN_TOLERANCE_SHARE * params.tolerance)
        } else {
            params.tolerance
        };
        let (mut last, mut relaxation, mut tightening) = (f64::INFINITY, 1.0, 1.0);
        for _ in 0..MAX_ROUNDS {
            let mut normal = self.solve_normal_problem(
                shear_displacement.as_ref(),
                pressure.as_ref(),
                combined,
                &mut bounds,
                tolerance,
            )?;
            let start_met_tolerance = normal.stats.iterations == 0;
            let limit =
                shear_limits(&self.friction, unsheared.upper(), self.grows_junctions, &normal.pressure);
            let answer = self.solve_tangential_problem(&normal, &limit, &shear, tolerance)?;
            shear = answer.shear;
            let assumed = shear_displacement;
            shear_displacement = self.bodies.normal_displacement(&shear);
            if let Some(u) = &shear_displacement {
                normal.displacement += u;
            }
            combined = self.combined_bounds(&normal.pressure, &shear);
            if alternates {
                let state = self.residual(&normal, combined.as_ref().unwrap_or(&bounds));
                (normal.residual, normal.approach) = (state.eta, state.approach);
            }
            normal.residual = normal.residual.max(answer.residual);
            watch.iteration(normal.residual, params.tolerance);
            if normal.residual <= params.tolerance {
                return Ok(self.finish(normal, limit, shear, answer.rigid));
            }
            let reached = normal.residual;
            relaxation = if reached < last {
                f64::min(RELAXATION_GROWTH * relaxation, 1.0)
            } else {
                f64::max(RELAXATION_REDUCTION * relaxation, MIN_RELAXATION)
            };
            if start_met_tolerance && (reached > SLOW_CONTRACTION * last || !self.grows_junctions) {
                // The normal problem has accepted its start relative to its own displacement, which
                // may be much larger than the displacement that remains with the shear.
                tightening *= TOLERANCE_REDUCTION;
            }
            last = reached;
            if let (Some(u), Some(assumed)) = (&mut shear_displacement, assumed) {
                *u = &assumed + relaxation * (&*u - &assumed);
            }
            tolerance = tightening
                * (TOLERANCE_REDUCTION * reached)
                    .min(FIRST_TOLERANCE)
                    .max(MIN_TOLERANCE_SHARE * params.tolerance);
            pressure = Some(normal.pressure);
        }
        let (iterations, tolerance) = (self.stats.iterations, params.tolerance);
        Err(Error::NotConverged { iterations, residual: last, tolerance })
    }

    /// Whether shear changes the pressures, so that the two problems alternate.
    fn alternates(&self) -> bool {
        self.bodies.shear_displaces_normally() || self.grows_junctions
    }

    /// Returns the cost so far.
    fn cost(&self) -> Stats {
        let mut stats = self.stats;
        stats.convolutions += self.bodies.convolutions;
        match &self.shear_method {
            Some(method) => stats.and(method.stats()),
            None => stats,
        }
    }

    /// Returns the bounds of a `pressure` with a `shear`, if junctions grow.
    fn combined_bounds(&self, pressure: &Field, shear: &[Field; 2]) -> Option<Bounds> {
        self.grows_junctions
            .then(|| bounds_under_shear(&self.friction, self.problem.normal.bounds, pressure, shear))
    }

    /// Solves the normal problem under a shear that displaces the surface normally by `shear_displacement`,
    /// with the `combined` bounds of the pressure.
    fn solve_normal_problem(
        &mut self,
        shear_displacement: Option<&Field>,
        pressure: Option<&Field>,
        combined: Option<Bounds>,
        bounds: &mut Bounds,
        tolerance: f64,
    ) -> Result<Solution> {
        let NormalProblem { gap: initial_gap, bounds: unsheared, .. } = self.problem.normal;
        let displaced = shear_displacement.map(|u| initial_gap + u);
        let gap = displaced.as_ref().unwrap_or(initial_gap);
        let params = &Params { tolerance, ..*self.problem.normal.params };
        let start = match (pressure, combined) {
            (Some(pressure), Some(combined)) => {
                let start = start_within(pressure, bounds, &combined);
                *bounds = combined;
                Some(Cow::Owned(start))
            }
            (start, _) => {
                *bounds = unsheared.clone();
                start.map(Cow::Borrowed)
            }
        };
        // The equilibrium of bodies that attract each other depends on the contact before.
        let before = if self.interface.is_hard() {
            start.as_deref().map_or(Before::Apart, Before::Guess)
        } else {
            self.problem.normal.before
        };
        let normal = NormalProblem { gap, bounds, before, params, watch: self.within, ..self.problem.normal };
        let operator = self.bodies.operator.normal();
        let solution = normal.solve(operator, self.interface, self.problem.compliance)?;
        self.stats = self.stats.and(&solution.stats);
        Ok(solution)
    }

    /// Solves the tangential problem under the pressure of a `normal` one.
    fn solve_tangential_problem(
        &mut self,
        normal: &Solution,
        limit: &Field,
        shear: &[Field; 2],
        tolerance: f64,
    ) -> Result<Answer> {
        let control = match self.problem.tangential {
            Tangential::Displacement(displacement) => Rigid::Displacement(displacement),
            Tangential::Force(force) => Rigid::Force(force),
            Tangential::Sliding(direction) => {
                let shear = direction.map(|n| limit * n);
                return Ok(Answer { shear, rigid: [0.0; 2], residual: 0.0 });
            }
        };
        let free_slip = self.bodies.free_slip(&normal.pressure, &self.history);
        let scale = shear_scale(normal, limit, self.bodies.operator);
        let solver = self.shear_method.get_or_insert_with(|| method(&self.history, self.bodies.operator));
        let task = Task { limit, free_slip: &free_slip, control, scale, tolerance };
        solver.solve(
            self.bodies.operator,
            &task,
            shear,
            self.problem.normal.params.max_convolutions,
            self.within,
        )
    }

    /// Computes the residual of the pressure under the shear that follows from it.
    fn residual(&self, normal: &Solution, bounds: &Bounds) -> Residual {
        // The multiplier of the load does not depend on cells that leave their upper bounds by a small
        // amount.
        let approach =
            if self.grows_junctions { Some(normal.approach) } else { self.problem.normal.control.approach() };
        residual(
            &normal.pressure,
            &normal.displacement,
            self.problem.normal.gap,
            bounds,
            self.bodies.operator.self_influence().zz,
            approach,
        )
    }

    fn finish(
        &mut self,
        mut normal: Solution,
        shear_limit: Field,
        shear: [Field; 2],
        rigid: [Metre; 2],
    ) -> FrictionalSolution {
        let displacement = self.bodies.displacement(&shear, &normal.pressure);
        normal.initial_gap.assign(self.problem.normal.gap);
        normal.stats = self.cost();
        let (slip, stick) = match self.problem.tangential {
            Tangential::Sliding(_) => {
                let none = || Field::zeros(shear_limit.raw_dim());
                ([none(), none()], none())
            }
            _ => {
                let slip = where_pressed(&normal.pressure, self.history.slip(rigid, &displacement));
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

/// Returns the scale of the residual of the tangential problem.
fn shear_scale(normal: &Solution, limit: &Field, operator: &dyn CoupledOperator) -> Metre {
    let local = operator.self_influence().zz * normal.max_pressure();
    let deviation = normal.displacement.std(0.0);
    // Cells under tension bear no shear.
    let pressed = normal.pressure.mapv(|p| p.max(0.0));
    let share = (limit.sum() / pressed.sum()).min(1.0);
    let largest = normal.displacement.iter().fold(local, |most, u| most.max(u.abs()));
    let scale = share * residual_scale(deviation, largest);
    // Without contact, or without friction, there is no scale.
    if scale > 0.0 { scale } else { 1.0 }
}

/// Returns the slip of cells in contact, and 0 elsewhere.
fn where_pressed(pressure: &Field, slip: [Field; 2]) -> [Field; 2] {
    slip.map(|mut slip| {
        slip.zip_mut_with(pressure, |s, p| *s = if *p > 0.0 { *s } else { 0.0 });
        slip
    })
}

/// Returns 1 for cells that stick, |q + Δs/c| ≤ g > 0, else 0.
fn stick(shear: &[Field; 2], slip: &[Field; 2], limit: &Field, compliance: f64) -> Field {
    let mut stick = limit.clone();
    let predicted = |axis: usize| &shear[axis] + &slip[axis] / compliance;
    ndarray::Zip::from(&mut stick).and(&predicted(0)).and(&predicted(1)).for_each(|g, x, y| {
        *g = if *g > 0.0 && x.hypot(*y) <= *g { 1.0 } else { 0.0 };
    });
    stick
}

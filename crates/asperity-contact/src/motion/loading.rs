//! Loading history of a static contact, on which its state depends.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::motion::adhesive::press_from;
use crate::motion::contact::facing;
use crate::motion::course::{self, Course, Output, Step};
use crate::motion::pair::Pair;
use crate::motion::record::{AdhesionRecord, IncrementRecord, ShearRecord, StaticRecord};
use crate::motion::state::{Flattening, LoadedContact, LoadingState, Origin};
use crate::motion::watch::{StaticWatch, Watch};
use crate::operator::{Boundary, CoupledOperator, Operator};
use crate::solver::{
    self, Bounds, Control, Equilibrium, Friction, FrictionalSolution, Loading, Params, Rolling,
    RollingSolution, Tangential, solve_frictional_watched, solve_rolling_watched,
};
use crate::units::{Joule, Metre, SquareMetre};

/// One stage of a loading: the values prescribed at its end, and the number of equal steps to reach them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stage {
    /// Loading at the end of the stage. Without friction, tangential values have no effect.
    pub loading: Loading,
    /// Number of equal steps, ≥ 1.
    pub increments: usize,
}

/// Loads a pair at full overlap, stage after stage, from before contact or from a state `under_way`. A resumed loading
/// gives the same result, bit by bit.
///
/// Within a stage, a load, an approach, a force or a displacement grows in equal steps. The first stage starts from 0, or
/// from first touch for an approach. If a stage prescribes another quantity than the one before, that quantity starts from
/// its present value.
///
/// Plastic deformation is irreversible. As long as no plastic interference would decrease, an increment is solved as if
/// loaded at once. As soon as one would, the surfaces stay flattened by the plastic deformation so far, and the increment
/// is solved again on them. This is the incremental law of perfect plasticity: in each increment w grows where p is at its
/// cap, and shrinks nowhere.
///
/// # Errors
/// The errors of [`solver::solve_frictional`], with several increments in an [`Error::AtIncrement`]; those of the outputs;
/// [`Error::Unsupported`] without stages; [`Error::Interrupted`].
///
/// # Panics
/// If the bodies have different shapes.
#[expect(clippy::too_many_arguments, reason = "the contact, its history, and who looks on")]
pub fn load_in_stages(
    pair: &Pair,
    boundary: Boundary,
    friction: Option<&Friction>,
    stages: &[Stage],
    params: &Params,
    under_way: Option<LoadingState>,
    watch: &dyn Watch,
    outputs: &mut [&mut dyn Output],
) -> Result<LoadedContact> {
    let bodies = Bodies::new(pair, boundary, friction, params)?;
    let mut loading = StagedLoading { bodies, stages, state: under_way };
    course::run(&mut loading, watch, outputs)?;
    let state = loading.state.ok_or(Error::Unsupported("a loading needs at least one increment"))?;
    Ok(loading.bodies.finish(state))
}

/// A loading in stages.
struct StagedLoading<'a> {
    bodies: Bodies<'a>,
    stages: &'a [Stage],
    /// State after the last increment; `None` before the first.
    state: Option<LoadingState>,
}

impl Course for StagedLoading<'_> {
    type Solved = LoadingState;

    fn next(&mut self, watch: &dyn Watch) -> Result<Option<LoadingState>> {
        let state = self.state.take();
        let done = state.as_ref().map_or(0, |state| state.increments.len());
        let Some((stage, step)) = Stage::after(self.stages, done) else {
            self.state = state;
            return Ok(None);
        };
        if watch.stop() {
            return Err(Error::Interrupted);
        }
        let origin = match &state {
            Some(state) if step > 1 => state.origin,
            Some(state) => Origin::of(&state.contact),
            None => Origin::apart(self.bodies.gap.iter().copied().fold(f64::INFINITY, f64::min)),
        };
        let Stage { loading, increments } = self.stages[stage];
        let loading = origin.towards(loading, step as f64 / increments as f64);
        let all = Stage::increments(self.stages);
        let watch = StaticWatch::new(watch, done, all, loading.normal);
        let at = |source| Error::AtIncrement { increment: done + 1, source };
        self.bodies.load(stage + 1, loading, origin, state, &watch).map(Some).map_err(|error| match all {
            1 => error,
            _ => error.unless_interrupted(at),
        })
    }

    fn report<'a>(&'a self, state: &'a LoadingState) -> Step<'a> {
        Step::Increment { state, of: Stage::increments(self.stages) }
    }

    fn take(&mut self, state: LoadingState) {
        self.state = Some(state);
    }
}

impl Stage {
    /// Total number of increments of all `stages`.
    pub(super) fn increments(stages: &[Self]) -> usize {
        stages.iter().map(|stage| stage.increments).sum()
    }

    /// Returns the index of the stage and its next step, from 1, after `done` increments; `None` after the last.
    pub(super) fn after(stages: &[Self], done: usize) -> Option<(usize, usize)> {
        let mut left = done;
        for (index, stage) in stages.iter().enumerate() {
            if left < stage.increments {
                return Some((index, left + 1));
            }
            left -= stage.increments;
        }
        None
    }
}

/// Solves the steady state of a pair that rolls along x, see [`solver::solve_rolling`].
///
/// # Errors
/// The errors of [`solver::solve_rolling`].
///
/// # Panics
/// If the bodies have different shapes.
pub fn roll(
    pair: &Pair,
    boundary: Boundary,
    friction: &Friction,
    control: Control,
    rolling: Rolling,
    params: &Params,
    watch: &dyn Watch,
) -> Result<LoadedContact> {
    let (operators, gap) = facing(pair, boundary)?;
    pair.check_no_adhesion()?;
    pair.check_shear()?;
    let mut operator = operators.coupled_on(pair.lower_grid().shape);
    let watch = StaticWatch::new(watch, 0, 1, control);
    LoadedContact::rolling(pair, operator.as_mut(), &gap, friction, control, rolling, params, &watch)
}

impl LoadedContact {
    /// Presses together in one step, without friction, over the initial `gap`.
    pub(super) fn pressed(
        pair: &Pair,
        operator: &mut dyn Operator,
        gap: &Field,
        control: Control,
        params: &Params,
        watch: &dyn solver::Watch,
    ) -> Result<Self> {
        let bounds = pair.bounds(&pair.at_rest(), None);
        let solution = press_from(pair, operator, gap, &bounds, control, None, params, watch)?;
        let plastic = solution.plastic_interference();
        let record = StaticRecord::new(&solution).attracted(pair, &solution);
        let solution = Equilibrium::Frictionless(Box::new(solution));
        Ok(Self { record, increments: Vec::new(), solution, plastic, slip: None, dissipation_error: 0.0 })
    }

    /// Solves the contact in steady rolling along x, over the initial `gap`.
    #[expect(clippy::too_many_arguments, reason = "the contact, what is asked of it, and who looks on")]
    pub(super) fn rolling(
        pair: &Pair,
        operator: &mut dyn CoupledOperator,
        gap: &Field,
        friction: &Friction,
        control: Control,
        rolling: Rolling,
        params: &Params,
        watch: &dyn solver::Watch,
    ) -> Result<Self> {
        let bounds = pair.bounds(&pair.at_rest(), None);
        let rolled =
            solve_rolling_watched(operator, gap, &bounds, friction, control, rolling, params, watch)?;
        let slip_work = rolled.slip_work();
        let RollingSolution { contact: solution, creepage, dissipation } = rolled;
        let plastic = solution.normal.plastic_interference();
        let shear = ShearRecord {
            creepage: Some(creepage),
            spin: Some(rolling.spin),
            moment: Some(solution.moment()),
            slip_work: Some(slip_work),
            ..shear_record(&solution, dissipation)
        };
        let slip = Some(solution.slip.clone());
        let solution = Equilibrium::Frictional(Box::new(solution));
        let record = StaticRecord { shear: Some(shear), ..static_record(&solution, &plastic) };
        Ok(Self { record, increments: Vec::new(), solution, plastic, slip, dissipation_error: 0.0 })
    }
}

/// Two bodies under a loading, and the solver of an increment.
struct Bodies<'a> {
    pair: &'a Pair,
    /// Initial gap of the undeformed bodies.
    gap: Field,
    solver: Solver<'a>,
    bounds: Bounds,
    area: SquareMetre,
    params: &'a Params,
}

enum Solver<'a> {
    Frictionless(&'a Pair, Box<dyn Operator>),
    Frictional(Box<dyn CoupledOperator>, &'a Friction),
}

/// Largest ignored decrease of a plastic interference, in tolerances relative to std(u). Both solutions have an error.
const MAX_DECREASE: f64 = 4.0;

impl<'a> Bodies<'a> {
    fn new(
        pair: &'a Pair,
        boundary: Boundary,
        friction: Option<&'a Friction>,
        params: &'a Params,
    ) -> Result<Self> {
        let (operators, gap) = facing(pair, boundary)?;
        let shape = pair.lower_grid().shape;
        let solver = match friction {
            None => Solver::Frictionless(pair, params.device.operator(&operators, shape)),
            Some(friction) => {
                pair.check_no_adhesion()?;
                pair.check_shear()?;
                Solver::Frictional(operators.coupled_on(shape), friction)
            }
        };
        let bounds = pair.bounds(&pair.at_rest(), None);
        Ok(Self { pair, gap, solver, bounds, area: pair.cell_area(), params })
    }

    /// Returns the state after an increment that starts from the state `before`.
    fn load(
        &mut self,
        stage: usize,
        loading: Loading,
        origin: Origin,
        before: Option<LoadingState>,
        watch: &dyn solver::Watch,
    ) -> Result<LoadingState> {
        let (last, mut flattening, mut increments, slip, error) = match before {
            Some(LoadingState { contact, flattening, increments, slip, dissipation_error, .. }) => {
                (Some(contact), flattening, increments, slip, dissipation_error)
            }
            None => {
                let deepest = Field::zeros(self.gap.raw_dim());
                (None, Flattening { kept: None, deepest }, Vec::new(), None, 0.0)
            }
        };
        let (bounds, params) = (&self.bounds, self.params);
        let mut contact =
            self.solver.solve(&flattening.open(&self.gap), bounds, loading, last.as_ref(), params, watch)?;
        let mut stats = contact.normal().stats;
        let mut plastic = contact.normal().plastic_interference();
        let allowed = MAX_DECREASE * params.tolerance * contact.normal().displacement.std(0.0);
        if flattening.exceeds(&plastic, allowed) {
            flattening.keep();
            contact = self.solver.solve(
                &flattening.open(&self.gap),
                bounds,
                loading,
                last.as_ref(),
                params,
                watch,
            )?;
            stats = stats.and(&contact.normal().stats);
            plastic = contact.normal().plastic_interference();
        }
        flattening.deepen(&plastic);
        let of_friction = contact.frictional().map(|solution| {
            let last = last.as_ref().and_then(Equilibrium::frictional);
            let error = last.map_or(0.0, |last| solution.dissipation_error(last));
            [solution.dissipation(last), error]
        });
        let slip = match (slip, contact.frictional()) {
            (Some([x, y]), Some(solution)) => Some([x + &solution.slip[0], y + &solution.slip[1]]),
            (_, solution) => solution.map(|solution| solution.slip.clone()),
        };
        let [dissipation, more_error] = of_friction.unwrap_or_default();
        let adhesion = self.pair.adhesion().map(|adhesion| {
            let record = AdhesionRecord::of(adhesion, contact.normal());
            let last = last.as_ref().map(Equilibrium::normal);
            last.map_or(record, |last| record.since(adhesion, contact.normal(), last))
        });
        increments.push(IncrementRecord {
            increment: increments.len() + 1,
            stage,
            plastic_volume: self.area * flattening.whole(plastic).sum(),
            dissipation,
            adhesion,
            iterations: stats.iterations,
            convolutions: stats.convolutions,
            ..IncrementRecord::of(&contact)
        });
        let dissipation_error = error + more_error;
        Ok(LoadingState { increments, contact, origin, flattening, slip, dissipation_error })
    }

    /// Returns the contact at the end of its loading.
    fn finish(self, state: LoadingState) -> LoadedContact {
        let LoadingState { increments, contact: solution, flattening, slip, dissipation_error, .. } = state;
        let now = solution.normal().plastic_interference();
        let plastic = flattening.whole(now);
        let sum = |value: fn(&IncrementRecord) -> f64| increments.iter().map(value).sum::<f64>();
        let shear = solution.frictional().map(|solution| shear_record(solution, sum(|i| i.dissipation)));
        let adhesion = increments.last().and_then(|last| last.adhesion);
        let adhesion = adhesion
            .map(|last| last.after(increments.iter().filter_map(|increment| increment.adhesion.as_ref())));
        let normal = solution.normal();
        let gap = &self.gap + &normal.displacement - normal.approach;
        let record = StaticRecord {
            mean_gap: gap.mean().unwrap_or(0.0),
            iterations: increments.iter().map(|increment| increment.iterations).sum(),
            convolutions: sum(|increment| increment.convolutions),
            shear,
            adhesion,
            ..static_record(&solution, &plastic)
        };
        LoadedContact { record, increments, solution, plastic, slip, dissipation_error }
    }
}

impl Solver<'_> {
    /// Solves an increment over the initial `gap`, from the `last` one.
    fn solve(
        &mut self,
        gap: &Field,
        bounds: &Bounds,
        loading: Loading,
        last: Option<&Equilibrium>,
        params: &Params,
        watch: &dyn solver::Watch,
    ) -> Result<Equilibrium> {
        match self {
            Self::Frictionless(pair, operator) => {
                let last = last.map(Equilibrium::normal);
                let operator = operator.as_mut();
                press_from(pair, operator, gap, bounds, loading.normal, last, params, watch)
                    .map(|solution| Equilibrium::Frictionless(Box::new(solution)))
            }
            Self::Frictional(operator, friction) => {
                let last = last.and_then(Equilibrium::frictional);
                solve_frictional_watched(
                    operator.as_mut(),
                    gap,
                    bounds,
                    friction,
                    loading,
                    last,
                    params,
                    watch,
                )
                .map(|solution| Equilibrium::Frictional(Box::new(solution)))
            }
        }
    }
}

impl Origin {
    /// Creates the state of bodies that just do not touch, at this approach.
    pub(super) fn apart(approach: Metre) -> Self {
        Self { load: 0.0, approach, force: [0.0; 2], displacement: [0.0; 2] }
    }

    /// Creates the state of a contact in equilibrium.
    pub(super) fn of(contact: &Equilibrium) -> Self {
        let (normal, shear) = (contact.normal(), contact.frictional());
        Self {
            load: normal.load(),
            approach: normal.approach,
            force: shear.map_or([0.0; 2], FrictionalSolution::force),
            displacement: shear.map_or([0.0; 2], |solution| solution.rigid_displacement),
        }
    }

    /// Interpolates the loading towards the end of the stage, which is met exactly.
    pub(super) fn towards(&self, end: Loading, share: f64) -> Loading {
        let between = |from: f64, to: f64| if share == 1.0 { to } else { from + share * (to - from) };
        let both = |from: [f64; 2], to: [f64; 2]| [between(from[0], to[0]), between(from[1], to[1])];
        Loading {
            normal: match end.normal {
                Control::Load(load) => Control::Load(between(self.load, load)),
                Control::Approach(approach) => Control::Approach(between(self.approach, approach)),
            },
            tangential: match end.tangential {
                Tangential::Force(force) => Tangential::Force(both(self.force, force)),
                Tangential::Displacement(displacement) => {
                    Tangential::Displacement(both(self.displacement, displacement))
                }
                sliding @ Tangential::Sliding(_) => sliding,
            },
        }
    }
}

impl IncrementRecord {
    /// Creates the record of an increment from the contact at its end.
    pub(super) fn of(contact: &Equilibrium) -> Self {
        let (normal, shear) = (contact.normal(), contact.frictional());
        let area = normal.grid.cell_area();
        let [tangential_force_x, tangential_force_y] = shear.map_or([0.0; 2], FrictionalSolution::force);
        let [tangential_displacement_x, tangential_displacement_y] =
            shear.map_or([0.0; 2], |solution| solution.rigid_displacement);
        Self {
            load: normal.load(),
            approach: normal.approach,
            tangential_force_x,
            tangential_force_y,
            tangential_displacement_x,
            tangential_displacement_y,
            contact_area: area * normal.contact_cells() as f64,
            stick_area: area * shear.map_or(0.0, |solution| solution.stick.sum()),
            max_pressure: normal.max_pressure(),
            max_shear: shear.map_or(0.0, FrictionalSolution::max_shear),
            elastic_energy: contact.elastic_energy(),
            iterations: normal.stats.iterations,
            convolutions: normal.stats.convolutions,
            residual: normal.residual,
            ..Self::default()
        }
    }
}

/// Returns the record of a contact with its plastic interference so far, without its shear.
pub(super) fn static_record(contact: &Equilibrium, plastic: &Field) -> StaticRecord {
    StaticRecord {
        elastic_energy: contact.elastic_energy(),
        plastic_volume: contact.normal().grid.cell_area() * plastic.sum(),
        ..StaticRecord::new(contact.normal())
    }
}

pub(super) fn shear_record(solution: &FrictionalSolution, dissipation: Joule) -> ShearRecord {
    let force = solution.force();
    let load = solution.normal.load();
    let force_ratio = if load > 0.0 { force[0].hypot(force[1]) / load } else { 0.0 };
    let sticks = solution.stick.sum();
    ShearRecord {
        tangential_force: force,
        force_ratio,
        friction_coefficient: (load > 0.0 && sticks == 0.0).then_some(force_ratio),
        tangential_displacement: solution.rigid_displacement,
        stick_area: solution.normal.grid.cell_area() * sticks,
        max_shear: solution.max_shear(),
        dissipation,
        slip_work: None,
        creepage: None,
        spin: None,
        moment: None,
    }
}

//! Loading history of a static contact, on which its state depends.

use std::borrow::Cow;

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::motion::contact::facing;
use crate::motion::course::{self, Course, Output, Step, StepRow};
use crate::motion::creeping;
use crate::motion::extrapolation::Acceleration;
use crate::motion::fretting::{ChangedBodies, Changes};
use crate::motion::law::Law;
use crate::motion::memory::Memory;
use crate::motion::pair::Pair;
use crate::motion::press::{shear_record, static_record};
use crate::motion::record::{CreepRecord, IncrementRecord, StaticRecord};
use crate::motion::report::CycleReport;
use crate::motion::slip::SlipRegime;
use crate::motion::stage::{Origin, Progress, Stage};
use crate::motion::state::{Flattening, LoadedContact, LoadingState};
use crate::motion::watch::{StaticWatch, Watch};
use crate::motion::yielding::Yielding;
use crate::operator::Boundary;
use crate::plasticity::{PlasticBody, PlasticParams};
use crate::solver::{
    self, ContactProblem, ContactSolver, Control, Equilibrium, Friction, FrictionalSolution, InterfaceRecord,
    Loading, Params,
};
use crate::temperature::Thermal;
use crate::units::Kelvin;

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
/// The errors of [`StagedLoading`].
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
    let loading = StagedLoading::new(pair.clone(), boundary, friction.copied(), stages.to_vec(), *params)?;
    loading.run(under_way, watch, outputs)
}

/// Two bodies that are loaded at full overlap, stage after stage, see [`load_in_stages`], and that laws may change where they slip.
pub struct StagedLoading {
    pair: Pair,
    /// Initial gap of the undeformed bodies.
    gap: Field,
    response: Response,
    params: Params,
    boundary: Boundary,
    stages: Vec<Stage>,
    laws: Vec<Box<dyn Law>>,
    memories: Vec<Box<dyn Memory>>,
    acceleration: Acceleration,
    bulk: [Kelvin; 2],
    thermal: Option<[Thermal; 2]>,
}

/// How the bodies of a loading answer.
enum Response {
    /// By an elastic contact, with their memory if they creep.
    Elastic(Box<dyn ContactSolver>),
    /// With plastic flow below their surfaces.
    Yielding(Box<Yielding>),
}

impl Response {
    /// Whether cells may stick.
    fn sticks(&self) -> bool {
        match self {
            Self::Elastic(solver) => solver.sticks(),
            Self::Yielding(yielding) => yielding.sticks(),
        }
    }
}

impl StagedLoading {
    /// Creates the loading of a `pair`.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] or [`Error::Unsupported`] for invalid input.
    ///
    /// # Panics
    /// If the bodies have different shapes.
    pub fn new(
        pair: Pair,
        boundary: Boundary,
        friction: Option<Friction>,
        stages: Vec<Stage>,
        params: Params,
    ) -> Result<Self> {
        stages.iter().filter_map(|stage| stage.cycles).try_for_each(|cycles| cycles.checked().map(|_| ()))?;
        pair.check_creep()?;
        let (operators, gap) = facing(&pair, boundary)?;
        let shape = pair.lower_grid().shape;
        let solver = SlipRegime::from(friction).solver(&pair, &operators, shape, params.device)?;
        let (acceleration, bulk) = (Acceleration::NONE, [f64::NAN; 2]);
        let (laws, memories) = (Vec::new(), Vec::new());
        let (thermal, response) = (None, Response::Elastic(solver));
        Ok(Self {
            pair,
            gap,
            response,
            params,
            boundary,
            stages,
            laws,
            memories,
            acceleration,
            bulk,
            thermal,
        })
    }

    /// Adds plastic flow below the surfaces of the given `bodies`, lower one first, with the convergence criteria of a step. Their load is taken
    /// off at the end in so many `unloading` steps, ≥ 1, or stays. Such a loading is not resumed.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for an elasto-plastic body with a hardness, for viscoelastic bodies, and for bodies that attract each other.
    ///
    /// # Panics
    /// If no body is given, or if the grid of one differs from that of its surface.
    pub fn with_plastic(
        self,
        bodies: [Option<PlasticBody>; 2],
        plastic: PlasticParams,
        unloading: Option<usize>,
    ) -> Result<Self> {
        let Response::Elastic(solver) = self.response else {
            return Err(Error::Unsupported("the bodies of this loading are elasto-plastic already"));
        };
        let end = (plastic, unloading);
        let yielding = Yielding::new(&self.pair, &self.gap, solver, bodies, end, self.params)?;
        Ok(Self { response: Response::Yielding(Box::new(yielding)), ..self })
    }

    /// Adds a `law` by which slip changes the bodies. It needs friction.
    #[must_use]
    pub fn with_law(self, law: impl Law + 'static) -> Self {
        self.with_laws(vec![Box::new(law)])
    }

    /// Adds several laws, as [`Self::with_law`] does.
    #[must_use]
    pub fn with_laws(mut self, laws: Vec<Box<dyn Law>>) -> Self {
        self.laws.extend(laws);
        self
    }

    /// Adds a `memory` of whole cycles.
    #[must_use]
    pub fn with_memory(mut self, memory: Box<dyn Memory>) -> Self {
        self.memories.push(memory);
        self
    }

    /// Lets computed cycles stand for several, within these limits.
    #[must_use]
    pub fn with_acceleration(self, acceleration: Acceleration) -> Self {
        Self { acceleration, ..self }
    }

    /// Sets the temperatures of the bodies, > 0, which the growth of some films needs.
    #[must_use]
    pub fn with_bulk(self, bulk: [Kelvin; 2]) -> Self {
        Self { bulk, ..self }
    }

    /// Adds frictional heating of bodies with these thermal constants, lower one first, to their cycles. Laws then see the steady temperature
    /// by the mean heat of the last computed cycle; before there is one, that of the bodies. It needs their temperatures and the periods.
    #[must_use]
    pub fn with_heat(self, thermal: [Thermal; 2]) -> Self {
        Self { thermal: Some(thermal), ..self }
    }

    /// The bodies before the loading.
    pub fn pair(&self) -> &Pair {
        &self.pair
    }

    /// Loads the bodies, from before contact or from a state `under_way`. A resumed loading gives the same result, bit by bit.
    ///
    /// # Errors
    /// The errors of [`solver::solve_frictional`], with several increments in an [`Error::AtIncrement`]; those of the outputs;
    /// [`Error::Unsupported`] without stages and for laws without friction; [`Error::WornAway`]; [`Error::Interrupted`].
    pub fn run(
        mut self,
        under_way: Option<LoadingState>,
        watch: &dyn Watch,
        outputs: &mut [&mut dyn Output],
    ) -> Result<LoadedContact> {
        let mut state = under_way;
        let mut changes = self.changes()?;
        if let (Some(changes), Some(changed)) =
            (&mut changes, state.as_mut().and_then(|state| state.changed.as_mut()))
        {
            changes.resume(changed);
        }
        let mut increments = Increments { loading: self, changes, state, loaded: None };
        course::run(&mut increments, watch, outputs)?;
        let Increments { mut loading, state, loaded, .. } = increments;
        let state = state.ok_or(Error::Unsupported("a loading needs at least one increment"))?;
        Ok(match (&mut loading.response, loaded) {
            (Response::Yielding(yielding), Some(loaded)) => {
                yielding.unloaded(LoadedContact { increments: state.increments, ..loaded })
            }
            _ => loading.finish(state),
        })
    }

    /// Prepares the bodies for the laws that change them and for the memories of their cycles; `None` without any.
    fn changes(&mut self) -> Result<Option<Changes>> {
        let (laws, memories) = (std::mem::take(&mut self.laws), std::mem::take(&mut self.memories));
        if laws.is_empty() && memories.is_empty() {
            return Ok(None);
        }
        if !laws.is_empty() && !self.response.sticks() {
            return Err(Error::Unsupported(
                "laws change the bodies of a loading by slip, which needs friction",
            ));
        }
        let remembers = self.pair.creep().is_some() || matches!(self.response, Response::Yielding(_));
        if remembers && self.acceleration.max_jump > 1 {
            return Err(Error::Unsupported(
                "cycles of bodies that creep or flow below their surfaces are not extrapolated",
            ));
        }
        let (operators, _) = facing(&self.pair, self.boundary)?;
        let with = (&operators, self.boundary, self.params);
        let heat = (self.bulk, self.thermal);
        Changes::new(&mut self.pair, laws, memories, self.acceleration, heat, with).map(Some)
    }
}

/// The increments of a loading, one after the other.
struct Increments {
    loading: StagedLoading,
    changes: Option<Changes>,
    /// State after the last increment; `None` before the first.
    state: Option<LoadingState>,
    /// Elasto-plastic bodies under their last load, once it is reached.
    loaded: Option<LoadedContact>,
}

impl Course for Increments {
    type Solved = LoadingState;

    fn next(&mut self, watch: &dyn Watch) -> Result<Option<LoadingState>> {
        let state = self.state.take();
        let next = state.as_ref().map_or(Progress::BEGIN, |state| state.next);
        let stage = match self.loading.stages.get(next.stage) {
            Some(stage) => Some(*stage),
            None => state.as_ref().and_then(|state| self.unloading(state)),
        };
        let Some(stage) = stage else {
            self.state = state;
            return Ok(None);
        };
        if watch.stop() {
            return Err(Error::Interrupted);
        }
        let done = state.as_ref().map_or(0, |state| state.increments.len());
        let origin = match &state {
            Some(state) if !next.begins_stage() => state.origin,
            Some(state) => Origin::of(&state.contact),
            None => Origin::apart(self.loading.gap.iter().copied().fold(f64::INFINITY, f64::min)),
        };
        let (loading, share) = stage.at(next.step, &origin);
        let all = done + next.left(&self.loading.stages, 1) + self.unloading_steps();
        let watch = StaticWatch::new(watch, done, all, loading.normal);
        let at = |source| Error::AtIncrement { increment: done + 1, source };
        self.load(next, loading, share, origin, state, &watch).map(Some).map_err(|error| match all {
            1 => error,
            _ => error.unless_interrupted(at),
        })
    }

    fn report<'a>(&'a self, state: &'a LoadingState) -> Step<'a> {
        let changed = state.changed.as_ref().filter(|_| !state.next.begins_stage());
        let represented = changed.and_then(|changed| Some(changed.last.as_ref()?.extrapolation.passes));
        let left = state.next.left(&self.loading.stages, represented.unwrap_or(1));
        let record = state.increments.last().expect("the increment just done");
        let number = state.increments.len();
        let left = left + self.unloading_steps();
        let yields = matches!(self.loading.response, Response::Yielding(_));
        let is_loading = self.loaded.is_none();
        Step {
            contact: is_loading.then(|| state.contact.normal()),
            flattening: Some(&state.flattening),
            changed: state.changed.as_ref().map(|changed| &changed.pair),
            state: (!yields).then_some(state),
            cycle: self.loading.cycle(state),
            ends_loading: yields && is_loading && state.next.stage == self.loading.stages.len(),
            ..Step::new(number, number + left, StepRow::Increment(record))
        }
    }

    fn take(&mut self, state: LoadingState) {
        self.state = Some(state);
    }
}

/// Largest ignored decrease of a plastic interference, in tolerances relative to std(u). Both solutions have an error.
const MAX_DECREASE: f64 = 4.0;

impl Increments {
    /// Number of unloading steps of elasto-plastic bodies that are still to come, before the first of them.
    fn unloading_steps(&self) -> usize {
        match &self.loading.response {
            Response::Yielding(yielding) if self.loaded.is_none() => yielding.unloading.unwrap_or(0),
            _ => 0,
        }
    }

    /// Keeps the contact of elasto-plastic bodies under their last load, and adds the stage that takes the load off, if it is taken off.
    fn unloading(&mut self, state: &LoadingState) -> Option<Stage> {
        if self.loaded.is_some() || matches!(self.loading.response, Response::Elastic(_)) {
            return None;
        }
        let loaded = self.loading.finish(state.clone());
        let Response::Yielding(yielding) = &mut self.loading.response else { return None };
        let stage = yielding.unloading_from(&state.contact);
        self.loaded = Some(yielding.loaded(loaded));
        self.loading.stages.extend(stage);
        stage
    }

    /// Returns the state after an increment that starts from the state `before`, in a `share` of the time of a cycle.
    fn load(
        &mut self,
        next: Progress,
        loading: Loading,
        share: f64,
        origin: Origin,
        before: Option<LoadingState>,
        watch: &dyn solver::Watch,
    ) -> Result<LoadingState> {
        let (last, mut flattening, mut increments, slip, error, mut changed, mut memory) = match before {
            Some(LoadingState {
                contact,
                flattening,
                increments,
                slip,
                dissipation_error,
                changed,
                memory,
                ..
            }) => (Some(contact), flattening, increments, slip, dissipation_error, changed, memory),
            None => {
                let deepest = Field::zeros(self.loading.gap.raw_dim());
                let begun = self.changes.as_ref().map(|changes| changes.begin(self.loading.pair.clone()));
                let pair = &self.loading.pair;
                let memory = creeping::memory(pair);
                (None, Flattening { kept: None, deepest }, Vec::new(), None, 0.0, begun, memory)
            }
        };
        let StagedLoading { pair, gap, response, params, stages, .. } = &mut self.loading;
        let (pair, gap) = match &changed {
            None => (&*pair, Cow::Borrowed(&*gap)),
            Some(ChangedBodies { pair, .. }) => (pair, Cow::Owned(pair.initial_gap(&pair.at_rest()))),
        };
        // Bodies that attract each other come from their last contact on the surfaces as they are now.
        let last = match &changed {
            Some(_) if !pair.interface().is_hard() => last.map(|last| last.over(&flattening.open(&gap))),
            _ => last,
        };
        let duration = stages[next.stage].duration(next.step, share);
        let bounds = pair.bounds(&pair.at_rest());
        let solve = |solver: &mut dyn ContactSolver, gap: &Field| {
            let before = last.as_ref();
            solver.solve(&ContactProblem {
                before,
                ..ContactProblem::new(gap, &bounds, loading, params, watch)
            })
        };
        let mut flow = None;
        let mut contact = match (&mut *response, &mut memory) {
            (Response::Yielding(yielding), _) => {
                let (contact, of_increment) = yielding.load(&flattening.open(&gap), loading, watch)?;
                flow = Some(of_increment);
                contact
            }
            (Response::Elastic(solver), None) => solve(solver.as_mut(), &flattening.open(&gap))?,
            (Response::Elastic(solver), Some(memory)) => {
                let before = last.as_ref();
                let problem =
                    ContactProblem { before, ..ContactProblem::new(&gap, &bounds, loading, params, watch) };
                creeping::load(solver.normal(), pair.modulus(), memory, &problem, duration)?
            }
        };
        let mut stats = contact.normal().stats;
        let mut plastic = contact.normal().plastic_interference();
        match &mut *response {
            Response::Elastic(solver) => {
                let allowed = MAX_DECREASE * params.tolerance * contact.normal().displacement.std(0.0);
                if flattening.exceeds(&plastic, allowed) {
                    flattening.keep();
                    contact = solve(solver.as_mut(), &flattening.open(&gap))?;
                    stats = stats.and(&contact.normal().stats);
                    plastic = contact.normal().plastic_interference();
                }
                flattening.deepen(&plastic);
            }
            // Plastic flow below depends on the path anyway.
            Response::Yielding(_) if bounds.upper().min().is_finite() => {
                flattening.deepen(&plastic);
                flattening.keep();
                plastic.fill(0.0);
            }
            Response::Yielding(_) => {}
        }
        let [dissipation, more_error] = contact.dissipation(last.as_ref());
        let slip = match (slip, contact.slip()) {
            (Some([x, y]), Some(more)) => Some([x + &more[0], y + &more[1]]),
            (_, slip) => slip.cloned(),
        };
        let before = last.as_ref().map(Equilibrium::normal);
        let interface = InterfaceRecord::of(pair.interface(), contact.normal(), before);
        let area = pair.cell_area();
        let stage = &stages[next.stage];
        let (mut represented, mut gone) = (1, None);
        if let (Some(changes), Some(changed)) = (&mut self.changes, &mut changed) {
            if next.begins_stage() {
                (changed.last, changed.computed) = (None, 0);
            }
            let before = last.as_ref().and_then(Equilibrium::frictional);
            changed.work += dissipation;
            if next.step > 0 {
                let period = stage.cycles.and_then(|cycles| cycles.period).unwrap_or(f64::NAN);
                if let Some(now) = contact.frictional() {
                    changes.add(changed, now, before, if share > 0.0 { share * period } else { 0.0 });
                }
                changed.cycle_work += dissipation;
            }
            match stage.cycles {
                Some(cycles) => {
                    changes.see(changed, &contact, last.as_ref().filter(|_| next.step > 0));
                    if next.ends_cycle(stages) {
                        changes.warm(changed, contact.normal(), cycles.period)?;
                        let volumes = match &mut *response {
                            Response::Yielding(yielding) if changes.remembers() => yielding.volumes(),
                            _ => Vec::new(),
                        };
                        changes.look(changed, &volumes, &|| watch.stop())?;
                        let left = cycles.count - next.cycles;
                        let gap = match response {
                            Response::Elastic(_) => flattening.open(&gap),
                            // The surfaces with their plastic displacement.
                            Response::Yielding(_) => Cow::Borrowed(&contact.normal().initial_gap),
                        };
                        // The load or the approach is that of the contact itself, as closely as it is solved.
                        let now = contact.normal();
                        let control = match loading.normal {
                            Control::Load(_) => Control::Load(now.load()),
                            Control::Approach(_) => Control::Approach(now.approach),
                        };
                        let cycles = [next.cycles, left];
                        let (stands_for, depth) =
                            changes.act_for_cycles(changed, now, (&gap, control), cycles)?;
                        (represented, gone) = (stands_for, Some(depth));
                    }
                }
                None => gone = Some(changes.act_once(changed)?),
            }
            if let (Response::Yielding(yielding), Some(gone)) = (response, gone) {
                yielding.uncover(&gone);
            }
        }
        let removes = self.changes.as_ref().is_some_and(Changes::remove);
        let following = next.after(stages, represented, removes);
        let fretting =
            self.changes.as_ref().zip(changed.as_ref()).map(|(changes, changed)| changes.record(changed));
        let heat = self
            .changes
            .as_ref()
            .zip(changed.as_ref())
            .and_then(|(changes, changed)| changes.heat_record(changed));
        let creep = memory.as_ref().map(|_| {
            let before = increments.last().and_then(|last| last.creep).unwrap_or_default();
            CreepRecord { time: before.time + duration }
        });
        increments.push(IncrementRecord {
            increment: increments.len() + 1,
            creep,
            stage: next.stage + 1,
            heat,
            fretting,
            plastic_volume: area * flattening.total(plastic).sum(),
            dissipation,
            interface,
            plastic: flow,
            iterations: stats.iterations,
            convolutions: stats.convolutions,
            ..IncrementRecord::of(&contact)
        });
        let dissipation_error = error + more_error;
        let next = following;
        Ok(LoadingState {
            increments,
            contact,
            origin,
            flattening,
            slip,
            dissipation_error,
            next,
            changed,
            memory,
        })
    }
}

impl StagedLoading {
    /// Returns the cycle that ends with the last increment of a `state`, if there is one and its bodies change or have a memory.
    fn cycle<'a>(&self, state: &'a LoadingState) -> Option<CycleReport<'a>> {
        let (end, before) = state.increments.split_last()?;
        let changed = state.changed.as_ref()?;
        let done = |increment: &IncrementRecord| increment.fretting.map_or(0, |bodies| bodies.cycles);
        if done(end) == before.last().map_or(0, done) {
            return None;
        }
        let increments = state.increments.rchunks(self.stages[end.stage - 1].steps()).next()?;
        let load = increments.iter().map(|increment| increment.load).sum::<f64>() / increments.len() as f64;
        Some(CycleReport {
            number: changed.computed,
            done: done(end),
            step: end.increment,
            stage: Some(end.stage),
            mean_pressure: load / changed.pair.lower_grid().area(),
            pair: &changed.pair,
            pass: None,
            watch: &(),
        })
    }

    /// Returns the contact at the end of its loading.
    fn finish(&self, state: LoadingState) -> LoadedContact {
        let LoadingState {
            increments, contact: solution, flattening, slip, dissipation_error, changed, ..
        } = state;
        let normal = solution.normal();
        let plastic = match (&self.response, &flattening.kept) {
            (Response::Elastic(_), _) => flattening.total(normal.plastic_interference()),
            // All of it is kept.
            (Response::Yielding(_), Some(kept)) => kept.clone(),
            (Response::Yielding(_), None) => Field::zeros(normal.pressure.raw_dim()),
        };
        let sum = |value: fn(&IncrementRecord) -> f64| increments.iter().map(value).sum::<f64>();
        // Cycles that were not computed have taken energy, too, with the relative error of those that were.
        let computed = sum(|increment| increment.dissipation);
        let dissipation = changed.as_ref().map_or(computed, |changed| changed.work);
        let dissipation_error =
            if computed > 0.0 { dissipation_error * (dissipation / computed) } else { dissipation_error };
        let shear = shear_record(&solution, dissipation);
        let (fretting, heat) = increments.last().map_or((None, None), |last| (last.fretting, last.heat));
        let of_interface = || increments.iter().filter_map(|increment| increment.interface.as_ref());
        let interface = of_interface().next_back().map(|last| last.after(of_interface()));
        let gap = match (&self.response, &changed) {
            (Response::Yielding(yielding), Some(changed)) => {
                changed.pair.initial_gap(&changed.pair.at_rest()) + yielding.displacement(normal)
            }
            // The surfaces with their plastic displacement, below 0 by what a hardness has flattened, as for other bodies.
            (Response::Yielding(_), None) => {
                &normal.initial_gap - &(&plastic - &normal.plastic_interference())
            }
            (Response::Elastic(_), Some(changed)) => changed.pair.initial_gap(&changed.pair.at_rest()),
            (Response::Elastic(_), None) => self.gap.clone(),
        };
        let gap = gap + &normal.displacement - normal.approach;
        let record = StaticRecord {
            mean_gap: gap.mean().unwrap_or(0.0),
            iterations: increments.iter().map(|increment| increment.iterations).sum(),
            convolutions: sum(|increment| increment.convolutions),
            shear,
            interface,
            fretting,
            heat,
            ..static_record(&solution, &plastic)
        };
        let plastic_result = None;
        LoadedContact {
            record,
            increments,
            solution,
            plastic,
            slip,
            dissipation_error,
            changed,
            plastic_result,
        }
    }
}

impl IncrementRecord {
    /// Creates the record of an increment from the contact at its end.
    pub(super) fn of(contact: &Equilibrium) -> Self {
        let normal = contact.normal();
        let [tangential_force_x, tangential_force_y] = contact.force();
        let [tangential_displacement_x, tangential_displacement_y] = contact.rigid_displacement();
        Self {
            load: normal.load(),
            approach: normal.approach,
            tangential_force_x,
            tangential_force_y,
            tangential_displacement_x,
            tangential_displacement_y,
            contact_area: normal.grid.cell_area() * normal.contact_cells() as f64,
            stick_area: contact.stick_area(),
            max_pressure: normal.max_pressure(),
            max_shear: contact.frictional().map_or(0.0, FrictionalSolution::max_shear),
            elastic_energy: contact.elastic_energy(),
            iterations: normal.stats.iterations,
            convolutions: normal.stats.convolutions,
            residual: normal.residual,
            ..Self::default()
        }
    }
}

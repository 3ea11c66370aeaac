//! The increments of a loading, one after the other.

use std::borrow::Cow;

use super::{Response, StagedLoading};
use crate::error::{Error, Result};
use crate::grid::Field;
use crate::motion::course::{Course, Step, StepRow};
use crate::motion::creeping;
use crate::motion::fretting::{ChangedBodies, Fretting};
use crate::motion::record::{CreepRecord, IncrementRecord};
use crate::motion::stage::{Origin, Progress, Stage};
use crate::motion::state::{Flattening, LoadedContact, LoadingState};
use crate::motion::watch::{StaticWatch, Watch};
use crate::solver::{
    self, ContactProblem, ContactSolver, Control, Equilibrium, FrictionalSolution, InterfaceRecord, Loading,
};

/// The increments of a loading, one after the other.
pub(super) struct Increments {
    pub(super) loading: StagedLoading,
    pub(super) fretting: Option<Fretting>,
    /// State after the last increment; `None` before the first.
    pub(super) state: Option<LoadingState>,
    /// Elasto-plastic bodies under their last load, once it is reached.
    pub(super) loaded: Option<LoadedContact>,
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
            Some(state) => Origin::from_contact(&state.contact),
            None => Origin::apart(self.loading.gap.iter().copied().fold(f64::INFINITY, f64::min)),
        };
        let (loading, share) = stage.loading_at(next.step, &origin);
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
        let left = state.next.left(&self.loading.stages, represented.unwrap_or(1)) + self.unloading_steps();
        let record = state.increments.last().expect("the increment just done");
        let number = state.increments.len();
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

/// Largest ignored decrease of a plastic interference, in tolerances relative to std(u). Both solutions have
/// an error.
const MAX_DECREASE: f64 = 4.0;

impl Increments {
    /// Number of unloading steps of elasto-plastic bodies that are still to come, before the first of them.
    fn unloading_steps(&self) -> usize {
        match &self.loading.response {
            Response::Yielding(yielding) if self.loaded.is_none() => yielding.unloading.unwrap_or(0),
            _ => 0,
        }
    }

    /// Keeps the contact of elasto-plastic bodies under their last load, and adds the stage that takes the
    /// load off, if it is taken off.
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

    /// Returns the state after an increment that starts from the state `before`, in a `share` of the time of
    /// a cycle.
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
                let begun = self.fretting.as_ref().map(|fretting| fretting.begin(self.loading.pair.clone()));
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
        let interface = InterfaceRecord::new(pair.interface(), contact.normal(), before);
        let area = pair.cell_area();
        let stage = &stages[next.stage];
        let (mut represented, mut gone) = (1, Vec::new());
        if let (Some(fretting), Some(changed)) = (&mut self.fretting, &mut changed) {
            if next.begins_stage() {
                (changed.last, changed.computed) = (None, 0);
            }
            let before = last.as_ref().and_then(Equilibrium::frictional);
            changed.work += dissipation;
            let period = stage.cycles.and_then(|cycles| cycles.period).unwrap_or(f64::NAN);
            if next.step > 0 {
                if let Some(now) = contact.frictional() {
                    fretting.add(changed, now, before, if share > 0.0 { share * period } else { 0.0 });
                }
                changed.cycle_work += dissipation;
            }
            match stage.cycles {
                Some(cycles) => {
                    fretting.see(changed, &contact, last.as_ref().filter(|_| next.step > 0));
                    if next.ends_cycle(stages) {
                        fretting.warm(changed, contact.normal(), period)?;
                        let volumes = match &mut *response {
                            Response::Yielding(yielding) if !fretting.changes().memories.is_empty() => {
                                yielding.volumes()
                            }
                            _ => Vec::new(),
                        };
                        fretting.look(changed, &volumes, &|| watch.stop())?;
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
                        (represented, gone) =
                            fretting.act_for_cycles(changed, now, (&gap, control), cycles)?;
                    }
                }
                None => gone = fretting.act_once(changed)?,
            }
            if let Response::Yielding(yielding) = response {
                gone.iter().for_each(|depth| yielding.uncover(depth));
            }
        }
        let removes = self.fretting.as_ref().is_some_and(|fretting| fretting.changes().removes());
        let following = next.after(stages, represented, removes);
        let both = self.fretting.as_ref().zip(changed.as_ref());
        let record = both.map(|(fretting, changed)| fretting.record(changed));
        let heat = both.and_then(|(fretting, changed)| fretting.heat_record(changed));
        let creep = memory.as_ref().map(|_| {
            let before = increments.last().and_then(|last| last.creep).unwrap_or_default();
            CreepRecord { time: before.time + duration }
        });
        increments.push(IncrementRecord {
            increment: increments.len() + 1,
            creep,
            stage: next.stage + 1,
            heat,
            fretting: record,
            plastic_volume: area * flattening.total(plastic).sum(),
            dissipation,
            interface,
            plastic: flow,
            iterations: stats.iterations,
            convolutions: stats.convolutions,
            ..IncrementRecord::from_contact(&contact)
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

impl IncrementRecord {
    /// Creates the record of an increment from the contact at its end.
    pub(super) fn from_contact(contact: &Equilibrium) -> Self {
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

//! The motion itself: pass after pass.

mod removal; // changes of the bodies after a pass
mod search; // the approach of a pass
mod solved; // a solved pass

use std::borrow::Cow;

use web_time::Instant;

use crate::error::{Error, Result, check, check_in};
use crate::motion::body::Body;
use crate::motion::changes::{Changes, FrictionalHeat};
use crate::motion::contact::Contact;
use crate::motion::control::check_limit;
use crate::motion::course::{self, Course, Output, Step};
use crate::motion::creeping;
use crate::motion::extrapolation::{GridCompliance, Removed};
use crate::motion::heat::PassHeat;
use crate::motion::kinematics::{Motion, Strategy};
use crate::motion::lubricated_passes;
use crate::motion::pair::Pair;
use crate::motion::pass::{Pass, Solver};
use crate::motion::path::{OffsetY, Position, Stroke};
use crate::motion::plastic_volume::PlasticVolume;
use crate::motion::record::{DragRecord, RunningRecord, StepRecord};
use crate::motion::rim::Interior;
use crate::motion::together::memory_together;
use crate::motion::truncation::Truncation;
use crate::motion::volumes::Volumes;
use crate::motion::warm_start::WarmStart;
use crate::motion::watch::{Progress, Watch};
use crate::operator::{Boundary, Operators};
use crate::plasticity::{PlasticBody, PlasticParams, PlasticState};
use crate::solver::{Control, Coupling, Device, Params};
use crate::temperature::FlashTemperature;
use crate::units::{Dimension, Newton};

use solved::FinishedPass;
pub use solved::SolvedPass;

/// Two bodies that pass over each other.
pub struct Simulation {
    pair: Pair,
    motion: Motion,
    params: Params,
    /// The positions of the next pass.
    positions: Vec<Position>,
    /// Number of positions, the first ones, that are solved. The others are the same contacts on the return
    /// stroke.
    distinct: usize,
    /// Whether the contact at each position keeps its gap.
    gaps: Vec<bool>,
    operators: Operators,
    boundary: Boundary,
    interiors: [Interior; 2],
    /// Changes of the bodies by a pass.
    changes: Changes,
    /// Compliance of single cells; `None` if no law repeats, nothing is remembered, and passes are not
    /// extrapolated.
    compliance_of_grid: Option<GridCompliance>,
    /// The flash temperature over a pass, if requested.
    heat: Option<PassHeat>,
    /// Whether the first guess of the approach comes from a sample of the positions, solved together.
    together: bool,
    /// Source of the upper body of each pass after the first, if it differs from pass to pass.
    counter: Option<Counter>,
    /// The volumes below the surfaces of elasto-plastic bodies.
    volumes: Option<Volumes>,
    /// Number of computed passes.
    passes_done: usize,
    /// The state in which the next pass begins.
    warm: WarmStart,
}

/// Source of the upper body of a pass.
type Counter = Box<dyn Fn(usize) -> Result<Body> + Send + Sync>;

impl Simulation {
    /// Creates a motion at its beginning.
    ///
    /// # Errors
    /// [`Error::OutOfRange`], [`Error::Unsupported`] or [`Error::GridMismatch`] for invalid input,
    /// [`Error::BeyondPlasticLimit`] if the bodies cannot carry the load.
    pub fn new(pair: Pair, boundary: Boundary, motion: Motion, params: Params) -> Result<Self> {
        let positions = positions(&pair, boundary, &motion)?;
        let max_load: Vec<Newton> = positions.iter().map(|p| max_load(&pair, &motion, p)).collect();
        check_limit(motion.control, motion.load_control.plastic_limit(&max_load))?;
        let distinct = if pair.relaxes() || pair.lubrication().is_some() {
            positions.len()
        } else {
            let follows = pair.interface().follows_path();
            motion.distinct(positions.len(), pair.yields(), pair.couples(), follows)
        };
        let columns: Vec<usize> = positions[..distinct].iter().map(|p| p.columns).collect();
        // Viscoelastic bodies are displaced beyond the overlap, too.
        let [lower, upper] = [&pair.lower, &pair.upper].map(Body::columns);
        let largest = pair.grid(if pair.relaxes() { lower.max(upper) } else { lower.min(upper) });
        let displaces = motion.slip(Stroke::Forth).displaces_normally(&pair);
        pair.interface().check_passes(motion.strategy != Strategy::Overlap, displaces, &params)?;
        if displaces {
            params.device.only_processor(
                "a device does not solve sliding whose shear displaces the bodies normally",
            )?;
        }
        creeping::check(&pair, boundary, &motion, &params)?;
        lubricated_passes::check(&pair, boundary, &motion, &params)?;
        let operators = pair.operators(largest, boundary)?;
        if motion.friction.is_some_and(|friction| friction.coupling != Coupling::None) {
            pair.check_shear()?;
        }
        let together = params.device == Device::Cpu
            && pair.interface().is_hard()
            && !pair.relaxes()
            && pair.lubrication().is_none()
            && memory_together(&motion, params.method, pair.yields(), &columns, pair.lower.width()).is_some();
        Ok(Self {
            together,
            gaps: vec![false; positions.len()],
            boundary,
            interiors: interiors(&pair, boundary, &motion, 0.0),
            changes: Changes::by(Truncation),
            compliance_of_grid: None,
            heat: None,
            pair,
            motion,
            params,
            positions,
            distinct,
            operators,
            counter: None,
            volumes: None,
            passes_done: 0,
            warm: WarmStart::default(),
        })
    }

    /// Resumes the motion after `passes` computed passes. The pair must have the heights after them and the
    /// hardness before them. `warm` is the state that they left
    /// ([`PassReport::warm`](crate::motion::PassReport::warm)). The motion continues as if it had not
    /// stopped, to the last bit.
    ///
    /// # Panics
    /// If the number of positions in `warm` differs from that of the solved positions of a pass, or if it has
    /// any although passes do not repeat.
    pub fn resumed(self, passes: usize, warm: WarmStart) -> Self {
        let begins_alone = self.volumes.is_some() || !self.pair.interface().is_hard();
        let kept = if self.repeats() && !begins_alone { self.distinct } else { 0 };
        assert_eq!(warm.positions.len(), kept, "positions of the warm start");
        let mut resumed = Self { passes_done: passes, warm, ..self };
        resumed.positions = resumed.next_positions();
        resumed
    }

    /// Sets a new upper body for each pass after the first. `counter` returns it for the number of the pass,
    /// on the grid of the first body, and prepared in the same way, with the states that laws store with it.
    /// The upper body of [`Simulation::pair`] is that of the last pass.
    ///
    /// Passes then do not repeat. Changes of an upper body are lost after its pass.
    ///
    /// # Errors
    /// [`Error::Unsupported`] together with extrapolation over passes.
    pub fn with_counter(
        self,
        counter: impl Fn(usize) -> Result<Body> + Send + Sync + 'static,
    ) -> Result<Self> {
        let simulation = Self { counter: Some(Box::new(counter)), ..self };
        simulation.check_jumps()?;
        Ok(simulation)
    }

    /// Whether the next pass has the same positions and bodies as this one.
    fn repeats(&self) -> bool {
        self.motion.repeats() && self.counter.is_none()
    }

    /// Returns the positions of the next pass.
    fn next_positions(&self) -> Vec<Position> {
        let columns = [self.pair.lower.columns(), self.pair.upper.columns()];
        self.motion.positions(columns, self.pair.lower.width(), self.represented() + 1)
    }

    /// Returns the bodies of the next pass.
    fn next_pair(&self) -> Result<Cow<'_, Pair>> {
        let (Some(counter), pass @ 2..) = (&self.counter, self.represented() + 1) else {
            return Ok(Cow::Borrowed(&self.pair));
        };
        let upper = counter(pass)?;
        assert_eq!(upper.heights.dim(), self.pair.upper.heights.dim(), "shape of the upper body");
        upper.validate()?;
        let mut pair = self.pair.clone();
        pair.upper = upper;
        Ok(Cow::Owned(pair))
    }

    /// Restricts records to the interior of the bodies: cells farther than the fraction `rim` of the body
    /// length from free ends, 0 ≤ rim < ½. Without it, the interior is the whole body.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn with_rim(self, rim: f64) -> Result<Self> {
        check("rim", rim, (0.0..0.5).contains(&rim), "a part of the length from 0, below a half")?;
        Ok(Self { interiors: interiors(&self.pair, self.boundary, &self.motion, rim), ..self })
    }

    /// Sets what each pass does to the bodies, besides plastic deformation, which acts first. The contacts of
    /// a pass are solved on the bodies before the pass or, under [`crate::motion::PlasticUpdate::Step`],
    /// before the position.
    ///
    /// # Errors
    /// [`Error::OutOfRange`]; [`Error::Unsupported`] for an extrapolation if passes do not repeat, or if they
    /// change the bodies position by position, and for heat without friction, a speed or temperatures of the
    /// bodies, or in a shift under a boundary that is free along x; also the errors of
    /// [`FlashTemperature::new`].
    pub fn with_changes(mut self, mut changes: Changes) -> Result<Self> {
        changes.prepare(&mut self.pair)?;
        let repeats = changes.laws.iter().any(|law| law.repeats());
        let compliance = repeats || !changes.memories.is_empty() || changes.jumps();
        self.compliance_of_grid = compliance.then(|| GridCompliance::new(&self.pair, self.boundary));
        self.heat = self.heat_of(&changes)?;
        changes.laws.insert(0, Box::new(Truncation));
        let simulation = Self { changes, ..self };
        simulation.check_jumps()?;
        Ok(simulation)
    }

    /// Returns the flash temperature of the passes, if it is requested.
    fn heat_of(&self, changes: &Changes) -> Result<Option<PassHeat>> {
        let cells = self.motion.stride.min(self.pair.lower.columns()) as f64;
        let time = self.motion.time_of(cells, self.pair.pitch()[0]);
        let heated = changes.heated(self.motion.friction.is_some() && time.is_finite())?;
        let Some(FrictionalHeat { thermal, every }) = heated else { return Ok(None) };
        check("every", every as f64, every > 0, "at least each computed pass")?;
        self.pair.check_elastic()?;
        if self.motion.strategy != Strategy::Overlap && !self.boundary.repeats(0) {
            return Err(Error::Unsupported(
                "a flash temperature in a shift needs a boundary that is periodic along x",
            ));
        }
        let grids = [&self.pair.lower_grid(), &self.pair.upper_grid()];
        let positions = self.positions.len();
        let flash = FlashTemperature::new(grids, thermal, self.boundary, positions, time, changes.bulk)?;
        Ok(Some(PassHeat::new(flash, every)))
    }

    /// Checks whether passes may be extrapolated, if they are.
    fn check_jumps(&self) -> Result<()> {
        let refused = if !self.changes.jumps() {
            return Ok(());
        } else if !self.repeats() {
            "extrapolation needs passes that repeat"
        } else if self.changes_at_every_step() {
            "extrapolation needs plastic deformation that is applied after each pass"
        } else {
            return Ok(());
        };
        Err(Error::Unsupported(refused))
    }

    /// Keeps the gap of the contact at each position whose index is `wanted` ([`Contact::gap`]), for outputs
    /// that need it.
    #[must_use]
    pub fn keeping_gaps(mut self, wanted: impl Fn(usize) -> bool) -> Self {
        let last = self.gaps.len() - 1;
        // The contacts of a return stroke may be those of the outward stroke.
        let gaps = self.gaps.iter_mut().enumerate();
        gaps.for_each(|(index, gap)| *gap = wanted(index) || wanted(last - index));
        self
    }

    /// Whether the bodies change position by position.
    fn changes_at_every_step(&self) -> bool {
        !self.motion.is_frozen(self.pair.yields()) || self.volumes.is_some()
    }

    /// Adds plastic flow below the surfaces of the given `bodies`, lower one first. Plastic strain moves with
    /// the material from position to position, and each pass ends with unloading. [`Simulation::pair`] has
    /// their surfaces with the plastic displacement. Laws change such bodies after each pass: plastic strain
    /// moves up with the material where some above it has gone, and a hardness of the other body flattens it
    /// after the pass.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for an elasto-plastic body with a hardness, extrapolation over passes, an
    /// elasto-plastic upper body that differs from pass to pass, and a shift under a boundary that is free
    /// along x.
    ///
    /// # Panics
    /// If no body is given, or if the grid of one differs from that of its surface.
    pub fn with_plastic(self, bodies: [Option<PlasticBody>; 2], plastic: PlasticParams) -> Result<Self> {
        self.pair.interface().check_combined()?;
        self.pair.check_elastic()?;
        self.pair.check_flow(&bodies)?;
        let refused = if self.changes.jumps() {
            "elasto-plastic bodies do not support extrapolation over passes"
        } else if self.counter.is_some() && bodies[1].is_some() {
            "a fresh counter-body does not keep its plastic state"
        } else if self.motion.strategy != Strategy::Overlap && !self.boundary.repeats(0) {
            "an elasto-plastic body in a shift needs a periodic boundary along x"
        } else {
            ""
        };
        if !refused.is_empty() {
            return Err(Error::Unsupported(refused));
        }
        let Self { pair, operators, positions, params, boundary, .. } = &self;
        let volumes = Volumes::new(bodies, pair, operators, &positions[0], *boundary, (plastic, params))?;
        Ok(Self { distinct: self.positions.len(), together: false, volumes: Some(volumes), ..self })
    }

    /// Restores the plastic state of each elasto-plastic body (lower first) after the finished passes. The
    /// surfaces of the pair already have its displacement.
    ///
    /// # Panics
    /// If no body is elasto-plastic.
    pub fn with_plastic_states(self, states: Vec<PlasticState>) -> Self {
        let volumes = self.volumes.expect("bodies that flow").with_states(states);
        Self { volumes: Some(volumes), ..self }
    }

    /// Adds the plastic state under the load at a position, by its index, to the reports of each pass.
    ///
    /// # Panics
    /// If no body is elasto-plastic.
    pub fn with_state_under_load(self, position: usize) -> Self {
        let volumes = self.volumes.expect("bodies that flow").states_under_load(position);
        Self { volumes: Some(volumes), ..self }
    }

    /// Returns the plastic state after the finished passes; empty for other than elasto-plastic bodies.
    pub fn plastic_volumes(&self) -> Vec<PlasticVolume> {
        self.volumes.as_ref().map_or(Vec::new(), Volumes::volumes)
    }

    /// Number of finished passes of the motion, extrapolated ones included.
    pub fn represented(&self) -> usize {
        self.warm.represented
    }

    /// The interiors of the lower and of the upper body.
    pub fn interiors(&self) -> &[Interior; 2] {
        &self.interiors
    }

    /// The bodies in their present state.
    pub fn pair(&self) -> &Pair {
        &self.pair
    }

    /// The parameters of the motion.
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// The positions of the next pass.
    pub fn positions(&self) -> &[Position] {
        &self.positions
    }

    /// Runs the remaining passes.
    ///
    /// # Errors
    /// The errors of [`Simulation::solve`] and of the outputs.
    pub fn run(&mut self, watch: &dyn Watch, outputs: &mut [&mut dyn Output]) -> Result<()> {
        course::run(self, watch, outputs)
    }

    /// Solves the next pass and lets the laws change its bodies. The pass counts only once it is
    /// [finished](Simulation::finish).
    ///
    /// # Errors
    /// The errors of [`crate::solver::solve_normal`] in an [`Error::AtPosition`]; [`Error::LoadNotReached`],
    /// [`Error::WornAway`] in an [`Error::AtPass`]; [`Error::Interrupted`].
    pub fn solve(&self, watch: &dyn Watch) -> Result<SolvedPass> {
        let pass = self.passes_done + 1;
        self.solve_next(watch).map_err(|error| error.if_of_step(|source| Error::AtPass { pass, source }))
    }

    fn solve_next(&self, watch: &dyn Watch) -> Result<SolvedPass> {
        let began = Instant::now();
        let pass = self.passes_done + 1;
        let before = self.next_pair()?;
        let (mut outcome, guess, trials) = self.solve_pass(&before, watch)?;
        let hardness = [&before.lower, &before.upper].map(|body| body.hardness.clone());
        drop(before);
        let history_difference = self.history_difference(&outcome, watch)?;
        self.come_back(&mut outcome.contacts);
        let removal = self.solve_with_removal(&mut outcome, watch)?;
        let displaced = self.motion.offset_y != OffsetY::NONE;
        let offset_y = |across: usize| displaced.then_some(across as f64 * self.pair.pitch()[1]);
        let step = |(k, contact): (usize, &Contact)| {
            let record = contact.record(&outcome.pair, &self.interiors, self.boundary, [pass, k + 1]);
            StepRecord { offset_y: offset_y(contact.position.across), ..record }
        };
        let mut steps: Vec<StepRecord> = outcome.contacts.iter().enumerate().map(step).collect();
        let drags = steps.iter_mut().zip(outcome.drag.iter().flat_map(|drag| &drag.positions));
        drags.for_each(|(step, drag)| step.drag = Some(DragRecord { drag: *drag }));
        steps.iter_mut().zip(&outcome.films).for_each(|(step, film)| step.film = Some(*film));
        if let Some(plastic_pass) = &outcome.plastic_pass {
            steps
                .iter_mut()
                .zip(&plastic_pass.steps)
                .for_each(|(step, plastic)| step.plastic = Some(*plastic));
        }
        self.look(&mut outcome, watch)?;
        let (running, extrapolation) = self.advance(&mut outcome, &mut steps, removal.as_ref())?;
        let represented = self.represented() + running.map_or(1, |running: RunningRecord| running.represents);
        let interiors = self.interiors.clone();
        let wall_time = began.elapsed().as_secs_f64();
        let distance = self.position_data().distance * steps.len() as f64;
        Ok(SolvedPass {
            outcome,
            hardness,
            steps,
            guess,
            trials,
            wall_time,
            interiors,
            running,
            extrapolation,
            removed: None,
            represented,
            history_difference,
            distance,
        })
    }

    /// Returns how much the loads of a pass depend on the position before; 0 if they do not, or if they
    /// follow it.
    fn history_difference(&self, outcome: &Pass, watch: &dyn Watch) -> Result<f64> {
        let interface = self.pair.interface();
        if interface.is_hard() || interface.follows_path() || outcome.taken.is_some() {
            return Ok(0.0);
        }
        self.solver(watch).history_difference(outcome, &self.params)
    }

    /// Adds the contacts of the return stroke to the solved ones, if they are the same.
    fn come_back(&self, contacts: &mut Vec<Contact>) {
        let back = self.positions[self.distinct..].iter().zip(contacts.iter().rev());
        let back: Vec<Contact> = back.map(|(position, contact)| contact.back(*position)).collect();
        contacts.extend(back);
    }

    /// Finishes a solved pass of this motion: passes it to the outputs, and uses its bodies for the next one.
    ///
    /// # Errors
    /// The errors of the outputs; the pass then does not count.
    pub fn finish(
        &mut self,
        pass: SolvedPass,
        watch: &dyn Watch,
        outputs: &mut [&mut dyn Output],
    ) -> Result<()> {
        let finished = self.finished(pass);
        course::finish(self, finished, watch, outputs)
    }

    /// Returns a solved pass with the state that it leaves to the next one.
    fn finished(&self, mut pass: SolvedPass) -> FinishedPass {
        let (before, passes) = (self.warm.removed.as_ref(), self.warm.extrapolated_passes());
        if let Some(depth) = &pass.removed {
            self.uncover(&mut pass.outcome, std::slice::from_ref(depth));
        }
        let removed = pass.removed.take().map(|depth| Removed::after(depth, before, passes));
        if let (Some(running), Some(removed)) = (&mut pass.running, &removed) {
            running.error_estimate += removed.error(running.represents);
        }
        let record = pass.record();
        let SolvedPass { outcome, hardness, steps, guess, extrapolation, represented, .. } = pass;
        // Without repetition the next pass begins from zero.
        let (guess, again) = match self.repeats() {
            // Each pass of elasto-plastic bodies, and of bodies that are no hard walls to each other, begins
            // with separated bodies.
            true if self.volumes.is_some() || !self.pair.interface().is_hard() => (guess, &[][..]),
            true => (guess, &outcome.contacts[..self.distinct]),
            false => (None, &[][..]),
        };
        let warm = WarmStart::new(guess, again, extrapolation, removed, represented, &self.warm);
        FinishedPass { record, outcome, hardness, steps, warm }
    }

    /// Creates the solver of the next pass.
    fn solver<'a>(&'a self, watch: &'a dyn Watch) -> Solver<'a> {
        let progress = Progress {
            pass: self.represented() + 1,
            passes: self.motion.passes,
            trial: 1,
            solved: 0,
            positions: self.distinct,
            load: 0.0,
            together: None,
        };
        let goes_on = self.pair.relaxes() && self.motion.apart().is_none();
        let last = goes_on.then(|| self.warm.last(&self.pair, &self.positions[..self.distinct])).flatten();
        Solver {
            last,
            operators: &self.operators,
            positions: &self.positions[..self.distinct],
            motion: &self.motion,
            interiors: &self.interiors,
            laws: &self.changes.laws,
            heat: self.heat.as_ref().map(|heat| (heat, self.passes_done)),
            bulk: self.changes.bulk,
            gaps: &self.gaps,
            watch,
            progress,
        }
    }
}

impl Course for Simulation {
    type Solved = FinishedPass;

    fn next(&mut self, watch: &dyn Watch) -> Result<Option<FinishedPass>> {
        if self.represented() < self.motion.passes {
            self.solve(watch).map(|pass| Some(self.finished(pass)))
        } else {
            Ok(None)
        }
    }

    fn report<'a>(&'a self, pass: &'a FinishedPass) -> Step<'a> {
        Step::of_pass(pass.report(&self.motion))
    }

    fn take(&mut self, pass: FinishedPass) {
        let Pass { pair, plastic_pass, .. } = pass.outcome;
        if let (Some(volumes), Some(plastic_pass)) = (&mut self.volumes, plastic_pass) {
            volumes.take(plastic_pass.volumes);
        }
        self.warm = pass.warm;
        self.pair = pair;
        if !self.motion.repeats() {
            self.positions = self.next_positions();
        }
        self.passes_done = pass.record.pass;
    }
}

fn positions(pair: &Pair, boundary: Boundary, motion: &Motion) -> Result<Vec<Position>> {
    check("passes", motion.passes as f64, motion.passes > 0, "at least one pass")?;
    check("stride", motion.stride as f64, motion.stride > 0, "at least one cell")?;
    let tolerance = motion.load_tolerance;
    check("load_tolerance", tolerance, tolerance > 0.0, "a relative tolerance above 0")?;
    if let Control::Load(load) = motion.control {
        check_in(Dimension::Force, "load", load, load > 0.0 && load.is_finite(), "a finite load above 0")?;
    }
    if let Some(friction) = motion.friction {
        friction.checked()?;
        if motion.strategy.direction() == 0.0 {
            return Err(Error::Unsupported("friction needs surfaces with different speeds"));
        }
    }
    if let Control::Approach(approach) = motion.control {
        check_in(Dimension::Length, "approach", approach, approach.is_finite(), "a finite length")?;
    }
    let (lower, upper) = (pair.lower.columns(), pair.upper.columns());
    match motion.strategy {
        Strategy::Overlap if boundary.repeats(0) => {
            return Err(Error::Unsupported("an overlap needs a boundary that is free along x"));
        }
        Strategy::Overlap => {}
        Strategy::Shift { .. } if lower != upper => {
            return Err(Error::GridMismatch {
                what: "length of the two bodies, which a circular shift needs equal",
                left: format!("{lower} cells along x"),
                right: format!("{upper} cells along x"),
            });
        }
        Strategy::Shift { speed_lower, speed_upper } => {
            let fastest = speed_lower.abs().max(speed_upper.abs());
            check("speed", fastest, fastest > 0.0 && fastest.is_finite(), "a surface that moves")?;
        }
    }
    if motion.offset_y != OffsetY::NONE && !boundary.repeats(1) {
        return Err(Error::Unsupported("an offset along y needs a boundary that is periodic along y"));
    }
    Ok(motion.positions([lower, upper], pair.lower.width(), 1))
}

/// Largest load that the cells at a position can carry together.
fn max_load(pair: &Pair, motion: &Motion, position: &Position) -> Newton {
    let bounds = motion.bounds(pair, position);
    pair.cell_area() * bounds.upper().sum(pair.grid(position.columns).cells())
}

fn interiors(pair: &Pair, boundary: Boundary, motion: &Motion, rim: f64) -> [Interior; 2] {
    let shapes = [pair.lower_grid().shape, pair.upper_grid().shape];
    Interior::of_bodies(shapes, boundary, motion.strategy, rim)
}

#[cfg(test)]
mod tests;

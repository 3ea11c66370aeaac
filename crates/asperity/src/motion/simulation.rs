//! The motion itself: pass after pass.

use std::borrow::Cow;

use web_time::Instant;

use crate::error::{Error, LoadLimit, Result, check, check_in};
use crate::grid::{CellValues, Field};
use crate::motion::approach::{Limit, MAX_RESIDUAL, Search};
use crate::motion::body::Body;
use crate::motion::contact::Contact;
use crate::motion::film::FILM;
use crate::motion::flowed::FlowedVolume;
use crate::motion::heat::PassHeat;
use crate::motion::jump::{self, Acceleration, Bounds, Jump, Leap, Softness};
use crate::motion::law::{self, Heat, Law, Sums, Warmth};
use crate::motion::pair::Pair;
use crate::motion::pass::{Pass, Solver};
use crate::motion::path::{OffsetY, Position};
use crate::motion::plastic::PlasticFlow;
use crate::motion::record::{LostVolume, PassRecord, RunningRecord, StepRecord};
use crate::motion::report::{Output, PassReport};
use crate::motion::rim::Interior;
use crate::motion::together::memory_together;
use crate::motion::volumes::Volumes;
use crate::motion::warm_start::{Guess, WarmStart};
use crate::motion::watch::{Progress, Watch};
use crate::motion::wear::WEAR;
use crate::motion::{LoadControl, Motion, PlasticUpdate, Strategy, check_limit};
use crate::operator::{Boundary, Operators};
use crate::plasticity::{FlowParams, PlasticBody, PlasticState};
use crate::solver::{Control, Coupling, Params};
use crate::temperature::{FlashTemperature, Thermal};
use crate::units::{CubicMetre, Dimension, Metre, Newton, Second};

/// Two bodies that pass over each other.
pub struct Simulation {
    pair: Pair,
    motion: Motion,
    params: Params,
    /// The positions of the next pass.
    positions: Vec<Position>,
    /// How many of them, the first ones, are solved; the others are the same contacts on the way back.
    distinct: usize,
    operators: Operators,
    boundary: Boundary,
    interiors: [Interior; 2],
    /// The laws by which a pass changes the bodies, in their order.
    laws: Vec<Box<dyn Law>>,
    /// Whether the approach of a pass is found with all positions together, before they are solved one by one.
    together: bool,
    acceleration: Acceleration,
    /// How far single cells give way; known once a law repeats.
    softness: Option<Softness>,
    /// The flash temperature over a pass, where it is wanted.
    heat: Option<PassHeat>,
    /// What gives the upper body of each pass after the first, where they are not the same.
    counter: Option<Counter>,
    /// What flows below the surfaces, where bodies do.
    volumes: Option<Volumes>,
    /// Passes that are computed.
    passes_done: usize,
    /// The state in which the next pass begins.
    warm: WarmStart,
}

/// How much the laws that repeat take in a pass.
struct PassWear {
    softness: Softness,
    /// Passes of such wear at which a chequered pattern of pressures would not decay if each were solved without it.
    stable: f64,
    /// The depths that the pass would have taken without its wear, where it was solved with that.
    explicit: Option<Vec<[Field; 2]>>,
}

/// What gives the upper body of a pass.
type Counter = Box<dyn Fn(usize) -> Result<Body> + Send + Sync>;

/// A pass that is solved, and not yet [finished](Simulation::finish).
pub struct SolvedPass {
    outcome: Pass,
    /// The hardness of the bodies in the pass, lower one first.
    hardness: [CellValues; 2],
    steps: Vec<StepRecord>,
    guess: Option<Guess>,
    trials: usize,
    wall_time: Second,
    interiors: [Interior; 2],
    running: Option<RunningRecord>,
    jump: Option<Jump>,
    /// Passes of the motion that are done with this one.
    represented: usize,
}

impl SolvedPass {
    /// The contacts of the pass, position by position.
    pub fn contacts(&self) -> &[Contact] {
        &self.outcome.contacts
    }

    /// The positions of the pass in numbers.
    pub fn steps(&self) -> &[StepRecord] {
        &self.steps
    }

    /// What has flowed below the surfaces, once the load is taken off; nothing in bodies that do not flow.
    pub fn flowed(&self) -> &[FlowedVolume] {
        self.outcome.flowed.as_ref().map_or(&[], |flowed| &flowed.volumes)
    }

    /// The bodies as the pass leaves them.
    pub fn pair(&self) -> &Pair {
        &self.outcome.pair
    }

    /// The pass in numbers, as they are now.
    pub fn record(&self) -> PassRecord {
        let record = summarise(&self.outcome, &self.interiors, &self.steps);
        PassRecord {
            outer_iterations: self.trials,
            wall_time_s: self.wall_time,
            running: self.running,
            flow: self.outcome.flowed.as_ref().map(|flowed| flowed.record),
            ..record
        }
    }

    /// Takes a `depth` off each cell of the lower and of the upper body, m, below 0 where a cell grows; its volume is lost to
    /// the law of that name, in snake case.
    ///
    /// # Panics
    /// If a depth has another shape than its body.
    pub fn remove(&mut self, law: &str, depth: &[Field; 2]) {
        let Pass { pair, lost, .. } = &mut self.outcome;
        let known = lost.iter().position(|lost| lost.law == law).unwrap_or_else(|| {
            lost.push(LostVolume::nothing(law));
            lost.len() - 1
        });
        law::remove(pair, depth, &self.interiors, &mut lost[known]);
    }
}

impl Simulation {
    /// A motion from its beginning.
    ///
    /// # Errors
    /// [`Error::OutOfRange`], [`Error::Unsupported`] or [`Error::GridMismatch`] for input without meaning,
    /// [`Error::BeyondPlasticLimit`] if the bodies cannot carry the load.
    pub fn new(pair: Pair, boundary: Boundary, motion: Motion, params: Params) -> Result<Self> {
        let positions = positions(&pair, boundary, &motion)?;
        let bearable: Vec<Newton> = positions.iter().map(|p| bearable(&pair, &motion, p)).collect();
        check_limit(motion.control, motion.load_control.plastic_limit(&bearable))?;
        let distinct = motion.distinct(positions.len(), pair.yields(), pair.couples());
        let columns: Vec<usize> = positions[..distinct].iter().map(|p| p.columns).collect();
        let largest = pair.grid(pair.lower.columns().min(pair.upper.columns()));
        let operators = pair.operators(largest, boundary)?;
        if motion.friction.is_some_and(|friction| friction.coupling != Coupling::None) {
            pair.check_shear()?;
        }
        let together =
            memory_together(&motion, params.method, pair.yields(), &columns, pair.lower.width()).is_some();
        Ok(Self {
            together,
            boundary,
            interiors: interiors(&pair, boundary, &motion, 0.0),
            laws: vec![Box::new(PlasticFlow)],
            pair,
            motion,
            params,
            positions,
            distinct,
            operators,
            acceleration: Acceleration::NONE,
            softness: None,
            heat: None,
            counter: None,
            volumes: None,
            passes_done: 0,
            warm: WarmStart::default(),
        })
    }

    /// The same motion with so many computed `passes` already done; the pair has the heights after them and the hardness of
    /// before, and `warm` is what they left ([`PassReport::warm`]). It goes on as if it had not stopped, to the last bit.
    ///
    /// # Panics
    /// If `warm` has not as many positions as are solved of a pass, or any where passes do not repeat.
    pub fn resumed(self, passes: usize, warm: WarmStart) -> Self {
        let kept = if self.repeats() && self.volumes.is_none() { self.distinct } else { 0 };
        assert_eq!(warm.positions.len(), kept, "positions of the warm start");
        let mut resumed = Self { passes_done: passes, warm, ..self };
        resumed.positions = resumed.next_positions();
        resumed
    }

    /// The same motion, in which each pass after the first has an upper body of its own: the one that the `counter` gives for the
    /// number of the pass, on the grid of the first and prepared as that one is, with the states that laws keep of it. The upper body
    /// of [`Simulation::pair`] is that of the last pass.
    ///
    /// Passes do not repeat then. What a pass does to an upper body is gone with it.
    ///
    /// # Errors
    /// [`Error::Unsupported`] where a computed pass stands for others.
    pub fn with_counter(
        self,
        counter: impl Fn(usize) -> Result<Body> + Send + Sync + 'static,
    ) -> Result<Self> {
        let simulation = Self { counter: Some(Box::new(counter)), ..self };
        let acceleration = simulation.acceleration;
        simulation.with_acceleration(acceleration)
    }

    /// Whether the next pass meets what this one does.
    fn repeats(&self) -> bool {
        self.motion.repeats() && self.counter.is_none()
    }

    /// The positions of the pass after those that are done.
    fn next_positions(&self) -> Vec<Position> {
        let columns = [self.pair.lower.columns(), self.pair.upper.columns()];
        self.motion.positions(columns, self.pair.lower.width(), self.represented() + 1)
    }

    /// The bodies of the next pass.
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

    /// The same motion, whose records tell what is in the interior of the bodies: farther than the part `rim` of their
    /// length, 0 ≤ rim < ½, from their free ends. Without it, the interior is the whole body.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn with_rim(self, rim: f64) -> Result<Self> {
        check("rim", rim, (0.0..0.5).contains(&rim), "a part of the length from 0, below a half")?;
        Ok(Self { interiors: interiors(&self.pair, self.boundary, &self.motion, rim), ..self })
    }

    /// The same motion, after whose passes a `law` changes the bodies, too: after those that do already, of which plastic flow
    /// is the first; a law that does not repeat before those that do. The contacts of a pass are solved on the bodies as they
    /// were before it, or under [`crate::motion::PlasticUpdate::Step`] before its position.
    pub fn with_law(mut self, mut law: impl Law + 'static) -> Self {
        law.prepare(&mut self.pair);
        if law.repeats() {
            self.softness.get_or_insert_with(|| Softness::of(&self.pair, self.boundary));
            self.laws.push(Box::new(law));
        } else {
            // What a pass does once comes first: how many passes it stands for depends on it.
            self.laws.insert(self.once(), Box::new(law));
        }
        self
    }

    /// The same motion, whose computed passes stand for several.
    ///
    /// # Errors
    /// [`Error::OutOfRange`], and [`Error::Unsupported`] where passes do not repeat, or change the bodies position by position.
    pub fn with_acceleration(self, acceleration: Acceleration) -> Result<Self> {
        let acceleration = acceleration.checked()?;
        if acceleration.max_jump > 1 {
            if !self.repeats() {
                return Err(Error::Unsupported(
                    "surfaces that meet anew in each pass have none that stands for others",
                ));
            }
            if self.changes_at_every_step() {
                return Err(Error::Unsupported(
                    "a pass that changes the bodies position by position stands for itself",
                ));
            }
        }
        Ok(Self { acceleration, ..self })
    }

    /// Whether the bodies change position by position.
    fn changes_at_every_step(&self) -> bool {
        let by_laws = self.motion.plastic_update == PlasticUpdate::Step && self.pair.yields();
        by_laws || self.volumes.is_some()
    }

    /// The same motion of bodies that flow below their surfaces: those that are given, lower one first. Plastic strain stays with the
    /// material, position after position; each pass ends with the load taken off. No other law changes such bodies, and
    /// [`Simulation::pair`] has their surfaces as flow has left them.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for bodies that have a hardness, heat, a pass that stands for others, an upper body that flows and is another
    /// in each pass, and a shift under a boundary that is free along x.
    ///
    /// # Panics
    /// If none is given, or one has another grid than its surface.
    pub fn with_flow(self, bodies: [Option<PlasticBody>; 2], flow: FlowParams) -> Result<Self> {
        let refused = if self.pair.yields() {
            "bodies that flow below their surfaces have no hardness"
        } else if self.laws.len() > 1 {
            "bodies that flow below their surfaces neither wear nor grow films"
        } else if self.heat.is_some() {
            "a flash temperature is that of bodies that stay as they are in a pass"
        } else if self.acceleration.max_jump > 1 {
            "a pass in which bodies flow stands for itself"
        } else if self.counter.is_some() && bodies[1].is_some() {
            "an upper body that is another in each pass does not keep what has flowed"
        } else if self.motion.strategy != Strategy::Overlap && !self.boundary.repeats(0) {
            "plastic strain goes round with the surfaces of a shift: their boundary is periodic along x"
        } else {
            ""
        };
        if !refused.is_empty() {
            return Err(Error::Unsupported(refused));
        }
        let Self { pair, operators, positions, params, boundary, .. } = &self;
        let volumes = Volumes::new(bodies, pair, operators, &positions[0], *boundary, (flow, *params));
        Ok(Self { distinct: self.positions.len(), together: false, volumes: Some(volumes), ..self })
    }

    /// The same motion, in which so much has flowed in the passes that are done, of each body that may flow, lower one first; the
    /// surfaces of the pair are those that it has left.
    ///
    /// # Panics
    /// If the bodies do not flow.
    pub fn with_flowed(self, states: Vec<PlasticState>) -> Self {
        let volumes = self.volumes.expect("bodies that flow").with_states(states);
        Self { volumes: Some(volumes), ..self }
    }

    /// The same motion, whose reports say what has flowed under the load at a position, by its index, of each pass.
    ///
    /// # Panics
    /// If the bodies do not flow.
    pub fn looking_at(self, position: usize) -> Self {
        let volumes = self.volumes.expect("bodies that flow").looked_at(position);
        Self { volumes: Some(volumes), ..self }
    }

    /// What has flowed in the passes that are done; nothing in bodies that do not.
    pub fn flowed(&self) -> Vec<FlowedVolume> {
        self.volumes.as_ref().map_or(Vec::new(), Volumes::volumes)
    }

    /// The same motion, whose friction heats bodies of these thermal constants, lower one first: laws see the temperature of the
    /// cells in contact, which begin each pass at that of the bodies. It is computed in the first and in every `every`-th computed
    /// pass, ≥ 1; in those between the cells are as warm as they were in the mean over their contacts of the last such pass.
    ///
    /// # Errors
    /// [`Error::Unsupported`] without friction, a speed or temperatures of the bodies, where these change position by position, and
    /// for a shift under a boundary that is free along x; those of [`FlashTemperature::new`].
    pub fn with_heat(self, thermal: [Thermal; 2], every: usize) -> Result<Self> {
        check("every", every as f64, every > 0, "at least each computed pass")?;
        let time = self.motion.step_time(self.pair.pitch()[0]);
        let (Some(_), Some(bulk), true) = (self.motion.friction, self.motion.bulk, time.is_finite()) else {
            return Err(Error::Unsupported(
                "a flash temperature is that of bodies with friction, a speed and temperatures",
            ));
        };
        if self.changes_at_every_step() {
            return Err(Error::Unsupported(
                "a flash temperature is that of bodies that stay as they are in a pass",
            ));
        }
        if self.motion.strategy != Strategy::Overlap && !self.boundary.repeats(0) {
            return Err(Error::Unsupported(
                "the heat of surfaces that go round goes round with them: their boundary is periodic along x",
            ));
        }
        let grids = [&self.pair.lower_grid(), &self.pair.upper_grid()];
        let heat = FlashTemperature::new(grids, thermal, self.boundary, self.positions.len(), time, bulk)?;
        Ok(Self { heat: Some(PassHeat::new(heat, every)), ..self })
    }

    /// Passes of the motion that are done: those that the computed ones stand for.
    pub fn represented(&self) -> usize {
        self.warm.represented
    }

    /// The interiors of the lower and of the upper body.
    pub fn interiors(&self) -> &[Interior; 2] {
        &self.interiors
    }

    /// The bodies as they are now.
    pub fn pair(&self) -> &Pair {
        &self.pair
    }

    /// How the bodies move.
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// The positions of the next pass.
    pub fn positions(&self) -> &[Position] {
        &self.positions
    }

    /// Runs the passes that are left.
    ///
    /// # Errors
    /// Those of [`Simulation::solve`], and those of the outputs.
    pub fn run(&mut self, watch: &dyn Watch, outputs: &mut [&mut dyn Output]) -> Result<()> {
        while self.represented() < self.motion.passes {
            let pass = self.solve(watch)?;
            self.finish(pass, watch, outputs)?;
        }
        Ok(())
    }

    /// Solves the next pass and lets the laws change its bodies. It counts once it is [finished](Simulation::finish).
    ///
    /// # Errors
    /// Those of [`crate::solver::solve_normal`], [`Error::LoadNotReached`], [`Error::Interrupted`].
    pub fn solve(&self, watch: &dyn Watch) -> Result<SolvedPass> {
        let began = Instant::now();
        let pass = self.passes_done + 1;
        if self.volumes.is_some() && self.laws.len() > 1 {
            return Err(Error::Unsupported(
                "bodies that flow below their surfaces neither wear nor grow films",
            ));
        }
        let before = self.next_pair()?;
        let (mut outcome, guess, trials) = self.solve_pass(&before, watch)?;
        let hardness = [&before.lower, &before.upper].map(|body| body.hardness.clone());
        drop(before);
        self.come_back(&mut outcome.contacts);
        let wear = self.solve_with_wear(&mut outcome, watch)?;
        let displaced = self.motion.offset_y != OffsetY::NONE;
        let offset_y = |across: usize| displaced.then_some(across as f64 * self.pair.pitch()[1]);
        let step = |(k, contact): (usize, &Contact)| {
            let record = contact.record(&outcome.pair, &self.interiors, self.boundary, [pass, k + 1]);
            StepRecord { offset_y: offset_y(contact.position.across), ..record }
        };
        let mut steps: Vec<StepRecord> = outcome.contacts.iter().enumerate().map(step).collect();
        if let Some(flowed) = &outcome.flowed {
            steps.iter_mut().zip(&flowed.steps).for_each(|(step, flow)| step.flow = Some(*flow));
        }
        let (running, jump) = match outcome.has_changed {
            true => (None, None),
            false => self.advance(&mut outcome, &mut steps, wear.as_ref())?,
        };
        let represented = self.represented() + running.map_or(1, |running: RunningRecord| running.represents);
        let interiors = self.interiors.clone();
        let wall_time = began.elapsed().as_secs_f64();
        Ok(SolvedPass {
            outcome,
            hardness,
            steps,
            guess,
            trials,
            wall_time,
            interiors,
            running,
            jump,
            represented,
        })
    }

    /// Adds the contacts of the way back to those that are solved, if they are the same.
    fn come_back(&self, contacts: &mut Vec<Contact>) {
        let back = self.positions[self.distinct..].iter().zip(contacts.iter().rev());
        let back: Vec<Contact> = back.map(|(position, contact)| contact.back(*position)).collect();
        contacts.extend(back);
    }

    /// Solves a pass again, with its wear, that takes more off the bodies than single cells bear without swinging: its contacts take
    /// the place of those of the `outcome`. None where no law repeats.
    fn solve_with_wear(&self, outcome: &mut Pass, watch: &dyn Watch) -> Result<Option<PassWear>> {
        let Some(softness) = self.softness.filter(|_| !outcome.has_changed) else { return Ok(None) };
        let passage = self.motion.passage(self.pair.pitch()[0]);
        let friction = self.motion.friction.map_or(0.0, |friction| friction.coefficient);
        let laws = &self.laws[self.once()..];
        let relaxation = jump::relaxation(&outcome.pair, &outcome.contacts, laws, friction, passage.distance);
        let stable = softness.chequered / relaxation;
        if stable > 0.5 {
            return Ok(Some(PassWear { softness, stable, explicit: None }));
        }
        let (sums, _) = law::sums(laws, &outcome.pair, &outcome.contacts, &passage, None)?;
        // The way back wears as much again under the same pressures.
        let distance = passage.distance * (self.positions.len() / self.distinct) as f64;
        let compliance = law::compliance(laws, &outcome.pair, &sums, friction, distance);
        let explicit = Some(law::tried(laws, &outcome.pair, &sums, 1));
        outcome.contacts.truncate(self.distinct);
        outcome.contacts = self.solver(watch).solve_implicitly(outcome, compliance, &self.params)?;
        self.come_back(&mut outcome.contacts);
        Ok(Some(PassWear { softness, stable, explicit }))
    }

    /// How many of the laws, the first, act once in a computed pass; the others do again in the passes that it stands for.
    fn once(&self) -> usize {
        self.laws.iter().take_while(|law| !law.repeats()).count()
    }

    /// Lets the laws change the bodies of a pass that is solved, by as many passes as it stands for.
    fn advance(
        &self,
        pass: &mut Pass,
        steps: &mut [StepRecord],
        wear: Option<&PassWear>,
    ) -> Result<(Option<RunningRecord>, Option<Jump>)> {
        let passage = self.motion.passage(self.pair.pitch()[0]);
        let mut heat =
            self.heat.as_ref().map(|heat| heat.of_pass(self.passes_done, &pass.pair, passage.bulk));
        let step = heat.as_deref_mut().map(|heat| heat as &mut Heat);
        let (mut sums, warm) = law::sums(&self.laws, &pass.pair, &pass.contacts, &passage, step)?;
        drop(heat);
        for ((step, contact), Warmth { record, temperature }) in
            steps.iter_mut().zip(&mut pass.contacts).zip(warm)
        {
            step.heat = Some(record);
            contact.temperature = Some(temperature);
        }
        if let Some(heat) = &self.heat {
            heat.remember(self.passes_done, &mut pass.pair, &pass.contacts, passage.bulk);
        }
        let once = self.once();
        let (flow, laws) = self.laws.split_at(once);
        let repeated = sums.split_off(once);
        let mut lost = std::mem::take(&mut pass.lost);
        law::advance(flow, &mut pass.pair, &sums, 1.0, &self.interiors, &mut lost[..once]);
        if laws.is_empty() && self.heat.is_none() {
            pass.lost = lost;
            return Ok((None, None));
        }
        let flown = lost.iter().flat_map(|lost| lost.whole).sum();
        let Leap { passes, mean, error } = match wear {
            // Euler's implicit and explicit steps err by as much, to either side.
            Some(PassWear { explicit: Some(explicit), .. }) => {
                let taken = law::tried(laws, &pass.pair, &repeated, 1);
                Leap { error: 0.5 * law::difference(explicit, &taken), ..Leap::ONE }
            }
            Some(wear) => self.jump(pass, laws, &repeated, flown, wear),
            None => Leap::ONE,
        };
        let mean = mean.as_deref().unwrap_or(&repeated);
        let taken =
            law::advance(laws, &mut pass.pair, mean, passes as f64, &self.interiors, &mut lost[once..]);
        pass.lost = lost;
        let wear =
            laws.iter().position(|law| law.name() == WEAR).map(|index| law::deepest(&taken[index..=index]));
        let [max_wear_lower, max_wear_upper] = wear.unwrap_or_default();
        let film = |body: &Body| body.state.get(FILM).map_or(0.0, |film| film.values.mean().unwrap_or(0.0));
        let positions = self.positions.len() as f64;
        let done = (self.represented() + passes) as f64;
        let rubbed = pass.contacts.iter().map(|contact| contact.tangential_force.abs()).sum::<f64>();
        let running = RunningRecord {
            represents: passes,
            time: done * positions * passage.time,
            distance: done * positions * passage.distance,
            max_wear_lower,
            max_wear_upper,
            mean_film_lower: film(&pass.pair.lower),
            mean_film_upper: film(&pass.pair.upper),
            friction_work: passes as f64 * rubbed * passage.distance,
            max_flash_temperature: match steps
                .iter()
                .filter_map(|step| step.heat)
                .map(|heat| heat.max_flash_temperature)
                .reduce(f64::max)
            {
                Some(warmest) => warmest,
                None => passage.bulk[0].max(passage.bulk[1]),
            },
            error_estimate: error,
        };
        let jump = (self.acceleration.max_jump > 1).then_some(Jump { passes, sums: repeated });
        Ok((Some(running), jump))
    }

    /// How many passes a solved one stands for, by what its `laws` have summed and the volume that has flown.
    fn jump(
        &self,
        pass: &Pass,
        laws: &[Box<dyn Law>],
        sums: &[Sums],
        flown: CubicMetre,
        wear: &PassWear,
    ) -> Leap {
        let Some(before) = self.warm.jump.as_ref().filter(|_| self.acceleration.max_jump > 1) else {
            return Leap::ONE;
        };
        let one = law::tried(laws, &pass.pair, sums, 1);
        let worn = one.iter().flatten().map(|depth| depth.iter().map(|depth| depth.max(0.0)).sum::<f64>());
        let bounds = Bounds {
            left: self.motion.passes - self.represented(),
            volumes: [flown, self.pair.cell_area() * worn.sum::<f64>()],
            deepest: law::deepest(&one).into_iter().fold(0.0, f64::max),
            stable: wear.stable,
        };
        let mut passes = self.acceleration.most(&bounds, before);
        let pressures = pass.contacts.iter().flat_map(|contact| &contact.pressure);
        let highest = pressures.fold(0.0, |most: f64, (_, p)| most.max(*p));
        let allowed = self.acceleration.tolerance * wear.softness.single * highest;
        while passes > 1 {
            let mean = jump::extrapolated(sums, before, passes);
            let error = law::difference(
                &law::tried(laws, &pass.pair, sums, passes),
                &law::tried(laws, &pass.pair, &mean, passes),
            );
            if error <= allowed {
                return Leap { passes, mean: Some(mean), error };
            }
            // The error of wear grows as the square.
            let fewer = (passes as f64 * (allowed / error).sqrt()) as usize;
            passes = fewer.clamp(1, passes - 1);
        }
        Leap::ONE
    }

    /// Finishes a pass that this motion has solved: the outputs take it, and the next one begins on the bodies that it left.
    ///
    /// # Errors
    /// Those of the outputs; the pass then does not count.
    pub fn finish(
        &mut self,
        pass: SolvedPass,
        watch: &dyn Watch,
        outputs: &mut [&mut dyn Output],
    ) -> Result<()> {
        let record = pass.record();
        let SolvedPass { outcome, hardness, steps, guess, jump, represented, .. } = pass;
        let Pass { contacts, pair, flowed, .. } = outcome;
        // Bodies that meet elsewhere begin anew.
        let (guess, again) = match self.repeats() {
            // Each pass in which they flow begins with bodies that are apart.
            true if self.volumes.is_some() => (guess, &[][..]),
            true => (guess, &contacts[..self.distinct]),
            false => (None, &[][..]),
        };
        let warm = WarmStart::new(guess, again, jump, represented, &self.warm);
        let at = |source| Error::AtPass { pass: record.pass, source };
        pair.check_finite().map_err(|error| error.if_not_finite(at))?;
        for output in outputs.iter_mut() {
            let motion = &self.motion;
            let (record, steps, contacts, pair, warm) = (&record, &steps, &contacts, &pair, &warm);
            let looked_at = flowed.as_ref().map_or(&[][..], |flowed| &flowed.looked_at);
            let flowed = flowed.as_ref().map_or(&[][..], |flowed| &flowed.volumes);
            let hardness = [&hardness[0], &hardness[1]];
            let report =
                PassReport { record, steps, contacts, pair, hardness, motion, warm, flowed, looked_at };
            output.pass(&report).map_err(|error| error.if_not_finite(at))?;
        }
        if let (Some(volumes), Some(flowed)) = (&mut self.volumes, flowed) {
            volumes.take(flowed.volumes);
        }
        self.warm = warm;
        self.pair = pair;
        if !self.motion.repeats() {
            self.positions = self.next_positions();
        }
        self.passes_done = record.pass;
        watch.pass(&record);
        Ok(())
    }

    /// The solver of the next pass.
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
        Solver {
            operators: &self.operators,
            positions: &self.positions[..self.distinct],
            motion: &self.motion,
            interiors: &self.interiors,
            laws: &self.laws,
            watch,
            progress,
        }
    }

    /// One pass from the present geometry, the guess with which the search of the next one begins, and the approaches tried.
    fn solve_pass(&self, pair: &Pair, watch: &dyn Watch) -> Result<(Pass, Option<Guess>, usize)> {
        let positions = &self.positions[..self.distinct];
        let mut earlier: Vec<Vec<Contact>> = self.warm.contacts(pair, positions).into_iter().collect();
        let mut solver = self.solver(watch);
        let load = match (self.motion.control, self.motion.load_control, &self.volumes) {
            (Control::Load(load), LoadControl::Pass, _) => load,
            (control, _, Some(volumes)) => {
                return Ok((solver.solve_flowing(volumes, pair, control)?, None, 1));
            }
            (control, ..) => return Ok((solver.solve(pair, control, &self.params, &earlier)?, None, 1)),
        };
        // Flow takes most of the time of a trial: no contact is solved roughly beside it.
        let roughest = if self.volumes.is_some() { self.params.tolerance } else { MAX_RESIDUAL };
        let mut residual = roughest;
        let mut guess = self.warm.guess;
        if self.together {
            let accuracy = self.motion.load_tolerance;
            let start = earlier.first();
            match solver.solve_together(pair, load, accuracy, &self.params, start) {
                Ok(contacts) => {
                    let slope = guess.map_or(1.0 / height_scale(pair), |guess| guess.slope);
                    guess = Some(Guess { approach: contacts[0].approach, slope });
                    earlier = vec![contacts];
                    residual = self.params.tolerance;
                }
                // The search that follows does without.
                Err(Error::NotConverged { .. }) => {}
                Err(other) => return Err(other),
            }
        }
        let guess = match guess {
            Some(guess) => guess,
            None => self.first_guess(pair, load, watch)?,
        };
        let search = Search {
            load,
            tolerance: self.motion.load_tolerance,
            residual: self.params.tolerance,
            roughest,
            touch: self.touch(pair),
            resolution: resolution(pair),
            limit: self.limit(pair),
        };
        let mut closed = false;
        let found = search.run(guess, residual, |approach, residual| {
            let control = Control::Approach(approach);
            let outcome = match &self.volumes {
                Some(volumes) => solver.solve_flowing(volumes, pair, control)?,
                None => solver.solve_roughly(pair, control, (residual, &self.params), &earlier)?,
            };
            solver.progress.trial += 1;
            closed |= outcome.contacts.iter().any(|contact| self.leaves_mean_free(contact));
            earlier.insert(0, outcome.contacts.clone());
            earlier.truncate(2);
            Ok((outcome.mean_load(), outcome))
        });
        let found = found.map_err(|error| match error {
            // A load that jumps where a position comes into full contact with the pressure below the hardness.
            Error::LoadNotReached { load, below: most, approach, .. } if most > 0.0 && closed => {
                Error::BeyondPass { load, most, approach, cause: LoadLimit::FullContact }
            }
            other => other,
        })?;
        Ok((found.outcome, Some(found.guess), found.trials))
    }

    /// Whether the pressure of a contact determines no approach: all cells touch elastically, and their mean displacement is free.
    fn leaves_mean_free(&self, contact: &Contact) -> bool {
        let cells = self.pair.grid(contact.position.columns).cells();
        self.boundary.leaves_mean_free() && contact.pressure.len() == cells && contact.plastic.is_empty()
    }

    /// The position with the most columns, at two loads near its share of the pass-mean load.
    fn first_guess(&self, pair: &Pair, load: Newton, watch: &dyn Watch) -> Result<Guess> {
        let fullest = self.positions.iter().max_by_key(|p| p.columns).expect("a pass has positions");
        let share = fullest.columns as f64 / mean_columns(&self.positions);
        let limit = bearable(pair, &self.motion, fullest);
        let params = Params { tolerance: 1e-3_f64.max(self.params.tolerance), ..self.params };
        let solve = |load: Newton, start: Option<&Contact>| {
            let start = start.map(|c| c.pressure_field(pair.lower.width()));
            let control = Control::Load(load);
            Contact::solve(pair, &self.operators, *fullest, None, control, start.as_ref(), &params, watch)
        };
        let (less, more) = ((load * share).min(0.9 * limit), (1.2 * load * share).min(0.95 * limit));
        let scale = height_scale(pair);
        let solved =
            solve(less, None).and_then(|first| Ok((first.approach, solve(more, Some(&first))?.approach)));
        let (approach, further) = match solved {
            Ok(approaches) => approaches,
            // A guess that cannot be had is no guess: from the first touch.
            Err(Error::NotConverged { .. }) => {
                return Ok(Guess { approach: self.touch(pair) + scale, slope: 1.0 / scale });
            }
            Err(other) => return Err(other),
        };
        let slope = (more / less).ln() / (further - approach);
        Ok(Guess { approach, slope: if slope > 0.0 && slope.is_finite() { slope } else { 1.0 / scale } })
    }

    /// The approach at which some position of the pass first touches.
    fn touch(&self, pair: &Pair) -> Metre {
        let lowest = |position| pair.initial_gap(position).iter().copied().fold(f64::INFINITY, f64::min);
        self.positions[..self.distinct].iter().map(lowest).fold(f64::INFINITY, f64::min)
    }

    /// The approach beyond which a pass of the bodies as they are bears no more: at which every cell would be at the hardness
    /// at every position, if none had yielded before; of elastic bodies that continue over their edges the mean gap, at which
    /// they are in full contact at all positions. Where some cells yield and others never do, there is none.
    fn limit(&self, pair: &Pair) -> Limit {
        let cap = |hardness| self.motion.friction.map_or(hardness, |friction| friction.sliding_cap(hardness));
        let hardness = cap(pair.max_hardness());
        let largest = |value: fn(&Field) -> f64| {
            let positions = self.positions[..self.distinct].iter();
            positions.map(|p| value(&pair.initial_gap(p))).fold(f64::NEG_INFINITY, f64::max)
        };
        if hardness.is_finite() {
            let highest = largest(|gap| gap.iter().copied().fold(f64::NEG_INFINITY, f64::max));
            let columns = self.positions.iter().map(|p| p.columns).max().unwrap_or(1);
            // Of the hardness on all that faces; the shear of what slides adds less than μ times as much.
            let sinks = self.operators.most_under_uniform([columns, pair.lower.width()]);
            let coefficient = self.motion.friction.map_or(0.0, |friction| friction.coefficient);
            let approach = highest + (1.0 + coefficient) * hardness * sinks;
            Limit { approach, cause: LoadLimit::Yielded }
        } else if self.boundary.leaves_mean_free() && !pair.yields() {
            // Closer to it the load is less certain than the residual.
            let least = -largest(|gap| -gap.mean().unwrap_or(0.0));
            let rough = largest(|gap| gap.std(0.0));
            Limit { approach: least - self.params.tolerance * rough, cause: LoadLimit::FullContact }
        } else {
            Limit { approach: f64::INFINITY, cause: LoadLimit::FullContact }
        }
    }
}

/// The rounding of the heights, as a length.
fn resolution(pair: &Pair) -> Metre {
    let highest = |heights: &Field| heights.iter().fold(0.0, |most, z| f64::max(most, z.abs()));
    f64::EPSILON * highest(&pair.lower.heights).max(highest(&pair.upper.heights))
}

/// The length over which the load changes by a factor of about e, for a first guess: a tenth of the roughness.
fn height_scale(pair: &Pair) -> Metre {
    let roughness = pair.lower.heights.std(0.0).hypot(pair.upper.heights.std(0.0));
    if roughness > 0.0 { 0.1 * roughness } else { pair.pitch()[0] }
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
            return Err(Error::Unsupported("bodies that roll at equal speeds do not slide over each other"));
        }
    }
    if let Control::Approach(approach) = motion.control {
        check_in(Dimension::Length, "approach", approach, approach.is_finite(), "a finite length")?;
    }
    let (lower, upper) = (pair.lower.columns(), pair.upper.columns());
    match motion.strategy {
        Strategy::Overlap if boundary.repeats(0) => {
            return Err(Error::Unsupported("an overlap is a finite contact: its boundary is free along x"));
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
        return Err(Error::Unsupported(
            "bodies that are displaced along y continue over their edges there: their boundary is periodic along y",
        ));
    }
    Ok(motion.positions([lower, upper], pair.lower.width(), 1))
}

/// The most load that the cells at a position bear together.
fn bearable(pair: &Pair, motion: &Motion, position: &Position) -> Newton {
    let bounds = pair.bounds(position, motion.friction.as_ref());
    pair.cell_area() * bounds.upper().sum(pair.grid(position.columns).cells())
}

fn mean_columns(positions: &[Position]) -> f64 {
    positions.iter().map(|p| p.columns).sum::<usize>() as f64 / positions.len() as f64
}

fn interiors(pair: &Pair, boundary: Boundary, motion: &Motion, rim: f64) -> [Interior; 2] {
    let shapes = [pair.lower_grid().shape, pair.upper_grid().shape];
    Interior::of_bodies(shapes, boundary, motion.strategy, rim)
}

/// The record of a pass, a row of `passes.csv`, but for the number of approaches tried and the time.
fn summarise(outcome: &Pass, interiors: &[Interior; 2], steps: &[StepRecord]) -> PassRecord {
    let pair = &outcome.pair;
    let mean_columns = steps.iter().map(|s| s.overlap_columns as f64).sum::<f64>() / steps.len() as f64;
    let mean = |value: fn(&StepRecord) -> f64| steps.iter().map(value).sum::<f64>() / steps.len() as f64;
    let most = |value: fn(&StepRecord) -> f64| steps.iter().map(value).fold(f64::NEG_INFINITY, f64::max);
    PassRecord {
        pass: steps[0].pass,
        approach: mean(|s| s.approach),
        mean_load: mean(|s| s.load),
        mean_tangential_force: mean(|s| s.tangential_force),
        friction_coefficient: mean(|s| s.tangential_force.abs()) / mean(|s| s.load),
        min_load: -most(|s| -s.load),
        max_load: most(|s| s.load),
        mean_pressure: mean(|s| s.load) / (mean_columns * pair.grid(1).area()),
        mean_contact_area: mean(|s| s.contact_area),
        mean_contact_area_interior: mean(|s| s.contact_area_interior),
        largest_spot_cells: steps.iter().map(|s| s.largest_spot_cells).max().unwrap_or(0),
        max_pressure: most(|s| s.max_pressure),
        lost: outcome.lost.clone(),
        running: None,
        flow: None,
        sq_lower: pair.lower.heights.std(0.0),
        sq_upper: pair.upper.heights.std(0.0),
        sq_lower_interior: interiors[0].of(&pair.lower.heights).std(0.0),
        sq_upper_interior: interiors[1].of(&pair.upper.heights).std(0.0),
        outer_iterations: 1,
        convolutions: steps.iter().map(|s| s.convolutions).sum(),
        wall_time_s: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Material;
    use crate::solver::Method;
    use crate::surface::{Amplitude, SelfAffine};

    struct Reports(Vec<PassRecord>);

    impl Output for Reports {
        fn pass(&mut self, report: &PassReport) -> Result<()> {
            self.0.push(report.record.clone());
            Ok(())
        }
    }

    fn passes(strategy: Strategy, boundary: Boundary, together: bool) -> Vec<PassRecord> {
        let grid = crate::grid::Grid::new([32, 24], [1e-6, 1.5e-6]).unwrap();
        let form =
            SelfAffine { hurst: 0.8, rolloff: None, shortest: Some(6e-6), amplitude: Amplitude::Sq(0.1e-6) };
        let steel = Material::new(210e9, 0.3, 3e9).unwrap();
        let surface = |seed| form.generate(&grid, seed).unwrap();
        let pair = Pair::new(surface(1), surface(2), [&steel, &steel]).unwrap();
        let motion = Motion::new(strategy, Control::Load(0.05 * 3e9 * grid.area()))
            .with_passes(3)
            .with_stride(4)
            .with_load_tolerance(1e-6);
        let mut simulation = Simulation::new(
            pair,
            boundary,
            motion,
            Params { method: Method::ActiveSet, ..Params::default() },
        )
        .unwrap();
        assert!(simulation.together);
        simulation.together = together;
        let mut reports = Reports(Vec::new());
        simulation.run(&(), &mut [&mut reports]).unwrap();
        reports.0
    }

    #[test]
    fn cells_that_never_yield_bear_what_those_that_do_leave_them() {
        let grid = crate::grid::Grid::new([12, 8], [1e-6; 2]).unwrap();
        let form = SelfAffine { hurst: 0.8, rolloff: None, shortest: None, amplitude: Amplitude::Sq(5e-9) };
        let steel = Material::new(210e9, 0.3, f64::INFINITY).unwrap();
        let surface = |seed| form.generate(&grid, seed).unwrap();
        let pair = Pair::new(surface(1), surface(2), [&steel, &steel]).unwrap();
        let soft = Field::from_shape_fn([12, 8], |(i, _)| if i % 4 < 2 { 0.1e9 } else { f64::INFINITY });
        let pair = pair.with_hardness([soft.into(), f64::INFINITY.into()]).unwrap();
        let load = 1e9 * grid.area();
        let motion = Motion::new(Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 }, Control::Load(load))
            .with_passes(1)
            .with_stride(3)
            .with_load_tolerance(1e-4);
        for method in [Method::Direct, Method::ActiveSet] {
            let params = Params { method, ..Params::default() };
            let mut simulation = Simulation::new(pair.clone(), Boundary::PERIODIC, motion, params).unwrap();
            let mut reports = Reports(Vec::new());
            simulation.run(&(), &mut [&mut reports]).unwrap();
            // The planes of the mean heights are 0: pressed beyond full contact.
            assert!(reports.0[0].approach > 0.0, "{method:?}: {:e}", reports.0[0].approach);
            assert!((reports.0[0].mean_load / load - 1.0).abs() < 1e-4, "{method:?}");
        }
    }

    #[test]
    fn all_positions_together_are_the_search_on_the_approach_in_fewer_convolutions() {
        let shift = Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 };
        for (strategy, boundary) in [(Strategy::Overlap, Boundary::FREE), (shift, Boundary::PERIODIC)] {
            let [one, other] = [true, false].map(|together| passes(strategy, boundary, together));
            for (a, b) in one.iter().zip(&other) {
                let close = |a: f64, b: f64, tolerance: f64| (a / b - 1.0).abs() < tolerance;
                assert!((a.approach - b.approach).abs() < 1e-6 * 0.1e-6, "{a:?}\n{b:?}");
                assert!(close(a.mean_load, b.mean_load, 2e-6) && close(a.max_load, b.max_load, 1e-5));
                assert!(close(a.lost("plastic")[0], b.lost("plastic")[0], 1e-3), "{a:?}\n{b:?}");
            }
            let cost = |passes: &[PassRecord]| passes.iter().map(|p| p.convolutions).sum::<f64>();
            assert!(cost(&one) < 0.8 * cost(&other), "{} and {}", cost(&one), cost(&other));
        }
    }
}

//! Sliding in place: a static contact slides some distance while the same cells stay in contact.

use crate::error::{Error, Result, check, check_in};
use crate::grid::{CellValues, Field};
use crate::motion::changes::{Changes, FrictionalHeat};
use crate::motion::contact::{Contact, facing};
use crate::motion::control::check_limit;
use crate::motion::course::{self, Course, Output, Step, StepRow};
use crate::motion::creeping;
use crate::motion::kinematics::Strategy;
use crate::motion::law::{self, Heat, PositionData, Sums};
use crate::motion::pair::{Pair, opposing_values};
use crate::motion::path::Position;
use crate::motion::record::{LawsInUpdate, StaticRecord, UpdateRecord};
use crate::motion::rim::Interior;
use crate::motion::slip::SlipRegime;
use crate::motion::spot::largest_spot;
use crate::motion::state::SlidingState;
use crate::motion::truncation::Truncation;
use crate::motion::watch::{StaticWatch, Watch};
use crate::motion::worn_away;
use crate::operator::Boundary;
use crate::solver::{
    ContactProblem, ContactSolver, Control, Equilibrium, Friction, Guess, InterfaceRecord, Loading, Params,
    Sliding, Solution, Stats,
};
use crate::temperature::{FlashStep, SteadyTemperature};
use crate::units::{Dimension, Kelvin, Metre, MetrePerSecond, Second};

/// Sliding in place. The upper body slides towards +x, while the cells of the lower body stay under the same
/// cells of the upper one. Examples are a pin on a disc, and a body that is worn uniformly along its path.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Slide {
    /// Distances slid at the ends of the updates, > 0, increasing.
    pub ends: Vec<Metre>,
    /// Prescribed load or approach, constant over the whole distance.
    pub control: Control,
    /// Friction of the bodies, if any.
    pub friction: Option<Friction>,
    /// Speed of the upper body over the lower one, > 0, if known.
    pub speed: Option<MetrePerSecond>,
}

impl Slide {
    /// Slides over a `distance`, > 0, in `updates` updates, ≥ 1. The i-th ends at distance · (i/updates)²,
    /// because a worn contact changes ever more slowly. An update is a step of backward Euler. The error of
    /// depths is of first order in the number of updates; worn volumes have none.
    pub fn graded(distance: Metre, updates: usize, control: Control) -> Self {
        let end = |update: usize| distance * (update as f64 / updates as f64).powi(2);
        Self::to((1..=updates).map(end).collect(), control)
    }

    /// Slides in updates that end at these distances.
    pub const fn to(ends: Vec<Metre>, control: Control) -> Self {
        Self { ends, control, friction: None, speed: None }
    }

    /// Sets or removes the friction.
    #[must_use]
    pub fn with_friction(self, friction: impl Into<Option<Friction>>) -> Self {
        Self { friction: friction.into(), ..self }
    }

    /// Sets the speed, > 0.
    #[must_use]
    pub fn with_speed(self, speed: impl Into<Option<MetrePerSecond>>) -> Self {
        Self { speed: speed.into(), ..self }
    }

    /// Direction of sliding and friction, if there is friction.
    fn sliding(&self) -> Option<Sliding> {
        self.friction.map(|friction| Sliding { friction, direction: [1.0, 0.0] })
    }

    /// Returns the data of an update that laws need besides the contact; `update` is the index of the
    /// distance at its end, and `bulk` the temperature of each body.
    fn position_data(&self, update: usize, bulk: [Kelvin; 2]) -> PositionData {
        let before = if update == 0 { 0.0 } else { self.ends[update - 1] };
        let distance = self.ends[update] - before;
        PositionData { sliding: self.sliding(), distance, time: self.time(distance), bulk }
    }

    /// Time to slide a distance; NaN if the speed is unknown.
    fn time(&self, distance: Metre) -> Second {
        self.speed.map_or(f64::NAN, |speed| distance / speed)
    }

    /// Returns how the bodies slip on each other.
    fn regime(&self) -> SlipRegime {
        self.sliding().into()
    }

    fn checked(self) -> Result<Self> {
        check("updates", self.ends.len() as f64, !self.ends.is_empty(), "at least one update")?;
        let mut before = 0.0;
        for &end in &self.ends {
            let further = end > before && end.is_finite();
            check_in(
                Dimension::Length,
                "distance",
                end,
                further,
                "a distance above that of the update before",
            )?;
            before = end;
        }
        if let Some(speed) = self.speed {
            check_in(Dimension::Speed, "speed", speed, speed > 0.0 && speed.is_finite(), "a speed above 0")?;
        }
        if let Some(friction) = self.friction {
            friction.checked()?;
        }
        Ok(self)
    }
}

impl SlidingState {
    /// Returns the state with the bodies of a `contact`, on which its laws are prepared.
    #[must_use]
    pub fn resumed(self, contact: &SlidingContact) -> Self {
        Self { pair: contact.pair.clone(), ..self }
    }

    /// Returns the state after an update of this `time` with its `record`.
    fn after(mut self, pressed: Pressed, record: UpdateRecord, time: Second) -> Updated {
        let Pressed { solution, elastic, .. } = pressed;
        self.pressure.assign(&solution.pressure);
        self.updates.push(record);
        if !self.pair.interface().is_hard() {
            self.contact = Some(solution.clone());
        }
        if let (Some(memory), Some(elastic)) = (&mut self.memory, elastic) {
            memory.advance(elastic, time);
        }
        Updated { state: self, solution }
    }
}

/// A contact that has slid the whole distance.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct SlidingOutcome {
    /// The state after the last update.
    pub state: SlidingState,
    /// The record of the final contact.
    pub record: StaticRecord,
    /// The final contact.
    pub solution: Solution,
    /// Absolute temperature of the cells in contact, K, NaN elsewhere; `None` if it is not computed.
    pub temperature: Option<Field>,
}

/// Two bodies that slide in place.
///
/// An update is implicit (backward Euler): the contact is solved on the bodies at the end of the update, worn
/// by κ p. This is the contact problem with [`Compliant`](crate::operator::Compliant) cells, κ = Σ k |Δs|
/// over both bodies, cell by cell. Pressures therefore stay smooth for any length of an update, and the worn
/// volume is k W |Δs| to round-off. The coefficient of a cell under a film is evaluated at the mean film
/// thickness of the update, found together with the contact. Film growth and plastic deformation use the
/// bodies at the beginning of the update. A viscoelastic upper body creeps meanwhile, by the pressures on its
/// own cells.
pub struct SlidingContact {
    slide: Slide,
    boundary: Boundary,
    params: Params,
    solver: Box<dyn ContactSolver>,
    interiors: [Interior; 2],
    changes: Changes,
    heat: Option<SteadyTemperature>,
    pair: Pair,
}

/// Largest change of the coefficients from one solution of an update to the next at which they have
/// converged, relative to the largest coefficient.
const COEFFICIENT_ACCURACY: f64 = 1e-4;
/// Number of solutions of an update after which its coefficients are accepted. They then change by less than
/// the film does.
const MAX_SOLUTIONS: usize = 12;

impl SlidingContact {
    /// Creates a contact of a `pair` at full overlap.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] or [`Error::Unsupported`] for invalid input, [`Error::BeyondPlasticLimit`] if
    /// the bodies cannot carry the load.
    ///
    /// # Panics
    /// If the bodies have different shapes.
    pub fn new(pair: Pair, boundary: Boundary, slide: Slide, params: Params) -> Result<Self> {
        let slide = slide.checked()?;
        creeping::check_in_place(&pair, slide.regime(), slide.speed.is_some(), params.device)?;
        let (operators, _) = facing(&pair, boundary)?;
        let shape = pair.lower_grid().shape;
        let bounds = slide.regime().sheared(pair.bounds(&pair.at_rest()));
        check_limit(slide.control, pair.cell_area() * bounds.upper().sum(shape[0] * shape[1]))?;
        Ok(Self {
            solver: slide.regime().solver(&pair, &operators, shape, params.device)?,
            interiors: Interior::of_bodies([shape; 2], boundary, Strategy::Overlap, 0.0),
            changes: Changes::by(Truncation),
            heat: None,
            slide,
            boundary,
            params,
            pair,
        })
    }

    /// Sets what updates do to the bodies, besides plastic deformation, which acts first. The contact is
    /// stationary on the upper body, and its heat moves over the lower one at the sliding speed.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for heat without friction, a speed or temperatures of the bodies, for an
    /// extrapolation and for memories of load cycles; the errors of [`SteadyTemperature::new`].
    pub fn with_changes(mut self, mut changes: Changes) -> Result<Self> {
        if changes.jumps() || !changes.memories.is_empty() {
            return Err(Error::Unsupported("sliding in place has no cycles to extrapolate or to remember"));
        }
        changes.prepare(&mut self.pair)?;
        let (grid, boundary) = (self.pair.lower_grid(), self.boundary);
        let speed = self.slide.speed.filter(|_| self.slide.friction.is_some());
        let heated = changes.heated(speed.is_some())?.zip(speed);
        let steady = heated.map(|(FrictionalHeat { thermal, .. }, speed)| {
            SteadyTemperature::new(grid, thermal, boundary, [-speed, 0.0], changes.bulk)
        });
        self.heat = steady.transpose()?;
        changes.laws.insert(0, Box::new(Truncation));
        Ok(Self { changes, ..self })
    }

    /// The bodies before sliding.
    pub fn pair(&self) -> &Pair {
        &self.pair
    }

    /// The parameters of the sliding.
    pub fn slide(&self) -> &Slide {
        &self.slide
    }

    /// Slides the whole distance, from the beginning or from a state `under_way`. A resumed contact gives the
    /// same result, bit by bit.
    ///
    /// # Errors
    /// The errors of [`crate::solver::solve_normal`], of [`SteadyTemperature::solve`] and of the outputs;
    /// [`Error::Interrupted`].
    pub fn run(
        self,
        under_way: Option<SlidingState>,
        watch: &dyn Watch,
        outputs: &mut [&mut dyn Output],
    ) -> Result<SlidingOutcome> {
        under_way.iter().flat_map(|state| &state.updates).for_each(|update| watch.update(update));
        let mut course = Updates { contact: self, state: under_way };
        course::run(&mut course, watch, outputs)?;
        let Updates { contact, state } = course;
        let state = state.expect("the contact before it slides");
        let update = state.updates.len() - 1;
        contact
            .end(state, watch)
            .map_err(|error| error.if_of_step(|source| Error::AtUpdate { update, source }))
    }

    /// Solves the contact of the bodies after the last update.
    fn end(mut self, state: SlidingState, watch: &dyn Watch) -> Result<SlidingOutcome> {
        let Pressed { solution, contact, .. } =
            self.press(&state, 0.0.into(), 0.0, self.slide.ends.len(), watch)?;
        let flash = self.flash(&contact)?;
        // Without contact no cell has a temperature.
        let heated = self.heat.is_some();
        let temperature = heated.then(|| flash.map_or_else(Vec::new, |flash| flash.temperature));
        let contact = Contact { temperature, ..contact };
        let temperature = contact.temperature_field(solution.pressure.ncols());
        let record = StaticRecord { interface: contact.interface, ..StaticRecord::new(&solution) };
        Ok(SlidingOutcome { state, record, solution, temperature })
    }

    /// Solves the contact before sliding.
    fn begin(&mut self, watch: &dyn Watch) -> Result<Updated> {
        let pair = self.pair.clone();
        let (pressure, memory) = (pair.lower_grid().zeros(), creeping::memory(&pair));
        let state = SlidingState { pair, updates: Vec::new(), pressure, contact: None, memory };
        let pressed = self.press(&state, 0.0.into(), 0.0, 0, watch)?;
        let flash = self.flash(&pressed.contact)?;
        let record = UpdateRecord {
            distance: 0.0,
            time: self.slide.time(0.0),
            lost: law::nothing_lost(&self.changes.laws),
            ..self.record(&state.pair, &pressed.contact, flash.as_ref())
        };
        Ok(state.after(pressed, record, 0.0))
    }

    /// Solves the update that ends at the distance of this `index`.
    fn advance(&mut self, mut state: SlidingState, index: usize, watch: &dyn Watch) -> Result<Updated> {
        let position_data = self.slide.position_data(index, self.changes.bulk);
        let nothing = law::nothing(&self.changes.laws, &state.pair);
        let mut compliance = self.compliance(&state.pair, &nothing, position_data.distance, &state.pressure);
        let (mut stats, mut solutions) = (Stats::default(), 0);
        let time = position_data.time;
        let (pressed, flash, sums) = loop {
            let pressed = self.press(&state, compliance.clone(), time, index, watch)?;
            let Pressed { solution, contact, .. } = &pressed;
            state.pressure.assign(&solution.pressure);
            stats = stats.and(&solution.stats);
            solutions += 1;
            let flash = self.flash(contact)?;
            let sums = self.sums(&state.pair, contact, &position_data, flash.as_ref())?;
            let next = self.compliance(&state.pair, &sums, position_data.distance, &solution.pressure);
            // A cell whose pressure is hardly one may go on changing between pressure and tension.
            let highest = contact.max_pressure();
            let weight =
                |pressure: f64| if state.pair.interface().is_hard() { 1.0 } else { pressure.abs() / highest };
            let change = |(cell, pressure): &(u32, f64)| {
                weight(*pressure) * (next.value(*cell as usize) - compliance.value(*cell as usize)).abs()
            };
            let most = contact.pressure.iter().map(change).fold(0.0, f64::max);
            if most <= COEFFICIENT_ACCURACY * next.max() || solutions == MAX_SOLUTIONS {
                break (pressed, flash, sums);
            }
            compliance = next;
        };
        let contact = &pressed.contact;
        let before = state.updates.last().expect("the contact before it slides");
        let mut lost = before.lost.clone();
        let work = before.friction_work + contact.tangential_force.abs() * position_data.distance;
        law::advance(&self.changes.laws, &mut state.pair, &sums, 1.0, &self.interiors, &mut lost);
        worn_away::check_cells(&state.pair, &self.changes.laws)?;
        let distance = self.slide.ends[index];
        let record = UpdateRecord {
            update: index + 1,
            distance,
            time: self.slide.time(distance),
            lost,
            friction_work: work,
            solutions,
            iterations: stats.iterations,
            convolutions: stats.convolutions,
            ..self.record(&state.pair, contact, flash.as_ref())
        };
        Ok(state.after(pressed, record, time))
    }

    /// Solves the contact after a `state` with the additional cell `compliance`, at the end of an update of
    /// this `time`, after `done` updates.
    fn press(
        &mut self,
        state: &SlidingState,
        compliance: CellValues,
        time: Second,
        done: usize,
        watch: &dyn Watch,
    ) -> Result<Pressed> {
        let pair = &state.pair;
        let (control, position) = (self.slide.control, pair.at_rest());
        let (gap, bounds) = (pair.initial_gap(&position), pair.bounds(&position));
        let watch = StaticWatch::new(watch, done, self.slide.ends.len(), control);
        let last = state.contact.clone();
        let last = last.map(|last| Equilibrium::Frictionless(Box::new(last)).over(&gap));
        let begins = state.updates.is_empty();
        let problem = ContactProblem {
            compliance: Some(&compliance),
            before: last.as_ref(),
            guess: (!begins).then_some(Guess::Pressure(&state.pressure)),
            ..ContactProblem::new(&gap, &bounds, Loading::pressing(control), &self.params, &watch)
        };
        let (solution, elastic) = match &state.memory {
            None => (self.solver.solve(&problem)?.into_normal(), None),
            Some(memory) => {
                let (operator, modulus) = (self.solver.normal(), pair.modulus());
                let (solution, elastic) = creeping::load_removing(operator, modulus, memory, &problem, time)?;
                (solution, Some(elastic))
            }
        };
        let before = last.as_ref().map(Equilibrium::normal);
        let interface = InterfaceRecord::new(pair.interface(), &solution, before);
        let contact =
            Contact { interface, ..Contact::new(position, self.slide.sliding().as_ref(), &solution) };
        Ok(Pressed { solution, contact, elastic })
    }

    /// Returns the depth κ that laws remove from each cell of both bodies per pressure over a `distance`,
    /// m/Pa, with these sums; nothing where the attraction of the bodies pulls by this `pressure`.
    fn compliance(&self, pair: &Pair, sums: &[Sums], distance: Metre, pressure: &Field) -> CellValues {
        let friction = self.slide.friction.map_or(0.0, |friction| friction.coefficient);
        let [lower, upper] = law::compliance(&self.changes.laws, pair, sums, friction, distance);
        let shape = pair.lower_grid().shape;
        let depths =
            opposing_values([&lower, &upper], [shape; 2], &pair.at_rest(), |lower, upper| lower + upper);
        if pair.interface().is_hard() {
            return depths;
        }
        let mut pressed = pressure.clone();
        pressed
            .iter_mut()
            .enumerate()
            .for_each(|(cell, p)| *p = if *p > 0.0 { depths.value(cell) } else { 0.0 });
        pressed.into()
    }

    /// Returns the sums of the laws over an update.
    fn sums(
        &self,
        pair: &Pair,
        contact: &Contact,
        position_data: &PositionData,
        flash: Option<&FlashStep>,
    ) -> Result<Vec<Sums>> {
        let mut known =
            flash.map(|flash| |_: [&[u32]; 2], _: &Position, _: &[f64]| Ok(flash.temperature.clone()));
        let heat = known.as_mut().map(|known| known as &mut Heat);
        Ok(law::sums(&self.changes.laws, pair, std::slice::from_ref(contact), position_data, heat)?.0)
    }

    /// Returns the temperature of the cells in contact; `None` if it is not requested or nothing touches.
    fn flash(&mut self, contact: &Contact) -> Result<Option<FlashStep>> {
        let (Some(heat), Some(speed), Some(friction)) =
            (&mut self.heat, self.slide.speed, self.slide.friction)
        else {
            return Ok(None);
        };
        if contact.pressure.is_empty() {
            return Ok(None);
        }
        let cells: Vec<u32> = contact.pressure.iter().map(|(cell, _)| *cell).collect();
        let flux: Vec<f64> = contact.pressure.iter().map(|(_, p)| friction.shear_limit(*p) * speed).collect();
        heat.solve(&cells, &flux).map(Some)
    }

    /// Creates the record of an update from its contact.
    fn record(&self, pair: &Pair, contact: &Contact, flash: Option<&FlashStep>) -> UpdateRecord {
        let cells = || contact.pressure.iter().map(|(cell, _)| *cell as usize);
        let mut laws = LawsInUpdate::default();
        self.changes.laws.iter().for_each(|law| law.record_update(pair, contact, &mut laws));
        UpdateRecord {
            update: 0,
            distance: 0.0,
            time: 0.0,
            load: contact.load,
            approach: contact.approach,
            tangential_force: contact.tangential_force,
            contact_area: pair.cell_area() * contact.pressure.len() as f64,
            largest_spot_cells: largest_spot(cells(), pair.lower_grid().shape, self.boundary.wraps()),
            max_pressure: contact.max_pressure(),
            plastic_cells: contact.plastic.len(),
            lost: Vec::new(),
            laws,
            friction_power: contact.tangential_force.abs() * self.slide.speed.unwrap_or(f64::NAN),
            friction_work: 0.0,
            max_temperature: flash.and_then(FlashStep::max_temperature).unwrap_or(self.changes.warmer_bulk()),
            solutions: 1,
            iterations: contact.stats.iterations,
            convolutions: contact.stats.convolutions,
            residual: contact.residual,
            interface: contact.interface,
        }
    }
}

/// A contact at the end of an update.
struct Pressed {
    solution: Solution,
    contact: Contact,
    /// Displacement by which the memory of viscoelastic bodies advances.
    elastic: Option<Field>,
}

/// An update, and the contact at its end.
struct Updated {
    state: SlidingState,
    solution: Solution,
}

/// The updates of a contact that slides in place.
struct Updates {
    contact: SlidingContact,
    /// State after the last update; `None` before the contact is pressed.
    state: Option<SlidingState>,
}

impl Course for Updates {
    type Solved = Updated;

    fn next(&mut self, watch: &dyn Watch) -> Result<Option<Updated>> {
        let at = |update| move |error: Error| error.if_of_step(|source| Error::AtUpdate { update, source });
        let Some(state) = self.state.take() else {
            return self.contact.begin(watch).map(Some).map_err(at(0));
        };
        let index = state.updates.len() - 1;
        if index == self.contact.slide.ends.len() {
            self.state = Some(state);
            return Ok(None);
        }
        if watch.stop() {
            return Err(Error::Interrupted);
        }
        self.contact.advance(state, index, watch).map(Some).map_err(at(index + 1))
    }

    fn report<'a>(&'a self, Updated { state, solution }: &'a Updated) -> Step<'a> {
        let record = state.updates.last().expect("the update just done");
        let number = state.updates.len() - 1;
        Step {
            contact: Some(solution),
            changed: Some(&state.pair).filter(|_| number > 0),
            state: Some(state),
            ..Step::new(number, self.contact.slide.ends.len(), StepRow::Update(record))
        }
    }

    fn take(&mut self, Updated { state, .. }: Updated) {
        self.state = Some(state);
    }
}

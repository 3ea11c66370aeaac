//! Passes of elasto-plastic bodies.

use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::error::Result;
use crate::grid::Field;
use crate::motion::contact::Contact;
use crate::motion::pair::Pair;
use crate::motion::pass::{Pass, Solver};
use crate::motion::path::Position;
use crate::motion::plastic_volume::{ElastoPlasticPass, PlasticVolume, displace};
use crate::motion::record::{PassPlasticRecord, PlasticStepRecord};
use crate::motion::slip::SlipRegime;
use crate::motion::watch::{OneOfMany, Progress};
use crate::operator::{Boundary, Operators};
use crate::plasticity::{
    Increment, PlasticBody, PlasticContact, PlasticParams, PlasticState, RelativePosition,
};
use crate::solver::{Control, Loading, Params};
use crate::units::Joule;

/// Number of equal loading steps at the first position of a pass, which takes its load from zero.
const FIRST_STEPS: usize = 8;
/// Width in columns of the rim at either end of the overlap.
const RIM: usize = 2;

/// The volumes of elasto-plastic bodies in a motion.
pub(super) struct Volumes {
    /// The contact at a position, with the plastic state within a pass.
    contact: Mutex<PlasticContact>,
    /// The plastic state after the finished passes.
    states: Vec<PlasticState>,
    boundary: Boundary,
    /// The position whose plastic state is reported.
    states_under_load: Option<usize>,
}

impl Volumes {
    /// Creates the volumes of the given `bodies` of a `pair`, lower one first, which begin at a `position`.
    pub(super) fn new(
        bodies: [Option<PlasticBody>; 2],
        pair: &Pair,
        operators: &Operators,
        position: &Position,
        boundary: Boundary,
        (plastic, params): (PlasticParams, &Params),
    ) -> Result<Self> {
        let facing = facing(pair, operators, position, SlipRegime::Frictionless, params)?;
        let mut contact = PlasticContact::new(facing, bodies, plastic, *params);
        let states = states(&mut contact);
        Ok(Self { contact: Mutex::new(contact), states, boundary, states_under_load: None })
    }

    /// The plastic state after the finished passes.
    pub(super) fn states(&self) -> &[PlasticState] {
        &self.states
    }

    /// Selects a position whose plastic state is reported.
    pub(super) fn states_under_load(self, position: usize) -> Self {
        Self { states_under_load: Some(position), ..self }
    }

    /// Sets the plastic state.
    pub(super) fn with_states(self, states: Vec<PlasticState>) -> Self {
        Self { states, ..self }
    }

    /// Continues from a finished pass.
    pub(super) fn take(&mut self, volumes: Vec<PlasticVolume>) {
        self.states = volumes.into_iter().map(|volume| volume.state).collect();
    }

    /// Moves the plastic strain of these `volumes` up where the depth `worn` of the material above it has
    /// gone, and the surfaces of a `pair` with its displacement.
    pub(super) fn uncover(&self, volumes: &mut Vec<PlasticVolume>, pair: &mut Pair, worn: &[Field; 2]) {
        if volumes.iter().all(|volume| worn[volume.body].iter().all(|depth| *depth <= 0.0)) {
            return;
        }
        let states: Vec<PlasticState> =
            volumes.iter().map(|volume| volume.state.uncovered(&volume.faces, &worn[volume.body])).collect();
        let mut contact = self.contact.lock().unwrap_or_else(PoisonError::into_inner);
        contact.restore(&states);
        volumes.iter().for_each(|volume| displace(pair, volume.body, &volume.displacement, -1.0));
        *volumes = PlasticVolume::unloaded(&mut contact);
        volumes.iter().for_each(|volume| displace(pair, volume.body, &volume.displacement, 1.0));
    }

    /// Returns the volumes after the finished passes.
    pub(super) fn volumes(&self) -> Vec<PlasticVolume> {
        PlasticVolume::unloaded(&mut self.begin())
    }

    /// Returns the contact before a pass.
    fn begin(&self) -> MutexGuard<'_, PlasticContact> {
        let mut contact = self.contact.lock().unwrap_or_else(PoisonError::into_inner);
        contact.restore(&self.states);
        contact
    }
}

impl Solver<'_> {
    /// Solves the positions of a pass of the elasto-plastic bodies of a `pair`, one after another, and
    /// removes the load.
    pub(super) fn solve_elasto_plastic(
        &self,
        volumes: &Volumes,
        pair: &Pair,
        control: Control,
        params: &Params,
    ) -> Result<Pass> {
        let mut contact = volumes.begin();
        // The bodies without their plastic displacement, which the contact adds.
        let mut undeformed = pair.clone();
        for (index, side) in contact.sides().to_vec().into_iter().enumerate() {
            displace(&mut undeformed, side, contact.bodies()[index].displacement(), -1.0);
        }
        let mut course = Course { work: [0.0; 2], at_rim: 0.0, steps: Vec::new(), contacts: Vec::new() };
        let mut states_under_load = Vec::new();
        let mut carrier = Carrier { body: 1, last: None };
        for (index, position) in self.positions.iter().enumerate() {
            let shifts = carrier.shifts(position, pair, volumes.boundary);
            contact.move_to(self.facing(&undeformed, position, params)?, shifts);
            let step = self.step(&mut contact, control, index);
            let increments = step.map_err(|error| self.at_position(index, error))?;
            carrier.arrive(position, contact.pressure());
            if volumes.states_under_load == Some(index) {
                states_under_load = states(&mut contact);
            }
            let here = self.contact(index, contact.solution().expect("a contact at the position"));
            let (solved, load) = (index + 1, here.load);
            course.contacts.push(here);
            course.add(&increments, &mut contact, pair, position, volumes.boundary);
            self.watch.position(&Progress { solved, load, ..self.progress });
        }
        let last = self.positions.len() - 1;
        let apart = contact.go_to(Control::Load(0.0)).map_err(|error| self.at_position(last, error))?;
        course.work_of(&apart, contact.sides());
        let left = states(&mut contact);
        contact.restore(&left);
        let after = PlasticVolume::unloaded(&mut contact);
        drop(contact);
        let mut bodies = undeformed;
        after.iter().for_each(|volume| displace(&mut bodies, volume.body, &volume.displacement, 1.0));
        let Course { work, at_rim, steps, contacts } = course;
        let record = PassPlasticRecord::new(&after, volumes.states(), work, at_rim);
        let plastic_pass = Some(ElastoPlasticPass { volumes: after, steps, record, states_under_load });
        Ok(Pass { plastic_pass, ..Pass::new(contacts, bodies, self.laws) })
    }

    /// Returns how the bodies of a `pair` are placed at a position.
    fn facing(&self, pair: &Pair, position: &Position, params: &Params) -> Result<RelativePosition> {
        facing(pair, self.operators, position, self.motion.slip(position.stroke), params)
    }

    /// Loads the bodies at a position; the first position of the pass is loaded in steps.
    fn step(&self, contact: &mut PlasticContact, control: Control, index: usize) -> Result<Vec<Increment>> {
        let steps = if index == 0 { FIRST_STEPS } else { 1 };
        let touch = contact.first_touch();
        let watch = OneOfMany(self.watch);
        let at = |step: usize| match control {
            _ if step == steps => control,
            Control::Load(load) => Control::Load(load * step as f64 / steps as f64),
            Control::Approach(approach) => {
                Control::Approach(touch + (approach - touch) * step as f64 / steps as f64)
            }
        };
        (1..=steps).map(|step| contact.load(Loading::pressing(at(step)), &watch)).collect()
    }
}

/// Returns how the bodies of a `pair` are placed at a position, and how they slip on each other there.
fn facing(
    pair: &Pair,
    operators: &Operators,
    position: &Position,
    regime: SlipRegime,
    params: &Params,
) -> Result<RelativePosition> {
    let shape = [position.columns, pair.lower.width()];
    Ok(RelativePosition {
        solver: regime.solver(pair, operators, shape, params.device)?,
        initial_gap: pair.initial_gap(position),
        bounds: pair.bounds(position),
        placements: pair.placements(position),
    })
}

fn states(contact: &mut PlasticContact) -> Vec<PlasticState> {
    contact.bodies().iter().map(|body| body.state().clone()).collect()
}

/// Sums over a running pass.
struct Course {
    /// Plastic work in the lower and in the upper body.
    work: [Joule; 2],
    /// The part of it at the rim of the overlap.
    at_rim: Joule,
    steps: Vec<PlasticStepRecord>,
    contacts: Vec<Contact>,
}

impl Course {
    /// Adds the increments at a position.
    fn add(
        &mut self,
        increments: &[Increment],
        contact: &mut PlasticContact,
        pair: &Pair,
        position: &Position,
        boundary: Boundary,
    ) {
        self.steps.push(PlasticStepRecord::from_increments(increments, contact));
        for increment in increments {
            self.work_of(increment, contact.sides());
            if boundary.repeats(0) {
                continue;
            }
            let placements = pair.placements(position);
            let ends = (0..position.columns).filter(|j| *j < RIM || *j + RIM >= position.columns);
            for (plastic, side) in increment.bodies.iter().zip(contact.sides()) {
                let width = pair.lower.width();
                let column = |j: usize| placements[*side].cell(j * width) / width;
                self.at_rim += ends.clone().map(|j| plastic.work_of_columns[column(j)]).sum::<f64>();
            }
        }
    }

    fn work_of(&mut self, increment: &Increment, sides: &[usize]) {
        increment
            .bodies
            .iter()
            .zip(sides)
            .for_each(|(plastic, side)| self.work[*side] += plastic.plastic_work);
    }
}

/// The body with which the load moves over the other one: the one whose summits carry it.
struct Carrier {
    body: usize,
    /// The last position, and the pressure there.
    last: Option<(Position, Field)>,
}

impl Carrier {
    /// Returns by how many cells the load moves over the lower and over the upper body to the next position.
    fn shifts(&self, to: &Position, pair: &Pair, boundary: Boundary) -> [[isize; 2]; 2] {
        let Some((from, _)) = &self.last else { return [[0; 2]; 2] };
        let [from, to] = [from.places(), to.places()];
        let moved = |body: usize| to[body] - from[body];
        let other = 1 - self.body;
        let mut shift = (moved(other) - moved(self.body)).round() as isize;
        if boundary.repeats(0) {
            let columns = pair.lower.columns() as isize;
            shift = (shift + columns / 2).rem_euclid(columns) - columns / 2;
        }
        let mut shifts = [[0; 2]; 2];
        shifts[other][0] = shift;
        shifts
    }

    /// Stores the pressure at a position, and determines from it which body carries the load.
    fn arrive(&mut self, at: &Position, pressure: &Field) {
        if let Some((from, before)) = &self.last {
            let [from, to] = [from.places(), at.places()];
            // Correlation with the last pressure if the load moves with the body.
            let common = |body: usize| {
                let moved = (from[body] - to[body]).round() as isize;
                let columns = pressure.nrows() as isize;
                let product = |(j, row): (usize, ndarray::ArrayView1<f64>)| {
                    let here = (j as isize + moved).rem_euclid(columns.max(1));
                    row.dot(&pressure.row(here as usize))
                };
                before.outer_iter().enumerate().map(product).sum::<f64>()
            };
            let [lower, upper] = [common(0), common(1)];
            self.body = if lower > upper { 0 } else { 1 };
        }
        self.last = Some((*at, pressure.clone()));
    }
}

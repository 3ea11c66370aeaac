//! Viscoelastic bodies in stages, in place, and in passes, in which their memory moves with them.

use crate::error::{Error, Result, check_in};
use crate::grid::{CellValues, Field, Placement};
use crate::motion::body::{Body, State};
use crate::motion::contact::Contact;
use crate::motion::kinematics::{Motion, Strategy};
use crate::motion::pair::Pair;
use crate::motion::pass::{Drag, Pass, Solver, first_guess};
use crate::motion::path::Stroke;
use crate::motion::slip::SlipRegime;
use crate::motion::watch::{OneOfMany, Progress};
use crate::operator::{Boundary, Compliant, Operator, Operators};
use crate::solver::{ContactProblem, Control, Device, Equilibrium, Params, Solution};
use crate::units::{Dimension, Joule, Newton, Pascal, PerPascal, Second, SquareMetre};
use crate::viscoelastic::memory::solve_step;
use crate::viscoelastic::{Creep, CreepMemory, solve_in_time};

/// Returns the memory of a pair at full overlap that has borne no load; `None` if neither body creeps.
pub(super) fn memory(pair: &Pair) -> Option<CreepMemory> {
    pair.creep_together().map(|creep| CreepMemory::new(creep, pair.lower_grid().shape))
}

/// Solves the contact at the end of a step in time of bodies with a composite `modulus`, and advances their
/// `memory`.
pub(super) fn load(
    operator: &mut dyn Operator,
    modulus: Pascal,
    memory: &mut CreepMemory,
    problem: &ContactProblem<'_>,
    duration: Second,
) -> Result<Equilibrium> {
    let ContactProblem { gap, loading, before, params, watch, .. } = *problem;
    let start = before.map(|before| &before.normal().pressure);
    solve_in_time(operator, modulus, memory, gap, loading.normal, duration, start, params, watch)
        .map(|solution| Equilibrium::Frictionless(Box::new(solution)))
}

/// Solves the contact at the end of a step in time of bodies with a composite `modulus` and this `memory`,
/// which lose height in it by the compliance of the problem. Returns it with the displacement by which the
/// memory advances.
pub(super) fn load_removing(
    operator: &mut dyn Operator,
    modulus: Pascal,
    memory: &CreepMemory,
    problem: &ContactProblem<'_>,
    duration: Second,
) -> Result<(Solution, Field)> {
    let ContactProblem { gap, loading, guess, compliance: removal, params, watch, .. } = *problem;
    let (creep, history) = (memory.compliance(duration), memory.history(duration));
    let start = guess.and_then(|guess| guess.pressure());
    // A step is solved as an elastic contact, whose pressures are these times its compliance over that of the
    // bodies.
    let depth =
        removal.map_or(CellValues::Uniform(0.0), |removal| removal.map(|depth| depth / (creep * modulus)));
    let mut operator = Compliant::new(operator, depth.clone())?;
    let (solution, mut elastic) =
        solve_step(&mut operator, modulus, (creep, &history), gap, loading.normal, start, params, watch)?;
    let pressures = solution.pressure.iter().enumerate();
    elastic
        .iter_mut()
        .zip(pressures)
        .for_each(|(elastic, (cell, p))| *elastic -= depth.value(cell) * modulus * p);
    Ok((solution, elastic))
}

/// Checks what viscoelastic bodies need to slide in place.
pub(super) fn check_in_place(pair: &Pair, regime: SlipRegime, has_speed: bool, device: Device) -> Result<()> {
    pair.check_memory()?;
    let Some([lower, _]) = pair.creep() else { return Ok(()) };
    device.only_processor("a device does not solve contacts of viscoelastic bodies")?;
    let refused = if !lower.terms.is_empty() {
        "the contact moves over the lower body of sliding in place: a viscoelastic body must be the upper one"
    } else if !has_speed {
        "viscoelastic bodies need the speed of their motion"
    } else if regime.displaces_normally(pair) {
        "viscoelastic bodies are not solved together with shear that displaces them normally"
    } else {
        return Ok(());
    };
    Err(Error::Unsupported(refused))
}

/// Checks what viscoelastic bodies need to pass over each other.
pub(super) fn check(pair: &Pair, boundary: Boundary, motion: &Motion, params: &Params) -> Result<()> {
    pair.check_memory()?;
    if !pair.relaxes() {
        return Ok(());
    }
    params.device.only_processor("a device does not solve contacts of viscoelastic bodies")?;
    let refused = if !motion.sliding_speed().is_finite() {
        "viscoelastic bodies need the speed of their motion"
    } else if motion.strategy != Strategy::Overlap && !boundary.repeats(0) {
        "a viscoelastic body in a shift needs a boundary that is periodic along x"
    } else if motion.slip(Stroke::Forth).displaces_normally(pair) {
        "viscoelastic bodies are not solved together with shear that displaces them normally"
    } else {
        let is_time = motion.pause >= 0.0 && motion.pause.is_finite();
        return check_in(Dimension::Time, "pause", motion.pause, is_time, "a finite time of at least 0");
    };
    Err(Error::Unsupported(refused))
}

/// Name of the field of a memory with the displacement of an elastic half-space of a unit modulus.
pub(super) const ELASTIC: &str = "crept_elastic";
/// Unit of the fields of a memory.
pub(super) const UNIT: &str = "Pa m";

/// Name of the field of a memory of a retardation time, from 0.
fn crept(term: usize) -> String {
    format!("crept_{}", term + 1)
}

/// The fields of a memory, with their names in files.
pub(super) fn named(memory: &CreepMemory) -> impl Iterator<Item = (String, &Field)> {
    let delayed = memory.delayed().iter().enumerate().map(|(term, values)| (crept(term), values));
    std::iter::once((ELASTIC.to_owned(), memory.elastic())).chain(delayed)
}

/// Restores a memory from its fields by their names.
pub(super) fn restored<E>(
    creep: Creep,
    field: impl Fn(&str) -> std::result::Result<Field, E>,
) -> std::result::Result<CreepMemory, E> {
    let delayed =
        (0..creep.terms.len()).map(|term| field(&crept(term))).collect::<std::result::Result<_, _>>()?;
    Ok(CreepMemory::restored(creep, delayed, field(ELASTIC)?))
}

/// A viscoelastic body in a pass, on its own cells.
struct Remembering {
    memory: CreepMemory,
    /// The elastic half-space with the composite modulus of the pair.
    operator: Box<dyn Operator>,
    /// Displacement at the end of the present step by the loads before it.
    history: Field,
    /// Displacement of the body at the last position.
    displacement: Field,
    /// Pressure at the last position.
    pressure: Field,
}

impl Remembering {
    /// Returns the body as a pass finds it, with the memory in its state.
    fn of(creep: &Creep, body: &Body, operators: &Operators) -> Self {
        let shape = [body.columns(), body.width()];
        let kept = |name: &str| body.state.get(name).map(|state| state.values.clone()).ok_or(());
        let memory =
            restored(creep.clone(), kept).unwrap_or_else(|()| CreepMemory::new(creep.clone(), shape));
        let nothing = Field::zeros(shape);
        let [history, displacement] = [nothing.clone(), nothing.clone()];
        Self { memory, operator: operators.on(shape), history, displacement, pressure: nothing }
    }

    /// Keeps the memory in the state of the `body`.
    fn keep(&self, body: &mut Body) {
        for (name, values) in named(&self.memory) {
            body.state.insert(name, State { unit: UNIT.to_owned(), values: values.clone() });
        }
    }

    /// Advances to the end of a step, with its pressure and the displacement Lp of the contact. Returns the
    /// work on the body per area of a cell, by the trapezoidal rule.
    fn advance(
        &mut self,
        placement: &Placement,
        pressure: &Field,
        elastic: &Field,
        duration: Second,
        modulus: Pascal,
    ) -> f64 {
        let pressure = placement.onto(pressure);
        let elastic = if elastic.dim() == pressure.dim() {
            placement.onto(elastic)
        } else {
            let mut displaced = Field::zeros(pressure.raw_dim());
            self.operator.apply(&pressure, &mut displaced);
            displaced * modulus
        };
        let displacement = &self.history + &(self.memory.compliance(duration) * &elastic);
        self.memory.advance(elastic, duration);
        let pressures = pressure.iter().zip(&self.pressure).map(|(now, before)| 0.5 * (now + before));
        let moved = displacement.iter().zip(&self.displacement).map(|(now, before)| now - before);
        let work = pressures.zip(moved).map(|(pressure, moved)| pressure * moved).sum();
        (self.displacement, self.pressure) = (displacement, pressure);
        work
    }
}

/// The two bodies of a pass.
struct Creeping {
    /// The viscoelastic ones, lower one first.
    bodies: [Option<Remembering>; 2],
    /// Compliance of the other one; 0 if there is none.
    elastic: PerPascal,
    area: SquareMetre,
    modulus: Pascal,
    /// Energy stored in the elastic body at the last position.
    stored: Joule,
}

impl Creeping {
    fn new(pair: &Pair, operators: &Operators) -> Self {
        let creeps = pair.creep().expect("a viscoelastic body");
        let of = |creep: &Creep, body: &Body| {
            (!creep.terms.is_empty()).then(|| Remembering::of(creep, body, operators))
        };
        let elastic = creeps.iter().filter(|creep| creep.terms.is_empty()).map(|creep| creep.glassy).sum();
        let bodies = [of(&creeps[0], &pair.lower), of(&creeps[1], &pair.upper)];
        Self { bodies, elastic, area: pair.cell_area(), modulus: pair.modulus(), stored: 0.0 }
    }

    fn remembering(&mut self) -> impl Iterator<Item = &mut Remembering> {
        self.bodies.iter_mut().flatten()
    }

    /// Begins a pass: from the `last` contact of the pass before, or after the bodies have been apart for a
    /// time.
    fn begin(&mut self, pair: &Pair, last: Option<&Contact>, apart: Option<Second>) {
        if let Some(apart) = apart {
            self.remembering().for_each(|body| body.memory.recover(apart));
        }
        let placements = last.map(|last| pair.placements(&last.position));
        let pressure = last.map(|last| last.pressure_field(pair.lower.width()));
        for (index, body) in self.bodies.iter_mut().enumerate() {
            let Some(body) = body else { continue };
            body.displacement = body.memory.displacement();
            if let (Some(placements), Some(pressure)) = (&placements, &pressure) {
                body.pressure = placements[index].onto(pressure);
            }
        }
        self.stored = self.stored_now();
    }

    /// Energy of the elastic body.
    fn stored_now(&self) -> Joule {
        // It is the same on the cells of either body.
        let body = self.bodies.iter().flatten().next().expect("a viscoelastic body");
        let energy = body.pressure.iter().zip(body.memory.elastic()).map(|(p, elastic)| p * elastic);
        0.5 * self.elastic * self.area * energy.sum::<f64>()
    }

    /// Compliance of both bodies together in a step of this time.
    fn compliance(&self, duration: Second) -> PerPascal {
        let bodies = self.bodies.iter().flatten();
        self.elastic + bodies.map(|body| body.memory.compliance(duration)).sum::<f64>()
    }

    /// Displacement of the cells of the contact by earlier loads at the end of a step of this time.
    fn history(&mut self, placements: &[Placement; 2], columns: usize, duration: Second) -> Field {
        let of = |(body, placement): (&mut Option<Remembering>, &Placement)| {
            let body = body.as_mut()?;
            body.history = body.memory.history(duration);
            Some(placement.under(&body.history, columns))
        };
        let histories = self.bodies.iter_mut().zip(placements).filter_map(of);
        histories.reduce(|sum, history| sum + history).expect("a viscoelastic body")
    }

    /// Advances both bodies to the end of a step. Returns the work on them.
    fn advance(
        &mut self,
        placements: &[Placement; 2],
        pressure: &Field,
        elastic: &Field,
        duration: Second,
    ) -> Joule {
        let mut work = 0.0;
        for (body, placement) in self.bodies.iter_mut().zip(placements) {
            let Some(body) = body else { continue };
            work += self.area * body.advance(placement, pressure, elastic, duration, self.modulus);
        }
        let now = self.stored_now();
        work + now - std::mem::replace(&mut self.stored, now)
    }
}

impl Solver<'_> {
    /// Solves all positions of a pass of viscoelastic bodies, one after another, each a step of the same
    /// time. The starts are those of [`Solver::solve`], or the contact at the position before.
    pub(super) fn solve_creeping(
        &self,
        pair: &Pair,
        control: Control,
        params: &Params,
        earlier: &[Vec<Contact>],
    ) -> Result<Pass> {
        let (pitch, columns) = (pair.pitch()[0], pair.lower.columns());
        let width = pair.lower.width();
        let rougher = usize::from(pair.lower.heights.std(0.0) < pair.upper.heights.std(0.0));
        let mut bodies = Creeping::new(pair, self.operators);
        bodies.begin(pair, self.last.as_ref(), self.motion.apart());
        // Such bodies come from apart and go apart without being pressed together.
        let passes_by = self.motion.strategy == Strategy::Overlap && matches!(control, Control::Approach(_));
        let mut contacts: Vec<Contact> = Vec::with_capacity(self.positions.len());
        let mut drags: Vec<Newton> = Vec::with_capacity(self.positions.len());
        for (index, position) in self.positions.iter().enumerate() {
            if self.watch.stop() {
                return Err(Error::Interrupted);
            }
            let cells = self.motion.cells_to_position(index, columns);
            let duration = self.motion.time_of(cells, pitch);
            let distance = self.motion.sliding_distance_of(cells, pitch);
            let placements = pair.placements(position);
            let last = contacts.last().or(self.last.as_ref());
            let start = first_guess(earlier, index, control, width).or_else(|| {
                let last = last?;
                let pressure = pair.placements(&last.position)[rougher].onto(&last.pressure_field(width));
                Some(placements[rougher].under(&pressure, position.columns))
            });
            let history = bodies.history(&placements, position.columns, duration);
            let mut operator = self.operators.on([position.columns, width]);
            let (solution, elastic) = solve_step(
                operator.as_mut(),
                pair.modulus(),
                (bodies.compliance(duration), &history),
                &pair.initial_gap(position),
                control,
                start.as_ref(),
                params,
                &OneOfMany(self.watch),
            )
            .map_err(|error| self.at_position(index, error))?;
            let mut contact = self.contact(index, &solution);
            if let Some(latest) = earlier.first() {
                contact.stats.convolutions += latest[index].stats.convolutions;
            }
            let work = bodies.advance(&placements, &solution.pressure, &elastic, duration);
            let pressing = match last {
                Some(last) => 0.5 * (last.load + contact.load) * (contact.approach - last.approach),
                None if passes_by => 0.0,
                None => f64::NAN,
            };
            drags.push(if distance > 0.0 { (work - pressing) / distance } else { 0.0 });
            let load = contact.load;
            contacts.push(contact);
            self.watch.position(&Progress { solved: index + 1, load, ..self.progress });
        }
        // Bodies that have passed come apart in the step after the last position.
        let mut leaving = 0.0;
        let cells: Vec<f64> =
            (0..self.positions.len()).map(|index| self.motion.cells_to_position(index, columns)).collect();
        if let (Strategy::Overlap, Some(last)) = (self.motion.strategy, contacts.last()) {
            let step = cells[cells.len() - 1];
            let (duration, distance) =
                (self.motion.time_of(step, pitch), self.motion.sliding_distance_of(step, pitch));
            let placements = pair.placements(&last.position);
            let nothing = Field::zeros([last.position.columns, width]);
            bodies.history(&placements, last.position.columns, duration);
            let work = bodies.advance(&placements, &nothing, &nothing, duration);
            if passes_by {
                leaving = work / distance * step;
            }
        }
        let mut after = pair.clone();
        for (remembering, body) in bodies.bodies.iter().zip([&mut after.lower, &mut after.upper]) {
            if let Some(remembering) = remembering {
                remembering.keep(body);
            }
        }
        let drag = Some(Drag { positions: drags, cells, leaving });
        Ok(Pass { drag, ..Pass::new(contacts, after, self.laws) })
    }
}

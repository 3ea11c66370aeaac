//! States of static courses: everything that the next step depends on.

use std::borrow::Cow;

use crate::error::Result;
use crate::grid::{CellValues, Field};
use crate::lubrication::Film;
use crate::motion::creeping;
use crate::motion::cycle_heat::CycleHeat;
use crate::motion::extrapolation::LastExtrapolation;
use crate::motion::fretting::{ChangedBodies, LastCycle};
use crate::motion::pair::Pair;
use crate::motion::plastic_volume::PlasticResult;
use crate::motion::record::{HEIGHT_ERROR, IncrementRecord, StaticRecord, UpdateRecord};
use crate::motion::stage::{Origin, Progress};
use crate::motion::store::{
    CourseState, StateReader, StateWriter, restore_both, restore_if, restore_sums, store_both, store_sums,
};
use crate::solver::{Bounds, Equilibrium, FrictionalSolution, Solution, Stats};
use crate::subsurface::Tractions;
use crate::units::{Joule, Metre};
use crate::viscoelastic::{Creep, CreepMemory};

/// A static contact at the end of its loading, with its history.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct LoadedContact {
    /// The record of the contact at the end of its loading.
    pub record: StaticRecord,
    /// The increments of the loading; empty for a rolling contact.
    pub increments: Vec<IncrementRecord>,
    /// The solution at the end of the loading.
    pub solution: Equilibrium,
    /// Plastic interference of both bodies together, m.
    pub plastic: Field,
    /// Sum of the slip of all increments along x and y, m; in rolling, the slip while the contact moves on by
    /// a cell; `None` without friction.
    pub slip: Option<[Field; 2]>,
    /// Bound on the error of the frictional energy in the record, without the contribution of the first
    /// increment: see
    /// [`FrictionalSolution::dissipation_error`](crate::solver::FrictionalSolution::dissipation_error).
    pub dissipation_error: Joule,
    /// Bodies that laws have changed; `None` if none did.
    pub changed: Option<ChangedBodies>,
    /// Plastic state below the surfaces; `None` for other than elasto-plastic bodies.
    pub plastic_result: Option<PlasticResult>,
    /// The film between lubricated bodies; `None` between others.
    pub film: Option<Film>,
}

/// State of a loading: everything that its next increment depends on.
#[derive(Debug, Clone)]
pub struct LoadingState {
    /// The increments done so far.
    pub increments: Vec<IncrementRecord>,
    /// The contact at the end of the last increment.
    pub contact: Equilibrium,
    /// Load, approach, force and displacement at the beginning of the current stage.
    pub origin: Origin,
    /// The plastic interference of the cells.
    pub flattening: Flattening,
    /// Sum of the slip of all increments along x and y, m; `None` without friction.
    pub slip: Option<[Field; 2]>,
    /// Sum over the increments of
    /// [`FrictionalSolution::dissipation_error`](crate::solver::FrictionalSolution::dissipation_error).
    pub dissipation_error: Joule,
    /// The next increment.
    pub next: Progress,
    /// Bodies that laws have changed; `None` without laws.
    pub changed: Option<ChangedBodies>,
    /// Memory of viscoelastic bodies; `None` for others.
    pub memory: Option<CreepMemory>,
}

/// Plastic interference of the cells of a contact over its loading.
#[derive(Debug, Clone)]
pub struct Flattening {
    /// Permanent plastic flattening, m: both bodies are lowered by it together. `None` before plastic cells
    /// are first unloaded.
    pub kept: Option<Field>,
    /// Largest plastic interference of each cell, m, on the surfaces lowered by `kept`.
    pub deepest: Field,
}

impl Flattening {
    /// Returns the initial gap of the permanently lowered surfaces.
    pub fn open<'a>(&self, gap: &'a Field) -> Cow<'a, Field> {
        match &self.kept {
            None => Cow::Borrowed(gap),
            Some(kept) => Cow::Owned(gap + kept),
        }
    }

    /// Whether the interference of some cell has been larger than `now` by more than `allowed`.
    pub(super) fn exceeds(&self, now: &Field, allowed: Metre) -> bool {
        self.deepest.iter().zip(now).any(|(deepest, now)| deepest - now > allowed)
    }

    /// Lowers the surfaces by the largest interference of each cell.
    pub(super) fn keep(&mut self) {
        let virgin = Field::zeros(self.deepest.raw_dim());
        let deepest = std::mem::replace(&mut self.deepest, virgin);
        self.kept = Some(match self.kept.take() {
            None => deepest,
            Some(kept) => kept + deepest,
        });
    }

    /// Updates the largest interference of each cell with the present contact.
    pub(super) fn deepen(&mut self, now: &Field) {
        self.deepest.zip_mut_with(now, |deepest, now| *deepest = deepest.max(*now));
    }

    /// Returns the total plastic interference, with `now` that of the present contact.
    pub fn total(&self, now: Field) -> Field {
        match &self.kept {
            None => now,
            Some(kept) => kept + &now,
        }
    }
}

/// State of a contact after its updates so far: everything that the next one depends on.
#[derive(Debug, Clone)]
pub struct SlidingState {
    /// The bodies in their present state.
    pub pair: Pair,
    /// The updates so far; the first is the contact before sliding.
    pub updates: Vec<UpdateRecord>,
    /// Pressure of the last update, Pa.
    pub pressure: Field,
    /// The last contact of bodies that attract each other, from which they come to the next one; `None`
    /// between hard walls.
    pub contact: Option<Solution>,
    /// Memory of viscoelastic bodies; `None` for others.
    pub memory: Option<CreepMemory>,
}

impl CourseState for LoadingState {
    fn store(&self, to: &mut dyn StateWriter) {
        let normal = self.contact.normal();
        to.field("pressure", "Pa", &normal.pressure);
        to.field("displacement", "m", &normal.displacement);
        to.field("deepest", "m", &self.flattening.deepest);
        if let CellValues::Field(lower) = normal.bounds.lower() {
            to.field("least_pressure", "Pa", lower);
        }
        if let Some(kept) = &self.flattening.kept {
            to.field("kept", "m", kept);
        }
        if let Some(slip) = &self.slip {
            store_both(to, "slip", "m", slip);
        }
        if let Some(solution) = self.contact.frictional() {
            store_both(to, "traction", "Pa", &solution.shear);
            store_both(to, "displacement", "m", &solution.displacement);
            store_both(to, "last_slip", "m", &solution.slip);
            if let CellValues::Field(cap) = normal.bounds.upper() {
                to.field("cap", "Pa", cap);
            }
            to.field("shear_limit", "Pa", &solution.shear_limit);
            to.field("stick", "1", &solution.stick);
            to.vector("rigid_displacement", solution.rigid_displacement);
        }
        if let Some(changed) = &self.changed {
            changed.store(to);
        }
        store_memory(to, self.memory.as_ref());
        let Progress { stage, cycles, step } = self.next;
        to.count("next_stage", stage);
        to.count("next_cycles", cycles);
        to.count("next_step", step);
        to.number("approach", normal.approach);
        to.number("residual", normal.residual);
        to.count("iterations", normal.stats.iterations);
        to.number("convolutions", normal.stats.convolutions);
        to.count("restarts", normal.stats.restarts);
        to.number("dissipation_error", self.dissipation_error);
        let Origin { load, approach, force, displacement } = self.origin;
        to.number("origin_load", load);
        to.number("origin_approach", approach);
        to.vector("origin_force", force);
        to.vector("origin_displacement", displacement);
    }
}

/// Stores the memory of viscoelastic bodies, if there is one.
fn store_memory(to: &mut dyn StateWriter, memory: Option<&CreepMemory>) {
    let fields = memory.into_iter().flat_map(creeping::named);
    fields.for_each(|(name, values)| to.field(&name, creeping::UNIT, values));
}

/// Restores the contact of a `pair`, without its residual and its cost.
fn restored_contact(from: &dyn StateReader, pair: &Pair) -> Result<Solution> {
    let bounds = match restore_if(from, "cap", || from.field("cap"))? {
        Some(cap) => Bounds::up_to(cap),
        None => pair.bounds(&pair.at_rest()),
    };
    let bounds = match restore_if(from, "least_pressure", || from.field("least_pressure"))? {
        Some(least) => bounds.above(least),
        None => bounds,
    };
    Ok(Solution {
        grid: pair.lower_grid(),
        initial_gap: pair.initial_gap(&pair.at_rest()),
        bounds,
        pressure: from.field("pressure")?,
        displacement: from.field("displacement")?,
        approach: from.number("approach")?,
        residual: f64::NAN,
        stats: Stats::default(),
    })
}

/// Restores the memory of the bodies of a `pair`, if there is one.
fn restored_memory(from: &dyn StateReader, pair: &Pair) -> Result<Option<CreepMemory>> {
    restore_if(from, creeping::ELASTIC, || {
        let creep = pair.creep_together().unwrap_or(Creep::elastic(0.0));
        creeping::restored(creep, |name| from.field(name))
    })
}

impl LoadingState {
    /// Restores the state of a loading of a `pair` after these `increments`.
    ///
    /// # Errors
    /// The errors of the reader.
    pub fn restore(from: &dyn StateReader, pair: &Pair, increments: Vec<IncrementRecord>) -> Result<Self> {
        let changed = restore_if(from, "cycles_done", || ChangedBodies::restore(from, pair))?;
        let pair = changed.as_ref().map_or(pair, |changed| &changed.pair);
        let kept = restore_if(from, "kept", || from.field("kept"))?;
        let flattening = Flattening { kept, deepest: from.field("deepest")? };
        let gap = pair.initial_gap(&pair.at_rest());
        let normal = Solution {
            initial_gap: flattening.open(&gap).into_owned(),
            residual: from.number("residual")?,
            stats: Stats {
                iterations: from.number("iterations")? as usize,
                convolutions: from.number("convolutions")?,
                restarts: from.number("restarts")? as usize,
                ..Stats::default()
            },
            ..restored_contact(from, pair)?
        };
        let memory = restored_memory(from, pair)?;
        let has_friction = from.holds("stick");
        let contact = if has_friction {
            Equilibrium::Frictional(Box::new(FrictionalSolution {
                normal,
                shear: restore_both(from, "traction")?,
                shear_limit: from.field("shear_limit")?,
                displacement: restore_both(from, "displacement")?,
                rigid_displacement: from.vector("rigid_displacement")?,
                slip: restore_both(from, "last_slip")?,
                stick: from.field("stick")?,
            }))
        } else {
            Equilibrium::Frictionless(Box::new(normal))
        };
        Ok(Self {
            increments,
            contact,
            origin: Origin {
                load: from.number("origin_load")?,
                approach: from.number("origin_approach")?,
                force: from.vector("origin_force")?,
                displacement: from.vector("origin_displacement")?,
            },
            flattening,
            slip: has_friction.then(|| restore_both(from, "slip")).transpose()?,
            dissipation_error: from.number("dissipation_error")?,
            next: Progress {
                stage: from.number("next_stage")? as usize,
                cycles: from.number("next_cycles")? as usize,
                step: from.number("next_step")? as usize,
            },
            memory,
            changed,
        })
    }
}

impl ChangedBodies {
    /// Keeps the bodies and the present cycle.
    fn store(&self, to: &mut dyn StateWriter) {
        let Self { pair, sums, last, work, cycle_work, error, cycles, computed, contacts, heat } = self;
        to.bodies(pair);
        if let Some(CycleHeat { taken, temperature, power }) = heat {
            to.field("cycle_heat", "J/m²", taken);
            to.field("cycle_temperature", "K", temperature);
            to.number("cycle_power", *power);
        }
        store_sums(to, "cycle", sums);
        if let Some(LastCycle { extrapolation, pressure, work }) = last {
            to.count("jump", extrapolation.passes);
            to.number("last_work", *work);
            to.field("cycle_pressure", "Pa", pressure);
            store_sums(to, "sum", &extrapolation.sums);
        }
        to.number("friction_work", *work);
        to.number("cycle_work", *cycle_work);
        to.number(HEIGHT_ERROR, *error);
        to.count("cycles_done", *cycles);
        to.count("cycles_computed", *computed);
        for (Tractions { pressure, shear }, index) in contacts.iter().zip(1..) {
            to.field(&format!("contact_{index}"), "Pa", pressure);
            if let [Some(x), Some(y)] = shear {
                to.field(&format!("contact_{index}_x"), "Pa", x);
                to.field(&format!("contact_{index}_y"), "Pa", y);
            }
        }
    }

    /// Restores the bodies of a `pair`, whose hardness they have, without their films.
    fn restore(from: &dyn StateReader, pair: &Pair) -> Result<Self> {
        let mut pair = pair.clone();
        from.bodies(&mut pair)?;
        let last = restore_if(from, "jump", || {
            let passes = from.number("jump")? as usize;
            Ok(LastCycle {
                extrapolation: LastExtrapolation { passes, sums: restore_sums(from, "sum")? },
                pressure: from.field("cycle_pressure")?,
                work: from.number("last_work")?,
            })
        })?;
        let heat = restore_if(from, "cycle_heat", || {
            let [taken, temperature] = [from.field("cycle_heat")?, from.field("cycle_temperature")?];
            Ok(CycleHeat { taken, temperature, power: from.number("cycle_power")? })
        })?;
        let contacts = (1..).map(|index| format!("contact_{index}"));
        let tractions = |name: String| {
            let shear =
                |axis| restore_if(from, &format!("{name}_{axis}"), || from.field(&format!("{name}_{axis}")));
            Ok(Tractions { shear: [shear("x")?, shear("y")?], pressure: from.field(&name)? })
        };
        Ok(Self {
            pair,
            heat,
            sums: restore_sums(from, "cycle")?,
            last,
            work: from.number("friction_work")?,
            cycle_work: from.number("cycle_work")?,
            error: from.number(HEIGHT_ERROR)?,
            cycles: from.number("cycles_done")? as usize,
            computed: restore_if(from, "cycles_computed", || from.number("cycles_computed"))?
                .unwrap_or_default() as usize,
            contacts: contacts.take_while(|name| from.holds(name)).map(tractions).collect::<Result<_>>()?,
        })
    }
}

impl CourseState for SlidingState {
    fn store(&self, to: &mut dyn StateWriter) {
        to.bodies(&self.pair);
        to.field("pressure", "Pa", &self.pressure);
        if let Some(contact) = &self.contact {
            to.field("displacement", "m", &contact.displacement);
            to.number("approach", contact.approach);
            if let CellValues::Field(lower) = contact.bounds.lower() {
                to.field("least_pressure", "Pa", lower);
            }
        }
        store_memory(to, self.memory.as_ref());
    }
}

impl SlidingState {
    /// Restores the state of a contact of a `pair` after these `updates`. The bodies have the hardness of the
    /// `pair`, without their films.
    ///
    /// # Errors
    /// The errors of the reader.
    pub fn restore(from: &dyn StateReader, pair: &Pair, updates: Vec<UpdateRecord>) -> Result<Self> {
        let mut pair = pair.clone();
        from.bodies(&mut pair)?;
        let pressure = from.field("pressure")?;
        let contact = restore_if(from, "displacement", || restored_contact(from, &pair))?;
        let memory = restored_memory(from, &pair)?;
        Ok(Self { pair, updates, pressure, contact, memory })
    }
}

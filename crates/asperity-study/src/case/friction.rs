//! `[friction]` and `[[history]]`: friction, and the loading history of a static contact.

use serde::{Serialize, Serializer};

use super::cursor::{Entry, Table};
use super::prescribed::{Prescribed, of_stage};
use super::schema::loading::{friction as keys, history};
use super::schema::tables::known_in;
use super::{Case, Number};
use asperity_base::error::Result;
use asperity_base::units::{Second, SquareMetre};
use asperity_contact::motion::{Cycles, Point, Stage, StageTime};
use asperity_contact::solver::{Coupling, Creep, Friction, Loading, Rolling, Tangential};

/// Friction, and the tangential loading.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct FrictionSpec {
    /// The law.
    #[serde(flatten, serialize_with = "with_infinities")]
    pub law: Friction,
    /// Prescribed tangential loading of a static contact; no force if neither it nor `creepages` is given.
    #[serde(flatten)]
    pub prescribed: Option<InPlane>,
    /// Creepages of a rolling contact in a sweep, each on virgin bodies; empty without a sweep.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub creepages: Vec<[f64; 2]>,
    /// Spin of a rolling contact, 1/m; 0 for any other contact.
    #[serde(skip_serializing_if = "is_zero")]
    pub spin: f64,
    /// Number of equal loading steps of a static contact, ≥ 1; 1 for a rolling contact and a motion.
    #[serde(skip_serializing_if = "is_one")]
    pub increments: usize,
}

/// Prescribed tangential loading, along x and y.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum InPlane {
    /// Force of the upper body on the lower one.
    Force([f64; 2]),
    /// Displacement of the upper body relative to the lower one.
    Displacement([f64; 2]),
    /// Sliding of the upper body in this direction, a unit vector.
    Sliding([f64; 2]),
    /// Rolling along x, with the velocity of the upper body relative to the lower one over the rolling velocity.
    Creepage([f64; 2]),
    /// Rolling along x, with the force of the upper body on the lower one.
    RollingForce([f64; 2]),
}

/// A further stage of the loading. Quantities not given stay as they are.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct StageSpec {
    /// Prescribed load, mean pressure or approach.
    #[serde(flatten)]
    pub normal: Option<Prescribed>,
    /// Prescribed tangential loading: force, displacement or sliding.
    #[serde(flatten)]
    pub in_plane: Option<InPlane>,
    /// Number of equal steps, ≥ 1; in a cycle of each way.
    pub increments: usize,
    /// Number of cycles, in each of which the loading goes there and comes back, ≥ 1; `None` if it goes there once.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cycles: Option<usize>,
    /// Time of a cycle, > 0; unknown if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub period: Option<Second>,
    /// Time in which the loading goes there, > 0; at once if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub duration: Option<Second>,
    /// Time for which the loading then stays, > 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dwell: Option<Second>,
}

/// Loading path of a static contact: the sequence of prescribed states.
#[derive(Debug, Clone, PartialEq)]
pub enum LoadingPath {
    /// Loading stage after stage.
    Stages(Vec<Stage>),
    /// One contact in steady rolling.
    Rolling(Rolling),
    /// Load sweep, each load on virgin bodies.
    Sweep(Vec<Point>),
}

impl FrictionSpec {
    /// Whether the contact is rolling.
    pub(super) fn rolls(&self) -> bool {
        self.rolling().next().is_some()
    }

    /// Whether any shear causes slip.
    pub(super) fn slips(&self) -> bool {
        self.law.shear_limit(1.0).is_finite()
    }

    /// Returns the rolling states: one for each of `creepages`, or a single one.
    fn rolling(&self) -> impl Iterator<Item = Rolling> + '_ {
        let one = self.prescribed.and_then(InPlane::creep);
        let creeps = self.creepages.iter().copied().map(Creep::Creepage).chain(one);
        creeps.map(|creep| Rolling { creep, spin: self.spin })
    }
}

impl LoadingPath {
    /// Returns the states of steady rolling.
    pub fn rolling(&self) -> impl Iterator<Item = Rolling> + '_ {
        let (one, points) = match self {
            Self::Stages(_) => (None, &[][..]),
            Self::Rolling(rolling) => (Some(*rolling), &[][..]),
            Self::Sweep(points) => (None, points.as_slice()),
        };
        one.into_iter().chain(points.iter().filter_map(|point| point.rolling))
    }
}

impl Case {
    /// Returns the loading path of a static contact on this apparent area: `[contact]`, then each `[[history]]`; `None`
    /// with a `[motion]` or `[sliding]`.
    ///
    /// Without friction the first stage is a single increment, except for elasto-plastic bodies. The first loading of a
    /// contact does not depend on its steps.
    pub fn loading_path(&self, apparent_area: SquareMetre) -> Option<LoadingPath> {
        if self.motion.is_some() || self.sliding.is_some() {
            return None;
        }
        let friction = self.friction.as_ref();
        let mut rolling = friction.into_iter().flat_map(FrictionSpec::rolling);
        let normal = self.contact.prescribed.control(apparent_area);
        if friction.is_some_and(|friction| !friction.creepages.is_empty()) {
            let point = |rolling| Point { control: normal, rolling: Some(rolling), speed: None };
            return Some(LoadingPath::Sweep(rolling.map(point).collect()));
        }
        if let Some(steady) = &self.steady {
            let point = |speed| Point { control: normal, rolling: None, speed: Some(speed) };
            return Some(LoadingPath::Sweep(steady.all().into_iter().map(point).collect()));
        }
        let rolling = rolling.next();
        if !self.contact.sweep.is_empty() {
            let point = |prescribed: &Prescribed| Point {
                control: prescribed.control(apparent_area),
                rolling,
                speed: None,
            };
            return Some(LoadingPath::Sweep(self.contact.sweep.iter().map(point).collect()));
        }
        if let Some(rolling) = rolling {
            return Some(LoadingPath::Rolling(rolling));
        }
        let tangential = friction.and_then(|friction| friction.prescribed).and_then(InPlane::tangential);
        let mut loading = Loading { normal, tangential: tangential.unwrap_or(Tangential::Force([0.0; 2])) };
        let flowing = self.plasticity.and_then(|plasticity| plasticity.increments).unwrap_or(1);
        let increments = friction.map_or(flowing, |friction| friction.increments);
        let mut stages = vec![Stage::new(loading, increments)];
        for stage in &self.history {
            if let Some(normal) = stage.normal {
                loading.normal = normal.control(apparent_area);
            }
            if let Some(tangential) = stage.in_plane.and_then(InPlane::tangential) {
                loading.tangential = tangential;
            }
            let cycles = stage.cycles.map(|count| Cycles { count, period: stage.period });
            let time = stage.duration.map_or(StageTime::Sudden, StageTime::Even);
            // A stage that only dwells goes nowhere.
            if stage.normal.is_some() || stage.in_plane.is_some() {
                // Steps that take no time change a viscoelastic contact at once.
                let increments =
                    if stage.dwell.is_some() && stage.duration.is_none() { 1 } else { stage.increments };
                stages.push(Stage::new(loading, increments).with_cycles(cycles).within(time));
            }
            stages.extend(
                stage
                    .dwell
                    .map(|time| Stage::new(loading, stage.increments).within(StageTime::Growing(time))),
            );
        }
        Some(LoadingPath::Stages(stages))
    }

    /// Whether the contact is solved at several points, one after another.
    pub fn is_swept(&self) -> bool {
        matches!(self.loading_path(1.0), Some(LoadingPath::Sweep(_)))
    }
}

impl InPlane {
    /// Returns the tangential loading of bodies that do not roll.
    fn tangential(self) -> Option<Tangential> {
        match self {
            Self::Force(force) => Some(Tangential::Force(force)),
            Self::Displacement(shift) => Some(Tangential::Displacement(shift)),
            Self::Sliding(direction) => Some(Tangential::Sliding(direction)),
            Self::Creepage(_) | Self::RollingForce(_) => None,
        }
    }

    /// Returns the tangential loading of rolling bodies.
    fn creep(self) -> Option<Creep> {
        match self {
            Self::Creepage(creepage) => Some(Creep::Creepage(creepage)),
            Self::RollingForce(force) => Some(Creep::Force(force)),
            Self::Force(_) | Self::Displacement(_) | Self::Sliding(_) => None,
        }
    }
}

/// Keys of the tangential loading of a static contact.
pub(super) const IN_PLANE: [&str; 6] =
    ["force", "displacement", "sliding", "creepage", "creepages", "rolling_force"];
/// Keys that a stage may change: normal, then tangential.
const STAGE: [&str; 6] = ["load", "mean_pressure", "approach", "force", "displacement", "sliding"];
/// Default number of steps in a time, with which pressures are within some per cent.
const STEPS_IN_TIME: usize = 16;

pub(super) fn friction(table: &Table<'_>) -> Result<FrictionSpec> {
    known_in(table)?;
    at_most_one(table, &IN_PLANE)?;
    Ok(FrictionSpec {
        law: Friction {
            coefficient: keys::COEFFICIENT.of(table)?,
            shear_strength: keys::SHEAR_STRENGTH.of(table)?,
            junction_growth: keys::JUNCTION_GROWTH.of(table)?,
            coupling: keys::COUPLING.of(table)?,
        },
        prescribed: in_plane(table)?,
        creepages: keys::CREEPAGES.of(table)?.unwrap_or_default(),
        spin: keys::SPIN.of(table)?,
        increments: keys::INCREMENTS.of(table)?,
    })
}

/// Returns the stages after the first; by default each that takes no time has `steps` steps.
pub(super) fn stages(
    entry: &Entry<'_>,
    friction: Option<&FrictionSpec>,
    steps: usize,
) -> Result<Vec<StageSpec>> {
    let (normal, plane) = STAGE.split_at(3);
    let stage = |table: &Table<'_>| {
        known_in(table)?;
        let gives = |keys: &[&str]| keys.iter().any(|key| table.get(key).is_some());
        if !gives(&STAGE) && !gives(&["dwell"]) {
            let keys = if friction.is_some() { "'load', 'force' or another" } else { "'load' or another" };
            let hint = match gives(&["duration"]) {
                true => format!(
                    "give {keys}, to which it goes in the `duration`; a `dwell` is the time for which it stays"
                ),
                false => format!("give {keys}; what a stage does not name stays"),
            };
            return Err(table.error("[[history]] names nothing that changes".to_owned(), Some(hint)));
        }
        at_most_one(table, plane)?;
        let default = if gives(&["duration", "dwell"]) { STEPS_IN_TIME } else { steps };
        Ok(StageSpec {
            normal: gives(normal).then(|| of_stage(table)).transpose()?,
            in_plane: in_plane(table)?,
            increments: history::INCREMENTS.of(table)?.unwrap_or(default),
            cycles: history::CYCLES.of(table)?,
            period: history::PERIOD.of(table)?,
            duration: history::DURATION.of(table)?,
            dwell: history::DWELL.of(table)?,
        })
    };
    entry.tables()?.iter().map(stage).collect()
}

/// Returns an error if more than one of `keys` is given.
fn at_most_one(table: &Table<'_>, keys: &[&'static str]) -> Result<()> {
    match keys.iter().any(|key| table.get(key).is_some()) {
        true => table.exactly_one(keys, "give one of them, or none").map(|_| ()),
        false => Ok(()),
    }
}

/// Reads the tangential loading of [friction] or of a stage, at most one key of which is given.
fn in_plane(table: &Table<'_>) -> Result<Option<InPlane>> {
    let force = keys::FORCE.of(table)?.map(InPlane::Force);
    let displacement = keys::DISPLACEMENT.of(table)?.map(InPlane::Displacement);
    let sliding = keys::SLIDING.of(table)?.map(InPlane::Sliding);
    let creepage = keys::CREEPAGE.of(table)?.map(InPlane::Creepage);
    let rolling_force = keys::ROLLING_FORCE.of(table)?.map(InPlane::RollingForce);
    Ok(force.or(displacement).or(sliding).or(creepage).or(rolling_force))
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

fn is_one(count: &usize) -> bool {
    *count == 1
}

fn with_infinities<S: Serializer>(law: &Friction, serializer: S) -> std::result::Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Keys {
        coefficient: Number,
        shear_strength: Number,
        coupling: Coupling,
        junction_growth: f64,
    }
    let Friction { coefficient, shear_strength, coupling, junction_growth } = *law;
    let (coefficient, shear_strength) = (coefficient.into(), shear_strength.into());
    Keys { coefficient, shear_strength, coupling, junction_growth }.serialize(serializer)
}

//! `[friction]` and `[[history]]`: friction, and the loading history of a static contact.

use serde::Serialize;

use super::Case;
use super::prescribed::Prescribed;
use asperity_base::error::Result;
use asperity_base::exists;
use asperity_base::table::{Bounds, Exists, Key, Kind, Source, Value, at_most_one, two};
use asperity_base::units::{Metre, Newton, Pascal, Second, SquareMetre};
use asperity_contact::motion::{Cycles, Point, Stage, StageTime};
use asperity_contact::solver::{Creep, Friction, Loading, Rolling, Tangential};
use asperity_derive::{Part, Table};

/// Friction, and the tangential loading.
#[derive(Table, Debug, Clone, PartialEq, Serialize)]
#[table("friction")]
#[non_exhaustive]
pub struct FrictionSpec {
    /// The law.
    #[key(part)]
    #[serde(flatten)]
    pub law: Friction,
    /// Prescribed tangential loading of a static contact; no force if absent.
    #[key(part)]
    #[serde(flatten)]
    pub prescribed: Option<InPlane>,
    /// Rolling only, in 1/m: angular velocity of the upper body relative to the lower one, over the rolling velocity, about z through the middle
    /// of the grid, positive from +x towards +y.
    #[key(number = "a number, in 1/m", default = 0.0, written = "0", example = "25")]
    #[serde(skip_serializing_if = "is_zero")]
    pub spin: f64,
    /// Equal steps in which load and tangential load grow from 0.
    ///
    /// 1 for a rolling contact and a motion.
    #[key(count = 1, default = 1, example = "20")]
    #[serde(skip_serializing_if = "is_one")]
    pub increments: usize,
}

/// Prescribed tangential loading, along x and y.
#[derive(Part, Debug, Clone, PartialEq, Serialize)]
#[part(absent = "at most one of the six in the plane", hint = "give one of them, or none")]
#[serde(rename_all = "snake_case")]
pub enum InPlane {
    /// Force of the upper body on the lower one.
    #[key(quantity = Force, vector, absent = "0", example = "\"0.1 N\"", exists = exists::LOAD)]
    Force([Newton; 2]),
    /// Displacement of the upper body relative to the lower one.
    #[key(quantity = Length, vector, example = "\"0.1 um\"", exists = exists::LENGTH)]
    Displacement([Metre; 2]),
    /// Sliding direction of the upper body; every cell slips.
    ///
    /// A unit vector.
    #[key(special = direction, form = "`[x, y]` of any length", example = "[1, 0]")]
    Sliding([f64; 2]),
    /// Steady rolling along x: velocity of the upper body relative to the lower one, over the rolling velocity.
    #[key(number = "a finite number", vector, example = "0.001")]
    Creepage([f64; 2]),
    /// Several creepages, one after the other.
    ///
    /// A sweep, each on virgin bodies.
    #[key(number = "a finite number", vector, several = "[0.001, 0]", spacing = Linear, example = "[0.001]")]
    Creepages(Vec<[f64; 2]>),
    /// Steady rolling along x: force of the upper body on the lower one.
    #[key(quantity = Force, vector, example = "\"0.1 N\"", exists = exists::LOAD)]
    RollingForce([Newton; 2]),
}

/// A direction in the plane, as a unit vector.
fn direction(value: &dyn Value, key: &Key) -> Result<[f64; 2]> {
    const EXPECTED: &str = "a direction such as [1, 0]";
    const COMPONENT: Kind = Kind::Number("a finite number", Bounds::Any);
    let [x, y] = match value.is_array() {
        true => two(value, EXPECTED, |item| item.real(key, &COMPONENT))?,
        false => [value.real(key, &COMPONENT)?, 0.0],
    };
    let length = x.hypot(y);
    if length == 0.0 { Err(value.unexpected(EXPECTED, None)) } else { Ok([x / length, y / length]) }
}

/// A further stage of the loading. Quantities not given stay as they are.
#[derive(Table, Debug, Clone, Copy, PartialEq, Serialize)]
#[table("history", check = at_most_one_of_each)]
#[non_exhaustive]
pub struct StageSpec {
    /// As in \[contact\]; at most one of the three; with \[adhesion\] it may be 0 or pull, below 0.
    #[key(quantity = Force, absent = "unchanged", example = "\"2 N\"", exists = exists::LOAD)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load: Option<Newton>,
    /// As in \[contact\]; at most one of the three; with \[adhesion\] it may be 0 or pull, below 0.
    #[key(quantity = Pressure, absent = "unchanged", example = "\"1 MPa\"", exists = exists::LOAD)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean_pressure: Option<Pascal>,
    /// As in \[contact\]; at most one of the three.
    #[key(quantity = Length, absent = "unchanged", example = "\"10 nm\"", exists = exists::LENGTH)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub approach: Option<Metre>,
    /// As in \[friction\], which it requires; at most one of the three.
    #[key(quantity = Force, vector, absent = "unchanged", example = "\"0.1 N\"", exists = exists::LOAD)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force: Option<[Newton; 2]>,
    /// As in \[friction\], which it requires; at most one of the three.
    #[key(quantity = Length, vector, absent = "unchanged", example = "\"0.1 um\"", exists = exists::LENGTH)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub displacement: Option<[Metre; 2]>,
    /// As in \[friction\], which it requires; at most one of the three.
    #[key(special = direction, form = "`[x, y]` of any length", absent = "unchanged", example = "[1, 0]")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sliding: Option<[f64; 2]>,
    /// Equal steps from the end of the previous stage; in a cycle of each way.
    ///
    /// Always there in a case.
    #[key(
        count = 1,
        absent = "1; with a `duration` or a `dwell` 16; for elasto-plastic bodies the number in [plasticity]",
        example = "10"
    )]
    pub increments: Option<usize>,
    /// Number of cycles, in each of which the loading goes there and comes back.
    #[key(count = 1, absent = "none: the loading goes there once", example = "10000")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cycles: Option<usize>,
    /// Time in which the loading goes there, in equal steps, for viscoelastic bodies.
    #[key(
        quantity = Time,
        range = AboveZero,
        absent = "none: at once",
        example = "\"0.1 s\"",
        exists = Exists::Any("a stage of any time")
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub duration: Option<Second>,
    /// Time for which the loading then stays, in `increments` steps that grow, for viscoelastic bodies.
    #[key(
        quantity = Time,
        range = AboveZero,
        absent = "none",
        example = "\"10 s\"",
        exists = Exists::Any("a dwell of any time")
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dwell: Option<Second>,
    /// Time of a cycle, for films that grow and for viscoelastic bodies.
    #[key(
        quantity = Time,
        range = AboveZero,
        absent = "unknown",
        example = "\"50 ms\"",
        exists = Exists::Any("a cycle of any time")
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub period: Option<Second>,
}

fn at_most_one_of_each(_: &StageSpec, source: &dyn Source) -> Result<()> {
    at_most_one(source, &["force", "displacement", "sliding"], "give one of them, or none")?;
    at_most_one(source, &["load", "mean_pressure", "approach"], "for example `load = \"2 N\"`")
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

    /// Whether it takes several creepages, one after the other.
    pub fn sweeps(&self) -> bool {
        matches!(self.prescribed, Some(InPlane::Creepages(_)))
    }

    /// Returns the rolling states: one for each of several creepages, or a single one.
    fn rolling(&self) -> impl Iterator<Item = Rolling> + '_ {
        let creeps = self.prescribed.iter().flat_map(InPlane::creeps);
        creeps.map(|creep| Rolling { creep, spin: self.spin })
    }
}

impl StageSpec {
    /// Default number of steps in a time, with which pressures are within some per cent.
    const STEPS_IN_TIME: usize = 16;

    /// Returns the normal loading, if it changes.
    pub fn normal(&self) -> Option<Prescribed> {
        let load = self.load.map(Prescribed::Load);
        load.or(self.mean_pressure.map(Prescribed::MeanPressure)).or(self.approach.map(Prescribed::Approach))
    }

    /// Returns the tangential loading, if it changes.
    pub fn tangential(&self) -> Option<Tangential> {
        let force = self.force.map(Tangential::Force);
        force.or(self.displacement.map(Tangential::Displacement)).or(self.sliding.map(Tangential::Sliding))
    }

    /// Returns the number of equal steps; in a cycle of each way.
    pub fn steps(&self) -> usize {
        self.increments.unwrap_or(1)
    }

    /// Whether the loading goes anywhere.
    fn goes(&self) -> bool {
        self.normal().is_some() || self.tangential().is_some()
    }

    /// Returns the stage with its number of steps, which is `steps` for one that takes no time and does not name it.
    ///
    /// # Errors
    /// A hint, if it names nothing that changes; `keys` are examples of what it might.
    pub(super) fn resolved(self, steps: usize, keys: &str) -> std::result::Result<Self, String> {
        let takes_time = self.duration.is_some() || self.dwell.is_some();
        let default = if takes_time { Self::STEPS_IN_TIME } else { steps };
        match self.duration {
            _ if self.goes() || self.dwell.is_some() => {
                Ok(Self { increments: self.increments.or(Some(default)), ..self })
            }
            Some(_) => Err(format!(
                "give {keys}, to which it goes in the `duration`; a `dwell` is the time for which it stays"
            )),
            None => Err(format!("give {keys}; what a stage does not name stays")),
        }
    }

    /// Returns the stages of the library after a `loading`, which they change.
    fn stages(&self, loading: &mut Loading, apparent_area: SquareMetre) -> impl Iterator<Item = Stage> {
        if let Some(normal) = self.normal() {
            loading.normal = normal.control(apparent_area);
        }
        if let Some(tangential) = self.tangential() {
            loading.tangential = tangential;
        }
        let loading = *loading;
        let cycles = self.cycles.map(|count| Cycles { count, period: self.period });
        let time = self.duration.map_or(StageTime::Sudden, StageTime::Even);
        // Steps that take no time change a viscoelastic contact at once.
        let steps = if self.dwell.is_some() && self.duration.is_none() { 1 } else { self.steps() };
        // A stage that only dwells goes nowhere.
        let goes = self.goes().then(|| Stage::new(loading, steps).with_cycles(cycles).within(time));
        let stays = self.dwell.map(|time| Stage::new(loading, self.steps()).within(StageTime::Growing(time)));
        goes.into_iter().chain(stays)
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
        let normal = self.contact.prescribed().control(apparent_area);
        if friction.is_some_and(FrictionSpec::sweeps) {
            let point = |rolling| Point { control: normal, rolling: Some(rolling), speed: None };
            return Some(LoadingPath::Sweep(rolling.map(point).collect()));
        }
        if let Some(steady) = &self.steady {
            let point = |speed| Point { control: normal, rolling: None, speed: Some(speed) };
            return Some(LoadingPath::Sweep(steady.all().into_iter().map(point).collect()));
        }
        let rolling = rolling.next();
        let sweep = self.contact.sweep();
        if !sweep.is_empty() {
            let point = |prescribed: &Prescribed| Point {
                control: prescribed.control(apparent_area),
                rolling,
                speed: None,
            };
            return Some(LoadingPath::Sweep(sweep.iter().map(point).collect()));
        }
        if let Some(rolling) = rolling {
            return Some(LoadingPath::Rolling(rolling));
        }
        let tangential = friction.and_then(|friction| friction.prescribed.as_ref()?.tangential());
        let mut loading = Loading { normal, tangential: tangential.unwrap_or(Tangential::Force([0.0; 2])) };
        let flowing = self.plasticity.and_then(|plasticity| plasticity.increments).unwrap_or(1);
        let increments = friction.map_or(flowing, |friction| friction.increments);
        let mut stages = vec![Stage::new(loading, increments)];
        for stage in &self.history {
            stages.extend(stage.stages(&mut loading, apparent_area));
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
    fn tangential(&self) -> Option<Tangential> {
        match *self {
            Self::Force(force) => Some(Tangential::Force(force)),
            Self::Displacement(shift) => Some(Tangential::Displacement(shift)),
            Self::Sliding(direction) => Some(Tangential::Sliding(direction)),
            Self::Creepage(_) | Self::Creepages(_) | Self::RollingForce(_) => None,
        }
    }

    /// Returns the tangential loadings of rolling bodies.
    fn creeps(&self) -> Vec<Creep> {
        match self {
            Self::Creepage(creepage) => vec![Creep::Creepage(*creepage)],
            Self::Creepages(several) => several.iter().copied().map(Creep::Creepage).collect(),
            Self::RollingForce(force) => vec![Creep::Force(*force)],
            Self::Force(_) | Self::Displacement(_) | Self::Sliding(_) => Vec::new(),
        }
    }
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

fn is_one(count: &usize) -> bool {
    *count == 1
}

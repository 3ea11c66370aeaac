//! `[[history]]`: the later stages of the loading of a static contact.

use std::mem::discriminant;

use serde::Serialize;

use super::friction::direction;
use super::prescribed::Prescribed;
use asperity_base::beside::{self, Beside, Scale};
use asperity_base::error::Result;
use asperity_base::exists;
use asperity_base::table::{Exists, Source, at_most_one};
use asperity_base::units::{Metre, Newton, Pascal, Second, SquareMetre};
use asperity_contact::motion::{Cycles, Stage, StageTime};
use asperity_contact::solver::{Loading, Tangential};
use asperity_derive::Table;

/// A further stage of the loading. Quantities not given stay as they are.
#[derive(Table, Debug, Clone, Copy, PartialEq, Serialize)]
#[table("history", check = at_most_one_of_each)]
#[non_exhaustive]
pub struct StageSpec {
    /// As in \[contact\]; at most one of the three; with \[adhesion\] it may be 0 or pull, below 0.
    #[key(quantity = Force, absent = "unchanged", example = "\"2 N\"", exists = exists::LOAD, beside = [beside::LOAD])]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load: Option<Newton>,
    /// As in \[contact\]; at most one of the three; with \[adhesion\] it may be 0 or pull, below 0.
    #[key(quantity = Pressure, absent = "unchanged", example = "\"1 MPa\"", exists = exists::LOAD, beside = [beside::LOAD])]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean_pressure: Option<Pascal>,
    /// As in \[contact\]; at most one of the three.
    #[key(quantity = Length, absent = "unchanged", example = "\"10 nm\"", exists = exists::LENGTH, beside = [beside::APPROACH])]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub approach: Option<Metre>,
    /// As in \[friction\], which it requires; at most one of the three.
    #[key(quantity = Force, vector, absent = "unchanged", example = "\"0.1 N\"", exists = exists::LOAD, beside = [beside::FORCE])]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force: Option<[Newton; 2]>,
    /// As in \[friction\], which it requires; at most one of the three.
    #[key(quantity = Length, vector, absent = "unchanged", example = "\"0.1 um\"", exists = exists::LENGTH, beside = [beside::DISPLACEMENT])]
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
        exists = Exists::Any("a stage of any time"),
        beside = [Beside::least(Scale::RelaxationTimes, 1e-3, "nothing relaxes meanwhile")]
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub duration: Option<Second>,
    /// Time for which the loading then stays, in `increments` steps that grow, for viscoelastic bodies.
    #[key(
        quantity = Time,
        range = AboveZero,
        absent = "none",
        example = "\"10 s\"",
        exists = Exists::Any("a dwell of any time"),
        beside = [Beside::within(Scale::RelaxationTimes, [0.1, 200.0], WAITS)]
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dwell: Option<Second>,
    /// Time of a cycle, for films that grow and for viscoelastic bodies.
    #[key(
        quantity = Time,
        range = AboveZero,
        absent = "unknown",
        example = "\"50 ms\"",
        exists = Exists::Any("a cycle of any time"),
        beside = [Beside::within(Scale::RelaxationTimes, [0.01, 100.0], CYCLES)]
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub period: Option<Second>,
}

/// Meaning of short and of long times in which viscoelastic bodies wait.
pub(super) const WAITS: [&str; 2] =
    ["hardly anything relaxes meanwhile", "everything has relaxed long before"];
const CYCLES: [&str; 2] = ["nothing relaxes in a cycle", "the bodies are relaxed throughout"];

fn at_most_one_of_each(_: &StageSpec, source: &dyn Source) -> Result<()> {
    at_most_one(source, &["force", "displacement", "sliding"], "give one of them, or none")?;
    at_most_one(source, &["load", "mean_pressure", "approach"], "for example `load = \"2 N\"`")
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

    /// Returns the stage with its number of steps, which is `steps` for one that takes no time and does not
    /// name it.
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

    /// Returns the stages of the library after the `present` loading, which they change.
    pub(super) fn stages(
        &self,
        present: &mut PresentLoading,
        apparent_area: SquareMetre,
    ) -> impl Iterator<Item = Stage> {
        let before = *present;
        if let Some(normal) = self.normal() {
            present.loading.normal = normal.control(apparent_area);
            present.stays[0] = false;
        }
        if let Some(tangential) = self.tangential() {
            present.loading.tangential = tangential;
            present.stays[1] = false;
        }
        let stage = |steps| Stage::new(present.loading, steps).staying(present.stays);
        let cycles = self.cycles.map(|count| Cycles { count, period: self.period });
        let time = self.duration.map_or(StageTime::Sudden, StageTime::Even);
        // Steps that take no time change a viscoelastic contact at once.
        let steps = if self.dwell.is_some() && self.duration.is_none() { 1 } else { self.steps() };
        // A stage that only dwells goes nowhere.
        let goes = self.goes().then(|| stage(steps).with_cycles(cycles).within(time));
        let stays = self.dwell.map(|time| stage(self.steps()).within(StageTime::Growing(time)));
        let stages = goes.into_iter().chain(stays);
        if self.cycles.is_some() {
            present.come_back(&before);
        }
        stages
    }
}

/// Loading after the stages so far.
#[derive(Debug, Clone, Copy)]
pub(super) struct PresentLoading {
    /// The loading, as far as the case gives it.
    pub(super) loading: Loading,
    /// Whether the normal and the tangential loading have values of this kind that only the contact knows.
    pub(super) stays: [bool; 2],
}

impl PresentLoading {
    /// Comes back to the loading `before` the cycles that led here. A quantity of another kind than before
    /// comes back to a value that only the contact knows.
    fn come_back(&mut self, before: &Self) {
        let kinds = [
            discriminant(&self.loading.normal) == discriminant(&before.loading.normal),
            discriminant(&self.loading.tangential) == discriminant(&before.loading.tangential),
        ];
        self.stays = [0, 1].map(|part| before.stays[part] || !kinds[part]);
        if kinds[0] {
            self.loading.normal = before.loading.normal;
        }
        if kinds[1] {
            self.loading.tangential = before.loading.tangential;
        }
    }
}

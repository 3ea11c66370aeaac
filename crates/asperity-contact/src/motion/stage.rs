//! Stages of a loading: where the loading goes, in which steps, and how often it comes back.

use crate::error::{Error, Result};
use crate::solver::{Control, Equilibrium, Loading, Tangential};
use crate::units::{Metre, Newton, Second};

/// One stage of a loading: the values prescribed at its end, and the number of equal steps to reach them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Stage {
    /// Loading at the end of the stage, or of the way there in a cycle. Without friction, tangential values
    /// have no effect.
    pub loading: Loading,
    /// Number of equal steps, ≥ 1; in a cycle of each way.
    pub increments: usize,
    /// Cycles, in each of which the loading goes there and comes back; `None` if it goes there once and
    /// stays.
    pub cycles: Option<Cycles>,
    /// Time of the stage, which viscoelastic bodies need.
    pub time: StageTime,
    /// Whether the normal and the tangential loading stay at their values at the beginning of the stage, in
    /// the kind of its `loading`. They do after cycles that began at a value which only the contact knows.
    pub stays: [bool; 2],
}

/// Time of a stage.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum StageTime {
    /// Its steps take no time.
    #[default]
    Sudden,
    /// All of its steps together take this time, > 0, each the same part of it.
    Even(Second),
    /// All of its steps together take this time, > 0; the first k of n steps take (k/n)² of it, as for a body
    /// that creeps fast at first.
    Growing(Second),
}

/// Cycles of a stage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cycles {
    /// Their number, ≥ 1.
    pub count: usize,
    /// Time of a cycle, > 0; `None` if it is unknown. Films that grow need it.
    pub period: Option<Second>,
}

/// The next step of a loading.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// Index of the stage.
    pub stage: usize,
    /// Cycles of the stage that are done, with those that were not computed.
    pub cycles: usize,
    /// Step of the stage, or of the present cycle, from 1. Step 0 of a cycle brings the contact into
    /// equilibrium on bodies that have changed; its slip is not one of the cycle.
    pub step: usize,
}

impl Stage {
    /// Creates a stage that goes to this loading in a number of equal steps, ≥ 1.
    pub const fn new(loading: Loading, increments: usize) -> Self {
        Self { loading, increments, cycles: None, time: StageTime::Sudden, stays: [false; 2] }
    }

    /// Sets the time of the stage.
    #[must_use]
    pub const fn within(self, time: StageTime) -> Self {
        Self { time, ..self }
    }

    /// Lets the loading go there and come back, `count` times.
    #[must_use]
    pub const fn with_cycles(self, cycles: Option<Cycles>) -> Self {
        Self { cycles, ..self }
    }

    /// Lets the normal and the tangential loading stay at their values at the beginning of the stage.
    #[must_use]
    pub const fn staying(self, stays: [bool; 2]) -> Self {
        Self { stays, ..self }
    }

    /// Returns the total number of increments of all `stages`, if each cycle is computed.
    pub fn increments(stages: &[Self]) -> usize {
        stages.iter().map(|stage| stage.steps() * stage.cycles.map_or(1, |cycles| cycles.count)).sum()
    }

    /// Number of steps of the stage, or of a cycle.
    pub(super) fn steps(&self) -> usize {
        if self.cycles.is_some() { 2 * self.increments } else { self.increments }
    }

    /// Returns the time of a step, which is this `share` of a cycle in cycles.
    pub(super) fn duration(&self, step: usize, share: f64) -> Second {
        let n = self.increments as f64;
        match (self.cycles, self.time) {
            (Some(cycles), _) => share * cycles.period.unwrap_or(0.0),
            (None, StageTime::Sudden) => 0.0,
            (None, StageTime::Even(time)) => time / n,
            (None, StageTime::Growing(time)) => time * (2 * step - 1) as f64 / (n * n),
        }
    }

    /// Returns the loading at a `share` of the way from `origin` to the end of the stage.
    pub(super) fn towards(&self, share: f64, origin: &Origin) -> Loading {
        let Loading { normal, tangential } = origin.towards(self.loading, share);
        let begun = origin.towards(self.loading, 0.0);
        let [normal_stays, tangential_stays] = self.stays;
        Loading {
            normal: if normal_stays { begun.normal } else { normal },
            tangential: if tangential_stays { begun.tangential } else { tangential },
        }
    }

    /// Returns the loading of a step that began at `origin`, and its share of the time of a cycle; 0 without
    /// cycles.
    pub(super) fn loading_at(&self, step: usize, origin: &Origin) -> (Loading, f64) {
        let n = self.increments;
        let towards = |part: usize| self.towards(part as f64 / n as f64, origin);
        match self.cycles {
            None => (towards(step), 0.0),
            Some(_) if step == 0 => (towards(0), 0.0),
            Some(_) => (towards(if step > n { 2 * n - step } else { step }), 0.5 / n as f64),
        }
    }
}

impl Progress {
    /// Before the first step.
    pub const BEGIN: Self = Self { stage: 0, cycles: 0, step: 1 };

    /// Whether the next step begins its stage.
    pub(super) fn begins_stage(&self) -> bool {
        self.cycles == 0 && self.step == 1
    }

    /// Whether the next step ends a cycle of `stages`.
    pub(super) fn ends_cycle(&self, stages: &[Stage]) -> bool {
        let stage = &stages[self.stage];
        stage.cycles.is_some() && self.step == stage.steps()
    }

    /// Returns the step after the next one. A cycle that ends with it stands for `represented` cycles;
    /// `changes` says whether the heights of the bodies change with it.
    pub(super) fn after(self, stages: &[Stage], represented: usize, changes: bool) -> Self {
        let stage = &stages[self.stage];
        if self.step < stage.steps() {
            return Self { step: self.step + 1, ..self };
        }
        let cycles = self.cycles + represented;
        match stage.cycles {
            Some(Cycles { count, .. }) if cycles < count => {
                Self { cycles, step: usize::from(!changes), ..self }
            }
            _ => Self { stage: self.stage + 1, cycles: 0, step: 1 },
        }
    }

    /// Returns the least number of steps that are left, if each computed cycle to come stands for
    /// `represented` cycles.
    pub(super) fn left(&self, stages: &[Stage], represented: usize) -> usize {
        let Some(stage) = stages.get(self.stage) else { return 0 };
        let later = Stage::increments(&stages[self.stage + 1..]);
        let cycles = stage.cycles.map_or(0, |cycles| cycles.count - self.cycles - 1);
        (stage.steps() + 1).saturating_sub(self.step)
            + cycles.div_ceil(represented.max(1)) * stage.steps()
            + later
    }
}

impl Cycles {
    /// Checks the numbers.
    pub(super) fn checked(self) -> Result<Self> {
        let is_good = self.period.is_none_or(|period| period > 0.0 && period.is_finite());
        if self.count > 0 && is_good {
            Ok(self)
        } else {
            Err(Error::Unsupported("cycles need a number of at least 1 and a time above 0"))
        }
    }
}

/// State at the beginning of a stage, in each quantity that a stage may prescribe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Origin {
    /// Normal force.
    pub load: Newton,
    /// Rigid-body approach.
    pub approach: Metre,
    /// Force of the upper body on the lower one along x and y.
    pub force: [Newton; 2],
    /// Rigid-body displacement of the upper body against the lower one along x and y.
    pub displacement: [Metre; 2],
}

impl Origin {
    /// Creates the state of bodies that just do not touch, at this approach.
    pub(super) fn apart(approach: Metre) -> Self {
        Self { load: 0.0, approach, force: [0.0; 2], displacement: [0.0; 2] }
    }

    /// Creates the state of a contact in equilibrium.
    pub(super) fn from_contact(contact: &Equilibrium) -> Self {
        let normal = contact.normal();
        Self {
            load: normal.load(),
            approach: normal.approach,
            force: contact.force(),
            displacement: contact.rigid_displacement(),
        }
    }

    /// Interpolates the loading towards the end of the stage, which is met exactly.
    pub(super) fn towards(&self, end: Loading, share: f64) -> Loading {
        let between = |from: f64, to: f64| if share == 1.0 { to } else { from + share * (to - from) };
        let both = |from: [f64; 2], to: [f64; 2]| [between(from[0], to[0]), between(from[1], to[1])];
        Loading {
            normal: match end.normal {
                Control::Load(load) => Control::Load(between(self.load, load)),
                Control::Approach(approach) => Control::Approach(between(self.approach, approach)),
            },
            tangential: match end.tangential {
                Tangential::Force(force) => Tangential::Force(both(self.force, force)),
                Tangential::Displacement(displacement) => {
                    Tangential::Displacement(both(self.displacement, displacement))
                }
                sliding @ Tangential::Sliding(_) => sliding,
            },
        }
    }
}

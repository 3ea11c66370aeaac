//! The course of a case: the contacts that are solved one after another, by whichever tables give them.

use super::stage::PresentLoading;
use super::{Case, FrictionSpec, Prescribed};
use asperity_base::units::SquareMetre;
use asperity_contact::motion::{Motion, Point, Slide, SlipRegime, Stage};
use asperity_contact::solver::{Loading, Rolling, Tangential};

/// Course of a case: the sequence of prescribed states.
#[derive(Debug, Clone, PartialEq)]
pub enum Course {
    /// Passes of one body over the other.
    Passes(Motion),
    /// Sliding in place.
    InPlace(Slide),
    /// Loading stage after stage.
    Stages(Vec<Stage>),
    /// One contact in steady rolling.
    Rolling(Rolling),
    /// Sweep of loads, creepages or speeds, each on virgin bodies.
    Sweep(Vec<Point>),
}

impl Course {
    /// The name of a step in messages and tables.
    pub fn step(&self) -> &'static str {
        match self {
            Self::Passes(_) => "pass",
            Self::InPlace(_) => "update",
            Self::Stages(_) | Self::Rolling(_) => "increment",
            Self::Sweep(_) => "point",
        }
    }

    /// Whether a run that is stopped keeps the steps that are finished.
    pub fn keeps_steps(&self) -> bool {
        match self {
            Self::Passes(_) => true,
            Self::Stages(stages) => Stage::increments(stages) > 1,
            Self::Sweep(points) => points.len() > 1,
            Self::InPlace(_) | Self::Rolling(_) => false,
        }
    }

    /// Whether it is one contact in one increment.
    pub fn is_one_increment(&self) -> bool {
        matches!(self, Self::Stages(stages) if Stage::increments(stages) == 1)
    }

    /// Whether it has passes.
    pub fn moves(&self) -> bool {
        matches!(self, Self::Passes(_))
    }

    /// Whether it is a sweep.
    pub fn is_sweep(&self) -> bool {
        matches!(self, Self::Sweep(_))
    }

    /// The stages of a loading; none for another course.
    pub fn stages(&self) -> &[Stage] {
        match self {
            Self::Stages(stages) => stages,
            _ => &[],
        }
    }

    /// Returns the states of steady rolling.
    pub fn rolling(&self) -> impl Iterator<Item = Rolling> + '_ {
        let (one, points) = match self {
            Self::Rolling(rolling) => (Some(*rolling), &[][..]),
            Self::Sweep(points) => (None, points.as_slice()),
            Self::Passes(_) | Self::InPlace(_) | Self::Stages(_) => (None, &[][..]),
        };
        one.into_iter().chain(points.iter().filter_map(|point| point.regime.rolling()))
    }
}

impl Case {
    /// Returns the course on this apparent area, on which a mean pressure acts.
    ///
    /// Without friction the first stage of a loading is a single increment, except for elasto-plastic bodies.
    /// The first loading of a contact does not depend on its steps.
    pub fn course(&self, apparent_area: SquareMetre) -> Course {
        if let Some(motion) = self.motion(apparent_area) {
            return Course::Passes(motion);
        }
        if let Some(slide) = self.slide(apparent_area) {
            return Course::InPlace(slide);
        }
        let friction = self.friction.as_ref();
        let mut rolling = friction.into_iter().flat_map(FrictionSpec::rolling);
        let regime = |rolling: Option<Rolling>| match friction.zip(rolling) {
            None => SlipRegime::Frictionless,
            Some((friction, rolling)) => SlipRegime::Rolling(friction.law, rolling),
        };
        let normal = self.contact.prescribed().control(apparent_area);
        if friction.is_some_and(FrictionSpec::sweeps) {
            let point = |rolling| Point { control: normal, regime: regime(Some(rolling)), speed: None };
            return Course::Sweep(rolling.map(point).collect());
        }
        let speeds = match (&self.steady, &self.interface.lubrication) {
            (Some(steady), _) => Some(steady.all()),
            (None, Some(oil)) => Some(oil.all_speeds()),
            (None, None) => None,
        };
        if let Some(speeds) = speeds {
            let point = |speed| Point { control: normal, regime: regime(None), speed: Some(speed) };
            return Course::Sweep(speeds.into_iter().map(point).collect());
        }
        let rolling = rolling.next();
        let sweep = self.contact.sweep();
        if !sweep.is_empty() {
            let point = |prescribed: &Prescribed| Point {
                control: prescribed.control(apparent_area),
                regime: regime(rolling),
                speed: None,
            };
            return Course::Sweep(sweep.iter().map(point).collect());
        }
        if let Some(rolling) = rolling {
            return Course::Rolling(rolling);
        }
        let tangential = friction.and_then(|friction| friction.prescribed.as_ref()?.tangential());
        let loading = Loading { normal, tangential: tangential.unwrap_or(Tangential::Force([0.0; 2])) };
        let flowing = self.plasticity.and_then(|plasticity| plasticity.increments).unwrap_or(1);
        let increments = friction.map_or(flowing, |friction| friction.increments);
        let mut stages = vec![Stage::new(loading, increments)];
        let mut present = PresentLoading { loading, stays: [false; 2] };
        for stage in &self.history {
            stages.extend(stage.stages(&mut present, apparent_area));
        }
        Course::Stages(stages)
    }
}

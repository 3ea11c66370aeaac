//! The loading path of a static contact: `[contact]` and `[friction]`, then each `[[history]]`.

use super::{Case, FrictionSpec, Prescribed};
use asperity_base::units::SquareMetre;
use asperity_contact::motion::{Point, Stage};
use asperity_contact::solver::{Loading, Rolling, Tangential};

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

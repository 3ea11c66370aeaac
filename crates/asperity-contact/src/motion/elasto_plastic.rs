//! Elasto-plastic bodies in a loading, stage after stage.

use crate::error::Result;
use crate::motion::course::Output;
use crate::motion::loading::StagedLoading;
use crate::motion::pair::Pair;
use crate::motion::stage::Stage;
use crate::motion::state::LoadedContact;
use crate::motion::watch::Watch;
use crate::operator::Boundary;
use crate::plasticity::{PlasticBody, PlasticParams};
use crate::solver::{Friction, Params};

/// Loading path of elasto-plastic bodies.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PlasticPath {
    /// The stages, one after another. Tangential loading counts only with friction.
    pub stages: Vec<Stage>,
    /// Number of equal unloading steps at the end, ≥ 1; `None` if the load stays.
    pub unloading: Option<usize>,
    /// Convergence criteria of a step.
    pub plastic: PlasticParams,
}

impl PlasticPath {
    /// Creates a path through these stages, without unloading.
    pub fn new(stages: Vec<Stage>) -> Self {
        Self { stages, unloading: None, plastic: PlasticParams::new() }
    }

    /// Sets the number of unloading steps at the end.
    #[must_use]
    pub fn with_unloading(self, steps: impl Into<Option<usize>>) -> Self {
        Self { unloading: steps.into(), ..self }
    }

    /// Sets the convergence criteria of a step.
    #[must_use]
    pub fn with_plastic(self, plastic: PlasticParams) -> Self {
        Self { plastic, ..self }
    }
}

/// Presses a pair at full overlap along a `path`. The given `bodies`, lower one first, are elasto-plastic.
/// Under `friction` they stick or slip. The increments include the unloading; record and solution are those
/// under the last load.
///
/// # Errors
/// The errors of [`StagedLoading::with_plastic`] and of [`StagedLoading::run`].
///
/// # Panics
/// If the bodies have different shapes.
#[expect(clippy::too_many_arguments, reason = "the contact, its path, and who looks on")]
pub fn press_elasto_plastic(
    pair: &Pair,
    boundary: Boundary,
    friction: Option<&Friction>,
    bodies: [Option<PlasticBody>; 2],
    path: &PlasticPath,
    params: &Params,
    watch: &dyn Watch,
    outputs: &mut [&mut dyn Output],
) -> Result<LoadedContact> {
    let loading =
        StagedLoading::new(pair.clone(), boundary, friction.copied(), path.stages.clone(), *params)?;
    loading.with_plastic(bodies, path.plastic, path.unloading)?.run(None, watch, outputs)
}

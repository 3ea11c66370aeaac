//! A static contact of elasto-plastic bodies.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::motion::contact::facing;
use crate::motion::course::{self, Course, Output, Step, StepRow};
use crate::motion::pair::Pair;
use crate::motion::plastic_volume::{PlasticResult, PlasticSums, PlasticVolume};
use crate::motion::press::{shear_record, static_record};
use crate::motion::record::{IncrementRecord, PlasticRecord, PlasticStepRecord, StaticRecord};
use crate::motion::slip::SlipRegime;
use crate::motion::stage::{Origin, Stage};
use crate::motion::state::LoadedContact;
use crate::motion::watch::{StaticWatch, Watch};
use crate::operator::Boundary;
use crate::plasticity::{PlasticBody, PlasticContact, PlasticParams, RelativePosition};
use crate::solver::{Control, Equilibrium, Friction, Loading, Params, Tangential};
use crate::units::Joule;

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

    /// Total number of increments, unloading included.
    fn increments(&self) -> usize {
        Stage::increments(&self.stages) + self.unloading.unwrap_or(0)
    }

    /// Sets the convergence criteria of a step.
    #[must_use]
    pub fn with_plastic(self, plastic: PlasticParams) -> Self {
        Self { plastic, ..self }
    }
}

/// Presses a pair at full overlap along a `path`. The given `bodies`, lower one first, are elasto-plastic. Under `friction`
/// they stick or slip. The increments include the unloading; record and solution are those under the last load.
///
/// # Errors
/// [`Error::AtIncrement`] with the cause, [`Error::Interrupted`], [`Error::Unsupported`] for a path that ends without
/// contact, and the errors of the outputs.
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
    pair.interface().check_combined()?;
    pair.check_elastic()?;
    pair.check_flow(&bodies)?;
    let (operators, initial_gap) = facing(pair, boundary)?;
    let regime = SlipRegime::from(friction.copied());
    let solver = regime.solver(pair, &operators, pair.lower_grid().shape, params.device)?;
    let at_rest = pair.at_rest();
    let (bounds, placements) = (pair.bounds(&at_rest), pair.placements(&at_rest));
    let facing = RelativePosition { solver, initial_gap, bounds, placements };
    let contact = PlasticContact::new(facing, bodies, path.plastic, *params);
    let mut yielding = ElastoPlasticLoading {
        flattened: contact.grid().zeros(),
        contact,
        path,
        increments: Vec::new(),
        sums: PlasticSums::default(),
        slip: None,
        dissipation_error: 0.0,
        origin: None,
        loaded: None,
    };
    course::run(&mut yielding, watch, outputs)?;
    yielding.finish()
}

/// A contact of elasto-plastic bodies on its loading path.
struct ElastoPlasticLoading<'a> {
    contact: PlasticContact,
    /// The plastic interference at a hardness so far.
    flattened: Field,
    path: &'a PlasticPath,
    increments: Vec<IncrementRecord>,
    sums: PlasticSums,
    slip: Option<[Field; 2]>,
    dissipation_error: Joule,
    /// State at the beginning of the current stage.
    origin: Option<Origin>,
    /// The contact under its last load, once it is reached.
    loaded: Option<LastLoad>,
}

/// A contact under its last load.
struct LastLoad {
    solution: Equilibrium,
    flattened: Field,
    slip: Option<[Field; 2]>,
    dissipation: Joule,
    dissipation_error: Joule,
    volumes: Vec<PlasticVolume>,
    plastic: PlasticRecord,
}

impl LastLoad {
    /// Creates the unloading stage with `increments` steps.
    fn unloading(&self, increments: usize) -> Stage {
        // The force of bodies in gross slip is the whole friction force, also under each smaller load.
        let slides = Some(&self.solution).filter(|solution| solution.stick_area() == 0.0);
        let tangential = match slides.map(Equilibrium::force) {
            Some([x, y]) if x.hypot(y) > 0.0 => Tangential::Sliding([x, y].map(|part| part / x.hypot(y))),
            _ => Tangential::Force([0.0; 2]),
        };
        Stage::new(Loading { normal: Control::Load(0.0), tangential }, increments)
    }
}

impl Course for ElastoPlasticLoading<'_> {
    type Solved = IncrementRecord;

    fn next(&mut self, watch: &dyn Watch) -> Result<Option<IncrementRecord>> {
        let Some((index, stage, step)) = self.stage()? else { return Ok(None) };
        if step == 1 {
            self.origin = Some(match self.contact.equilibrium() {
                Some(equilibrium) => Origin::of(equilibrium),
                None => Origin::apart(self.contact.first_touch()),
            });
        }
        let origin = self.origin.expect("a stage has begun");
        let loading = stage.towards(step as f64 / stage.increments as f64, &origin);
        let watch = StaticWatch::new(watch, self.increments.len(), self.path.increments(), loading.normal);
        self.increment(loading, index + 1, &watch).map(Some)
    }

    fn report<'a>(&'a self, record: &'a IncrementRecord) -> Step<'a> {
        let loading = Stage::increments(&self.path.stages);
        let contact = self.contact.equilibrium().filter(|_| record.increment <= loading);
        Step {
            contact: contact.map(Equilibrium::normal),
            ends_loading: record.increment == loading,
            ..Step::new(record.increment, self.path.increments(), StepRow::Increment(record))
        }
    }

    fn take(&mut self, record: IncrementRecord) {
        self.increments.push(record);
    }
}

impl ElastoPlasticLoading<'_> {
    /// Returns the index of the current stage, the stage, and its next step, from 1; `None` after the last.
    fn stage(&mut self) -> Result<Option<(usize, Stage, usize)>> {
        let (stages, done) = (&self.path.stages, self.increments.len());
        if let Some((index, step)) = Stage::after(stages, done) {
            return Ok(Some((index, stages[index], step)));
        }
        let unloading = done - Stage::increments(stages);
        if unloading == 0 {
            self.loaded = Some(self.under_the_last_load()?);
        }
        let (Some(loaded), Some(increments)) = (&self.loaded, self.path.unloading) else { return Ok(None) };
        Ok((unloading < increments).then(|| (stages.len(), loaded.unloading(increments), unloading + 1)))
    }

    fn under_the_last_load(&mut self) -> Result<LastLoad> {
        let nothing = Error::Unsupported("an elasto-plastic contact needs a load");
        let solution = self.contact.equilibrium().cloned().ok_or(nothing)?;
        let volumes = PlasticVolume::loaded(&mut self.contact);
        Ok(LastLoad {
            solution,
            flattened: self.flattened.clone(),
            slip: self.slip.take(),
            dissipation: self.increments.iter().map(|increment| increment.dissipation).sum(),
            dissipation_error: self.dissipation_error,
            plastic: PlasticRecord::of(&volumes, &self.sums),
            volumes,
        })
    }

    /// Advances to a prescribed loading.
    fn increment(
        &mut self,
        loading: Loading,
        stage: usize,
        watch: &StaticWatch<'_>,
    ) -> Result<IncrementRecord> {
        let contact = &mut self.contact;
        let before = contact.equilibrium().cloned();
        let increment = contact.load(loading, watch)?;
        self.flattened += &contact.flatten();
        self.sums.add(&increment);
        let plastic = PlasticStepRecord::of(std::slice::from_ref(&increment), contact);
        let apart = || IncrementRecord { approach: f64::NAN, ..IncrementRecord::default() };
        let record = contact.equilibrium().map_or_else(apart, IncrementRecord::of);
        let equilibrium = contact.equilibrium();
        let [dissipation, error] = equilibrium.map_or([0.0; 2], |now| now.dissipation(before.as_ref()));
        self.dissipation_error += error;
        if let Some(slip) = equilibrium.and_then(Equilibrium::slip) {
            self.slip = Some(match self.slip.take() {
                None => slip.clone(),
                Some([x, y]) => [x + &slip[0], y + &slip[1]],
            });
        }
        let increment = self.increments.len() + 1;
        let plastic_volume = contact.grid().cell_area() * self.flattened.sum();
        let plastic = Some(plastic);
        Ok(IncrementRecord { increment, stage, plastic_volume, dissipation, plastic, ..record })
    }

    /// Returns the contact at the end of its path.
    fn finish(mut self) -> Result<LoadedContact> {
        let loaded = self.loaded.take().expect("the end of the path");
        let LastLoad { solution, flattened, slip, dissipation, dissipation_error, volumes, plastic } = loaded;
        let (residual, left) = match self.path.unloading {
            None => (Vec::new(), None),
            Some(_) => {
                let residual = PlasticVolume::unloaded(&mut self.contact);
                let left = PlasticRecord::of(&residual, &self.sums).into_residual();
                (residual, Some(left))
            }
        };
        let PlasticSums { products, mismatch, .. } = self.sums;
        let plastic = PlasticRecord { products, mismatch, residual: left, ..plastic };
        let shear = shear_record(&solution, dissipation);
        let record = static_record(&solution, &flattened);
        // Below 0 by all of the plastic interference, as for other bodies.
        let mean = |field: &Field| field.mean().unwrap_or(0.0);
        let opened = mean(&flattened) - mean(&solution.normal().plastic_interference());
        let mean_gap = record.mean_gap - opened;
        let record = StaticRecord { plastic: Some(plastic), shear, mean_gap, ..record };
        Ok(LoadedContact {
            record,
            increments: self.increments,
            solution,
            plastic: flattened,
            slip,
            dissipation_error,
            changed: None,
            plastic_result: Some(PlasticResult { volumes, residual }),
        })
    }
}

//! A static contact of bodies that flow below their surfaces.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::motion::contact::facing;
use crate::motion::flowed::{self, FlowSums, FlowedVolume};
use crate::motion::loading::{Origin, Stage, shear_record, static_record};
use crate::motion::pair::Pair;
use crate::motion::record::{FlowRecord, FlowStepRecord, IncrementRecord, StaticRecord};
use crate::motion::watch::{AtRest, Progress, Watch};
use crate::operator::Boundary;
use crate::plasticity::{Facing, FlowParams, Interface, PlasticBody, PlasticContact};
use crate::solver::{Control, Equilibrium, Friction, FrictionalSolution, Loading, Params, Tangential};
use crate::units::Joule;

/// A static contact whose bodies have flowed below their surfaces.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct FlowedContact {
    /// The contact in numbers, under its last load.
    pub record: StaticRecord,
    /// The contact under its last load; its gap is that of the bodies with what has flowed.
    pub solution: Equilibrium,
    /// Slip of all increments until then together along x and y, m; none without friction.
    pub slip: Option<[Field; 2]>,
    /// How far the energy that friction took may be from what the record says: see
    /// [`FrictionalSolution::dissipation_error`](crate::solver::FrictionalSolution::dissipation_error).
    pub dissipation_error: Joule,
    /// What has flowed.
    pub flowed: Flowed,
}

/// What has flowed below the surfaces of a static contact.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct Flowed {
    /// The increments, and those in which the load is taken off.
    pub increments: Vec<IncrementRecord>,
    /// What has flowed in each body that may, under the last load.
    pub volumes: Vec<FlowedVolume>,
    /// The same once the load is taken off; nothing where it is not.
    pub residual: Vec<FlowedVolume>,
}

impl Flowed {
    /// A `pair` with its surfaces where the plastic strain under the last load has brought them.
    pub fn displaced(&self, pair: Pair) -> Pair {
        flowed::displaced(pair, &self.volumes, 1.0)
    }
}

/// How bodies that flow are pressed together.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FlowPath {
    /// The stages, one after another; what acts in the plane counts with friction alone.
    pub stages: Vec<Stage>,
    /// Equal steps in which the load is taken off at the end, ≥ 1; none where it stays.
    pub unloading: Option<usize>,
    /// When a step is done.
    pub flow: FlowParams,
}

impl FlowPath {
    /// Through these stages, and no further.
    pub fn new(stages: Vec<Stage>) -> Self {
        Self { stages, unloading: None, flow: FlowParams::new() }
    }

    /// The same, whose load is taken off at the end in so many steps.
    #[must_use]
    pub fn with_unloading(self, steps: impl Into<Option<usize>>) -> Self {
        Self { unloading: steps.into(), ..self }
    }

    /// The same with another measure of when a step is done.
    #[must_use]
    pub fn with_flow(self, flow: FlowParams) -> Self {
        Self { flow, ..self }
    }
}

/// Presses a pair whose bodies face each other with all their columns, and of which those that are given, lower one first, flow below
/// their surfaces, along a `path`; under `friction` they stick or slip.
///
/// # Errors
/// [`Error::AtIncrement`] with what is wrong there, [`Error::Interrupted`], [`Error::Unsupported`] for a path that ends without contact.
///
/// # Panics
/// If the bodies have different shapes.
pub fn press_flowing(
    pair: &Pair,
    boundary: Boundary,
    friction: Option<&Friction>,
    bodies: [Option<PlasticBody>; 2],
    path: &FlowPath,
    params: &Params,
    watch: &dyn Watch,
) -> Result<FlowedContact> {
    let (operators, initial_gap) = facing(pair, boundary)?;
    let shape = pair.lower_grid().shape;
    let interface = match friction {
        None => Interface::Frictionless(operators.on(shape)),
        Some(friction) => {
            pair.check_shear()?;
            Interface::Frictional(operators.coupled_on(shape), *friction)
        }
    };
    let facing = Facing { interface, initial_gap, seats: pair.seats(&pair.at_rest()) };
    let mut contact = PlasticContact::new(facing, bodies, path.flow, *params);
    let steps = path.stages.iter().map(|stage| stage.increments).chain(path.unloading).sum();
    let mut course = Course {
        watch,
        steps,
        increments: Vec::new(),
        sums: FlowSums::default(),
        slip: None,
        dissipation_error: 0.0,
    };
    for (stage, index) in path.stages.iter().zip(1..) {
        course.walk(&mut contact, stage, index)?;
    }
    let solution =
        contact.equilibrium().cloned().ok_or(Error::Unsupported("a contact without a load does not flow"))?;
    let dissipation = course.increments.iter().map(|increment| increment.dissipation).sum();
    let (slip, dissipation_error) = (course.slip.take(), course.dissipation_error);
    let volumes = FlowedVolume::loaded(&mut contact);
    let flow = FlowRecord::of(&volumes, &course.sums);
    let (residual, left) = match path.unloading {
        None => (Vec::new(), None),
        Some(increments) => {
            // The force of bodies that slide is all that friction holds, and so it is under each smaller load.
            let slides = solution.frictional().filter(|solution| solution.stick.sum() == 0.0);
            let tangential = match slides.map(FrictionalSolution::force) {
                Some([x, y]) if x.hypot(y) > 0.0 => Tangential::Sliding([x, y].map(|part| part / x.hypot(y))),
                _ => Tangential::Force([0.0; 2]),
            };
            let nothing = Loading { normal: Control::Load(0.0), tangential };
            course.walk(&mut contact, &Stage { loading: nothing, increments }, path.stages.len() + 1)?;
            let residual = FlowedVolume::unloaded(&mut contact);
            let left = FlowRecord::of(&residual, &course.sums).into_residual();
            (residual, Some(left))
        }
    };
    let FlowSums { products, mismatch, .. } = course.sums;
    let flow = FlowRecord { products, mismatch, residual: left, ..flow };
    let shear = solution.frictional().map(|solution| shear_record(solution, dissipation));
    let plastic = Field::zeros(shape);
    let record = StaticRecord { flow: Some(flow), shear, ..static_record(&solution, &plastic) };
    Ok(FlowedContact {
        record,
        solution,
        slip,
        dissipation_error,
        flowed: Flowed { increments: course.increments, volumes, residual },
    })
}

/// The increments so far.
struct Course<'a> {
    watch: &'a dyn Watch,
    /// Increments in all.
    steps: usize,
    increments: Vec<IncrementRecord>,
    sums: FlowSums,
    slip: Option<[Field; 2]>,
    dissipation_error: Joule,
}

impl Course<'_> {
    /// Goes through a stage, which begins where the contact is.
    fn walk(&mut self, contact: &mut PlasticContact, stage: &Stage, index: usize) -> Result<()> {
        let origin = match contact.equilibrium() {
            Some(equilibrium) => Origin::of(equilibrium),
            None => Origin::apart(contact.first_touch()),
        };
        for step in 1..=stage.increments {
            let loading = origin.towards(stage.loading, step as f64 / stage.increments as f64);
            self.go(contact, loading, index)?;
        }
        Ok(())
    }

    /// Goes on to what is prescribed.
    fn go(&mut self, contact: &mut PlasticContact, loading: Loading, stage: usize) -> Result<()> {
        let at_rest = AtRest::new(self.watch, self.increments.len(), self.steps, loading.normal);
        let before = contact.equilibrium().and_then(Equilibrium::frictional).cloned();
        let increment = contact.load(loading, &at_rest)?;
        self.sums.add(&increment);
        let flow = FlowStepRecord::of(std::slice::from_ref(&increment), contact);
        let apart = || IncrementRecord { approach: f64::NAN, ..IncrementRecord::default() };
        let record = contact.equilibrium().map_or_else(apart, IncrementRecord::of);
        let solution = contact.equilibrium().and_then(Equilibrium::frictional);
        let dissipation = solution.map_or(0.0, |solution| solution.dissipation(before.as_ref()));
        if let Some(solution) = solution {
            let error = before.map_or(0.0, |before| solution.dissipation_error(&before));
            self.dissipation_error += error;
            self.slip = Some(match self.slip.take() {
                None => solution.slip.clone(),
                Some([x, y]) => [x + &solution.slip[0], y + &solution.slip[1]],
            });
        }
        let increment = self.increments.len() + 1;
        self.increments.push(IncrementRecord { increment, stage, dissipation, flow: Some(flow), ..record });
        let (solved, positions, load) = (increment, self.steps, contact.normal_force());
        self.watch.at(&Progress { pass: 1, passes: 1, trial: 1, solved, positions, load, together: None });
        Ok(())
    }
}

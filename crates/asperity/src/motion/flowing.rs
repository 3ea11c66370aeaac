//! A static contact of bodies that flow below their surfaces.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::motion::contact::facing;
use crate::motion::loading::{Origin, Stage};
use crate::motion::pair::Pair;
use crate::motion::record::{FlowRecord, FlowStepRecord, IncrementRecord, StaticRecord};
use crate::motion::watch::{AtRest, Progress, Watch};
use crate::operator::Boundary;
use crate::plasticity::{FlowParams, PlasticBody, PlasticContact, TensorField, VolumeField};
use crate::solver::{Control, Loading, Params, Solution, Tangential};
use crate::stress::{Component, Stress};
use crate::units::{CubicMetre, Metre};

/// A static contact whose bodies have flowed below their surfaces.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct FlowedContact {
    /// The contact in numbers, under its last load.
    pub record: StaticRecord,
    /// The contact under its last load; its gap is that of the bodies with what has flowed.
    pub solution: Solution,
    /// What has flowed.
    pub flowed: Flowed,
}

/// What has flowed below the surfaces of a static contact.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Flowed {
    /// The increments, and those in which the load is taken off.
    pub increments: Vec<IncrementRecord>,
    /// What has flowed in each body that may, under the last load.
    pub volumes: Vec<FlowedVolume>,
    /// The same once the load is taken off; nothing where it is not.
    pub residual: Vec<FlowedVolume>,
}

/// What has flowed below the surface of a body.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct FlowedVolume {
    /// The body: 0 the lower, 1 the upper one.
    pub body: usize,
    /// Depths of the faces of the layers, from 0 at the surface.
    pub faces: Vec<Metre>,
    /// Plastic strain ε, `[layer, component, ix, iy]`.
    pub strain: TensorField,
    /// Accumulated plastic strain, `[layer, ix, iy]`.
    pub accumulated: VolumeField,
    /// Back stress, Pa, of a law that has one.
    pub back_stress: Option<TensorField>,
    /// Residual stress K ε, Pa.
    pub residual_stress: TensorField,
    /// Inward displacement r of the surface, m.
    pub displacement: Field,
}

impl Flowed {
    /// A `pair` with its surfaces where the plastic strain under the last load has brought them.
    pub fn displaced(&self, mut pair: Pair) -> Pair {
        for volume in &self.volumes {
            match volume.body {
                0 => pair.lower.heights -= &volume.displacement,
                _ => pair.upper.heights += &volume.displacement,
            }
        }
        pair
    }
}

impl FlowedVolume {
    fn of(body: &mut PlasticBody, index: usize) -> Self {
        let residual_stress = body.residual_stress();
        Self {
            body: index,
            faces: body.volume().layers().faces().to_vec(),
            strain: body.strain().clone(),
            accumulated: body.accumulated().clone(),
            back_stress: body.back_stress().cloned(),
            residual_stress,
            displacement: body.displacement().clone(),
        }
    }

    /// Largest principal stress of the residual stress.
    fn max_tension(&self) -> f64 {
        let mut most = 0.0_f64;
        for layer in self.residual_stress.outer_iter() {
            for cell in layer.lanes(ndarray::Axis(0)) {
                let stress =
                    Stress::from_components(Component::ALL.map(|component| cell[component as usize]));
                most = most.max(stress.principal()[0]);
            }
        }
        most
    }
}

/// How bodies that flow are pressed together.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FlowPath {
    /// The stages, one after another; nothing acts in the plane.
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
/// their surfaces, along a `path`.
///
/// # Errors
/// [`Error::AtIncrement`] with what is wrong there, [`Error::Interrupted`], [`Error::Unsupported`] for a path that ends without contact.
///
/// # Panics
/// If the bodies have different shapes.
pub fn press_flowing(
    pair: &Pair,
    boundary: Boundary,
    bodies: [Option<PlasticBody>; 2],
    path: &FlowPath,
    params: &Params,
    watch: &dyn Watch,
) -> Result<FlowedContact> {
    let bodies = bodies.into_iter().enumerate().filter_map(|(index, body)| Some((index, body?)));
    let (indices, bodies): (Vec<_>, Vec<_>) = bodies.unzip();
    let (operators, gap) = facing(pair, boundary)?;
    let operator = operators.on(pair.lower_grid().shape);
    let mut contact = PlasticContact::new(operator, gap, bodies, path.flow, *params);
    let steps = path.stages.iter().map(|stage| stage.increments).chain(path.unloading).sum();
    let mut course =
        Course { watch, steps, increments: Vec::new(), products: 0, mismatch: 0.0, plastic_work: 0.0 };
    for (stage, index) in path.stages.iter().zip(1..) {
        course.walk(&mut contact, stage, index)?;
    }
    let solution =
        contact.solution().cloned().ok_or(Error::Unsupported("a contact without a load does not flow"))?;
    let volumes = kept(&mut contact, &indices);
    let flow = course.record(&mut contact, &volumes);
    let (residual, left) = match path.unloading {
        None => (Vec::new(), None),
        Some(increments) => {
            let loading = Loading { normal: Control::Load(0.0), tangential: Tangential::Force([0.0; 2]) };
            course.walk(&mut contact, &Stage { loading, increments }, path.stages.len() + 1)?;
            let residual = kept(&mut contact, &indices);
            let left = course.record(&mut contact, &residual).into_residual();
            (residual, Some(left))
        }
    };
    let flow = FlowRecord { products: course.products, mismatch: course.mismatch, residual: left, ..flow };
    let record = StaticRecord { flow: Some(flow), ..StaticRecord::new(&solution) };
    Ok(FlowedContact {
        record,
        solution,
        flowed: Flowed { increments: course.increments, volumes, residual },
    })
}

fn kept(contact: &mut PlasticContact, indices: &[usize]) -> Vec<FlowedVolume> {
    contact.bodies().iter_mut().zip(indices).map(|(body, index)| FlowedVolume::of(body, *index)).collect()
}

/// The increments so far.
struct Course<'a> {
    watch: &'a dyn Watch,
    /// Increments in all.
    steps: usize,
    increments: Vec<IncrementRecord>,
    products: usize,
    mismatch: f64,
    plastic_work: f64,
}

impl Course<'_> {
    /// Goes through a stage, which begins where the contact is.
    fn walk(&mut self, contact: &mut PlasticContact, stage: &Stage, index: usize) -> Result<()> {
        let approach = contact.approach().unwrap_or_else(|| contact.first_touch());
        let origin = Origin { load: contact.load(), approach, force: [0.0; 2], displacement: [0.0; 2] };
        for step in 1..=stage.increments {
            let Loading { normal, .. } = origin.towards(stage.loading, step as f64 / stage.increments as f64);
            self.go(contact, normal, index)?;
        }
        Ok(())
    }

    /// Goes on to a load or an approach.
    fn go(&mut self, contact: &mut PlasticContact, control: Control, stage: usize) -> Result<()> {
        let at_rest = AtRest::new(self.watch, self.increments.len(), self.steps, control);
        let increment = contact.go_to_watched(control, &at_rest)?;
        self.products += increment.products;
        self.mismatch = self.mismatch.max(increment.mismatch);
        self.plastic_work += increment.plastic_work();
        let most = contact.bodies().iter().map(|body| body.max_accumulated().0).fold(0.0, f64::max);
        let area = contact.grid().cell_area();
        let (touching, max_pressure) = contact
            .pressure()
            .iter()
            .fold((0, 0.0_f64), |(count, most), p| (count + usize::from(*p > 0.0), most.max(*p)));
        let (residual, stats) = contact
            .solution()
            .map_or((0.0, Default::default()), |solution| (solution.residual, solution.stats));
        self.increments.push(IncrementRecord {
            increment: self.increments.len() + 1,
            stage,
            load: contact.load(),
            approach: contact.approach().unwrap_or(f64::NAN),
            contact_area: area * touching as f64,
            max_pressure,
            elastic_energy: contact.elastic_energy(),
            iterations: stats.iterations,
            convolutions: stats.convolutions,
            residual,
            flow: Some(FlowStepRecord {
                yielded_cells: increment.flowing_cells(),
                max_plastic_strain: most,
                plastic_work: increment.plastic_work(),
                products: increment.products,
                mismatch: increment.mismatch,
            }),
            ..IncrementRecord::default()
        });
        let (solved, positions, load) = (self.increments.len(), self.steps, contact.load());
        self.watch.at(&Progress { pass: 1, passes: 1, trial: 1, solved, positions, load, together: None });
        Ok(())
    }

    /// What has flowed so far.
    fn record(&self, contact: &mut PlasticContact, volumes: &[FlowedVolume]) -> FlowRecord {
        let grid = *contact.grid();
        let bodies = contact.bodies();
        let energy = |(body, volume): (&mut PlasticBody, &FlowedVolume)| {
            -0.5 * body.volume().inner_product(&volume.residual_stress, &volume.strain)
        };
        let stored_energy = bodies.iter_mut().zip(volumes).map(energy).sum();
        let yielded_volume: CubicMetre = bodies.iter().map(PlasticBody::yielded_volume).sum();
        let most = bodies.iter_mut().map(|body| {
            let (strain, [layer, ix, iy]) = body.max_accumulated();
            let depth = body.volume().layers().centre(layer);
            (strain, [grid.centre(0, ix), grid.centre(1, iy), depth])
        });
        let (max_plastic_strain, max_plastic_strain_position) =
            most.max_by(|(a, _), (b, _)| a.total_cmp(b)).unwrap_or((0.0, [0.0; 3]));
        let displaced = |volume: &FlowedVolume| {
            grid.cell_area() * volume.displacement.iter().map(|r| r.max(0.0)).sum::<f64>()
        };
        let range = |volume: &FlowedVolume| {
            let (least, most) = volume
                .displacement
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), r| (r.min(least), r.max(most)));
            most - least
        };
        FlowRecord {
            max_plastic_strain,
            max_plastic_strain_position,
            yielded_volume,
            plastic_work: self.plastic_work,
            stored_energy,
            displaced_volume: volumes.iter().map(displaced).sum(),
            max_residual_tension: volumes.iter().map(FlowedVolume::max_tension).fold(0.0, f64::max),
            residual_displacement: volumes.iter().map(range).fold(0.0, f64::max),
            products: self.products,
            mismatch: self.mismatch,
            regime: if max_plastic_strain > 0.0 { "yields" } else { "elastic" }.to_owned(),
            residual: None,
        }
    }
}

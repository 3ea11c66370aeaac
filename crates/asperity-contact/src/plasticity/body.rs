//! An elasto-plastic body.

use std::slice::{ChunksExact, ChunksExactMut};
use std::sync::Arc;

use ndarray::s;

use super::j2::J2;
use super::law::{CellState, Tensor, contract, equivalent};
use super::{COMPONENTS, TensorField, Volume, VolumeField};
use crate::grid::Field;
use crate::kernel::Traction;
use crate::math::parallel;
use crate::subsurface::Tractions;
use crate::units::{CubicMetre, Joule, Pascal};

/// θ, the fraction of 2μ by which the stress of the predictor relaxes. The iteration converges only above ½.
const RELAXATION: f64 = 0.65;
/// Cells whose equivalent predictor exceeds this fraction of the yield stress may flow.
const MAY_YIELD: f64 = 0.5;

/// Loading of a body.
#[derive(Debug, Clone)]
pub enum Action {
    /// Tractions on its surface, in its own frame.
    Tractions(Tractions),
    /// A stress in its layers without plastic strain, Pa.
    Stress(Arc<TensorField>),
}

/// Displacement of a surface by plastic strain.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SurfaceDisplacement {
    /// Component into the body, m.
    pub inward: Field,
    /// Components along +x and +y, m; `None` if the surface is not [followed](PlasticBody::followed_along)
    /// tangentially.
    pub along: Option<[Field; 2]>,
}

/// Plastic state of a body: everything its further response depends on.
#[derive(Debug, Clone, PartialEq)]
pub struct PlasticState {
    /// Plastic strain ε.
    pub strain: TensorField,
    /// Accumulated plastic strain p̄.
    pub accumulated: VolumeField,
    /// Back stress X, Pa, if the law has one.
    pub back_stress: Option<TensorField>,
}

/// An elasto-plastic half-space: the volume under its surface, its flow law, and its plastic state.
pub struct PlasticBody {
    volume: Volume,
    law: J2,
    state: PlasticState,
    /// Present loading, and the stress under it.
    action: Option<Action>,
    stress: TensorField,
    /// Displacement of the surface by the plastic strain.
    displacement: SurfaceDisplacement,
    /// Increase of the strain in the last increment, for the cells that flowed.
    increment: Vec<(usize, Tensor)>,
    trial: Trial,
}

/// State within an increment.
struct Trial {
    /// y.
    predictor: TensorField,
    /// ε for this predictor.
    strain: TensorField,
    /// σ for this strain.
    stress: TensorField,
    /// Whether a cell flows.
    flows: ndarray::Array3<bool>,
}

/// Results of an increment in a body.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct BodyIncrement {
    /// Number of cells of all layers that have flowed.
    pub yielding_cells: usize,
    /// Plastic work ∫ ½ (σ₀ + σ₁) : Δε, J.
    pub plastic_work: Joule,
    /// Part of it under each column of the body, J.
    pub work_of_columns: Vec<Joule>,
}

/// Flat index of a cell in the layers: the layer, and the cell in it.
type Place = usize;

impl PlasticBody {
    /// Creates an unloaded body without plastic strain.
    pub fn new(volume: Volume, law: J2) -> Self {
        let zeros = || volume.zeros();
        let shape = [volume.layers().count(), volume.grid().shape[0], volume.grid().shape[1]];
        Self {
            state: PlasticState {
                strain: zeros(),
                accumulated: VolumeField::zeros(shape),
                back_stress: law.is_kinematic().then(zeros),
            },
            action: None,
            stress: zeros(),
            displacement: SurfaceDisplacement { inward: volume.grid().zeros(), along: None },
            increment: Vec::new(),
            trial: Trial {
                predictor: zeros(),
                strain: zeros(),
                stress: zeros(),
                flows: ndarray::Array3::from_elem(shape, false),
            },
            volume,
            law,
        }
    }

    /// Follows the tangential displacement of the surface, too, as friction requires.
    pub fn followed_along(mut self) -> Self {
        let zeros = || self.volume.grid().zeros();
        self.displacement.along = Some([zeros(), zeros()]);
        self
    }

    /// The present plastic state.
    pub fn state(&self) -> &PlasticState {
        &self.state
    }

    /// Restores a plastic `state` of the unloaded body. The result has the same bits for any history. Cost:
    /// one operator application.
    ///
    /// # Panics
    /// If the state belongs to another volume or law.
    pub fn restore(&mut self, state: &PlasticState) {
        assert_eq!(state.strain.dim(), self.state.strain.dim(), "shape of the strain");
        assert_eq!(state.back_stress.is_some(), self.law.is_kinematic(), "back stress of the law");
        self.state.strain.assign(&state.strain);
        self.state.accumulated.assign(&state.accumulated);
        if let (Some(back), Some(known)) = (&mut self.state.back_stress, &state.back_stress) {
            back.assign(known);
        }
        self.volume.take(&self.state.strain);
        self.displacement = self.surface();
        self.volume.stress(None, &mut self.stress);
        self.action = Some(Action::Tractions(Tractions::frictionless(self.volume.grid().zeros())));
        self.increment.clear();
    }

    /// Computes the displacement of the surface by the strain stored in the volume.
    fn surface(&mut self) -> SurfaceDisplacement {
        let inward = self.volume.surface(Traction::Pressure);
        let follows = self.displacement.along.is_some();
        let along = follows.then(|| [Traction::X, Traction::Y].map(|traction| self.volume.surface(traction)));
        SurfaceDisplacement { inward, along }
    }

    /// The volume and its operators.
    pub fn volume(&mut self) -> &mut Volume {
        &mut self.volume
    }

    /// The flow law.
    pub fn law(&self) -> &J2 {
        &self.law
    }

    /// Plastic strain ε.
    pub fn strain(&self) -> &TensorField {
        &self.state.strain
    }

    /// Accumulated plastic strain p̄.
    pub fn accumulated(&self) -> &VolumeField {
        &self.state.accumulated
    }

    /// Back stress X, Pa, if the law has one.
    pub fn back_stress(&self) -> Option<&TensorField> {
        self.state.back_stress.as_ref()
    }

    /// Stress under the present loading and plastic strain, Pa.
    pub fn stress(&self) -> &TensorField {
        &self.stress
    }

    /// Inward displacement r of the surface by the plastic strain, m.
    pub fn displacement(&self) -> &Field {
        &self.displacement.inward
    }

    /// Computes the residual stress of the plastic strain alone, Pa, by one operator application.
    pub fn residual_stress(&mut self) -> TensorField {
        self.volume.residual(&self.state.strain)
    }

    /// Computes the stored energy −½ ∫ ε : K ε ≥ 0 of the residual stress, J, by one operator application.
    pub fn stored_energy(&mut self) -> Joule {
        let residual = self.residual_stress();
        -0.5 * self.volume.inner_product(&residual, &self.state.strain)
    }

    /// Volume of the cells that have flowed at any time, m³.
    pub fn yielded_volume(&self) -> CubicMetre {
        let layers = self.state.accumulated.outer_iter().enumerate();
        let cells = |layer: ndarray::ArrayView2<f64>| layer.iter().filter(|p| **p > 0.0).count() as f64;
        let height: f64 = layers.map(|(n, layer)| self.volume.layers().thickness(n) * cells(layer)).sum();
        self.volume.grid().cell_area() * height
    }

    /// κ = 2μθ, as in the predictor y = dev σ + κ ε.
    fn stiffness(&self) -> Pascal {
        let material = self.volume.material();
        RELAXATION * material.young / (1.0 + material.poisson)
    }

    // ---- an increment, step by step ----------------------------------------------------------------------

    /// Surface displacement before the increment.
    pub(super) fn displacement_before(&self) -> SurfaceDisplacement {
        self.displacement.clone()
    }

    /// Computes the predictor without further flow under an `action`. Returns whether that took an operator
    /// application.
    pub(super) fn predict_elastic(&mut self, action: &Action) -> bool {
        let product = match (self.action.as_ref(), action) {
            (None, Action::Tractions(now)) if self.increment.is_empty() && self.is_virgin() => {
                self.volume.reset();
                self.volume.stress(Some(now), &mut self.trial.stress);
                false
            }
            (Some(Action::Tractions(before)), Action::Tractions(now)) => {
                let change = difference(now, before);
                self.volume.reset();
                self.volume.stress(Some(&change), &mut self.trial.stress);
                self.trial.stress += &self.stress;
                false
            }
            (Some(Action::Stress(before)), Action::Stress(now)) => {
                self.trial.stress.assign(&self.stress);
                self.trial.stress += &**now;
                self.trial.stress -= &**before;
                false
            }
            _ => {
                self.volume.take(&self.state.strain);
                self.respond(action);
                true
            }
        };
        self.trial.strain.assign(&self.state.strain);
        self.predict();
        product
    }

    fn is_virgin(&self) -> bool {
        self.state.accumulated.iter().all(|p| *p == 0.0)
    }

    /// Whether the body flowed in the last increment.
    pub(super) fn has_yielded(&self) -> bool {
        !self.increment.is_empty()
    }

    /// Adds the strain of the last increment once more, shifted with the load by this number of cells.
    /// Returns whether there was any.
    pub(super) fn guess(&mut self, shift: [isize; 2]) -> bool {
        let [nx, ny] = self.volume.grid().shape;
        let wraps = self.volume.boundary().leaves_mean_free();
        self.trial.strain.assign(&self.state.strain);
        let mut any = false;
        for (place, increment) in &self.increment {
            let (layer, cell) = (place / (nx * ny), place % (nx * ny));
            let at = |index: usize, n: usize, by: isize| {
                let moved = index as isize + by;
                let n = n as isize;
                if wraps {
                    Some(moved.rem_euclid(n) as usize)
                } else {
                    (0..n).contains(&moved).then_some(moved as usize)
                }
            };
            let (Some(ix), Some(iy)) = (at(cell / ny, nx, shift[0]), at(cell % ny, ny, shift[1])) else {
                continue;
            };
            any = true;
            (0..COMPONENTS).for_each(|c| self.trial.strain[[layer, c, ix, iy]] += increment[c]);
        }
        any
    }

    /// Stores the trial strain in the volume, and returns its surface displacement.
    pub(super) fn take_trial(&mut self) -> SurfaceDisplacement {
        self.volume.take(&self.trial.strain);
        self.surface()
    }

    /// Computes the stress of the stored strain under an `action`.
    pub(super) fn respond(&mut self, action: &Action) {
        match action {
            Action::Tractions(tractions) => self.volume.stress(Some(tractions), &mut self.trial.stress),
            Action::Stress(stress) => {
                self.volume.stress(None, &mut self.trial.stress);
                self.trial.stress += &**stress;
            }
        }
    }

    /// Computes the predictor from the trial stress and strain.
    pub(super) fn predict(&mut self) {
        let stiffness = self.stiffness();
        let Trial { predictor, strain, stress, .. } = &mut self.trial;
        let layers = layers_mut(predictor).zip(layers(stress)).zip(layers(strain));
        parallel::tasks(layers, |((y, stress), strain)| {
            each_cell(stress, strain, stiffness, |cell, cells, g| {
                (0..COMPONENTS).for_each(|c| y[c * cells + cell] = g[c]);
            });
        });
    }

    /// Computes the strain from the predictor. Returns its distance from `start`, as a stress over the yield
    /// stress.
    pub(super) fn flow(&mut self, start: Start) -> f64 {
        let stiffness = self.stiffness();
        let cells = self.cells();
        let Self { law, state, trial, .. } = self;
        let Trial { predictor, strain: trial, flows, .. } = trial;
        let yields = law.yield_stress();
        let layers =
            layers_mut(trial).zip(flows.as_slice_mut().expect("standard layout").chunks_exact_mut(cells));
        let moved = parallel::tasks(layers.enumerate(), |(layer, (trial, flows))| {
            let before = PreviousStates::new(layer, state);
            let y = layer_of(predictor, layer);
            let mut moved = 0.0f64;
            for (cell, flows) in flows.iter_mut().enumerate() {
                let state = before.at(cell);
                let y = tensor(y, cell, cells);
                let next = law.flow(&y, stiffness, &state);
                *flows = next.is_some();
                let next = next.map_or(state.strain, |next| next.strain);
                for c in 0..COMPONENTS {
                    let from = match start {
                        Start::PreviousStates => state.strain[c],
                        Start::Trial => trial[c * cells + cell],
                    };
                    moved = moved.max((next[c] - from).abs());
                    trial[c * cells + cell] = next[c];
                }
            }
            moved
        });
        stiffness * moved.into_iter().fold(0.0, f64::max) / yields
    }

    /// Return-mapping residual: the largest difference between the predictor and the one from the trial
    /// stress and strain, over the yield stress.
    pub(super) fn mismatch(&self) -> f64 {
        let stiffness = self.stiffness();
        let Trial { predictor, strain, stress, .. } = &self.trial;
        let layers = layers(predictor).zip(layers(stress)).zip(layers(strain));
        let largest = parallel::tasks(layers, |((y, stress), strain)| {
            let mut largest = 0.0f64;
            each_cell(stress, strain, stiffness, |cell, cells, g| {
                for c in 0..COMPONENTS {
                    let f = (g[c] - y[c * cells + cell]).abs();
                    largest = if f > largest || f.is_nan() { f } else { largest };
                }
            });
            largest
        });
        let largest = largest.into_iter().fold(0.0, |a, b| if a > b || a.is_nan() { a } else { b });
        largest / self.law.yield_stress()
    }

    /// Returns the places that may flow in this increment.
    pub(super) fn candidates(&self) -> Vec<Place> {
        let (cells, stiffness) = (self.cells(), self.stiffness());
        let least = MAY_YIELD * self.law.yield_stress();
        let per_layer = parallel::tasks(0..self.volume.layers().count(), |layer| {
            let before = PreviousStates::new(layer, &self.state);
            let y = layer_of(&self.trial.predictor, layer);
            let may = |cell: usize| {
                let (y, state) = (tensor(y, cell, cells), before.at(cell));
                let xi: Tensor = std::array::from_fn(|c| y[c] - stiffness * state.strain[c] - state.back[c]);
                equivalent(&xi) > least
            };
            (0..cells).filter(|cell| may(*cell)).map(|cell| layer * cells + cell).collect::<Vec<Place>>()
        });
        per_layer.concat()
    }

    /// Gathers the predictor at some places, and its residual.
    pub(super) fn gather(&self, places: &[Place]) -> [Vec<f64>; 2] {
        let (cells, stiffness) = (self.cells(), self.stiffness());
        let Trial { predictor, strain, stress, .. } = &self.trial;
        let mut gathered =
            [Vec::with_capacity(COMPONENTS * places.len()), Vec::with_capacity(COMPONENTS * places.len())];
        for place in places {
            let (layer, cell) = (place / cells, place % cells);
            let at = |field: &TensorField| tensor(layer_of(field, layer), cell, cells);
            let (y, g) = (at(predictor), response(&at(stress), &at(strain), stiffness));
            gathered[0].extend(y);
            gathered[1].extend((0..COMPONENTS).map(|c| g[c] - y[c]));
        }
        gathered
    }

    /// Returns the gathered entries that belong to flowing cells.
    pub(super) fn yielding_entries(&self, places: &[Place]) -> impl Iterator<Item = usize> {
        let flows = self.trial.flows.as_slice().expect("standard layout");
        let flowing = places.iter().enumerate().filter(|(_, place)| flows[**place]);
        flowing.flat_map(|(n, _)| COMPONENTS * n..COMPONENTS * (n + 1))
    }

    /// Scatters `values` to the predictor at some places.
    pub(super) fn scatter(&mut self, places: &[Place], values: &[f64]) {
        let cells = self.cells();
        let predictor = self.trial.predictor.as_slice_mut().expect("standard layout");
        for (place, value) in places.iter().zip(values.chunks_exact(COMPONENTS)) {
            let (layer, cell) = (place / cells, place % cells);
            (0..COMPONENTS).for_each(|c| predictor[(layer * COMPONENTS + c) * cells + cell] = value[c]);
        }
    }

    /// Ends the increment: the trial becomes the state of the body under an `action`.
    pub(super) fn commit(&mut self, action: Action, displacement: SurfaceDisplacement) -> BodyIncrement {
        let (cells, stiffness) = (self.cells(), self.stiffness());
        let [columns, width] = self.volume.grid().shape;
        let mut flow =
            BodyIncrement { yielding_cells: 0, plastic_work: 0.0, work_of_columns: vec![0.0; columns] };
        self.increment.clear();
        for layer in 0..self.volume.layers().count() {
            let volume = self.volume.grid().cell_area() * self.volume.layers().thickness(layer);
            for cell in 0..cells {
                if !self.trial.flows.as_slice().expect("standard layout")[layer * cells + cell] {
                    continue;
                }
                let state = PreviousStates::new(layer, &self.state).at(cell);
                let y = tensor(layer_of(&self.trial.predictor, layer), cell, cells);
                let Some(next) = self.law.flow(&y, stiffness, &state) else { continue };
                let change = std::array::from_fn(|c| next.strain[c] - state.strain[c]);
                let before = tensor(layer_of(&self.stress, layer), cell, cells);
                let after = tensor(layer_of(&self.trial.stress, layer), cell, cells);
                let work = 0.5 * volume * (contract(&before, &change) + contract(&after, &change));
                let at = [cell / width, cell % width];
                flow.plastic_work += work;
                flow.work_of_columns[at[0]] += work;
                flow.yielding_cells += 1;
                self.increment.push((layer * cells + cell, change));
                let PlasticState { strain, accumulated, back_stress } = &mut self.state;
                accumulated[[layer, at[0], at[1]]] = next.accumulated;
                for c in 0..COMPONENTS {
                    strain[[layer, c, at[0], at[1]]] = next.strain[c];
                    if let Some(back) = back_stress {
                        back[[layer, c, at[0], at[1]]] = next.back[c];
                    }
                }
            }
        }
        std::mem::swap(&mut self.stress, &mut self.trial.stress);
        self.action = Some(action);
        self.displacement = displacement;
        flow
    }

    /// Number of cells of a layer.
    fn cells(&self) -> usize {
        self.volume.grid().cells()
    }

    /// Returns the largest accumulated plastic strain, with its layer and cell.
    pub fn max_accumulated(&self) -> (f64, [usize; 3]) {
        let mut largest = (0.0, [0; 3]);
        for ((layer, ix, iy), value) in self.state.accumulated.indexed_iter() {
            if *value > largest.0 {
                largest = (*value, [layer, ix, iy]);
            }
        }
        largest
    }

    /// Shear of the layers of the body: the mean of 2 ε_xz over the cells of each.
    pub fn mean_shear(&self) -> Vec<f64> {
        self.state
            .strain
            .outer_iter()
            .map(|layer| 2.0 * layer.slice(s![4, .., ..]).mean().unwrap_or(0.0))
            .collect()
    }
}

/// Reference of a change in strain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Start {
    /// The strain before the increment.
    PreviousStates,
    /// The trial strain.
    Trial,
}

/// States of the cells of a layer before an increment.
struct PreviousStates<'a> {
    strain: &'a [f64],
    accumulated: &'a [f64],
    back: Option<&'a [f64]>,
}

impl<'a> PreviousStates<'a> {
    fn new(layer: usize, state: &'a PlasticState) -> Self {
        let PlasticState { strain, accumulated, back_stress } = state;
        let cells = accumulated.shape()[1] * accumulated.shape()[2];
        let accumulated = accumulated.as_slice().expect("standard layout");
        Self {
            strain: layer_of(strain, layer),
            accumulated: &accumulated[layer * cells..][..cells],
            back: back_stress.as_ref().map(|back| layer_of(back, layer)),
        }
    }

    #[inline]
    fn at(&self, cell: usize) -> CellState {
        let cells = self.accumulated.len();
        CellState {
            strain: tensor(self.strain, cell, cells),
            accumulated: self.accumulated[cell],
            back: self.back.map_or([0.0; 6], |back| tensor(back, cell, cells)),
        }
    }
}

#[inline]
fn tensor(layer: &[f64], cell: usize, cells: usize) -> Tensor {
    std::array::from_fn(|c| layer[c * cells + cell])
}

fn layer_of(field: &TensorField, layer: usize) -> &[f64] {
    let length = field.len() / field.shape()[0];
    &field.as_slice().expect("standard layout")[layer * length..][..length]
}

fn layers(field: &TensorField) -> ChunksExact<'_, f64> {
    let length = field.len() / field.shape()[0];
    field.as_slice().expect("standard layout").chunks_exact(length)
}

fn layers_mut(field: &mut TensorField) -> ChunksExactMut<'_, f64> {
    let length = field.len() / field.shape()[0];
    field.as_slice_mut().expect("standard layout").chunks_exact_mut(length)
}

/// g = dev σ + κ ε.
#[inline]
fn response(stress: &Tensor, strain: &Tensor, stiffness: Pascal) -> Tensor {
    let mean = (stress[0] + stress[1] + stress[2]) / 3.0;
    std::array::from_fn(|c| stress[c] - if c < 3 { mean } else { 0.0 } + stiffness * strain[c])
}

/// Calls `look` for each cell of a layer, with its index, the number of cells in the layer, and g.
fn each_cell(stress: &[f64], strain: &[f64], stiffness: Pascal, mut look: impl FnMut(usize, usize, Tensor)) {
    let cells = stress.len() / COMPONENTS;
    for cell in 0..cells {
        look(cell, cells, response(&tensor(stress, cell, cells), &tensor(strain, cell, cells), stiffness));
    }
}

fn difference(now: &Tractions, before: &Tractions) -> Tractions {
    let shear = [0, 1].map(|axis| match (&now.shear[axis], &before.shear[axis]) {
        (Some(now), Some(before)) => Some(now - before),
        (Some(now), None) => Some(now.clone()),
        (None, Some(before)) => Some(-before),
        (None, None) => None,
    });
    Tractions { pressure: &now.pressure - &before.pressure, shear }
}

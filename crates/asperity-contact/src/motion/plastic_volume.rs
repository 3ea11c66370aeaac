//! Plastic state below the surfaces of elasto-plastic bodies.

use crate::grid::{Field, Grid};
use crate::motion::pair::Pair;
use crate::motion::record::{
    IncrementRecord, PassPlasticRecord, PassRecord, PlasticRecord, PlasticStepRecord, Regime, StepRecord,
};
use crate::motion::regime;
use crate::plasticity::{Increment, PlasticBody, PlasticContact, PlasticState, TensorField};
use crate::stress::{Component, Stress};
use crate::units::{CubicMetre, Joule, Metre, Pascal};

/// Plastic state below the surface of a body.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct PlasticVolume {
    /// The body: 0 the lower, 1 the upper one.
    pub body: usize,
    /// Grid of the surface.
    pub grid: Grid,
    /// Depths of the faces of the layers, from 0 at the surface.
    pub faces: Vec<Metre>,
    /// Plastic strain, `[layer, component, ix, iy]`, and the rest of the plastic state.
    pub state: PlasticState,
    /// Residual stress K ε, Pa.
    pub residual_stress: TensorField,
    /// Inward displacement r of the surface, m.
    pub displacement: Field,
    /// Largest accumulated plastic strain and its place: x and y from the corner of the body, z from its
    /// surface.
    pub max_strain: (f64, [Metre; 3]),
    /// Volume that has yielded.
    pub yielded_volume: CubicMetre,
    /// Energy stored in the residual stress, −½ ∫ ε : K ε.
    pub stored_energy: Joule,
}

/// Plastic state below the surfaces of a static contact.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct PlasticResult {
    /// The plastic state of each elasto-plastic body under the last load.
    pub volumes: Vec<PlasticVolume>,
    /// The plastic state after unloading; empty if the load stays.
    pub residual: Vec<PlasticVolume>,
}

impl PlasticResult {
    /// Returns a `pair` with its surfaces displaced by the plastic strain under the last load.
    pub fn displaced(&self, pair: Pair) -> Pair {
        displaced(pair, &self.volumes, 1.0)
    }
}

/// Results of a pass of elasto-plastic bodies.
pub(super) struct ElastoPlasticPass {
    /// The plastic state after unloading.
    pub(super) volumes: Vec<PlasticVolume>,
    /// The records of the positions.
    pub(super) steps: Vec<PlasticStepRecord>,
    /// The record of the pass.
    pub(super) record: PassPlasticRecord,
    /// The plastic state under the load at the selected position; empty if none is selected.
    pub(super) states_under_load: Vec<PlasticState>,
}

impl PlasticVolume {
    /// Returns the volumes of the bodies of a contact under its load.
    pub(super) fn loaded(contact: &mut PlasticContact) -> Vec<Self> {
        let sides = contact.sides().to_vec();
        let of = |(body, side): (&mut PlasticBody, usize)| {
            let residual_stress = body.residual_stress();
            Self::of(body, side, residual_stress)
        };
        contact.bodies().iter_mut().zip(sides).map(of).collect()
    }

    /// Returns the volumes of the bodies of an unloaded contact, whose stress is the residual stress.
    pub(super) fn unloaded(contact: &mut PlasticContact) -> Vec<Self> {
        let sides = contact.sides().to_vec();
        let of = |(body, side): (&mut PlasticBody, usize)| {
            let residual_stress = body.stress().clone();
            Self::of(body, side, residual_stress)
        };
        contact.bodies().iter_mut().zip(sides).map(of).collect()
    }

    fn of(body: &mut PlasticBody, side: usize, residual_stress: TensorField) -> Self {
        let (state, displacement) = (body.state().clone(), body.displacement().clone());
        let (yielded_volume, (strain, [layer, ix, iy])) = (body.yielded_volume(), body.max_accumulated());
        let volume = body.volume();
        let (grid, layers) = (*volume.grid(), volume.layers());
        Self {
            body: side,
            grid,
            faces: layers.faces().to_vec(),
            max_strain: (strain, [grid.centre(0, ix), grid.centre(1, iy), layers.centre(layer)]),
            yielded_volume,
            stored_energy: -0.5 * volume.inner_product(&residual_stress, &state.strain),
            state,
            residual_stress,
            displacement,
        }
    }

    /// Largest principal value of the residual stress.
    fn max_tension(&self) -> Pascal {
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

    /// Range of the surface displacement.
    fn range(&self) -> Metre {
        let (least, most) = self
            .displacement
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), r| (r.min(least), r.max(most)));
        most - least
    }

    /// Displacement of the surface along +x relative to the deep material, as the mean over the grid: −∫ 2
    /// ε_xz dz.
    fn shift(&self, strain: &TensorField) -> Metre {
        let shear = strain.index_axis(ndarray::Axis(1), Component::Xz as usize);
        let layers = shear.outer_iter().zip(self.faces.windows(2));
        -layers.map(|(shear, faces)| 2.0 * (faces[1] - faces[0]) * shear.mean().unwrap_or(0.0)).sum::<f64>()
    }

    /// Net strain since the state `before` over the strain accumulated since then: ∫ √(⅔ Δε:Δε) over ∫ Δp̄.
    fn net_strain(&self, before: &PlasticState) -> f64 {
        let [mut net, mut all] = [0.0; 2];
        for layer in 0..self.faces.len() - 1 {
            let [now, then] =
                [&self.state, before].map(|state| state.strain.index_axis(ndarray::Axis(0), layer));
            let grown = &self.state.accumulated.index_axis(ndarray::Axis(0), layer)
                - &before.accumulated.index_axis(ndarray::Axis(0), layer);
            let change = &now - &then;
            let cells = change.lanes(ndarray::Axis(0)).into_iter().map(|change| {
                let [xx, yy, zz, yz, xz, xy] = std::array::from_fn(|component| change[component]);
                let square = xx * xx + yy * yy + zz * zz + 2.0 * (yz * yz + xz * xz + xy * xy);
                (square / 1.5).sqrt()
            });
            let thickness = self.faces[layer + 1] - self.faces[layer];
            net += thickness * cells.sum::<f64>();
            all += thickness * grown.sum();
        }
        if all > 0.0 { net / all } else { 0.0 }
    }
}

/// Returns a `pair` with its surfaces displaced by the plastic strain; with `sign` −1 the displacement is
/// removed.
pub(super) fn displaced(mut pair: Pair, volumes: &[PlasticVolume], sign: f64) -> Pair {
    volumes.iter().for_each(|volume| displace(&mut pair, volume.body, &volume.displacement, sign));
    pair
}

/// Moves the surface of a body by `sign` times an inward displacement.
pub(super) fn displace(pair: &mut Pair, body: usize, inward: &Field, sign: f64) {
    match body {
        0 => pair.lower.heights.scaled_add(-sign, inward),
        _ => pair.upper.heights.scaled_add(sign, inward),
    }
}

/// Sums over increments.
#[derive(Default)]
pub(super) struct PlasticSums {
    pub(super) products: usize,
    /// The largest return-mapping residual.
    pub(super) mismatch: f64,
    pub(super) plastic_work: Joule,
}

impl PlasticSums {
    pub(super) fn add(&mut self, increment: &Increment) {
        self.products += increment.products;
        self.mismatch = self.mismatch.max(increment.mismatch);
        self.plastic_work += increment.plastic_work();
    }
}

impl PlasticStepRecord {
    /// Sums the `increments` of a step that ends with the bodies of a `contact`.
    pub(super) fn from_increments(increments: &[Increment], contact: &mut PlasticContact) -> Self {
        let mut sums = PlasticSums::default();
        increments.iter().for_each(|increment| sums.add(increment));
        Self {
            yielded_cells: increments.iter().map(Increment::yielding_cells).max().unwrap_or(0),
            max_plastic_strain: contact
                .bodies()
                .iter()
                .map(|body| body.max_accumulated().0)
                .fold(0.0, f64::max),
            plastic_work: sums.plastic_work,
            products: sums.products,
            mismatch: sums.mismatch,
        }
    }
}

impl PlasticStepRecord {
    /// Sums the flow of all `increments` of a loading; `None` if none has any.
    pub(super) fn up_to_last(increments: &[IncrementRecord]) -> Option<Self> {
        let flow = increments.iter().filter_map(|increment| increment.plastic);
        flow.reduce(|sum, more| Self {
            yielded_cells: sum.yielded_cells.max(more.yielded_cells),
            max_plastic_strain: sum.max_plastic_strain.max(more.max_plastic_strain),
            plastic_work: sum.plastic_work + more.plastic_work,
            products: sum.products + more.products,
            mismatch: sum.mismatch.max(more.mismatch),
        })
    }
}

impl PlasticRecord {
    /// Returns the record of these volumes and of the increments with these sums.
    pub(super) fn new(volumes: &[PlasticVolume], sums: &PlasticSums) -> Self {
        let (max_plastic_strain, max_plastic_strain_position) = volumes
            .iter()
            .map(|volume| volume.max_strain)
            .max_by(|(a, _), (b, _)| a.total_cmp(b))
            .unwrap_or((0.0, [0.0; 3]));
        let displaced = |volume: &PlasticVolume| {
            volume.grid.cell_area() * volume.displacement.iter().map(|r| r.max(0.0)).sum::<f64>()
        };
        Self {
            max_plastic_strain,
            max_plastic_strain_position,
            yielded_volume: volumes.iter().map(|volume| volume.yielded_volume).sum(),
            plastic_work: sums.plastic_work,
            stored_energy: volumes.iter().map(|volume| volume.stored_energy).sum(),
            displaced_volume: volumes.iter().map(displaced).sum(),
            max_residual_tension: volumes.iter().map(PlasticVolume::max_tension).fold(0.0, f64::max),
            residual_displacement: volumes.iter().map(PlasticVolume::range).fold(0.0, f64::max),
            products: sums.products,
            mismatch: sums.mismatch,
            regime: if max_plastic_strain > 0.0 { Regime::Yields } else { Regime::Elastic },
            strain_per_pass: None,
            shift_per_pass: None,
            residual: None,
        }
    }
}

impl PlasticRecord {
    /// Returns the record of the residual state after a motion with these positions and passes.
    pub fn of_passes(left: &[PlasticVolume], steps: &[StepRecord], passes: &[PassRecord]) -> Self {
        let steps = steps.iter().filter_map(|step| step.plastic);
        let passes: Vec<PassPlasticRecord> = passes.iter().filter_map(|pass| pass.plastic).collect();
        let mut sums = PlasticSums::default();
        for step in steps {
            sums.products += step.products;
            sums.mismatch = sums.mismatch.max(step.mismatch);
        }
        sums.plastic_work = passes.iter().map(|pass| pass.plastic_work_lower + pass.plastic_work_upper).sum();
        let regime = Regime::from_passes(&passes);
        let (strain_per_pass, shift_per_pass) =
            regime::rates(&passes).filter(|_| regime == Regime::Ratchets).unzip();
        Self { regime, strain_per_pass, shift_per_pass, ..Self::new(left, &sums) }
    }
}

impl PassPlasticRecord {
    /// Returns the record of a pass from the states `before` to these volumes. Plastic work is given in the
    /// lower and in the upper body, and under the outer columns of the overlap.
    pub(super) fn new(
        volumes: &[PlasticVolume],
        before: &[PlasticState],
        [plastic_work_lower, plastic_work_upper]: [Joule; 2],
        plastic_work_rim: Joule,
    ) -> Self {
        let of = |body: usize, value: &dyn Fn(&PlasticVolume, &PlasticState) -> f64| {
            let mut all = volumes.iter().zip(before);
            all.find(|(volume, _)| volume.body == body).map_or(0.0, |(volume, before)| value(volume, before))
        };
        let both = |value: &dyn Fn(&PlasticVolume, &PlasticState) -> f64| [0, 1].map(|body| of(body, value));
        let [max_plastic_strain_lower, max_plastic_strain_upper] = both(&|volume, _| volume.max_strain.0);
        let [surface_shift_lower, surface_shift_upper] =
            both(&|volume, before| volume.shift(&volume.state.strain) - volume.shift(&before.strain));
        let [residual_displacement_lower, residual_displacement_upper] = both(&|volume, _| volume.range());
        let [net_strain_lower, net_strain_upper] = both(&|volume, before| volume.net_strain(before));
        Self {
            max_plastic_strain_lower,
            max_plastic_strain_upper,
            plastic_work_lower,
            plastic_work_upper,
            plastic_work_rim,
            surface_shift_lower,
            surface_shift_upper,
            residual_displacement_lower,
            residual_displacement_upper,
            net_strain_lower,
            net_strain_upper,
        }
    }
}

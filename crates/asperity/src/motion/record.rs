//! The rows that a computation reports: one per static contact, per position, per pass.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::motion::regime::Regime;
use crate::units::{
    CubicMetre, Joule, Kelvin, Metre, Newton, NewtonPerMetre, Pascal, Second, SquareMetre, Watt,
};

/// A static contact in numbers: `static` in `summary.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct StaticRecord {
    /// Total normal force W.
    pub load: Newton,
    /// Rigid-body approach δ.
    pub approach: Metre,
    /// Area of the cells with p > 0.
    pub contact_area: SquareMetre,
    /// Area of the whole grid.
    pub apparent_area: SquareMetre,
    /// Largest pressure.
    pub max_pressure: Pascal,
    /// Mean deformed gap.
    pub mean_gap: Metre,
    /// Elastic energy ½ ΔA Σ p u.
    pub elastic_energy: Joule,
    /// Number of cells at the hardness, under shear at their caps.
    pub plastic_cells: usize,
    /// Plastic volume ΔA Σ w, w the plastic interference that the cells have taken up in the course of the loading.
    pub plastic_volume: CubicMetre,
    /// Iterations of the solver.
    pub iterations: usize,
    /// Convolutions, those on coarse grids counted by their cost.
    pub convolutions: f64,
    /// Scale-free complementarity residual η.
    pub residual: f64,
    /// The tangential quantities; none without friction.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub shear: Option<ShearRecord>,
    /// What has flowed below the surfaces; none of bodies that do not.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub flow: Option<FlowRecord>,
}

/// A static contact of bodies that flow below their surfaces: what its loading has left in both of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct FlowRecord {
    /// Largest accumulated plastic strain.
    pub max_plastic_strain: f64,
    /// Where it is: x and y from the corner of the body, z from its surface.
    pub max_plastic_strain_position: [Metre; 3],
    /// Volume that has flowed.
    pub yielded_volume: CubicMetre,
    /// Plastic work ∫ σ : dε.
    pub plastic_work: Joule,
    /// Energy stored in the residual stress, −½ ∫ ε : K ε.
    pub stored_energy: Joule,
    /// Volume that the surfaces have been displaced inward by, ΔA Σ max(r, 0).
    pub displaced_volume: CubicMetre,
    /// Largest principal stress of the residual stress, in tension.
    pub max_residual_tension: Pascal,
    /// Range of the inward displacement r of a surface by the plastic strain: its largest less its least value.
    pub residual_displacement: Metre,
    /// Products: applications of the operator of the residual stress.
    pub products: usize,
    /// Largest mismatch of the stress over the yield stress that an increment has ended with.
    pub mismatch: f64,
    /// What becomes of the bodies.
    pub regime: Regime,
    /// Where the bodies ratchet, by how much the largest plastic strain grows in a pass; none elsewhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strain_per_pass: Option<f64>,
    /// Where the bodies ratchet, by how much the surface moves along x in a pass, that of the body where it moves more; none elsewhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shift_per_pass: Option<Metre>,
    /// What is left once the load is taken off; none where it is not.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub residual: Option<ResidualRecord>,
}

impl FlowRecord {
    /// What is left, where the load has been taken off.
    pub(super) fn into_residual(self) -> ResidualRecord {
        ResidualRecord {
            residual_max_plastic_strain: self.max_plastic_strain,
            residual_yielded_volume: self.yielded_volume,
            residual_plastic_work: self.plastic_work,
            residual_stored_energy: self.stored_energy,
            residual_displaced_volume: self.displaced_volume,
            residual_max_residual_tension: self.max_residual_tension,
            residual_residual_displacement: self.residual_displacement,
        }
    }
}

/// What a contact of bodies that flow leaves in them once its load is taken off.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ResidualRecord {
    /// As [`FlowRecord::max_plastic_strain`].
    pub residual_max_plastic_strain: f64,
    /// As [`FlowRecord::yielded_volume`].
    pub residual_yielded_volume: CubicMetre,
    /// As [`FlowRecord::plastic_work`].
    pub residual_plastic_work: Joule,
    /// As [`FlowRecord::stored_energy`].
    pub residual_stored_energy: Joule,
    /// As [`FlowRecord::displaced_volume`].
    pub residual_displaced_volume: CubicMetre,
    /// As [`FlowRecord::max_residual_tension`].
    pub residual_max_residual_tension: Pascal,
    /// As [`FlowRecord::residual_displacement`].
    pub residual_residual_displacement: Metre,
}

/// What has flowed below the surfaces in a pass: further columns of its row. 0 of a body that may not flow.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct PassFlowRecord {
    /// Largest accumulated plastic strain of the lower body after the pass.
    pub max_plastic_strain_lower: f64,
    /// Largest accumulated plastic strain of the upper body after the pass.
    pub max_plastic_strain_upper: f64,
    /// Plastic work in the lower body in the pass.
    pub plastic_work_lower: Joule,
    /// Plastic work in the upper body in the pass.
    pub plastic_work_upper: Joule,
    /// The part of the plastic work under the two columns at either end of what faces, along a boundary that is free.
    pub plastic_work_rim: Joule,
    /// By how much the surface of the lower body has moved along +x against its depths in the pass, in the mean over it.
    pub surface_shift_lower: Metre,
    /// By how much the surface of the upper body has moved along +x against its depths in the pass, in the mean over it.
    pub surface_shift_upper: Metre,
    /// Range of the inward displacement r of the lower surface by the plastic strain after the pass.
    pub residual_displacement_lower: Metre,
    /// Range of the inward displacement r of the upper surface by the plastic strain after the pass.
    pub residual_displacement_upper: Metre,
    /// Net strain of the lower body in the pass over what has accumulated in it, ∫ √(⅔ Δε:Δε) over ∫ Δp̄: 1 where each cell flows one
    /// way, 0 where flow comes and goes.
    pub net_strain_lower: f64,
    /// The same of the upper body.
    pub net_strain_upper: f64,
}

/// What has flowed below the surfaces in a step: further columns of its row.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct FlowStepRecord {
    /// Cells of all layers of both bodies that have flowed in it.
    pub yielded_cells: usize,
    /// Largest accumulated plastic strain at its end.
    pub max_plastic_strain: f64,
    /// Plastic work in it.
    pub plastic_work: Joule,
    /// Products: applications of the operator of the residual stress.
    pub products: usize,
    /// Mismatch of the stress over the yield stress.
    pub mismatch: f64,
}

/// A static contact with friction: its tangential quantities.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ShearRecord {
    /// Force of the upper body on the lower one, along x and y.
    pub tangential_force: [Newton; 2],
    /// The magnitude of the tangential force over the load; 0 without load.
    pub force_ratio: f64,
    /// The magnitude of the tangential force over the load where no cell sticks: the coefficient of the contact as a
    /// whole.
    pub friction_coefficient: Option<f64>,
    /// Rigid-body displacement of the upper body against the lower one, along x and y; 0 in sliding.
    pub tangential_displacement: [Metre; 2],
    /// Area of the cells that stick.
    pub stick_area: SquareMetre,
    /// Largest shear traction.
    pub max_shear: Pascal,
    /// Energy that friction took; in rolling, while the contact moves on by a cell, see
    /// [`RollingSolution::dissipation`](crate::solver::RollingSolution::dissipation).
    pub dissipation: Joule,
    /// Work of the shear on the slip of the cells while the contact moves on by a cell, see
    /// [`RollingSolution::slip_work`](crate::solver::RollingSolution::slip_work); in rolling.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slip_work: Option<Joule>,
    /// Velocity of the upper body against the lower one over the rolling velocity, along x and y.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub creepage: Option<[f64; 2]>,
    /// Angular velocity of the upper body against the lower one over the rolling velocity, 1/m; in rolling.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spin: Option<f64>,
    /// Moment of the upper body on the lower one about z through the middle of the grid, N·m; in rolling.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moment: Option<f64>,
}

/// One increment of the loading of a static contact: a row of `increments.csv`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct IncrementRecord {
    /// Increment, from 1.
    pub increment: usize,
    /// Stage of the loading that it belongs to, from 1.
    pub stage: usize,
    /// Normal force.
    pub load: Newton,
    /// Rigid-body approach δ; NaN of elasto-plastic bodies that are apart.
    #[serde(deserialize_with = "number_or_none")]
    pub approach: Metre,
    /// Force of the upper body on the lower one along x.
    pub tangential_force_x: Newton,
    /// Force of the upper body on the lower one along y.
    pub tangential_force_y: Newton,
    /// Rigid-body displacement of the upper body along x; 0 in sliding.
    pub tangential_displacement_x: Metre,
    /// Rigid-body displacement of the upper body along y; 0 in sliding.
    pub tangential_displacement_y: Metre,
    /// Area of the cells with p > 0.
    pub contact_area: SquareMetre,
    /// Area of the cells that stick; 0 without friction.
    pub stick_area: SquareMetre,
    /// Largest pressure.
    pub max_pressure: Pascal,
    /// Largest shear traction.
    pub max_shear: Pascal,
    /// Plastic volume that both bodies have lost so far.
    pub plastic_volume: CubicMetre,
    /// Elastic energy ½ ΔA Σ (p u_z + q·u).
    pub elastic_energy: Joule,
    /// Energy that friction took in this increment.
    pub dissipation: Joule,
    /// Iterations of the solver.
    pub iterations: usize,
    /// Convolutions of the increment.
    pub convolutions: f64,
    /// Scale-free residual η, normal and tangential.
    pub residual: f64,
    /// What has flowed below the surfaces; none of bodies that do not.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub flow: Option<FlowStepRecord>,
}

/// One update of a contact that slides in place: a row of `updates.csv`, the first of which is the contact before it slides.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct UpdateRecord {
    /// Update, from 1; 0 before the first.
    pub update: usize,
    /// Distance that the bodies have slid at its end.
    pub distance: Metre,
    /// Time since the beginning; NaN where the speed is not known.
    #[serde(deserialize_with = "number_or_none")]
    pub time: Second,
    /// Normal force.
    pub load: Newton,
    /// Rigid-body approach δ.
    pub approach: Metre,
    /// Friction force along x of the upper body on the lower one.
    pub tangential_force: Newton,
    /// Area of the cells with p > 0.
    pub contact_area: SquareMetre,
    /// Cells across the largest contact spot: of the spot with the most cells, its columns or its rows, the fewer.
    pub largest_spot_cells: usize,
    /// Largest pressure.
    pub max_pressure: Pascal,
    /// Number of cells at the hardness.
    pub plastic_cells: usize,
    /// Volumes that each law has taken from the bodies so far: of wear the columns `wear_volume_lower`, `wear_volume_upper`.
    #[serde(flatten, with = "lost_volumes::whole")]
    pub lost: Vec<LostVolume>,
    /// Deepest wear of a cell of the lower body so far.
    pub max_wear_lower: Metre,
    /// Deepest wear of a cell of the upper body so far.
    pub max_wear_upper: Metre,
    /// Mean thickness of the film on the cells of the lower body that are in contact; 0 without one.
    pub mean_film_lower: Metre,
    /// Mean thickness of the film on the cells of the upper body that are in contact; 0 without one.
    pub mean_film_upper: Metre,
    /// Power of friction; NaN where the speed is not known.
    #[serde(deserialize_with = "number_or_none")]
    pub friction_power: Watt,
    /// Energy that friction took so far.
    pub friction_work: Joule,
    /// Largest temperature of the surfaces, absolute; that of the warmer body where the flash temperature is not computed, NaN
    /// where that is not known.
    #[serde(deserialize_with = "number_or_none")]
    pub max_temperature: Kelvin,
    /// Contacts solved, until the coefficients of wear under the films were found.
    pub solutions: usize,
    /// Iterations of the solver.
    pub iterations: usize,
    /// Convolutions.
    pub convolutions: f64,
    /// Scale-free complementarity residual η.
    pub residual: f64,
}

impl UpdateRecord {
    /// Volumes that the lower and the upper body have lost to the law of that name so far; 0 where there is no such law.
    pub fn lost(&self, law: &str) -> [CubicMetre; 2] {
        self.lost.iter().find(|lost| lost.law == law).map_or([0.0; 2], |lost| lost.whole)
    }
}

/// One point of a sweep: a row of `sweep.csv`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SweepRecord {
    /// Point, from 1, in the order given.
    pub point: usize,
    /// Normal force.
    pub load: Newton,
    /// Load over the area of the whole grid.
    pub mean_pressure: Pascal,
    /// Rigid-body approach δ.
    pub approach: Metre,
    /// Mean deformed gap.
    pub mean_gap: Metre,
    /// Area of the cells with p > 0.
    pub contact_area: SquareMetre,
    /// Area of contact over the area of the whole grid, 0 to 1.
    pub contact_fraction: f64,
    /// Cells across the largest contact spot: of the spot with the most cells, its columns or its rows, the fewer.
    pub largest_spot_cells: usize,
    /// Largest pressure.
    pub max_pressure: Pascal,
    /// Area of the cells at the hardness, under shear at their caps.
    pub plastic_area: SquareMetre,
    /// Plastic volume ΔA Σ w, w the plastic interference of the cells.
    pub plastic_volume: CubicMetre,
    /// Elastic energy ½ ΔA Σ p u, in rolling that of both tractions.
    pub elastic_energy: Joule,
    /// Normal stiffness dW/dδ, see [`crate::solver::normal_stiffness`]; none where a whole period bears elastically.
    pub stiffness: Option<NewtonPerMetre>,
    /// Creepage along x, velocity of the upper body against the lower one over the rolling velocity; 0 of a contact that does
    /// not roll.
    pub creepage_x: f64,
    /// Creepage along y; 0 of a contact that does not roll.
    pub creepage_y: f64,
    /// Force of the upper body on the lower one along x.
    pub tangential_force_x: Newton,
    /// Force of the upper body on the lower one along y.
    pub tangential_force_y: Newton,
    /// Area of the cells that stick.
    pub stick_area: SquareMetre,
    /// Largest shear traction.
    pub max_shear: Pascal,
    /// Energy that friction took while the contact moved on by a cell, from the work of the force and the pressure.
    pub dissipation: Joule,
    /// Work of the shear on the slip of the cells meanwhile: the dissipation without what the step from cell to cell takes by itself.
    pub slip_work: Joule,
    /// Iterations of the solver.
    pub iterations: usize,
    /// Convolutions, with those of the stiffness.
    pub convolutions: f64,
    /// Scale-free residual η.
    pub residual: f64,
}

/// One position of one pass: a row of `steps.csv`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct StepRecord {
    /// Pass, from 1.
    pub pass: usize,
    /// Position in the pass, from 1.
    pub step: usize,
    /// How far the upper body's left edge lies to the right of the lower body's.
    pub offset: Metre,
    /// How far the upper body is displaced along y, cyclically; none where all passes lie at one place.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset_y: Option<Metre>,
    /// Columns that face each other.
    pub overlap_columns: usize,
    /// Rigid-body approach δ.
    pub approach: Metre,
    /// Normal force at this position.
    pub load: Newton,
    /// Friction force along x of the upper body on the lower one.
    pub tangential_force: Newton,
    /// Area of the cells with p > 0.
    pub contact_area: SquareMetre,
    /// Area of the cells with p > 0 that are in the interior of both bodies.
    pub contact_area_interior: SquareMetre,
    /// Cells across the largest contact spot: of the spot with the most cells, its columns or its rows, the fewer.
    pub largest_spot_cells: usize,
    /// Largest pressure.
    pub max_pressure: Pascal,
    /// Number of cells at the hardness.
    pub plastic_cells: usize,
    /// Plastic volume ΔA Σ w, w the interference left at the cells at the hardness.
    pub plastic_volume: CubicMetre,
    /// Plastic volume over the cells that are in the interior of both bodies.
    pub plastic_volume_interior: CubicMetre,
    /// Iterations of the solver at the last approach tried.
    pub iterations: usize,
    /// Convolutions over all approaches tried.
    pub convolutions: f64,
    /// Scale-free complementarity residual η.
    pub residual: f64,
    /// The heat of friction; none where the temperature is not computed.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub heat: Option<HeatRecord>,
    /// What has flowed below the surfaces; none of bodies that do not.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub flow: Option<FlowStepRecord>,
}

/// One pass: a row of `passes.csv`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct PassRecord {
    /// Pass, from 1.
    pub pass: usize,
    /// Rigid-body approach δ of the pass (mean over the positions under step load).
    pub approach: Metre,
    /// Mean load over the positions.
    pub mean_load: Newton,
    /// Mean friction force along x of the upper body on the lower one.
    pub mean_tangential_force: Newton,
    /// Mean magnitude of the friction force over mean load; NaN where no position bears a load.
    #[serde(deserialize_with = "number_or_none")]
    pub friction_coefficient: f64,
    /// Smallest load at a position of the pass.
    pub min_load: Newton,
    /// Largest load at a position of the pass.
    pub max_load: Newton,
    /// Mean load over the mean area that faces.
    pub mean_pressure: Pascal,
    /// Mean real contact area over the positions.
    pub mean_contact_area: SquareMetre,
    /// Mean real contact area over the positions, of the cells that are in the interior of both bodies.
    pub mean_contact_area_interior: SquareMetre,
    /// Cells across the largest contact spot met: of the spot with the most cells at a position, its columns or its rows,
    /// the fewer.
    pub largest_spot_cells: usize,
    /// Largest pressure at any position.
    pub max_pressure: Pascal,
    /// Volumes that each law took from the bodies in this pass: of the plastic flow the columns `plastic_volume_lower`,
    /// `plastic_volume_upper`, `plastic_volume_lower_interior`, `plastic_volume_upper_interior`.
    #[serde(flatten, with = "lost_volumes")]
    pub lost: Vec<LostVolume>,
    /// What wear and films add; none without them.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub running: Option<RunningRecord>,
    /// What has flowed below the surfaces; none of bodies that do not.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub flow: Option<PassFlowRecord>,
    /// Rms height of the lower surface after the pass.
    pub sq_lower: Metre,
    /// Rms height of the upper surface after the pass.
    pub sq_upper: Metre,
    /// Rms height of the interior of the lower surface after the pass.
    pub sq_lower_interior: Metre,
    /// Rms height of the interior of the upper surface after the pass.
    pub sq_upper_interior: Metre,
    /// Number of approaches tried.
    pub outer_iterations: usize,
    /// Convolutions of the pass.
    pub convolutions: f64,
    /// Time the pass took.
    pub wall_time_s: Second,
}

/// The heat of friction at a position: further columns of `steps.csv`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct HeatRecord {
    /// Power of friction.
    pub friction_power: Watt,
    /// Largest temperature of the surfaces, absolute.
    pub max_flash_temperature: Kelvin,
}

/// A pass of bodies that wear or grow films, which may stand for many.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct RunningRecord {
    /// Passes of the motion that this computed one stands for, ≥ 1.
    pub represents: usize,
    /// Time since the beginning, at the end of these passes; NaN where the speed is not known.
    #[serde(deserialize_with = "number_or_none")]
    pub time: Second,
    /// Distance that the bodies have slid over each other since the beginning.
    pub distance: Metre,
    /// Deepest wear of a cell of the lower body in these passes.
    pub max_wear_lower: Metre,
    /// Deepest wear of a cell of the upper body in these passes.
    pub max_wear_upper: Metre,
    /// Mean thickness of the film on the lower body after them; 0 without one.
    pub mean_film_lower: Metre,
    /// Mean thickness of the film on the upper body after them.
    pub mean_film_upper: Metre,
    /// Energy that friction took in these passes.
    pub friction_work: Joule,
    /// Largest temperature of the surfaces, absolute; that of the warmer body where the flash temperature is not computed, NaN
    /// where that is not known.
    #[serde(deserialize_with = "number_or_none")]
    pub max_flash_temperature: Kelvin,
    /// Estimate of the error of the heights from not computing every pass.
    pub error_estimate: Metre,
}

/// Reads a number that may be unknown: NaN then.
fn number_or_none<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Known::deserialize(deserializer)?.0.unwrap_or(f64::NAN))
}

/// A number of a table or of JSON; none where the cell is empty, or JSON has `null`.
struct Known(Option<f64>);

impl<'de> Deserialize<'de> for Known {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Number;

        impl serde::de::Visitor<'_> for Number {
            type Value = Known;

            fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
                formatter.write_str("a number, or nothing")
            }

            fn visit_f64<E>(self, value: f64) -> Result<Known, E> {
                Ok(Known(Some(value)))
            }

            fn visit_u64<E>(self, value: u64) -> Result<Known, E> {
                Ok(Known(Some(value as f64)))
            }

            fn visit_i64<E>(self, value: i64) -> Result<Known, E> {
                Ok(Known(Some(value as f64)))
            }

            fn visit_str<E: serde::de::Error>(self, value: &str) -> Result<Known, E> {
                match value {
                    "" => Ok(Known(None)),
                    text => Err(E::invalid_value(serde::de::Unexpected::Str(text), &self)),
                }
            }

            fn visit_unit<E>(self) -> Result<Known, E> {
                Ok(Known(None))
            }

            fn visit_none<E>(self) -> Result<Known, E> {
                Ok(Known(None))
            }
        }

        deserializer.deserialize_any(Number)
    }
}

/// The volumes that a law took from the bodies.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LostVolume {
    /// Name of the law.
    pub law: String,
    /// Volumes that the lower and the upper body lost, m³.
    pub whole: [CubicMetre; 2],
    /// Volumes that the interiors of the lower and of the upper body lost, m³.
    pub interior: [CubicMetre; 2],
}

impl LostVolume {
    /// Nothing lost to the law of that name.
    pub fn nothing(law: &str) -> Self {
        Self { law: law.to_owned(), whole: [0.0; 2], interior: [0.0; 2] }
    }
}

impl PassRecord {
    /// Passes of the motion that this computed one stands for, ≥ 1.
    pub fn represents(&self) -> usize {
        self.running.map_or(1, |running| running.represents)
    }

    /// Volumes that the lower and the upper body lost in this pass to the law of that name; 0 where there is no such law.
    pub fn lost(&self, law: &str) -> [CubicMetre; 2] {
        self.of(law).map_or([0.0; 2], |lost| lost.whole)
    }

    /// Volumes that the interiors of the lower and of the upper body lost in this pass to the law of that name.
    pub fn lost_inside(&self, law: &str) -> [CubicMetre; 2] {
        self.of(law).map_or([0.0; 2], |lost| lost.interior)
    }

    /// The volumes of the law of that name.
    fn of(&self, law: &str) -> Option<&LostVolume> {
        self.lost.iter().find(|lost| lost.law == law)
    }
}

/// Volumes as columns: four for each law, by its name.
mod lost_volumes {
    use std::fmt;

    use serde::de::{Deserializer, Error, MapAccess, Visitor};
    use serde::ser::Serializer;

    use super::{CubicMetre, Known, LostVolume};

    /// Endings of the columns of a law, after its name.
    const COLUMNS: [&str; 4] =
        ["_volume_lower", "_volume_upper", "_volume_lower_interior", "_volume_upper_interior"];

    pub(super) fn serialize<S: Serializer>(lost: &[LostVolume], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(lost.iter().flat_map(|lost| {
            let values = [lost.whole[0], lost.whole[1], lost.interior[0], lost.interior[1]];
            let columns = COLUMNS.map(|column| format!("{}{column}", lost.law));
            columns.into_iter().zip(values)
        }))
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<LostVolume>, D::Error> {
        let lost = read::<4, D>(deserializer, COLUMNS)?.into_iter();
        Ok(lost.map(|(law, [a, b, c, d])| LostVolume { law, whole: [a, b], interior: [c, d] }).collect())
    }

    /// The values in these columns of each law.
    fn read<'de, const N: usize, D: Deserializer<'de>>(
        deserializer: D,
        endings: [&str; N],
    ) -> Result<Vec<(String, [CubicMetre; N])>, D::Error> {
        // All columns that no field has come here, those of numbers that there are not among them.
        let columns = deserializer.deserialize_map(InOrder)?;
        let laws = columns.iter().filter_map(|(column, _)| column.strip_suffix(endings[0]));
        laws.map(|law| {
            let mut values = [0.0; N];
            for (value, ending) in values.iter_mut().zip(endings) {
                let column = format!("{law}{ending}");
                let found = columns.iter().find(|(known, _)| *known == column).and_then(|(_, value)| *value);
                *value = found.ok_or_else(|| D::Error::custom(format!("no column `{column}`")))?;
            }
            Ok((law.to_owned(), values))
        })
        .collect()
    }

    /// Columns in their order, which is that of the laws.
    struct InOrder;

    impl<'de> Visitor<'de> for InOrder {
        type Value = Vec<(String, Option<CubicMetre>)>;

        fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
            formatter.write_str("columns of numbers")
        }

        fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
            let mut columns = Vec::new();
            while let Some((column, Known(value))) = map.next_entry()? {
                columns.push((column, value));
            }
            Ok(columns)
        }
    }

    /// Those of the whole bodies: two for each law.
    pub(super) mod whole {
        use serde::{Deserializer, Serializer};

        use super::{COLUMNS, LostVolume};

        pub(in crate::motion::record) fn serialize<S: Serializer>(
            lost: &[LostVolume],
            serializer: S,
        ) -> Result<S::Ok, S::Error> {
            serializer.collect_map(lost.iter().flat_map(|lost| {
                [0, 1].map(|body| (format!("{}{}", lost.law, COLUMNS[body]), lost.whole[body]))
            }))
        }

        pub(in crate::motion::record) fn deserialize<'de, D: Deserializer<'de>>(
            deserializer: D,
        ) -> Result<Vec<LostVolume>, D::Error> {
            let lost = super::read::<2, D>(deserializer, [COLUMNS[0], COLUMNS[1]])?.into_iter();
            Ok(lost.map(|(law, whole)| LostVolume { law, whole, interior: whole }).collect())
        }
    }
}

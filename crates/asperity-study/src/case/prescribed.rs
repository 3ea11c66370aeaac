//! Prescribed normal loading: a load, a mean pressure or an approach, or several.

use serde::Serialize;

use asperity_base::units::{Metre, Newton, Pascal, SquareMetre};
use asperity_base::{beside, exists};
use asperity_contact::solver;
use asperity_derive::Part;

/// Normal loading of a contact.
#[derive(Part, Debug, Clone, PartialEq, Serialize)]
#[part(
    absent = "exactly one of the six that give a load or an approach",
    hint = "for example `load = \"2 N\"`"
)]
#[serde(rename_all = "snake_case")]
pub enum ContactLoad {
    /// Total normal force; in a motion, the mean over a pass or the force at each position, see `control`.
    #[key(quantity = Force, range = AboveZero, example = "\"2 N\"", exists = exists::LOAD, beside = [beside::LOADS])]
    Load(Newton),
    /// Load over the apparent area, the area of all cells at full overlap; during an overlap motion half of
    /// them overlap on average, so that the mean pressure there is about twice as large.
    #[key(quantity = Pressure, range = AboveZero, example = "\"1 MPa\"", exists = exists::LOAD, beside = [beside::LOADS])]
    MeanPressure(Pascal),
    /// Distance by which the bodies have approached, of any sign; 0 if the planes z = 0 of both height maps
    /// coincide.
    #[key(quantity = Length, example = "\"10 nm\"", exists = exists::LENGTH, beside = [beside::APPROACH])]
    Approach(Metre),
    /// Several loads, one after the other.
    #[key(
        quantity = Force,
        range = AboveZero,
        several = "\"0.1 N\"",
        example = "[\"0.1 N\", \"1 N\"]",
        exists = exists::LOAD,
        beside = [beside::LOADS]
    )]
    Loads(Vec<Newton>),
    /// Several mean pressures, one after the other.
    #[key(
        quantity = Pressure,
        range = AboveZero,
        several = "\"1 MPa\"",
        example = "[\"1 MPa\", \"10 MPa\"]",
        exists = exists::LOAD,
        beside = [beside::LOADS]
    )]
    MeanPressures(Vec<Pascal>),
    /// Several approaches, one after the other.
    #[key(
        quantity = Length,
        several = "\"10 nm\"",
        spacing = Linear,
        example = "[\"10 nm\", \"20 nm\"]",
        exists = exists::LENGTH,
        beside = [beside::APPROACH]
    )]
    Approaches(Vec<Metre>),
}

/// One normal loading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Prescribed {
    /// Total normal force, > 0; of any sign in a history of bodies that attract each other.
    Load(Newton),
    /// Load over the apparent area, > 0; of any sign in a history of bodies that attract each other.
    MeanPressure(Pascal),
    /// Approach relative to the prepared heights; positive or negative.
    Approach(Metre),
}

impl ContactLoad {
    /// Returns the loading, the largest of a sweep.
    pub(super) fn largest(&self) -> Prescribed {
        let largest = |values: &[f64]| {
            values.iter().copied().max_by(f64::total_cmp).expect("a list has at least one value")
        };
        match self {
            Self::Load(load) => Prescribed::Load(*load),
            Self::MeanPressure(pressure) => Prescribed::MeanPressure(*pressure),
            Self::Approach(approach) => Prescribed::Approach(*approach),
            Self::Loads(loads) => Prescribed::Load(largest(loads)),
            Self::MeanPressures(pressures) => Prescribed::MeanPressure(largest(pressures)),
            Self::Approaches(approaches) => Prescribed::Approach(largest(approaches)),
        }
    }

    /// Returns the points of a sweep.
    pub(super) fn sweep(&self) -> Vec<Prescribed> {
        let points =
            |values: &[f64], point: fn(f64) -> Prescribed| values.iter().copied().map(point).collect();
        match self {
            Self::Load(_) | Self::MeanPressure(_) | Self::Approach(_) => Vec::new(),
            Self::Loads(loads) => points(loads, Prescribed::Load),
            Self::MeanPressures(pressures) => points(pressures, Prescribed::MeanPressure),
            Self::Approaches(approaches) => points(approaches, Prescribed::Approach),
        }
    }
}

impl Prescribed {
    /// Returns the control of the solver, on this apparent area.
    pub fn control(&self, apparent_area: SquareMetre) -> solver::Control {
        match *self {
            Self::Load(load) => solver::Control::Load(load),
            Self::MeanPressure(pressure) => solver::Control::Load(pressure * apparent_area),
            Self::Approach(approach) => solver::Control::Approach(approach),
        }
    }
}

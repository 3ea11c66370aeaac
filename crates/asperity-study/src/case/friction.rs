//! `[friction]`: friction of the bodies, and the tangential loading of a static contact.

use serde::Serialize;

use asperity_base::error::Result;
use asperity_base::table::{Bounds, Key, Kind, Value, two};
use asperity_base::units::{Metre, Newton};
use asperity_base::{beside, exists};
use asperity_contact::solver::{Creep, Friction, Rolling, Tangential};
use asperity_derive::{Part, Table};

/// Friction, and the tangential loading.
#[derive(Table, Debug, Clone, PartialEq, Serialize)]
#[table("friction")]
#[non_exhaustive]
pub struct FrictionSpec {
    /// The law.
    #[key(part)]
    #[serde(flatten)]
    pub law: Friction,
    /// Prescribed tangential loading of a static contact; no force if absent.
    #[key(part)]
    #[serde(flatten)]
    pub prescribed: Option<InPlane>,
    /// Rolling only, in 1/m: angular velocity of the upper body relative to the lower one, over the rolling
    /// velocity; its axis is z through the middle of the grid, and a positive spin turns from +x towards +y.
    #[key(number = "a number, in 1/m", default = 0.0, written = "0", example = "25")]
    #[serde(skip_serializing_if = "is_zero")]
    pub spin: f64,
    /// Equal steps in which load and tangential load grow together from 0: a loading path, not a resolution.
    /// To press first and push then, push in a \[\[history\]\].
    ///
    /// 1 for a rolling contact and a motion.
    #[key(count = 1, default = 1, example = "20")]
    #[serde(skip_serializing_if = "is_one")]
    pub increments: usize,
}

/// Prescribed tangential loading, along x and y.
#[derive(Part, Debug, Clone, PartialEq, Serialize)]
#[part(absent = "at most one of the six in the plane", hint = "give one of them, or none")]
#[serde(rename_all = "snake_case")]
pub enum InPlane {
    /// Force of the upper body on the lower one.
    #[key(quantity = Force, vector, absent = "0", example = "\"0.1 N\"", exists = exists::LOAD, beside = [beside::FORCE])]
    Force([Newton; 2]),
    /// Displacement of the upper body relative to the lower one.
    #[key(quantity = Length, vector, example = "\"0.1 um\"", exists = exists::LENGTH, beside = [beside::DISPLACEMENT])]
    Displacement([Metre; 2]),
    /// Sliding direction of the upper body; every cell slips.
    ///
    /// A unit vector.
    #[key(special = direction, form = "`[x, y]` of any length", example = "[1, 0]")]
    Sliding([f64; 2]),
    /// Steady rolling along x: velocity of the upper body relative to the lower one, over the rolling
    /// velocity.
    #[key(number = "a finite number", vector, example = "0.001")]
    Creepage([f64; 2]),
    /// Several creepages, one after the other.
    ///
    /// A sweep, each on virgin bodies.
    #[key(number = "a finite number", vector, several = "[0.001, 0]", spacing = Linear, example = "[0.001]")]
    Creepages(Vec<[f64; 2]>),
    /// Steady rolling along x: force of the upper body on the lower one.
    #[key(quantity = Force, vector, example = "\"0.1 N\"", exists = exists::LOAD, beside = [beside::FORCE])]
    RollingForce([Newton; 2]),
}

/// A direction in the plane, as a unit vector.
pub(super) fn direction(value: &dyn Value, key: &Key) -> Result<[f64; 2]> {
    const EXPECTED: &str = "a direction such as [1, 0]";
    const COMPONENT: Kind = Kind::Number("a finite number", Bounds::Any);
    let [x, y] = if value.is_array() {
        two(value, EXPECTED, |item| item.real(key, &COMPONENT))?
    } else {
        [value.real(key, &COMPONENT)?, 0.0]
    };
    let length = x.hypot(y);
    if length == 0.0 { Err(value.unexpected(EXPECTED, None)) } else { Ok([x / length, y / length]) }
}

impl FrictionSpec {
    /// Whether the contact is rolling.
    pub(super) fn rolls(&self) -> bool {
        self.rolling().next().is_some()
    }

    /// Whether any shear causes slip.
    pub(super) fn slips(&self) -> bool {
        self.law.shear_limit(1.0).is_finite()
    }

    /// Whether it takes several creepages, one after the other.
    pub fn sweeps(&self) -> bool {
        matches!(self.prescribed, Some(InPlane::Creepages(_)))
    }

    /// Returns the rolling states: one for each of several creepages, or a single one.
    pub(super) fn rolling(&self) -> impl Iterator<Item = Rolling> + '_ {
        let creeps = self.prescribed.iter().flat_map(InPlane::creeps);
        creeps.map(|creep| Rolling { creep, spin: self.spin })
    }
}

impl InPlane {
    /// Returns the tangential loading of bodies that do not roll.
    pub(super) fn tangential(&self) -> Option<Tangential> {
        match *self {
            Self::Force(force) => Some(Tangential::Force(force)),
            Self::Displacement(shift) => Some(Tangential::Displacement(shift)),
            Self::Sliding(direction) => Some(Tangential::Sliding(direction)),
            Self::Creepage(_) | Self::Creepages(_) | Self::RollingForce(_) => None,
        }
    }

    /// Returns the tangential loadings of rolling bodies.
    fn creeps(&self) -> Vec<Creep> {
        match self {
            Self::Creepage(creepage) => vec![Creep::Creepage(*creepage)],
            Self::Creepages(several) => several.iter().copied().map(Creep::Creepage).collect(),
            Self::RollingForce(force) => vec![Creep::Force(*force)],
            Self::Force(_) | Self::Displacement(_) | Self::Sliding(_) => Vec::new(),
        }
    }
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

fn is_one(count: &usize) -> bool {
    *count == 1
}

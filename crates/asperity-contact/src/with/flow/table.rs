//! The table `[flow]`: the fluid, the pressure that drives it, and the gap beyond the grid.

use serde::Serialize;

use super::{Along, Ends, Fluid};
use crate::operator::Boundary;
use crate::units::{Metre, Pascal, PascalSecond};
use asperity_base::beside::{Beside, Scale};
use asperity_base::exists;
use asperity_base::table::Exists;
use asperity_derive::Table;

/// The leakage of a fluid through the gap of each contact.
#[derive(Table, Debug, Clone, Copy, PartialEq, Serialize)]
#[table("flow")]
#[non_exhaustive]
pub struct Leakage {
    /// Viscosity of the fluid, constant.
    #[key(quantity = Viscosity, range = AboveZero, example = "\"80 mPa s\"", exists = VISCOSITY)]
    pub viscosity: PascalSecond,
    /// Pressure difference that drives the leakage.
    #[key(quantity = Pressure, range = FromZero, default = 1e5, example = "\"1 bar\"", exists = PRESSURE, beside = [LIFTS])]
    pub pressure: Pascal,
    /// Direction of the pressure gradient.
    #[key(choice, default = Along::Both, example = "\"x\"")]
    pub along: Along,
    /// `"periodic"`: the gap repeats itself, under a mean gradient of pressure; `"reservoirs"`: the fluid has
    /// two pressures at the ends of the grid, and the sides are closed along a free axis.
    #[key(
        choice,
        absent = "`\"periodic\"` along periodic axes, `\"reservoirs\"` along free ones",
        example = "\"reservoirs\""
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ends: Option<Ends>,
    /// Whether the fluid is an ideal gas at constant temperature; needs `outlet`.
    #[key(flag, default = false, example = "true")]
    pub gas: bool,
    /// Absolute pressure of a gas at the outlet, to which its leakage refers.
    #[key(
        quantity = Pressure,
        range = AboveZero,
        absent = "with a gas: must be given",
        example = "\"1 bar\"",
        exists = OUTLET
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outlet: Option<Pascal>,
    /// Density of a liquid, by which its leakage is also given as a mass.
    #[key(quantity = Density, range = AboveZero, absent = "unknown", example = "\"870 kg/m3\"", exists = exists::DENSITY)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density: Option<f64>,
    /// Width of the face of a seal along the flow, for which the leakage of a metre of seal is given. This
    /// leakage is inversely proportional to the width.
    #[key(quantity = Length, range = AboveZero, absent = "the length of the map along the flow", example = "\"2 mm\"", exists = FACE, beside = [NARROW])]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub width: Option<Metre>,
    /// Whether to compute how the surfaces carry and shear the fluid when they slide: the shear flow factor and the stress
    /// factors of mean equations of lubrication.
    #[key(flag, default = false, example = "true")]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub shear: bool,
    /// Interval of the positions of a pass, or of the increments, updates or points, whose flow is computed;
    /// 0: once a pass, where the left edges are flush, or for the last contact alone.
    #[key(count = 0, default = 1, example = "4")]
    pub every: usize,
}

/// Viscosities.
const VISCOSITY: Exists =
    Exists::Within { least: 3e-6, most: 30.0, of: "gases to cold gear oils", slips: &["mPa s", "uPa s"] };
/// Pressures of fluids.
const PRESSURE: Exists = Exists::Within {
    least: 1e-3,
    most: 4e9,
    of: "vacuum pumps to elastohydrodynamic contacts",
    slips: &["bar", "MPa"],
};

/// Widths of the faces of seals.
const FACE: Exists =
    Exists::Within { least: 1e-6, most: 1.0, of: "sealing lips to flanges", slips: &["mm", "um"] };
/// Pressures of gases that are ideal.
const OUTLET: Exists =
    Exists::Within { least: 1e-3, most: 3e7, of: "vacuum pumps to gas cylinders", slips: &["bar", "mbar"] };
const NARROW: Beside = Beside::least(Scale::Side, 0.5, "the map is wider than the face");
const LIFTS: Beside = Beside::most(Scale::MeanPressure, 1.0, "the fluid lifts the bodies, which is left out");

impl Leakage {
    /// Returns the fluid with the difference of its pressure.
    pub fn fluid(&self) -> Fluid {
        Fluid { viscosity: self.viscosity, drop: self.pressure, outlet: self.outlet }
    }

    /// Returns how the gap of a contact with this boundary goes on beyond the grid, for a flow along `axis`.
    pub fn ends_along(&self, axis: usize, boundary: Boundary) -> Ends {
        let by_boundary = if boundary.repeats(axis) { Ends::Periodic } else { Ends::Reservoirs };
        self.ends.unwrap_or(by_boundary)
    }
}

//! `[contact]`: the load of the bodies, and the solver of the contact.

use serde::Serialize;

use super::prescribed::{ContactLoad, Prescribed};
use asperity_base::choice;
use asperity_base::error::Result;
use asperity_base::table::{Key, Value, choice, two};
use asperity_contact::operator::Boundary;
use asperity_contact::solver::{Device, Method};
use asperity_derive::Table;

/// Load, boundary and solver.
#[derive(Table, Debug, Clone, PartialEq, Serialize)]
#[table("contact")]
#[non_exhaustive]
pub struct Contact {
    /// The load or the approach, or several.
    #[key(part)]
    #[serde(flatten)]
    pub load: ContactLoad,
    /// Continuation beyond the edges: `"free"`, an unloaded half-space; `"periodic"`, copies of the contact;
    /// one of each: a line contact.
    #[key(
        special = boundary,
        form = "`\"free\"`, `\"periodic\"`, or one word for each axis: `[\"free\", \"periodic\"]`",
        default = Boundary::FREE,
        written = "\"free\"",
        example = "[\"free\", \"periodic\"]"
    )]
    pub boundary: Boundary,
    /// `"common"` resamples both prepared surfaces to the coarser pitch and crops them about their centres to
    /// a common size; `"as-prepared"` requires surfaces that fit.
    #[key(choice, default = GridMatch::AsPrepared, example = "\"common\"")]
    #[serde(skip_serializing_if = "is_default")]
    pub grid: GridMatch,
    /// Solver; all methods give the same result.
    #[key(choice, default = Method::Auto, example = "\"direct\"")]
    pub method: Method,
    /// Device that solves the contact: `"cpu"`; `"cuda"`, a GPU of NVIDIA; `"host"`, the solver of the GPU in
    /// plain loops on the processor, for comparison.
    #[key(choice, default = Device::Cpu, example = "\"cuda\"")]
    #[serde(skip_serializing_if = "is_default")]
    pub device: Device,
    /// Residual η at which the solver stops, see [theory](theory.md).
    #[key(
        number = "a number",
        range = Between { least: 0.0, most: 1.0, open: [true, true] },
        default = 1e-6,
        written = "1e-6",
        example = "1e-8"
    )]
    pub tolerance: f64,
}

/// Treatment of two surfaces whose grids differ.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum GridMatch {
    /// Both surfaces must fit as they are prepared.
    #[default]
    AsPrepared,
    /// Both surfaces are resampled to the coarser pitch, and cropped about their centres to a common size.
    Common,
}

choice!(GridMatch: "as-prepared" => AsPrepared, "common" => Common);

impl Contact {
    /// Returns the load or approach, the largest of a sweep.
    pub fn prescribed(&self) -> Prescribed {
        self.load.largest()
    }

    /// Returns the points of a sweep, each on virgin bodies; none without a sweep.
    pub fn sweep(&self) -> Vec<Prescribed> {
        self.load.sweep()
    }
}

/// A word for both axes, or one for each.
fn boundary(value: &dyn Value, _: &Key) -> Result<Boundary> {
    const EXPECTED: &str = "\"free\", \"periodic\", or one of them for x and one for y";
    Ok(Boundary(if value.is_array() { two(value, EXPECTED, choice)? } else { [choice(value)?; 2] }))
}

// Default values are omitted, so that cases from before these keys keep their digests.
fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

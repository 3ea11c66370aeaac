//! The table `[subsurface]`: requested output of the stress under the surface.

use serde::Serialize;

use asperity_base::beside::{Beside, DEEPEST, DEPTH, Scale};
use asperity_base::choice::choice;
use asperity_base::error::Result;
use asperity_base::exists;
use asperity_base::table::{Bounds, Key, Kind, Value, list, two};
use asperity_base::units::{Dimension, Metre};
use asperity_derive::Table;

/// Depths and places within a body.
const INSIDE: Beside = Beside::least(Scale::Cell, 0.1, "a part of a cell makes no difference");

/// Requested output of the stress under the surface. Positions x and y are relative to the corner of the
/// body, depths to its surface.
#[derive(Table, Debug, Clone, PartialEq, Serialize)]
#[table("subsurface")]
#[non_exhaustive]
pub struct SubsurfaceSpec {
    /// Deepest plane; the largest stress of a contact spot lies at about a quarter of its width.
    #[key(quantity = Length, range = AboveZero, example = "\"20 um\"", exists = exists::LENGTH, beside = [DEPTH, DEEPEST])]
    pub to: Metre,
    /// Steps from the surface to `to`.
    ///
    /// The surface is one more plane.
    #[key(count = 1, most = 10_000, default = 40, example = "20")]
    pub layers: usize,
    /// Body, with its own Poisson's ratio.
    #[key(choice, default = Side::Lower, example = "\"upper\"")]
    pub body: Side,
    /// Depths at which von Mises' stress is stored on the whole plane.
    #[key(
        special = depths,
        form = "list of lengths ≥ 0",
        dimension = Length,
        default = Vec::new(),
        absent = "none",
        example = "[\"1 um\", \"5 um\"]",
        exists = exists::LENGTH,
        beside = [DEPTH, INSIDE]
    )]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub planes: Vec<Metre>,
    /// Place y of the section along x on which the stress is stored, in the contact.
    #[key(
        quantity = Length,
        range = FromZero,
        absent = "the most stressed point",
        example = "\"20 um\"",
        exists = exists::LENGTH,
        beside = [INSIDE]
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub section: Option<Metre>,
    /// Positions in the contact below which the stress is stored.
    ///
    /// `[x, y]`, each ≥ 0.
    #[key(
        special = positions,
        form = "list of `[x, y]`, lengths ≥ 0",
        dimension = Length,
        default = Vec::new(),
        absent = "none",
        example = "[[\"5 um\", \"10 um\"]]",
        exists = exists::LENGTH,
        beside = [INSIDE]
    )]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub columns: Vec<[Metre; 2]>,
    /// \[motion\] only: position of each pass at which the stress is computed.
    ///
    /// From 1.
    #[key(count = 1, absent = "the position with aligned left edges", example = "3")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step: Option<usize>,
}

/// One of the two bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The body underneath.
    Lower,
    /// The body above.
    Upper,
}

choice!(Side: "lower" => Lower, "upper" => Upper);

/// Depths below the surface.
fn depths(value: &dyn Value, key: &Key) -> Result<Vec<Metre>> {
    list(value, "a list of depths such as [\"1 um\", \"5 um\"]", |item| length(item, key))
}

/// Positions on the surface.
fn positions(value: &dyn Value, key: &Key) -> Result<Vec<[Metre; 2]>> {
    let position = |item: &dyn Value| two(item, "a position [x, y] of two lengths", |item| length(item, key));
    list(value, "a list of positions such as [[\"5 um\", \"10 um\"]]", position)
}

/// A length of at least 0.
fn length(value: &dyn Value, key: &Key) -> Result<Metre> {
    value.real(key, &Kind::Quantity(Dimension::Length, Bounds::FromZero))
}

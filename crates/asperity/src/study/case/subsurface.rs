//! The table `[subsurface]`: what is wanted of the stress under the surface.

use serde::Serialize;

use super::cursor::{Entry, Table};
use super::schema::results::subsurface as keys;
use super::schema::tables::known_in;
use crate::choice::choice;
use crate::error::Result;
use crate::units::{Dimension, Metre};

/// What is looked at under the surface. Positions x and y count from the corner of the body, depths from its surface.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SubsurfaceSpec {
    /// The body that is looked into.
    pub body: Side,
    /// The deepest plane, > 0.
    pub to: Metre,
    /// Planes below the surface, evenly spaced down to `to`, ≥ 1. The surface is one more.
    pub layers: usize,
    /// Depths ≥ 0 of the planes that are kept whole.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub planes: Vec<Metre>,
    /// The y ≥ 0 at which the section along x lies; through the most stressed point if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub section: Option<Metre>,
    /// Positions `[x, y]`, each ≥ 0, below which the stress is kept.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub columns: Vec<[Metre; 2]>,
    /// The position of a pass that is looked at, from 1; if absent, the one at which the left edges are flush.
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

pub(super) fn subsurface(table: &Table<'_>) -> Result<SubsurfaceSpec> {
    known_in(table)?;
    Ok(SubsurfaceSpec {
        body: keys::BODY.of(table)?,
        to: keys::TO.of(table)?,
        layers: keys::LAYERS.of(table)?,
        planes: keys::PLANES.of(table)?.unwrap_or_default(),
        section: keys::SECTION_Y.of(table)?,
        columns: keys::COLUMNS.of(table)?.unwrap_or_default(),
        step: keys::STEP.of(table)?,
    })
}

/// Depths below the surface.
pub(super) fn depths(entry: &Entry<'_>) -> Result<Vec<Metre>> {
    entry.list("a list of depths such as [\"1 um\", \"5 um\"]", length)
}

/// Positions on the surface.
pub(super) fn positions(entry: &Entry<'_>) -> Result<Vec<[Metre; 2]>> {
    entry.list("a list of positions such as [[\"5 um\", \"10 um\"]]", |item| {
        item.array("a position [x, y] of two lengths", length)
    })
}

/// A length of at least 0.
fn length(entry: &Entry<'_>) -> Result<Metre> {
    let length = entry.quantity(Dimension::Length)?;
    if length >= 0.0 { Ok(length) } else { Err(entry.unexpected("a length of at least 0", None)) }
}

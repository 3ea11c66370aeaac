//! The table `[subsurface]`: requested output of the stress under the surface.

use serde::Serialize;

use super::cursor::Table;
use super::schema::results::subsurface as keys;
use super::schema::tables::known_in;
use super::schema::values::subsurface::Side;
use asperity_base::error::Result;
use asperity_base::units::Metre;

/// Requested output of the stress under the surface. Positions x and y are relative to the corner of the body, depths to
/// its surface.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SubsurfaceSpec {
    /// The requested body.
    pub body: Side,
    /// The deepest plane, > 0.
    pub to: Metre,
    /// Number of planes below the surface, evenly spaced down to `to`, ≥ 1. The surface is one more.
    pub layers: usize,
    /// Depths ≥ 0 of planes that are stored in full.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub planes: Vec<Metre>,
    /// The y ≥ 0 of the section along x; by default through the most stressed point.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub section: Option<Metre>,
    /// Positions `[x, y]`, each ≥ 0, below which the stress is stored.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub columns: Vec<[Metre; 2]>,
    /// The requested position of a pass, from 1; by default the one at which the left edges are flush.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step: Option<usize>,
}

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

//! The table `[subsurface]`: what is wanted of the stress under the surface.

use serde::Serialize;

use super::cursor::{Entry, Table};
use super::keys::known_in;
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

/// Beyond this many planes nobody looks at them.
const MAX_LAYERS: usize = 10_000;

pub(super) fn subsurface(table: &Table<'_>, moves: bool) -> Result<SubsurfaceSpec> {
    known_in(table)?;
    let layers = |entry: Entry<'_>| match entry.count(1)? {
        layers if layers <= MAX_LAYERS => Ok(layers),
        _ => Err(entry.unexpected("at most 10000", None)),
    };
    let position = |entry: &Entry<'_>| entry.array("a position [x, y] of two lengths", length);
    let step = table.get("step").map(|entry| {
        let step = entry.count(1)?;
        let hint = || Some("a static contact has one position; leave it out".to_owned());
        if moves {
            Ok(step)
        } else {
            Err(entry.error("'step' has no meaning without [motion]".to_owned(), hint()))
        }
    });
    Ok(SubsurfaceSpec {
        body: table.choice_or("body", Side::Lower)?,
        to: table.required("to", "\"20 um\"")?.positive(Dimension::Length)?,
        layers: table.get("layers").map(layers).transpose()?.unwrap_or(40),
        planes: list(table, "planes", "a list of depths such as [\"1 um\", \"5 um\"]", length)?,
        section: table.get("section").map(|entry| length(&entry)).transpose()?,
        columns: list(table, "columns", "a list of positions such as [[\"5 um\", \"10 um\"]]", position)?,
        step: step.transpose()?,
    })
}

fn list<'a, T>(
    table: &Table<'a>,
    key: &str,
    expected: &str,
    read: impl Fn(&Entry<'a>) -> Result<T>,
) -> Result<Vec<T>> {
    table.get(key).map_or(Ok(Vec::new()), |entry| entry.list(expected, read))
}

/// A length of at least 0.
fn length(entry: &Entry<'_>) -> Result<Metre> {
    let length = entry.quantity(Dimension::Length)?;
    if length >= 0.0 { Ok(length) } else { Err(entry.unexpected("a length of at least 0", None)) }
}

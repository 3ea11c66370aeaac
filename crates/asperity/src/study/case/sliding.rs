//! `[sliding]`: a static contact that slides some distance and wears in place.

use serde::Serialize;

use super::cursor::Table;
use super::schema::motion::sliding as keys;
use super::schema::tables::known_in;
use super::{Body, Case, sweep};
use crate::error::Result;
use crate::motion::Slide;
use crate::units::{Metre, MetrePerSecond, SquareMetre};

/// How a static contact slides in place.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SlidingSpec {
    /// Distance, > 0.
    pub distance: Metre,
    /// Speed of the upper body over the lower one, > 0; not known if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<MetrePerSecond>,
    /// Implicit updates, ≥ 1.
    pub updates: usize,
}

pub(super) fn sliding(table: &Table<'_>) -> Result<SlidingSpec> {
    known_in(table)?;
    Ok(SlidingSpec {
        distance: keys::DISTANCE.of(table)?,
        speed: keys::SPEED.of(table)?,
        updates: keys::UPDATES.of(table)?,
    })
}

/// An error if what slides in place moves besides, has a past or several loads, or nothing that the sliding changes.
pub(super) fn alone(root: &Table<'_>, bodies: [&Body; 2]) -> Result<()> {
    let Some(table) = root.table("sliding")? else { return Ok(()) };
    let refused = |message: &str, hint: &str| Err(table.error(message.to_owned(), Some(hint.to_owned())));
    if root.table("motion")?.is_some() {
        let hint =
            "in [sliding] the same cells face each other all the way, in a [motion] all pass each other";
        return refused("[sliding] and [motion] are both given, expected one of them", hint);
    }
    if root.get("history").is_some() {
        return refused("[sliding] has no [[history]]", "what is prescribed in [contact] holds all the way");
    }
    let contact = root.required_table("contact")?;
    if let Some(entry) = sweep::KEYS.iter().find_map(|key| contact.get(key)) {
        let message = format!("[sliding] has no '{}'", entry.key());
        let hint = "it has one `load`, `mean_pressure` or `approach`".to_owned();
        return Err(entry.error(message, Some(hint)));
    }
    if let Some(entry) = root.get("acceleration") {
        let hint = "set `updates` in [sliding], or leave [acceleration] out".to_owned();
        return Err(entry.error("[acceleration] is that of a [motion]".to_owned(), Some(hint)));
    }
    if bodies.iter().all(|body| body.wear.is_none() && body.film.is_none()) {
        let hint = "give a body `[lower.wear]` or `[lower.film]`, or leave [sliding] out";
        return refused("[sliding] is of bodies that wear or grow films", hint);
    }
    Ok(())
}

impl Case {
    /// How a static contact slides in place, on so large an apparent area; none if it does not.
    pub fn slide(&self, apparent_area: SquareMetre) -> Option<Slide> {
        let SlidingSpec { distance, speed, updates } = self.sliding?;
        let control = self.contact.prescribed.control(apparent_area);
        let slide = Slide::graded(distance, updates, control).with_speed(speed);
        let friction = self.friction.as_ref().map(|friction| friction.law);
        Some(slide.with_friction(friction).with_bulk(self.temperature.map(|temperature| temperature.bulk)))
    }
}

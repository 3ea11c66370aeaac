//! `[sliding]`: a static contact that slides some distance, with wear in place.

use serde::Serialize;

use super::Case;
use super::cursor::Table;
use super::schema::moving::sliding as keys;
use super::schema::tables::known_in;
use asperity_base::error::Result;
use asperity_base::units::{Metre, MetrePerSecond, SquareMetre};
use asperity_contact::motion::Slide;

/// Sliding of a contact that wears in place.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SlidingSpec {
    /// Distance slid, > 0.
    pub distance: Metre,
    /// Speed of the upper body over the lower one, > 0; unknown if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<MetrePerSecond>,
    /// Number of implicit updates, ≥ 1.
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

impl Case {
    /// Returns the sliding of a contact that wears in place, on this apparent area; `None` for others.
    pub fn slide(&self, apparent_area: SquareMetre) -> Option<Slide> {
        let SlidingSpec { distance, speed, updates } = self.sliding?;
        let control = self.contact.prescribed.control(apparent_area);
        let slide = Slide::graded(distance, updates, control).with_speed(speed);
        let friction = self.friction.as_ref().map(|friction| friction.law);
        Some(slide.with_friction(friction).with_bulk(self.temperature.map(|temperature| temperature.bulk)))
    }
}

//! `[sliding]`: a static contact that slides some distance in place.

use serde::Serialize;

use super::Case;
use asperity_base::exists;
use asperity_base::units::{Metre, MetrePerSecond, SquareMetre};
use asperity_contact::motion::Slide;
use asperity_derive::Table;

/// Sliding in place.
#[derive(Table, Debug, Clone, Copy, PartialEq, Serialize)]
#[table("sliding")]
#[non_exhaustive]
pub struct SlidingSpec {
    /// Sliding distance.
    #[key(quantity = Length, range = AboveZero, example = "\"640 mm\"", exists = exists::LENGTH)]
    pub distance: Metre,
    /// Speed of the upper body; required for growing films and for temperature.
    #[key(quantity = Speed, range = AboveZero, absent = "unknown", example = "\"10 mm/s\"", exists = exists::SPEED)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<MetrePerSecond>,
    /// Number of implicit updates, each a contact with the changes of the bodies during it; update i of n
    /// ends at the distance · (i/n)².
    #[key(count = 1, default = 40, example = "80")]
    pub updates: usize,
}

impl Case {
    /// Returns the sliding in place, on this apparent area; `None` for others.
    pub fn slide(&self, apparent_area: SquareMetre) -> Option<Slide> {
        let SlidingSpec { distance, speed, updates } = self.sliding?;
        let control = self.contact.prescribed().control(apparent_area);
        let slide = Slide::graded(distance, updates, control).with_speed(speed);
        let friction = self.friction.as_ref().map(|friction| friction.law);
        Some(slide.with_friction(friction))
    }
}

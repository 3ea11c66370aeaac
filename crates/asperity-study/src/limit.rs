//! A limit of the model that a result exceeds.

use serde::{Deserialize, Deserializer, Serialize};

use crate::case::Side;
use asperity_base::choice::{Choice, choice};
use asperity_base::record::Record;
use asperity_contact::motion::{Column, Presence};

/// Name of the table of limits, without its ending.
pub(crate) const LIMITS_TABLE: &str = "limits";

/// A limit of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Limit {
    /// The rms slope of the gap between bodies that have changed.
    Slope,
    /// The depth that a cell loses in one pass.
    Wear,
    /// The pressure of elastic bodies.
    Pressure,
    /// The share of the cells at the hardness.
    Hardness,
    /// The surface temperature, K.
    Temperature,
    /// The mean thickness of a film.
    Film,
    /// The elastic displacement.
    Displacement,
    /// The plastic interference.
    Interference,
}

choice!(Limit:
    "slope" => Slope, "wear" => Wear, "pressure" => Pressure, "hardness" => Hardness, "temperature" => Temperature,
    "film" => Film, "displacement" => Displacement, "interference" => Interference,
);

/// A limit of the model, the first result beyond it, and its place: a row of `limits.csv`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct BrokenLimit {
    /// Pass of a motion, from 1; left out of a static contact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pass: Option<usize>,
    /// Position in the pass, increment, point (each from 1) or update (from 0); `None` for a pass as a whole.
    pub step: Option<usize>,
    /// The limit.
    #[serde(deserialize_with = "word")]
    pub limit: Limit,
    /// The body; `None` if it concerns both.
    #[serde(deserialize_with = "word_or_none")]
    pub body: Option<Side>,
    /// The result, SI.
    pub value: f64,
    /// The limit that it exceeds, SI.
    pub bound: f64,
}

impl Record for BrokenLimit {
    const COLUMNS: &'static [Column] = &[
        Column { presence: Presence::Optional, ..Column::new("pass", "1", "Pass.") },
        Column {
            presence: Presence::Unknown,
            ..Column::new("step", "1", "Position, increment, point or update.")
        },
        Column::new("limit", "", "Limit."),
        Column { presence: Presence::Unknown, ..Column::new("body", "", "Body.") },
        Column::new("value", "1", "Result, SI."),
        Column::new("bound", "1", "Limit, SI."),
    ];
}

/// Reads an option from its word.
fn word<'de, D: Deserializer<'de>, C: Choice>(deserializer: D) -> std::result::Result<C, D::Error> {
    word_or_none(deserializer)?.ok_or_else(|| serde::de::Error::custom("no such word"))
}

/// Reads an option from its word, `None` from another text.
fn word_or_none<'de, D: Deserializer<'de>, C: Choice>(
    deserializer: D,
) -> std::result::Result<Option<C>, D::Error> {
    Ok(C::of_word(&String::deserialize(deserializer)?))
}

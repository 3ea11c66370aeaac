//! A limit of the model that a result exceeds.

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::case::Side;
use asperity_base::choice::Choice;
use asperity_base::record::Record;
use asperity_contact::each;
use asperity_contact::motion::{Column, Presence};
use asperity_contact::with::BodyLaw;

/// Name of the table of limits, without its ending.
pub(crate) const LIMITS_TABLE: &str = "limits";

/// A limit of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Limit {
    /// The rms slope of the gap between bodies that have changed.
    Slope,
    /// The limit of a law that changes the bodies, by its name.
    Law(&'static str),
    /// The pressure of elastic bodies.
    Pressure,
    /// The share of the cells at the hardness.
    Hardness,
    /// The surface temperature, K.
    Temperature,
    /// The elastic displacement.
    Displacement,
    /// The plastic interference.
    Interference,
}

impl Limit {
    /// The limits of every contact.
    const OF_CONTACTS: [Self; 6] = [
        Self::Slope,
        Self::Pressure,
        Self::Hardness,
        Self::Temperature,
        Self::Displacement,
        Self::Interference,
    ];

    /// The word of this limit.
    pub fn word(self) -> &'static str {
        match self {
            Self::Slope => "slope",
            Self::Law(name) => name,
            Self::Pressure => "pressure",
            Self::Hardness => "hardness",
            Self::Temperature => "temperature",
            Self::Displacement => "displacement",
            Self::Interference => "interference",
        }
    }

    /// Returns the limit for this word, if there is one.
    pub fn of_word(word: &str) -> Option<Self> {
        let mut limits = Self::OF_CONTACTS.to_vec();
        each!(law L => limits.push(Self::Law(L::NAME)));
        limits.into_iter().find(|limit| limit.word() == word)
    }
}

impl Serialize for Limit {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        serializer.serialize_str(self.word())
    }
}

impl<'de> Deserialize<'de> for Limit {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        Self::of_word(&String::deserialize(deserializer)?).ok_or_else(|| D::Error::custom("no such limit"))
    }
}

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

/// Reads an option from its word, `None` from another text.
fn word_or_none<'de, D: Deserializer<'de>, C: Choice>(
    deserializer: D,
) -> std::result::Result<Option<C>, D::Error> {
    Ok(C::of_word(&String::deserialize(deserializer)?))
}

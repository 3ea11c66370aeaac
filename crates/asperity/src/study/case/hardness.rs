//! What a body bears: one pressure, or a map of its cells.

use std::path::PathBuf;

use serde::{Serialize, Serializer};

use super::Number;
use crate::units::Pascal;

/// Hardness of a body.
#[derive(Debug, Clone, PartialEq)]
pub enum Hardness {
    /// The same in every cell, > 0; infinite for an elastic body.
    Uniform(Pascal),
    /// A value for each cell of the body as it is prepared.
    Map(HardnessMap),
    /// A value for each cell, which the caller has in memory, see [`Given`](crate::study::Given).
    Given(GivenMap),
}

/// A hardness that the caller has in memory.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GivenMap {
    /// The name under which it is given.
    #[serde(rename = "given")]
    pub name: String,
}

/// A hardness that is read from a file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HardnessMap {
    /// The file.
    #[serde(rename = "file")]
    pub path: PathBuf,
    /// Its channel; the first one if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub channel: Option<String>,
    /// What a 1 in the file stands for, > 0.
    pub unit: Pascal,
}

impl Hardness {
    /// Whether any cell can yield.
    pub fn yields(&self) -> bool {
        match self {
            Self::Uniform(value) => value.is_finite(),
            Self::Map(_) | Self::Given(_) => true,
        }
    }
}

impl Serialize for Hardness {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        match self {
            Self::Uniform(value) => Number::from(*value).serialize(serializer),
            Self::Map(map) => map.serialize(serializer),
            Self::Given(map) => map.serialize(serializer),
        }
    }
}

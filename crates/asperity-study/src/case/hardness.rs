//! Hardness of a body: one pressure, or a map of its cells.

use std::path::PathBuf;

use serde::{Serialize, Serializer};

use super::Number;
use asperity_base::units::Pascal;
use asperity_surface::{Axis, ReadOptions};

/// Hardness of a body.
#[derive(Debug, Clone, PartialEq)]
pub enum Hardness {
    /// The same value in every cell, > 0; infinite for an elastic body.
    Uniform(Pascal),
    /// A value for each cell of the prepared body.
    Map(HardnessMap),
    /// A value for each cell, supplied in memory by the caller, see [`SurfaceInput`](crate::SurfaceInput).
    Given(HardnessInput),
}

/// A hardness supplied in memory by the caller.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HardnessInput {
    /// The name under which it is supplied.
    #[serde(rename = "given")]
    pub name: String,
}

/// A hardness read from a file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HardnessMap {
    /// The file.
    #[serde(rename = "file")]
    pub path: PathBuf,
    /// Channel of the file; the first one by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub channel: Option<String>,
    /// Size of the unit of the values in the file, > 0.
    pub unit: Pascal,
    /// Direction of a line of a matrix whose format does not determine it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lines: Option<Axis>,
    /// Number of lines above the numbers of a text.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub skip: Option<usize>,
}

impl HardnessMap {
    /// Returns the options for reading the file.
    pub(crate) fn reading(&self) -> ReadOptions {
        let mut options = ReadOptions::default();
        options.channel.clone_from(&self.channel);
        (options.lines, options.skip) = (self.lines, self.skip.unwrap_or_default());
        options
    }
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

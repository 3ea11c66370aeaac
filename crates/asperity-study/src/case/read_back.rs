//! Reads a case from what it serialises to.

use std::path::Path;

use serde::de::Error;
use serde::{Deserialize, Deserializer};
use serde_json::{Map, Value};

use super::Case;

/// Reads a case from the keys of the case file, in any format of serde. Keys without a value count as absent;
/// relative names of files stay as they are.
impl<'de> Deserialize<'de> for Case {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let keys = given(Map::deserialize(deserializer)?);
        // The reader of case files checks each key, and which keys go together.
        let text = toml::to_string(&keys).map_err(D::Error::custom)?;
        Self::parse(&text, Path::new("case"), Path::new("")).map_err(D::Error::custom)
    }
}

/// Returns the keys that have a value.
fn given(keys: Map<String, Value>) -> Map<String, Value> {
    let of_tables = |value: Value| match value {
        Value::Object(keys) => Value::Object(given(keys)),
        other => other,
    };
    keys.into_iter()
        .filter(|(_, value)| !value.is_null())
        .map(|(key, value)| (key, of_tables(value)))
        .collect()
}

//! Deserialisation of a case from its serialised form.

use std::path::Path;

use serde::de::Error;
use serde::{Deserialize, Deserializer};

use super::Case;

/// Reads a case from the keys of the case file, in any format of serde. Relative names of files stay as they are.
impl<'de> Deserialize<'de> for Case {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let keys = toml::Table::deserialize(deserializer)?;
        // The reader of case files checks each key, and combinations of keys.
        Self::parse(&keys.to_string(), Path::new("case"), Path::new("")).map_err(D::Error::custom)
    }
}

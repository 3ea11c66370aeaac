//! A file that a study names.

use std::path::PathBuf;

/// A file named in a study: its dotted key in the case, the text that names it in the study, and its path
/// from the working directory.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct NamedFile {
    pub(super) key: String,
    /// The text on an axis; `None` for a file of the base.
    pub(super) value: Option<String>,
    pub(super) path: PathBuf,
}

impl NamedFile {
    /// Name of the file among the digests, independent of the place of the study: its key, and for an axis
    /// its value.
    pub(super) fn name(&self) -> String {
        match &self.value {
            None => self.key.clone(),
            Some(value) => format!("{} = {value}", self.key),
        }
    }
}

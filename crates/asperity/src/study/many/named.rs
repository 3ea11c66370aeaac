//! A file that a study names.

use std::path::PathBuf;

/// A file that a study names: its dotted key in the case, the text that names it in the study, where it lies as seen from here.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct NamedFile {
    pub(super) key: String,
    /// As an axis has it; none of a file of the base.
    pub(super) value: Option<String>,
    pub(super) path: PathBuf,
}

impl NamedFile {
    /// What it is called among the digests, wherever the study lies: its key, of an axis with its value.
    pub(super) fn name(&self) -> String {
        match &self.value {
            None => self.key.clone(),
            Some(value) => format!("{} = {value}", self.key),
        }
    }
}

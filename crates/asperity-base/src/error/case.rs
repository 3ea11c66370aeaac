use std::ops::Range;
use std::path::PathBuf;

/// A mistake in a case file, and its place.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}:{line}: {message}", file.display())]
pub struct CaseError {
    /// The file, as the caller named it.
    pub file: PathBuf,
    /// The whole text of the file, to show the place.
    pub text: String,
    /// Line of the place, from 1.
    pub line: usize,
    /// Column of the place in characters, from 1.
    pub column: usize,
    /// The place in bytes of the text; empty if something is missing from the file as a whole.
    pub span: Range<usize>,
    /// Dotted key: `upper.hardness`. Empty if the mistake belongs to no key.
    pub key: String,
    /// The mistake, with the value found and the values expected.
    pub message: String,
    /// Advice for the user.
    pub hint: Option<String>,
}

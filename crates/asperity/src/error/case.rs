use std::ops::Range;
use std::path::PathBuf;

/// A mistake in a case file, and where it stands.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}:{line}: {message}", file.display())]
#[non_exhaustive]
pub struct CaseError {
    /// The file, as the caller named it.
    pub file: PathBuf,
    /// All of its text, so that the place can be shown.
    pub text: String,
    /// Line of the place, from 1.
    pub line: usize,
    /// Column of the place in characters, from 1.
    pub column: usize,
    /// The place in bytes of the text; empty where something is missing from the file as a whole.
    pub span: Range<usize>,
    /// Dotted: `upper.hardness`. Empty where the mistake belongs to no key.
    pub key: String,
    /// What is wrong, with the value and what was expected.
    pub message: String,
    /// What to do about it.
    pub hint: Option<String>,
}

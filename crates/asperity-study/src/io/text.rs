//! Reading of text files in UTF-8.

use std::io::{self, ErrorKind};
use std::path::Path;

use super::regular;
use asperity_base::error::{Error, Result};

/// Reads the text at `path`, of at most `most` bytes. `expected` describes it: "a case file".
///
/// # Errors
/// [`Error::File`] if it cannot be read or is no text.
pub(crate) fn text_of(path: &Path, expected: &str, most: u64) -> Result<String> {
    let failed = |source| Error::File { path: path.to_owned(), source };
    let text = regular::read(path, expected, most).map_err(failed)?;
    let no_text = format!("is no text in UTF-8, expected {expected}");
    String::from_utf8(text).map_err(|_| failed(io::Error::new(ErrorKind::InvalidData, no_text)))
}

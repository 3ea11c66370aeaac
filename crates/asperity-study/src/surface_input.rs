//! Surfaces and maps that a caller supplies to a case in place of files.

use std::collections::BTreeMap;
use std::path::PathBuf;

use asperity_base::error::{Error, Result};
use asperity_base::grid::Field;
use asperity_surface::Topography;

/// Surfaces and maps in memory that a case names: `given = "NAME"` in the table of a topography or of a
/// hardness, in place of `file`. Each is used once.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct SurfaceInput {
    /// Heights, m, NaN where undefined, by name.
    pub topographies: BTreeMap<String, Topography>,
    /// Hardness of the cells of a body after its preparation, Pa, by name.
    pub hardness: BTreeMap<String, Field>,
    /// Required content of the files of the case; `None` if any content is accepted.
    pub(super) pinned: Option<ExpectedContent>,
}

/// Content that files must have to match the results of an earlier run.
#[derive(Debug, Clone)]
pub(super) struct ExpectedContent {
    /// The directory of the results.
    pub(super) directory: PathBuf,
    /// Path and hexadecimal digest of each file, by the dotted key that names it.
    pub(super) digests: BTreeMap<String, (PathBuf, String)>,
}

impl SurfaceInput {
    /// Returns an error unless the file named at a dotted key may have this digest.
    pub(super) fn admit(&self, key: &str, sha256: &str) -> Result<()> {
        let Some(pinned) = &self.pinned else { return Ok(()) };
        match pinned.digests.get(key) {
            Some((file, digest)) if digest != sha256 => {
                Err(Error::SurfaceChanged { path: pinned.directory.clone(), file: file.clone() })
            }
            _ => Ok(()),
        }
    }

    /// Returns the topography of this name.
    pub(super) fn topography(&self, name: &str) -> Result<&Topography> {
        self.topographies.get(name).ok_or(NOT_GIVEN)
    }

    /// Removes and returns the topography of this name.
    pub(super) fn take_topography(&mut self, name: &str) -> Result<Topography> {
        self.topographies.remove(name).ok_or(NOT_GIVEN)
    }

    /// Removes and returns the map of this name.
    pub(super) fn take_hardness(&mut self, name: &str) -> Result<Field> {
        self.hardness.remove(name).ok_or(NOT_GIVEN)
    }
}

/// Error for a name that the caller did not supply.
const NOT_GIVEN: Error =
    Error::Unsupported("nothing of that name is given: only a program that calls the library can give it");

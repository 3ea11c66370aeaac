//! What a caller hands over to a case, in place of files.

use std::collections::BTreeMap;
use std::path::PathBuf;

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::surface::Topography;

/// Surfaces and maps in memory that a case names: `given = "NAME"` in the table of a topography or of a hardness, where a case
/// file has `file`. Each is taken once.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct Given {
    /// Heights, m, NaN where undefined, by name.
    pub topographies: BTreeMap<String, Topography>,
    /// Hardness, Pa, of the cells of a body as it is prepared, by name.
    pub hardness: BTreeMap<String, Field>,
    /// What the files of the case must hold; nothing where any content will do.
    pub(super) pinned: Option<Pinned>,
}

/// What files must hold to be those that results were begun with.
#[derive(Debug, Clone)]
pub(super) struct Pinned {
    /// The directory of the results.
    pub(super) directory: PathBuf,
    /// By the dotted key that names a file: its path, and its digest, hexadecimal.
    pub(super) digests: BTreeMap<String, (PathBuf, String)>,
}

impl Given {
    /// An error unless the file that is named at a dotted key may have this digest.
    pub(super) fn admit(&self, key: &str, sha256: &str) -> Result<()> {
        let Some(pinned) = &self.pinned else { return Ok(()) };
        match pinned.digests.get(key) {
            Some((file, digest)) if digest != sha256 => {
                Err(Error::SurfaceChanged { path: pinned.directory.clone(), file: file.clone() })
            }
            _ => Ok(()),
        }
    }

    /// The topography of that name, to be looked at.
    pub(super) fn topography(&self, name: &str) -> Result<&Topography> {
        self.topographies.get(name).ok_or(NOT_GIVEN)
    }

    /// The topography of that name, which is the caller's no more.
    pub(super) fn take_topography(&mut self, name: &str) -> Result<Topography> {
        self.topographies.remove(name).ok_or(NOT_GIVEN)
    }

    /// The map of that name, which is the caller's no more.
    pub(super) fn take_hardness(&mut self, name: &str) -> Result<Field> {
        self.hardness.remove(name).ok_or(NOT_GIVEN)
    }
}

/// A case names what nobody has handed over.
const NOT_GIVEN: Error =
    Error::Unsupported("nothing of that name is given: only a program that calls the library can give it");

//! What a caller hands over to a case, in place of files.

use std::collections::BTreeMap;

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
}

impl Given {
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

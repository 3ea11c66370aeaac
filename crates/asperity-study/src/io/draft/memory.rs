//! A field file in memory, which is encoded once it is complete.

use std::path::{Path, PathBuf};

use hdf5_pure::{AttrValue, FileBuilder};

use super::{Attributes, PackedArray, Result, fill};
use crate::io::fs;

/// A field file before it is encoded.
pub(in crate::io) struct FieldDraft {
    path: PathBuf,
    file: FileBuilder,
}

impl FieldDraft {
    /// Creates it for the file at `path`, whose folder exists.
    pub(in crate::io) fn new(path: &Path) -> Result<Self> {
        Ok(Self { path: path.to_owned(), file: FileBuilder::new() })
    }

    /// Path of the file.
    pub(in crate::io) fn path(&self) -> &Path {
        &self.path
    }

    /// Adds an array with its attributes.
    pub(in crate::io) fn add(
        &mut self,
        name: &str,
        values: &[f64],
        shape: &[u64],
        attributes: Attributes,
    ) -> Result<()> {
        fill(self.file.create_dataset(name), values, shape, attributes);
        Ok(())
    }

    /// Adds a packed array: there is none.
    pub(in crate::io) fn add_packed(&mut self, array: PackedArray) -> Result<()> {
        match array.packed {}
    }

    /// Gives the file these attributes and its name.
    pub(in crate::io) fn publish(
        mut self,
        attributes: impl Iterator<Item = (String, AttrValue)>,
    ) -> Result<()> {
        attributes.for_each(|(name, value)| self.file.set_attr(&name, value));
        Ok(fs::write(&self.path, self.file.finish()?)?)
    }
}

/// Chunks of an array as they are in its file. There are none before the file is encoded.
pub(in crate::io) enum Packed {}

impl Packed {
    /// Returns `None`: the library of the format packs all arrays.
    pub(in crate::io) fn new(_: &[f64], _: &[u64]) -> Option<Self> {
        None
    }
}

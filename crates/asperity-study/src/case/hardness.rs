//! Hardness of a body: one pressure, or a map of its cells.

use std::path::{Path, PathBuf};

use serde::{Serialize, Serializer};

use super::source::{Layout, named};
use asperity_base::error::Result;
use asperity_base::exists;
use asperity_base::table::{Bounds, Key, Kind, Part as _, Source, Value, unit};
use asperity_base::units::{Dimension, Pascal, or_inf};
use asperity_derive::Part;
use asperity_surface::ReadOptions;

/// Hardness of a body.
#[derive(Debug, Clone, PartialEq)]
pub enum Hardness {
    /// The same value in every cell, > 0; infinite for an elastic body.
    Uniform(Pascal),
    /// A value for each cell of the prepared body.
    Map(HardnessMap),
}

/// Source of the hardness of the cells.
#[derive(Part, Debug, Clone, PartialEq, Serialize)]
#[part(hint = "for example `file = \"hardness.npy\"`", check = is_named)]
#[serde(untagged)]
pub enum HardnessMap {
    /// A file.
    File {
        /// File of numbers (npy, npz, mat, csv, text, tiff or HDF5), relative to the case file.
        #[key(text, example = "\"hardness.npy\"")]
        file: PathBuf,
        /// Channel, if the file has several.
        #[key(text, absent = "the first", example = "\"hardness\"")]
        #[serde(skip_serializing_if = "Option::is_none")]
        channel: Option<String>,
        /// Unit of the numbers in the file.
        #[key(
            special = unit,
            form = "unit, or pressure > 0",
            dimension = Pressure,
            default = 1.0,
            written = "\"Pa\"",
            example = "\"GPa\"",
            exists = exists::UNIT
        )]
        unit: Pascal,
        /// Place of the numbers in a text or an array.
        #[key(part)]
        #[serde(flatten)]
        layout: Layout,
    },
    /// Supplied in memory by the caller, see [`SurfaceInput`](crate::SurfaceInput).
    Given {
        /// Name of a map in the memory of the caller.
        #[key(text, example = "\"map\"")]
        given: String,
    },
}

impl HardnessMap {
    /// The tables of a map.
    pub(super) const TABLES: &[&str] = &["lower.hardness", "upper.hardness"];

    /// Returns the options for reading the file.
    pub(crate) fn reading(&self) -> ReadOptions {
        match self {
            Self::File { channel, layout, .. } => layout.reading(channel.as_ref()),
            Self::Given { .. } => ReadOptions::default(),
        }
    }
}

fn is_named(read: &HardnessMap, source: &dyn Source) -> Result<()> {
    match read {
        HardnessMap::File { file, .. } => named(file, source),
        HardnessMap::Given { .. } => Ok(()),
    }
}

impl Hardness {
    /// Whether any cell can yield.
    pub fn yields(&self) -> bool {
        match self {
            Self::Uniform(value) => value.is_finite(),
            Self::Map(_) => true,
        }
    }

    /// Returns the hardness with the file relative to a `folder`.
    pub(super) fn in_folder(mut self, folder: &Path) -> Self {
        if let Self::Map(HardnessMap::File { file, .. }) = &mut self {
            *file = folder.join(&*file);
        }
        self
    }
}

impl Serialize for Hardness {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        match self {
            Self::Uniform(value) => or_inf(value, serializer),
            Self::Map(map) => map.serialize(serializer),
        }
    }
}

/// Reads one pressure, or a table that names a map.
pub(super) fn hardness(value: &dyn Value, key: &Key) -> Result<Hardness> {
    const ONE: Kind = Kind::Quantity(
        Dimension::Pressure,
        Bounds::AboveZeroOrInfinite("an elastic body, as is leaving it out"),
    );
    if value.is_table() {
        HardnessMap::read(value.table()?.as_ref()).map(Hardness::Map)
    } else {
        value.real(key, &ONE).map(Hardness::Uniform)
    }
}

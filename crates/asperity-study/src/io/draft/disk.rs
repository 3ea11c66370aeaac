//! A field file under a temporary name on the disk. Arrays are written while others are added, so that only a
//! few are in memory.

use std::path::{Path, PathBuf};

use hdf5_pure::{AttrValue, File, FileAccessProperties, FileCreateProperties, FileLocking, SyncPolicy};
use rayon::prelude::*;

use super::{Attributes, DEFLATE_LEVEL, PackedArray, Result, chunk, fill, image};
use crate::io::atomic::Draft;
use asperity_base::io::packing;

/// A field file under its temporary name.
pub(in crate::io) struct FieldDraft {
    path: PathBuf,
    file: File,
    draft: Draft,
    /// Bytes of the arrays waiting to be written.
    waiting: usize,
}

impl FieldDraft {
    /// Creates it for the file at `path`, whose folder exists.
    pub(in crate::io) fn new(path: &Path) -> Result<Self> {
        let draft = Draft::new(path)?;
        let create = FileCreateProperties::new();
        // No other process knows it, and it is synchronised to disk when it is published.
        let access = FileAccessProperties::new().with_locking(FileLocking::Disabled);
        let access = access.with_sync_policy(SyncPolicy::OnClose);
        let file = File::create_with_options(draft.temporary_path(), create, access)?;
        Ok(Self { path: path.to_owned(), file, draft, waiting: 0 })
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
        self.file.root().create_dataset(name, |dataset| fill(dataset, values, shape, attributes))?;
        self.wait(size_of_val(values))
    }

    /// Adds a packed array with its attributes.
    pub(in crate::io) fn add_packed(&mut self, array: PackedArray) -> Result<()> {
        let PackedArray { name, shape, packed, attributes } = array;
        let image = image::image(&shape, &packed.chunk, &packed.chunks, DEFLATE_LEVEL);
        drop(packed);
        let bytes = image.len();
        let image = File::from_bytes(image)?;
        self.file.copy_from(&image, image::NAME, &name)?;
        drop(image);
        // Attributes with texts do not come with a copy.
        self.file.commit()?;
        let mut dataset = self.file.dataset(&name)?;
        for (name, value) in attributes {
            dataset.set_attr(name, value)?;
        }
        self.waiting = 0;
        self.wait(bytes)
    }

    /// Gives the file these attributes and its name.
    pub(in crate::io) fn publish(self, attributes: impl Iterator<Item = (String, AttrValue)>) -> Result<()> {
        for (name, value) in attributes {
            self.file.root().set_attr(&name, value)?;
        }
        self.file.commit()?;
        self.file.close()?;
        self.draft.publish().map_err(hdf5_pure::Error::Io)
    }

    /// Adds this number of bytes to those of the waiting arrays, and writes these if they are many.
    fn wait(&mut self, bytes: usize) -> Result<()> {
        self.waiting += bytes;
        if self.waiting >= MAX_WAITING {
            self.file.commit()?;
            self.waiting = 0;
        }
        Ok(())
    }
}

/// Chunks of an array as they are in its file.
pub(in crate::io) struct Packed {
    chunk: Vec<u64>,
    chunks: Vec<Vec<u8>>,
}

impl Packed {
    /// Packs an array whose chunks are whole rows; `None` for other arrays, and for small ones.
    pub(in crate::io) fn new(values: &[f64], shape: &[u64]) -> Option<Self> {
        let chunk = chunk(shape);
        let len: u64 = chunk.iter().product();
        if values.len() < MIN_PACKED || chunk[1..] != shape[1..] || shape[0].div_ceil(chunk[0]) > MAX_CHUNKS {
            return None;
        }
        let pack = |values: &[f64]| packing::packed(values, len as usize, DEFLATE_LEVEL);
        let chunks = values.par_chunks(len as usize).map(pack).collect();
        Some(Self { chunk, chunks })
    }
}

/// Bytes of arrays that are written together.
const MAX_WAITING: usize = 1 << 24;
/// Fields with fewer values are compressed by the library of the format, because a file of many fields should
/// not be committed after each of them.
const MIN_PACKED: usize = 1 << 19;
/// Chunks that one node of the image of an array holds.
const MAX_CHUNKS: u64 = 1 << 15;

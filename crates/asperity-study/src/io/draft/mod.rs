//! A field file being written: on the disk, or in memory where there is no disk.

#[cfg(not(any(feature = "memory", all(target_arch = "wasm32", target_os = "unknown"))))]
mod disk;
#[cfg(not(any(feature = "memory", all(target_arch = "wasm32", target_os = "unknown"))))]
mod image; // HDF5 in memory, of one array
#[cfg(any(feature = "memory", all(target_arch = "wasm32", target_os = "unknown")))]
mod memory;

use hdf5_pure::{AttrValue, DatasetBuilder};

#[cfg(not(any(feature = "memory", all(target_arch = "wasm32", target_os = "unknown"))))]
pub(super) use disk::{FieldDraft, Packed};
#[cfg(any(feature = "memory", all(target_arch = "wasm32", target_os = "unknown")))]
pub(super) use memory::{FieldDraft, Packed};

/// Result of the library of the format.
type Result<T> = std::result::Result<T, hdf5_pure::Error>;

/// The attributes of an array.
pub(super) type Attributes = [(&'static str, AttrValue); 4];

/// A packed array with its attributes.
#[cfg_attr(
    any(feature = "memory", all(target_arch = "wasm32", target_os = "unknown")),
    expect(dead_code, reason = "no array is packed before its file")
)]
pub(super) struct PackedArray {
    pub(super) name: String,
    pub(super) shape: Vec<u64>,
    pub(super) packed: Packed,
    pub(super) attributes: Attributes,
}

/// Sets the values and the attributes of an array.
fn fill(dataset: &mut DatasetBuilder, values: &[f64], shape: &[u64], attributes: Attributes) {
    dataset.with_f64_data(values).with_shape(shape);
    if values.len() >= MIN_COMPRESSED {
        dataset.with_chunks(&chunk(shape)).with_shuffle().with_deflate(DEFLATE_LEVEL);
    }
    for (name, value) in attributes {
        dataset.set_attr(name, value);
    }
}

/// Fields with fewer values are not compressed.
const MIN_COMPRESSED: usize = 1024;
/// Level of the compression, 1 to 9. Higher levels gain less than 1 %.
const DEFLATE_LEVEL: u32 = 2;

/// Returns the chunk shape: whole rows, about 1 MiB of them; for very long rows a part.
fn chunk(shape: &[u64]) -> Vec<u64> {
    /// Number of values in a chunk.
    const VALUES: u64 = 1 << 17;
    // From 2¹⁶ on hdf5-pure 0.47 stores the sizes of a chunk in 4 bytes where 3 are enough, which HDF5 2
    // rejects.
    const MAX_CHUNK_SIDE: u64 = 1 << 15;
    match *shape {
        [nx, ny] => vec![(VALUES / ny).clamp(1, nx.min(MAX_CHUNK_SIDE)), ny.min(MAX_CHUNK_SIDE)],
        [nx, ny, nz] => {
            let nz = nz.min(MAX_CHUNK_SIDE);
            let [nx, ny] =
                [(VALUES / (ny * nz)).clamp(1, nx.min(MAX_CHUNK_SIDE)), (VALUES / nz).clamp(1, ny)];
            vec![nx, ny.min(MAX_CHUNK_SIDE), nz]
        }
        _ => vec![shape[0].min(MAX_CHUNK_SIDE)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_fit_their_arrays_and_the_encoding() {
        for shape in [
            &[3, 2][..],
            &[1024, 1024],
            &[2, 200_000],
            &[200_000, 2],
            &[1, 70_000],
            &[300_000],
            &[512, 512, 64],
            &[3, 2, 512],
            &[100_000, 3, 4],
        ] {
            let chunk = chunk(shape);
            assert_eq!(chunk.len(), shape.len());
            assert!(
                chunk.iter().zip(shape).all(|(chunk, size)| (1..=*size).contains(chunk) && *chunk < 1 << 16)
            );
            assert!(chunk.iter().product::<u64>() <= 1 << 17);
        }
    }
}

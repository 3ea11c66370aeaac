//! File access: atomic writing, fields in HDF5 and for ParaView.

mod digest; // SHA-256
pub mod fields; // HDF5: named fields with unit, axes, pitch
mod image; // HDF5 in memory, of one array
pub(crate) mod lock; // locks that end with their process
mod packing; // chunks of arrays, deflated
pub mod vti; // fields for ParaView

pub use asperity_base::io::{atomic, read_regular, regular, replace, sweep};
pub use digest::{sha256, sha256_of, sha256_of_file};

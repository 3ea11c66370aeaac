//! File access: atomic writing, fields in HDF5 and for ParaView.

pub(crate) mod atomic; // atomic files
mod digest; // SHA-256
pub mod fields; // HDF5: named fields with unit, axes, pitch
mod image; // HDF5 in memory, of one array
#[cfg(feature = "study")]
pub(crate) mod lock; // locks that end with their process
mod packing; // chunks of arrays, deflated
pub(crate) mod regular; // reading of regular files
pub mod vti; // fields for ParaView

pub use atomic::{replace, sweep};
pub(crate) use digest::sha256;
#[cfg(feature = "study")]
pub(crate) use digest::{sha256_of, sha256_of_file};
pub use regular::read as read_regular;

//! Files as such: written in full or not at all, fields in HDF5 and for ParaView.

pub(crate) mod atomic; // a file is there in full or not at all
mod digest; // SHA-256
pub mod fields; // HDF5: named fields with unit, axes, pitch
pub(crate) mod regular; // regular files, read as a whole
pub mod vti; // fields for ParaView

pub use atomic::{replace, sweep};
pub(crate) use digest::sha256;
#[cfg(feature = "study")]
pub(crate) use digest::sha256_of;

//! File access: atomic writing, fields in HDF5 and for ParaView.

mod digest; // SHA-256
mod draft; // a field file being written
pub mod fields; // HDF5: named fields with unit, axes, pitch
pub(crate) mod lock; // locks that end with their process
mod text; // text in UTF-8
pub mod vti; // fields for ParaView

pub use asperity_base::io::{atomic, fs, read_regular, regular, replace, sweep};
pub use digest::{sha256, sha256_of, sha256_of_file};
pub(crate) use text::text_of;

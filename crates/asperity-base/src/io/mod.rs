//! Files: reading of regular files, atomic writing.

pub mod atomic;
pub mod regular;

pub use atomic::{replace, sweep};
pub use regular::read as read_regular;

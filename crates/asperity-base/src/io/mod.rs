//! Files: reading of regular files and of text, atomic writing. They are on the disk, or in memory where
//! there is no disk: in a browser, and with the feature `memory`.

#[cfg(not(any(feature = "memory", all(target_arch = "wasm32", target_os = "unknown"))))]
mod disk;
#[cfg(any(feature = "memory", all(target_arch = "wasm32", target_os = "unknown")))]
mod memory;
pub mod packing;
pub mod regular;
pub mod text;

#[cfg(not(any(feature = "memory", all(target_arch = "wasm32", target_os = "unknown"))))]
pub use disk::{atomic, fs};
#[cfg(any(feature = "memory", all(target_arch = "wasm32", target_os = "unknown")))]
pub use memory::{atomic, fs};

pub use atomic::{replace, sweep};
pub use regular::read as read_regular;

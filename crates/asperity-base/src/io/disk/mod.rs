//! Files on the disk.

pub mod atomic;
pub mod fs;

//! Files in memory, by name. All threads of the process see the same files.

pub mod atomic;
pub mod fs;

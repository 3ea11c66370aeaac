//! Files: case files.

pub mod case;

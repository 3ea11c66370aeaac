//! Records: structs whose fields are columns of a table and keys of a summary, each with unit and meaning.

mod columns;
mod number;

pub use columns::{Column, Part, Presence};
pub use number::{OptionalNumber, known_or_none, number_or_none};

pub use crate::columns;

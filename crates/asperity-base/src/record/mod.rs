//! Records: structs whose fields are columns of a table and keys of a summary, each with unit and meaning.

mod columns;
mod number;

pub use columns::{Column, OverMotion, Part, Presence};
pub use number::{OptionalNumber, known_or_none, number_or_none};

pub use crate::columns;

use serde::Serialize;

use crate::error::Error;

/// A record that forms a row of a table, or a part of a summary.
pub trait Record: Serialize {
    /// Its columns, including those of optional groups.
    const COLUMNS: &'static [Column];

    /// Wraps an error as one at the step of the record.
    fn error_at(&self, error: Error) -> Error {
        error
    }
}

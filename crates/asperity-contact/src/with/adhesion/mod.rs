//! Attraction between the bodies of a case: its table, and what it comes to in numbers.
//!
//! The law is in [`crate::adhesion`], since it is a part of the contact problem.

mod record;
mod table;
mod views;

pub use record::{AdhesionSummary, depends_on_history, jumps};
pub use table::{AdhesionRange, Attraction};
pub use views::answers;

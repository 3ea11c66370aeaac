//! Results in words, for the terminal and the page alike.

mod clipped;
pub(crate) mod captions;
pub mod closed_form;
pub mod numbers;

pub use clipped::{MAX_CHARACTERS, MAX_LINES, clipped};

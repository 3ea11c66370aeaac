//! An oil between the bodies of a case: its table, its rules, and its results in words.
//!
//! The film is in [`crate::lubrication`], and its contacts in [`crate::motion`].

mod doubts;
mod rules;
mod table;
pub(super) mod views;

pub(super) use doubts::{after_passes, after_points};
pub use table::Lubricant;

use crate::with::Rule;

impl Lubricant {
    /// Name of its table in a case and in a summary.
    pub const NAME: &'static str = "lubrication";
    /// Heading of its section on the page.
    pub const TITLE: &'static str = "Lubrication";
    /// Its meaning in the list of the tables of a case.
    pub const MEANING: &'static str = "oil between the bodies";
    /// Combinations that exclude it, and what it requires.
    pub const RULES: &'static [Rule<Self>] = rules::RULES;
    /// Its numbers in the order of the page; none, since they belong to the points of a sweep.
    pub const LABELS: &'static [(&'static str, &'static str)] = &[];
}

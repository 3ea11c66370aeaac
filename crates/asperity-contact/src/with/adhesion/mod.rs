//! Attraction between the bodies of a case: its table, its rules, and its results in numbers and words.
//!
//! The law is in [`crate::adhesion`], since it is a part of the contact problem.

mod doubts;
mod record;
mod rules;
mod table;
#[cfg(test)]
mod tests;
pub(super) mod views;

pub(super) use doubts::{cut_off, depends_on_history, jumped};
pub use record::AdhesionSummary;
pub use table::{AdhesionRange, Attraction};
pub(super) use views::{ANSWERS, OF_POINTS, answers, jumps};

use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::operator::Boundary;
use crate::units::Pascal;
use crate::with::Rule;

impl Attraction {
    /// Name of its table in a case and in a summary.
    pub const NAME: &'static str = "adhesion";
    /// Heading of its section on the page.
    pub const TITLE: &'static str = "Adhesion";
    /// Its meaning in the list of the tables of a case.
    pub const MEANING: &'static str = "attraction between the bodies";
    /// Combinations that exclude it, and what it requires.
    pub const RULES: &'static [Rule<Self>] = rules::RULES;
    /// Its numbers in the order of the page: the columns, and their names there.
    pub const LABELS: &'static [(&'static str, &'static str)] = &views::LABELS;

    /// Returns its numbers for bodies with this composite modulus and this initial `gap`, and the reasons not
    /// to trust them.
    ///
    /// # Errors
    /// The errors of [`Self::on`].
    pub(super) fn numbers(
        &self,
        grid: &Grid,
        gap: &Field,
        boundary: Boundary,
        modulus: Pascal,
    ) -> Result<(AdhesionSummary, Vec<String>)> {
        let adhesion = self.on(grid, modulus)?;
        let numbers = AdhesionSummary::new(&adhesion, gap, grid.pitch, boundary, modulus);
        let pitch = grid.pitch[0].max(grid.pitch[1]);
        let doubts = doubts::unresolved(&numbers, &adhesion, modulus, pitch);
        Ok((numbers, doubts.into_iter().collect()))
    }
}

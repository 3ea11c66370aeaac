//! `[adhesion]`: the attraction between the bodies.

use serde::Serialize;

use super::Case;
use super::cursor::Table;
use super::schema::adhesion as keys;
use super::schema::tables::known_in;
use super::schema::values::adhesion::AdhesionRange;
use asperity_base::error::Result;
use asperity_base::grid::Grid;
use asperity_base::units::{JoulePerSquareMetre, Pascal};
use asperity_contact::adhesion::{Adhesion, Potential};
use asperity_contact::motion::AdhesionHistory;

/// Attraction between the bodies.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct AdhesionSpec {
    /// Work of adhesion, > 0.
    pub work: JoulePerSquareMetre,
    /// Range of the attraction.
    pub range: AdhesionRange,
    /// Form of the attraction.
    pub potential: Potential,
    /// Where the bodies come from at each position of a motion.
    #[serde(skip_serializing_if = "is_none")]
    pub history: AdhesionHistory,
}

pub(super) fn adhesion(table: &Table<'_>) -> Result<AdhesionSpec> {
    known_in(table)?;
    Ok(AdhesionSpec {
        work: keys::WORK.of(table)?,
        range: keys::RANGE.of(table)?,
        potential: keys::POTENTIAL.of(table)?,
        history: keys::HISTORY.of(table)?,
    })
}

impl Case {
    /// Returns the attraction of bodies with this composite modulus on a `grid`; `None` without adhesion.
    ///
    /// # Errors
    /// The errors of [`Adhesion::new`].
    pub(crate) fn attraction(&self, grid: &Grid, modulus: Pascal) -> Result<Option<Adhesion>> {
        let Some(AdhesionSpec { work, range, potential, .. }) = self.adhesion else { return Ok(None) };
        let range = match range {
            AdhesionRange::Length(range) => range,
            AdhesionRange::Grid => Adhesion::grid_range(work, modulus, grid.pitch[0].max(grid.pitch[1])),
        };
        Ok(Some(Adhesion::new(work, range)?.with_potential(potential)))
    }
}

fn is_none(history: &AdhesionHistory) -> bool {
    *history == AdhesionHistory::None
}

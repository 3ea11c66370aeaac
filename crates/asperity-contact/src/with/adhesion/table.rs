//! The table `[adhesion]`.

use serde::{Serialize, Serializer};

use crate::adhesion::{Adhesion, History, Potential};
use crate::error::Result;
use crate::grid::Grid;
use crate::units::{Dimension, JoulePerSquareMetre, Metre, Pascal};
use asperity_base::beside::{Beside, Scale};
use asperity_base::choice::near;
use asperity_base::table::{Bounds, Exists, Key, Kind, Value};
use asperity_derive::Table;

/// Attraction between the bodies.
#[derive(Table, Debug, Clone, Copy, PartialEq, Serialize)]
#[table("adhesion")]
#[non_exhaustive]
pub struct Attraction {
    /// Work of adhesion: the energy that separates an area of flat surfaces.
    #[key(quantity = SurfaceEnergy, range = AboveZero, example = "\"50 mJ/m2\"", exists = WORK)]
    pub work: JoulePerSquareMetre,
    /// Range of the attraction, the gap at which the exponential tension has fallen to 1/e.
    #[key(
        special = range,
        form = "length > 0, or `\"grid\"`: the shortest range that the grid resolves",
        dimension = Length,
        example = "\"2 nm\"",
        exists = RANGE,
        beside = [Beside::most(Scale::FreeSide, 0.2, "the attraction ends at the rim of the grid")]
    )]
    pub range: AdhesionRange,
    /// Tension as a function of the gap: `"exponential"`, or constant up to the range, for comparison with
    /// closed forms.
    #[key(choice, default = Potential::Exponential, example = "\"dugdale\"")]
    pub potential: Potential,
    /// In a motion: `"none"`, the bodies come from afar at each position; `"path"`, in a shift, from the
    /// position before, so that jumps lose energy.
    #[key(choice, default = History::None, example = "\"path\"")]
    #[serde(skip_serializing_if = "is_none")]
    pub history: History,
}

/// Israelachvili, Intermolecular and Surface Forces: 0.1 mJ/m² in liquids to some J/m² of clean metals.
const WORK: Exists =
    Exists::Within { least: 1e-4, most: 10.0, of: "solids in liquids to clean metals", slips: &["mJ/m2"] };
const RANGE: Exists =
    Exists::Within { least: 1e-11, most: 1e-4, of: "atoms to capillary bridges", slips: &["nm"] };

/// Range of the attraction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AdhesionRange {
    /// A length, > 0.
    Length(Metre),
    /// The shortest range that the grid resolves.
    Grid,
}

/// The word for the shortest range that the grid resolves.
const GRID: &str = "grid";

impl Serialize for AdhesionRange {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        match self {
            Self::Length(length) => serializer.serialize_f64(*length),
            Self::Grid => serializer.serialize_str(GRID),
        }
    }
}

impl Attraction {
    /// Whether the bodies come from the position before at each position of a pass.
    pub(in crate::with) fn follows_path(&self) -> bool {
        self.history == History::Path
    }

    /// Returns the law for bodies with this composite modulus on a `grid`.
    ///
    /// # Errors
    /// The errors of [`Adhesion::new`].
    pub fn on(&self, grid: &Grid, modulus: Pascal) -> Result<Adhesion> {
        let range = match self.range {
            AdhesionRange::Length(range) => range,
            AdhesionRange::Grid => Adhesion::grid_range(self.work, modulus, grid.pitch[0].max(grid.pitch[1])),
        };
        Ok(Adhesion::new(self.work, range)?.with_potential(self.potential).with_history(self.history))
    }
}

/// Reads a length above 0, or the word for the shortest range that the grid resolves.
fn range(value: &dyn Value, key: &Key) -> Result<AdhesionRange> {
    match value.text() {
        Ok(GRID) => Ok(AdhesionRange::Grid),
        // No word is a length.
        Ok(word) if !word.contains(|c: char| c.is_ascii_digit()) => {
            let hint = near(&[GRID])(word);
            Err(value.unexpected("a length above 0 such as \"2 nm\", or \"grid\"", hint.as_deref()))
        }
        _ => {
            value.real(key, &Kind::Quantity(Dimension::Length, Bounds::AboveZero)).map(AdhesionRange::Length)
        }
    }
}

/// Whether it is the default.
fn is_none(history: &History) -> bool {
    *history == History::None
}

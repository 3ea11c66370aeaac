//! A body whose cells a motion can change.

use std::collections::BTreeMap;

use crate::error::{Result, check_in};
use crate::grid::{CellValues, Field};
use crate::units::{Dimension, Metre};

/// One of two contacting bodies: its heights, and its other properties that a motion may change cell by cell.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Body {
    /// Heights of the surface, m; for the upper body, heights of its underside.
    pub heights: Field,
    /// Largest pressure that each cell can carry, Pa; infinite if the body is elastic.
    pub hardness: CellValues,
    /// Further state that laws store with the body, by name in snake case: a film's thickness, an accumulated
    /// strain, ….
    pub state: BTreeMap<String, State>,
}

/// A field that a law stores with a body.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// SI unit of the values; `1` for pure numbers.
    pub unit: String,
    /// One value for each cell of the body.
    pub values: Field,
}

impl Body {
    /// Creates a body with these heights, which can carry at most the pressure `hardness`.
    pub fn new(heights: Field, hardness: impl Into<CellValues>) -> Self {
        Self { heights, hardness: hardness.into(), state: BTreeMap::new() }
    }

    /// Number of columns along x.
    pub fn columns(&self) -> usize {
        self.heights.nrows()
    }

    /// Number of cells along y.
    pub fn width(&self) -> usize {
        self.heights.ncols()
    }

    /// Difference of the highest and the lowest cell.
    pub fn height_range(&self) -> Metre {
        let ends = |[least, most]: [Metre; 2], z: &Metre| [least.min(*z), most.max(*z)];
        let [least, most] = self.heights.iter().fold([Metre::INFINITY, Metre::NEG_INFINITY], ends);
        most - least
    }

    /// Checks that each field has a value for each cell, and that the hardness is valid.
    pub(super) fn validate(&self) -> Result<()> {
        let shape = [self.columns(), self.width()];
        assert!(self.hardness.fits(shape), "shape of the hardness");
        let wrong = |value: &f64| value.is_nan() || *value <= 0.0;
        let found = match &self.hardness {
            CellValues::Uniform(value) => Some(*value).filter(wrong),
            CellValues::Field(field) => field.iter().copied().find(wrong),
        };
        match found {
            Some(value) => check_in(Dimension::Pressure, "hardness", value, false, "a hardness above 0"),
            None => Ok(()),
        }
    }
}

//! A body as a motion changes it.

use std::collections::BTreeMap;

use crate::error::{Result, check_in};
use crate::grid::{CellValues, Field};
use crate::units::Dimension;

/// One of two bodies that face each other: its heights, and what else of it a motion may change cell by cell.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Body {
    /// Heights of the surface, of the upper body those of its underside, m.
    pub heights: Field,
    /// Most pressure that its cells bear, Pa; infinite where the body is elastic.
    pub hardness: CellValues,
    /// What laws keep of the body besides, by name in snake case: a film's thickness, an accumulated strain, ….
    pub state: BTreeMap<String, State>,
}

/// A field that a law keeps of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// SI unit of the values; `1` where they have none.
    pub unit: String,
    /// A value for each cell of the body.
    pub values: Field,
}

impl Body {
    /// A body of these heights that bears at most the pressure `hardness`.
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

    /// Whether each field has a value for each cell, and the hardness a meaning.
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

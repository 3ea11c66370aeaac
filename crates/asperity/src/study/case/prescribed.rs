//! What presses the bodies together: one of `load`, `mean_pressure`, `approach`.

use serde::Serialize;

use super::cursor::Table;
use crate::error::Result;
use crate::solver;
use crate::units::{Dimension, Metre, Newton, Pascal, SquareMetre};

/// What holds the bodies together.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Prescribed {
    /// Total normal force, > 0.
    Load(Newton),
    /// Load over the apparent area, > 0.
    MeanPressure(Pascal),
    /// Approach from the heights as prepared; of any sign.
    Approach(Metre),
}

impl Prescribed {
    /// What the solver is told, on so large an apparent area.
    pub fn control(&self, apparent_area: SquareMetre) -> solver::Control {
        match *self {
            Self::Load(load) => solver::Control::Load(load),
            Self::MeanPressure(pressure) => solver::Control::Load(pressure * apparent_area),
            Self::Approach(approach) => solver::Control::Approach(approach),
        }
    }
}

/// The one of the three that `table` gives.
pub(super) fn prescribed(table: &Table<'_>) -> Result<Prescribed> {
    let key = table.exactly_one(
        &["load", "mean_pressure", "approach"],
        "for example `load = \"2 N\"` and no other of them",
    )?;
    let entry = table.required(key, "\"2 N\"")?;
    Ok(match key {
        "load" => Prescribed::Load(entry.positive(Dimension::Force)?),
        "mean_pressure" => Prescribed::MeanPressure(entry.positive(Dimension::Pressure)?),
        _ => Prescribed::Approach(entry.quantity(Dimension::Length)?),
    })
}

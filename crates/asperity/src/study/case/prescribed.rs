//! What presses the bodies together: one of `load`, `mean_pressure`, `approach`.

use serde::Serialize;

use super::cursor::Table;
use super::schema::loading::contact as keys;
use crate::error::Result;
use crate::solver;
use crate::units::{Metre, Newton, Pascal, SquareMetre};

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

/// The one of the three that `table`, [contact] or a stage of a [[history]], gives.
pub(super) fn prescribed(table: &Table<'_>) -> Result<Prescribed> {
    table.exactly_one(
        &["load", "mean_pressure", "approach"],
        "for example `load = \"2 N\"` and no other of them",
    )?;
    let load = keys::LOAD.of(table)?.map(Prescribed::Load);
    let pressure = keys::MEAN_PRESSURE.of(table)?.map(Prescribed::MeanPressure);
    let approach = keys::APPROACH.of(table)?.map(Prescribed::Approach);
    Ok(load.or(pressure).or(approach).expect("one of the three is given"))
}

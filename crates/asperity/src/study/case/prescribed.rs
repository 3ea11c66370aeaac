//! Prescribed normal loading: one of `load`, `mean_pressure`, `approach`.

use serde::Serialize;

use super::cursor::Table;
use super::schema::loading::contact as keys;
use crate::error::Result;
use crate::solver;
use crate::units::{Metre, Newton, Pascal, SquareMetre};

/// Prescribed normal loading.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Prescribed {
    /// Total normal force, > 0.
    Load(Newton),
    /// Load over the apparent area, > 0.
    MeanPressure(Pascal),
    /// Approach relative to the prepared heights; positive or negative.
    Approach(Metre),
}

impl Prescribed {
    /// Returns the control of the solver, on this apparent area.
    pub fn control(&self, apparent_area: SquareMetre) -> solver::Control {
        match *self {
            Self::Load(load) => solver::Control::Load(load),
            Self::MeanPressure(pressure) => solver::Control::Load(pressure * apparent_area),
            Self::Approach(approach) => solver::Control::Approach(approach),
        }
    }
}

/// Reads the one of the three keys in `table`, which is [contact] or a stage of a [[history]].
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

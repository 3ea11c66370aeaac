//! Prescribed normal loading: one of `load`, `mean_pressure`, `approach`.

use serde::Serialize;

use super::cursor::Table;
use super::schema::loading::{contact as keys, history};
use asperity_base::error::Result;
use asperity_base::units::{Metre, Newton, Pascal, SquareMetre};
use asperity_contact::solver;

/// Prescribed normal loading.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Prescribed {
    /// Total normal force, > 0; of any sign in a history of bodies that attract each other.
    Load(Newton),
    /// Load over the apparent area, > 0; of any sign in a history of bodies that attract each other.
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

    /// The value, in the unit of its kind.
    pub(super) fn value(self) -> f64 {
        match self {
            Self::Load(value) | Self::MeanPressure(value) | Self::Approach(value) => value,
        }
    }

    /// The key of a list of such values in `[contact]`.
    pub(super) fn key_of_list(self) -> &'static str {
        match self {
            Self::Load(_) => LISTS[0],
            Self::MeanPressure(_) => LISTS[1],
            Self::Approach(_) => LISTS[2],
        }
    }
}

/// The keys of a sweep in `[contact]`.
pub(super) const LISTS: [&str; 3] = ["loads", "mean_pressures", "approaches"];

/// Reads the one of the three that [contact] gives.
pub(super) fn prescribed(table: &Table<'_>) -> Result<Prescribed> {
    table.exactly_one(&["load", "mean_pressure", "approach"], "for example `load = \"2 N\"`")?;
    let load = keys::LOAD.of(table)?.map(Prescribed::Load);
    let pressure = keys::MEAN_PRESSURE.of(table)?.map(Prescribed::MeanPressure);
    let approach = keys::APPROACH.of(table)?.map(Prescribed::Approach);
    Ok(load.or(pressure).or(approach).expect("one of the three is given"))
}

/// Reads the one of the three that a stage of a [[history]] gives.
pub(super) fn of_stage(table: &Table<'_>) -> Result<Prescribed> {
    table.exactly_one(&["load", "mean_pressure", "approach"], "for example `load = \"2 N\"`")?;
    let load = history::LOAD.of(table)?.map(Prescribed::Load);
    let pressure = history::MEAN_PRESSURE.of(table)?.map(Prescribed::MeanPressure);
    let approach = history::APPROACH.of(table)?.map(Prescribed::Approach);
    Ok(load.or(pressure).or(approach).expect("one of the three is given"))
}

/// The points of the sweep that `table` gives; none where it gives no list.
pub(super) fn sweep(table: &Table<'_>) -> Result<Vec<Prescribed>> {
    let points = |values: Option<Vec<f64>>, point: fn(f64) -> Prescribed| {
        values.unwrap_or_default().into_iter().map(point)
    };
    let loads = points(keys::LOADS.of(table)?, Prescribed::Load);
    let pressures = points(keys::MEAN_PRESSURES.of(table)?, Prescribed::MeanPressure);
    let approaches = points(keys::APPROACHES.of(table)?, Prescribed::Approach);
    Ok(loads.chain(pressures).chain(approaches).collect())
}

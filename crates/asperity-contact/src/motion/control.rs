//! Where a prescribed load holds, and what bodies of a hardness bear.

use crate::error::{Error, Result};
use crate::solver::Control;
use crate::units::Newton;

/// Where a prescribed load holds in a motion. A prescribed approach holds at every position of every pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoadControl {
    /// As the mean over a pass, at one common approach of all its positions.
    Pass,
    /// At every position.
    Step,
}

impl LoadControl {
    /// Returns the plastic limit of the load from the limits `max_load` of all positions: their mean under
    /// pass control, their smallest under step control.
    pub fn plastic_limit(self, max_load: &[Newton]) -> Newton {
        match self {
            Self::Pass => max_load.iter().sum::<f64>() / max_load.len() as f64,
            Self::Step => max_load.iter().copied().fold(f64::INFINITY, f64::min),
        }
    }
}

/// Returns an error if a prescribed load is not below the [`LoadControl::plastic_limit`].
pub fn check_limit(control: Control, limit: Newton) -> Result<()> {
    match control {
        Control::Load(load) if load >= limit => Err(Error::BeyondPlasticLimit { load, limit }),
        _ => Ok(()),
    }
}

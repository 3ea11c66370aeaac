//! The records of a computation: one for each static contact, increment, update, point of a sweep, position
//! and pass.
//!
//! A field of a record is a column of its table, or a key of `summary.json`. Only this module declares it:
//! its type is the unit and its documentation the meaning ([`asperity_base::record`]).

mod creep;
mod plastic;
mod heat;
mod increment;
mod laws;
mod lubrication;
pub(crate) mod lost_volumes;
mod pass;
mod static_contact;
mod steady;
mod step;
mod sweep;
mod update;

pub use creep::{CreepRecord, DragRecord, PassDragRecord};
pub use heat::HeatRecord;
pub use increment::IncrementRecord;
pub(super) use laws::HEIGHT_ERROR;
pub use laws::{FrettingRecord, LawsInCycles, LawsInPass, LawsInUpdate, RunningRecord};
pub use lost_volumes::LostVolume;
pub use lubrication::{FilmRecord, LubricationRecord};
pub use pass::PassRecord;
pub use plastic::{PassPlasticRecord, PlasticRecord, PlasticStepRecord, Regime, ResidualRecord};
pub use static_contact::{ShearRecord, StaticRecord};
pub use steady::SteadyRecord;
pub use step::StepRecord;
pub use sweep::SweepRecord;
pub use update::UpdateRecord;

use crate::error::Error;
use asperity_base::record::{Column, Record};

impl Record for StepRecord {
    const COLUMNS: &'static [Column] = Self::COLUMNS;

    fn error_at(&self, error: Error) -> Error {
        error.if_of_step(|source| Error::AtPass { pass: self.pass, source })
    }
}

impl Record for PassRecord {
    const COLUMNS: &'static [Column] = Self::COLUMNS;

    fn error_at(&self, error: Error) -> Error {
        error.if_of_step(|source| Error::AtPass { pass: self.pass, source })
    }
}

impl Record for IncrementRecord {
    const COLUMNS: &'static [Column] = Self::COLUMNS;

    fn error_at(&self, error: Error) -> Error {
        error.if_of_step(|source| Error::AtIncrement { increment: self.increment, source })
    }
}

impl Record for UpdateRecord {
    const COLUMNS: &'static [Column] = Self::COLUMNS;

    fn error_at(&self, error: Error) -> Error {
        error.if_of_step(|source| Error::AtUpdate { update: self.update, source })
    }
}

impl Record for SweepRecord {
    const COLUMNS: &'static [Column] = Self::COLUMNS;
}

impl Record for StaticRecord {
    const COLUMNS: &'static [Column] = Self::COLUMNS;
}

//! State between two updates of a contact that wears in place.

use super::super::Results;
use super::super::bodies::add_bodies;
use super::Stored;
use crate::error::Result;
use crate::grid::Field;
use crate::io::fields::FieldFile;
use crate::motion::{Pair, SlidingState, UpdateRecord};

/// State of an interrupted contact.
pub(in crate::study) struct UnderWay {
    /// The bodies, with the hardness they had before sliding.
    pub(in crate::study) pair: Pair,
    /// The finished updates.
    pub(in crate::study) updates: Vec<UpdateRecord>,
    /// Pressure of the last update.
    pub(in crate::study) pressure: Field,
}

/// Adds the state after an update.
pub(in crate::study) fn add(file: &mut FieldFile, state: &SlidingState) {
    add_bodies(file, &state.pair);
    file.add_field("pressure", "Pa", &state.pair.lower_grid(), [0.0, 0.0], &state.pressure);
}

/// Reads the state after these `updates` of a contact of the `pair` from a `stored` state.
pub(in crate::study) fn read(stored: &Stored, pair: &Pair, updates: Vec<UpdateRecord>) -> Result<UnderWay> {
    let mut pair = pair.clone();
    (pair.lower.heights, pair.upper.heights) = (stored.field("lower")?, stored.field("upper")?);
    [pair.lower.state, pair.upper.state] = Results::states_of(&stored.fields)?;
    Ok(UnderWay { pair, updates, pressure: stored.field("pressure")? })
}

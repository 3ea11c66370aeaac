//! State between two updates of a contact that slides in place.

use super::super::Results;
use super::super::bodies::add_bodies;
use super::Stored;
use crate::io::fields::FieldFile;
use asperity_base::error::Result;
use asperity_contact::motion::{Pair, SlidingState, UpdateRecord};

/// Adds the state after an update.
pub(crate) fn add(file: &mut FieldFile, state: &SlidingState) {
    add_bodies(file, &state.pair);
    file.add_field("pressure", "Pa", &state.pair.lower_grid(), [0.0, 0.0], &state.pressure);
}

/// Reads the state after these `updates` of a contact of the `pair` from a `stored` state. The bodies have the hardness of the
/// `pair`, without their films.
pub(crate) fn read(stored: &Stored, pair: &Pair, updates: Vec<UpdateRecord>) -> Result<SlidingState> {
    let mut pair = pair.clone();
    (pair.lower.heights, pair.upper.heights) = (stored.field("lower")?, stored.field("upper")?);
    [pair.lower.state, pair.upper.state] = Results::states_of(&stored.fields)?;
    Ok(SlidingState { pair, updates, pressure: stored.field("pressure")? })
}

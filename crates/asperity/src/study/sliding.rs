//! A contact that slides in place, kept update by update: what a computation that was interrupted goes on from.
//!
//! ```text
//! DIR/updates.csv             a row for each update done
//!     fields/update-state.h5  all that the next one depends on; gone once all is done
//! ```
//!
//! The row of an update is written before its state, and the state has the number of updates that it stands for: rows beyond it
//! are those of an update whose state was not written any more.

use super::loading::Stored;
use super::results::{ROWS, Results, add_bodies};
use super::tables::{self, GrowingTable};
use crate::error::{Error, Result};
use crate::grid::Field;
use crate::io::fields::FieldFile;
use crate::motion::{Pair, SlidingOutput, SlidingState, UpdateRecord};

/// Keeps each update of a contact that slides in place on the disk.
pub struct SlidingWriter {
    results: Results,
    identity: String,
    /// Updates in all, the contact before it slides included.
    updates: usize,
    table: Option<GrowingTable>,
}

/// What an interrupted contact has left.
pub(super) struct UnderWay {
    /// The bodies, with the hardness that they had before they slid.
    pub(super) pair: Pair,
    /// The updates done.
    pub(super) updates: Vec<UpdateRecord>,
    /// The pressure of the last.
    pub(super) pressure: Field,
}

impl SlidingWriter {
    pub(super) fn new(results: &Results, identity: &str, updates: usize) -> Self {
        Self { results: results.clone(), identity: identity.to_owned(), updates, table: None }
    }

    /// What an interrupted contact of the `pair` has left, if it has left anything.
    ///
    /// # Errors
    /// [`Error::File`] for files that cannot be read, [`Error::NotResumable`] where they do not fit together.
    pub(super) fn under_way(&self, pair: &Pair) -> Result<Option<UnderWay>> {
        let path = self.results.update_state_path();
        if !path.exists() {
            return Ok(None);
        }
        let stored = Stored::open(&path)?;
        let count = stored.number("updates")? as usize;
        let mut updates = self.results.updates()?;
        if updates.len() < count {
            let path = self.results.updates_path();
            return Err(Error::NotResumable { path, reason: "does not have every finished update" });
        }
        updates.truncate(count);
        stored.has_rows(&tables::digest("", &updates), &self.results.updates_path())?;
        let mut pair = pair.clone();
        (pair.lower.heights, pair.upper.heights) = (stored.field("lower")?, stored.field("upper")?);
        [pair.lower.state, pair.upper.state] = Results::states_of(&stored.fields)?;
        Ok(Some(UnderWay { pair, updates, pressure: stored.field("pressure")? }))
    }

    /// Removes the state, once nothing goes on from it any more.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn done(&self) -> Result<()> {
        self.results.remove_state(&self.results.update_state_path())
    }
}

impl SlidingOutput for SlidingWriter {
    fn update(&mut self, state: &SlidingState) -> Result<()> {
        let done = state.updates.len();
        let table = match &mut self.table {
            Some(table) => table,
            None => self.table.insert(GrowingTable::open(self.results.updates_path(), done - 1)?),
        };
        table.add(&state.updates[done - 1..])?;
        // After the last one the contact itself is written.
        if done == self.updates {
            return Ok(());
        }
        let mut file = FieldFile::of_run(&self.identity, &self.results.update_state_path());
        file.set("updates", done).set(ROWS, tables::digest("", &state.updates).as_str());
        add_bodies(&mut file, &state.pair);
        file.add_field("pressure", "Pa", &state.pair.lower_grid(), [0.0, 0.0], &state.pressure);
        file.write()
    }
}

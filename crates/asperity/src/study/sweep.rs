//! A sweep, kept point by point.
//!
//! ```text
//! DIR/sweep.csv            a row for each point done, written last
//!     fields/point-0001.h5 pressure and gap of the points kept
//!     fields/sweep-state.json  digests of these rows, written before each; gone once all is done
//! ```
//!
//! Points do not depend on each other: an interrupted sweep goes on after the last row.

use super::results::Results;
use super::tables;
use crate::error::{Error, Result};
use crate::grid::{Field, Grid};
use crate::io::atomic;
use crate::io::fields::FieldFile;
use crate::motion::{LoadedContact, Pair, SweepOutput, SweepRecord};

/// Keeps each point of a sweep on the disk.
pub struct SweepWriter {
    results: Results,
    identity: String,
    grid: Grid,
    yields: bool,
    fields_every: usize,
}

impl SweepWriter {
    /// Into a results directory, with the fields of every `fields_every`-th point (0: of none).
    pub(super) fn new(results: &Results, identity: &str, pair: &Pair, fields_every: usize) -> Self {
        Self {
            results: results.clone(),
            identity: identity.to_owned(),
            grid: pair.lower_grid(),
            yields: pair.yields(),
            fields_every,
        }
    }
}

impl SweepOutput for SweepWriter {
    fn point(&mut self, points: &[SweepRecord], contact: &LoadedContact) -> Result<()> {
        if is_kept(points.len(), self.fields_every) {
            let solution = contact.solution.normal();
            let mut file = FieldFile::of_run(&self.identity, &self.results.point_path(points.len()));
            file.set("point", points.len()).set("approach", solution.approach);
            let mut add = |name: &str, unit: &str, field: &Field| {
                file.add_field(name, unit, &self.grid, [0.0, 0.0], field);
            };
            add("pressure", "Pa", &solution.pressure);
            add("gap", "m", &solution.gap());
            if self.yields {
                add("plastic", "m", &contact.plastic);
            }
            file.write()?;
        }
        let digests: Vec<_> =
            points.iter().map(|point| tables::digest("", std::slice::from_ref(point))).collect();
        let text = serde_json::to_vec(&digests).expect("texts can be written");
        let state = self.results.sweep_state_path();
        let failed = |source| Error::File { path: state.clone(), source };
        std::fs::create_dir_all(self.results.fields_folder()).map_err(failed)?;
        atomic::replace(&state, &text)?;
        tables::write_sweep(&self.results.sweep_path(), points)
    }
}

/// Whether the fields of a point, from 1, are kept, if those of every n-th are.
pub(super) fn is_kept(point: usize, every: usize) -> bool {
    every > 0 && (point - 1).is_multiple_of(every)
}

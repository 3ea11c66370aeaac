//! A loading under way, kept increment by increment: what a computation that was interrupted goes on from.
//!
//! ```text
//! DIR/increments.csv             a row for each increment done
//!     fields/increment-state.h5  all that the next one depends on; gone once all is done
//! ```
//!
//! The row of an increment is written before its state, and the state has the number of increments that it stands for:
//! rows beyond it are those of an increment whose state was not written any more.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use super::results::{ALTERED, ROWS, Results};
use super::tables;
use crate::error::{Error, Result};
use crate::grid::{CellValues, Field, Grid};
use crate::io::fields::{Attribute, FieldFile, Fields};
use crate::motion::{Flattening, IncrementRecord, LoadingOutput, LoadingState, Origin, Pair};
use crate::solver::{Bounds, Equilibrium, FrictionalSolution, Solution, Stats};

/// Keeps each increment of a loading on the disk.
pub struct LoadingWriter {
    results: Results,
    identity: String,
    grid: Grid,
    gap: Field,
    bounds: Bounds,
    increments: usize,
}

impl LoadingWriter {
    /// Into a results directory, for a loading of the `pair` in so many `increments`.
    pub(super) fn new(results: &Results, identity: &str, pair: &Pair, increments: usize) -> Self {
        let position = pair.at_rest();
        Self {
            results: results.clone(),
            identity: identity.to_owned(),
            grid: pair.lower_grid(),
            gap: pair.initial_gap(&position),
            bounds: pair.bounds(&position, None),
            increments,
        }
    }

    /// What an interrupted loading has left, if it has left anything.
    ///
    /// # Errors
    /// [`Error::File`] for files that cannot be read, [`Error::NotResumable`] where they do not fit together.
    pub fn under_way(&self) -> Result<Option<LoadingState>> {
        let path = self.results.increment_state_path();
        if !path.exists() {
            return Ok(None);
        }
        let stored = Stored::open(&path)?;
        let count = stored.number("increments")? as usize;
        let mut increments = self.results.increments()?;
        if increments.len() < count {
            let path = self.results.increments_path();
            return Err(Error::NotResumable { path, reason: "does not have every finished increment" });
        }
        let [nx, ny] = self.grid.shape;
        if count >= self.increments || stored.field("pressure")?.dim() != (nx, ny) {
            return Err(Error::NotResumable { path, reason: "is of another loading" });
        }
        increments.truncate(count);
        stored.has_rows(&tables::digest("", &increments), &self.results.increments_path())?;
        self.state(&stored, increments).map(Some)
    }

    /// Removes the state, once nothing goes on from it any more.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn done(&self) -> Result<()> {
        self.results.remove_state(&self.results.increment_state_path())
    }
}

impl LoadingOutput for LoadingWriter {
    fn increment(&mut self, state: &LoadingState) -> Result<()> {
        let written =
            tables::write_increments(&self.results.increments_path(), &state.increments).and_then(|()| {
                // After the last one the contact itself is written.
                if state.increments.len() < self.increments { self.write(state) } else { Ok(()) }
            });
        let at = |source| Error::AtIncrement { increment: state.increments.len(), source };
        written.map_err(|error| error.if_not_finite(at))
    }
}

impl LoadingWriter {
    fn write(&self, state: &LoadingState) -> Result<()> {
        let mut file = FieldFile::of_run(&self.identity, &self.results.increment_state_path());
        let mut add = |name: &str, unit: &str, field: &Field| {
            file.add_field(name, unit, &self.grid, [0.0, 0.0], field);
        };
        let normal = state.contact.normal();
        add("pressure", "Pa", &normal.pressure);
        add("displacement", "m", &normal.displacement);
        add("deepest", "m", &state.flattening.deepest);
        if let Some(kept) = &state.flattening.kept {
            add("kept", "m", kept);
        }
        if let Some([x, y]) = &state.slip {
            add("slip_x", "m", x);
            add("slip_y", "m", y);
        }
        if let Some(solution) = state.contact.frictional() {
            for (name, unit, [x, y]) in [
                ("traction", "Pa", &solution.shear),
                ("displacement", "m", &solution.displacement),
                ("last_slip", "m", &solution.slip),
            ] {
                add(&format!("{name}_x"), unit, x);
                add(&format!("{name}_y"), unit, y);
            }
            if let CellValues::Field(cap) = normal.bounds.upper() {
                add("cap", "Pa", cap);
            }
            add("shear_limit", "Pa", &solution.shear_limit);
            add("stick", "1", &solution.stick);
            file.set("rigid_displacement", solution.rigid_displacement.to_vec());
        }
        let Origin { load, approach, force, displacement } = state.origin;
        file.set("increments", state.increments.len())
            .set(ROWS, tables::digest("", &state.increments).as_str())
            .set("approach", normal.approach)
            .set("residual", normal.residual)
            .set("iterations", normal.stats.iterations)
            .set("convolutions", normal.stats.convolutions)
            .set("restarts", normal.stats.restarts)
            .set("dissipation_error", state.dissipation_error)
            .set("origin_load", load)
            .set("origin_approach", approach)
            .set("origin_force", force.to_vec())
            .set("origin_displacement", displacement.to_vec());
        file.write()
    }

    /// The state of a loading as it is `stored`.
    fn state(&self, stored: &Stored, increments: Vec<IncrementRecord>) -> Result<LoadingState> {
        let kept = stored.holds("kept").then(|| stored.field("kept")).transpose()?;
        let flattening = Flattening { kept, deepest: stored.field("deepest")? };
        let bounds = match stored.holds("cap") {
            true => Bounds::up_to(stored.field("cap")?),
            false => self.bounds.clone(),
        };
        let normal = Solution {
            grid: self.grid,
            initial_gap: flattening.open(&self.gap).into_owned(),
            bounds,
            pressure: stored.field("pressure")?,
            displacement: stored.field("displacement")?,
            approach: stored.number("approach")?,
            residual: stored.number("residual")?,
            stats: Stats {
                iterations: stored.number("iterations")? as usize,
                convolutions: stored.number("convolutions")?,
                restarts: stored.number("restarts")? as usize,
            },
        };
        let has_friction = stored.holds("stick");
        let contact = match has_friction {
            false => Equilibrium::Frictionless(Box::new(normal)),
            true => Equilibrium::Frictional(Box::new(FrictionalSolution {
                normal,
                shear: stored.both("traction")?,
                shear_limit: stored.field("shear_limit")?,
                displacement: stored.both("displacement")?,
                rigid_displacement: stored.pair("rigid_displacement")?,
                slip: stored.both("last_slip")?,
                stick: stored.field("stick")?,
            })),
        };
        Ok(LoadingState {
            increments,
            contact,
            origin: Origin {
                load: stored.number("origin_load")?,
                approach: stored.number("origin_approach")?,
                force: stored.pair("origin_force")?,
                displacement: stored.pair("origin_displacement")?,
            },
            flattening,
            slip: has_friction.then(|| stored.both("slip")).transpose()?,
            dissipation_error: stored.number("dissipation_error")?,
        })
    }
}

/// A state as it is read back.
pub(super) struct Stored {
    path: PathBuf,
    pub(super) fields: Fields,
    names: Vec<String>,
    attributes: BTreeMap<String, Attribute>,
}

impl Stored {
    pub(super) fn open(path: &Path) -> Result<Self> {
        let fields = Fields::open(path)?;
        let (names, attributes) = (fields.names()?, fields.attributes()?);
        Ok(Self { path: path.to_owned(), fields, names, attributes })
    }

    fn holds(&self, name: &str) -> bool {
        self.names.iter().any(|held| held == name)
    }

    pub(super) fn field(&self, name: &str) -> Result<Field> {
        self.fields.read(name)?.into_field().ok_or_else(|| self.damaged(name))
    }

    fn both(&self, name: &str) -> Result<[Field; 2]> {
        Ok([self.field(&format!("{name}_x"))?, self.field(&format!("{name}_y"))?])
    }

    pub(super) fn number(&self, name: &str) -> Result<f64> {
        match self.attributes.get(name) {
            Some(Attribute::Number(number)) => Ok(*number),
            Some(Attribute::Integer(number)) => Ok(*number as f64),
            _ => Err(self.damaged(name)),
        }
    }

    fn pair(&self, name: &str) -> Result<[f64; 2]> {
        match self.attributes.get(name) {
            Some(Attribute::Numbers(numbers)) => {
                numbers.as_slice().try_into().map_err(|_| self.damaged(name))
            }
            _ => Err(self.damaged(name)),
        }
    }

    /// An error if the state was written with rows of another digest, which are those of `table`.
    pub(super) fn has_rows(&self, digest: &str, table: &Path) -> Result<()> {
        match self.attributes.get(ROWS) {
            Some(written) if *written != Attribute::from(digest) => {
                Err(Error::NotResumable { path: table.to_owned(), reason: ALTERED })
            }
            _ => Ok(()),
        }
    }

    fn damaged(&self, name: &str) -> Error {
        let source = io::Error::new(io::ErrorKind::InvalidData, format!("`{name}` is missing or damaged"));
        Error::File { path: self.path.clone(), source }
    }
}

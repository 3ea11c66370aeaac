//! States of courses in files: everything the next step depends on, so that an interrupted run gives the same
//! bits.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use super::Results;
use super::bodies::add_bodies;
use crate::io::fields::{Attribute, FieldFile, Fields};
use asperity_base::error::{Error, Result};
use asperity_base::grid::{Field, Grid};
use asperity_base::units::Metre;
use asperity_contact::motion::{CourseState, Pair, StateReader, StateWriter};

/// Defect of a table whose rows differ from those written.
pub(crate) const ALTERED: &str = "has been changed since it was written";

/// Name of the attribute of a state with the digest of its rows.
pub(crate) const ROWS: &str = "rows";

/// Adds the `state` of bodies with this `pitch` to a file.
pub(super) fn add(file: &mut FieldFile, pitch: [Metre; 2], state: &dyn CourseState) {
    state.store(&mut StateFile { file, pitch });
}

/// A file that keeps a state.
struct StateFile<'a> {
    file: &'a mut FieldFile,
    pitch: [Metre; 2],
}

impl StateWriter for StateFile<'_> {
    fn field(&mut self, name: &str, unit: &str, values: &Field) {
        let grid = Grid { shape: [values.nrows(), values.ncols()], pitch: self.pitch };
        self.file.add_field(name, unit, &grid, [0.0, 0.0], values);
    }

    fn series(&mut self, name: &str, unit: &str, axis: &str, values: &[f64]) {
        if !values.is_empty() {
            self.file.add_series(name, unit, axis, 1.0, 0.0, values);
        }
    }

    fn number(&mut self, name: &str, value: f64) {
        self.file.set(name, value);
    }

    fn count(&mut self, name: &str, value: usize) {
        self.file.set(name, value);
    }

    fn vector(&mut self, name: &str, value: [f64; 2]) {
        self.file.set(name, value.to_vec());
    }

    fn bodies(&mut self, pair: &Pair) {
        add_bodies(self.file, pair);
    }
}

/// A state read from a file.
pub(super) struct Stored {
    path: PathBuf,
    fields: Fields,
    names: Vec<String>,
    attributes: BTreeMap<String, Attribute>,
}

impl Stored {
    pub(super) fn open(path: &Path) -> Result<Self> {
        let fields = Fields::open(path)?;
        let (names, attributes) = (fields.names()?, fields.attributes()?);
        Ok(Self { path: path.to_owned(), fields, names, attributes })
    }

    /// Returns an error if the state was written with rows of another digest than those of `table`.
    pub(super) fn has_rows(&self, digest: &str, table: &Path) -> Result<()> {
        match self.attributes.get(ROWS) {
            Some(written) if *written != Attribute::from(digest) => {
                Err(Error::NotResumable { path: table.to_owned(), reason: ALTERED })
            }
            _ => Ok(()),
        }
    }

    pub(super) fn of_another_contact(&self) -> Error {
        Error::NotResumable { path: self.path.clone(), reason: "is of another contact" }
    }

    fn is_array(&self, name: &str) -> bool {
        self.names.iter().any(|held| held == name)
    }

    fn damaged(&self, name: &str) -> Error {
        let source = io::Error::new(io::ErrorKind::InvalidData, format!("`{name}` is missing or damaged"));
        Error::File { path: self.path.clone(), source }
    }
}

impl StateReader for Stored {
    fn holds(&self, name: &str) -> bool {
        self.is_array(name) || self.attributes.contains_key(name)
    }

    fn field(&self, name: &str) -> Result<Field> {
        self.fields.read(name)?.into_field().ok_or_else(|| self.damaged(name))
    }

    fn series(&self, name: &str) -> Result<Vec<f64>> {
        if self.is_array(name) {
            Ok(self.fields.read(name)?.values.into_iter().collect())
        } else {
            Ok(Vec::new())
        }
    }

    fn number(&self, name: &str) -> Result<f64> {
        match self.attributes.get(name) {
            Some(Attribute::Number(number)) => Ok(*number),
            Some(Attribute::Integer(number)) => Ok(*number as f64),
            _ => Err(self.damaged(name)),
        }
    }

    fn vector(&self, name: &str) -> Result<[f64; 2]> {
        match self.attributes.get(name) {
            Some(Attribute::Numbers(numbers)) => {
                numbers.as_slice().try_into().map_err(|_| self.damaged(name))
            }
            _ => Err(self.damaged(name)),
        }
    }

    fn bodies(&self, pair: &mut Pair) -> Result<()> {
        (pair.lower.heights, pair.upper.heights) = (self.field("lower")?, self.field("upper")?);
        [pair.lower.state, pair.upper.state] = Results::states_of(&self.fields)?;
        Ok(())
    }
}

//! States of courses in files: everything the next step depends on, so that an interrupted run gives the same bits.

pub(super) mod increment; // state of a loading
pub(super) mod pass; // state of a motion
pub(super) mod update; // state of a contact that slides in place

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use crate::io::fields::{Attribute, Fields};
use asperity_base::error::{Error, Result};
use asperity_base::grid::Field;

/// Defect of a table whose rows differ from those written.
pub(crate) const ALTERED: &str = "has been changed since it was written";

/// Name of the attribute of a state with the digest of its rows.
pub(crate) const ROWS: &str = "rows";

/// A state read from a file.
pub(crate) struct Stored {
    path: PathBuf,
    pub(crate) fields: Fields,
    names: Vec<String>,
    attributes: BTreeMap<String, Attribute>,
}

impl Stored {
    pub(crate) fn open(path: &Path) -> Result<Self> {
        let fields = Fields::open(path)?;
        let (names, attributes) = (fields.names()?, fields.attributes()?);
        Ok(Self { path: path.to_owned(), fields, names, attributes })
    }

    pub(super) fn holds(&self, name: &str) -> bool {
        self.names.iter().any(|held| held == name)
    }

    pub(crate) fn field(&self, name: &str) -> Result<Field> {
        self.fields.read(name)?.into_field().ok_or_else(|| self.damaged(name))
    }

    pub(super) fn both(&self, name: &str) -> Result<[Field; 2]> {
        Ok([self.field(&format!("{name}_x"))?, self.field(&format!("{name}_y"))?])
    }

    pub(crate) fn number(&self, name: &str) -> Result<f64> {
        match self.attributes.get(name) {
            Some(Attribute::Number(number)) => Ok(*number),
            Some(Attribute::Integer(number)) => Ok(*number as f64),
            _ => Err(self.damaged(name)),
        }
    }

    pub(super) fn pair(&self, name: &str) -> Result<[f64; 2]> {
        match self.attributes.get(name) {
            Some(Attribute::Numbers(numbers)) => {
                numbers.as_slice().try_into().map_err(|_| self.damaged(name))
            }
            _ => Err(self.damaged(name)),
        }
    }

    /// Returns an error if the state was written with rows of another digest than those of `table`.
    pub(crate) fn has_rows(&self, digest: &str, table: &Path) -> Result<()> {
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

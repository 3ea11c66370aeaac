//! `fields/ranks.json`, the list of the files of the ranks, and these files.

use std::io::{self, ErrorKind};
use std::ops::Range;
use std::path::{Path, PathBuf};

use ndarray::s;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use asperity_base::error::{Error, Result};
use asperity_base::grid::{Field, Grid};
use asperity_base::io::{atomic, regular};
use asperity_base::ranks::Slab;
use asperity_base::units::{Metre, Pascal};
use asperity_contact::operator::Boundary;
use asperity_study::io::fields::{Attribute, FieldFile, Fields, StoredField};
use asperity_study::io::sha256;
use asperity_study::parts::identity_of;
use asperity_study::{NamedField, RestFields};

/// The rows of the fields in each file of a run on ranks.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Index {
    version: String,
    pub(crate) identity: String,
    shape: [usize; 2],
    pitch: [Metre; 2],
    pub(crate) periodic: [bool; 2],
    pub(crate) approach: Metre,
    /// `None` if it is infinite.
    pub(crate) hardness: Option<Pascal>,
    pub(crate) fields: Vec<Named>,
    parts: Vec<Part>,
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Named {
    pub(crate) name: String,
    pub(crate) unit: String,
}

/// The rows of one rank.
#[derive(Debug, Serialize, Deserialize)]
struct Part {
    file: String,
    first_row: usize,
    rows: usize,
}

impl Part {
    fn rows(&self) -> Range<usize> {
        self.first_row..self.first_row.saturating_add(self.rows)
    }
}

/// Name of the index in the folder of the fields.
const INDEX: &str = "ranks.json";

/// Key of the digest of all other keys.
const DIGEST: &str = "digest";

/// Adds to an index the digest of its other keys.
pub(crate) fn sign(index: &mut Value) {
    index[DIGEST] = Value::Null;
    let text = serde_json::to_vec(index).expect("a JSON value can be written");
    index[DIGEST] = sha256(&text).into();
}

/// Fields of every contact, which [`super::collect`] reads.
const NEEDED: [&str; 3] = ["pressure", "lower", "upper"];

impl Index {
    pub(crate) fn new(
        slab: &Slab,
        boundary: Boundary,
        fields: &RestFields,
        hardness: Pascal,
        identity: &str,
    ) -> Self {
        let Grid { shape, pitch } = slab.whole_grid();
        let named = |field: &NamedField| Named { name: field.name.to_string(), unit: field.unit.to_string() };
        let part = |(rank, rows): (usize, Range<usize>)| Part {
            file: file_of(rank),
            first_row: rows.start,
            rows: rows.len(),
        };
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            identity: identity.to_owned(),
            shape,
            pitch,
            periodic: boundary.wraps(),
            approach: fields.approach,
            hardness: Some(hardness).filter(|hardness| hardness.is_finite()),
            fields: fields.fields.iter().map(named).collect(),
            parts: slab.parts().all().enumerate().map(part).collect(),
        }
    }

    /// Reads the index of the run of this `case` in `directory`.
    ///
    /// # Errors
    /// [`Error::File`] if it is missing or damaged, [`Error::NotResumable`] if it belongs to another case.
    pub(crate) fn read(directory: &Path, case: &Value) -> Result<Self> {
        let path = directory.join("fields").join(INDEX);
        let failed = |source| Error::File { path: path.clone(), source };
        let text = regular::read(&path, "an index of parts", u64::MAX).map_err(failed)?;
        let mut value: Value = serde_json::from_slice(&text).map_err(|error| failed(error.into()))?;
        if !value.is_object() {
            return Err(damaged(&path, "it is no JSON object"));
        }
        let written = value[DIGEST].take();
        sign(&mut value);
        if value[DIGEST] != written {
            return Err(damaged(&path, "it is damaged: its content has another digest"));
        }
        let index: Self = serde_json::from_value(value).map_err(|error| failed(error.into()))?;
        index.check().map_err(|reason| damaged(&path, reason))?;
        if index.identity == identity_of(case) {
            Ok(index)
        } else {
            Err(Error::NotResumable { path, reason: OF_ANOTHER_RUN })
        }
    }

    /// Checks the index: its files must contain each row once, in order.
    fn check(&self) -> std::result::Result<(), &'static str> {
        if Grid::new(self.shape, self.pitch).is_err() {
            return Err("its grid has no meaning");
        }
        let mut next = 0;
        for (rank, part) in self.parts.iter().enumerate() {
            if part.file != file_of(rank) {
                return Err("its files are not numbered in the order of the ranks");
            }
            if part.first_row != next || part.rows == 0 {
                return Err("its files do not hold each row once");
            }
            next = part.rows().end;
        }
        if next != self.shape[0] {
            return Err("its files do not hold each row once");
        }
        let count = |name: &str| self.fields.iter().filter(|field| field.name == name).count();
        if NEEDED.into_iter().any(|name| count(name) == 0) {
            return Err("it lists no pressure, lower or upper field");
        }
        if self.fields.iter().any(|field| count(&field.name) > 1) {
            return Err("it lists a field twice");
        }
        Ok(())
    }

    pub(crate) fn write(&self, directory: &Path) -> Result<()> {
        let mut value = serde_json::to_value(self).expect("an index can be written as JSON");
        sign(&mut value);
        let text = serde_json::to_vec_pretty(&value).expect("a JSON value can be written");
        atomic::replace(&directory.join("fields").join(INDEX), &text)
    }

    /// The grid of all rows.
    pub(crate) fn grid(&self) -> Grid {
        Grid { shape: self.shape, pitch: self.pitch }
    }

    /// Writes the fields on the rows of this rank.
    pub(crate) fn write_part(&self, directory: &Path, slab: &Slab, fields: RestFields) -> Result<()> {
        let Part { file: name, first_row, rows } = &self.parts[slab.ranks().rank()];
        let mut file = FieldFile::of_run(&self.identity, &directory.join("fields").join(name));
        file.set("first_row", *first_row).set("rows", *rows).set("ranks", self.parts.len());
        let origin = [*first_row as f64 * self.pitch[0], 0.0];
        for NamedField { name, unit, values, .. } in fields.fields {
            file.add_field(&name, &unit, &slab.grid(), origin, &values);
        }
        file.write()
    }

    /// Opens the files of the ranks, and checks that they are undamaged, belong to this run, and contain the
    /// rows given in the index.
    ///
    /// # Errors
    /// [`Error::File`], [`Error::NotResumable`], [`Error::OtherRows`], each with the name of the file.
    pub(crate) fn open_parts(&self, directory: &Path) -> Result<Vec<RankFile>> {
        let open = |part: &Part| {
            let path = directory.join("fields").join(&part.file);
            let fields = Fields::open(&path)?;
            fields.verify()?;
            let attributes = fields.attributes()?;
            if attributes.get("identity") != Some(&Attribute::from(self.identity.as_str())) {
                return Err(Error::NotResumable { path, reason: OF_ANOTHER_RUN });
            }
            let count = |name: &str| match attributes.get(name) {
                Some(Attribute::Integer(number)) => usize::try_from(*number).ok(),
                _ => None,
            };
            let (Some(first), Some(rows), Some(ranks)) = (count("first_row"), count("rows"), count("ranks"))
            else {
                return Err(damaged(&path, "it does not say which rows it holds"));
            };
            let rows = first..first.saturating_add(rows);
            if rows != part.rows() || ranks != self.parts.len() {
                return Err(Error::OtherRows {
                    path,
                    rows: ends(&rows),
                    ranks,
                    expected: ends(&part.rows()),
                    expected_ranks: self.parts.len(),
                });
            }
            Ok(RankFile { path, fields, shape: [part.rows, self.shape[1]], pitch: self.pitch })
        };
        self.parts.iter().map(open).collect()
    }

    /// Joins all rows of a field from the `files`.
    ///
    /// # Errors
    /// [`Error::NoField`]; [`Error::File`] if the field in a file has another grid or another unit.
    pub(crate) fn whole(&self, files: &[RankFile], Named { name, unit }: &Named) -> Result<Field> {
        let mut whole = Field::zeros(self.shape);
        for (part, file) in self.parts.iter().zip(files) {
            whole.slice_mut(s![part.rows(), ..]).assign(&file.read(name, unit)?);
        }
        Ok(whole)
    }
}

/// The file of a rank, open for reading.
pub(crate) struct RankFile {
    path: PathBuf,
    fields: Fields,
    /// Number of its rows, and of the cells of each.
    shape: [usize; 2],
    pitch: [Metre; 2],
}

impl RankFile {
    fn read(&self, name: &str, unit: &str) -> Result<Field> {
        let StoredField { unit: stored, axes, pitch, values, .. } = self.fields.read(name)?;
        if values.shape() != self.shape || stored != unit || axes != "x,y" || pitch != self.pitch {
            return Err(damaged(
                &self.path,
                "its fields have another shape, pitch or unit than ranks.json says",
            ));
        }
        Ok(values.into_dimensionality().expect("a field has two axes"))
    }
}

/// Name of the file of a rank.
fn file_of(rank: usize) -> String {
    format!("rank-{rank:04}.h5")
}

/// First and last of some rows.
fn ends(rows: &Range<usize>) -> [usize; 2] {
    [rows.start, rows.end.saturating_sub(1)]
}

const OF_ANOTHER_RUN: &str = "is of another run";

fn damaged(path: &Path, reason: &'static str) -> Error {
    Error::File { path: path.to_owned(), source: io::Error::new(ErrorKind::InvalidData, reason) }
}

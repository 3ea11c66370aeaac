//! Container of results: an HDF5 file of named fields, each with its unit, axes, pitch and origin.
//!
//! ```text
//! /             attributes: those of the writer, for example `version`, `pass`; `digest` of the whole file
//! /pressure     float64 [nx, ny]   unit "Pa"   axes "x,y"   pitch [m, m]   origin [m, m]
//! ```
//!
//! A file gets its name once all of it is written, so that a killed run leaves only complete files: one for
//! each pass. `origin` is the position of the centre of the first cell.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::fmt::Write as _;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use hdf5_pure::{
    AttrValue, Dataset, Datatype, DatatypeByteOrder, File, FileAccessProperties, FileLocking, FormatError,
    MetadataCacheConfig, Source,
};
use ndarray::{ArrayD, ArrayRef, Dimension, Ix2};
use rayon::prelude::*;
use sha2::{Digest as _, Sha256};

use super::draft::{FieldDraft, Packed, PackedArray};
use super::{fs, regular, sha256};
use asperity_base::error::{Error, Result};
use asperity_base::grid::{Field, Grid, check_finite};
use asperity_base::io::packing;
use asperity_base::units::Metre;

/// A file of fields being written. Arrays are written to disk while others are added, so that only a few are
/// in memory.
pub struct FieldFile {
    attributes: BTreeMap<String, Attribute>,
    /// Digest of each array, by name.
    arrays: BTreeMap<String, Digest>,
    /// The file on disk, or the error of its creation.
    draft: Result<FieldDraft>,
    /// The last array, if it is packed. It is written while the next one is packed.
    last: Option<PackedArray>,
    /// Whether each value must be a finite number, unless its field may contain others.
    finite: bool,
}

/// An attribute of a file.
#[derive(Debug, Clone, PartialEq)]
pub enum Attribute {
    /// A text.
    Text(String),
    /// A number.
    Number(f64),
    /// A count.
    Integer(i64),
    /// Several numbers.
    Numbers(Vec<f64>),
}

/// An array read from a file.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredField {
    /// Unit of the values.
    pub unit: String,
    /// Names of the axes, `x,y` for a field.
    pub axes: String,
    /// Distance between neighbouring values along each axis.
    pub pitch: Vec<Metre>,
    /// Position of the first value along each axis.
    pub origin: Vec<Metre>,
    /// The values, in the order of the axes.
    pub values: ArrayD<f64>,
}

impl FieldFile {
    /// Creates an empty file for `path`, in a folder that is created if missing. It exists at `path` once
    /// [`FieldFile::write`] has succeeded, which also reports earlier errors.
    pub fn new(path: &Path) -> Self {
        let (attributes, arrays) = (BTreeMap::new(), BTreeMap::new());
        Self { attributes, arrays, draft: draft(path), last: None, finite: false }
    }

    /// Creates a file for `path` with the identity of a run. [`FieldFile::write`] rejects a value that is not
    /// finite with [`Error::NotFinite`], unless its field may contain such values.
    pub fn of_run(identity: &str, path: &Path) -> Self {
        let mut file = Self { finite: true, ..Self::new(path) };
        file.set("version", env!("CARGO_PKG_VERSION")).set("identity", identity);
        file
    }

    /// Adds an attribute of the whole file.
    pub fn set(&mut self, name: &str, value: impl Into<Attribute>) -> &mut Self {
        self.attributes.insert(name.to_owned(), value.into());
        self
    }

    /// Adds a field on `grid`, whose first cell has its corner at `corner`.
    ///
    /// # Panics
    /// If the shape of `values` differs from that of `grid`, or if an array `name` exists.
    pub fn add_field(
        &mut self,
        name: &str,
        unit: &str,
        grid: &Grid,
        corner: [Metre; 2],
        values: &Field,
    ) -> &mut Self {
        assert_eq!(values.shape(), grid.shape, "{name} is not on the grid");
        let origin = [corner[0] + grid.centre(0, 0), corner[1] + grid.centre(1, 0)];
        self.add(name, unit, "x,y", &grid.shape, &grid.pitch, &origin, flat(&values.as_standard_layout()))
    }

    /// Adds values on a section along x and into the depth z. Its first row is the surface, and its first
    /// column is at `x`.
    ///
    /// # Panics
    /// If there are no values, or if an array `name` exists.
    pub fn add_section(
        &mut self,
        name: &str,
        unit: &str,
        pitch: [Metre; 2],
        x: Metre,
        values: &Field,
    ) -> &mut Self {
        let values = values.as_standard_layout();
        self.add(name, unit, "x,z", values.shape(), &pitch, &[x, 0.0], flat(&values))
    }

    /// Adds values in layers below the cells of `grid`, `[ix, iy, iz]`.
    ///
    /// # Panics
    /// If the shape of `values` differs from that of `grid`, or if an array `name` exists.
    pub(crate) fn add_layers(
        &mut self,
        name: &str,
        unit: &str,
        grid: &Grid,
        values: &ndarray::Array3<f64>,
    ) -> &mut Self {
        assert_eq!(values.shape()[..2], grid.shape, "{name} is not on the grid");
        let origin = [grid.centre(0, 0), grid.centre(1, 0)];
        let values = values.as_standard_layout();
        self.add(name, unit, "x,y,layer", values.shape(), &grid.pitch, &origin, flat(&values))
    }

    /// Adds values at `origin`, `origin + pitch`, … along one axis.
    ///
    /// # Panics
    /// If there are no values, or if an array `name` exists.
    pub fn add_series(
        &mut self,
        name: &str,
        unit: &str,
        axis: &str,
        pitch: Metre,
        origin: Metre,
        values: &[f64],
    ) -> &mut Self {
        self.add(name, unit, axis, &[values.len()], &[pitch], &[origin], values)
    }

    #[expect(clippy::too_many_arguments, reason = "the public ways to call it name them")]
    fn add(
        &mut self,
        name: &str,
        unit: &str,
        axes: &str,
        shape: &[usize],
        pitch: &[Metre],
        origin: &[Metre],
        values: &[f64],
    ) -> &mut Self {
        assert!(!values.is_empty(), "{name} has no values");
        let sizes: Vec<u64> = shape.iter().map(|size| *size as u64).collect();
        let attributes = [
            ("unit", AttrValue::VarLenString(unit.to_owned())),
            ("axes", AttrValue::VarLenString(axes.to_owned())),
            ("pitch", AttrValue::F64Array(pitch.to_vec())),
            ("origin", AttrValue::F64Array(origin.to_vec())),
        ];
        let finite = self.finite && self.draft.is_ok();
        let digest = || array_digest([unit, axes], shape, [pitch, origin], values.iter());
        let examined = || (digest(), if finite { check_finite(name, shape, values) } else { Ok(()) });
        let pack = || Packed::new(values, &sizes);
        let ((digest, checked), (packed, ())) =
            rayon::join(examined, || rayon::join(pack, || self.write_last()));
        let other = self.arrays.insert(name.to_owned(), digest);
        assert!(other.is_none(), "two arrays named {name}");
        if let (Ok(_), Err(error)) = (&self.draft, checked) {
            self.draft = Err(error);
        }
        match packed {
            Some(packed) => {
                self.last = Some(PackedArray { name: name.to_owned(), shape: sizes, packed, attributes });
            }
            None => self.in_draft(|draft| draft.add(name, values, &sizes, attributes)),
        }
        self
    }

    /// Writes the last array, if it has not been written.
    fn write_last(&mut self) {
        if let Some(array) = self.last.take() {
            self.in_draft(|draft| draft.add_packed(array));
        }
    }

    /// Performs a task on the file, unless an earlier one has failed.
    fn in_draft(&mut self, task: impl FnOnce(&mut FieldDraft) -> std::result::Result<(), hdf5_pure::Error>) {
        if let Ok(draft) = &mut self.draft
            && let Err(error) = task(draft)
        {
            self.draft = Err(file_error(draft.path(), error));
        }
    }

    /// Completes the file, and gives it its name.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn write(mut self) -> Result<()> {
        self.write_last();
        let digest = content_digest(&self.attributes, &self.arrays);
        self.set(DIGEST, digest.as_str());
        let attributes = self.attributes.into_iter().map(|(name, value)| {
            let value = match value {
                Attribute::Text(text) => AttrValue::VarLenString(text),
                Attribute::Number(number) => AttrValue::F64(number),
                Attribute::Integer(number) => AttrValue::I64(number),
                Attribute::Numbers(numbers) => AttrValue::F64Array(numbers),
            };
            (name, value)
        });
        let draft = self.draft?;
        let path = draft.path().to_owned();
        draft.publish(attributes).map_err(|error| file_error(&path, error))
    }
}

/// Creates the draft of the file at `path`, and its folder if it is missing.
fn draft(path: &Path) -> Result<FieldDraft> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|source| Error::File { path: folder.to_owned(), source })?;
    }
    FieldDraft::new(path).map_err(|error| file_error(path, error))
}

/// Returns the values of an array in the order of its axes, the last one fastest.
fn flat<D: Dimension>(values: &ArrayRef<f64, D>) -> &[f64] {
    values.as_slice().expect("standard layout")
}

/// SHA-256.
type Digest = [u8; 32];

/// Attribute with the digest of everything else.
const DIGEST: &str = "digest";

/// Digest of an array and its attributes.
fn array_digest<'a>(
    texts: [&str; 2],
    shape: &[usize],
    numbers: [&[f64]; 2],
    values: impl Iterator<Item = &'a f64>,
) -> Digest {
    let mut digest = Sha256::new();
    digest.update(format!("{texts:?} {shape:?} {numbers:?}"));
    let mut bytes = [0; 1 << 12];
    let mut filled = 0;
    for value in values {
        bytes[filled..filled + 8].copy_from_slice(&value.to_le_bytes());
        filled += 8;
        if filled == bytes.len() {
            digest.update(bytes);
            filled = 0;
        }
    }
    digest.update(&bytes[..filled]);
    digest.finalize().into()
}

/// Digest of a whole file, hexadecimal.
fn content_digest(attributes: &BTreeMap<String, Attribute>, arrays: &BTreeMap<String, Digest>) -> String {
    let mut text = String::new();
    for (name, value) in attributes {
        // A single number may read back as a list of one, or the other way round.
        let value = match value {
            Attribute::Number(number) => &Attribute::Numbers(vec![*number]),
            other => other,
        };
        let _ = write!(text, "{name:?} {value:?} ");
    }
    let _ = write!(text, "{arrays:?}");
    sha256(text.as_bytes())
}

/// Bytes of array descriptions kept while a file is read.
const MAX_METADATA: usize = 1 << 24;
/// Fields with fewer values are unpacked by the library of the format.
const MIN_UNPACKED: usize = 1 << 16;
/// A field file, open for reading.
pub struct Fields {
    path: PathBuf,
    file: File,
    /// The bytes of the file.
    bytes: FileBytes,
    /// Names of the arrays, sorted, once they have been read.
    names: OnceLock<Vec<String>>,
    /// Digest of each array read so far, if they are kept.
    digests: Option<Mutex<BTreeMap<String, Digest>>>,
}

impl Fields {
    /// Opens a file written by [`FieldFile::write`].
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn open(path: &Path) -> Result<Self> {
        let failed = |source| Error::File { path: path.to_owned(), source };
        regular::check(path, "a file of fields").map_err(failed)?;
        // Files get their names when they are complete.
        let access = FileAccessProperties::new().with_locking(FileLocking::Disabled);
        let access = access.with_metadata_cache(MetadataCacheConfig::new(MAX_METADATA));
        let bytes = FileBytes::open(path).map_err(failed)?;
        let file = File::from_source_with_options(bytes.clone(), access);
        let file = file.map_err(|error| file_error(path, error))?;
        Ok(Self { path: path.to_owned(), file, bytes, names: OnceLock::new(), digests: None })
    }

    /// Keeps the digest of each array that is read from now on, so that [`Self::verify`] does not read it
    /// again.
    pub fn with_digests(self) -> Self {
        Self { digests: Some(Mutex::default()), ..self }
    }

    /// Returns the names of the arrays, sorted.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn names(&self) -> Result<Vec<String>> {
        Ok(self.known()?.to_vec())
    }

    fn known(&self) -> Result<&[String]> {
        if let Some(names) = self.names.get() {
            return Ok(names);
        }
        let mut names = self.file.root().datasets().map_err(|error| self.error(error))?;
        names.sort_unstable();
        Ok(self.names.get_or_init(|| names))
    }

    /// Returns the attributes of the whole file.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn attributes(&self) -> Result<BTreeMap<String, Attribute>> {
        let attributes = self.file.root().attrs().map_err(|error| self.error(error))?;
        Ok(attributes.into_iter().filter_map(|(name, value)| Some((name, attribute(&value)?))).collect())
    }

    /// Returns the shape of the array `name` without reading it.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn shape(&self, name: &str) -> Result<Vec<usize>> {
        let shape = self.file.dataset(name).and_then(|dataset| dataset.shape());
        let shape = shape.map_err(|error| self.error(error))?;
        Ok(shape.into_iter().map(|size| size as usize).collect())
    }

    /// Reads the array `name`.
    ///
    /// # Errors
    /// [`Error::NoField`], [`Error::File`].
    pub fn read(&self, name: &str) -> Result<StoredField> {
        let known = self.known()?;
        if !known.iter().any(|other| other == name) {
            let available = known.to_vec();
            return Err(Error::NoField { path: self.path.clone(), name: name.to_owned(), available });
        }
        let stored = self.file.dataset(name).and_then(|dataset| stored(&dataset, &self.bytes));
        let stored = stored.map_err(|error| self.error(error))?;
        if let Some(digests) = &self.digests {
            let digest = stored.digest();
            digests.lock().unwrap_or_else(PoisonError::into_inner).insert(name.to_owned(), digest);
        }
        Ok(stored)
    }

    /// Compares the file with its stored digest. It reads all arrays, except those whose digests are kept.
    ///
    /// # Errors
    /// [`Error::File`], also if they differ.
    pub fn verify(&self) -> Result<()> {
        let mut attributes = self.attributes()?;
        let written = attributes.remove(DIGEST);
        let kept =
            |digests: &Mutex<BTreeMap<_, _>>| digests.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let mut arrays = self.digests.as_ref().map(kept).unwrap_or_default();
        for name in self.names()? {
            if let Entry::Vacant(array) = arrays.entry(name) {
                let digest = self.read(array.key())?.digest();
                array.insert(digest);
            }
        }
        if written == Some(content_digest(&attributes, &arrays).as_str().into()) {
            return Ok(());
        }
        let damaged =
            io::Error::new(io::ErrorKind::InvalidData, "it is damaged: its content has another digest");
        Err(Error::File { path: self.path.clone(), source: damaged })
    }

    fn error(&self, error: hdf5_pure::Error) -> Error {
        file_error(&self.path, error)
    }
}

/// Reads the array `name` of the file at `path`.
///
/// # Errors
/// [`Error::NoField`], [`Error::File`].
pub fn read_field(path: &Path, name: &str) -> Result<StoredField> {
    Fields::open(path)?.read(name)
}

impl StoredField {
    /// Digest of the array and its attributes.
    fn digest(&self) -> Digest {
        let Self { unit, axes, pitch, origin, values } = self;
        array_digest([unit, axes], values.shape(), [pitch, origin], values.iter())
    }

    /// Returns the values of a two-dimensional field, `[ix, iy]`; `None` for any other array.
    pub fn into_field(self) -> Option<Field> {
        self.values.into_dimensionality::<Ix2>().ok()
    }
}

/// Bytes of a file, for several threads.
#[derive(Clone)]
struct FileBytes {
    file: Arc<Mutex<fs::File>>,
    len: u64,
}

impl FileBytes {
    fn open(path: &Path) -> io::Result<Self> {
        let file = fs::File::open(path)?;
        let len = file.metadata()?.len();
        Ok(Self { file: Arc::new(Mutex::new(file)), len })
    }

    fn read(&self, offset: u64, bytes: &mut [u8]) -> io::Result<()> {
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.seek(SeekFrom::Start(offset))?;
        file.read_exact(bytes)
    }
}

impl Source for FileBytes {
    fn len(&self) -> u64 {
        self.len
    }

    fn read_at(&self, offset: u64, buf: &mut [u8]) -> std::result::Result<(), FormatError> {
        self.read(offset, buf).map_err(|error| match error.kind() {
            io::ErrorKind::UnexpectedEof => FormatError::UnexpectedEof {
                expected: buf.len(),
                available: self.len.saturating_sub(offset) as usize,
            },
            _ => FormatError::Source(error.to_string()),
        })
    }
}

/// Reads the values of an array that was packed by [`Packed`], on all threads. `None` for other arrays, and
/// for damaged ones, whose error the library of the format reports.
fn unpacked(dataset: &Dataset, shape: &[usize], bytes: &FileBytes) -> Option<Vec<f64>> {
    let sizes: Vec<u64> = shape.iter().map(|size| *size as u64).collect();
    let chunk = dataset.chunk_shape().ok()??;
    let byte_order = DatatypeByteOrder::LittleEndian;
    let is_double = |kind: &Datatype| matches!(kind, Datatype::FloatingPoint { size: 8, byte_order: order, .. } if *order == byte_order);
    let is_ours = dataset.filters() == [2, 1] && dataset.datatype().is_ok_and(|kind| is_double(&kind));
    if !is_ours || chunk.len() != sizes.len() || chunk[1..] != sizes[1..] {
        return None;
    }
    let len = usize::try_from(chunk.iter().product::<u64>()).ok()?;
    let chunks = dataset.chunks().ok()?;
    let (all, row) = (shape.iter().product::<usize>(), shape[1..].iter().product::<usize>());
    let places: Vec<usize> = chunks.iter().map(|chunk| chunk.offset[0] as usize * row).collect();
    let is_whole = places.iter().enumerate().all(|(at, place)| *place == at * len);
    if all < MIN_UNPACKED || !is_whole || chunks.len() != all.div_ceil(len) {
        return None;
    }
    if chunks.iter().any(|chunk| chunk.filter_mask != 0 || chunk.storage_size > bytes.len) {
        return None;
    }
    let mut values = vec![0.0; all];
    let unpack = |(values, chunk): (&mut [f64], &hdf5_pure::Chunk)| -> io::Result<()> {
        let mut packed = vec![0; chunk.storage_size as usize];
        bytes.read(chunk.address, &mut packed)?;
        packing::unpack(&packed, len, values)
    };
    values.par_chunks_mut(len).zip(&chunks).try_for_each(unpack).ok()?;
    Some(values)
}

fn stored(dataset: &Dataset, bytes: &FileBytes) -> std::result::Result<StoredField, hdf5_pure::Error> {
    let shape: Vec<usize> = dataset.shape()?.iter().map(|size| *size as usize).collect();
    let attributes = dataset.attrs()?;
    let text = |name| {
        let text = attributes.get(name).and_then(AttrValue::as_str);
        text.unwrap_or_default().to_owned()
    };
    let numbers = |name| attributes.get(name).and_then(AttrValue::to_f64s).unwrap_or_default();
    let values = match unpacked(dataset, &shape, bytes) {
        Some(values) => values,
        None => dataset.read_f64()?,
    };
    let values =
        ArrayD::from_shape_vec(shape, values).map_err(|error| hdf5_pure::Error::Shape(error.to_string()))?;
    Ok(StoredField {
        unit: text("unit"),
        axes: text("axes"),
        pitch: numbers("pitch"),
        origin: numbers("origin"),
        values,
    })
}

fn attribute(value: &AttrValue) -> Option<Attribute> {
    if let Some(text) = value.as_str() {
        return Some(Attribute::Text(text.to_owned()));
    }
    Some(match value {
        AttrValue::F64(number) => Attribute::Number(*number),
        AttrValue::F64Array(numbers) => Attribute::Numbers(numbers.clone()),
        other => Attribute::Integer(other.as_i64()?),
    })
}

fn file_error(path: &Path, error: hdf5_pure::Error) -> Error {
    let source = match error {
        hdf5_pure::Error::Io(error) => error,
        other => {
            let text = other.to_string();
            let text = if text.starts_with("HDF5") { text } else { format!("HDF5: {text}") };
            io::Error::new(io::ErrorKind::InvalidData, text)
        }
    };
    Error::File { path: path.to_owned(), source }
}

impl From<&str> for Attribute {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<f64> for Attribute {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<usize> for Attribute {
    fn from(count: usize) -> Self {
        Self::Integer(count as i64)
    }
}

impl From<Vec<f64>> for Attribute {
    fn from(numbers: Vec<f64>) -> Self {
        Self::Numbers(numbers)
    }
}

#[cfg(test)]
mod tests {
    use std::process::Command;

    use super::*;

    fn field(grid: &Grid) -> Field {
        Field::from_shape_fn(grid.shape, |(ix, iy)| ((ix * 7 + iy * 3) % 11) as f64 / 3.0)
    }

    #[test]
    fn fields_read_back_with_their_units_and_axes() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("fields.h5");
        let small = Grid::new([3, 2], [1e-6, 2e-6]).unwrap();
        let large = Grid::new([257, 129], [1e-6, 2e-6]).unwrap();
        let mut with_hole = field(&small);
        with_hole[[1, 1]] = f64::NAN;
        let loads: Vec<f64> = (0..5).map(f64::from).collect();

        let mut file = FieldFile::new(&path);
        file.set("version", "0.1.0").set("pass", 3).set("load", 2.5).set("window", vec![0.0, 1.0]);
        file.add_field("gap", "m", &small, [0.0, 0.0], &with_hole);
        file.add_field("pressure", "Pa", &large, [1e-3, 0.0], &field(&large));
        file.add_series("load", "N", "x", 1e-6, 0.0, &loads);
        file.add_section("stress", "Pa", [1e-6, 5e-7], 3e-6, &field(&small));
        file.write().unwrap();

        let fields = Fields::open(&path).unwrap();
        assert_eq!(fields.names().unwrap(), ["gap", "load", "pressure", "stress"]);
        let attributes = fields.attributes().unwrap();
        assert_eq!(attributes["version"], "0.1.0".into());
        assert_eq!(attributes["pass"], 3.into());
        assert_eq!(attributes["load"], 2.5.into());
        assert_eq!(attributes["window"], vec![0.0, 1.0].into());

        let pressure = fields.read("pressure").unwrap();
        assert_eq!((pressure.unit.as_str(), pressure.axes.as_str()), ("Pa", "x,y"));
        assert_eq!(
            (&pressure.pitch[..], &pressure.origin[..]),
            (&[1e-6, 2e-6][..], &[1e-3 + 0.5e-6, 1e-6][..])
        );
        assert_eq!(pressure.into_field().unwrap(), field(&large));
        let stress = fields.read("stress").unwrap();
        assert_eq!(
            (stress.axes.as_str(), &stress.origin[..], stress.pitch[1]),
            ("x,z", &[3e-6, 0.0][..], 5e-7)
        );
        assert_eq!(stress.into_field().unwrap(), field(&small));
        let gap = read_field(&path, "gap").unwrap().into_field().unwrap();
        assert!(gap.iter().zip(&with_hole).all(|(found, written)| found.to_bits() == written.to_bits()));
        let load = fields.read("load").unwrap();
        assert_eq!((load.values.as_slice().unwrap(), load.axes.as_str()), (&loads[..], "x"));
        assert_eq!(load.into_field(), None);
    }

    #[test]
    fn a_field_that_is_not_there_names_those_that_are() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("fields.h5");
        let grid = Grid::new([2, 2], [1.0, 1.0]).unwrap();
        let mut file = FieldFile::new(&path);
        file.add_field("gap", "m", &grid, [0.0, 0.0], &grid.zeros());
        file.write().unwrap();
        let error = read_field(&path, "presure").unwrap_err();
        assert!(error.to_string().starts_with("no field `presure` in "), "{error}");
        assert_eq!(error.hint().unwrap(), "it holds `gap`");
    }

    /// Several times the amount that waits to be written, and more arrays than fit into a header.
    fn written_in_turns(path: &Path) -> Field {
        let large = Grid::new([1024, 1100], [1e-6; 2]).unwrap();
        let small = Grid::new([8, 9], [1e-6; 2]).unwrap();
        let mut file = FieldFile::new(path);
        for n in 0..5 {
            file.add_field(&format!("large_{n}"), "m", &large, [0.0; 2], &(field(&large) + f64::from(n)));
            for m in 0..6 {
                let name = format!("small_{n}_{m}");
                file.add_field(&name, "m", &small, [0.0; 2], &(field(&small) * f64::from(n - m)));
                file.set(&name, f64::from(n - m));
            }
        }
        assert!(!path.exists());
        file.write().unwrap();
        field(&large)
    }

    #[test]
    fn a_file_written_in_turns_is_complete() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("many").join("fields.h5");
        let large = written_in_turns(&path);
        let fields = Fields::open(&path).unwrap();
        fields.verify().unwrap();
        assert_eq!((fields.names().unwrap().len(), fields.attributes().unwrap().len()), (35, 31));
        assert_eq!(fields.read("large_4").unwrap().into_field().unwrap(), large + 4.0);
        assert_eq!(std::fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    }

    #[test]
    #[ignore = "needs a Python with h5py, which ASPERITY_PYTHON names"]
    fn a_file_written_in_turns_is_read_in_python() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("fields.h5");
        let large = written_in_turns(&path);
        let script = "import sys, h5py\nf = h5py.File(sys.argv[1])\nl = f['large_3']\n\
                      print(len(f), len(f.attrs), l.shape, l.attrs['unit'], l[1023, 1099], \
                      f['small_4_1'][1, 0] / f['small_1_0'][1, 0], f.attrs['small_4_1'])";
        let python = std::env::var_os("ASPERITY_PYTHON").expect("ASPERITY_PYTHON names a Python with h5py");
        let output = Command::new(python).args(["-c", script]).arg(&path).output().unwrap();
        let expected = format!("35 31 (1024, 1100) m {:?} 3.0 3.0", large[[1023, 1099]] + 3.0);
        assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), expected, "{output:?}");
    }

    #[test]
    fn a_file_that_cannot_be_written_says_so_in_the_end() {
        let directory = tempfile::tempdir().unwrap();
        let inside = directory.path().join("taken");
        std::fs::write(&inside, b"a file").unwrap();
        let mut file = FieldFile::new(&inside.join("fields.h5"));
        let grid = Grid::new([3, 2], [1e-6; 2]).unwrap();
        file.set("pass", 3).add_field("gap", "m", &grid, [0.0; 2], &field(&grid));
        assert!(matches!(file.write(), Err(Error::File { path, .. }) if path == inside));
    }

    #[test]
    fn no_damage_of_a_byte_changes_a_value_unnoticed() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("fields.h5");
        let grids = [[3, 2], [40, 30]].map(|shape| Grid::new(shape, [1e-6; 2]).unwrap());
        let mut file = FieldFile::new(&path);
        file.set("version", "0.1.0").set("pass", 3);
        for (name, grid) in ["small", "large"].into_iter().zip(&grids) {
            file.add_field(name, "m", grid, [0.0; 2], &field(grid));
        }
        file.write().unwrap();
        let whole = std::fs::read(&path).unwrap();
        // Every read returns either all values or an error.
        let read = || -> Result<()> {
            let fields = Fields::open(&path)?;
            fields.verify()?;
            for (name, grid) in ["small", "large"].into_iter().zip(&grids) {
                assert_eq!(fields.read(name)?.into_field(), Some(field(grid)), "{name}");
            }
            Ok(())
        };
        read().unwrap();
        let found = (0..whole.len()).step_by(11).filter(|byte| {
            let mut damaged = whole.clone();
            damaged[*byte] ^= 1 << (byte % 8);
            std::fs::write(&path, damaged).unwrap();
            read().is_err()
        });
        let found = found.count();
        // Most of a small file is padding.
        assert!(found > 80, "{found} of {}", whole.len());
        for length in [0, 100, whole.len() / 2, whole.len() - 1] {
            std::fs::write(&path, &whole[..length]).unwrap();
            assert!(read().is_err(), "{length} bytes");
        }
    }

    #[test]
    fn a_damaged_file_is_an_error() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("fields.h5");
        let missing = Fields::open(&path).err().unwrap().to_string();
        assert!(missing.starts_with(path.to_str().unwrap()), "{missing}");
        std::fs::write(&path, b"not HDF5").unwrap();
        assert!(Fields::open(&path).err().unwrap().to_string().contains("HDF5"));
    }

    #[test]
    fn a_run_leaves_no_file_with_a_value_that_is_no_number() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("pass-0001.h5");
        let grid = Grid::new([2, 3], [1e-6; 2]).unwrap();
        let mut values = grid.zeros();
        values[[1, 2]] = f64::NAN;
        let mut file = FieldFile::of_run("identity", &path);
        file.add_field("temperature_00001", "K", &grid, [0.0; 2], &values);
        file.add_field("upper", "m", &grid, [0.0; 2], &values);
        file.add_field("lower", "m", &grid, [0.0; 2], &grid.zeros());
        let error = file.write().unwrap_err();
        assert_eq!(error.to_string(), "`upper` is not a finite number in cell [1, 2]");
        assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 0, "nothing is left");
    }
}

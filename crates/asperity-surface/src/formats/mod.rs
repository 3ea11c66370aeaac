//! Topography files, with one module per format. The format is recognised by the content when reading, and by
//! the file extension when writing.
//!
//! For any content a reader returns a [`Scan`] or an error. It compares the sizes in a header with the
//! existing data before it allocates memory, and decompresses no more than the header specifies.

mod binary;
mod foreign;
mod header;
mod numbers;
mod labels;
mod points;
mod preamble;
mod words;
mod write;

mod al3d;
mod asc;
mod bcr;
mod csv;
#[cfg(feature = "hdf5")]
mod data_sets;
#[cfg(feature = "hdf5")]
mod datx;
mod frt;
mod gsf;
mod gwy;
#[cfg(feature = "hdf5")]
mod hdf5;
mod headed;
mod ibw;
mod mat;
mod metropro;
mod mi;
#[cfg(feature = "compound")]
mod mnt;
mod nanoscope;
mod netcdf;
mod nid;
mod nms;
mod npy;
#[cfg(feature = "zip")]
mod npz;
mod opd;
mod opdx;
mod plu;
mod sdf;
mod sur;
mod text;
#[cfg(feature = "tiff")]
mod tiff;
mod tmd;
mod vk;
mod vtk;
mod wsxm;
#[cfg(feature = "zip")]
mod x3p;

use std::collections::HashSet;
use std::io::Read;
use std::path::Path;

pub use write::Format;

use crate::{Axis, Topography};
use asperity_base::error::{Defect, Error, Result};
use asperity_base::grid::{Field, Grid};
use asperity_base::io::{self, regular};
use asperity_base::units::{Dimension, Metre};
use foreign::Foreign;

/// Heights of a file.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Scan {
    /// Name of the module of the format, such as `x3p`; for text `text` (a matrix), `xyz` (a table of x, y,
    /// height), `xz` (a profile of x and height) or the program that wrote its header.
    pub format: &'static str,
    /// The channel read.
    pub channel: String,
    /// All height channels of the file, the default one first.
    pub channels: Vec<String>,
    /// Distance between neighbouring heights along x and y, if the file contains it.
    pub pitch: Option<[Metre; 2]>,
    /// Heights in metres, `[ix, iy]`, NaN where missing.
    pub heights: Field,
    /// Information in the file about the unit of its numbers.
    pub unit: LengthUnit,
    /// Direction along which a line of the matrix in the file was laid; none if the format or the file
    /// determines it.
    pub lines: Option<Axis>,
}

/// Information in a file about the unit of its numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum LengthUnit {
    /// The file has a unit.
    Known,
    /// The file has no unit for its heights: they are in metres unless a unit is given.
    Metres,
    /// The file has no unit at all: heights and pitch are in metres unless a unit is given.
    MetresThroughout,
    /// The heights of the file are levels, which need a unit to become lengths.
    Levels,
}

/// Options for reading a topography file: the channel, and values that the file may lack.
///
/// The format is recognised by the content, never by the name. Any file may be gzipped.
///
/// ```no_run
/// use asperity_surface::ReadOptions;
///
/// let topography = ReadOptions::default().with_channel("height").with_pitch([0.5e-6; 2]).read("disc.npy")?;
/// # Ok::<(), asperity_surface::Error>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct ReadOptions {
    /// The channel to read; the first one by default. Files with one unnamed channel call it `height`.
    pub channel: Option<String>,
    /// Size of the unit in a file without units, above 0; a metre by default, see [`LengthUnit`].
    pub unit: Option<Metre>,
    /// Distance between neighbouring heights along x and y for a file without a pitch, each above 0.
    pub pitch: Option<[Metre; 2]>,
    /// Direction of a line of a matrix whose format does not determine it: x by default for text, y for
    /// arrays (npy, npz, mat, HDF5), which are indexed `[ix, iy]`. A text that looks like points is a matrix
    /// if this is given.
    pub lines: Option<Axis>,
    /// Number of lines above the numbers of a text.
    pub skip: usize,
}

impl ReadOptions {
    /// Sets the channel to read.
    #[must_use]
    pub fn with_channel(mut self, channel: impl Into<String>) -> Self {
        self.channel = Some(channel.into());
        self
    }

    /// Sets the size of the unit in a file without units, above 0.
    #[must_use]
    pub fn with_unit(mut self, unit: Metre) -> Self {
        self.unit = Some(unit);
        self
    }

    /// Sets the pitch for a file without one, each above 0.
    #[must_use]
    pub fn with_pitch(mut self, pitch: [Metre; 2]) -> Self {
        self.pitch = Some(pitch);
        self
    }

    /// Sets the direction of a line of a matrix whose format does not determine it.
    #[must_use]
    pub fn with_lines(mut self, along: Axis) -> Self {
        self.lines = Some(along);
        self
    }

    /// Sets the number of lines above the numbers of a text.
    #[must_use]
    pub fn with_skip(mut self, lines: usize) -> Self {
        self.skip = lines;
        self
    }

    /// Reads the topography in the file at `path`.
    ///
    /// # Errors
    /// The errors of [`scan`](Self::scan), and [`Error::NoPitch`] if neither the file nor these options have
    /// a pitch.
    pub fn read(&self, path: impl AsRef<Path>) -> Result<Topography> {
        let path = path.as_ref();
        let Scan { format, pitch, heights, .. } = self.scan(path)?;
        let missing = || Error::NoPitch { path: path.to_owned(), format };
        let grid = Grid::new([heights.nrows(), heights.ncols()], pitch.ok_or_else(missing)?)?;
        Topography::new(grid, heights)
    }

    /// Reads the heights in the file at `path`, with the other data about them.
    ///
    /// # Errors
    /// [`Error::File`] if it cannot be read, [`Error::NotATopography`] if its format is unknown,
    /// [`Error::CorruptTopography`] if it is damaged, uses an unsupported part of the format or lacks a
    /// required unit, [`Error::NoChannel`], [`Error::OwnUnit`] if a unit is given for a file that has one,
    /// [`Error::OptionOfText`] if `lines` or `skip` is given for a format that leaves nothing open.
    pub fn scan(&self, path: impl AsRef<Path>) -> Result<Scan> {
        let path = path.as_ref();
        self.scan_bytes(path, &contents(path)?)
    }

    /// Reads the heights in `bytes`, the content of a file called `name` in errors.
    ///
    /// # Errors
    /// The errors of [`scan`](Self::scan) without [`Error::File`].
    pub fn scan_bytes(&self, name: impl AsRef<Path>, bytes: &[u8]) -> Result<Scan> {
        let scan = decode(bytes, self).and_then(|scan| scan.in_lines(self.lines)?.in_unit(self.unit));
        let mut scan = scan.map_err(|fault| fault.at(name.as_ref(), self.channel.as_deref()))?;
        scan.pitch = scan.pitch.or(self.pitch);
        Ok(scan)
    }
}

impl Topography {
    /// Reads the topography in the file at `path`, of any format. Use [`ReadOptions`] for values that the
    /// file lacks.
    ///
    /// # Errors
    /// The errors of [`ReadOptions::read`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self> {
        ReadOptions::default().read(path)
    }
}

impl Scan {
    /// The chosen channel of a file that has the unit of its heights. A pitch that is not usable is left out.
    fn of_channel(
        format: &'static str,
        channels: Vec<String>,
        chosen: usize,
        pitch: [Metre; 2],
        heights: Field,
    ) -> Self {
        let (channel, pitch) = (channels[chosen].clone(), usable_pitch(pitch));
        Self { format, channel, channels, pitch, heights, unit: LengthUnit::Known, lines: None }
    }

    /// The chosen matrix of a file whose matrices have neither unit nor pitch.
    fn of_matrix(format: &'static str, channels: Vec<String>, chosen: usize, heights: Field) -> Self {
        Self {
            format,
            channel: channels[chosen].clone(),
            channels,
            pitch: None,
            heights,
            unit: LengthUnit::Metres,
            lines: Some(Axis::Y),
        }
    }

    /// Whether the heights describe an underside, as mounted: that of the upper body in asperity's results.
    pub fn is_underside(&self) -> bool {
        (self.format, self.channel.as_str()) == (RESULTS, UNDERSIDE)
    }

    /// Lays the lines of the matrix in the file along the given direction.
    fn in_lines(mut self, lines: Option<Axis>) -> Decoded {
        if let Some(wanted) = lines {
            let Some(found) = self.lines else {
                return Err(Fault::OptionOfText { format: self.format, option: "lines" });
            };
            if found != wanted {
                self.heights = self.heights.t().as_standard_layout().into_owned();
                self.lines = lines;
            }
        }
        Ok(self)
    }

    /// Multiplies the heights by the given unit, if they have none of their own.
    fn in_unit(mut self, unit: Option<Metre>) -> Decoded {
        match (self.unit, unit) {
            (LengthUnit::Known, Some(_)) => return Err(Fault::OwnUnit { format: self.format }),
            (LengthUnit::Levels, None) => {
                let expected = "heights, or with them the unit that one level stands for";
                let defect =
                    Defect::Value { what: "the kind of pixels", found: "levels".to_owned(), expected };
                return Err(Fault::defect(self.format, defect));
            }
            (_, None) => {}
            (kind, Some(unit)) => {
                self.heights.mapv_inplace(|z| finite(unit * z));
                self.unit = LengthUnit::Known;
                if kind == LengthUnit::MetresThroughout {
                    self.pitch = self.pitch.and_then(|pitch| usable_pitch(pitch.map(|p| unit * p)));
                }
            }
        }
        Ok(self)
    }
}

/// Largest number of heights: 2 GiB of them.
const MAX_CELLS: usize = 1 << 28;

/// Largest unpacked size of a gzipped file: the largest number of heights, and a header.
const MAX_UNPACKED: u64 = 8 * MAX_CELLS as u64 + (1 << 16);

/// Reads the bytes of a topography file.
pub fn contents(path: &Path) -> Result<Vec<u8>> {
    regular::read(path, "a topography file", u64::MAX)
        .map_err(|source| Error::File { path: path.to_owned(), source })
}

fn decode(bytes: &[u8], options: &ReadOptions) -> Decoded {
    if bytes.starts_with(&[0x1f, 0x8b]) {
        decode_plain(&unpacked(bytes, MAX_UNPACKED)?, options)
    } else {
        decode_plain(bytes, options)
    }
}

/// Unpacks the gzipped `bytes`, if the result has at most `most` bytes.
fn unpacked(bytes: &[u8], most: u64) -> std::result::Result<Vec<u8>, Fault> {
    let fault = |defect| Fault::defect("gzip", defect);
    let mut unpacked = Vec::new();
    let result = flate2::read::MultiGzDecoder::new(bytes).take(most + 1).read_to_end(&mut unpacked);
    result.map_err(|error| fault(Defect::Container(error.to_string())))?;
    match unpacked.len() as u64 {
        found if found > most => {
            Err(fault(Defect::Length { what: "the unpacked file", expected: most, found }))
        }
        _ => Ok(unpacked),
    }
}

fn decode_plain(bytes: &[u8], options: &ReadOptions) -> Decoded {
    type Decode = fn(&[u8], Option<&str>) -> Decoded;
    const READ: &[(&[&[u8]], Decode)] = &[
        #[cfg(feature = "zip")]
        (&[b"PK\x03\x04"], decode_archive),
        (&[b"DIGITAL SURF", b"DSCOMPRESSED"], sur::decode),
        (&[b"\x93NUMPY"], npy::decode),
        (&sdf::MAGICS, sdf::decode),
        (&[gwy::MAGIC], gwy::decode),
        (&[gsf::MAGIC], gsf::decode),
        (&mat::MAGICS, mat::decode),
        (&bcr::MAGICS, bcr::decode),
        (&[opd::MAGIC], opd::decode),
        (&metropro::MAGICS, metropro::decode),
        (&[al3d::MAGIC], al3d::decode),
        (&[frt::MAGIC], frt::decode),
        (&[tmd::MAGIC], tmd::decode),
        #[cfg(feature = "tiff")]
        (&tiff::MAGICS, tiff::decode),
        (&nanoscope::MAGICS, nanoscope::decode),
        (&[nid::MAGIC], nid::decode),
        (&[wsxm::MAGIC], wsxm::decode),
        (&[mi::MAGIC], mi::decode),
        #[cfg(feature = "compound")]
        (&[mnt::MAGIC], mnt::decode),
        (&[opdx::MAGIC], opdx::decode),
        (&vk::MAGICS, vk::decode),
        (&netcdf::MAGICS, netcdf::decode),
        #[cfg(feature = "hdf5")]
        (&[hdf5::MAGIC], hdf5::decode),
    ];
    if bytes.is_empty() {
        return Err(Fault::NotATopography(Foreign::new("it is empty")));
    }
    let starts_with = |magics: &[&[u8]]| magics.iter().any(|magic| bytes.starts_with(magic));
    let known = READ.iter().find(|(magics, _)| starts_with(magics)).map(|(_, decode)| *decode);
    let known = known
        .or_else(|| plu::is_one(bytes).then_some(plu::decode as Decode))
        .or_else(|| ibw::is_one(bytes).then_some(ibw::decode as Decode))
        .or_else(|| nms::is_one(bytes).then_some(nms::decode as Decode));
    if let (None, Some(kind)) = (known, foreign::kind(bytes)) {
        return Err(Fault::NotATopography(kind));
    }
    if let Some(decode) = known {
        let scan = decode(bytes, options.channel.as_deref())?;
        return match options.skip {
            0 => Ok(scan),
            _ => Err(Fault::OptionOfText { format: scan.format, option: "skip" }),
        };
    }
    match io::text::decode(bytes) {
        Some(text) => decode_text(&text, options),
        None => Err(Fault::NotATopography(Foreign::new("it is binary, of no known format"))),
    }
}

#[cfg(feature = "zip")]
fn decode_archive(bytes: &[u8], channel: Option<&str>) -> Decoded {
    if npz::is_one(bytes) { npz::decode(bytes, channel) } else { x3p::decode(bytes, channel) }
}

/// Decodes text without a byte order mark. After skipped lines it is a matrix or a table, whatever the lines
/// say.
fn decode_text(text: &str, options: &ReadOptions) -> Decoded {
    let channel = options.channel.as_deref();
    if options.skip == 0
        && let Some(decoded) = headed::decode(text, channel).or_else(|| asc::decode(text, channel))
    {
        return decoded;
    }
    let numbers = numbers::Part::after(text, options.skip);
    csv::decode(numbers, channel).unwrap_or_else(|| text::decode(numbers, options))
}

type Decoded = std::result::Result<Scan, Fault>;

/// Reason for the failure of a decoder, which does not know the path.
#[derive(Debug)]
enum Fault {
    NotATopography(Foreign),
    Corrupt { format: &'static str, reason: Defect },
    NoChannel { available: Vec<String> },
    OwnUnit { format: &'static str },
    OptionOfText { format: &'static str, option: &'static str },
}

impl Fault {
    fn defect(format: &'static str, reason: Defect) -> Self {
        Self::Corrupt { format, reason }
    }

    fn at(self, path: &Path, channel: Option<&str>) -> Error {
        let path = path.to_owned();
        match self {
            Self::NotATopography(Foreign { reason, export }) => {
                Error::NotATopography { path, reason, export }
            }
            Self::Corrupt { format, reason } => Error::CorruptTopography { path, format, reason },
            Self::OwnUnit { format } => Error::OwnUnit { path, format },
            Self::OptionOfText { format, option } => Error::OptionOfText { path, format, option },
            Self::NoChannel { available } => {
                Error::NoChannel { path, channel: channel.unwrap_or_default().to_owned(), available }
            }
        }
    }
}

/// Returns the index of the requested channel among `available` (not empty).
fn choose(available: &[String], channel: Option<&str>) -> std::result::Result<usize, Fault> {
    match channel {
        None => Ok(0),
        Some(channel) => available
            .iter()
            .position(|name| name == channel)
            .ok_or_else(|| Fault::NoChannel { available: available.to_vec() }),
    }
}

/// Returns the index of the requested channel among `available` (not empty), none of which is a default.
fn choose_among(available: &[String], channel: Option<&str>) -> std::result::Result<usize, Fault> {
    match channel {
        None if available.len() > 1 => Err(Fault::NoChannel { available: available.to_vec() }),
        _ => choose(available, channel),
    }
}

/// Makes names distinct: a repeated name gets its position as a number.
fn distinct(names: impl Iterator<Item = String>) -> Vec<String> {
    let mut seen = HashSet::new();
    let number = |(index, mut name): (usize, String)| {
        while !seen.insert(name.clone()) {
            name = format!("{name} {}", index + 1);
        }
        name
    };
    names.enumerate().map(number).collect()
}

/// Format name of results of asperity.
const RESULTS: &str = "results";

/// Channel of results that is the underside of the upper body.
pub const UNDERSIDE: &str = "upper";

/// Name of the only channel of a file that does not name it.
const ONLY_CHANNEL: &str = "height";

fn only_channel(channel: Option<&str>) -> std::result::Result<Vec<String>, Fault> {
    let channels = vec![ONLY_CHANNEL.to_owned()];
    choose(&channels, channel)?;
    Ok(channels)
}

/// Creates the scan of a file with one channel, whose heights and pitch `read` finds in its content.
fn only(
    format: &'static str,
    channel: Option<&str>,
    read: impl FnOnce() -> std::result::Result<([Metre; 2], Field), Defect>,
) -> Decoded {
    let channels = only_channel(channel)?;
    let (pitch, heights) = read().map_err(|defect| Fault::defect(format, defect))?;
    Ok(Scan::of_channel(format, channels, 0, pitch, heights))
}

/// A channel of a file with several, whose heights are read only if it is chosen.
struct Channel<'a> {
    /// Name; empty if the file does not name it.
    name: String,
    pitch: [Metre; 2],
    unit: LengthUnit,
    heights: Box<dyn FnOnce() -> std::result::Result<Field, Defect> + 'a>,
}

/// Creates the scan of a file with these channels of heights.
fn several(
    format: &'static str,
    channel: Option<&str>,
    found: std::result::Result<Vec<Channel<'_>>, Defect>,
) -> Decoded {
    let fault = |defect| Fault::defect(format, defect);
    let mut found = found.map_err(fault)?;
    if found.is_empty() {
        return Err(fault(Defect::Missing("channel of lengths")));
    }
    let name = |channel: &Channel<'_>| match channel.name.as_str() {
        "" => ONLY_CHANNEL.to_owned(),
        name => name.to_owned(),
    };
    let channels = distinct(found.iter().map(name));
    let chosen = choose(&channels, channel)?;
    let Channel { pitch, unit, heights, .. } = found.swap_remove(chosen);
    let heights = heights().map_err(fault)?;
    Ok(Scan { unit, ..Scan::of_channel(format, channels, chosen, pitch, heights) })
}

/// Returns the product of the sizes in a header, if it is an accepted number of heights.
fn cells(sizes: &[u64]) -> std::result::Result<usize, Defect> {
    let cells = sizes.iter().fold(1u128, |product, size| product.saturating_mul(u128::from(*size)));
    match usize::try_from(cells) {
        Ok(cells) if cells <= MAX_CELLS => Ok(cells),
        _ => Err(Defect::TooLarge { cells, limit: MAX_CELLS }),
    }
}

/// Returns a pitch if it is valid for a grid; otherwise the user must give one.
fn usable_pitch(pitch: [Metre; 2]) -> Option<[Metre; 2]> {
    pitch.iter().all(|p| Dimension::Length.range().holds(*p)).then_some(pitch)
}

/// Reverses the order of the lines, for a file with the last one first.
fn from_last_y_to_first(heights: &mut Field) {
    for mut column in heights.rows_mut() {
        column.as_slice_mut().expect("heights are in standard layout").reverse();
    }
}

/// Returns `height` if it is finite, otherwise NaN.
fn finite(height: Metre) -> Metre {
    if height.is_finite() { height } else { f64::NAN }
}

/// Creates heights stored with x fastest, as by almost every instrument. `heights` writes consecutive ones
/// from an index on.
fn x_fastest(shape: [usize; 2], heights: impl Fn(usize, &mut [f64])) -> Field {
    // One tile at a time, which stays in the first-level cache while it is transposed; partly filled columns
    // are completed first.
    /// Side of a tile.
    const TILE: usize = 32;
    let [nx, ny] = shape;
    let mut field = Field::zeros(shape);
    let cells = field.as_slice_mut().expect("a new field is in standard layout");
    let mut tile = [[0.0; TILE]; TILE];
    for (strip, columns) in cells.chunks_mut(TILE * ny).enumerate() {
        for y in (0..ny).step_by(TILE) {
            let lines = &mut tile[..TILE.min(ny - y)];
            for (iy, line) in lines.iter_mut().enumerate() {
                heights(TILE * strip + nx * (y + iy), &mut line[..columns.len() / ny]);
            }
            for (ix, column) in columns.chunks_mut(ny).enumerate() {
                for (cell, line) in column[y..].iter_mut().zip(&*lines) {
                    *cell = line[ix];
                }
            }
        }
    }
    field
}

#[cfg(all(test, feature = "formats"))]
mod tests;

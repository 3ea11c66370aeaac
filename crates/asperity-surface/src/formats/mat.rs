//! MAT: variables of MATLAB, version 5 (`save -v6` and `-v7`) and 7.3; read only.
//!
//! Format: "MAT-File Format" by MathWorks. A header of 128 bytes ends with the version and the byte order.
//! Data elements follow: kind, number of bytes, content, padded to eight bytes. Small ones share their first
//! eight bytes with the content. A variable is an element `miMATRIX`, possibly compressed by zlib: flags with
//! its class, dimensions, name and numbers, whose storage may be narrower than the class. Version 7.3 is HDF5
//! behind a block of 512 bytes, with the dimensions reversed.
//!
//! Each matrix of real numbers is a channel, indexed `[ix, iy]` in metres: its rows are ix. Scalars are left
//! out, and so are vectors beside a matrix, logical, complex and sparse arrays, text and structures. If there
//! are several, the user must choose one. There is no pitch.

use std::io::Read;

#[cfg(feature = "hdf5")]
use hdf5_pure::{AttrValue, Dataset};

use super::binary::{Cursor, Number, Order, Raster, text};
#[cfg(feature = "hdf5")]
use super::hdf5;
use super::words::excerpt;
use super::{Decoded, Fault, Scan, cells, choose_among};
use asperity_base::error::Defect;
use asperity_base::grid::Field;

/// First bytes of the file.
pub(super) const MAGICS: [&[u8]; 2] = [b"MATLAB 5.0 MAT-file", HIERARCHICAL];
const HIERARCHICAL: &[u8] = b"MATLAB 7.3 MAT-file";

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    if bytes.starts_with(HIERARCHICAL) {
        return hierarchical(bytes, channel);
    }
    let fault = |defect| Fault::defect("mat", defect);
    let (mut variables, others) = variables(bytes).map_err(fault)?;
    if variables.iter().any(|variable| !variable.is_vector()) {
        variables.retain(|variable| !variable.is_vector());
    }
    if variables.is_empty() {
        let (found, expected) = (excerpt(&others.join(", ")), "a matrix of real numbers");
        return Err(fault(Defect::Value { what: "the content", found, expected }));
    }
    // Names are distinct in a file of MATLAB.
    let channels = super::distinct(variables.iter().map(|variable| variable.name.clone()));
    let chosen = choose_among(&channels, channel)?;
    let heights = variables[chosen].heights().map_err(fault)?;
    Ok(Scan::of_matrix("mat", channels, chosen, heights))
}

#[cfg(not(feature = "hdf5"))]
fn hierarchical(_: &[u8], _: Option<&str>) -> Decoded {
    let reason = "it is HDF5 by MATLAB 7.3, and the feature `hdf5` is left out";
    Err(Fault::NotATopography(super::foreign::Foreign::new(reason)))
}

/// Reads version 7.3.
#[cfg(feature = "hdf5")]
fn hierarchical(bytes: &[u8], channel: Option<&str>) -> Decoded {
    const BLOCK: usize = 512;
    if !bytes.get(BLOCK..).is_some_and(|file| file.starts_with(hdf5::MAGIC)) {
        return Err(Fault::defect("mat", Defect::Missing("HDF5 behind 512 bytes")));
    }
    // Text and logical values are numbers whose class says so.
    let is_numeric = |set: &Dataset| {
        let class = set
            .attrs()
            .ok()
            .and_then(|all| all.get("MATLAB_class").and_then(AttrValue::as_str).map(str::to_owned));
        class.is_none_or(|class| {
            class == "double" || class == "single" || class.trim_start_matches('u').starts_with("int")
        })
    };
    let sizes = |set: &Dataset| set.shape().unwrap_or_default();
    let is_matrix = |set: &Dataset| is_numeric(set) && !sizes(set).contains(&1);
    let is_vector = |set: &Dataset| is_numeric(set) && sizes(set).iter().any(|size| *size > 1);
    let mut scan = match hdf5::decode_sets("mat", bytes, channel, is_matrix) {
        Err(Fault::Corrupt { reason: Defect::Missing(_), .. }) => {
            hdf5::decode_sets("mat", bytes, channel, is_vector)?
        }
        decoded => decoded?,
    };
    scan.heights = scan.heights.t().as_standard_layout().into_owned();
    Ok(scan)
}

type Outcome<T> = Result<T, Defect>;

const HEADER: usize = 128;
const COMPRESSED: u32 = 15;
const MATRIX: u32 = 14;

/// Largest size of what stands before the numbers of a variable, and largest number of variables.
const MAX_HEADER: u64 = 1 << 12;
const MAX_VARIABLES: usize = 1 << 12;

/// A matrix of real numbers, or a vector.
struct Variable<'a> {
    name: String,
    /// Number of rows and of columns.
    shape: [usize; 2],
    order: Order,
    /// The element, without its first eight bytes.
    content: Content<'a>,
}

#[derive(Clone, Copy)]
enum Content<'a> {
    Plain(&'a [u8]),
    /// Compressed, with the first eight bytes.
    Packed(&'a [u8]),
}

/// Returns the matrices and vectors of real numbers, and the names of the other variables with what they are.
fn variables(bytes: &[u8]) -> Outcome<(Vec<Variable<'_>>, Vec<String>)> {
    let order = match bytes.get(HEADER - 2..HEADER) {
        Some(b"IM") => Order::Little,
        Some(b"MI") => Order::Big,
        _ => return Err(Defect::Missing("byte order at the end of the header")),
    };
    let mut file = Cursor::new(bytes, order, "the file");
    file.seek(HEADER)?;
    let (mut variables, mut others) = (Vec::new(), Vec::new());
    while !file.rest().is_empty() && variables.len() + others.len() < MAX_VARIABLES {
        let (kind, size) = (file.u32()?, file.u32()? as usize);
        let content = file.take(size)?;
        let content = match kind {
            COMPRESSED => Content::Packed(content),
            MATRIX => Content::Plain(content),
            _ => continue,
        };
        match Variable::of(content, order)? {
            Ok(variable) => variables.push(variable),
            Err(other) => others.push(other),
        }
    }
    Ok((variables, others))
}

impl<'a> Variable<'a> {
    /// Reads what stands before the numbers; the name and the kind of a variable that is no matrix or vector
    /// of real numbers.
    fn of(content: Content<'a>, order: Order) -> Outcome<Result<Self, String>> {
        let start = content.start(MAX_HEADER)?;
        let mut cursor = Cursor::new(&start, order, "a variable");
        let flags = element(&mut cursor)?.1;
        // The class and the flags are two bytes of one number.
        let [class, flags] = match (order, flags) {
            (Order::Little, [class, flags, ..]) => [*class, *flags],
            (Order::Big, [_, _, flags, class, ..]) => [*class, *flags],
            _ => return Err(Defect::Missing("flags of a variable")),
        };
        let (_, sizes) = element(&mut cursor)?;
        let sizes: Vec<_> = sizes.as_chunks().0.iter().map(|size| number(order, *size)).collect();
        let name = text(element(&mut cursor)?.1);
        const COMPLEX: u8 = 0x08;
        const LOGICAL: u8 = 0x02;
        let kind = match (class, &sizes[..]) {
            (1, _) => "a cell array",
            (2 | 3, _) => "a structure",
            (4, _) => "text",
            (5, _) => "sparse",
            (6..=15, _) if flags & COMPLEX != 0 => "complex",
            (6..=15, _) if flags & LOGICAL != 0 => "logical",
            (6..=15, &[rows, columns]) => match cells(&[rows.into(), columns.into()])? {
                0 => "empty",
                1 => "a number",
                _ => {
                    let shape = [rows as usize, columns as usize];
                    return Ok(Ok(Self { name, shape, order, content }));
                }
            },
            (6..=15, _) => "of more dimensions",
            _ => "of another class",
        };
        Ok(Err(format!("{name}: {kind}")))
    }

    fn is_vector(&self) -> bool {
        self.shape.contains(&1)
    }

    fn heights(&self) -> Outcome<Field> {
        let most = MAX_HEADER + 8 * (self.shape[0] * self.shape[1]) as u64;
        let content = self.content.start(most)?;
        let mut cursor = Cursor::new(&content, self.order, "a variable");
        for _ in 0..3 {
            element(&mut cursor)?;
        }
        let (kind, data) = element(&mut cursor)?;
        let number = match kind {
            1 => Number::Int8,
            2 => Number::Uint8,
            3 => Number::Int16,
            4 => Number::Uint16,
            5 => Number::Int32,
            6 => Number::Uint32,
            7 => Number::Float32,
            9 => Number::Float64,
            12 => Number::Int64,
            13 => Number::Uint64,
            _ => {
                let expected = "that of real numbers";
                return Err(Defect::Value {
                    what: "the kind of an element",
                    found: kind.to_string(),
                    expected,
                });
            }
        };
        // Rows are fastest.
        Ok(Raster::new(self.shape, number, self.order, data)?.heights(|height| height))
    }
}

impl<'a> Content<'a> {
    /// Returns the start of a variable behind its first eight bytes, at most so many bytes.
    fn start(self, most: u64) -> Outcome<std::borrow::Cow<'a, [u8]>> {
        match self {
            Self::Plain(content) => Ok(content.into()),
            Self::Packed(packed) => {
                let mut unpacked = Vec::new();
                let mut decoder = flate2::read::ZlibDecoder::new(packed).take(8 + most);
                decoder.read_to_end(&mut unpacked).map_err(|error| Defect::Container(error.to_string()))?;
                if unpacked.len() < 8 {
                    let (expected, found) = (8, unpacked.len() as u64);
                    return Err(Defect::Length { what: "a compressed variable", expected, found });
                }
                Ok(unpacked.split_off(8).into())
            }
        }
    }
}

/// Reads the kind and the content of an element.
fn element<'a>(cursor: &mut Cursor<'a>) -> Outcome<(u32, &'a [u8])> {
    let word = cursor.u32()?;
    // A small element has its size in the upper half, and at most four bytes.
    if word >> 16 != 0 {
        let (kind, size) = (word & 0xffff, (word >> 16) as usize);
        let content = cursor.take(4)?;
        let found = content.get(..size);
        let expected = "at most 4 bytes";
        let too_long =
            || Defect::Value { what: "the size of a small element", found: size.to_string(), expected };
        return Ok((kind, found.ok_or_else(too_long)?));
    }
    let size = cursor.u32()? as usize;
    let content = cursor.take(size)?;
    let padding = size.next_multiple_of(8) - size;
    // Padding behind the last element may be absent.
    let _ = cursor.take(padding);
    Ok((word, content))
}

fn number(order: Order, bytes: [u8; 4]) -> u32 {
    match order {
        Order::Little => u32::from_le_bytes(bytes),
        Order::Big => u32::from_be_bytes(bytes),
    }
}

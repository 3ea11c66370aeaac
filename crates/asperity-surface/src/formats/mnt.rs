//! MNT: documents of Digital Surf's Mountains; read only.
//!
//! The file is a compound file (OLE). Its stream `ScopedContents` has 8 bytes and a tree of entries: tag u16,
//! size u64, content, little-endian. Entries of the list of objects are preceded by 8 bytes. An object is its
//! class (1 → 1, u32) and its body (2). An object of class 9012 that contains one of class 9062 is a measured
//! surface. Derived surfaces are not in the file. These tags lead from the body of the surface to its parts:
//!
//! ```text
//! ffff → ffff → 1 → ffff → 1     number of columns u32, of rows 2 → ffff → 1; their scales beside it: ffff
//! ffff → 2 → ffff                scale of the heights: step f64 (1), its unit (2), unit shown (3), origin in it f64 (5)
//! ffff → 1 → 2                   heights: count u32 (1), blocks (2), x fastest, i16 or i32, step · number + origin
//! ffff → ffff → 3 → 2            mask: columns (1), rows (2), blocks with a rim of one (5 → 2), u8, 9 where measured
//! ```
//!
//! Blocks consist of the total size u64 and, for each block, its first element u64, its number of elements
//! u32, its number of bytes u32 and these bytes, a zlib stream. Text is 4 and UTF-16.

use std::io::{Cursor, Read};

use super::binary::{Number, Order, Raster};
use super::foreign::kind_of_compound;
use super::words::unit_of_length;
use super::{Channel, Decoded, Fault, LengthUnit, several};
use asperity_base::error::Defect;
use asperity_base::units::Metre;

/// First bytes of the file, as of any compound file.
pub(super) const MAGIC: &[u8] = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1";

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    let container = |error: std::io::Error| Fault::defect("mnt", Defect::Container(error.to_string()));
    let mut file = cfb::CompoundFile::open(Cursor::new(bytes)).map_err(container)?;
    if !file.is_stream(STREAM) {
        return Err(Fault::NotATopography(kind_of_compound(|name| file.is_stream(name))));
    }
    let mut contents = Vec::new();
    let stream = file.open_stream(STREAM).map_err(container)?;
    stream.take(bytes.len() as u64).read_to_end(&mut contents).map_err(container)?;
    several("mnt", channel, channels(contents.get(8..).unwrap_or_default()))
}

type Outcome<T> = Result<T, Defect>;

/// Stream of the document.
const STREAM: &str = "/ScopedContents";

const SURFACE: u32 = 9012;
const MEASUREMENT: u32 = 9062;

/// Tag of the base class of a part.
const BASE: u16 = 0xffff;

fn channels(document: &[u8]) -> Outcome<Vec<Channel<'_>>> {
    let objects = part(document, &[1, 0x2bd, 2, 1]).ok_or(Defect::Missing("list of objects"))?;
    let surfaces = objects_in(objects).filter(|object| class(object) == Some(SURFACE));
    surfaces.filter_map(|object| surface(part(object, &[2])?).transpose()).collect()
}

/// Returns the channel of a surface, if it contains heights.
fn surface(body: &[u8]) -> Outcome<Option<Channel<'_>>> {
    let data = part(body, &[1]).filter(|data| class(data) == Some(MEASUREMENT));
    let Some(data) = data.and_then(|data| part(data, &[2, BASE])) else { return Ok(None) };
    let grid = part(data, &[BASE]).ok_or(Defect::Missing("grid"))?;
    let [x, y] = [1, 2].map(|axis| part(grid, &[axis, BASE]).ok_or(Defect::Missing("axis")));
    let (x, y) = (Axis::of(x?)?, Axis::of(y?)?);
    let height = Scale::of(part(data, &[2, BASE]).ok_or(Defect::Missing("scale of the heights"))?)?;
    let Ok(shown) = unit_of_length(&height.shown) else { return Ok(None) };
    let step = height.step * unit_of_length(&height.unit)?;
    let origin = height.origin * shown;

    let shape = super::binary::shape([x.count, y.count])?;
    let heights = part(data, &[1, 2]).ok_or(Defect::Missing("heights"))?;
    let mask = part(grid, &[3, 2]);
    let name = part(grid, &[BASE, BASE, 1]).and_then(text).filter(|name| !name.is_empty());
    Ok(Some(Channel {
        name: name.or_else(|| part(body, &[BASE, 4]).and_then(text)).unwrap_or_default(),
        pitch: [x.step, y.step],
        unit: LengthUnit::Known,
        heights: Box::new(move || {
            let (numbers, size) = unpacked(heights, shape)?;
            let number = match size {
                2 => Number::Int16,
                4 => Number::Int32,
                _ => {
                    let (found, expected) = (size.to_string(), "2 or 4");
                    return Err(Defect::Value { what: "the bytes of a height", found, expected });
                }
            };
            let raster = Raster::new(shape, number, Order::Little, &numbers)?;
            let mut heights = raster.heights(|number| number * step + origin);
            if let Some(mask) = mask {
                let framed = shape.map(|size| size + 2);
                let (mask, _) = unpacked(part(mask, &[5, 2]).ok_or(Defect::Missing("mask"))?, framed)?;
                let mask = Raster::new(framed, Number::Uint8, Order::Little, &mask)?.heights(|mask| mask);
                for ((ix, iy), height) in heights.indexed_iter_mut() {
                    if mask[[ix + 1, iy + 1]] != f64::from(MEASURED) {
                        *height = f64::NAN;
                    }
                }
            }
            Ok(heights)
        }),
    }))
}

const MEASURED: u8 = 9;

struct Axis {
    count: u32,
    step: Metre,
}

impl Axis {
    fn of(axis: &[u8]) -> Outcome<Self> {
        let scale = Scale::of(part(axis, &[BASE]).ok_or(Defect::Missing("scale of an axis"))?)?;
        let count = part(axis, &[1]).and_then(u32_of).ok_or(Defect::Missing("size of an axis"))?;
        Ok(Self { count, step: scale.step * unit_of_length(&scale.unit)? })
    }
}

struct Scale {
    step: f64,
    unit: String,
    /// Unit of the origin.
    shown: String,
    origin: f64,
}

impl Scale {
    fn of(scale: &[u8]) -> Outcome<Self> {
        let number = |tag| Some(f64::from_le_bytes(part(scale, &[tag])?.try_into().ok()?));
        let step = number(1).ok_or(Defect::Missing("step of a scale"))?;
        let unit = part(scale, &[2]).and_then(text).ok_or(Defect::Missing("unit of a scale"))?;
        let shown = part(scale, &[3]).and_then(text).filter(|unit| !unit.is_empty());
        Ok(Self {
            step,
            shown: shown.unwrap_or_else(|| unit.clone()),
            unit,
            origin: number(5).unwrap_or(0.0),
        })
    }
}

/// Unpacks the numbers of an array of this shape; also returns the number of bytes of each.
fn unpacked(array: &[u8], shape: [usize; 2]) -> Outcome<(Vec<u8>, usize)> {
    /// Largest number of bytes that deflate expands one byte to.
    const MAX_INFLATION: usize = 1032;
    let cells = shape[0] * shape[1];
    let count = part(array, &[1]).and_then(u32_of).ok_or(Defect::Missing("size of an array"))?;
    if count as usize != cells {
        let found = count.to_string();
        return Err(Defect::Value { what: "the size of an array", found, expected: "that of its grid" });
    }
    let blocks = part(array, &[2]).ok_or(Defect::Missing("blocks of an array"))?;
    let mut blocks = super::binary::Cursor::new(blocks, Order::Little, "the blocks");
    let bytes = usize::try_from(blocks.u64()?).unwrap_or(usize::MAX);
    let size = bytes / cells;
    let most = blocks.rest().len().saturating_mul(MAX_INFLATION);
    if bytes % cells != 0 || bytes > most {
        let (found, expected) = (bytes.to_string(), "that of its numbers");
        return Err(Defect::Value { what: "the bytes of an array", found, expected });
    }
    let mut numbers = vec![0; bytes];
    let mut filled = 0;
    while !blocks.rest().is_empty() {
        let first = usize::try_from(blocks.u64()?).unwrap_or(usize::MAX).saturating_mul(size);
        let length = blocks.u32()? as usize * size;
        let packed = blocks.u32()? as usize;
        let packed = blocks.take(packed)?;
        let place = first.checked_add(length).and_then(|end| numbers.get_mut(first..end));
        let place = place.ok_or(Defect::Length {
            what: "the array",
            expected: first.saturating_add(length) as u64,
            found: bytes as u64,
        })?;
        flate2::read::ZlibDecoder::new(packed)
            .read_exact(place)
            .map_err(|error| Defect::Container(format!("zlib: {error}")))?;
        filled += length;
        // A repeated block would take forever.
        if filled > bytes {
            break;
        }
    }
    if filled != bytes {
        return Err(Defect::Length { what: "the array", expected: bytes as u64, found: filled as u64 });
    }
    Ok((numbers, size))
}

/// Follows the tags to a part, using the first entry of each.
fn part<'a>(bytes: &'a [u8], tags: &[u16]) -> Option<&'a [u8]> {
    tags.iter().try_fold(bytes, |part, tag| {
        let mut rest = part;
        loop {
            let (found, content, behind) = entry(rest)?;
            if found == *tag {
                return Some(content);
            }
            rest = behind;
        }
    })
}

/// Returns the first entry: its tag, its content, and the rest.
fn entry(bytes: &[u8]) -> Option<(u16, &[u8], &[u8])> {
    let (tag, rest) = bytes.split_first_chunk()?;
    let (size, rest) = rest.split_first_chunk()?;
    let (content, rest) = rest.split_at_checked(usize::try_from(u64::from_le_bytes(*size)).ok()?)?;
    Some((u16::from_le_bytes(*tag), content, rest))
}

fn objects_in(mut list: &[u8]) -> impl Iterator<Item = &[u8]> {
    std::iter::from_fn(move || {
        let (_, content, rest) = entry(list.get(8..)?)?;
        list = rest;
        Some(content)
    })
}

fn class(object: &[u8]) -> Option<u32> {
    u32_of(part(object, &[1, 1])?)
}

fn u32_of(content: &[u8]) -> Option<u32> {
    content.try_into().ok().map(u32::from_le_bytes)
}

fn text(content: &[u8]) -> Option<String> {
    let units = content.strip_prefix(&[4])?.as_chunks().0.iter().map(|unit| u16::from_le_bytes(*unit));
    let text: String = char::decode_utf16(units).map(|unit| unit.unwrap_or('\u{fffd}')).collect();
    Some(text.trim_end_matches('\0').trim().to_owned())
}

//! Digital Surf `.sur` (MountainsMap): surfaces with 16 or 32 bits per height, plain or compressed; read
//! only.
//!
//! Format: the manual of MountainsMap, "SURF file format". A file holds one or more objects. Each starts with
//! 512 bytes, little-endian, then a comment and a private zone, then the heights, x fastest:
//!
//! ```text
//! 0   code (12)            98  bits per height i16   120 spacing of x, y, z 3 f32   334 lengths of the comment
//! 14  number of objects    100 least height i32      132 names of x, y, z 3 × 16        and the private zone 2 u16
//! 18  kind of object       108 heights along x i32   180 units of the spacing 3 × 16 466 offset of x, y, z 3 f32
//! 20  name (30)            112 heights along y i32   228 units of length 3 × 16
//! 86  1: some are missing
//! ```
//!
//! A height is `raw · spacing + offset` in the unit of the spacing. A missing one is stored as the minimum
//! minus 2. Compressed files have the code `DSCOMPRESSED`. Their heights are preceded by the number of zlib
//! streams and, for each, its unpacked and packed length (u32).

use std::io::Read;

use super::binary::{Number, Order, Raster, text};
use super::words::unit_of_length;
use super::{Decoded, Fault, ONLY_CHANNEL, Scan, cells, choose, distinct};
use asperity_base::error::Defect;
use asperity_base::grid::Field;
use asperity_base::units::Metre;

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    let fault = |defect| Fault::defect("sur", defect);
    let objects = objects(bytes).map_err(fault)?;
    let channels = distinct(objects.iter().map(|object| object.name.clone()));
    let chosen = choose(&channels, channel)?;
    let object = &objects[chosen];
    let heights = object.heights().map_err(fault)?;
    Ok(Scan::of_channel("sur", channels, chosen, object.pitch, heights))
}

const HEADER: usize = 512;

/// Returns the objects of the file, not empty; their heights are complete but not decoded.
fn objects(bytes: &[u8]) -> Result<Vec<Object<'_>>, Defect> {
    let mut objects: Vec<Object<'_>> = Vec::new();
    let mut rest = bytes;
    loop {
        let (object, behind) = Object::read(rest)?;
        let count = header_i16(bytes, 14)?;
        objects.push(object);
        rest = behind;
        if objects.len() as i64 >= i64::from(count) {
            return Ok(objects);
        }
    }
}

struct Object<'a> {
    name: String,
    shape: [usize; 2],
    number: Number,
    pitch: [Metre; 2],
    /// Height of one unit of the raw heights, m.
    height: Metre,
    offset: Metre,
    missing: Option<f64>,
    data: Data<'a>,
}

enum Data<'a> {
    Plain(&'a [u8]),
    Zlib(Vec<&'a [u8]>),
}

impl<'a> Object<'a> {
    /// Reads the first object in `bytes`; also returns the rest.
    fn read(bytes: &'a [u8]) -> Result<(Self, &'a [u8]), Defect> {
        let compressed = match bytes.get(..12) {
            Some(b"DIGITAL SURF") => false,
            Some(b"DSCOMPRESSED") => true,
            _ if bytes.len() < HEADER => return Err(length("the header", HEADER as u64, bytes.len())),
            Some(code) => {
                let found = String::from_utf8_lossy(code).into_owned();
                return Err(Defect::Value {
                    what: "the code of an object",
                    found,
                    expected: "`DIGITAL SURF`",
                });
            }
            None => return Err(Defect::Missing("header")),
        };
        let kind = header_i16(bytes, 18)?;
        if let Some(found) = not_heights(kind) {
            return Err(Defect::Value {
                what: "the kind of object",
                found,
                expected: "a surface or a profile",
            });
        }
        let bits = header_i16(bytes, 98)?;
        let number = match bits {
            16 => Number::Int16,
            32 => Number::Int32,
            _ => {
                let (what, found) = ("the number of bits per height", bits.to_string());
                return Err(Defect::Value { what, found, expected: "16 or 32" });
            }
        };
        let mut shape = [0; 2];
        for (size, (at, what)) in shape.iter_mut().zip([(108, "the size along x"), (112, "the size along y")])
        {
            let found = header_i32(bytes, at)?;
            *size = usize::try_from(found).ok().filter(|size| *size > 0).ok_or_else(|| Defect::Value {
                what,
                found: found.to_string(),
                expected: "at least 1",
            })?;
        }
        let cells = cells(&shape.map(|size| size as u64))?;
        let [x, y, z] = [180, 196, 212].map(|at| unit(bytes, at));
        let [x, y, z] = [x?, y?, z?];
        let [dx, dy, dz] = [120, 124, 128].map(|at| header_f32(bytes, at));
        let missing = header_i16(bytes, 86)? == 1;
        let name = text(&bytes[20..50]);
        let mut object = Object {
            name: if name.is_empty() { ONLY_CHANNEL.to_owned() } else { name },
            shape,
            number,
            pitch: [dx? * x, dy? * y],
            height: dz? * z,
            offset: header_f32(bytes, 474)? * z,
            missing: missing.then_some(f64::from(header_i32(bytes, 100)?) - 2.0),
            data: Data::Plain(&[]),
        };

        let comments =
            usize::from(header_i16(bytes, 334)? as u16) + usize::from(header_i16(bytes, 336)? as u16);
        let start = HEADER + comments;
        let data = bytes.get(start..).ok_or_else(|| length("the file", start as u64, bytes.len()))?;
        let needed = cells * number.bytes();
        let rest;
        (object.data, rest) = if compressed {
            streams(data)?
        } else {
            let (plain, rest) = data
                .split_at_checked(needed)
                .ok_or_else(|| length("the heights", needed as u64, data.len()))?;
            (Data::Plain(plain), rest)
        };
        Ok((object, rest))
    }

    fn heights(&self) -> Result<Field, Defect> {
        let needed = self.shape[0] * self.shape[1] * self.number.bytes();
        let unpacked;
        let raw = match &self.data {
            Data::Plain(raw) => raw,
            Data::Zlib(streams) => {
                unpacked = unpack(streams, needed)?;
                unpacked.as_slice()
            }
        };
        let raster = Raster::new(self.shape, self.number, Order::Little, raw)?;
        let is_missing = |raw| self.missing == Some(raw);
        Ok(raster.heights(|raw| if is_missing(raw) { f64::NAN } else { raw * self.height + self.offset }))
    }
}

/// Reads the zlib streams at the start of `bytes`; also returns the rest.
fn streams(bytes: &[u8]) -> Result<(Data<'_>, &[u8]), Defect> {
    let word = |at: usize| {
        let word = bytes.get(at..at + 4).and_then(|word| word.first_chunk());
        word.map(|word| u32::from_le_bytes(*word))
            .ok_or_else(|| length("the directory", at as u64 + 4, bytes.len()))
    };
    let count = word(0)? as usize;
    let start = 4 + 8 * count as u64;
    if start > bytes.len() as u64 {
        return Err(length("the directory", start, bytes.len()));
    }
    let mut rest = &bytes[start as usize..];
    let mut streams = Vec::with_capacity(count);
    for stream in 0..count {
        let packed = word(4 + 8 * stream + 4)? as usize;
        let stream;
        (stream, rest) = rest
            .split_at_checked(packed)
            .ok_or_else(|| length("a zlib stream", packed as u64, rest.len()))?;
        streams.push(stream);
    }
    Ok((Data::Zlib(streams), rest))
}

fn unpack(streams: &[&[u8]], needed: usize) -> Result<Vec<u8>, Defect> {
    let mut heights = Vec::new();
    for stream in streams {
        let most = (needed + 1).saturating_sub(heights.len()) as u64;
        let result = flate2::read::ZlibDecoder::new(*stream).take(most).read_to_end(&mut heights);
        result.map_err(|error| Defect::Container(format!("zlib: {error}")))?;
    }
    if heights.len() == needed {
        Ok(heights)
    } else {
        Err(length("the heights", needed as u64, heights.len()))
    }
}

/// Describes an object that contains no heights on a grid.
fn not_heights(kind: i16) -> Option<String> {
    let name = match kind {
        // Profile, surface, series of surfaces, surface of several layers, surface with an intensity image.
        1 | 2 | 5 | 8 | 11 => return None,
        3 => "binary image",
        4 => "series of profiles",
        6 => "meridian disc",
        7 => "profile of several layers",
        9 => "parallel disc",
        10 => "intensity image",
        12 => "RGB image",
        _ => return Some(format!("unknown ({kind})")),
    };
    Some(name.to_owned())
}

fn unit(bytes: &[u8], at: usize) -> Result<Metre, Defect> {
    unit_of_length(&text(field::<16>(bytes, at)?))
}

fn field<const N: usize>(bytes: &[u8], at: usize) -> Result<&[u8; N], Defect> {
    let header = bytes.get(..HEADER).ok_or_else(|| length("the header", HEADER as u64, bytes.len()))?;
    Ok(header[at..].first_chunk().expect("fields lie within the header"))
}

fn header_i16(bytes: &[u8], at: usize) -> Result<i16, Defect> {
    field(bytes, at).map(|field| i16::from_le_bytes(*field))
}

fn header_i32(bytes: &[u8], at: usize) -> Result<i32, Defect> {
    field(bytes, at).map(|field| i32::from_le_bytes(*field))
}

fn header_f32(bytes: &[u8], at: usize) -> Result<f64, Defect> {
    field(bytes, at).map(|field| f64::from(f32::from_le_bytes(*field)))
}

fn length(what: &'static str, expected: u64, found: usize) -> Defect {
    Defect::Length { what, expected, found: found as u64 }
}

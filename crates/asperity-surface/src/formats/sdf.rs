//! SDF, the surface data file of ISO 25178-71, and earlier of BCR's report EUR 15178.
//!
//! The file has a header, the heights with x fastest, and a trailer of text. The first byte is the kind: `a`
//! text, `b` binary, little-endian. The version follows: `ISO-1.0`, `ISO-2.0`, `BCR-1.0`, `NIST-1.0`. A
//! height is a number times `Zscale`, in metres.
//!
//! ```text
//! 0   version (8)             ManufacID (10)  CreateDate (12)  ModDate (12)
//! 42  NumPoints, NumProfiles  2 u16; in ISO-2.0 2 u32
//!     Xscale, Yscale, Zscale, Zresolution  4 f64
//!     Compression, DataType, CheckType     3 u8
//! ```
//!
//! Data types are 0, 1, 2 for unsigned and 4, 5, 6 for signed integers of 8, 16, 32 bits, and 3 and 7 for
//! floating point of 32 and 64 bits; in text also a word such as `INTEGER`. In text each record is a line
//! `name = value`, a semicolon begins a comment, and a line with an asterisk ends each part. The first byte
//! may be a capital in BCR files.
//!
//! | version | missing height, binary | in text | first profile |
//! |---|---|---|---|
//! | ISO | smallest value of the type | `BAD`, or the same number | at y = 0 |
//! | BCR | largest value of the type, of floating point from 3.4e38 or 1.7e308 | the same number | at the largest y |
//! | NIST | smallest signed or largest unsigned integer | `BAD` | at y = 0 |
//!
//! NaN and `BAD` are missing in every version.

use std::path::Path;

use ndarray::Axis;

use super::binary::{Cursor, Number, Order, Raster, shape};
use super::header::{Header, before_comment};
use super::words::excerpt;
use super::{Decoded, finite, only, x_fastest};
use asperity_base::error::{Defect, Result};
use asperity_base::grid::{Field, Grid};
use asperity_base::io::atomic;

/// Writes `heights` on `grid` to `path` in binary, as float64, atomically. NaN becomes the marker of the
/// standard.
///
/// The version is `ISO-1.0` for sizes up to 65535, and `ISO-2.0` beyond.
///
/// # Errors
/// [`Error::File`](asperity_base::Error::File).
///
/// # Panics
/// If the shape of `heights` differs from that of `grid`.
pub(super) fn write(path: &Path, grid: &Grid, heights: &Field) -> Result<()> {
    assert_eq!(heights.shape(), grid.shape, "heights must be on the grid");
    let [nx, ny] = grid.shape;
    atomic::write_with(path, |file| {
        match (u16::try_from(nx), u16::try_from(ny)) {
            (Ok(nx), Ok(ny)) => {
                file.write_all(b"bISO-1.0asperity  010119700000010119700000")?;
                file.write_all(&[nx.to_le_bytes(), ny.to_le_bytes()].concat())?;
            }
            _ => {
                file.write_all(b"bISO-2.0asperity  010119700000010119700000")?;
                file.write_all(&[(nx as u32).to_le_bytes(), (ny as u32).to_le_bytes()].concat())?;
            }
        }
        for scale in [grid.pitch[0], grid.pitch[1], 1.0, -1.0] {
            file.write_all(&scale.to_le_bytes())?;
        }
        file.write_all(&[0, 7, 0])?;
        for height in heights.t() {
            let number = if height.is_nan() { f64::MIN } else { *height };
            file.write_all(&number.to_le_bytes())?;
        }
        Ok(())
    })
}

/// Possible first bytes of the file.
pub(super) const MAGICS: [&[u8]; 12] = [
    b"aISO-1.0",
    b"bISO-1.0",
    b"aISO-2.0",
    b"bISO-2.0",
    b"aBCR-1.0",
    b"bBCR-1.0",
    b"ABCR-1.0",
    b"BBCR-1.0",
    b"aBCR-0.0",
    b"bBCR-0.0",
    b"aNIST-1.",
    b"bNIST-1.",
];

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    only("sdf", channel, || {
        let (pitch, mut heights) =
            if bytes[0].eq_ignore_ascii_case(&b'a') { in_text(bytes) } else { in_binary(bytes) }?;
        if Version::of(bytes) == Version::Bcr {
            heights.invert_axis(Axis(1));
        }
        Ok((pitch, heights.as_standard_layout().into_owned()))
    })
}

type Outcome<T> = std::result::Result<T, Defect>;

/// Version of the format: it determines the marker of missing heights and the order of profiles.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Version {
    Iso,
    Bcr,
    Nist,
}

impl Version {
    fn of(bytes: &[u8]) -> Self {
        match bytes[1] {
            b'I' => Self::Iso,
            b'B' => Self::Bcr,
            _ => Self::Nist,
        }
    }

    /// Whether `number`, stored as `kind`, marks a missing height.
    fn is_missing(self, kind: Number, number: f64) -> bool {
        let [smallest, largest] = match kind {
            Number::Uint8 => [0.0, 255.0],
            Number::Uint16 => [0.0, 65_535.0],
            Number::Uint32 => [0.0, 4_294_967_295.0],
            Number::Int8 => [-128.0, 127.0],
            Number::Int16 => [-32_768.0, 32_767.0],
            Number::Int32 => [-2_147_483_648.0, 2_147_483_647.0],
            // Programs write the largest numbers with few digits.
            Number::Float32 => [-f64::from(3.4e38_f32), f64::from(3.4e38_f32)],
            _ => [-1.7e308, 1.7e308],
        };
        match self {
            Self::Iso => number <= smallest,
            Self::Bcr => number >= largest,
            Self::Nist => {
                if smallest == 0.0 {
                    number >= largest
                } else {
                    number <= smallest
                }
            }
        }
    }
}

const LINE: usize = 42;

fn in_binary(bytes: &[u8]) -> Outcome<([f64; 2], Field)> {
    let mut header = Cursor::new(bytes, Order::Little, "the file");
    header.take(LINE)?;
    let shape = if bytes.starts_with(b"bISO-2.0") {
        shape([header.u32()?, header.u32()?])?
    } else {
        shape([header.u16()?, header.u16()?])?
    };
    let [dx, dy, dz, _resolution] = [header.f64()?, header.f64()?, header.f64()?, header.f64()?];
    let [compression, kind, _check] = [header.u8()?, header.u8()?, header.u8()?];
    let number = vet(&compression.to_string(), &kind.to_string(), dz)?;

    // One manufacturer adds 8 undocumented bytes to the header.
    let size = shape[0] * shape[1] * number.bytes();
    let rest = header.rest();
    let data = if rest.len() == size + 8 && bytes.starts_with(b"bISO-1.0") { &rest[8..] } else { rest };
    let version = Version::of(bytes);
    let raster = Raster::new(shape, number, Order::Little, data)?;
    let height = |stored| if version.is_missing(number, stored) { f64::NAN } else { stored * dz };
    Ok(([dx, dy], raster.heights(height)))
}

fn in_text(bytes: &[u8]) -> Outcome<([f64; 2], Field)> {
    // Lines end with CR LF, LF or CR.
    let text = String::from_utf8_lossy(bytes).replace("\r\n", "\n").replace('\r', "\n");
    let ends_part = |line: &str| before_comment(line) == "*";
    let parts: Vec<&str> = text.split_inclusive('\n').collect();
    let end = parts.iter().position(|line| ends_part(line));
    let end = end.ok_or(Defect::Missing("asterisk that ends the header"))?;
    let header_text = parts[..end].concat();
    let header = Header::new(&header_text, '=');
    let shape = shape([header.size("NumPoints")?, header.size("NumProfiles")?])?;
    let dz = header.number("Zscale")?;
    let kind = vet(header.get("Compression").unwrap_or("0"), header.get("DataType").unwrap_or("7"), dz)?;
    let version = Version::of(bytes);

    let mut heights = Vec::new();
    let lines = parts[end + 1..].iter().take_while(|line| !ends_part(line));
    for (index, line) in lines.enumerate() {
        for token in before_comment(line).split_ascii_whitespace() {
            let number =
                if token.eq_ignore_ascii_case("bad") { Some(f64::NAN) } else { token.parse::<f64>().ok() };
            let number =
                number.ok_or_else(|| Defect::NotANumber { line: end + 2 + index, token: excerpt(token) })?;
            heights.push(if version.is_missing(kind, number) { f64::NAN } else { finite(number * dz) });
        }
    }
    if heights.len() != shape[0] * shape[1] {
        let found = heights.len().to_string();
        let expected = "NumPoints · NumProfiles";
        return Err(Defect::Value { what: "the number of heights", found, expected });
    }
    let heights = x_fastest(shape, |first, part| part.copy_from_slice(&heights[first..first + part.len()]));
    Ok(([header.number("Xscale")?, header.number("Yscale")?], heights))
}

/// Returns the kind of number, if heights with these header entries can be read.
fn vet(compression: &str, kind: &str, dz: f64) -> Outcome<Number> {
    if !["0", "none", "null"].contains(&compression.to_ascii_lowercase().as_str()) {
        let found = compression.to_owned();
        return Err(Defect::Value { what: "Compression", found, expected: "0, none" });
    }
    if !dz.is_finite() || dz == 0.0 {
        return Err(Defect::Value { what: "Zscale", found: dz.to_string(), expected: "a length in metres" });
    }
    Ok(match kind.to_ascii_lowercase().as_str() {
        "0" | "uint8" | "uchar" => Number::Uint8,
        "1" | "uint16" | "uinteger" => Number::Uint16,
        "2" | "uint32" | "ulongint" => Number::Uint32,
        "3" | "binary32" | "real32" | "float32" | "float" => Number::Float32,
        "4" | "int8" | "char" => Number::Int8,
        "5" | "int16" | "integer" => Number::Int16,
        "6" | "int32" | "longint" => Number::Int32,
        "7" | "binary64" | "real64" | "float64" | "double" => Number::Float64,
        _ => {
            let expected = "0 to 7, or the name of a type";
            return Err(Defect::Value { what: "DataType", found: excerpt(kind), expected });
        }
    })
}

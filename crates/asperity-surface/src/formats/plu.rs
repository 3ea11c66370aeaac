//! PLU: confocal microscopes and interferometers of Sensofar; read only.
//!
//! The format has no signature, but begins with a date as printed by the C library. Little-endian:
//!
//! ```text
//! 0    date (128)          388  calibration: sizes along y and x, a number, a scale, pitch along x and y in µm (f32)
//! 128  time u32            428  kind of measurement u32: 3 is a topography
//! 132  comment (256)       500  sizes along y and x 2 u32, heights in µm f32, x fastest; then pictures, further layers
//! ```
//!
//! A missing height is 1000001. Only the first of several layers is read.

use super::binary::{Cursor, Number, Order, Raster, shape};
use super::{Decoded, only};
use asperity_base::error::Defect;
use asperity_base::grid::Field;

/// Whether the content begins with a date such as `Fri Mar 10 16:35:59 2023`, and a zero.
pub(super) fn is_one(bytes: &[u8]) -> bool {
    let is = |form: u8, byte: u8| match form {
        b'A' => byte.is_ascii_alphabetic(),
        b'0' => byte.is_ascii_digit() || byte == b' ',
        _ => byte == form,
    };
    let form = b"AAA AAA 00 00:00:00 0000\0";
    bytes.len() >= form.len() && form.iter().zip(bytes).all(|(form, byte)| is(*form, *byte))
}

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    only("plu", channel, || heights(bytes))
}

const MICROMETRE: f64 = 1e-6;

fn heights(bytes: &[u8]) -> Result<([f64; 2], Field), Defect> {
    let mut file = Cursor::new(bytes, Order::Little, "the file");
    file.seek(404)?;
    let pitch = [file.f32()? * MICROMETRE, file.f32()? * MICROMETRE];
    file.seek(428)?;
    let kind = file.u32()?;
    if kind != 3 {
        let found = kind.to_string();
        return Err(Defect::Value { what: "the kind of measurement", found, expected: "3, a topography" });
    }
    file.seek(500)?;
    let [ny, nx] = [file.u32()?, file.u32()?];
    let raster = Raster::new(shape([nx, ny])?, Number::Float32, Order::Little, file.rest())?;
    Ok((pitch, raster.heights(|height| if height == 1_000_001.0 { f64::NAN } else { height * MICROMETRE })))
}

//! AL3D: focus variation microscopes of Alicona; read only.
//!
//! The file starts with `AliconaImaging`, a zero, CR LF, then tags of 52 bytes: name (20), value as text
//! (30), CR LF. The second tag, `TagCount`, is the number of the following ones. The heights are at
//! `DepthImageOffset`: `Rows` of `Cols` f32, little-endian, in metres, each row padded to a multiple of 8
//! bytes. Heights equal to `InvalidPixelValue` are missing. The pitch is `PixelSizeXMeter`,
//! `PixelSizeYMeter`.

use std::collections::HashMap;
use std::str::FromStr;

use super::binary::{Cursor, Number, Order, Raster, shape, text};
use super::{Decoded, only};
use asperity_base::error::Defect;
use asperity_base::grid::Field;

/// First bytes of the file.
pub(super) const MAGIC: &[u8] = b"AliconaImaging\0\r\n";

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    only("al3d", channel, || heights(bytes))
}

fn heights(bytes: &[u8]) -> Result<([f64; 2], Field), Defect> {
    let mut file = Cursor::new(bytes, Order::Little, "the file");
    file.take(MAGIC.len())?;
    let mut tags = HashMap::new();
    let (version, count) = (tag(&mut file)?, tag(&mut file)?);
    tags.extend([version, count]);
    for _ in 0..value::<u32>(&tags, "TagCount")? {
        tags.extend([tag(&mut file)?]);
    }

    let shape = shape([value::<u32>(&tags, "Cols")?, value::<u32>(&tags, "Rows")?])?;
    file.seek(value(&tags, "DepthImageOffset")?)?;
    let width = shape[0].next_multiple_of(2);
    let padded = Raster::new([width, shape[1]], Number::Float32, Order::Little, file.rest())?;
    let invalid: f64 = value(&tags, "InvalidPixelValue").unwrap_or(f64::NAN);
    // The value is printed as text, so that heights may differ from it by rounding.
    let is_missing = |height: f64| (height - invalid).abs() <= 1e-6 * invalid.abs();
    let heights = padded.heights(|height| if is_missing(height) { f64::NAN } else { height });
    let heights = heights.slice_move(ndarray::s![..shape[0], ..]);
    Ok(([value(&tags, "PixelSizeXMeter")?, value(&tags, "PixelSizeYMeter")?], heights))
}

fn tag(file: &mut Cursor<'_>) -> Result<(String, String), Defect> {
    let (name, value) = (text(file.take(20)?), text(file.take(30)?));
    file.take(2)?;
    Ok((name, value))
}

fn value<T: FromStr>(tags: &HashMap<String, String>, name: &'static str) -> Result<T, Defect> {
    let found = tags.get(name).ok_or(Defect::Missing(name))?;
    found.parse().map_err(|_| Defect::Value { what: name, found: found.clone(), expected: "a number" })
}

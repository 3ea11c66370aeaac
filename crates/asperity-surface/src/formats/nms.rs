//! NMS: confocal microscopes of NanoFocus (µsurf); read only.
//!
//! Little-endian; recognised by `OM_MS_` at 32.
//!
//! ```text
//! 16    smallest and largest height in µm 2 f64     1368  sizes along x and y 2 u32, steps along x and y in nm 2 f64
//! 3468  heights u16, x fastest, 0 the smallest, 65534 the largest; then an image
//! ```

use super::binary::{Cursor, Number, Order, Raster, shape};
use super::{Decoded, only};
use asperity_base::error::Defect;
use asperity_base::grid::Field;

/// Whether the content has this mark.
pub(super) fn is_one(bytes: &[u8]) -> bool {
    bytes.get(32..).is_some_and(|bytes| bytes.starts_with(b"OM_MS_"))
}

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    only("nms", channel, || heights(bytes))
}

fn heights(bytes: &[u8]) -> Result<([f64; 2], Field), Defect> {
    const MICROMETRE: f64 = 1e-6;
    const NANOMETRE: f64 = 1e-9;
    let mut file = Cursor::new(bytes, Order::Little, "the file");
    file.seek(16)?;
    let [least, largest] = [file.f64()?, file.f64()?];
    file.seek(1368)?;
    let shape = shape([file.u32()?, file.u32()?])?;
    let pitch = [file.f64()? * NANOMETRE, file.f64()? * NANOMETRE];
    file.seek(3468)?;
    let raster = Raster::new(shape, Number::Uint16, Order::Little, file.rest())?;
    let height = |number: f64| number / 65_534.0 * (largest - least) + least;
    Ok((pitch, raster.heights(|number| height(number) * MICROMETRE)))
}

//! TMD: TrueMap and TrueGage; read only.
//!
//! Little-endian. `Binary TrueMap Data File v2.0`, CR LF and a zero, a comment with a final zero, the sizes
//! along x and y (2 i32), the lengths and offsets along x and y (4 f32), and the heights (f32, x fastest).
//! Lengths are in mm.

use super::binary::{Cursor, Number, Order, Raster, shape};
use super::{Decoded, only};
use asperity_base::error::Defect;
use asperity_base::grid::Field;

/// First bytes of the file.
pub(super) const MAGIC: &[u8] = b"Binary TrueMap Data File v2.0\r\n\0";

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    only("tmd", channel, || heights(bytes))
}

const MILLIMETRE: f64 = 1e-3;

fn heights(bytes: &[u8]) -> Result<([f64; 2], Field), Defect> {
    let mut file = Cursor::new(bytes, Order::Little, "the file");
    file.take(MAGIC.len())?;
    file.until_zero()?;
    let shape = shape([file.i32()?, file.i32()?])?;
    let [x, y, _, _] = [file.f32()?, file.f32()?, file.f32()?, file.f32()?];
    let raster = Raster::new(shape, Number::Float32, Order::Little, file.rest())?;
    let pitch = [x * MILLIMETRE / shape[0] as f64, y * MILLIMETRE / shape[1] as f64];
    Ok((pitch, raster.heights(|height| height * MILLIMETRE)))
}

//! MetroPro `.dat`: interferometers of Zygo; read only.
//!
//! Format: "MetroPro Reference Guide" (OMP-0347), binary data format. Big-endian. The header has 834 or 4096
//! bytes:
//!
//! ```text
//! 6   bytes of the header i32      72  bytes of the phases i32              180 magnification f32
//! 60  bytes of the intensities i32 164 scale S f32, wavelength λ (m) f32    184 pitch (m) f32
//! 68  sizes along x and y 2 u16    176 obliquity O f32                      218 resolution R i16: 0, 1, 2
//! ```
//!
//! The intensities follow, then the phases, i32, x fastest. A height is phase · S λ O / R with R = 4096,
//! 32768 or 131072 for 0, 1, 2. It is missing if the phase is 2147483640 or more.

use super::binary::{Cursor, Number, Order, Raster, shape};
use super::{Decoded, only};
use asperity_base::error::Defect;
use asperity_base::grid::Field;

/// Possible first bytes of the file.
pub(super) const MAGICS: [&[u8]; 3] = [b"\x88\x1b\x03\x6f", b"\x88\x1b\x03\x70", b"\x88\x1b\x03\x71"];

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    only("metropro", channel, || heights(bytes))
}

fn heights(bytes: &[u8]) -> Result<([f64; 2], Field), Defect> {
    let file = |at| {
        let mut file = Cursor::new(bytes, Order::Big, "the file");
        file.seek(at).map(|()| file)
    };
    let (header, intensities) = (file(6)?.u32()?, file(60)?.u32()?);
    let mut sizes = file(68)?;
    let [nx, ny] = [sizes.u16()?, sizes.u16()?];
    let mut optics = file(164)?;
    let [scale, wavelength, _, obliquity] = [optics.f32()?, optics.f32()?, optics.f32()?, optics.f32()?];
    let resolution = match file(218)?.u16()? {
        0 => 4096.0,
        1 => 32_768.0,
        2 => 131_072.0,
        other => {
            let found = other.to_string();
            return Err(Defect::Value { what: "the resolution", found, expected: "0, 1 or 2" });
        }
    };
    let pitch = file(184)?.f32()?;

    let data = file((header as usize).saturating_add(intensities as usize))?;
    let raster = Raster::new(shape([nx, ny])?, Number::Int32, Order::Big, data.rest())?;
    let unit = scale * wavelength * obliquity / resolution;
    Ok(([pitch; 2], raster.heights(|phase| if phase >= 2_147_483_640.0 { f64::NAN } else { phase * unit })))
}

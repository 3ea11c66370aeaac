//! BCR-STM and BCRF: SPIP and other scanning probe software; read only.
//!
//! The header has 2048 characters in ASCII, or in UTF-16 (`_unicode` in the first line), with lines
//! `name = value`. The heights follow, x fastest: i16 (`bcrstm`) or f32 (`bcrf`), little-endian unless
//! `intelmode = 0`. A height is a number times `bit2nm` in `zunit`. Lengths are in `xunit` and `yunit`;
//! without a unit they are in nm. 32767, or a float beyond 10³⁸, is a missing height.

use super::binary::{Cursor, Number, Order, Raster, shape};
use super::header::Header;
use super::words::unit_of_length;
use super::{Decoded, only};
use asperity_base::error::Defect;
use asperity_base::grid::Field;

/// Possible first bytes of the file.
pub(super) const MAGICS: [&[u8]; 2] =
    [b"fileformat = bcr", b"f\0i\0l\0e\0f\0o\0r\0m\0a\0t\0 \0=\0 \0b\0c\0r\0"];

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    only("bcr", channel, || heights(bytes))
}

fn heights(bytes: &[u8]) -> Result<([f64; 2], Field), Defect> {
    const CHARACTERS: usize = 2048;
    let mut file = Cursor::new(bytes, Order::Little, "the file");
    let text: String = if bytes.starts_with(b"fileformat") {
        file.take(CHARACTERS)?.iter().map(|byte| char::from(*byte)).collect()
    } else {
        let header = file.take(2 * CHARACTERS)?;
        let units = header.as_chunks().0.iter().map(|unit| u16::from_le_bytes(*unit));
        char::decode_utf16(units).map(|character| character.unwrap_or('\u{fffd}')).collect()
    };
    let header = Header::new(&text, '=');
    if let Some(current @ "1") = header.get("current") {
        let found = current.to_owned();
        return Err(Defect::Value { what: "current", found, expected: "0: heights" });
    }
    let unit = |name| header.get(name).map_or(Ok(1e-9), unit_of_length);
    let (number, missing) = match header.get("fileformat") {
        Some("bcrstm" | "bcrstm_unicode") => (Number::Int16, 32_767.0),
        Some("bcrf" | "bcrf_unicode") => (Number::Float32, 1e38),
        other => {
            let found = other.unwrap_or_default().to_owned();
            return Err(Defect::Value { what: "fileformat", found, expected: "bcrstm or bcrf" });
        }
    };
    let order = if header.get("intelmode") == Some("0") { Order::Big } else { Order::Little };
    let [nx, ny] = [header.size("xpixels")?, header.size("ypixels")?];
    let raster = Raster::new(shape([nx, ny])?, number, order, file.rest())?;
    let scale = match header.get("bit2nm") {
        None if !number.is_integer() => 1.0,
        _ => header.number("bit2nm")?,
    };
    let height = scale * unit("zunit")?;
    let pitch = [
        header.number("xlength")? * unit("xunit")? / f64::from(nx),
        header.number("ylength")? * unit("yunit")? / f64::from(ny),
    ];
    let is_missing = |stored: f64| stored >= missing || !number.is_integer() && stored <= -missing;
    Ok((pitch, raster.heights(|stored| if is_missing(stored) { f64::NAN } else { stored * height })))
}

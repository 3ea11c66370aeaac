//! WSxM `.stp`, `.top`: scanning probe microscopy; read only.
//!
//! `WSxM file copyright`, `SxM Image file`, `Image header size: 4607`, then parts with lines `name: value`.
//! After a header of that size come the heights, little-endian, x fastest. The image is upside down and
//! mirrored: from the last y and the last x to the first.
//!
//! ```text
//! [Control]        X Amplitude: 600 nm      Y Amplitude: 600 nm
//! [General Info]   Number of columns: 256   Number of rows: 256   Image Data Type: short   Z Amplitude: 18.9 nm
//! [Miscellaneous]  Maximum: 6900            Minimum: 5927
//! ```
//!
//! `double` and `float` are heights in the unit of the amplitude. Integers (`short`) are scaled so that the
//! range from minimum to maximum is the amplitude.

use super::binary::{Cursor, Number, Order, Raster, shape, text};
use super::header::{Header, sections};
use super::words::{excerpt, unit_of_length};
use super::{Decoded, only};
use asperity_base::error::Defect;
use asperity_base::grid::Field;

/// First bytes of the file.
pub(super) const MAGIC: &[u8] = b"WSxM file copyright";

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    only("wsxm", channel, || heights(bytes))
}

fn heights(bytes: &[u8]) -> Result<([f64; 2], Field), Defect> {
    let start = start_of_data(bytes)?;
    let mut file = Cursor::new(bytes, Order::Little, "the file");
    let header = text(file.take(start)?);
    let parts = sections(&header);
    let part = |name| {
        let part = parts.iter().find(|(other, _)| *other == name).map_or("", |(_, part)| part);
        Header::new(part, ':')
    };
    let [general, control, range] = ["General Info", "Control", "Miscellaneous"].map(part);

    let [nx, ny] = [general.size("Number of columns")?, general.size("Number of rows")?];
    let kind = general.get("Image Data Type").unwrap_or("short");
    let number = match kind {
        "short" | "integer" => Number::Int16,
        "float" => Number::Float32,
        "double" => Number::Float64,
        _ => {
            let (found, expected) = (excerpt(kind), "short, float or double");
            return Err(Defect::Value { what: "Image Data Type", found, expected });
        }
    };
    let raster = Raster::new(shape([nx, ny])?, number, Order::Little, file.rest())?;
    let (amplitude, unit) = general.quantity("Z Amplitude")?;
    let unit = unit_of_length(unit)?;
    let scale = if number.is_integer() {
        match range.number("Maximum")? - range.number("Minimum")? {
            0.0 => 0.0,
            difference => amplitude / difference * unit,
        }
    } else {
        unit
    };
    let mut heights = raster.heights(|number| number * scale);
    heights.as_slice_mut().expect("heights are in standard layout").reverse();
    let x = control.length("X Amplitude")?;
    let y = if control.get("Y Amplitude").is_some() { control.length("Y Amplitude")? } else { x };
    Ok(([x / f64::from(nx), y / f64::from(ny)], heights))
}

/// Returns the header size in the third line.
fn start_of_data(bytes: &[u8]) -> Result<usize, Defect> {
    let mut lines = bytes.splitn(4, |byte| *byte == b'\n').map(text);
    let kind = lines.nth(1).unwrap_or_default();
    if kind != "SxM Image file" {
        let found = excerpt(&kind);
        return Err(Defect::Value { what: "the kind of file", found, expected: "SxM Image file" });
    }
    let line = lines.next().unwrap_or_default();
    let size = line.strip_prefix("Image header size:").and_then(|size| size.trim().parse().ok());
    size.ok_or(Defect::Missing("Image header size in line 3"))
}

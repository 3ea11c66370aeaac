//! MI: atomic force microscopes of Molecular Imaging, later Agilent and Keysight (PicoView); read only.
//!
//! The header has lines of a name of 14 characters and a value, from `fileType` to `data`. The numbers of all
//! channels follow without gaps, little-endian, x fastest, from the last y to the first. `bufferLabel` begins
//! a channel:
//!
//! ```text
//! xPixels       256          bufferLabel   Topography
//! xLength       2e-005       bufferUnit    um
//! data          BINARY_32    bufferRange   1.7
//! ```
//!
//! Lengths along x and y are in metres. Numbers are i16 (`BINARY`) or i32 (`BINARY_32`). The first number
//! beyond the largest represents `bufferRange`.

use super::binary::{Number, Order, Raster, shape, text};
use super::header::Header;
use super::words::{excerpt, unit_of_length};
use super::{Channel, Decoded, LengthUnit, from_last_y_to_first, several};
use asperity_base::error::Defect;

/// First bytes of the file.
pub(super) const MAGIC: &[u8] = b"fileType      ";

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    several("mi", channel, channels(bytes))
}

fn channels(bytes: &[u8]) -> Result<Vec<Channel<'_>>, Defect> {
    const NAME: usize = 14;
    // Lines `name: value`: a part for the file and one for each channel.
    let mut parts = vec![String::new()];
    let mut rest = bytes;
    let kind = loop {
        let end = rest.iter().position(|byte| *byte == b'\n').ok_or(Defect::Missing("line of the data"))?;
        let (line, behind) = (text(&rest[..end]), &rest[end + 1..]);
        rest = behind;
        let split = line.char_indices().nth(NAME).map_or(line.len(), |(at, _)| at);
        let (name, value) = (line[..split].trim(), line[split..].trim());
        match name {
            "data" => break value.to_owned(),
            "bufferLabel" => parts.push(String::new()),
            _ => {}
        }
        let part = parts.last_mut().expect("there is the first");
        *part += &format!("{name}: {value}\n");
    };
    let (file, buffers) = parts.split_first().expect("there is the first");
    let file = Header::new(file, ':');
    if let Some(found) = file.get("fileType").filter(|kind| *kind != "Image") {
        return Err(Defect::Value { what: "fileType", found: excerpt(found), expected: "Image" });
    }
    let (number, largest) = match kind.as_str() {
        "BINARY" | "" => (Number::Int16, 32_768.0),
        "BINARY_32" => (Number::Int32, 2_147_483_648.0),
        _ => {
            let found = excerpt(&kind);
            return Err(Defect::Value { what: "data", found, expected: "BINARY or BINARY_32" });
        }
    };
    let shape = shape([file.size("xPixels")?, file.size("yPixels")?])?;
    let pitch = [file.number("xLength")? / shape[0] as f64, file.number("yLength")? / shape[1] as f64];

    let mut channels = Vec::new();
    for buffer in buffers {
        let raster = Raster::new(shape, number, Order::Little, rest)?;
        rest = &rest[raster.bytes()..];
        let buffer = Header::new(buffer, ':');
        let Ok(unit) = unit_of_length(buffer.get("bufferUnit").unwrap_or_default()) else { continue };
        let step = buffer.number("bufferRange")? / largest * unit;
        channels.push(Channel {
            name: buffer.get("bufferLabel").unwrap_or_default().to_owned(),
            pitch,
            unit: LengthUnit::Known,
            heights: Box::new(move || {
                let mut heights = raster.heights(|number| number * step);
                from_last_y_to_first(&mut heights);
                Ok(heights)
            }),
        });
    }
    Ok(channels)
}

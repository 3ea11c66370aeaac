//! VK3, VK4, VK6, VK7: confocal microscopes of Keyence; read only.
//!
//! VK6 and VK7 are a preamble and a zip archive, whose entry `Vk4File` is a VK4. Little-endian, in u32:
//!
//! ```text
//! 0   VK4_, version, 0    12  places of the parts: 17, in VK4 18; the seventh to ninth are heights (0: none)
//! then the conditions; the 43rd to 45th are the steps along x, along y and of the heights in pm
//! heights: sizes along x and y, bits (8, 16, 32), compression, bytes, 2 more, a palette of 768 bytes, numbers, x fastest
//! ```

#[cfg(feature = "zip")]
use std::io::Cursor as File;

use super::binary::{Cursor, Number, Order, Raster, shape};
use super::{Channel, Decoded, Fault, LengthUnit, ONLY_CHANNEL, several};
#[cfg(feature = "zip")]
use super::{
    MAX_UNPACKED,
    x3p::{Archive, entry},
};
use asperity_base::error::Defect;

/// Possible first bytes of the file.
pub(super) const MAGICS: [&[u8]; 4] = [b"VK3_", b"VK4_", b"VK6", b"VK7"];

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    if bytes.starts_with(b"VK3_") || bytes.starts_with(b"VK4_") {
        return several("vk", channel, channels(bytes));
    }
    let unpacked = unpacked(bytes).map_err(|defect| Fault::defect("vk", defect))?;
    several("vk", channel, channels(&unpacked))
}

#[cfg(not(feature = "zip"))]
fn unpacked(_: &[u8]) -> Result<Vec<u8>, Defect> {
    Err(Defect::Container("it is a zip archive, and the feature `zip` is left out".to_owned()))
}

#[cfg(feature = "zip")]
fn unpacked(bytes: &[u8]) -> Result<Vec<u8>, Defect> {
    let archive = Archive::new(File::new(bytes));
    let mut archive = archive.map_err(|error| Defect::Container(error.to_string()))?;
    let unpacked = entry(&mut archive, "Vk4File", "Vk4File in the archive", MAX_UNPACKED)?;
    match unpacked.len() as u64 {
        found if found > MAX_UNPACKED => {
            Err(Defect::Length { what: "the unpacked file", expected: MAX_UNPACKED, found })
        }
        _ if MAGICS[..2].iter().any(|magic| unpacked.starts_with(magic)) => Ok(unpacked),
        _ => Err(Defect::Missing("VK4_ at the start of Vk4File")),
    }
}

fn channels(bytes: &[u8]) -> Result<Vec<Channel<'_>>, Defect> {
    const PICOMETRE: f64 = 1e-12;
    let mut file = Cursor::new(bytes, Order::Little, "the file");
    file.seek(12)?;
    let mut places = [0; 18];
    let places = &mut places[..if bytes.starts_with(b"VK4_") { 18 } else { 17 }];
    for place in &mut *places {
        *place = file.u32()? as usize;
    }
    file.take(42 * 4)?;
    let [x, y, z] = [file.u32()?, file.u32()?, file.u32()?].map(|step| f64::from(step) * PICOMETRE);

    let mut channels = Vec::new();
    for (index, place) in places[6..9].iter().enumerate().filter(|(_, place)| **place != 0) {
        file.seek(*place)?;
        let shape = shape([file.u32()?, file.u32()?])?;
        let bits = file.u32()?;
        let number = match bits {
            8 => Number::Uint8,
            16 => Number::Uint16,
            32 => Number::Uint32,
            _ => {
                let (found, expected) = (bits.to_string(), "8, 16 or 32");
                return Err(Defect::Value { what: "the bits of a height", found, expected });
            }
        };
        let [_compression, bytes, _, _] = [file.u32()?, file.u32()?, file.u32()?, file.u32()?];
        let expected = (shape[0] * shape[1] * number.bytes()) as u64;
        if u64::from(bytes) != expected {
            return Err(Defect::Length { what: "the heights", expected, found: bytes.into() });
        }
        file.take(768)?;
        let raster = Raster::new(shape, number, Order::Little, file.rest())?;
        channels.push(Channel {
            name: if index == 0 { ONLY_CHANNEL.to_owned() } else { format!("{ONLY_CHANNEL} {}", index + 1) },
            pitch: [x, y],
            unit: LengthUnit::Known,
            heights: Box::new(move || Ok(raster.heights(|number| number * z))),
        });
    }
    Ok(channels)
}

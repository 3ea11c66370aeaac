//! OPD: interferometers of Wyko, later Veeco and Bruker; read only.
//!
//! Little-endian. Two bytes, then a directory of entries of 24 bytes: name (16), type i16, size i32, flags u16. The first
//! entry is the directory itself, and the blocks of the others follow in order. An array (type 3) has the sizes along x and
//! y and the bytes per element (3 u16), then its elements, y fastest and from the last y to the first. Heights are in
//! wavelengths (`Wavelength`, nm); 16-bit integers count 1/`Mult` of them. The pitch along x is `Pixel_size`, mm, along y
//! `Aspect` times it. A missing height is 10³⁰ or more, of either sign, for integers 32766 or 32767.

use std::collections::HashMap;

use super::binary::{Cursor, Number, Order, Raster, shape, text};
use super::{Decoded, Fault, Scan, choose, distinct, from_last_y_to_first};
use asperity_base::error::Defect;
use asperity_base::grid::Field;

/// First bytes of the file.
pub(super) const MAGIC: &[u8] = b"\x01\0Directory";

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    let fault = |defect| Fault::defect("opd", defect);
    let blocks = blocks(bytes).map_err(fault)?;
    let arrays: Vec<_> =
        blocks.iter().filter(|block| block.kind == ARRAY && HEIGHTS.contains(&block.name.as_str())).collect();
    if arrays.is_empty() {
        return Err(fault(Defect::Missing("array of heights, such as Raw")));
    }
    let channels = distinct(arrays.iter().map(|block| block.name.clone()));
    let chosen = choose(&channels, channel)?;
    let numbers = blocks.iter().filter_map(|block| Some((block.name.as_str(), block.number()?))).collect();
    let heights = heights(arrays[chosen].data, &numbers).map_err(fault)?;
    let pixel = numbers.get("Pixel_size").copied().unwrap_or(f64::NAN) * 1e-3;
    let aspect = numbers.get("Aspect").copied().unwrap_or(1.0);
    Ok(Scan::of_channel("opd", channels, chosen, [pixel, pixel * aspect], heights))
}

const ARRAY: u16 = 3;

/// Names of arrays with heights.
const HEIGHTS: [&str; 5] = ["Raw", "RAW_DATA", "RAW DATA", "OPD", "SAMPLE_DATA"];

struct Block<'a> {
    name: String,
    kind: u16,
    data: &'a [u8],
}

impl Block<'_> {
    /// Returns the content of the block, if it is a number.
    fn number(&self) -> Option<f64> {
        let mut data = Cursor::new(self.data, Order::Little, "a number");
        match self.kind {
            6 => data.u16().map(|number| f64::from(number.cast_signed())).ok(),
            7 => data.f32().ok(),
            8 => data.f64().ok(),
            12 => data.i32().map(f64::from).ok(),
            _ => None,
        }
    }
}

/// Returns the blocks of the directory, without the directory itself.
fn blocks(bytes: &[u8]) -> Result<Vec<Block<'_>>, Defect> {
    const ENTRY: usize = 24;
    let mut data = Cursor::new(bytes, Order::Little, "the file");
    data.take(2)?;
    let mut directory = data.clone();
    let (_, _, size) = entry(&mut directory)?;
    data.take(size)?;
    let mut blocks = Vec::new();
    for _ in 1..size / ENTRY {
        let (name, kind, size) = entry(&mut directory)?;
        blocks.push(Block { name, kind, data: data.take(size)? });
    }
    Ok(blocks)
}

fn entry(directory: &mut Cursor<'_>) -> Result<(String, u16, usize), Defect> {
    let name = text(directory.take(16)?);
    let [kind, size] = [u32::from(directory.u16()?), directory.u32()?];
    directory.u16()?;
    Ok((name, kind as u16, size as usize))
}

fn heights(data: &[u8], numbers: &HashMap<&str, f64>) -> Result<Field, Defect> {
    let mut array = Cursor::new(data, Order::Little, "an array");
    let [nx, ny, size] = [array.u16()?, array.u16()?, array.u16()?];
    let wavelength = numbers.get("Wavelength").ok_or(Defect::Missing("Wavelength"))? * 1e-9;
    let (number, missing, unit) = match size {
        2 => (Number::Int16, 32_766.0, wavelength / numbers.get("Mult").copied().unwrap_or(1.0)),
        4 => (Number::Float32, f64::from(1e30_f32), wavelength),
        _ => {
            let found = size.to_string();
            return Err(Defect::Value { what: "the bytes of a height", found, expected: "2 or 4" });
        }
    };
    let raster = Raster::new(shape([nx, ny])?, number, Order::Little, array.rest())?;
    let height = |number: f64| {
        let is_missing = number >= missing || (size == 4 && number <= -missing);
        if is_missing { f64::NAN } else { number * unit }
    };
    let mut heights = raster.heights_with_y_fastest(height);
    from_last_y_to_first(&mut heights);
    Ok(heights)
}

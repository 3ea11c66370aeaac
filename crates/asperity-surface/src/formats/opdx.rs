//! OPDx: stylus profilometers and interferometers of Bruker (Dektak, Vision64); read only.
//!
//! Little-endian. `VCA DATA`, 01 00 00 55, then items: a name, its kind u8, its content. A name is its length
//! u32 and UTF-8. A size is the number of its bytes, 1, 2 or 4, and these bytes.
//!
//! ```text
//! 01 1 byte              12 text: size, UTF-8                          40 numbers: name, size, 5 bytes, f64 …
//! 04 05 2 bytes          13 quantity: size, f64, name, symbol of unit  42 list: name, size, names
//! 06 07 0c 4 bytes       0e 7c name, size, content                     00 matrix: name, 4 bytes, name, size,
//! 0a 0b 0d 8 bytes       18 size, content                                 rows u32, columns u32, f32, x fastest
//! 15 9 bytes             7d 46 47 size, items, 2 bytes                 45 matrix: name, size, the same      7f the end
//! ```
//!
//! Channels are the containers in `/2D_Data` with a `Matrix` and those in `/1D_Data` with an `Array` (a
//! profile). The unit of their `DataScale`, the factor of the numbers, must be a length. `Dimension1Extent`
//! (y) and `Dimension2Extent` (x), for a profile `Extent`, extend from the first to the last number. NaN, or
//! a number beyond 10³⁸, is a missing height.

use std::collections::HashMap;

use super::binary::{Cursor, Number, Order, Raster, shape, text};
use super::words::unit_of_length;
use super::{Channel, Decoded, LengthUnit, several};
use asperity_base::error::Defect;
use asperity_base::units::Metre;

/// First bytes of the file.
pub(super) const MAGIC: &[u8] = b"VCA DATA\x01\0\0\x55";

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    several("opdx", channel, channels(&bytes[MAGIC.len()..]))
}

type Outcome<T> = Result<T, Defect>;

fn channels(items: &[u8]) -> Outcome<Vec<Channel<'_>>> {
    let mut found = Items::default();
    found.read(Cursor::new(items, Order::Little, "the file"), "", 0)?;
    let mut sets = std::mem::take(&mut found.sets);
    if let Some(Item::Text(primary)) = found.others.get("/MetaData/PrimaryData2D") {
        let primary = format!("/2D_Data/{primary}");
        sets.sort_by_key(|(path, _)| *path != primary);
    }
    sets.iter().filter_map(|(path, data)| found.channel(path, data).transpose()).collect()
}

/// The required part of an item's content.
enum Item<'a> {
    Text(String),
    /// A number and the symbol of its unit.
    Quantity(f64, String),
    Data(Data<'a>),
    Other,
}

/// Numbers on a grid.
#[derive(Clone, Copy)]
struct Data<'a> {
    /// Number of heights along x and y; for a profile one along y.
    sizes: [u32; 2],
    number: Number,
    numbers: &'a [u8],
}

/// The items of a file by their paths.
#[derive(Default)]
struct Items<'a> {
    /// Data of heights, by the path of their container.
    sets: Vec<(String, Data<'a>)>,
    others: HashMap<String, Item<'a>>,
}

impl<'a> Items<'a> {
    /// Reads the items of a container.
    fn read(&mut self, mut items: Cursor<'a>, path: &str, depth: usize) -> Outcome<()> {
        const MAX_DEPTH: usize = 32;
        while !items.rest().is_empty() {
            let name = name(&mut items)?;
            let kind = items.u8()?;
            match kind {
                0x7f => break,
                0x46 | 0x47 | 0x7d if depth == MAX_DEPTH => {
                    let found = format!("more than {MAX_DEPTH} deep");
                    return Err(Defect::Value {
                        what: "a container",
                        found,
                        expected: "fewer in each other",
                    });
                }
                0x46 | 0x47 | 0x7d => {
                    let content = sized(&mut items)?;
                    // The two bytes at its end belong to no item.
                    let content = &content[..content.len().saturating_sub(2)];
                    let content = Cursor::new(content, Order::Little, "a container");
                    self.read(content, &format!("{path}/{name}"), depth + 1)?;
                }
                _ => match item(kind, &mut items)? {
                    Item::Other => {}
                    Item::Data(data) => {
                        let of_heights = [("/2D_Data/", "Matrix"), ("/1D_Data/", "Array")];
                        if of_heights.iter().any(|(folder, set)| path.starts_with(folder) && *set == name) {
                            self.sets.push((path.to_owned(), data));
                        }
                    }
                    item => {
                        self.others.insert(format!("{path}/{name}"), item);
                    }
                },
            }
        }
        Ok(())
    }

    /// Returns the channel of the data in the container at `path`, if they are heights.
    fn channel(&self, path: &str, data: &Data<'a>) -> Outcome<Option<Channel<'a>>> {
        let quantity = |name| match self.others.get(&format!("{path}/{name}")) {
            Some(Item::Quantity(number, unit)) => unit_of_length(unit).ok().map(|unit| number * unit),
            _ => None,
        };
        let Some(unit) = quantity("DataScale") else { return Ok(None) };
        let shape = shape(data.sizes)?;
        let raster = Raster::new(shape, data.number, Order::Little, data.numbers)?;
        let step = |extent, count: usize| quantity(extent).unwrap_or(f64::NAN) / (count.max(2) - 1) as f64;
        let pitch: [Metre; 2] = match data.number {
            Number::Float64 => [step("Extent", shape[0]); 2],
            _ => [step("Dimension2Extent", shape[0]), step("Dimension1Extent", shape[1])],
        };
        let name = match self.others.get(&format!("{path}/DataKind")) {
            Some(Item::Text(name)) => name.clone(),
            _ => path.rsplit('/').next().unwrap_or_default().to_owned(),
        };
        Ok(Some(Channel {
            name,
            pitch,
            unit: LengthUnit::Known,
            heights: Box::new(move || {
                let height = |number: f64| if number.abs() < 1e38 { number * unit } else { f64::NAN };
                Ok(raster.heights(height))
            }),
        }))
    }
}

fn item<'a>(kind: u8, items: &mut Cursor<'a>) -> Outcome<Item<'a>> {
    let bytes = match kind {
        0x01 => 1,
        0x04 | 0x05 => 2,
        0x06 | 0x07 | 0x0c => 4,
        0x0a | 0x0b | 0x0d => 8,
        0x15 => 9,
        0x12 => return sized(items).map(|content| Item::Text(text(content))),
        0x13 => {
            let mut content = Cursor::new(sized(items)?, Order::Little, "a quantity");
            let number = content.f64()?;
            name(&mut content)?;
            return Ok(Item::Quantity(number, name(&mut content)?));
        }
        0x18 => return sized(items).map(|_| Item::Other),
        0x40 => {
            const BEFORE: usize = 5;
            name(items)?;
            let numbers = sized(items)?.get(BEFORE..).unwrap_or_default();
            let sizes = [u32::try_from(numbers.len() / 8).unwrap_or(u32::MAX), 1];
            return Ok(Item::Data(Data { sizes, number: Number::Float64, numbers }));
        }
        0x00 | 0x45 => {
            name(items)?;
            if kind == 0 {
                items.take(4)?;
                name(items)?;
            }
            let mut content = Cursor::new(sized(items)?, Order::Little, "a matrix");
            let [ny, nx] = [content.u32()?, content.u32()?];
            return Ok(Item::Data(Data {
                sizes: [nx, ny],
                number: Number::Float32,
                numbers: content.rest(),
            }));
        }
        0x0e | 0x42 | 0x7c => {
            name(items)?;
            return sized(items).map(|_| Item::Other);
        }
        _ => {
            let (found, expected) = (format!("{kind:#04x}"), "one that is known");
            return Err(Defect::Value { what: "the kind of an item", found, expected });
        }
    };
    items.take(bytes).map(|_| Item::Other)
}

fn name(items: &mut Cursor<'_>) -> Outcome<String> {
    let length = items.u32()? as usize;
    items.take(length).map(text)
}

/// Reads content that is preceded by its size.
fn sized<'a>(items: &mut Cursor<'a>) -> Outcome<&'a [u8]> {
    let size = match items.u8()? {
        1 => u32::from(items.u8()?),
        2 => u32::from(items.u16()?),
        4 => items.u32()?,
        found => {
            let (found, expected) = (found.to_string(), "1, 2 or 4");
            return Err(Defect::Value { what: "the bytes of a size", found, expected });
        }
    };
    items.take(size as usize)
}

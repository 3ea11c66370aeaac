//! GWY: the native files of Gwyddion 2.
//!
//! Format: "Gwyddion native format (GWY)" in Gwyddion's user guide. `GWYP` is followed by one object, all
//! little-endian. An object is its name, the size of its content (u32), and the content: components with a
//! name, a letter for the type, and a value. Texts and names end with a zero. An array (a capital letter)
//! starts with the number of its elements (u32).
//!
//! The object is a container. Its component `/0/data` is a `GwyDataField`, x fastest, and `/0/data/title` its
//! name; further channels have other numbers. Channels are read if their values are lengths. The format has
//! no missing heights. A height is missing where `/0/mask` is positive, because programs that import
//! measurements mark missing heights so.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use super::binary::{Cursor, Number, Order, Raster, shape, text};
use super::words::unit_of_length;
use super::{Decoded, Fault, ONLY_CHANNEL, Scan, choose, distinct};
use asperity_base::error::{Defect, Result};
use asperity_base::grid::{Field, Grid};
use asperity_base::io::atomic;

/// Writes `heights` on `grid` to `path` as the channel `height`, atomically. NaN is masked, and replaced by
/// the mean.
///
/// # Errors
/// [`Error::File`](asperity_base::Error::File).
///
/// # Panics
/// If the shape of `heights` differs from that of `grid`, or if there are more than the format allows: 2²⁹.
pub(super) fn write(path: &Path, grid: &Grid, heights: &Field) -> Result<()> {
    assert_eq!(heights.shape(), grid.shape, "heights must be on the grid");
    assert!(grid.cells() < 1 << 29, "more heights than the format holds");
    let there = || heights.iter().filter(|height| !height.is_nan());
    let count = there().count();
    let mean = if count > 0 { there().sum::<f64>() / count as f64 } else { 0.0 };

    let filled = heights.mapv(|height| if height.is_nan() { mean } else { height });
    let mut content = component("/0/data", b'o', &data_field(grid, &filled, "m"));
    content.extend(component("/0/data/title", b's', format!("{ONLY_CHANNEL}\0").as_bytes()));
    content.extend(component("/0/data/visible", b'b', &[1]));
    if count < grid.cells() {
        let mask = heights.mapv(|height| f64::from(height.is_nan()));
        content.extend(component("/0/mask", b'o', &data_field(grid, &mask, "")));
    }
    atomic::replace(path, &[MAGIC, object("GwyContainer", &content).as_slice()].concat())
}

fn data_field(grid: &Grid, values: &Field, unit_of_values: &str) -> Vec<u8> {
    let unit = |unit: &str| object("GwySIUnit", &component("unitstr", b's', format!("{unit}\0").as_bytes()));
    let [nx, ny] = grid.shape.map(|size| (size as u32).to_le_bytes());
    let [width, depth] = grid.extent().map(f64::to_le_bytes);
    let mut data = (values.len() as u32).to_le_bytes().to_vec();
    data.extend(values.t().iter().flat_map(|value| value.to_le_bytes()));
    let content = [
        component("xres", b'i', &nx),
        component("yres", b'i', &ny),
        component("xreal", b'd', &width),
        component("yreal", b'd', &depth),
        component("si_unit_xy", b'o', &unit("m")),
        component("si_unit_z", b'o', &unit(unit_of_values)),
        component("data", b'D', &data),
    ];
    object("GwyDataField", &content.concat())
}

fn object(name: &str, content: &[u8]) -> Vec<u8> {
    [name.as_bytes(), b"\0", &(content.len() as u32).to_le_bytes(), content].concat()
}

fn component(name: &str, kind: u8, value: &[u8]) -> Vec<u8> {
    [name.as_bytes(), &[0, kind], value].concat()
}

/// First bytes of the file.
pub(super) const MAGIC: &[u8] = b"GWYP";

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    let fault = |defect| Fault::defect("gwy", defect);
    let mut file = Cursor::new(&bytes[MAGIC.len()..], Order::Little, "the file");
    let container = object_in(&mut file).and_then(components).map_err(fault)?;
    let numbers = channels(&container).map_err(fault)?;
    let title = |number: &u32| match container.get(format!("/{number}/data/title").as_str()) {
        Some(Value::Text(title)) if !title.is_empty() => title.clone(),
        _ => ONLY_CHANNEL.to_owned(),
    };
    let channels = distinct(numbers.keys().map(title));
    let chosen = choose(&channels, channel)?;
    let (number, field) = numbers.iter().nth(chosen).expect("one of the channels");
    let mask = match container.get(format!("/{number}/mask").as_str()) {
        Some(Value::Object(mask)) => Some(components(mask).map_err(fault)?),
        _ => None,
    };
    let (pitch, heights) = heights(field, mask.as_ref()).map_err(fault)?;
    Ok(Scan::of_channel("gwy", channels, chosen, pitch, heights))
}

type Outcome<T> = std::result::Result<T, Defect>;
type Components<'a> = HashMap<&'a str, Value<'a>>;

/// The required part of the value of a component.
enum Value<'a> {
    Int(i32),
    Double(f64),
    Text(String),
    /// Content of an object.
    Object(&'a [u8]),
    Doubles(&'a [u8]),
    Other,
}

/// Returns the channels whose values are lengths, by their number; not empty.
fn channels<'a>(container: &Components<'a>) -> Outcome<BTreeMap<u32, Components<'a>>> {
    let mut channels = BTreeMap::new();
    for (key, value) in container {
        let number = key.strip_prefix('/').and_then(|key| key.strip_suffix("/data"));
        let (Some(Ok(number)), Value::Object(field)) = (number.map(str::parse), value) else { continue };
        let field = components(field)?;
        if unit(&field, "si_unit_z")?.is_some() {
            channels.insert(number, field);
        }
    }
    if channels.is_empty() { Err(Defect::Missing("channel of lengths")) } else { Ok(channels) }
}

fn heights(field: &Components<'_>, mask: Option<&Components<'_>>) -> Outcome<([f64; 2], Field)> {
    let raster = raster(field)?;
    let scale = unit(field, "si_unit_z")?.unwrap_or(f64::NAN);
    let mut heights = raster.heights(|number| number * scale);
    if let Some(mask) = mask {
        let mask = self::raster(mask)?;
        if mask.shape != raster.shape {
            let found = format!("{} × {}", mask.shape[0], mask.shape[1]);
            return Err(Defect::Value { what: "the mask", found, expected: "of the size of its channel" });
        }
        heights.zip_mut_with(&mask.heights(|mask| mask), |height, mask| {
            if *mask > 0.0 {
                *height = f64::NAN;
            }
        });
    }
    let metre = unit(field, "si_unit_xy")?.unwrap_or(f64::NAN);
    let step = |name, count: usize| match field.get(name) {
        Some(Value::Double(length)) => length * metre / count as f64,
        _ => f64::NAN,
    };
    Ok(([step("xreal", raster.shape[0]), step("yreal", raster.shape[1])], heights))
}

fn raster<'a>(field: &Components<'a>) -> Outcome<Raster<'a>> {
    let (Some(Value::Int(nx)), Some(Value::Int(ny))) = (field.get("xres"), field.get("yres")) else {
        return Err(Defect::Missing("xres or yres in a GwyDataField"));
    };
    let Some(Value::Doubles(data)) = field.get("data") else {
        return Err(Defect::Missing("data in a GwyDataField"));
    };
    Raster::new(shape([*nx, *ny])?, Number::Float64, Order::Little, data)
}

/// Returns the unit of the object `name`, if it is one of length.
fn unit(field: &Components<'_>, name: &str) -> Outcome<Option<f64>> {
    let Some(Value::Object(unit)) = field.get(name) else { return Ok(None) };
    Ok(match components(unit)?.get("unitstr") {
        Some(Value::Text(unit)) => unit_of_length(unit).ok(),
        _ => None,
    })
}

fn components(content: &[u8]) -> Outcome<Components<'_>> {
    let mut content = Cursor::new(content, Order::Little, "an object");
    let mut components = HashMap::new();
    while !content.rest().is_empty() {
        let name = std::str::from_utf8(content.until_zero()?)
            .map_err(|error| Defect::Container(format!("the name of a component: {error}")))?;
        components.insert(name, value(&mut content)?);
    }
    Ok(components)
}

fn value<'a>(content: &mut Cursor<'a>) -> Outcome<Value<'a>> {
    let kind = content.u8()?;
    Ok(match kind {
        b'i' => Value::Int(content.i32()?),
        b'd' => Value::Double(content.f64()?),
        b's' => Value::Text(text(content.until_zero()?)),
        b'o' => Value::Object(object_in(content)?),
        b'D' => Value::Doubles(array(content, 8)?),
        b'b' | b'c' => content.take(1).map(|_| Value::Other)?,
        b'q' => content.take(8).map(|_| Value::Other)?,
        b'C' => array(content, 1).map(|_| Value::Other)?,
        b'I' => array(content, 4).map(|_| Value::Other)?,
        b'Q' => array(content, 8).map(|_| Value::Other)?,
        b'S' | b'O' => {
            for _ in 0..content.u32()? {
                if kind == b'S' {
                    content.until_zero()?
                } else {
                    object_in(content)?
                };
            }
            Value::Other
        }
        _ => {
            let found = char::from(kind).to_string();
            return Err(Defect::Value {
                what: "the type of a component",
                found,
                expected: "one of bciqdsoCIQDSO",
            });
        }
    })
}

/// Reads the content of the next object.
fn object_in<'a>(bytes: &mut Cursor<'a>) -> Outcome<&'a [u8]> {
    bytes.until_zero()?;
    let size = bytes.u32()? as usize;
    bytes.take(size)
}

fn array<'a>(content: &mut Cursor<'a>, size: usize) -> Outcome<&'a [u8]> {
    let count = content.u32()? as usize;
    content.take(count.saturating_mul(size))
}

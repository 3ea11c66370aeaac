//! NetCDF 3, classic and with 64-bit offsets; read only.
//!
//! Format: Unidata, "NetCDF Classic Format Specification"; big-endian. Variables with two dimensions and real
//! numbers are channels unless their `unit` (or `units`) is not a length. `scale_factor`, `add_offset`,
//! `_FillValue` and `missing_value` are applied; without `_FillValue` the number of the format for values
//! that were never written is missing. A height is missing where a variable `mask` is not 0. The pitch is
//! that of the variables named like the dimensions: their attribute `length` over their number, or the
//! spacing of their values, in their unit; values that fall reverse the order. Lines run along x if the first
//! dimension is `y` (or `lat`) or the second is `x` (or `lon`); otherwise they run along y, as in NumPy.

use std::collections::HashMap;

use ndarray::Axis;

use super::binary::{Cursor, Number, Order, Raster, shape, text};
use super::words::unit_of_length;
use super::{Channel, Decoded, Fault, LengthUnit, several};
use asperity_base::error::Defect;
use asperity_base::grid::Field;

/// Possible first bytes of the file.
pub(super) const MAGICS: [&[u8]; 2] = [b"CDF\x01", b"CDF\x02"];

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    let file = File::read(bytes).map_err(|defect| Fault::defect("netcdf", defect))?;
    let channels = file.variables.iter().filter_map(|variable| file.channel(variable).transpose());
    several("netcdf", channel, channels.collect())
}

type Outcome<T> = Result<T, Defect>;

struct File<'a> {
    bytes: &'a [u8],
    /// Names and sizes; 0 is the size of the record dimension, which is unlimited.
    dimensions: Vec<(String, u32)>,
    variables: Vec<Variable>,
}

struct Variable {
    name: String,
    dimensions: Vec<usize>,
    attributes: HashMap<String, Attribute>,
    number: Option<Number>,
    start: usize,
}

enum Attribute {
    Text(String),
    /// The first of the numbers.
    Number(f64),
    Other,
}

impl Variable {
    /// The number of a value that was never written, if no attribute gives it.
    fn unwritten(&self) -> f64 {
        match self.number {
            Some(Number::Int16) => -32_767.0,
            Some(Number::Int32) => -2_147_483_647.0,
            Some(Number::Float32) => f64::from(UNWRITTEN as f32),
            Some(Number::Float64) => UNWRITTEN,
            _ => f64::NAN,
        }
    }
}

/// 15 · 2¹¹⁹, the number of a value of floating point that was never written.
const UNWRITTEN: f64 = 9.969_209_968_386_869e36;

impl<'a> File<'a> {
    fn read(bytes: &'a [u8]) -> Outcome<Self> {
        let mut header = Cursor::new(bytes, Order::Big, "the header");
        let long = header.take(4)?[3] == 2;
        header.take(4)?;
        let mut dimensions = Vec::new();
        for _ in 0..list(&mut header, 0x0a)? {
            dimensions.push((name(&mut header)?, header.u32()?));
        }
        attributes(&mut header)?;
        let mut variables = Vec::new();
        for _ in 0..list(&mut header, 0x0b)? {
            let name = name(&mut header)?;
            let mut ids = Vec::new();
            for _ in 0..header.u32()? {
                ids.push(header.u32()? as usize);
            }
            if let Some(id) = ids.iter().find(|id| **id >= dimensions.len()) {
                let (found, expected) = (id.to_string(), "one of those there are");
                return Err(Defect::Value { what: "a dimension", found, expected });
            }
            let attributes = attributes(&mut header)?;
            let number = number(header.u32()?);
            header.take(4)?;
            let start = if long { header.u64()? } else { header.u32()?.into() };
            let start = usize::try_from(start).unwrap_or(usize::MAX);
            variables.push(Variable { name, dimensions: ids, attributes, number, start });
        }
        Ok(Self { bytes, dimensions, variables })
    }

    fn variable(&self, name: &str) -> Option<&Variable> {
        self.variables.iter().find(|variable| variable.name == name)
    }

    /// Returns the channel of a variable, if it contains heights.
    fn channel<'f>(&'f self, variable: &'f Variable) -> Outcome<Option<Channel<'f>>> {
        let [first, last] = variable.dimensions[..] else { return Ok(None) };
        let [first, last] = [&self.dimensions[first], &self.dimensions[last]];
        let unit = variable.unit();
        let is_length = unit.is_none_or(|unit| unit_of_length(unit).is_ok());
        if variable.number.is_none() || variable.name == MASK || first.1 == 0 || last.1 == 0 || !is_length {
            return Ok(None);
        }
        let begins = |name: &str, words: [&str; 2]| {
            let name = name.to_ascii_lowercase();
            words.iter().any(|word| name.starts_with(word))
        };
        let along_x = begins(&first.0, ["y", "lat"]) || begins(&last.0, ["x", "lon"]);
        let [x, y] = if along_x { [last, first] } else { [first, last] };
        let shape = shape([x.1, y.1])?;

        let axes = [self.axis(x), self.axis(y)];
        let has_unit = axes.iter().any(|axis| axis.is_some_and(|(_, unit)| unit.is_some()));
        let kind = match (unit, has_unit) {
            (Some(_), _) => LengthUnit::Known,
            (None, true) => LengthUnit::Metres,
            (None, false) => LengthUnit::MetresThroughout,
        };
        let pitch = axes.map(|axis| match axis {
            Some((step, Some(unit))) => step.abs() * unit_of_length(unit).unwrap_or(f64::NAN),
            Some((step, None)) if kind == LengthUnit::MetresThroughout => step.abs(),
            _ => f64::NAN,
        });
        let name = variable.name.clone();
        let falls = axes.map(|axis| axis.is_some_and(|(step, _)| step < 0.0));
        let heights = Box::new(move || {
            let mut heights = self.heights(variable, shape, along_x)?;
            for axis in (0..2).filter(|axis| falls[*axis]) {
                heights.invert_axis(Axis(axis));
            }
            Ok(heights.as_standard_layout().into_owned())
        });
        Ok(Some(Channel { name, pitch, unit: kind, heights }))
    }

    fn heights(&self, variable: &Variable, shape: [usize; 2], along_x: bool) -> Outcome<Field> {
        let number = |name, default| match variable.attributes.get(name) {
            Some(Attribute::Number(number)) => *number,
            _ => default,
        };
        let (scale, offset) = (number("scale_factor", 1.0), number("add_offset", 0.0));
        let missing = [number("_FillValue", variable.unwritten()), number("missing_value", f64::NAN)];
        let unit = variable.unit().map_or(Ok(1.0), unit_of_length)?;
        let height = |number: f64| {
            if missing.contains(&number) { f64::NAN } else { (number * scale + offset) * unit }
        };
        let mut heights = self.values(variable, shape, along_x, height)?;
        let same = |mask: &&Variable| mask.dimensions == variable.dimensions && mask.number.is_some();
        if let Some(mask) = self.variable(MASK).filter(same) {
            let mask = self.values(mask, shape, along_x, |number| number)?;
            heights.zip_mut_with(&mask, |height, mask| {
                if *mask != 0.0 {
                    *height = f64::NAN;
                }
            });
        }
        Ok(heights)
    }

    fn values(
        &self,
        variable: &Variable,
        shape: [usize; 2],
        along_x: bool,
        value: impl Fn(f64) -> f64,
    ) -> Outcome<Field> {
        let number = variable.number.ok_or(Defect::Missing("numbers in a variable"))?;
        let data = self.bytes.get(variable.start..).unwrap_or_default();
        let raster = Raster::new(shape, number, Order::Big, data)?;
        Ok(if along_x { raster.heights(value) } else { raster.heights_with_y_fastest(value) })
    }

    /// Returns the step along a dimension, if a variable defines it, and its unit.
    fn axis(&self, (name, count): &(String, u32)) -> Option<(f64, Option<&str>)> {
        let variable = self.variable(name)?;
        let step = match variable.attributes.get("length") {
            Some(Attribute::Number(length)) => length / f64::from(*count),
            _ if variable.dimensions.len() == 1 && *count > 1 => {
                let shape = shape([*count, 1]).ok()?;
                let places = self.values(variable, shape, true, |number| number).ok()?;
                let step = (places[[shape[0] - 1, 0]] - places[[0, 0]]) / f64::from(count - 1);
                let even = |(index, place): (usize, &f64)| {
                    (place - places[[0, 0]] - index as f64 * step).abs() < 0.1 * step.abs()
                };
                places.iter().enumerate().all(even).then_some(step)?
            }
            _ => return None,
        };
        Some((step, variable.unit()))
    }
}

const MASK: &str = "mask";

impl Variable {
    fn unit(&self) -> Option<&str> {
        ["unit", "units"].into_iter().find_map(|name| match self.attributes.get(name) {
            Some(Attribute::Text(unit)) => Some(unit.as_str()),
            _ => None,
        })
    }
}

/// Reads the number of elements in the next list, which may be absent.
fn list(header: &mut Cursor<'_>, tag: u32) -> Outcome<u32> {
    match (header.u32()?, header.u32()?) {
        (0, 0) => Ok(0),
        (found, count) if found == tag => Ok(count),
        (found, _) => {
            let expected = "that of dimensions, attributes or variables";
            Err(Defect::Value { what: "the tag of a list", found: format!("{found:#x}"), expected })
        }
    }
}

fn attributes(header: &mut Cursor<'_>) -> Outcome<HashMap<String, Attribute>> {
    let mut attributes = HashMap::new();
    for _ in 0..list(header, 0x0c)? {
        let name = name(header)?;
        let kind = header.u32()?;
        let count = header.u32()? as usize;
        let attribute = match number(kind) {
            Some(number) => {
                let values = padded(header, count.saturating_mul(number.bytes()))?;
                let first = Raster::new([1, 1], number, Order::Big, values);
                first.map_or(Attribute::Other, |first| Attribute::Number(first.heights(|n| n)[[0, 0]]))
            }
            None => Attribute::Text(text(padded(header, count)?)),
        };
        attributes.insert(name, attribute);
    }
    Ok(attributes)
}

/// Returns the storage format of a type, if it is numeric.
fn number(kind: u32) -> Option<Number> {
    Some(match kind {
        1 => Number::Int8,
        3 => Number::Int16,
        4 => Number::Int32,
        5 => Number::Float32,
        6 => Number::Float64,
        _ => return None,
    })
}

fn name(header: &mut Cursor<'_>) -> Outcome<String> {
    let length = header.u32()? as usize;
    padded(header, length).map(text)
}

/// Reads bytes padded to a multiple of four.
fn padded<'a>(header: &mut Cursor<'a>, count: usize) -> Outcome<&'a [u8]> {
    let content = header.take(count)?;
    header.take(count.next_multiple_of(4) - count)?;
    Ok(content)
}

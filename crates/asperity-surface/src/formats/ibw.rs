//! IBW: binary waves of Igor Pro, versions 2 and 5, as written by the atomic force microscopes of Asylum
//! Research; read only.
//!
//! Format: WaveMetrics, Technical Note 3. The version (i16) also determines the byte order. The i16 numbers
//! of both headers sum to 0.
//!
//! ```text
//! version 2: 0 i16 2, then 3 sizes i32             version 5: 0 i16 5, i16, 11 sizes i32: wave, formula, note, units of
//!   16 kind of number i16                                     the data, of 4 dimensions, 4 lists of labels, more
//!   46 units of the data, of x 2 × 4                64 + 12 count of numbers i32, kind of number i16
//!   58 count of numbers i32                            + 68 sizes of 4 dimensions i32, + 84 their steps f64
//!   64 step f64                                        + 148 units of the data 4, of the dimensions 4 × 4
//!   126 numbers                                        + 320 numbers, the first dimension fastest, those with a size
//! ```
//!
//! The first dimension is x, the second y, upwards, and the third the channels, named by the labels of that
//! dimension. A wave with one dimension is a profile. If a microscope wrote a note, the unit of a channel
//! follows from its name, because the unit of the wave is the same for all channels.

use std::collections::HashMap;

use super::binary::{Cursor, Number, Order, Raster, shape, text};
use super::words::unit_of_length;
use super::{Channel, Decoded, LengthUnit, from_last_y_to_first, several};
use asperity_base::error::Defect;

/// Whether the content begins with a version, and with headers whose checksum is correct.
pub(super) fn is_one(bytes: &[u8]) -> bool {
    let Some((version, order)) = version(bytes) else { return false };
    let headers = if version == 2 { 126 } else { 384 };
    let word = |word: &[u8; 2]| match order {
        Order::Little => u16::from_le_bytes(*word),
        Order::Big => u16::from_be_bytes(*word),
    };
    let words = bytes.get(..headers).map(|headers| headers.as_chunks().0);
    words.is_some_and(|words| words.iter().fold(0, |sum: u16, next| sum.wrapping_add(word(next))) == 0)
}

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    let channels = match version(bytes) {
        Some((2, order)) => version_2(bytes, order),
        Some((_, order)) => version_5(bytes, order),
        None => Err(Defect::Missing("version")),
    };
    several("ibw", channel, channels)
}

type Outcome<T> = Result<T, Defect>;

fn version(bytes: &[u8]) -> Option<(u8, Order)> {
    match *bytes.get(..2)? {
        [version @ (2 | 5), 0] => Some((version, Order::Little)),
        [0, version @ (2 | 5)] => Some((version, Order::Big)),
        _ => None,
    }
}

fn version_2(bytes: &[u8], order: Order) -> Outcome<Vec<Channel<'_>>> {
    let mut header = Cursor::new(bytes, order, "the file");
    header.seek(16)?;
    let kind = header.u16()?;
    header.seek(46)?;
    let [data_unit, x_unit] = [text(header.take(4)?), text(header.take(4)?)];
    header.seek(58)?;
    let size = header.i32()?;
    header.seek(64)?;
    let step = header.f64()?.abs();
    header.seek(126)?;
    let raster = Raster::new(shape([size, 1])?, number(kind)?, order, header.rest())?;
    let units = Units::of(&data_unit, [&x_unit, &x_unit]);
    Ok(units.channel(String::new(), [step, step], raster).into_iter().collect())
}

fn version_5(bytes: &[u8], order: Order) -> Outcome<Vec<Channel<'_>>> {
    const HEADER: usize = 320;
    let mut header = Cursor::new(bytes, order, "the file");
    header.seek(4)?;
    let mut sizes = [0; 11];
    for size in &mut sizes {
        *size = header.u32()? as usize;
    }
    header.seek(64 + 16)?;
    let kind = header.u16()?;
    header.seek(64 + 68)?;
    let [nx, ny, layers, more] = [header.i32()?, header.i32()?, header.i32()?, header.i32()?];
    if more > 1 {
        let found = more.to_string();
        return Err(Defect::Value { what: "the size of the fourth dimension", found, expected: "none" });
    }
    let steps = [header.f64()?.abs(), header.f64()?.abs()];
    header.seek(64 + 148)?;
    let units = [text(header.take(4)?), text(header.take(4)?), text(header.take(4)?)];

    // A dimension without numbers has the size 0.
    let steps = if ny == 0 { [steps[0]; 2] } else { steps };
    let shape = shape([nx, ny.max(1)])?;
    let number = number(kind)?;
    let layer = shape[0] * shape[1] * number.bytes();
    let layers = layers.max(1) as usize;
    header.seek(64)?;
    let mut wave = Cursor::new(header.take(sizes[0])?, order, "the wave");
    wave.take(HEADER)?;
    let data = wave.take(layer.saturating_mul(layers))?;

    header.take(sizes[1])?;
    let note = text(header.take(sizes[2])?);
    let of_data = text(header.take(sizes[3])?);
    for size in &sizes[4..10] {
        header.take(*size)?;
    }
    let labels = header.take(sizes[10])?.as_chunks::<32>().0;
    // The first label is that of the whole dimension.
    let label = |index: usize| labels.get(index + 1).map(|label| text(label)).unwrap_or_default();
    let of_data = if of_data.is_empty() { &units[0] } else { &of_data };
    let of_y = if ny == 0 { &units[1] } else { &units[2] };

    let note = note_of_a_microscope(&note);
    let channel = |(index, data)| {
        let name = label(index);
        let of_data = match &note {
            Some(note) if !name.is_empty() => unit_by_name(&name, note),
            _ => of_data.clone(),
        };
        let raster = Raster::new(shape, number, order, data);
        raster.map(|raster| Units::of(&of_data, [&units[1], of_y]).channel(name, steps, raster)).transpose()
    };
    data.chunks(layer).enumerate().filter_map(channel).collect()
}

fn number(kind: u16) -> Outcome<Number> {
    Ok(match kind {
        0x02 => Number::Float32,
        0x04 => Number::Float64,
        0x08 => Number::Int8,
        0x10 => Number::Int16,
        0x20 => Number::Int32,
        0x48 => Number::Uint8,
        0x50 => Number::Uint16,
        0x60 => Number::Uint32,
        _ => {
            let (found, expected) = (format!("{kind:#x}"), "of real numbers");
            return Err(Defect::Value { what: "the kind of wave", found, expected });
        }
    })
}

/// Units of a wave in metres.
struct Units {
    /// Size of the unit in metres; `None` if it is not a length.
    data: Option<f64>,
    dimensions: [f64; 2],
    kind: LengthUnit,
}

impl Units {
    fn of(data: &str, dimensions: [&String; 2]) -> Self {
        let length = |unit: &str| match unit {
            "" => Some(1.0),
            // The ampere.
            "A" => None,
            unit => unit_of_length(unit).ok(),
        };
        let kind = match (data.is_empty(), dimensions[0].is_empty()) {
            (false, _) => LengthUnit::Known,
            (true, false) => LengthUnit::Metres,
            (true, true) => LengthUnit::MetresThroughout,
        };
        let dimensions = dimensions.map(|unit| match length(unit) {
            Some(_) if unit.is_empty() && kind == LengthUnit::Known => f64::NAN,
            length => length.unwrap_or(f64::NAN),
        });
        Self { data: length(data), dimensions, kind }
    }

    fn channel(self, name: String, steps: [f64; 2], raster: Raster<'_>) -> Option<Channel<'_>> {
        let unit = self.data?;
        Some(Channel {
            name,
            pitch: [steps[0] * self.dimensions[0], steps[1] * self.dimensions[1]],
            unit: self.kind,
            heights: Box::new(move || {
                let mut heights = raster.heights(|number| number * unit);
                from_last_y_to_first(&mut heights);
                Ok(heights)
            }),
        })
    }
}

/// Returns the lines `name: value` of a note written by a microscope.
fn note_of_a_microscope(note: &str) -> Option<HashMap<&str, &str>> {
    let lines: HashMap<_, _> = note
        .split(['\r', '\n'])
        .filter_map(|line| line.split_once(':'))
        .map(|(name, value)| (name.trim(), value.trim()))
        .collect();
    lines.contains_key("ScanSize").then_some(lines)
}

/// Returns the unit of a channel such as `HeightTrace` or `NapZSensorRetrace`; volts by default.
fn unit_by_name(name: &str, note: &HashMap<&str, &str>) -> String {
    const LENGTHS: [&str; 4] = ["Height", "ZSensor", "Deflection", "Amplitude"];
    let name = name.trim_end_matches(|character: char| character.is_ascii_digit());
    let name = name.strip_suffix("Mod").unwrap_or(name);
    let name = name.strip_suffix("Retrace").or_else(|| name.strip_suffix("Trace")).unwrap_or(name);
    if let Some(unit) = note.get(format!("{name}Unit").as_str()) {
        return (*unit).to_owned();
    }
    let plain = name.strip_prefix("DAC").or_else(|| name.strip_prefix("Nap")).unwrap_or(name);
    if LENGTHS.iter().any(|length| plain.starts_with(length)) { "m".to_owned() } else { "V".to_owned() }
}

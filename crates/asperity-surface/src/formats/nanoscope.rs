//! NanoScope: atomic force microscopes of Digital Instruments, Veeco and Bruker; read only.
//!
//! The header has lines `\name: value` in parts that begin with `\*name`, from `\*File list` to
//! `\*File list end`. Then, at the places given in the header, come images of little-endian integers, x
//! fastest, from the last y to the first. Each `\*… image list` is a channel. The unit of an image is
//!
//! ```text
//! \@2:Z scale: V [Sens. Zsens] (0.005 V/LSB) 330 V     330 V / 256ᵇ, b the Bytes/pixel, 2 or 4
//! \@Sens. Zsens: V 34.5 nm/V                           times 34.5 nm/V
//! ```
//!
//! Channels are heights if their sensitivity is a length per volt, or per unit of the scale. From version 9.2
//! on the integers have 32 bits, whatever `Bytes/pixel` is. `~m` is µm.

use std::collections::HashMap;

use super::binary::{Number, Order, Raster, shape, text};
use super::words::{excerpt, unit_of_length};
use super::{Channel, Decoded, LengthUnit, from_last_y_to_first, several};
use asperity_base::error::Defect;
use asperity_base::units::Metre;

/// Possible first bytes of the file.
pub(super) const MAGICS: [&[u8]; 2] = [b"\\*File list", b"\\*EC File list"];

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    several("nanoscope", channel, channels(bytes))
}

type Outcome<T> = Result<T, Defect>;

fn channels(bytes: &[u8]) -> Outcome<Vec<Channel<'_>>> {
    let header = header(bytes);
    let parts = parts(&header);
    let (images, others): (Vec<_>, Vec<_>) = parts.iter().partition(|part| part.is_image());
    let mut common = HashMap::new();
    for (name, value) in others.iter().flat_map(|part| &part.entries) {
        common.entry(name.as_str()).or_insert(*value);
    }
    if let Some(found @ "FOL") = common.get("start context").copied() {
        let found = found.to_owned();
        return Err(Defect::Value { what: "Start context", found, expected: "an image, not a force curve" });
    }
    let channels = images.iter().map(|image| channel(bytes, &common, image));
    channels.filter_map(Outcome::transpose).collect()
}

/// Returns the channel of an image, if it contains heights.
fn channel<'a>(
    bytes: &'a [u8],
    common: &HashMap<&str, &str>,
    image: &Part<'_>,
) -> Outcome<Option<Channel<'a>>> {
    let scale = image.entries.get("@4:z scale").or_else(|| image.entries.get("@2:z scale"));
    let scale = scale.ok_or(Defect::Missing("@2:Z scale, which files before version 4.3 have not"))?;
    let Some(range) = Quantity::of(scale).and_then(|scale| scale.length(common)) else { return Ok(None) };

    let [nx, ny] = shape([image.count("samps/line")?, image.count("number of lines")?])?;
    let bytes_per_pixel = image.entries.get("bytes/pixel").copied().unwrap_or("2");
    let (mut number, unit) = match bytes_per_pixel {
        "2" => (Number::Int16, range / 65_536.0),
        "4" => (Number::Int32, range / 4_294_967_296.0),
        _ => {
            let found = excerpt(bytes_per_pixel);
            return Err(Defect::Value { what: "Bytes/pixel", found, expected: "2 or 4" });
        }
    };
    let length = image.count("data length")? as usize;
    let version = common.get("version").and_then(|version| version.strip_prefix("0x"));
    let version = version.and_then(|version| u32::from_str_radix(version, 16).ok()).unwrap_or(0);
    if version >= 0x0920_0000 && length >= 4 * nx * ny {
        number = Number::Int32;
    }
    let start = image.count("data offset")? as usize;
    let data = bytes.get(start..).unwrap_or_default();
    let raster = Raster::new([nx, ny], number, Order::Little, &data[..length.min(data.len())])?;

    let lengths = image.lengths(common)?;
    Ok(Some(Channel {
        name: image.name(),
        pitch: [lengths[0] / nx as f64, lengths[1] / ny as f64],
        unit: LengthUnit::Known,
        heights: Box::new(move || {
            let mut heights = raster.heights(|number| number * unit);
            from_last_y_to_first(&mut heights);
            Ok(heights)
        }),
    }))
}

/// Returns the lines of the header, which begin with a backslash.
fn header(bytes: &[u8]) -> String {
    let lines = bytes.split(|byte| *byte == b'\n').take_while(|line| line.starts_with(b"\\"));
    let lines = lines.map(text).take_while(|line| !line.to_ascii_lowercase().ends_with("file list end"));
    lines.map(|line| line + "\n").collect()
}

/// A part of the header: its name and its entries, in lower case.
struct Part<'a> {
    name: String,
    entries: HashMap<String, &'a str>,
}

fn parts(header: &str) -> Vec<Part<'_>> {
    let mut parts: Vec<Part<'_>> = Vec::new();
    for line in header.lines() {
        if let Some(name) = line.strip_prefix("\\*") {
            parts.push(Part { name: name.to_ascii_lowercase(), entries: HashMap::new() });
        } else if let (Some(part), Some((name, value))) = (parts.last_mut(), line[1..].split_once(": ")) {
            part.entries.insert(name.to_ascii_lowercase(), value.trim());
        }
    }
    parts
}

impl Part<'_> {
    fn is_image(&self) -> bool {
        self.name.ends_with("image list") && !self.name.contains("force")
    }

    /// Displayed name of the channel: `Height Sensor` for `S [ZSensor] "Height Sensor"`.
    fn name(&self) -> String {
        let data = ["@2:image data", "@3:image data", "@4:image data", "image data"];
        let data = data.iter().find_map(|name| self.entries.get(*name)).copied().unwrap_or_default();
        let between = |open, close| Some(data.split_once(open)?.1.split_once(close)?.0);
        between('"', '"').or_else(|| between('[', ']')).unwrap_or(data).trim().to_owned()
    }

    fn entry(&self, name: &'static str) -> Outcome<&str> {
        self.entries.get(name).copied().ok_or(Defect::Missing(name))
    }

    fn count(&self, name: &'static str) -> Outcome<u32> {
        let found = self.entry(name)?;
        let unusable = |_| Defect::Value { what: name, found: excerpt(found), expected: "a whole number" };
        found.parse().map_err(unusable)
    }

    /// Returns the side lengths of the image: `300 300 nm`, or `300 nm` for a square one.
    fn lengths(&self, common: &HashMap<&str, &str>) -> Outcome<[Metre; 2]> {
        let lengths = |found: &str| {
            let (numbers, unit): (Vec<_>, Vec<_>) =
                found.split_whitespace().partition(|word| word.parse::<f64>().is_ok());
            let numbers: Vec<f64> = numbers.iter().filter_map(|number| number.parse().ok()).collect();
            let unit = unit_of_length(&unit.join(" ")).ok()?;
            let (first, last) = (numbers.first()?, numbers.last()?);
            Some([first * unit, last * unit])
        };
        // If the length of the slow axis is given for the whole scan, the second length of the image may be
        // wrong.
        let slow = common.get("slow axis size").zip(common.get("scan size"));
        if let Some((slow, fast)) = slow
            && let (Some([y, _]), Some([x, _])) = (lengths(slow), lengths(fast))
        {
            let lines = common.get("lines").and_then(|lines| lines.parse().ok()).filter(|n: &f64| *n >= 1.0);
            let taken = f64::from(self.count("number of lines")?);
            let is_square = self.entries.get("aspect ratio").is_none_or(|aspect| *aspect == "1:1");
            return Ok([x, if is_square { y } else { y * lines.map_or(1.0, |n| (taken / n).min(1.0)) }]);
        }
        let found = self.entry("scan size")?;
        let unreadable = || Defect::Value {
            what: "Scan Size",
            found: excerpt(found),
            expected: "lengths with their unit",
        };
        lengths(found).ok_or_else(unreadable)
    }
}

/// `V [Sens. Zsens] (0.005 V/LSB) 330 V`: a number with its unit, and the name of a sensitivity.
struct Quantity<'a> {
    sensitivity: Option<&'a str>,
    number: f64,
    unit: &'a str,
}

impl<'a> Quantity<'a> {
    fn of(text: &'a str) -> Option<Self> {
        let mut rest = text.strip_prefix('V')?.trim_start();
        let mut sensitivity = None;
        if let Some(named) = rest.strip_prefix('[') {
            let (name, behind) = named.split_once(']')?;
            (sensitivity, rest) = (Some(name.trim()).filter(|name| !name.is_empty()), behind.trim_start());
        }
        if rest.starts_with('(') {
            // Units may contain parentheses: `(0.0005 log(Arb)/LSB)`.
            let mut depth = 0;
            let end = rest.find(|character| {
                depth += i32::from(character == '(') - i32::from(character == ')');
                depth == 0
            })?;
            rest = rest[end + 1..].trim_start();
        }
        let (number, unit) = rest.split_once(' ').unwrap_or((rest, ""));
        let number = number.parse().ok().filter(|number: &f64| number.is_finite())?;
        Some(Self { sensitivity, number, unit: unit.trim() })
    }

    /// Returns the value in metres, if it is a length.
    fn length(&self, common: &HashMap<&str, &str>) -> Option<Metre> {
        let Some(name) = self.sensitivity else { return Some(self.number * unit_of_length(self.unit).ok()?) };
        let sensitivity = Quantity::of(common.get(format!("@{}", name.to_ascii_lowercase()).as_str())?)?;
        let (length, per) = sensitivity.unit.split_once('/')?;
        let ratio = if self.unit == per { 1.0 } else { volts(self.unit)? / volts(per)? };
        Some(self.number * ratio * sensitivity.number * unit_of_length(length).ok()?)
    }
}

fn volts(unit: &str) -> Option<f64> {
    match unit.strip_suffix('V')? {
        "" => Some(1.0),
        "m" => Some(1e-3),
        "µ" | "u" | "~" => Some(1e-6),
        "n" => Some(1e-9),
        "k" => Some(1e3),
        _ => None,
    }
}

//! NID, EZD: atomic force microscopes of Nanosurf; read only.
//!
//! The text has parts with lines `name=value`, the first of which is `[DataSet]`. After `#!` the numbers of
//! all data sets follow without gaps, x fastest, from the last y to the first. `Gr0-Ch1` in the first part
//! names the part that describes a data set:
//!
//! ```text
//! Points=256  Lines=256  SaveBits=16  SaveSign=Signed  SaveOrder=Intel  Frame=Scan forward
//! Dim0Range=2e-05  Dim0Unit=m    Dim1Range=2e-05  Dim1Unit=m
//! Dim2Name=Z-Axis  Dim2Unit=m  Dim2Min=-5e-06  Dim2Range=1e-05    from the smallest to above the largest number
//! ```
//!
//! Data sets in units of length are channels, named by their frame and the name of their third dimension.

use super::binary::{Number, Order, Raster, shape, text};
use super::header::{Header, sections};
use super::words::{excerpt, unit_of_length};
use super::{Channel, Decoded, LengthUnit, from_last_y_to_first, several};
use asperity_base::error::Defect;

/// First bytes of the file.
pub(super) const MAGIC: &[u8] = b"[DataSet]";

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    several("nid", channel, channels(bytes))
}

type Outcome<T> = Result<T, Defect>;

fn channels(bytes: &[u8]) -> Outcome<Vec<Channel<'_>>> {
    const MARK: &[u8] = b"\n#!";
    let end = bytes.windows(MARK.len()).position(|bytes| bytes == MARK);
    let end = end.ok_or(Defect::Missing("mark of the data, #!"))?;
    let mut data = &bytes[end + MARK.len()..];
    let header = text(&bytes[..end]);
    let parts = sections(&header);
    let part =
        |name: &str| parts.iter().find(|(other, _)| *other == name).map(|(_, part)| Header::new(part, '='));

    let mut channels = Vec::new();
    for name in data_sets(parts.first().map_or("", |(_, part)| part)) {
        let Some(part) = part(name) else { continue };
        let set = DataSet::of(&part)?;
        let raster = Raster::new(set.shape, set.number, set.order, data)?;
        data = &data[raster.bytes()..];
        let Ok(unit) = unit_of_length(part.get("Dim2Unit").unwrap_or_default()) else { continue };
        channels.push(set.channel(&part, unit, raster)?);
    }
    Ok(channels)
}

/// Returns the names of the parts that describe the data sets, in the order of the data.
fn data_sets(part: &str) -> Vec<&str> {
    let place = |name: &str| -> Option<(u32, u32)> {
        let (group, channel) = name.trim().strip_prefix("Gr")?.split_once("-Ch")?;
        Some((group.parse().ok()?, channel.parse().ok()?))
    };
    let lines = part.lines().filter_map(|line| line.split_once('='));
    let mut sets: Vec<_> = lines.filter_map(|(name, value)| Some((place(name)?, value.trim()))).collect();
    sets.sort_unstable();
    sets.dedup_by_key(|(place, _)| *place);
    sets.into_iter().map(|(_, name)| name).collect()
}

/// Storage of the numbers of a data set.
struct DataSet {
    shape: [usize; 2],
    number: Number,
    order: Order,
    /// Smallest number, and the size of the range.
    range: [f64; 2],
}

impl DataSet {
    fn of(part: &Header<'_>) -> Outcome<Self> {
        let value = |name| part.get(name).unwrap_or_default();
        if value("SaveMode") != "Binary" {
            let found = excerpt(value("SaveMode"));
            return Err(Defect::Value { what: "SaveMode", found, expected: "Binary" });
        }
        let (number, range) = match (value("SaveBits"), value("SaveSign") == "Signed") {
            ("8", false) => (Number::Uint8, [0.0, 256.0]),
            ("16", false) => (Number::Uint16, [0.0, 65_536.0]),
            ("32", false) => (Number::Uint32, [0.0, 4_294_967_296.0]),
            ("8", true) => (Number::Int8, [-128.0, 256.0]),
            ("16", true) => (Number::Int16, [-32_768.0, 65_536.0]),
            ("32", true) => (Number::Int32, [-2_147_483_648.0, 4_294_967_296.0]),
            (bits, _) => {
                let found = excerpt(bits);
                return Err(Defect::Value { what: "SaveBits", found, expected: "8, 16 or 32" });
            }
        };
        let order = if value("SaveOrder") == "Intel" { Order::Little } else { Order::Big };
        Ok(Self { shape: shape([part.size("Points")?, part.size("Lines")?])?, number, order, range })
    }

    fn channel<'a>(self, part: &Header<'_>, unit: f64, raster: Raster<'a>) -> Outcome<Channel<'a>> {
        let length = |range, of| Ok(part.number(range)? * unit_of_length(part.get(of).unwrap_or("m"))?);
        let [x, y] = [length("Dim0Range", "Dim0Unit")?, length("Dim1Range", "Dim1Unit")?];
        let step = part.number("Dim2Range")? / self.range[1] * unit;
        let least = part.number("Dim2Min")? * unit;
        let [frame, axis] = ["Frame", "Dim2Name"].map(|name| part.get(name).unwrap_or_default());
        let start = self.range[0];
        Ok(Channel {
            name: if frame.is_empty() { axis.to_owned() } else { format!("{frame} ({axis})") },
            pitch: [x / self.shape[0] as f64, y / self.shape[1] as f64],
            unit: LengthUnit::Known,
            heights: Box::new(move || {
                let mut heights = raster.heights(|number| least + (number - start) * step);
                from_last_y_to_first(&mut heights);
                Ok(heights)
            }),
        })
    }
}

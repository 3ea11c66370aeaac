//! GSF: Gwyddion Simple Field; read only.
//!
//! Format: "Gwyddion Simple Field" in Gwyddion's user guide. A line, then lines of names and values, padded
//! by zeros to a multiple of four bytes; then `XRes` × `YRes` little-endian floating-point numbers of 32
//! bits, x fastest, the first line at the largest y. NaN is a missing height. `XReal` and `YReal` are the
//! extent, in `XYUnits`; heights are in `ZUnits`.

use super::binary::{Number, Order, Raster, shape};
use super::header::Header;
use super::words::unit_of_length;
use super::{Decoded, Fault, LengthUnit, ONLY_CHANNEL, Scan, choose, from_last_y_to_first, usable_pitch};
use asperity_base::error::Defect;
use asperity_base::grid::Field;

/// First bytes of the file.
pub(super) const MAGIC: &[u8] = b"Gwyddion Simple Field 1.0\n";

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    let read = File::read(bytes).map_err(|defect| Fault::defect("gsf", defect))?;
    let channels = vec![read.title];
    choose(&channels, channel)?;
    Ok(Scan {
        format: "gsf",
        channel: channels[0].clone(),
        channels,
        pitch: read.pitch.and_then(usable_pitch),
        heights: read.heights,
        unit: read.unit,
        lines: None,
    })
}

struct File {
    title: String,
    pitch: Option<[f64; 2]>,
    unit: LengthUnit,
    heights: Field,
}

impl File {
    fn read(bytes: &[u8]) -> Result<Self, Defect> {
        let end =
            bytes.iter().position(|byte| *byte == 0).ok_or(Defect::Missing("zero behind the header"))?;
        let text = String::from_utf8_lossy(&bytes[..end]);
        let header = Header::new(&text, '=');
        let sizes = [header.size("XRes")?, header.size("YRes")?];
        let shape = shape(sizes)?;
        let unit = |name| header.get(name).filter(|unit| !unit.is_empty()).map(unit_of_length).transpose();
        let (lateral, vertical) = (unit("XYUnits")?, unit("ZUnits")?);
        let unit = match (lateral, vertical) {
            (_, Some(_)) => LengthUnit::Known,
            (Some(_), None) => LengthUnit::Metres,
            (None, None) => LengthUnit::MetresThroughout,
        };
        // A length without a unit is none beside heights that have one.
        let lateral = lateral.or((unit == LengthUnit::MetresThroughout).then_some(1.0));
        let lengths = match ["XReal", "YReal"].map(|name| header.get(name)) {
            [None, None] => None,
            _ => Some([header.number("XReal")?, header.number("YReal")?]),
        };
        let pitch = lengths
            .zip(lateral)
            .map(|([x, y], unit)| [x * unit / f64::from(sizes[0]), y * unit / f64::from(sizes[1])]);
        let data = &bytes[(end + 1).next_multiple_of(4).min(bytes.len())..];
        let raster = Raster::new(shape, Number::Float32, Order::Little, data)?;
        let factor = vertical.unwrap_or(1.0);
        let mut heights = raster.heights(|height| factor * height);
        from_last_y_to_first(&mut heights);
        let title = header.get("Title").filter(|title| !title.is_empty()).unwrap_or(ONLY_CHANNEL).to_owned();
        Ok(Self { title, pitch, unit, heights })
    }
}

//! DATX: interferometers of Zygo (Mx), HDF5; read only.
//!
//! Heights are the data sets in the group `/Data/Surface`, or else `/Measurement/Surface`: lines along x, the
//! first one at y = 0. Their attribute `Unit` is a length, such as `NanoMeters`, or `Fringes`: times the
//! wavelength, the interferometric scale factor (waves per fringe, 1/2 if absent) and the obliquity factor (1
//! if absent). These numbers, of which each may be an array of one, stand beside it, or under other names,
//! with the pitch, among the attributes of the measurement. A height from the attribute `No Data` on is
//! missing. The converters of X, Y and Z, which have the same numbers in a compound, are not read.

use std::collections::HashMap;

use hdf5_pure::{AttrValue, File, Group};

use super::data_sets::{Set, dataset, number, text};
use super::words::{excerpt, unit_of_length};
use super::{Decoded, Fault, LengthUnit, Scan, choose_among, finite, usable_pitch};
use asperity_base::error::Defect;
use asperity_base::units::Metre;

/// Decodes the heights of a file with these `matrices`, if it is one of these.
pub(super) fn decode(
    bytes: &[u8],
    file: &File,
    matrices: &[String],
    channel: Option<&str>,
) -> Option<Decoded> {
    let among =
        |is: fn(&String) -> bool| matrices.iter().filter(|path| is(path)).cloned().collect::<Vec<_>>();
    let mut channels = among(|path| path.starts_with("/Data/Surface/"));
    if channels.is_empty() {
        channels = among(|path| path == "/Measurement/Surface");
    }
    let names = ["Unit", "No Data"];
    let is_zygo = |set: Set| names.iter().any(|name| set.attributes.contains_key(*name));
    channels.retain(|path| dataset(file, path).is_ok_and(is_zygo));
    (!channels.is_empty()).then(|| surface(bytes, file, channels, channel))
}

fn surface(bytes: &[u8], file: &File, channels: Vec<String>, channel: Option<&str>) -> Decoded {
    let fault = |defect| Fault::defect("datx", defect);
    let channel = channels[choose_among(&channels, channel)?].clone();
    let measurement = Measurement::of(file);
    let set = dataset(file, &channel).map_err(fault)?;
    let (factor, unit) = measurement.unit(&set).map_err(fault)?;
    let no_data = number(&set.attributes, "No Data").unwrap_or(f64::INFINITY).min(f64::from(f32::MAX));
    let height = |z| if z >= no_data { f64::NAN } else { finite(factor * z) };
    let heights = set.values(bytes.len()).map_err(fault)?.mapv_into(height);
    let heights = heights.t().as_standard_layout().into_owned();
    let pitch = measurement.length("Lateral Resolution").and_then(|pitch| usable_pitch([pitch; 2]));
    Ok(Scan { format: "datx", channel, channels, pitch, heights, unit, lines: None })
}

/// Attributes of the measurement: each name ends with that of its quantity and `:Value`, or `:Unit`.
struct Measurement(HashMap<String, AttrValue>);

impl Measurement {
    fn of(file: &File) -> Self {
        let attributes = |group: Group| group.attrs().unwrap_or_default();
        let several = file.group("Attributes").into_iter().flat_map(|all| {
            let names = all.groups().unwrap_or_default();
            names.into_iter().filter_map(move |name| all.group(&name).ok())
        });
        Self(several.chain(file.group("Measurement/Attributes")).flat_map(attributes).collect())
    }

    fn find(&self, ending: &str) -> Option<&str> {
        self.0.keys().filter(|name| name.ends_with(ending)).min().map(String::as_str)
    }

    fn number(&self, quantity: &str) -> Option<f64> {
        number(&self.0, self.find(&format!("{quantity}:Value"))?)
    }

    fn length(&self, quantity: &str) -> Option<Metre> {
        let unit = self.find(&format!("{quantity}:Unit")).and_then(|name| text(&self.0, name));
        Some(self.number(quantity)? * unit.map_or(Ok(1.0), |unit| unit_of_length(&unit)).ok()?)
    }

    /// Returns the factor of the heights of a set to metres.
    fn unit(&self, set: &Set) -> Result<(f64, LengthUnit), Defect> {
        let Some(unit) = text(&set.attributes, "Unit") else { return Ok((1.0, LengthUnit::Metres)) };
        let beside = |name| number(&set.attributes, name);
        let factor = match unit.as_str() {
            "Fringes" | "Waves" => {
                let wavelength = beside("Wavelength").or_else(|| self.length("Wavelength"));
                let scale =
                    beside("Interferometric Scale Factor").or_else(|| self.number("Interf Scale Factor"));
                let obliquity = beside("Obliquity Factor").or_else(|| self.number("Obliquity"));
                let waves =
                    if unit == "Waves" { 1.0 } else { scale.unwrap_or(0.5) * obliquity.unwrap_or(1.0) };
                waves
                    * wavelength
                        .filter(|wave| *wave > 0.0)
                        .ok_or(Defect::Missing("Wavelength of its fringes"))?
            }
            length => unit_of_length(length).map_err(|_| Defect::Value {
                what: "the unit of the heights",
                found: excerpt(length),
                expected: "Fringes, or a length such as NanoMeters",
            })?,
        };
        Ok((factor, LengthUnit::Known))
    }
}

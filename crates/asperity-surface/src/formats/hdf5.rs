//! HDF5: fields of asperity's results, and any matrix of numbers; read only.
//!
//! Results are identified by the file attributes `version` and `identity`, files of Zygo by their groups, see
//! [`datx`]. Their channels are the fields in metres over x and y, with `lower` and `upper` first. In other
//! files every data set with two dimensions and real numbers is a channel, named by its path, `/group/name`,
//! and indexed `[ix, iy]`. If there are several, the user must choose one. Its heights are in metres unless
//! it has an attribute `unit` or `units`. A height is missing if it equals the attribute `_FillValue` or
//! `missing_value`. It has no pitch.

use hdf5_pure::{AttrValue, Dataset, File};

use super::data_sets::{container, dataset, paths_of_matrices, text};
use super::{
    Decoded, Fault, LengthUnit, RESULTS, Scan, UNDERSIDE, choose, choose_among, datx, finite, usable_pitch,
};
use crate::Axis;
use asperity_base::error::Defect;

/// First bytes of the file.
pub(super) const MAGIC: &[u8] = b"\x89HDF\r\n\x1a\n";

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    let fault = |defect| Fault::defect("hdf5", defect);
    let file = File::from_bytes(bytes.to_vec()).map_err(container).map_err(fault)?;
    let attributes = file.root().attrs().map_err(container).map_err(fault)?;
    if ["version", "identity"].iter().all(|name| attributes.contains_key(*name)) {
        return result(bytes, &file, channel);
    }
    let matrices = paths_of_matrices(&file);
    datx::decode(bytes, &file, &matrices, channel)
        .unwrap_or_else(|| decode_sets("hdf5", bytes, channel, |_| true))
}

/// Decodes the matrices of real numbers that are `suitable`, in a file of this format.
pub(super) fn decode_sets(
    format: &'static str,
    bytes: &[u8],
    channel: Option<&str>,
    suitable: impl Fn(&Dataset) -> bool,
) -> Decoded {
    let fault = |defect| Fault::defect(format, defect);
    let file = File::from_bytes(bytes.to_vec()).map_err(container).map_err(fault)?;
    let mut channels = paths_of_matrices(&file);
    channels.retain(|path| file.dataset(path).is_ok_and(|set| suitable(&set)));
    if channels.is_empty() {
        return Err(fault(Defect::Missing("data set of two dimensions and real numbers")));
    }
    let wanted = channel.map(|channel| format!("/{}", channel.trim_start_matches('/')));
    let channel = channels[choose_among(&channels, wanted.as_deref())?].clone();
    let (heights, unit) = dataset(&file, &channel)
        .and_then(|set| {
            let unit = ["unit", "units", "Unit", "Units"].iter().find_map(|name| text(&set.attributes, name));
            let factor = unit.as_deref().map_or(Ok(1.0), super::words::unit_of_length)?;
            let kind = if unit.is_some() { LengthUnit::Known } else { LengthUnit::Metres };
            let missing = set.missing();
            let height = |z| if missing.contains(&z) { f64::NAN } else { finite(factor * z) };
            Ok((set.values(bytes.len())?.mapv_into(height), kind))
        })
        .map_err(fault)?;
    Ok(Scan { format, channel, channels, pitch: None, heights, unit, lines: Some(Axis::Y) })
}

fn result(bytes: &[u8], file: &File, channel: Option<&str>) -> Decoded {
    let fault = |defect| Fault::defect(RESULTS, defect);
    let mut channels = file.root().datasets().map_err(container).map_err(fault)?;
    let is_field = |name: &String| {
        let field = dataset(file, name).ok();
        field.is_some_and(|set| {
            ["unit", "axes"].map(|name| text(&set.attributes, name)) == [Some("m".into()), Some("x,y".into())]
        })
    };
    channels.retain(is_field);
    channels.sort_by_key(|name| (name != "lower", name != UNDERSIDE, name.clone()));
    if channels.is_empty() {
        return Err(fault(Defect::Missing("field in metres over x and y")));
    }
    let channel = channels[choose(&channels, channel)?].clone();
    let set = dataset(file, &channel).map_err(fault)?;
    let pitch = set.attributes.get("pitch").and_then(AttrValue::to_f64s).unwrap_or_default();
    let pitch = <[f64; 2]>::try_from(pitch).ok().and_then(usable_pitch);
    let heights = set.values(bytes.len()).map_err(fault)?.mapv_into(finite);
    let unit = LengthUnit::Known;
    Ok(Scan { format: RESULTS, channel, channels, pitch, heights, unit, lines: None })
}

//! HDF5: fields of asperity's results, and any matrix of numbers; read only.
//!
//! Results are identified by the file attributes `version` and `identity`, files of Zygo by their groups, see [`datx`]. Their channels are the fields in metres over x
//! and y, with `lower` and `upper` first. In other files every data set with two dimensions and real numbers is a channel,
//! named by its path, `/group/name`, and indexed `[ix, iy]`. If there are several, the user must choose one. Its heights
//! are in metres unless it has an attribute `unit` or `units`. A height is missing if it equals the attribute `_FillValue` or
//! `missing_value`. It has no pitch.

use std::collections::HashMap;

use hdf5_pure::{AttrValue, DType, Dataset, File, Group};

use super::{
    Decoded, Fault, LengthUnit, MAX_CELLS, RESULTS, Scan, UNDERSIDE, cells, choose, choose_among, datx,
    finite, usable_pitch,
};
use crate::Axis;
use asperity_base::error::Defect;
use asperity_base::grid::Field;

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

type Outcome<T> = Result<T, Defect>;

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

/// A data set and its attributes.
pub(super) struct Set {
    dataset: Dataset,
    pub(super) attributes: HashMap<String, AttrValue>,
}

pub(super) fn dataset(file: &File, path: &str) -> Outcome<Set> {
    let dataset = file.dataset(path).map_err(container)?;
    let attributes = dataset.attrs().map_err(container)?;
    Ok(Set { dataset, attributes })
}

/// Returns the text of an attribute, which may be an array of one.
pub(super) fn text(attributes: &HashMap<String, AttrValue>, name: &str) -> Option<String> {
    attributes.get(name).and_then(AttrValue::as_str).map(|text| text.trim().to_owned())
}

/// Returns the number of an attribute, which may be an array of one.
pub(super) fn number(attributes: &HashMap<String, AttrValue>, name: &str) -> Option<f64> {
    match numbers(attributes, name)?[..] {
        [number] => Some(number),
        _ => None,
    }
}

fn numbers(attributes: &HashMap<String, AttrValue>, name: &str) -> Option<Vec<f64>> {
    let value = attributes.get(name)?;
    let integers = || Some(value.to_i64s()?.into_iter().map(|n| n as f64).collect());
    value.to_f64s().or_else(integers)
}

impl Set {
    /// Numbers that mark a missing height, by the conventions of NetCDF 4.
    fn missing(&self) -> Vec<f64> {
        let marks = ["_FillValue", "missing_value"].into_iter();
        marks.filter_map(|name| numbers(&self.attributes, name)).flatten().collect()
    }

    /// Reads the numbers of the set; `bytes` is the size of the file.
    pub(super) fn values(&self, bytes: usize) -> Outcome<Field> {
        /// Largest number of bytes that deflate expands one byte to.
        const MAX_INFLATION: usize = 1032;
        let sizes = self.dataset.shape().map_err(container)?;
        let [nx, ny] = sizes[..] else { return Err(Defect::Missing("two dimensions")) };
        let count = cells(&[nx, ny])?;
        let limit = MAX_CELLS.min(bytes.saturating_mul(MAX_INFLATION));
        if count == 0 || count > limit {
            return Err(Defect::TooLarge { cells: count as u128, limit });
        }
        let values = self.dataset.read_f64().map_err(container)?;
        let found = values.len() as u64;
        let expected = count as u64;
        Field::from_shape_vec([nx as usize, ny as usize], values).map_err(|_| Defect::Length {
            what: "the data set",
            expected: 8 * expected,
            found: 8 * found,
        })
    }
}

fn paths_of_matrices(file: &File) -> Vec<String> {
    let mut found = Vec::new();
    matrices(&file.root(), "", &mut 0, &mut found);
    found
}

/// Adds the paths of the matrices of real numbers in a group and in its subgroups.
fn matrices(group: &Group, path: &str, visited: &mut usize, found: &mut Vec<String>) {
    /// Limit on visited groups, found matrices and the length of a path, because groups may contain each other.
    const MAX_ENTRIES: usize = 1 << 12;
    *visited += 1;
    let mut names = group.datasets().unwrap_or_default();
    names.sort_unstable();
    for name in names {
        if found.len() < MAX_ENTRIES && group.dataset(&name).is_ok_and(|dataset| is_matrix(&dataset)) {
            found.push(format!("{path}/{name}"));
        }
    }
    let mut groups = group.groups().unwrap_or_default();
    groups.sort_unstable();
    for name in groups {
        if *visited < MAX_ENTRIES
            && path.len() < MAX_ENTRIES
            && let Ok(group) = group.group(&name)
        {
            matrices(&group, &format!("{path}/{name}"), visited, found);
        }
    }
}

fn is_matrix(dataset: &Dataset) -> bool {
    use DType::{F32, F64, I8, I16, I32, I64, U8, U16, U32, U64};
    let real = matches!(dataset.dtype(), Ok(F32 | F64 | I8 | I16 | I32 | I64 | U8 | U16 | U32 | U64));
    real && dataset.shape().is_ok_and(|shape| shape.len() == 2 && shape.iter().all(|size| *size > 0))
}

fn container(error: hdf5_pure::Error) -> Defect {
    Defect::Container(error.to_string())
}

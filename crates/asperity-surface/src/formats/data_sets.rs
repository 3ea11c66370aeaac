//! Data sets of HDF5 files and their attributes.

use std::collections::HashMap;

use hdf5_pure::{AttrValue, DType, Dataset, File, Group};

use super::{MAX_CELLS, cells};
use asperity_base::error::Defect;
use asperity_base::grid::Field;

type Outcome<T> = Result<T, Defect>;

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
    pub(super) fn missing(&self) -> Vec<f64> {
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

pub(super) fn paths_of_matrices(file: &File) -> Vec<String> {
    let mut found = Vec::new();
    matrices(&file.root(), "", &mut 0, &mut found);
    found
}

/// Adds the paths of the matrices of real numbers in a group and in its subgroups.
fn matrices(group: &Group, path: &str, visited: &mut usize, found: &mut Vec<String>) {
    /// Limit on visited groups, found matrices and the length of a path, because groups may contain each
    /// other.
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

pub(super) fn container(error: hdf5_pure::Error) -> Defect {
    Defect::Container(error.to_string())
}

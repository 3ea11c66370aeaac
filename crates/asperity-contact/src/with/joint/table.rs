//! The table `[joint]`.

use std::path::PathBuf;

use serde::Serialize;

use crate::error::Result;
use asperity_base::table::{Key, Value, cells, list};
use asperity_derive::Table;

/// The law of a joint of two rough surfaces under the loads of a sweep.
#[derive(Table, Debug, Clone, PartialEq, Serialize)]
#[table("joint")]
#[non_exhaustive]
pub struct JointLaw {
    /// Samples that `asperity joint` computes, each of generated surfaces from other seeds.
    #[key(count = 1, most = 10_000, absent = "1, or the number of patches or files", example = "8")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub samples: Option<usize>,
    /// Patches along x and y into which `asperity joint` cuts measured surfaces; each is a sample.
    #[key(special = cells, form = "`[nx, ny]`, each ≥ 1", absent = "the whole map", example = "[4, 4]")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub patches: Option<[usize; 2]>,
    /// Measured files that `asperity joint` takes in place of that of the one measured body; each is a sample.
    #[key(special = files, form = "file names, relative to the case file", default = Vec::new(), absent = "that of the body", example = "[\"one.npy\", \"two.npy\"]")]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub files: Vec<PathBuf>,
    /// Interval of the points of a sweep, or of the increments, that are computed; 0 for the last contact alone.
    #[key(count = 0, default = 1, example = "2")]
    pub every: usize,
}

fn files(value: &dyn Value, _: &Key) -> Result<Vec<PathBuf>> {
    const EXPECTED: &str = "a list of file names such as [\"one.npy\", \"two.npy\"]";
    let files = list(value, EXPECTED, |item| item.text().map(PathBuf::from))?;
    if files.is_empty() { Err(value.unexpected(EXPECTED, None)) } else { Ok(files) }
}

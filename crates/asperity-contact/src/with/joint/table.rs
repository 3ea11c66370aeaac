//! The table `[joint]`.

use serde::Serialize;

use asperity_base::table::cells;
use asperity_derive::Table;

/// The law of a joint of two rough surfaces under the loads of a sweep.
#[derive(Table, Debug, Clone, Copy, PartialEq, Serialize)]
#[table("joint")]
#[non_exhaustive]
pub struct JointLaw {
    /// Samples that `asperity joint` computes, each of generated surfaces from other seeds.
    #[key(count = 1, most = 10_000, absent = "1, or the number of patches", example = "8")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub samples: Option<usize>,
    /// Patches along x and y into which `asperity joint` cuts measured surfaces; each is a sample.
    #[key(special = cells, form = "`[nx, ny]`, each ≥ 1", absent = "the whole map", example = "[4, 4]")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub patches: Option<[usize; 2]>,
    /// Interval of the points of a sweep, or of the increments, that are computed; 0 for the last contact alone.
    #[key(count = 0, default = 1, example = "2")]
    pub every: usize,
}

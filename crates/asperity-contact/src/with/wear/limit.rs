//! The depth up to which a pass describes its wear.

use super::WEAR;
use crate::motion::PassRecord;
use crate::units::{Dimension, Metre, format};
use crate::with::ChangedSurfaces;

/// Returns the deepest wear of each body in one pass; that of a law in Python is known only as a mean.
pub(super) fn in_pass(pass: &PassRecord, surfaces: &ChangedSurfaces) -> [[Metre; 2]; 2] {
    let deepest =
        pass.running.map_or([0.0; 2], |running| [running.laws.max_wear_lower, running.laws.max_wear_upper]);
    let mean = pass.lost(WEAR);
    [0, 1].map(|body| {
        let depth = deepest[body].max(mean[body] / surfaces.area[body]) / pass.represents() as f64;
        [depth, surfaces.removal]
    })
}

pub(super) fn beyond(body: &str, depth: Metre, most: Metre) -> String {
    let [depth, most] = [depth, most].map(|value| format(value, Dimension::Length));
    format!(
        "the {body} body wears {depth} deep in one pass, and the contacts of a pass describe it up to {most}, the width of a cell or what \
         makes its waves steep: check the wear `coefficient`, or wear less in a pass"
    )
}

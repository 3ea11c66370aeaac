//! Elasto-plastic bodies of a case, as arguments of a contact.

use crate::case::Case;
use asperity_base::error::Result;
use asperity_contact::motion::{Pair, Stage};
use asperity_contact::plasticity::{PlasticBody, Volume};
use asperity_contact::with::plasticity::PlasticRegion;

/// Creates the elasto-plastic bodies of `case`, lower one first, under the surfaces of the `pair`.
pub(super) fn bodies(case: &Case, spec: &PlasticRegion, pair: &Pair) -> Result<[Option<PlasticBody>; 2]> {
    let grids = [pair.lower_grid(), pair.upper_grid()];
    let of_body = |index: usize| {
        let body = [&case.lower, &case.upper][index];
        let Some(flow) = &body.plasticity else { return Ok(None) };
        let volume = Volume::new(grids[index], spec.layers()?, case.contact.boundary, &body.material)?;
        Ok(Some(PlasticBody::new(volume, flow.law()?)))
    };
    Ok([of_body(0)?, of_body(1)?])
}

/// Returns the number of unloading steps after these `stages`, as many as those of the first one; `None` if
/// the load stays.
pub(super) fn unloading(region: &PlasticRegion, stages: &[Stage]) -> Option<usize> {
    let steps = stages.first().map_or(1, |stage| stage.increments);
    region.unload.unwrap_or(true).then_some(steps)
}

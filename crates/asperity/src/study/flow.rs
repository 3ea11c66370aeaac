//! What a case says of bodies that flow below their surfaces, as a contact takes it.

use std::sync::Arc;

use crate::error::Result;
use crate::motion::{FlowPath, Pair};
use crate::plasticity::{PlasticBody, Volume};
use crate::study::case::{Case, PlasticitySpec};
use crate::units::SquareMetre;

/// The bodies of `case` that flow, lower one first, under the surfaces of the `pair`.
pub(super) fn bodies(case: &Case, spec: &PlasticitySpec, pair: &Pair) -> Result<[Option<PlasticBody>; 2]> {
    let grids = [pair.lower_grid(), pair.upper_grid()];
    let of_body = |index: usize| {
        let body = [&case.lower, &case.upper][index];
        let Some(flow) = &body.plasticity else { return Ok(None) };
        let volume = Volume::new(grids[index], spec.layers()?, case.contact.boundary, &body.material)?;
        Ok(Some(PlasticBody::new(volume, Arc::new(flow.law()?))))
    };
    Ok([of_body(0)?, of_body(1)?])
}

/// How the bodies of `case` are pressed together on so large an apparent area.
pub(super) fn path(case: &Case, spec: &PlasticitySpec, apparent_area: SquareMetre) -> FlowPath {
    let mut control = case.contact.prescribed.control(apparent_area);
    let mut stages = vec![control];
    for stage in &case.history {
        if let Some(normal) = stage.normal {
            control = normal.control(apparent_area);
        }
        stages.push(control);
    }
    FlowPath::new(stages, spec.increments).with_unloading(spec.unload).with_flow(spec.params())
}

//! `[plasticity]`: elasto-plastic bodies, with what their volumes mean for motion and friction.

use super::cursor::Table;
use super::schema::tables::known_in;
use super::{FrictionSpec, MotionSpec};
use asperity_base::error::Result;
use asperity_base::table::Table as _;
use asperity_contact::motion::PlasticUpdate;
use asperity_contact::with::plasticity::{INCREMENTS, Keep, PlasticRegion};

/// `[plasticity]`, with its effect on the `motion` of the bodies and on their `friction`.
pub(super) fn plasticity(
    table: &Table<'_>,
    root: &Table<'_>,
    motion: &mut Option<MotionSpec>,
    friction: &mut Option<FrictionSpec>,
) -> Result<PlasticRegion> {
    known_in(table)?;
    let mut region = PlasticRegion::read(table)?;
    let at_rest = motion.is_none();
    let increments = region.increments.unwrap_or(INCREMENTS);
    if let Some(motion) = motion {
        // Plastic flow occurs at every position.
        motion.plastic_update = PlasticUpdate::Step;
    } else if let (Some(friction), Some(of_friction)) = (friction.as_mut(), root.table("friction")?)
        && of_friction.get("increments").is_none()
    {
        // The load is applied in the steps of the volume.
        friction.increments = increments;
    }
    region.increments = (at_rest && friction.is_none()).then_some(increments);
    region.unload = at_rest.then_some(region.unload.unwrap_or(true));
    region.keep = (!at_rest).then_some(region.keep.unwrap_or(Keep::Last));
    Ok(region)
}

//! `[plasticity]`: elasto-plastic bodies, with what their volumes mean for motion and friction.

use super::{FrictionSpec, MotionSpec};
use asperity_contact::motion::PlasticUpdate;
use asperity_contact::with::plasticity::{INCREMENTS, Keep, PlasticRegion};

/// Returns `[plasticity]` with its effect on the `motion` of the bodies and on their `friction`, whose table
/// may give the increments. The load is not taken off the points of a case that `sweeps`.
pub(super) fn plasticity(
    mut region: PlasticRegion,
    motion: &mut Option<MotionSpec>,
    friction: &mut Option<FrictionSpec>,
    gives_increments: bool,
    sweeps: bool,
) -> PlasticRegion {
    let at_rest = motion.is_none();
    let increments = region.increments.unwrap_or(INCREMENTS);
    if let Some(motion) = motion {
        // Plastic flow occurs at every position.
        motion.plastic_update = PlasticUpdate::Step;
    } else if let Some(friction) = friction.as_mut().filter(|_| !gives_increments) {
        // The load is applied in the steps of the volume.
        friction.increments = increments;
    }
    region.increments = (at_rest && friction.is_none()).then_some(increments);
    region.unload = (at_rest && !sweeps).then_some(region.unload.unwrap_or(true));
    region.keep = (!at_rest).then_some(region.keep.unwrap_or(Keep::Last));
    region
}

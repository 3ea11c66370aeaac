//! Wear in numbers, curves and maps.

use crate::motion::{FrettingRecord, PassRecord, UpdateRecord, WEAR};
use crate::units::{Dimension, format};
use crate::with::views::{Answer, Kept, KeptMap, OfBodies, PassCell};

pub(super) const KEPT: &[Kept] = &[Kept {
    state: WEAR,
    names: ["wear_lower", "wear_upper"],
    raises: -1.0,
    map: Some(KeptMap {
        title: "wear since the beginning",
        of_fresh: "wear of the lower body since the beginning, of the upper body in its pass",
        of_body: "Depth of wear of",
        quantity: "depth",
    }),
}];

pub(super) const CELL: PassCell = PassCell {
    head: "wear",
    column: "wear_volume_lower_interior",
    least: 1e-18,
    value: |pass| pass.lost_inside(WEAR).iter().sum(),
    adds_up: true,
    is_inside: true,
    about: "wear: both bodies, so far",
};

pub(super) const OF_PASSES: &[OfBodies<PassRecord>] = &[OfBodies {
    name: "wear volume",
    column: "wear_volume_lower",
    values: |pass| pass.lost(WEAR),
    adds_up: true,
}];

pub(super) const OF_UPDATES: &[OfBodies<UpdateRecord>] = &[OfBodies {
    name: "deepest wear",
    column: "max_wear_lower",
    values: |update| [update.max_wear_lower, update.max_wear_upper],
    adds_up: false,
}];

pub(super) const OF_CYCLES: &[OfBodies<FrettingRecord>] = &[
    OfBodies {
        name: "worn volume",
        column: "worn_volume_lower",
        values: |cycle| [cycle.worn_volume_lower, cycle.worn_volume_upper],
        adds_up: false,
    },
    OfBodies {
        name: "deepest wear",
        column: "max_wear_lower",
        values: |cycle| [cycle.max_wear_lower, cycle.max_wear_upper],
        adds_up: false,
    },
];

pub(super) fn after_passes(passes: &[PassRecord]) -> Option<Answer> {
    let worn: f64 = passes.iter().flat_map(|pass| pass.lost(WEAR)).sum();
    let value = format(worn, Dimension::Volume);
    (worn > 0.0).then(|| Answer {
        name: "wear",
        about: "Volume that both bodies have lost so far.".to_owned(),
        sentence: format!("Wear has taken {value} from the bodies."),
        value,
    })
}

pub(super) fn after_sliding(update: &UpdateRecord) -> Option<Answer> {
    let deepest = format(update.max_wear_lower.max(update.max_wear_upper), Dimension::Length);
    let distance = format(update.distance, Dimension::Length);
    Some(Answer {
        name: "deepest wear",
        about: format!("After {distance} of sliding."),
        sentence: format!("After {distance} of sliding the wear is up to {deepest} deep."),
        value: deepest,
    })
}

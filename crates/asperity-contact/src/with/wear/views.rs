//! Wear in numbers, curves and maps.

use super::WEAR;
use crate::motion::{FrettingRecord, PassRecord, UpdateRecord};
use crate::units::{CubicMetre, Dimension, Joule, Metre, format, format_number};
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
    name: "worn volume",
    column: "wear_volume_lower",
    values: |pass| pass.lost(WEAR),
    adds_up: true,
}];

pub(super) const OF_UPDATES: &[OfBodies<UpdateRecord>] = &[
    OfBodies {
        name: "worn volume",
        column: "wear_volume_lower",
        values: |update| update.lost(WEAR),
        adds_up: false,
    },
    OfBodies {
        name: "deepest wear",
        column: "max_wear_lower",
        values: |update| [update.laws.max_wear_lower, update.laws.max_wear_upper],
        adds_up: false,
    },
];

pub(super) const OF_CYCLES: &[OfBodies<FrettingRecord>] = &[
    OfBodies {
        name: "worn volume",
        column: "worn_volume_lower",
        values: |cycle| [cycle.laws.worn_volume_lower, cycle.laws.worn_volume_upper],
        adds_up: false,
    },
    OfBodies {
        name: "deepest wear",
        column: "max_wear_lower",
        values: |cycle| [cycle.laws.max_wear_lower, cycle.laws.max_wear_upper],
        adds_up: false,
    },
];

pub(super) fn after_passes(passes: &[PassRecord]) -> Option<Answer> {
    let worn: f64 = passes.iter().flat_map(|pass| pass.lost(WEAR)).sum();
    let running = passes.last()?.running;
    let deepest =
        running.map_or(0.0, |running| running.laws.deepest_wear_lower.max(running.laws.deepest_wear_upper));
    // A pass that stands for several counts as often.
    let represented = |pass: &PassRecord| pass.represents() as f64;
    let load = passes.iter().map(|pass| represented(pass) * pass.mean_load).sum::<f64>()
        / passes.iter().map(represented).sum::<f64>();
    let distance = running.map_or(f64::NAN, |running| running.distance);
    worn_off(worn, deepest, distance, load * distance)
}

pub(super) fn after_sliding(updates: &[UpdateRecord]) -> Option<Answer> {
    let last = updates.last()?;
    let worn: f64 = last.lost(WEAR).iter().sum();
    // Each update ends under its load, as its removal is solved for.
    let steps = updates.windows(2).map(|pair| pair[1].load * (pair[1].distance - pair[0].distance));
    let deepest = last.laws.max_wear_lower.max(last.laws.max_wear_upper);
    worn_off(worn, deepest, last.distance, steps.sum())
}

/// Returns what wear has taken off the bodies over a sliding `distance`, in which the load has done the
/// `work` ∫ W ds.
fn worn_off(worn: CubicMetre, deepest: Metre, distance: Metre, work: Joule) -> Option<Answer> {
    let value = format(worn, Dimension::Volume);
    let deep = if deepest > 0.0 {
        format!(", up to {} deep", format(deepest, Dimension::Length))
    } else {
        String::new()
    };
    let [about, sentence] = if distance > 0.0 && (worn / work).is_finite() {
        let over = format(distance, Dimension::Length);
        let [k, rate] = [format_number(1e9 * worn / work), per_metre(worn / distance)];
        let law = format!("{rate}, a coefficient of {k} mm³/(N m).");
        [
            format!("Of both bodies over {over}{deep}: {law}"),
            format!("Wear has taken {value} from the bodies over {over} of sliding{deep}: {law}"),
        ]
    } else {
        [
            format!("Volume that both bodies have lost so far{deep}."),
            format!("Wear has taken {value} from the bodies{deep}."),
        ]
    };
    (worn > 0.0).then(|| Answer { name: "wear".into(), about, sentence, value })
}

/// Writes a volume per distance.
fn per_metre(rate: f64) -> String {
    format!("{} µm³/m", format_number(1e18 * rate))
}

pub(super) fn after_cycles(cycles: &FrettingRecord) -> Option<Answer> {
    let worn = cycles.laws.worn_volume_lower + cycles.laws.worn_volume_upper;
    let deepest = cycles.laws.max_wear_lower.max(cycles.laws.max_wear_upper);
    let (value, deepest) = (format(worn, Dimension::Volume), format(deepest, Dimension::Length));
    let count = cycles.cycles;
    (worn > 0.0).then(|| Answer {
        name: "worn volume".into(),
        about: format!("Of both bodies, after {count} cycles; up to {deepest} deep."),
        sentence: format!("{count} cycles have worn {value} off the bodies, up to {deepest} deep."),
        value,
    })
}

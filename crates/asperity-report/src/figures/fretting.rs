//! The figure of bodies that change where they slip, over the cycles of a loading.

use asperity_contact::each;
use asperity_contact::motion::{FrettingRecord, IncrementRecord};
use asperity_contact::with::BodyLaw;

use super::{Curves, charts_over, of_law};
use crate::draw::{Axis, Mark, Series, Unit};

/// A computed cycle: its increments, and the bodies at its end.
struct Cycle<'a> {
    increments: &'a [IncrementRecord],
    end: &'a IncrementRecord,
    bodies: FrettingRecord,
}

/// The computed cycles of a loading.
fn cycles(increments: &[IncrementRecord]) -> Vec<Cycle<'_>> {
    let done = |increment: &IncrementRecord| increment.fretting.map_or(0, |fretting| fretting.cycles);
    let (mut found, mut begin, mut before) = (Vec::new(), 0, 0);
    for (index, end) in increments.iter().enumerate() {
        // A stage begins with a new cycle.
        if index > 0 && increments[index - 1].stage != end.stage {
            begin = index;
        }
        // The last increment of a cycle is the first one that counts it.
        if done(end) > before {
            let bodies = end.fretting.unwrap_or_default();
            found.push(Cycle { increments: &increments[begin..=index], end, bodies });
            (begin, before) = (index + 1, done(end));
        }
    }
    found
}

/// The increments whose loop is shown: all without cycles, else those before the cycles, the first computed
/// cycle and the last one.
pub(super) fn selected(increments: &[IncrementRecord]) -> Vec<IncrementRecord> {
    let cycles = cycles(increments);
    let [first, .., last] = &cycles[..] else { return increments.to_vec() };
    let until = first.increments.last().map_or(0, |last| last.increment);
    [&increments[..until], last.increments].concat()
}

/// The curves over the cycles; none without at least two computed ones.
pub(crate) fn curves(increments: &[IncrementRecord]) -> Option<Curves> {
    let cycles = cycles(increments);
    if cycles.len() < 2 {
        return None;
    }
    let over = |value: &dyn Fn(&Cycle<'_>) -> f64| -> Vec<[f64; 2]> {
        cycles.iter().map(|cycle| [cycle.bodies.cycles as f64, value(cycle)]).collect()
    };
    let alone = |value: &dyn Fn(&Cycle<'_>) -> f64| vec![Series::new("", over(value), Mark::LineAndPoints)];
    let loss = |cycle: &Cycle<'_>| cycle.increments.iter().map(|increment| increment.dissipation).sum();
    let mut shown = Vec::new();
    let bodies = cycles.iter().map(|cycle| &cycle.bodies);
    each!(law L => shown.extend(
        L::OF_CYCLES.iter().map(|shown| of_law(bodies.clone(), |cycle| Some(cycle.cycles as f64), shown))
    ));
    shown.extend([
        (Axis::of("energy of a cycle", "dissipation"), alone(&loss)),
        (Axis::of("largest pressure", "max_pressure"), alone(&|cycle| cycle.end.max_pressure)),
        (Axis::of("contact area", "contact_area"), alone(&|cycle| cycle.end.contact_area)),
    ]);
    let charts = charts_over(&Axis::linear("cycles", Unit::Count), shown);
    Some(Curves::new("fretting", "fretting over the cycles", charts))
}

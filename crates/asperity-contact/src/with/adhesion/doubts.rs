//! Reasons not to trust the results of bodies that attract each other.

use super::AdhesionSummary;
use crate::adhesion::{Adhesion, RESOLVED_CELLS};
use crate::grid::Field;
use crate::motion::{IncrementRecord, PassRecord};
use crate::operator::Boundary;
use crate::units::{Dimension, Metre, Pascal, format};

/// Returns the warning about a grid that does not resolve the attraction.
pub(super) fn unresolved(
    numbers: &AdhesionSummary,
    adhesion: &Adhesion,
    modulus: Pascal,
    pitch: Metre,
) -> Option<String> {
    let length = |value| format(value, Dimension::Length);
    (numbers.process_zone_cells < 0.999 * RESOLVED_CELLS).then(|| {
        format!(
            "the grid does not resolve the adhesion: the process zone at the edge of a contact is {}, {:.2} cells, and pull-off \
             needs {RESOLVED_CELLS}; take a pitch of {}, or `range = \"grid\"`, which is {}",
            length(numbers.process_zone),
            numbers.process_zone_cells,
            length(numbers.process_zone / RESOLVED_CELLS),
            length(Adhesion::grid_range(adhesion.work, modulus, pitch))
        )
    })
}

/// Returns the warning about a free side of the grid that cuts off the attraction of bodies that are
/// `curved`, from their `pressure`, which is negative under tension.
pub(in crate::with) fn cut_off(
    pressure: &Field,
    boundary: Boundary,
    curved: impl FnOnce() -> bool,
) -> Option<String> {
    /// Largest share of the adhesive load in the outermost cells without a warning.
    const FELT: f64 = 0.01;
    let tension = pressure.mapv(|pressure| (-pressure).max(0.0));
    let share = boundary.outermost(&tension) / tension.sum();
    (share > FELT && curved()).then(|| {
        format!(
            "the rim of the grid cuts the attraction off: the outermost cells have {:.1} % of the adhesive load; take a larger grid",
            100.0 * share
        )
    })
}

/// Returns the warning about jumps of a loading.
pub(in crate::with) fn jumped(increments: &[IncrementRecord]) -> Option<String> {
    let jumps = |increment: &&IncrementRecord| increment.interface.is_some_and(|record| record.jumps > 0);
    let jumps: Vec<_> = increments.iter().filter(jumps).collect();
    let first = jumps.first()?;
    Some(format!(
        "the bodies jump in {} of {} increments, first in increment {}: the energy lost there depends on the increments; take more of \
         them",
        jumps.len(),
        increments.len(),
        first.increment
    ))
}

/// Returns the warning about positions that depend on the one before.
pub(in crate::with) fn depends_on_history(passes: &[PassRecord]) -> Option<String> {
    /// Largest change of the load of a position, relative to the mean, without a warning.
    const INDEPENDENT: f64 = 0.01;
    let of_pass = |pass: &PassRecord| pass.interface.map_or(0.0, |record| record.history_difference);
    let largest = passes.iter().map(of_pass).fold(0.0, f64::max);
    (largest > INDEPENDENT).then(|| {
        format!(
            "the load of a position changes by {:.1} % if the bodies come from the position before: contacts jump, and depend on the \
             path; set `history = \"path\"` in [adhesion] of a shift",
            100.0 * largest
        )
    })
}

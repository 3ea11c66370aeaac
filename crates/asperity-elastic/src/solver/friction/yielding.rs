//! Combined stress of plastic cells: the caps of their pressure under shear, and the limits of their shear.

use crate::grid::{CellValues, Field};
use crate::solver::Bounds;
use crate::solver::friction::Friction;

/// Computes the bounds of a `pressure` under a `shear` with junction growth, by [`Friction::cap`] from the
/// bounds `unsheared` of cells without shear.
pub(super) fn bounds_under_shear(
    friction: &Friction,
    unsheared: &Bounds,
    pressure: &Field,
    shear: &[Field; 2],
) -> Bounds {
    let mut upper = pressure.clone();
    let cells = upper.iter_mut().zip(&shear[0]).zip(&shear[1]).enumerate();
    for (cell, ((p, x), y)) in cells {
        let hardness = unsheared.upper().value(cell);
        *p = friction.within(hardness).cap(hardness, *p, x.hypot(*y));
    }
    Bounds::up_to(upper).above(unsheared.lower().clone())
}

/// Computes a start for the `next` bounds from a pressure within the last `bounds`. Capped cells move to
/// their new upper bounds.
pub(super) fn start_within(pressure: &Field, bounds: &Bounds, next: &Bounds) -> Field {
    let mut start = pressure.clone();
    for (cell, p) in start.iter_mut().enumerate() {
        if bounds.caps(cell, *p) {
            *p = next.upper().value(cell);
        }
    }
    start
}

/// Computes the largest shear of each cell under its pressure. With junction growth (`grows_junctions`) it is
/// at most the shear limit of a cell of this `hardness` without pressure.
pub(super) fn shear_limits(
    friction: &Friction,
    hardness: &CellValues,
    grows_junctions: bool,
    pressure: &Field,
) -> Field {
    let mut limits = pressure.clone();
    for (cell, p) in limits.iter_mut().enumerate() {
        let friction = if grows_junctions { friction.within(hardness.value(cell)) } else { *friction };
        *p = friction.shear_limit(*p);
    }
    limits
}

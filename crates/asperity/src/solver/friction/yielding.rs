//! What the shear of a yielding cell leaves to its pressure.

use crate::grid::{CellValues, Field};
use crate::solver::Bounds;
use crate::solver::friction::Friction;

/// The bounds that the `shear` leaves to the `pressure` of cells with the `virgin` ones: see [`Friction::cap`].
pub(super) fn bounds_beside(
    friction: &Friction,
    virgin: &Bounds,
    pressure: &Field,
    shear: &[Field; 2],
) -> Bounds {
    let mut upper = pressure.clone();
    let cells = upper.iter_mut().zip(&shear[0]).zip(&shear[1]).enumerate();
    for (cell, ((p, x), y)) in cells {
        let hardness = virgin.upper().at(cell);
        *p = friction.within(hardness).cap(hardness, *p, x.hypot(*y));
    }
    Bounds::up_to(upper).above(virgin.lower().clone())
}

/// A pressure near the answer within the `next` bounds: the cells that are capped by these `bounds` go along with them.
pub(super) fn carried(pressure: &Field, bounds: &Bounds, next: &Bounds) -> Field {
    let mut carried = pressure.clone();
    for (cell, p) in carried.iter_mut().enumerate() {
        if bounds.caps(cell, *p) {
            *p = next.upper().at(cell);
        }
    }
    carried
}

/// The most shear that each cell bears under its pressure. Where the shear `softens` it is no more than the cell bears
/// without pressure.
pub(super) fn shear_limits(
    friction: &Friction,
    virgin: &CellValues,
    softens: bool,
    pressure: &Field,
) -> Field {
    let mut limits = pressure.clone();
    for (cell, p) in limits.iter_mut().enumerate() {
        let friction = if softens { friction.within(virgin.at(cell)) } else { *friction };
        *p = friction.shear_limit(*p);
    }
    limits
}

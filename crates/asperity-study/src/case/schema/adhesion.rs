//! The keys of `[adhesion]`.

use super::super::exists;
use super::Bounds::AboveZero;
use super::typed::{Typed, choice, defaulted, other, quantity, required, section};
use crate::case::schema::values::adhesion::{self as read, AdhesionRange};
use asperity_base::units::Dimension;
use asperity_contact::adhesion::Potential;
use asperity_contact::motion::AdhesionHistory;

section! { &["adhesion"], "";
    WORK: Typed<f64> = required(
        "work",
        quantity(Dimension::SurfaceEnergy, AboveZero).exists(exists::ADHESION),
        "\"50 mJ/m2\"",
        "work of adhesion: the energy that separates an area of flat surfaces",
    );
    RANGE: Typed<AdhesionRange> = required(
        "range",
        other(Some(Dimension::Length), "length > 0, or `\"grid\"`: the shortest range that the grid resolves", |_, entry| {
            read::range(entry)
        })
        .exists(exists::ATTRACTION),
        "\"2 nm\"",
        "range of the attraction, the gap at which the exponential tension has fallen to 1/e",
    );
    POTENTIAL: Typed<Potential> = defaulted(
        "potential",
        choice::<Potential>(),
        "\"exponential\"",
        "\"dugdale\"",
        "tension as a function of the gap: `\"exponential\"`, or constant up to the range, for comparison with closed forms",
    );
    HISTORY: Typed<AdhesionHistory> = defaulted(
        "history",
        choice::<AdhesionHistory>(),
        "\"none\"",
        "\"path\"",
        "in a motion: `\"none\"`, the bodies come from afar at each position; `\"path\"`, in a shift, from the position before, so that jumps \
         lose energy",
    );
}

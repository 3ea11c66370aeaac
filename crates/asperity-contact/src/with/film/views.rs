//! Films in numbers, curves and maps.

use super::{FILM, GROWN};
use crate::motion::{FrettingRecord, PassRecord, UpdateRecord};
use crate::with::views::{Kept, KeptMap, OfBodies, PassCell};

pub(super) const KEPT: &[Kept] = &[
    Kept {
        state: FILM,
        names: ["film_lower", "film_upper"],
        raises: 1.0,
        map: Some(KeptMap {
            title: "tribofilm",
            of_fresh: "tribofilm",
            of_body: "Thickness of the film on",
            quantity: "thickness",
        }),
    },
    Kept { state: GROWN, names: ["film_grown_lower", "film_grown_upper"], raises: 0.0, map: None },
];

pub(super) const CELL: PassCell = PassCell {
    head: "film",
    column: "mean_film_lower",
    least: 1e-9,
    value: |pass| {
        pass.running.map_or(0.0, |running| running.laws.mean_film_lower.max(running.laws.mean_film_upper))
    },
    adds_up: false,
    is_inside: false,
    about: "film: mean of the thicker",
};

pub(super) const OF_PASSES: &[OfBodies<PassRecord>] = &[OfBodies {
    name: "mean film",
    column: "mean_film_lower",
    values: |pass| {
        pass.running.map_or([0.0; 2], |running| [running.laws.mean_film_lower, running.laws.mean_film_upper])
    },
    adds_up: false,
}];

pub(super) const OF_UPDATES: &[OfBodies<UpdateRecord>] = &[OfBodies {
    name: "mean film in contact",
    column: "mean_film_lower",
    values: |update| [update.laws.mean_film_lower, update.laws.mean_film_upper],
    adds_up: false,
}];

pub(super) const OF_CYCLES: &[OfBodies<FrettingRecord>] = &[OfBodies {
    name: "thickest film",
    column: "max_film_lower",
    values: |cycle| [cycle.laws.max_film_lower, cycle.laws.max_film_upper],
    adds_up: false,
}];

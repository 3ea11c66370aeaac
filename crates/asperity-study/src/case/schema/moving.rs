//! Keys of moving bodies.

use super::Bounds::{AboveZero, Any, FromZero};
use super::Exists;
use super::typed::{
    FRACTION, Optional, SEED, Typed, Value, choice, count, defaulted, optional, other, quantity, section,
};
use asperity_base::exists;

use asperity_base::units::Dimension;

const SPEED: Value<f64> = quantity(Dimension::Speed, AboveZero).exists(exists::SPEED);

/// `[motion]`.
pub(crate) mod motion {
    use super::*;
    use crate::case::schema::values::motion as read;
    use crate::case::{ControlKind, CounterBody, StrategyKind};
    use asperity_contact::motion::{Path, PlasticUpdate};

    const SIGNED_SPEED: Value<f64> = quantity(Dimension::Speed, Any).exists(exists::SPEED);

    section! { &["motion"], "";
        STRATEGY: Typed<StrategyKind> = defaulted(
            "strategy",
            choice::<StrategyKind>(),
            "\"overlap\"",
            "\"shift\"",
            "`\"overlap\"`: the upper body enters on the left, passes over the lower one and leaves on the right; only the overlap is \
             solved. `\"shift\"`: both bodies are shifted cyclically and the full contact is solved",
        );
        PASSES: Typed<usize> = defaulted("passes", count(1), "1", "5", "number of passes");
        STRIDE: Typed<usize> = defaulted("stride", count(1), "1", "4", "cells from one position to the next");
        CONTROL: Optional<ControlKind> = optional(
            "control",
            choice::<ControlKind>(),
            "`\"pass-load\"`; `\"approach\"` if [contact] gives an approach",
            "\"step-load\"",
            "prescribed quantity. `\"pass-load\"`: the mean load of a pass, with one approach for the pass; `\"step-load\"`: the load at \
             each position; `\"approach\"`: the approach at all positions",
        );
        PLASTIC_UPDATE: Typed<PlasticUpdate> = defaulted(
            "plastic_update",
            choice::<PlasticUpdate>(),
            "\"pass\"",
            "\"step\"",
            "when plastic deformation changes the surfaces: after each pass, or at every step; for elasto-plastic bodies always \
             `\"step\"`",
        );
        LOAD_TOLERANCE: Typed<f64> =
            defaulted("load_tolerance", FRACTION, "1e-4", "1e-6", "relative tolerance of the mean load of a pass");
        SPEED_LOWER: Typed<f64> = defaulted(
            "speed_lower",
            SIGNED_SPEED,
            "0",
            "\"0.3 m/s\"",
            "`\"shift\"` only: speed of the lower surface along x; apart from times, only the ratio of the speeds matters",
        );
        SPEED_UPPER: Typed<f64> = defaulted(
            "speed_upper",
            SIGNED_SPEED,
            "\"1 m/s\"",
            "\"0.5 m/s\"",
            "`\"shift\"` only: speed of the upper surface along x; at most one speed may be 0",
        );
        SPEED: Optional<f64> = optional(
            "speed",
            super::SPEED,
            "unknown",
            "\"0.5 m/s\"",
            "`\"overlap\"` only: speed of the upper body; required for growing films, temperature and viscoelastic bodies",
        );
        PAUSE: Typed<f64> = defaulted(
            "pause",
            quantity(Dimension::Time, FromZero).exists(Exists::Any("a pause of any time")),
            "0",
            "\"10 s\"",
            "viscoelastic bodies only: time for which they are apart between two passes; without it the passes of a shift follow each other in contact",
        );
        PATH: Typed<Path> = defaulted(
            "path",
            choice::<Path>(),
            "\"one-way\"",
            "\"reciprocating\"",
            "`\"reciprocating\"`: a pass goes forth and back",
        );
        OFFSET_Y: Typed<Option<usize>> = defaulted(
            "offset_y",
            other(None, "whole number ≥ 0, or `\"random\"`", |_, entry| read::offset(entry)),
            "0",
            "\"random\"",
            "shift of the upper body along y from pass to pass, in cells; `\"random\"`: a random position, from `seed` and the \
             number of the pass",
        );
        SEED: Typed<u64> = defaulted("seed", super::SEED, "0", "7", "seed of `offset_y = \"random\"`");
        COUNTER: Typed<CounterBody> = defaulted(
            "counter",
            choice::<CounterBody>(),
            "\"same\"",
            "\"fresh\"",
            "upper body in the passes after the first: the same, or a fresh one, generated and prepared in the same way from another \
             seed",
        );
    }
}

//! The keys of bodies that move.

use super::Bounds::{AboveZero, Any};
use super::typed::{
    FRACTION, LENGTH, Optional, SEED, Typed, Value, choice, count, defaulted, optional, other, quantity,
    required, section,
};
use crate::units::Dimension;

const SPEED: Value<f64> = quantity(Dimension::Speed, AboveZero);

/// `[motion]`.
pub(in crate::study) mod motion {
    use super::*;
    use crate::motion::{Path, PlasticUpdate};
    use crate::study::case::schema::values::motion as read;
    use crate::study::case::{ControlKind, CounterBody, StrategyKind};

    const SIGNED_SPEED: Value<f64> = quantity(Dimension::Speed, Any);

    section! { &["motion"], "";
        STRATEGY: Typed<StrategyKind> = defaulted(
            "strategy",
            choice::<StrategyKind>(),
            "\"overlap\"",
            "\"shift\"",
            "`\"overlap\"`: the upper body enters on the left, passes over and leaves on the right, and only the overlap is solved; \
             `\"shift\"`: both are shifted circularly and the full contact is solved",
        );
        PASSES: Typed<usize> = defaulted("passes", count(1), "1", "5", "number of passes");
        STRIDE: Typed<usize> = defaulted("stride", count(1), "1", "4", "cells from one position to the next");
        CONTROL: Optional<ControlKind> = optional(
            "control",
            choice::<ControlKind>(),
            "`\"pass-load\"`; `\"approach\"` where [contact] gives one",
            "\"step-load\"",
            "`\"pass-load\"`: one approach for a pass, found so that the mean load is the one prescribed; `\"step-load\"`: the load at \
             each position; `\"approach\"`: the approach throughout",
        );
        PLASTIC_UPDATE: Typed<PlasticUpdate> = defaulted(
            "plastic_update",
            choice::<PlasticUpdate>(),
            "\"pass\"",
            "\"step\"",
            "when plastic deformation changes the surfaces: after each pass, or at every step; of bodies with a plasticity always \
             `\"step\"`",
        );
        LOAD_TOLERANCE: Typed<f64> =
            defaulted("load_tolerance", FRACTION, "1e-4", "1e-6", "relative, on the mean load of a pass");
        SPEED_LOWER: Typed<f64> = defaulted(
            "speed_lower",
            SIGNED_SPEED,
            "0",
            "\"0.3 m/s\"",
            "`\"shift\"` only: speed of the lower surface along x; but for time, only the ratio of the speeds matters",
        );
        SPEED_UPPER: Typed<f64> = defaulted(
            "speed_upper",
            SIGNED_SPEED,
            "\"1 m/s\"",
            "\"0.5 m/s\"",
            "`\"shift\"` only: speed of the upper surface along x; not both speeds are 0",
        );
        SPEED: Optional<f64> = optional(
            "speed",
            super::SPEED,
            "not known",
            "\"0.5 m/s\"",
            "`\"overlap\"` only: speed of the upper body; needed where bodies wear, grow films or are heated",
        );
        PATH: Typed<Path> = defaulted(
            "path",
            choice::<Path>(),
            "\"one-way\"",
            "\"reciprocating\"",
            "`\"reciprocating\"`: a pass is forth and back",
        );
        OFFSET_Y: Typed<Option<usize>> = defaulted(
            "offset_y",
            other(None, "whole number ≥ 0, or `\"random\"`", |_, entry| read::offset(entry)),
            "0",
            "\"random\"",
            "cells by which the upper body lies further along y in each pass than in the one before; `\"random\"`: anywhere, drawn \
             from `seed` and the number of the pass",
        );
        SEED: Typed<u64> = defaulted("seed", super::SEED, "0", "7", "seed of `offset_y = \"random\"`");
        COUNTER: Typed<CounterBody> = defaulted(
            "counter",
            choice::<CounterBody>(),
            "\"same\"",
            "\"fresh\"",
            "the upper body in the passes after the first: the same, or a fresh one, generated and prepared as the first but from a \
             seed of its own",
        );
    }
}

/// `[sliding]`.
pub(in crate::study) mod sliding {
    use super::*;

    section! { &["sliding"], "";
        DISTANCE: Typed<f64> = required("distance", LENGTH, "\"640 mm\"", "the distance slid");
        SPEED: Optional<f64> = optional(
            "speed",
            super::SPEED,
            "not known",
            "\"10 mm/s\"",
            "speed of the upper body; needed where films grow or bodies are heated",
        );
        UPDATES: Typed<usize> = defaulted(
            "updates",
            count(1),
            "40",
            "80",
            "implicit updates, each a contact solved on the bodies as it leaves them; the i-th of n ends at the distance · (i/n)²",
        );
    }
}

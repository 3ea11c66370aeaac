//! The keys of bodies that deform plastically below their surfaces.

use super::Bounds::{Between, FromZero};
use super::typed::{
    FLAG, FRACTION, LENGTH, Optional, PRESSURE, Typed, Value, choice, count, count_to, defaulted, number,
    optional, other, quantity, required, section,
};
use super::values::plasticity as read;
use crate::units::{Dimension, Pascal};

const MODULUS: Value<f64> = quantity(Dimension::Pressure, FromZero);
const ONE: &str = "exactly one of `yield_stress` and `curve`";

/// `[lower.plasticity]` and `[upper.plasticity]`.
pub(in crate::study) mod flow {
    use super::*;

    section! { &["lower.plasticity", "upper.plasticity"], "";
        YIELD_STRESS: Optional<f64> =
            optional("yield_stress", PRESSURE, ONE, "\"1.5 GPa\"", "yield stress in tension σ_Y of the virgin body");
        HARDENING: Typed<f64> = defaulted(
            "hardening",
            MODULUS,
            "0",
            "\"20 GPa\"",
            "growth of the yield stress with the plastic strain, E·Eₜ/(E − Eₜ) of a tangent modulus Eₜ; with `yield_stress`",
        );
        CURVE: Optional<Vec<(f64, Pascal)>> = optional(
            "curve",
            other(None, "list of points `[strain, stress]`", |_, entry| read::curve(entry)),
            ONE,
            "[[0, \"1.5 GPa\"], [0.01, \"1.7 GPa\"]]",
            "points of plastic strain and yield stress, from strain 0 on, rising; level beyond the last",
        );
        KINEMATIC: Typed<f64> =
            defaulted("kinematic", MODULUS, "0", "\"20 GPa\"", "Prager's modulus M of the back stress, ⅔Mε");
        RECOVERY: Typed<f64> = defaulted(
            "recovery",
            number(FromZero),
            "0",
            "50",
            "Armstrong's and Frederick's recovery of the back stress; with `kinematic`",
        );
    }
}

/// `[plasticity]`.
pub(in crate::study) mod volume {
    use super::*;

    section! { &["plasticity"], "";
        DEPTH: Typed<f64> = required(
            "depth",
            LENGTH,
            "\"20 um\"",
            "depth of the volume that may deform plastically, from a cell to the smaller side of the grid; take 2.5 radii of the largest spot",
        );
        LAYERS: Typed<usize> = required("layers", count_to(1, 512), "16", "number of its layers");
        GROWTH: Typed<f64> = defaulted(
            "growth",
            number(Between { least: 1.0, most: 2.0, open: [false, false] }),
            "1",
            "1.2",
            "ratio of the thickness of a layer to that of the layer above",
        );
        INCREMENTS: Typed<usize> = defaulted(
            "increments",
            count(1),
            "16",
            "32",
            "static: equal steps of the loading in [contact], of each [[history]] without its own number, and of the unloading",
        );
        TOLERANCE: Typed<f64> = defaulted(
            "tolerance",
            FRACTION,
            "1e-4",
            "1e-5",
            "return-mapping residual over the yield stress at which a step ends",
        );
        UNLOAD: Typed<bool> =
            defaulted("unload", FLAG, "true", "false", "static: whether the contact is unloaded at the end");
        KEEP: Typed<read::Keep> = defaulted(
            "keep",
            choice::<read::Keep>(),
            "\"last\"",
            "\"passes\"",
            "in a [motion]: whether the volumes of the last pass or of all passes are kept",
        );
    }
}

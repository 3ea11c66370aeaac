//! Keys of elasto-plastic bodies.

use super::super::exists;
use super::Bounds::{Between, FromZero};
use super::typed::{
    FLAG, FRACTION, LENGTH, Optional, PRESSURE, Typed, Value, choice, count, count_to, defaulted, number,
    optional, other, quantity, required, section,
};
use super::values::plasticity as read;
use asperity_base::units::{Dimension, Pascal};

const MODULUS: Value<f64> = quantity(Dimension::Pressure, FromZero).exists(exists::HARDENING);
const ONE: &str = "exactly one of `yield_stress` and `curve`";

/// `[lower.plasticity]` and `[upper.plasticity]`.
pub(crate) mod body {
    use super::*;

    section! { &["lower.plasticity", "upper.plasticity"], "";
        YIELD_STRESS: Optional<f64> =
            optional("yield_stress", PRESSURE.exists(exists::YIELD), ONE, "\"1.5 GPa\"", "yield stress in tension σ_Y of the virgin body");
        HARDENING: Typed<f64> = defaulted(
            "hardening",
            MODULUS,
            "0",
            "\"20 GPa\"",
            "increase of the yield stress per plastic strain, E·Eₜ/(E − Eₜ) for a tangent modulus Eₜ; with `yield_stress`",
        );
        CURVE: Optional<Vec<(f64, Pascal)>> = optional(
            "curve",
            other(None, "list of points `[strain, stress]`", |_, entry| read::curve(entry)),
            ONE,
            "[[0, \"1.5 GPa\"], [0.01, \"1.7 GPa\"]]",
            "increasing points of plastic strain and yield stress, from strain 0; constant beyond the last",
        );
        KINEMATIC: Typed<f64> =
            defaulted("kinematic", MODULUS, "0", "\"20 GPa\"", "Prager's modulus M of the back stress, ⅔Mε");
        RECOVERY: Typed<f64> = defaulted(
            "recovery",
            number(FromZero),
            "0",
            "50",
            "Armstrong–Frederick recovery of the back stress; with `kinematic`",
        );
    }
}

/// `[plasticity]`.
pub(crate) mod volume {
    use super::*;

    section! { &["plasticity"], "";
        DEPTH: Typed<f64> = required(
            "depth",
            LENGTH,
            "\"20 um\"",
            "depth of the volume that may deform plastically, from one cell to the smaller side of the grid; 2.5 radii of the largest spot are enough",
        );
        LAYERS: Typed<usize> = required("layers", count_to(1, 512), "16", "number of layers");
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
            "static: equal steps of the loading in [contact], of each [[history]] stage without its own number, and of the unloading",
        );
        TOLERANCE: Typed<f64> = defaulted(
            "tolerance",
            FRACTION,
            "1e-4",
            "1e-5",
            "return-mapping residual over the yield stress at which an increment has converged",
        );
        UNLOAD: Typed<bool> =
            defaulted("unload", FLAG, "true", "false", "static: whether the contact is unloaded at the end");
        KEEP: Typed<read::Keep> = defaulted(
            "keep",
            choice::<read::Keep>(),
            "\"last\"",
            "\"passes\"",
            "[motion] only: whether the volumes of the last pass or of all passes are stored",
        );
    }
}

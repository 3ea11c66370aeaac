//! Keys of stresses below the surface and of stored results.

use super::Bounds::Between;
use super::exists;
use super::typed::{
    DEPTH, FLAG, LENGTH, Optional, Typed, choice, count, count_to, defaulted, number_named, optional, other,
    required, section,
};
use asperity_base::units::{Dimension, Metre};

/// `[subsurface]`.
pub(crate) mod subsurface {
    use super::*;
    use crate::case::schema::values::subsurface as read;

    section! { &["subsurface"], "";
        TO: Typed<f64> = required(
            "to",
            LENGTH,
            "\"20 um\"",
            "deepest plane; the largest stress of a contact spot lies at about a quarter of its width",
        );
        LAYERS: Typed<usize> =
            defaulted("layers", count_to(1, 10_000), "40", "20", "steps from the surface to `to`");
        BODY: Typed<read::Side> = defaulted(
            "body",
            choice::<read::Side>(),
            "\"lower\"",
            "\"upper\"",
            "body, with its own Poisson's ratio",
        );
        PLANES: Optional<Vec<Metre>> = optional(
            "planes",
            other(Some(Dimension::Length), "list of lengths ≥ 0", |_, entry| read::depths(entry))
                .exists(exists::LENGTH),
            "none",
            "[\"1 um\", \"5 um\"]",
            "depths at which von Mises' stress is stored on the whole plane",
        );
        SECTION_Y: Optional<Metre> = optional(
            "section",
            DEPTH,
            "the most stressed point",
            "\"20 um\"",
            "y of the section along x on which the stress is stored, in the contact",
        );
        COLUMNS: Optional<Vec<[Metre; 2]>> = optional(
            "columns",
            other(Some(Dimension::Length), "list of `[x, y]`, lengths ≥ 0", |_, entry| read::positions(entry))
                .exists(exists::LENGTH),
            "none",
            "[[\"5 um\", \"10 um\"]]",
            "positions in the contact below which the stress is stored",
        );
        STEP: Optional<usize> = optional(
            "step",
            count(1),
            "the position with aligned left edges",
            "3",
            "[motion] only: position of each pass at which the stress is computed",
        );
    }
}

/// `[output]`.
pub(crate) mod output {
    use super::*;

    section! { &["output"], "";
        PRESSURE_EVERY: Typed<usize> = defaulted(
            "pressure_every",
            count(0),
            "8",
            "4",
            "stores the pressure of every n-th position of a pass, or pressure and gap of every n-th point of a sweep, from the \
             first on; 0: none",
        );
        RIM: Typed<f64> = defaulted(
            "rim",
            number_named("a part of the length", Between { least: 0.0, most: 0.5, open: [false, true] }),
            "0.1",
            "0.2",
            "part of a body's length, at its free ends, that the columns `…_interior` of the tables [leave out](results.md#passescsv)",
        );
        PARAVIEW: Typed<bool> = defaulted(
            "paraview",
            FLAG,
            "false",
            "true",
            "whether all fields, and the stress below the surface as a volume, are also written as VTK image data (`.vti`); see \
             [results](results.md#for-paraview)",
        );
    }
}

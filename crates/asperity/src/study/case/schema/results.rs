//! The keys of what is looked at and kept.

use super::Bounds::Between;
use super::typed::{
    DEPTH, FLAG, LENGTH, Optional, Typed, choice, count, count_to, defaulted, number_named, optional, other,
    required, section,
};
use crate::units::{Dimension, Metre};

/// `[subsurface]`.
pub(in crate::study) mod subsurface {
    use super::*;
    use crate::study::case::schema::values::subsurface as read;

    section! { &["subsurface"], "";
        TO: Typed<f64> = required(
            "to",
            LENGTH,
            "\"20 um\"",
            "the deepest plane; a contact spot is stressed the most at about a quarter of its width",
        );
        LAYERS: Typed<usize> =
            defaulted("layers", count_to(1, 10_000), "40", "20", "steps from the surface to `to`");
        BODY: Typed<read::Side> = defaulted(
            "body",
            choice::<read::Side>(),
            "\"lower\"",
            "\"upper\"",
            "the body that is looked into, with its own Poisson's ratio",
        );
        PLANES: Optional<Vec<Metre>> = optional(
            "planes",
            other(Some(Dimension::Length), "list of lengths ≥ 0", |_, entry| read::depths(entry)),
            "none",
            "[\"1 um\", \"5 um\"]",
            "depths at which von Mises' stress is kept on the whole plane",
        );
        SECTION_Y: Optional<Metre> = optional(
            "section",
            DEPTH,
            "through the most stressed point",
            "\"20 um\"",
            "y of the section along x on which the stress is kept, on the contact",
        );
        COLUMNS: Optional<Vec<[Metre; 2]>> = optional(
            "columns",
            other(Some(Dimension::Length), "list of `[x, y]`, lengths ≥ 0", |_, entry| read::positions(entry)),
            "none",
            "[[\"5 um\", \"10 um\"]]",
            "positions on the contact below which the stress is kept",
        );
        STEP: Optional<usize> = optional(
            "step",
            count(1),
            "that at which the left edges are flush",
            "3",
            "with [motion]: the position of each pass that is looked at",
        );
    }
}

/// `[output]`.
pub(in crate::study) mod output {
    use super::*;

    section! { &["output"], "";
        PRESSURE_EVERY: Typed<usize> = defaulted(
            "pressure_every",
            count(0),
            "8",
            "4",
            "the pressure field of every n-th position of a pass is kept, pressure and gap of every n-th point of a sweep, from the \
             first on; 0: none",
        );
        RIM: Typed<f64> = defaulted(
            "rim",
            number_named("a part of the length", Between { least: 0.0, most: 0.5, open: [false, true] }),
            "0.1",
            "0.2",
            "the part of a body's length at its free ends that the columns `…_interior` of the tables [leave out](results.md#passescsv)",
        );
        PARAVIEW: Typed<bool> = defaulted(
            "paraview",
            FLAG,
            "false",
            "true",
            "whether all fields, and the stress under the surface as a volume, are also written as VTK image data (`.vti`); see \
             [results](results.md#for-paraview)",
        );
    }
}

//! Keys of stresses below the surface.

use super::super::exists;
use super::typed::{
    DEPTH, LENGTH, Optional, Typed, choice, count, count_to, defaulted, optional, other, required, section,
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

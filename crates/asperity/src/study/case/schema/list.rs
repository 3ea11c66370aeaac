//! Keys of a table that replaces a list of values.

use super::typed::{Optional, Typed, Value, choice as word, count_to, optional, other, required, section};
use crate::choice::choice;

/// Spacing of the values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::study) enum Spacing {
    Log,
    Linear,
}

choice!(Spacing: "log" => Log, "linear" => Linear);

const END: Value<()> = other(None, "as for the key in the singular", |_, _| Ok(()));

section! { &["contact.loads", "contact.mean_pressures", "contact.approaches", "friction.creepages"], "";
    FROM: Typed<()> = required("from", END, "\"10 mN\"", "first value");
    TO: Typed<()> = required("to", END, "\"10 N\"", "last value, larger or smaller than the first");
    POINTS: Typed<usize> =
        required("points", count_to(2, 10_000), "9", "number of values");
    SPACING: Optional<Spacing> = optional(
        "spacing",
        word::<Spacing>(),
        "`\"log\"`; `\"linear\"` for `approaches` and `creepages`",
        "\"linear\"",
        "`\"log\"`: equal ratios, for values above 0; `\"linear\"`: equal steps",
    );
}

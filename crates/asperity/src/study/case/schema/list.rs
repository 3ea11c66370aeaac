//! The keys of a table of values that are passed through, which stands in place of a list.

use super::typed::{Optional, Typed, Value, choice as word, count_to, optional, other, required, section};
use crate::choice::choice;

/// How values follow on each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::study) enum Spacing {
    Log,
    Linear,
}

choice!(Spacing: "log" => Log, "linear" => Linear);

const END: Value<()> = other(None, "as of the key in the singular", |_, _| Ok(()));

section! { &["contact.loads", "contact.mean_pressures", "contact.approaches", "friction.creepages"], "";
    FROM: Typed<()> = required("from", END, "\"10 mN\"", "first value");
    TO: Typed<()> = required("to", END, "\"10 N\"", "last value, larger or smaller than the first");
    POINTS: Typed<usize> =
        required("points", count_to(2, 10_000), "9", "number of values");
    SPACING: Optional<Spacing> = optional(
        "spacing",
        word::<Spacing>(),
        "`\"log\"`; of `approaches` and `creepages` `\"linear\"`",
        "\"linear\"",
        "`\"log\"`: in equal ratios, of values above 0; `\"linear\"`: in equal steps",
    );
}

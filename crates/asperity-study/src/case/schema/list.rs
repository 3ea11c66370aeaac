//! Keys of a table that replaces a list of values.

use super::super::cursor::Table;
use super::typed::{Optional, Typed, Value, choice as word, count_to, optional, other, required, section};
use asperity_base::choice::choice;
use asperity_base::error::Result;

/// Spacing of the values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Spacing {
    Log,
    Linear,
}

choice!(Spacing: "log" => Log, "linear" => Linear);

const END: Value<()> = other(None, "as for the key in the singular", |_, _| Ok(()));

section! { &["contact.loads", "contact.mean_pressures", "contact.approaches", "friction.creepages"], "";
    FROM: Typed<()> = required("from", END, "\"10 mN\"", "first value");
    TO: Typed<()> = required("to", END, "\"10 N\"", "last value, larger or smaller than the first");
    POINTS: Optional<usize> = optional("points", count_to(2, 10_000), "required", "9", "number of values");
    COUNT: Optional<usize> =
        optional("count", count_to(2, 10_000), "none", "9", "another word for `points`");
    SPACING: Optional<Spacing> = optional(
        "spacing",
        word::<Spacing>(),
        "`\"log\"`; `\"linear\"` for `approaches` and `creepages`",
        "\"linear\"",
        "`\"log\"`: equal ratios, for values above 0; `\"linear\"`: equal steps",
    );
}

/// Returns the number of values that `table` gives, by either word.
pub(crate) fn points(table: &Table<'_>) -> Result<usize> {
    let [points, count] = [POINTS.of(table)?, COUNT.of(table)?];
    if let (Some(_), Some(other)) = (points, table.get(COUNT.key.name)) {
        return Err(other.error("'count' is another word for 'points': give one of them".to_owned(), None));
    }
    let missing = || table.required(POINTS.key.name, POINTS.key.example).err();
    points.or(count).ok_or_else(|| missing().expect("it is not given"))
}

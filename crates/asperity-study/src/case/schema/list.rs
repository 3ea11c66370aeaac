//! Keys of a table that replaces a list of values.

use super::super::cursor::{Entry, Table};
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

section! { &["contact.loads", "contact.mean_pressures", "contact.approaches", "friction.creepages", "steady.speeds"], "";
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

/// Returns the number of values that the `table` of a sweep gives, by either word.
pub(crate) fn points(table: &Table<'_>) -> Result<usize> {
    points_entry(table)?;
    let [points, count] = [POINTS.of(table)?, COUNT.of(table)?];
    Ok(points.or(count).expect("one of them is given"))
}

/// Returns the entry that says how many values `table` has: `points`, or `count`.
pub(crate) fn points_entry<'a>(table: &Table<'a>) -> Result<Entry<'a>> {
    match [&POINTS, &COUNT].map(|word| table.get(word.key.name)) {
        [Some(_), Some(count)] => {
            Err(count.error("'count' is another word for 'points': give one of them".to_owned(), None))
        }
        [None, Some(count)] => Ok(count),
        [_, None] => table.required(POINTS.key.name, POINTS.key.example),
    }
}

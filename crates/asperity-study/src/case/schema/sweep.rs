//! Lists of values, or a table of their ends.

use super::super::cursor::{Entry, Table};
use super::numbers::real;
use super::tables::known_in;
use asperity_base::error::Result;
use asperity_base::table::{self, Key, Kind, Spacing, Table as _, Value};
use asperity_derive::Table;

/// The table in place of a list of values.
#[derive(Table, Debug, Clone, Copy, PartialEq)]
#[table(
    "contact.loads",
    "contact.mean_pressures",
    "contact.approaches",
    "friction.creepages",
    "steady.speeds",
    "lubrication.speeds"
)]
pub(super) struct Ends {
    /// First value.
    #[key(special = end, form = "as for the key in the singular", example = "\"10 mN\"")]
    from: (),
    /// Last value, larger or smaller than the first.
    #[key(special = end, form = "as for the key in the singular", example = "\"10 N\"")]
    to: (),
    /// Number of values.
    #[key(count = 2, most = 10_000, absent = "required", example = "9")]
    points: Option<usize>,
    /// Another word for `points`.
    #[key(count = 2, most = 10_000, absent = "none", example = "9")]
    count: Option<usize>,
    /// `"log"`: equal ratios, for values above 0; `"linear"`: equal steps.
    #[key(
        choice,
        absent = "`\"log\"`; `\"linear\"` for `approaches` and `creepages`",
        example = "\"linear\""
    )]
    spacing: Option<Spacing>,
}

/// An end is read as the values between the ends.
fn end(_: &dyn Value, _: &Key) -> Result<()> {
    Ok(())
}

/// The most values of a list.
const MAX_POINTS: usize = 10_000;

/// Reads a list of values, or a table of their ends, with this `spacing` unless the table says otherwise. A
/// number is the first of two.
pub(super) fn several(
    entry: &Entry<'_>,
    key: &Key,
    kind: &Kind,
    spacing: Spacing,
    example: &str,
) -> Result<Vec<[f64; 2]>> {
    let is_vector = matches!(kind, Kind::Vector(_));
    let one = Key { kind: *kind, ..*key };
    let read = |entry: &Entry<'_>| {
        if is_vector {
            table::Value::pair(entry, &one)
        } else {
            real(kind, key, entry).map(|value| [value, 0.0])
        }
    };
    let expected = format!(
        "a list of at least one value such as [{example}], or a table with `from`, `to` and `points`"
    );
    if !entry.is_table() {
        let values = if entry.is_array() { entry.list(&expected, read)? } else { Vec::new() };
        return match values.len() {
            1..=MAX_POINTS => Ok(values),
            0 => Err(entry.unexpected(&expected, None)),
            _ => Err(entry.unexpected("at most 10000 values", None)),
        };
    }
    let table = entry.clone().table()?;
    known_in(&table)?;
    let [from, to] = [table.required("from", example)?, table.required("to", example)?];
    let (first, last) = (read(&from)?, read(&to)?);
    points_entry(&table)?;
    let ends = Ends::read(&table)?;
    let count = ends.points.or(ends.count).expect("one of them is given");
    let by_ratio = ends.spacing.unwrap_or(spacing) == Spacing::Log;
    // A component that is 0 at both ends stays so.
    let has_ratio = |k: usize| first[k] * last[k] > 0.0 || (is_vector && first[k] == 0.0 && last[k] == 0.0);
    if by_ratio && let Some(k) = (0..1 + usize::from(is_vector)).find(|k| !has_ratio(*k)) {
        let entry = if first[k] <= 0.0 { from } else { to };
        let hint = "or `spacing = \"linear\"`".to_owned();
        return Err(entry.unexpected("the sign of the other end, as equal ratios need", Some(hint)));
    }
    let component = |k: usize, share: f64| match (first[k], last[k]) {
        (first, _) if share == 0.0 => first,
        (_, last) if share == 1.0 => last,
        (first, last) if by_ratio && first != 0.0 => first * (last / first).powf(share),
        (first, last) => first + share * (last - first),
    };
    let value = |n: usize| std::array::from_fn(|k| component(k, n as f64 / (count - 1) as f64));
    Ok((0..count).map(value).collect())
}

/// Returns the entry that says how many values `table` has: `points`, or `count`.
pub(crate) fn points_entry<'a>(table: &Table<'a>) -> Result<Entry<'a>> {
    match ["points", "count"].map(|word| table.get(word)) {
        [Some(_), Some(count)] => {
            Err(count.error("'count' is another word for 'points': give one of them".to_owned(), None))
        }
        [None, Some(count)] => Ok(count),
        [_, None] => table.required("points", "9"),
    }
}

//! Numbers of a case file, each within the bounds of its kind.

use super::super::cursor::Entry;
use super::{Bounds, Key, Kind};
use asperity_base::error::Result;
use asperity_base::table::expected;

/// Reads a count of a `kind`.
pub(super) fn count(kind: &Kind, key: &Key, entry: &Entry<'_>) -> Result<usize> {
    let Kind::Count { least, most } = *kind else { unreachable!("a count is declared as one") };
    let count = entry.count(least as usize)?;
    if count as u64 <= most { Ok(count) } else { Err(entry.unexpected(&expected(kind, key), None)) }
}

/// Reads a quantity or a number of a `kind`.
pub(super) fn real(kind: &Kind, key: &Key, entry: &Entry<'_>) -> Result<f64> {
    match *kind {
        Kind::Quantity(dimension, bounds) => match bounds {
            Bounds::AboveZero => entry.positive(dimension),
            Bounds::AboveZeroOrInfinite(meaning) => entry.positive_or_infinite(dimension, meaning),
            Bounds::Within(range, zero) => entry.within(dimension, range, zero, key.example),
            bounds => {
                let value = entry.quantity(dimension)?;
                if bounds.hold(value) { Ok(value) } else { Err(entry.unexpected(&expected(kind, key), None)) }
            }
        },
        Kind::Number(_, Bounds::Within(range, zero)) => entry.number_within(range, zero),
        Kind::Number(_, bounds @ Bounds::FromZeroOrInfinite(_)) => {
            entry.number_or_infinite(|value| bounds.hold(value), &expected(kind, key))
        }
        Kind::Number(_, bounds) => entry.number(|value| bounds.hold(value), &expected(kind, key)),
        _ => unreachable!("a key that is read as a number is declared as one"),
    }
}

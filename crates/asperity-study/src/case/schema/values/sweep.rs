//! Lists of values, or `from`, `to` and `points`.

use super::super::list::{self as keys, Spacing};
use super::super::tables::known_in;
use crate::case::cursor::Entry;
use asperity_base::error::Result;
use asperity_base::units::{Dimension, Metre, Newton, Pascal};

/// The loads of a sweep.
pub(in crate::case) fn loads(entry: &Entry<'_>) -> Result<Vec<Newton>> {
    let load = |entry: &Entry<'_>| entry.positive(Dimension::Force).map(|value| [value]);
    Ok(values(entry, "\"0.1 N\"", Spacing::Log, load)?.into_flattened())
}

/// The mean pressures of a sweep.
pub(in crate::case) fn mean_pressures(entry: &Entry<'_>) -> Result<Vec<Pascal>> {
    let pressure = |entry: &Entry<'_>| entry.positive(Dimension::Pressure).map(|value| [value]);
    Ok(values(entry, "\"1 MPa\"", Spacing::Log, pressure)?.into_flattened())
}

/// The approaches of a sweep.
pub(in crate::case) fn approaches(entry: &Entry<'_>) -> Result<Vec<Metre>> {
    let length = |entry: &Entry<'_>| entry.quantity(Dimension::Length).map(|value| [value]);
    Ok(values(entry, "\"10 nm\"", Spacing::Linear, length)?.into_flattened())
}

/// The creepages of a sweep along x and y.
pub(in crate::case) fn creepages(entry: &Entry<'_>) -> Result<Vec<[f64; 2]>> {
    let number = |entry: &Entry<'_>| entry.number(f64::is_finite, "a finite number");
    let expected = "a number along x, or two along x and y";
    values(entry, "[0.001, 0]", Spacing::Linear, |entry| entry.vector(expected, number))
}

/// The numbers of a sweep in equal ratios, each read by `read`.
pub(in crate::case) fn numbers(
    entry: &Entry<'_>,
    example: &str,
    read: impl Fn(&Entry<'_>) -> Result<f64>,
) -> Result<Vec<f64>> {
    Ok(values(entry, example, Spacing::Log, |entry| read(entry).map(|value| [value]))?.into_flattened())
}

/// The most points of a sweep.
const MAX_POINTS: usize = 10_000;

/// A list of values of N components, or a table of `from`, `to`, `points` and `spacing`.
fn values<'a, const N: usize>(
    entry: &Entry<'a>,
    example: &str,
    spacing: Spacing,
    read: impl Fn(&Entry<'a>) -> Result<[f64; N]>,
) -> Result<Vec<[f64; N]>> {
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
    let (first, last, count) = (read(&from)?, read(&to)?, keys::points(&table)?);
    let by_ratio = keys::SPACING.of(&table)?.unwrap_or(spacing) == Spacing::Log;
    // A component that is 0 at both ends stays so.
    let has_ratio = |k: usize| first[k] * last[k] > 0.0 || (N > 1 && first[k] == 0.0 && last[k] == 0.0);
    if by_ratio && let Some(k) = (0..N).find(|k| !has_ratio(*k)) {
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

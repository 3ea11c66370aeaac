//! A load in `[contact]`, or a creepage in `[friction]`, that takes one value after another.

use serde::Serialize;

use super::cursor::{Entry, Table};
use super::prescribed::Prescribed;
use super::schema::loading::{contact, sweep as keys};
use super::schema::tables::known_in;
use crate::choice::choice;
use crate::error::Result;
use crate::units::{Dimension, Metre, Newton, Pascal};

/// What a static contact is prescribed, one after the other, each on virgin bodies; at least one of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Sweep {
    /// Total normal forces, > 0.
    Loads(Vec<Newton>),
    /// Loads over the apparent area, > 0.
    MeanPressures(Vec<Pascal>),
    /// Approaches from the heights as prepared; of any sign.
    Approaches(Vec<Metre>),
}

impl Sweep {
    /// The points in their order.
    pub fn prescribed(&self) -> impl Iterator<Item = Prescribed> + '_ {
        let (values, point): (_, fn(f64) -> Prescribed) = match self {
            Self::Loads(loads) => (loads, Prescribed::Load),
            Self::MeanPressures(pressures) => (pressures, Prescribed::MeanPressure),
            Self::Approaches(approaches) => (approaches, Prescribed::Approach),
        };
        values.iter().copied().map(point)
    }

    /// The largest of them.
    pub fn largest(&self) -> Prescribed {
        let value = |prescribed: &Prescribed| match *prescribed {
            Prescribed::Load(value) | Prescribed::MeanPressure(value) | Prescribed::Approach(value) => value,
        };
        self.prescribed().max_by(|a, b| value(a).total_cmp(&value(b))).expect("a sweep has a point")
    }
}

/// Keys of a sweep in `[contact]`.
pub(super) const KEYS: [&str; 3] = ["loads", "mean_pressures", "approaches"];

/// How values follow on each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Spacing {
    Log,
    Linear,
}

choice!(Spacing: "log" => Log, "linear" => Linear);

/// The sweep of a table, if it has one.
pub(super) fn sweep(table: &Table<'_>) -> Result<Option<Sweep>> {
    let loads = contact::LOADS.of(table)?.map(Sweep::Loads);
    let pressures = contact::MEAN_PRESSURES.of(table)?.map(Sweep::MeanPressures);
    let approaches = contact::APPROACHES.of(table)?.map(Sweep::Approaches);
    Ok(loads.or(pressures).or(approaches))
}

/// The loads of a sweep.
pub(super) fn loads(entry: &Entry<'_>) -> Result<Vec<Newton>> {
    let load = |entry: &Entry<'_>| entry.positive(Dimension::Force).map(|value| [value]);
    Ok(values(entry, "\"0.1 N\"", Spacing::Log, load)?.into_flattened())
}

/// The mean pressures of a sweep.
pub(super) fn mean_pressures(entry: &Entry<'_>) -> Result<Vec<Pascal>> {
    let pressure = |entry: &Entry<'_>| entry.positive(Dimension::Pressure).map(|value| [value]);
    Ok(values(entry, "\"1 MPa\"", Spacing::Log, pressure)?.into_flattened())
}

/// The approaches of a sweep.
pub(super) fn approaches(entry: &Entry<'_>) -> Result<Vec<Metre>> {
    let length = |entry: &Entry<'_>| entry.quantity(Dimension::Length).map(|value| [value]);
    Ok(values(entry, "\"10 nm\"", Spacing::Linear, length)?.into_flattened())
}

/// The creepages of a sweep along x and y.
pub(super) fn creepages(entry: &Entry<'_>) -> Result<Vec<[f64; 2]>> {
    let number = |entry: &Entry<'_>| entry.number(f64::is_finite, "a finite number");
    let expected = "a number along x, or two along x and y";
    values(entry, "[0.001, 0]", Spacing::Linear, |entry| entry.vector(expected, number))
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
    let (first, last, count) = (read(&from)?, read(&to)?, keys::POINTS.of(&table)?);
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

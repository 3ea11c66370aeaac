//! Excluded cases: those for which all conditions of a table `[[exclude]]` hold.

use toml::Value;

use super::axis::{Axis, number};
use crate::case::cursor::{Entry, Table};
use asperity_base::choice::did_you_mean;
use asperity_base::error::Result;

/// A table `[[exclude]]`.
#[derive(Debug)]
pub(super) struct Exclusion {
    /// Conditions: an axis, and whether each of its values meets the condition.
    conditions: Vec<(usize, Vec<bool>)>,
}

impl Exclusion {
    /// Whether it excludes the case with these values, given as an index for each axis.
    pub(super) fn holds(&self, case: &[u32]) -> bool {
        self.conditions.iter().all(|(axis, met)| met[case[*axis] as usize])
    }

    /// Reads the exclusion from a table.
    pub(super) fn read(table: &Table<'_>, axes: &[Axis]) -> Result<Self> {
        let conditions = table.entries().into_iter().map(|(key, entry)| condition(key, &entry, axes));
        let conditions = conditions.collect::<Result<Vec<_>>>()?;
        if conditions.is_empty() {
            let hint = r#"for example `"contact.load" = { above = "2 N" }`"#.to_owned();
            return Err(
                table.error("[[exclude]] without a condition leaves out all cases".to_owned(), Some(hint))
            );
        }
        Ok(Self { conditions })
    }
}

fn condition(key: &str, entry: &Entry<'_>, axes: &[Axis]) -> Result<(usize, Vec<bool>)> {
    let Some(n) = axes.iter().position(|axis| axis.key() == key) else {
        let hint = did_you_mean(key, axes.iter().map(Axis::key))
            .or_else(|| Some("a key with dots is quoted: `\"contact.load\"`".to_owned()));
        return Err(entry.error(format!("'{key}' is no axis of the study"), hint));
    };
    let axis = &axes[n];
    let met: Vec<bool> = match () {
        () if entry.is_table() => between(axis, entry)?,
        () if entry.is_array() => {
            let values = entry.items("values")?.iter().map(Entry::literal).collect::<Result<Vec<_>>>()?;
            (0..axis.len()).map(|index| values.iter().any(|value| is(axis, index, value))).collect()
        }
        () => {
            let value = entry.literal()?;
            (0..axis.len()).map(|index| is(axis, index, &value)).collect()
        }
    };
    if !met.contains(&true) {
        let message = format!("no value of the axis '{key}' meets this condition");
        return Err(entry.error(message, None));
    }
    Ok((n, met))
}

/// Reads `{ above = "2 N", below = "5 N" }`, both strict.
fn between(axis: &Axis, entry: &Entry<'_>) -> Result<Vec<bool>> {
    let table = entry.clone().table()?;
    table.known(&["above", "below"], |_| None)?;
    let Some(numbers) = axis.numbers() else {
        let message = format!("the axis '{}' has values that are no numbers", axis.key());
        return Err(entry.error(message, Some("give the values to leave out, as a list".to_owned())));
    };
    let limit = |key: &str, none: f64| -> Result<f64> {
        let Some(entry) = table.get(key) else { return Ok(none) };
        let expected = || entry.unexpected(&format!("a number or quantity as of '{}'", axis.label()), None);
        number(&entry.literal()?, axis.dimension()).ok_or_else(expected)
    };
    let (above, below) = (limit("above", f64::NEG_INFINITY)?, limit("below", f64::INFINITY)?);
    Ok(numbers.iter().map(|number| above < *number && *number < below).collect())
}

/// Whether a value of an axis equals this one, in any unit.
fn is(axis: &Axis, index: usize, value: &Value) -> bool {
    match (axis.numbers(), number(value, axis.dimension())) {
        (Some(numbers), Some(number)) => (numbers[index] - number).abs() <= 1e-12 * number.abs(),
        _ => axis.value(index) == value,
    }
}

//! An axis of a study: a key of the case and its sequence of values.

use std::collections::BTreeSet;
use std::ops::Range;

use toml::Value;

use crate::case::cursor::{Entry, Table};
use crate::case::document::join;
use crate::case::schema::sweep::points_entry;
use crate::case::schema::tables::dimension;
use asperity_base::error::Result;
use asperity_base::table::{Spacing, choice};
use asperity_base::units::{self, Dimension};

/// A key of the case and its values.
#[derive(Debug, Clone)]
pub struct Axis {
    key: String,
    values: Vec<ValueInFile>,
    /// The values in SI, if all of them are numbers or quantities.
    numbers: Option<Vec<f64>>,
    dimension: Option<Dimension>,
    /// The values as texts for people.
    texts: Vec<String>,
    is_seed: bool,
}

/// A value and its place in the file.
#[derive(Debug, Clone)]
pub(super) struct ValueInFile {
    pub(super) value: Value,
    pub(super) span: Range<usize>,
}

impl Axis {
    /// Creates an axis of at least one value, in the unit of its key.
    pub(super) fn new(key: String, values: Vec<ValueInFile>) -> Self {
        let dimension = dimension(&key);
        let numbers: Option<Vec<f64>> =
            values.iter().map(|stated| number(&stated.value, dimension)).collect();
        let texts = texts(&values, numbers.as_deref(), dimension);
        let is_seed = key.ends_with("seed");
        Self { key, values, numbers, dimension, texts, is_seed }
    }

    /// Dotted key of the case: `contact.load`.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// The key with the unit of its numbers: `contact.load (N)`.
    pub fn label(&self) -> String {
        let unit = self.unit();
        if unit.is_empty() { self.key.clone() } else { format!("{} ({unit})", self.key) }
    }

    /// SI unit of the numbers; empty for pure numbers and texts.
    pub fn unit(&self) -> &'static str {
        self.dimension.filter(|_| self.numbers.is_some()).map(Dimension::si).unwrap_or_default()
    }

    /// Dimension of the numbers; `None` for pure numbers and texts.
    pub fn dimension(&self) -> Option<Dimension> {
        self.dimension
    }

    /// The values in SI; `None` if a value is neither a number nor a quantity, such as a file name.
    pub fn numbers(&self) -> Option<&[f64]> {
        self.numbers.as_deref()
    }

    /// Whether the values are random seeds: cases that differ only in them are samples of the same problem.
    pub fn is_seed(&self) -> bool {
        self.is_seed
    }

    /// Number of values.
    #[expect(clippy::len_without_is_empty, reason = "an axis without values is refused")]
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Returns the value of this index as a cell of a table: a number in SI, or the text.
    pub fn cell(&self, index: usize) -> String {
        match (&self.values[index].value, &self.numbers) {
            (Value::Integer(whole), _) if self.dimension.is_none() => whole.to_string(),
            (_, Some(numbers)) => format!("{:?}", numbers[index]),
            (Value::String(text), None) => text.clone(),
            (other, None) => other.to_string(),
        }
    }

    /// Returns the value of this index for people: `1 N`. Numbers with more than four digits are shortened,
    /// to at least three digits that still distinguish the values.
    pub fn text(&self, index: usize) -> &str {
        &self.texts[index]
    }

    /// Returns the index of a value.
    pub(super) fn index(&self, value: &Value) -> Option<u32> {
        self.values.iter().position(|known| known.value == *value).map(|index| index as u32)
    }

    pub(super) fn value(&self, index: usize) -> &Value {
        &self.values[index].value
    }

    pub(super) fn span(&self, index: usize) -> Range<usize> {
        self.values[index].span.clone()
    }
}

/// Writes values for people, with as few digits as distinguish them. Values that are short in the file stay
/// as they are.
fn texts(values: &[ValueInFile], numbers: Option<&[f64]>, dimension: Option<Dimension>) -> Vec<String> {
    const LEAST: usize = 3;
    const ALL: usize = 17;
    let with = |digits: usize| -> Vec<String> {
        let said = |(n, stated): (usize, &ValueInFile)| {
            said(&stated.value, numbers.map(|all| all[n]), dimension, digits)
        };
        values.iter().enumerate().map(said).collect()
    };
    let different = |texts: &[String]| texts.iter().collect::<BTreeSet<_>>().len();
    let all = with(ALL);
    let most = different(&all);
    (LEAST..ALL).map(with).find(|texts| different(texts) == most).unwrap_or(all)
}

/// Writes a value, a number in SI if it has one, with `digits` digits if it has more than a few.
fn said(value: &Value, number: Option<f64>, dimension: Option<Dimension>, digits: usize) -> String {
    const FEW: usize = 4;
    let own = |number: f64| {
        format!("{:e}", number.abs()).bytes().take_while(|b| *b != b'e').filter(u8::is_ascii_digit).count()
    };
    let digits = |number: f64| if own(number) <= FEW { FEW } else { digits.min(own(number)) };
    match (value, number, dimension) {
        (Value::String(text), Some(_), _) => match split(text) {
            Some((number, unit)) if own(number) > FEW => {
                format!("{} {unit}", units::format_number_digits(number, digits(number)))
            }
            _ => text.clone(),
        },
        (Value::String(text), ..) => text.clone(),
        (_, Some(number), Some(dimension)) => units::format_digits(number, dimension, digits(number)),
        (Value::Float(number), ..) => units::format_number_digits(*number, digits(*number)),
        (other, ..) => other.to_string(),
    }
}

/// Returns a value in SI, if it is a number or a quantity of the dimension.
pub(super) fn number(value: &Value, dimension: Option<Dimension>) -> Option<f64> {
    match value {
        Value::Integer(whole) => Some(*whole as f64),
        Value::Float(number) => Some(*number),
        Value::String(text) => units::parse(text, dimension?).ok(),
        _ => None,
    }
}

/// Reads the axes of the table `[axes]`, in the order of the file.
pub(super) fn axes(table: &Table<'_>) -> Result<Vec<Axis>> {
    let mut axes = Vec::new();
    collect(table, "", &mut axes)?;
    if axes.is_empty() {
        let hint = r#"for example `"contact.load" = ["1 N", "2 N"]`"#;
        return Err(table.error("[axes] has no axis".to_owned(), Some(hint.to_owned())));
    }
    Ok(axes)
}

/// Collects axes from quoted keys, `"contact.load"`, and from unquoted ones, which are nested tables.
fn collect(table: &Table<'_>, path: &str, axes: &mut Vec<Axis>) -> Result<()> {
    for (key, entry) in table.entries() {
        let path = join(path, key);
        match entry {
            entry if entry.is_table() && holds_axes(&entry)? => collect(&entry.table()?, &path, axes)?,
            entry => axes.push(axis(path, &entry)?),
        }
    }
    Ok(())
}

/// Whether a table contains axes. A range contains no list and no table.
fn holds_axes(entry: &Entry<'_>) -> Result<bool> {
    let table = entry.clone().table()?;
    let entries = table.entries();
    Ok(!entries.is_empty() && entries.iter().all(|(_, entry)| entry.is_array() || entry.is_table()))
}

fn axis(key: String, entry: &Entry<'_>) -> Result<Axis> {
    let values = match () {
        () if entry.is_array() => listed(&key, entry)?,
        () if entry.is_table() => ranged(&key, entry)?,
        () => {
            let hint = format!("for example `{EXAMPLE}`; what all cases share stands in the base");
            return Err(entry.error(format!("the axis '{key}' is one value, expected {AXIS}"), Some(hint)));
        }
    };
    let mut seen = BTreeSet::new();
    if let Some(again) = values.iter().find(|stated| !seen.insert(stated.value.to_string())) {
        return Err(entry.error(format!("the axis '{key}' has the value {} twice", again.value), None));
    }
    Ok(Axis::new(key, values))
}

/// Expected form of an axis.
const AXIS: &str = "a list of values or a range";
const EXAMPLE: &str = r#"{ from = "1 N", to = "5 N", points = 5 }"#;

fn listed(key: &str, entry: &Entry<'_>) -> Result<Vec<ValueInFile>> {
    let items = entry.items(AXIS)?;
    let stated = |item: &Entry<'_>| Ok(ValueInFile { value: item.literal()?, span: item.span() });
    let values = items.iter().map(stated).collect::<Result<Vec<_>>>()?;
    if values.is_empty() {
        let hint = format!("for example `{EXAMPLE}`");
        return Err(entry.error(format!("the axis '{key}' has no values, expected {AXIS}"), Some(hint)));
    }
    Ok(values)
}

/// Reads `{ from = "1 N", to = "5 N", points = 5, spacing = "log" }` or `{ seeds = 20, first = 100 }`.
fn ranged(key: &str, entry: &Entry<'_>) -> Result<Vec<ValueInFile>> {
    let table = entry.clone().table()?;
    table.known(&["from", "to", "points", "count", "spacing", "seeds", "first"], |_| None)?;
    let at = |value: Value| ValueInFile { value, span: entry.span() };
    if let Some(seeds) = table.get("seeds") {
        if let Some(other) =
            ["from", "to", "points", "count", "spacing"].iter().find_map(|key| table.get(key))
        {
            let message = format!("'{}' has no meaning beside 'seeds'", other.key());
            return Err(other.error(message, None));
        }
        let first = table.get("first").map_or(Ok(1), |first| first.whole(0))?;
        let count = seeds.count(1)? as u64;
        if first.checked_add(count).is_none_or(|end| end > i64::MAX as u64) {
            return Err(seeds.error("the seeds end beyond 2⁶³".to_owned(), None));
        }
        return Ok((first..first + count).map(|seed| at(Value::Integer(seed as i64))).collect());
    }
    if let Some(first) = table.get("first") {
        let hint = "`{ seeds = 20, first = 100 }` are 20 seeds from 100 on".to_owned();
        return Err(first.error("'first' has no meaning without 'seeds'".to_owned(), Some(hint)));
    }
    let [from, to] = ["from", "to"].map(|key| table.required(key, r#""1 N""#));
    let (from, to) = (from?, to?);
    let mut ends = [end(&from)?, end(&to)?];
    if ends[0].1 != ends[1].1 {
        let Some(dimension) = dimension(key) else {
            let message = format!("the axis '{key}' is from {} to {}", from.literal()?, to.literal()?);
            return Err(to.error(message, Some("give both ends in one unit".to_owned())));
        };
        ends = [(from.quantity(dimension)?, String::new()), (to.quantity(dimension)?, String::new())];
    }
    let [(a, unit), (b, _)] = ends;
    let number = points_entry(&table)?.count(2)?;
    let spacing = table.get("spacing").map_or(Ok(Spacing::Linear), |word| choice(&word))?;
    if spacing == Spacing::Log && !(a > 0.0 && b > 0.0) {
        let hint = Some("give ends above 0, or leave `spacing` out".to_owned());
        return Err(
            from.error(format!("the axis '{key}' has a logarithmic spacing from or to 0 or less"), hint)
        );
    }
    let numbers = spaced([a, b], number, spacing);
    let whole = from.literal()?.is_integer() && to.literal()?.is_integer();
    let whole = whole && numbers.iter().all(|number| number.fract() == 0.0);
    let value = |number: f64| match unit.as_str() {
        "" if whole => Value::Integer(number as i64),
        "" => Value::Float(number),
        unit => Value::String(format!("{number} {unit}")),
    };
    Ok(numbers.into_iter().map(|number| at(value(number))).collect())
}

/// Returns `count` numbers from one end to the other, both included, rounded to twelve digits in between.
fn spaced([from, to]: [f64; 2], count: usize, spacing: Spacing) -> Vec<f64> {
    let last = count - 1;
    let number = |k: usize| {
        let t = k as f64 / last as f64;
        let between = match spacing {
            Spacing::Linear => from + (to - from) * t,
            Spacing::Log => from * (to / from).powf(t),
        };
        match k {
            0 => from,
            k if k == last => to,
            _ => format!("{between:.11e}").parse().expect("a number that was written is read"),
        }
    };
    (0..count).map(number).collect()
}

/// Returns the number of an end of a range, in its own unit, and that unit; empty without one.
fn end(entry: &Entry<'_>) -> Result<(f64, String)> {
    let expected = || entry.unexpected("a number, or a quantity such as \"2 N\"", None);
    let (number, unit) = match entry.literal()? {
        Value::Integer(whole) => (whole as f64, String::new()),
        Value::Float(number) => (number, String::new()),
        Value::String(text) => {
            let (number, unit) = split(&text).ok_or_else(expected)?;
            (number, unit.to_owned())
        }
        _ => return Err(expected()),
    };
    if number.is_finite() { Ok((number, unit)) } else { Err(expected()) }
}

/// Splits a quantity into its number and its unit.
fn split(text: &str) -> Option<(f64, &str)> {
    let mut ends = (1..=text.len()).rev().filter(|end| text.is_char_boundary(*end));
    ends.find_map(|end| Some((text[..end].trim().parse().ok()?, text[end..].trim())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::document::Document;

    #[test]
    fn ranges_meet_their_ends_and_are_round_between_them() {
        assert_eq!(spaced([0.05, 0.3], 6, Spacing::Linear), [0.05, 0.1, 0.15, 0.2, 0.25, 0.3]);
        assert_eq!(spaced([1.0, 1000.0], 4, Spacing::Log), [1.0, 10.0, 100.0, 1000.0]);
        assert_eq!(spaced([5.0, 1.0], 2, Spacing::Linear), [5.0, 1.0]);
    }

    #[test]
    fn a_range_has_ends_in_any_prefix() {
        let axis = |key: &str, range: &str| {
            let text = format!("\"{key}\" = {range}");
            let mut document = Document::default();
            let entries = document.parse(&text).unwrap();
            let axis = axes(&Table::root(&document, entries.get_ref())).unwrap().remove(0);
            (0..axis.len())
                .map(|index| format!("{} = {}", axis.text(index), axis.value(index)))
                .collect::<Vec<_>>()
        };
        let log = "points = 3, spacing = \"log\"";
        assert_eq!(
            axis("steady.speed", &format!("{{ from = \"1 mm/s\", to = \"10 m/s\", {log} }}")),
            ["1 mm/s = 0.001", "100 mm/s = 0.1", "10 m/s = 10.0"]
        );
        assert_eq!(
            axis("contact.load", "{ from = 1, to = \"3000 mN\", points = 3 }"),
            ["1 N = 1.0", "2 N = 2.0", "3 N = 3.0"]
        );
        assert_eq!(
            axis("temperature.bulk", "{ from = \"20 °C\", to = \"300 K\", points = 2 }"),
            ["293 K = 293.15", "300 K = 300.0"]
        );
        assert_eq!(
            axis("lower.viscoelastic.moduli.0", "{ from = \"100 kPa\", to = \"1 MPa\", points = 2 }"),
            ["100 kPa = 100000.0", "1 MPa = 1000000.0"]
        );
    }

    #[test]
    fn an_axis_of_quantities_is_told_in_si() {
        let stated = |text: &str| ValueInFile { value: Value::String(text.to_owned()), span: 0..0 };
        let axis = Axis::new("contact.load".to_owned(), ["500 mN", "2 N"].map(stated).to_vec());
        assert_eq!(
            (axis.label(), axis.cell(0), axis.text(0)),
            ("contact.load (N)".into(), "0.5".into(), "500 mN")
        );
        let axis = Axis::new("lower.topography.file".to_owned(), ["a.x3p", "5 m.npy"].map(stated).to_vec());
        assert_eq!((axis.label(), axis.numbers()), ("lower.topography.file".to_owned(), None));
    }

    #[test]
    fn a_value_is_said_with_the_digits_that_tell_it_from_the_others() {
        let said = |key: &str, values: &[Value]| {
            let stated = |value: &Value| ValueInFile { value: value.clone(), span: 0..0 };
            let axis = Axis::new(key.to_owned(), values.iter().map(stated).collect());
            let of = |index| (axis.text(index).to_owned(), axis.cell(index));
            (0..axis.len()).map(of).unzip::<_, _, Vec<_>, Vec<_>>()
        };
        let texts = |texts: &[&str]| texts.iter().map(|text| Value::from(*text)).collect::<Vec<_>>();
        let floats = |numbers: &[f64]| numbers.iter().map(|number| Value::from(*number)).collect::<Vec<_>>();

        let (told, kept) = said(
            "contact.mean_pressure",
            &texts(&["10 MPa", "31.6227766017 MPa", "100 MPa", "316.227766017 MPa"]),
        );
        assert_eq!(told, ["10 MPa", "31.6 MPa", "100 MPa", "316 MPa"]);
        assert_eq!(kept[1], "31622776.6017");
        let (told, kept) = said("friction.coefficient", &floats(&[0.01, 0.0316227766017, 0.1]));
        assert_eq!(
            (told, kept[1].as_str()),
            (vec!["0.01".into(), "0.0316".into(), "0.1".into()], "0.0316227766017")
        );
        assert_eq!(said("contact.load", &floats(&[0.01, 0.0316227766017])).0, ["10 mN", "31.6 mN"]);
        // Enough digits for them to differ; short texts of the file stay unchanged.
        assert_eq!(said("contact.load", &floats(&[1.00001, 1.00002])).0, ["1.00001 N", "1.00002 N"]);
        assert_eq!(
            said("contact.load", &texts(&["1.23456 N", "1.23416 N", "1 N"])).0,
            ["1.235 N", "1.234 N", "1 N"]
        );
        assert_eq!(said("title", &texts(&["1.234 N", "35nm"])).0, ["1.234 N", "35nm"]);
        assert_eq!(said("contact.load", &texts(&["1.234 N", "12345.6 N"])).0, ["1.234 N", "12346 N"]);
        assert_eq!(
            said("friction.coefficient", &floats(&[1e-8, 1.23456e-7, 0.1, 0.1])).0,
            ["1e-8", "1.23e-7", "0.1", "0.1"]
        );
        assert_eq!(
            said("motion.seed", &[Value::from(123_456), Value::from(123_457)]).0,
            ["123456", "123457"]
        );
    }
}

//! Rows in sections, aligned as text.

use std::fmt::Write as _;

use asperity_base::units::Multiple;
use serde::Serialize;

use crate::words::numbers::in_column;

/// Rows in sections: a name, one or two numbers aligned at their decimal points, the unit, a remark.
#[derive(Default)]
pub struct Table {
    rows: Vec<Row>,
}

/// A row of a table.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Row {
    /// The head of a section.
    Title(String),
    /// A name and words.
    Words {
        /// Name of the row.
        name: String,
        /// Its text.
        value: String,
        /// A remark, which may be empty.
        remark: String,
    },
    /// A name and numbers in one unit.
    Numbers {
        /// Name of the row.
        name: String,
        /// Its numbers, written with four digits.
        numbers: Vec<String>,
        /// Their unit.
        unit: String,
        /// A remark, which may be empty.
        remark: String,
    },
}

impl Table {
    /// Adds the head of a section.
    pub fn title(&mut self, title: impl Into<String>) {
        self.rows.push(Row::Title(title.into()));
    }

    /// Adds words.
    pub fn words(&mut self, name: impl Into<String>, value: impl Into<String>, remark: impl Into<String>) {
        self.rows.push(Row::Words { name: name.into(), value: value.into(), remark: remark.into() });
    }

    /// Adds values in SI, printed in `unit`.
    pub fn numbers(
        &mut self,
        name: impl Into<String>,
        values: impl IntoIterator<Item = f64>,
        unit: &Multiple,
        remark: impl Into<String>,
    ) {
        let numbers = values.into_iter().map(|value| in_column(value / unit.factor)).collect();
        let (name, unit, remark) = (name.into(), unit.symbol.clone(), remark.into());
        self.rows.push(Row::Numbers { name, numbers, unit, remark });
    }

    /// The rows in turn.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Writes the rows in columns, with an empty line between sections.
    pub fn text(&self) -> String {
        let width = |pick: fn(&Row) -> usize| self.rows.iter().map(pick).max().unwrap_or(0);
        let names = width(|row| match row {
            Row::Title(_) => 0,
            Row::Words { name, .. } | Row::Numbers { name, .. } => length(name),
        });
        let before = width(|row| row.first().map_or(0, |number| length(point(number).0)));
        let after = width(|row| row.first().map_or(0, |number| length(point(number).1)));
        let units = width(|row| if let Row::Numbers { unit, .. } = row { length(unit) } else { 0 });
        let remarked = width(|row| match row {
            Row::Words { value, remark, .. } if !remark.is_empty() => length(value),
            _ => 0,
        });
        // Two adjacent numbers are aligned separately.
        let pair = 2 * (before + after) + 3;
        let values = |two: bool| if two { pair } else { before + after };
        let mut text = String::new();
        let mut two = false;
        for (i, row) in self.rows.iter().enumerate() {
            let line = match row {
                Row::Title(title) => {
                    two = self.rows[i + 1..].iter().map_while(Row::count).any(|count| count > 1);
                    format!("\n{title}")
                }
                Row::Words { name, value, remark } => {
                    format!("{name:<names$}  {value:<remarked$}  {remark}")
                }
                Row::Numbers { name, numbers, unit, remark } => {
                    let aligned: Vec<_> = numbers
                        .iter()
                        .map(|number| {
                            let (whole, part) = point(number);
                            format!("{whole:>before$}{part:<after$}")
                        })
                        .collect();
                    let width = values(two);
                    format!("{name:<names$}  {:<width$} {unit:<units$}  {remark}", aligned.join(" | "))
                }
            };
            let _ = writeln!(text, "{}", line.trim_end());
        }
        text
    }
}

impl Row {
    fn first(&self) -> Option<&str> {
        if let Self::Numbers { numbers, .. } = self { numbers.first().map(String::as_str) } else { None }
    }

    /// Returns the number of values in a row of a section; none for the head of the next.
    fn count(&self) -> Option<usize> {
        match self {
            Self::Title(_) => None,
            Self::Words { .. } => Some(0),
            Self::Numbers { numbers, .. } => Some(numbers.len()),
        }
    }
}

fn length(text: &str) -> usize {
    text.chars().count()
}

/// Splits a number before the decimal point.
fn point(number: &str) -> (&str, &str) {
    number.split_at(number.find(['.', 'e']).unwrap_or(number.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_stand_below_each_other_and_units_too() {
        let mut table = Table::default();
        let nm = Multiple { factor: 1e-9, symbol: "nm".to_owned() };
        table.words("format", "x3p", "");
        table.title("heights");
        table.numbers("Sq", [8.356e-9], &nm, "rms");
        table.numbers("Sz", [129.2e-9], &nm, "largest");
        table.title("both");
        table.numbers("Rq", [8.356e-9, 1e-9], &nm, "rms");
        let text = "format  x3p\n\nheights\nSq        8.356 nm  rms\nSz      129.2   nm  largest\n\nboth\n\
                    Rq        8.356 |   1.000 nm  rms\n";
        assert_eq!(table.text(), text);
    }
}

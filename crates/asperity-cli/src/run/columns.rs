//! A table that grows row by row, with one unit per column and aligned decimal points.

use asperity::study::dimension_of_column;
use asperity::units::{CELSIUS, Dimension, Multiple, format_number};

use asperity_report::words::numbers::decimals;

/// Characters of a column, and of its part from the decimal point on. Eight columns and the count fit into a
/// terminal of 80 characters.
const WIDTH: usize = 9;
const PART: usize = 4;

/// A number of a row with the head of its column, SI; none if it is unknown.
pub(super) struct Cell {
    head: &'static str,
    kind: Kind,
    value: Option<f64>,
}

#[derive(Clone, Copy)]
enum Kind {
    Of(Dimension),
    Share,
    Number,
    Celsius,
    Growing(Dimension, f64),
}

impl Cell {
    /// Creates a number of a column of the results: a quantity in a unit for the first row, an absolute
    /// temperature in degrees Celsius, or a pure number, which may be much smaller than 1.
    pub(super) fn new(head: &'static str, column: &str, value: impl Into<Option<f64>>) -> Self {
        let value = value.into();
        match dimension_of_column(column) {
            Some(Dimension::Temperature) => {
                Self { head, kind: Kind::Celsius, value: value.map(|value| value - CELSIUS) }
            }
            Some(dimension) => Self { head, kind: Kind::Of(dimension), value },
            None => Self { head, kind: Kind::Number, value },
        }
    }

    /// Creates a fraction, printed in per cent.
    pub(super) fn share(head: &'static str, value: impl Into<Option<f64>>) -> Self {
        Self { head, kind: Kind::Share, value: value.into() }
    }

    /// Creates a quantity that begins near zero, in a unit for at least this value.
    pub(super) fn growing(head: &'static str, column: &str, least: f64, value: f64) -> Self {
        let quantity = Self::new(head, column, value);
        match quantity.kind {
            Kind::Of(dimension) => Self { kind: Kind::Growing(dimension, least), ..quantity },
            _ => quantity,
        }
    }

    /// Returns the head of its column.
    pub(super) fn head(&self) -> &'static str {
        self.head
    }

    fn unit(&self) -> Multiple {
        let of = |factor, symbol: &str| Multiple { factor, symbol: symbol.to_owned() };
        match self.kind {
            Kind::Of(dimension) => {
                // A column that begins with 0 may have larger values later.
                let value = self.value.filter(|value| *value != 0.0).unwrap_or(match dimension {
                    Dimension::Volume => 1e-18,
                    Dimension::Force => 1e-3,
                    Dimension::Pressure => 1e6,
                    _ => 0.0,
                });
                dimension.multiple(value)
            }
            Kind::Share => of(0.01, "%"),
            Kind::Number => of(1.0, ""),
            Kind::Celsius => of(1.0, "°C"),
            Kind::Growing(dimension, least) => dimension.multiple(self.value.unwrap_or(least).max(least)),
        }
    }
}

/// Columns of a table, whose units are determined by the first row.
#[derive(Default)]
pub(super) struct Columns {
    units: Vec<Multiple>,
    /// Digits of the largest count.
    digits: usize,
}

impl Columns {
    /// Creates a table with counts up to this number.
    pub(super) fn counting_to(most: usize) -> Self {
        Self { digits: most.to_string().len(), ..Self::default() }
    }

    /// Returns a row, the first one with its heads: the name of the count, the number of this row, and its
    /// cells.
    pub(super) fn row(&mut self, counted: &str, number: usize, cells: &[Cell]) -> String {
        let first = counted.len().max(4).max(self.digits);
        let mut text = String::new();
        if self.units.is_empty() {
            self.units = cells.iter().map(Cell::unit).collect();
            let right = |text: &str| format!("{text:>WIDTH$}");
            let heads: String = cells.iter().map(|cell| right(cell.head)).collect();
            let units: String = self.units.iter().map(|unit| right(&unit.symbol)).collect();
            text = format!("{counted:>first$}{heads}\n{:first$}{}\n", "", units.trim_end());
        }
        let numbers: String = cells
            .iter()
            .zip(&self.units)
            .map(|(cell, unit)| match (cell.value, cell.kind) {
                (None, _) => format!("{:>WIDTH$}", "–"),
                (Some(value), Kind::Number) => format!("{:>WIDTH$}", pure(value)),
                (Some(value), _) => aligned(value / unit.factor),
            })
            .collect();
        text + format!("{number:>first$}{numbers}").trim_end() + "\n"
    }
}

/// Returns a pure number with four significant digits, or with three and a power of ten where these would
/// fill the column.
fn pure(value: f64) -> String {
    let text = format_number(value);
    if text.chars().count() < WIDTH { text } else { format!("{value:.2e}") }
}

/// Returns four significant digits with an aligned decimal point. If they do not fit into the column, or if
/// few of them would be visible, returns two digits and a power of ten.
fn aligned(value: f64) -> String {
    /// Below this value two digits do not fit into the column.
    const LEAST: f64 = 9.95e-3;
    let size = value.abs();
    if value == 0.0 {
        return format!("{:>1$}{2:PART$}", "0", WIDTH - PART, "");
    }
    // A sign takes the space of a digit.
    let most = if value < 0.0 { 999.5 } else { 9999.5 };
    if !(LEAST..most).contains(&size) {
        return format!("{:>WIDTH$}", format!("{value:.1e}"));
    }
    let decimals = decimals(size).min(PART - 1);
    let text = format!("{value:.decimals$}");
    let (whole, part) = text.split_at(text.find('.').unwrap_or(text.len()));
    format!("{whole:>0$}{part:PART$}", WIDTH - PART)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_has_four_digits_after_rounding() {
        assert_eq!([9.9996, 999.96].map(aligned).map(|text| text.trim().to_owned()), ["10.00", "1000"]);
    }

    #[test]
    fn a_small_number_does_not_touch_the_column_before_it() {
        let row =
            |value| Columns::default().row("point", 1, &[Cell::new("drag/W", "drag_coefficient", value)]);
        for (value, text) in
            [(0.0001475, "1.48e-4"), (-0.0001475, "-1.48e-4"), (0.01475, "0.01475"), (0.0, "0")]
        {
            assert_eq!(row(value).lines().last().unwrap(), format!("    1{text:>WIDTH$}"));
        }
    }

    #[test]
    fn a_table_keeps_its_units_and_points_and_eighty_columns() {
        let mut columns = Columns::default();
        let row = |area: f64, volume: f64| {
            [
                Cell::new("load", "load", 0.18),
                Cell::new("area", "contact_area", area),
                Cell::new("plastic", "plastic_volume", volume),
                Cell::share("stick", 0.5),
                Cell::new("friction", "friction_coefficient", -0.12345),
                Cell::new("stiff", "stiffness", None),
            ]
        };
        let mut text = columns.row("pass", 1, &row(61.8e-12, 3.085e-18));
        text += &columns.row("pass", 2, &row(1234e-12, 2e-23));
        text += &columns.row("pass", 3, &row(0.0, 12345e-18));
        let expected = "\
pass     load     area  plastic    stick friction    stiff
           mN      µm²      µm³        %               N/m
   1  180.0     61.80     3.085   50.00    -0.1235         –
   2  180.0   1234      2.0e-5   50.00    -0.1235         –
   3  180.0      0      1.2e4   50.00    -0.1235         –
";
        assert_eq!(text.replace(' ', ""), expected.replace(' ', ""));
        let places = |line: &str, c: char| -> Vec<usize> {
            line.chars().enumerate().filter(|(_, d)| *d == c).map(|(i, _)| i).collect()
        };
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(places(lines[2], '.')[0], places(lines[3], '.')[0]);
        assert!(lines.iter().all(|line| line.chars().count() <= 4 + 6 * WIDTH), "{text}");
    }
}

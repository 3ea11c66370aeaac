//! The tables of a results directory as HTML: every column, in one unit each.

use std::fmt::Write;
use std::path::Path;

use asperity_base::units::{CELSIUS, Dimension, Multiple, format, format_number};
use asperity_study::io;
use asperity_study::{column, dimension_of_column, unit_of_column};

use super::html::escaped;
use crate::words::numbers::in_column;

/// Share of the largest number of a column, or of its vector, below which a number is what rounding has left.
const ROUNDING: f64 = 1e-8;
/// Rows of a table on a page, at most.
const MAX_ROWS: usize = 200;

/// A table of numbers, SI.
pub(super) struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<f64>>,
}

/// What a column measures.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Of(Dimension),
    Celsius,
    Number,
    /// In a unit that no case file asks for, such as that of a moment.
    In(&'static str),
}

impl Table {
    /// The table of a file: its rows whose line has an end, as long as they are numbers.
    pub(super) fn read(path: &Path) -> std::io::Result<Self> {
        let text = io::read_regular(path, "a table of results", u64::MAX)?;
        let text = String::from_utf8_lossy(&text);
        let ended = text.rfind('\n').map_or("", |end| &text[..end]);
        let mut lines = ended.lines();
        let columns = lines.next().unwrap_or_default().split(',').map(str::to_owned).collect();
        // A stiffness that there is not is an empty cell.
        let cell = |text: &str| if text.is_empty() { Some(f64::NAN) } else { text.parse().ok() };
        let rows = lines.map_while(|line| line.split(',').map(cell).collect());
        Ok(Self { columns, rows: rows.collect() })
    }

    /// The rows in which the column has this value.
    pub(super) fn only(mut self, column: &str, value: f64) -> Self {
        if let Some(at) = self.columns.iter().position(|name| name == column) {
            self.rows.retain(|row| row.get(at) == Some(&value));
        }
        self
    }

    /// How many rows there are.
    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    /// HTML for the table of that name in a `file`. With a `key` each number has its value and says where it
    /// stands in `summary.json`. Of many rows some, evenly chosen. Columns of zeros are not seen.
    pub(super) fn html(&self, name: &str, file: &str, key: Option<&str>) -> String {
        let shown = evenly(self.rows.len(), MAX_ROWS);
        let all = 0..self.columns.len();
        let measures: Vec<Measure> =
            all.map(|column| Measure::of_column(&self.columns[column], self.largest(column))).collect();
        let is_hidden: Vec<bool> = (0..self.columns.len()).map(|column| self.says_nothing(column)).collect();
        let mut left_out = Vec::new();
        if shown.len() < self.rows.len() {
            left_out.push(format!("{} of {} rows, evenly chosen", shown.len(), self.rows.len()));
        }
        if is_hidden.contains(&true) {
            left_out.push("without the columns of zeros".to_owned());
        }
        let mut html = if left_out.is_empty() {
            String::new()
        } else {
            format!("<p class=\"remark\">Shown: {}. {file} has all.</p>", left_out.join(", "))
        };
        let _ = write!(
            html,
            "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{}\"><table><thead><tr>",
            escaped(name)
        );
        let rounding: Vec<f64> =
            (0..self.columns.len()).map(|column| ROUNDING * self.largest(column)).collect();
        for ((name, measure), is_hidden) in self.columns.iter().zip(&measures).zip(&is_hidden) {
            html += &measure.head(name, *is_hidden);
        }
        html += "</tr></thead><tbody>";
        for index in shown {
            html += "<tr>";
            for (column, (value, name)) in self.rows[index].iter().zip(&self.columns).enumerate() {
                let is_rounding = value.abs() < rounding[column];
                let text = measures[column].text(if is_rounding { 0.0 } else { *value });
                let hidden = if is_hidden[column] { " hidden" } else { "" };
                let _ = match key {
                    Some(key) if value.is_finite() => write!(
                        html,
                        "<td{hidden}><data data-key=\"{}.{index}.{}\" value=\"{value:?}\">{text}</data></td>",
                        escaped(key),
                        escaped(name)
                    ),
                    _ => write!(html, "<td{hidden}>{text}</td>"),
                };
            }
            html += "</tr>";
        }
        html + "</tbody></table></div>"
    }

    /// Whether a column of several rows has no number but zero.
    fn says_nothing(&self, column: usize) -> bool {
        let mut numbers = self.rows.iter().filter_map(|row| row.get(column));
        self.rows.len() > 1 && numbers.all(|value| *value == 0.0 || !value.is_finite())
    }

    /// The largest number of a column; of a component that of its vector.
    fn largest(&self, column: usize) -> f64 {
        let name = &self.columns[column];
        let belongs =
            |other: &String| other == name || (vector(name).is_some() && vector(other) == vector(name));
        let together = (0..self.columns.len()).filter(|at| belongs(&self.columns[*at]));
        let sizes =
            together.flat_map(|at| self.rows.iter().filter_map(move |row| row.get(at)).map(|v| v.abs()));
        sizes.filter(|size| size.is_finite()).fold(0.0, f64::max)
    }
}

/// A unit without multiples.
fn only(symbol: &str) -> Multiple {
    Multiple { factor: 1.0, symbol: symbol.to_owned() }
}

/// How the numbers of a column are shown.
pub(super) struct Measure {
    kind: Kind,
    unit: Multiple,
}

impl Measure {
    /// That of a column, in the unit that suits its `largest` number.
    pub(super) fn of_column(column: &str, largest: f64) -> Self {
        let kind = kind(column);
        let unit = match kind {
            Kind::Of(dimension) => dimension.multiple(largest),
            Kind::Celsius => only("°C"),
            Kind::In(unit) => only(unit),
            Kind::Number => only(""),
        };
        Self { kind, unit }
    }

    /// That of numbers of a dimension, in the unit that suits the largest of them.
    pub(super) fn of_dimension(dimension: Option<Dimension>, largest: f64) -> Self {
        match dimension {
            Some(Dimension::Temperature) => Self { kind: Kind::Celsius, unit: only("°C") },
            Some(dimension) => Self { kind: Kind::Of(dimension), unit: dimension.multiple(largest) },
            None => Self { kind: Kind::Number, unit: only("") },
        }
    }

    /// The unit.
    pub(super) fn unit(&self) -> &str {
        &self.unit.symbol
    }

    /// A difference of numbers of the column, SI, in its unit.
    pub(super) fn difference(&self, value: f64) -> f64 {
        value / self.unit.factor
    }

    /// The head of the column of a table of results: its name, its unit.
    fn head(&self, name: &str, is_hidden: bool) -> String {
        let head = self.headed(&escaped(&name.replace('_', " ")), column(name).map(|column| column.text));
        if is_hidden { head.replacen("<th", "<th hidden", 1) } else { head }
    }

    /// The head of a column: its words, which are HTML, its unit, and what it is about for who points at it.
    pub(super) fn headed(&self, words: &str, about: Option<&str>) -> String {
        let unit =
            if self.unit.symbol.is_empty() { String::new() } else { format!("<br>{}", self.unit.symbol) };
        let about = about.map_or(String::new(), |about| format!(" title=\"{}\"", escaped(about)));
        format!("<th scope=\"col\"{about}>{words}{unit}</th>")
    }

    /// A number that is prescribed, SI: without the zeros behind its last digit.
    pub(super) fn plain(&self, value: f64) -> String {
        match self.kind {
            Kind::Celsius => format_number(value - CELSIUS),
            _ => format_number(value / self.unit.factor),
        }
        .replace('-', "−")
    }

    /// A number of the column, SI.
    pub(super) fn text(&self, value: f64) -> String {
        match self.kind {
            _ if !value.is_finite() => "–".to_owned(),
            Kind::Celsius => in_column(value - CELSIUS),
            Kind::Of(_) | Kind::In(_) => in_column(value / self.unit.factor),
            // A count has no digits behind its point.
            Kind::Number if value.fract() == 0.0 => format_number(value),
            Kind::Number => in_column(value),
        }
        .replace('-', "−")
    }
}

/// A value, SI, under its key in `summary.json`, with a unit that suits it.
pub(super) fn text_of(key: &str, value: f64) -> String {
    match kind(key) {
        Kind::Of(dimension) => format(value, dimension),
        Kind::Celsius => format!("{} °C", format_number(value - CELSIUS)),
        Kind::In(unit) => format!("{} {unit}", format_number(value)),
        Kind::Number => format_number(value),
    }
}

/// At most so many of the numbers below `all`, evenly, the first and the last among them.
pub(super) fn evenly(all: usize, most: usize) -> Vec<usize> {
    match (all, most) {
        (all, most) if all <= most => (0..all).collect(),
        (all, 0 | 1) => vec![all - 1],
        (all, most) => (0..most).map(|k| k * (all - 1) / (most - 1)).collect(),
    }
}

/// The vector whose component a column is.
fn vector(column: &str) -> Option<&str> {
    column.strip_suffix("_x").or(column.strip_suffix("_y"))
}

/// What the column or key measures, by its name.
fn kind(name: &str) -> Kind {
    match dimension_of_column(name) {
        Some(Dimension::Temperature) => Kind::Celsius,
        Some(dimension) => Kind::Of(dimension),
        None => match unit_of_column(name) {
            None | Some("" | "1") => Kind::Number,
            Some(unit) => Kind::In(unit),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_rounding_leaves_of_a_component_is_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.csv");
        std::fs::write(&path, "tangential_force_x,tangential_force_y\n0.18,-3e-20\n0.09,1e-3\n").unwrap();
        let html = Table::read(&path).unwrap().html("rows", "t.csv", None);
        assert!(html.contains(">tangential force y<br>mN</th>"), "{html}");
        assert!(
            html.contains("<td>180.0</td><td>0</td>") && html.contains("<td>90.00</td><td>1.000</td>"),
            "{html}"
        );
    }

    #[test]
    fn columns_of_zeros_are_hidden_but_keep_their_numbers() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.csv");
        std::fs::write(&path, "pass,wear,load\n1,0,0\n2,0,1e-3\n").unwrap();
        let html = Table::read(&path).unwrap().html("rows", "t.csv", Some("passes"));
        assert!(html.contains("<td hidden><data data-key=\"passes.1.wear\" value=\"0.0\">"), "{html}");
        assert!(html.contains("<td><data data-key=\"passes.0.load\" value=\"0.0\">"), "{html}");
        assert!(html.contains("without the columns of zeros. t.csv has all."), "{html}");
    }

    #[test]
    fn a_table_is_read_to_its_last_whole_row() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.csv");
        std::fs::write(&path, "pass,load,stiffness\n1,0.5,\n2,0.25,1e6\n3,0.1").unwrap();
        let table = Table::read(&path).unwrap();
        assert_eq!(table.len(), 2);
        let html = table.html("rows", "t.csv", Some("passes"));
        assert!(html.contains(">load<br>mN</th>"), "{html}");
        assert!(html.contains("<data data-key=\"passes.1.load\" value=\"0.25\">250.0</data>"), "{html}");
        assert!(html.contains("<td>–</td>"), "{html}");
        assert_eq!(table.only("pass", 2.0).len(), 1);
        assert_eq!(evenly(5, 3), [0, 2, 4]);
        assert_eq!((evenly(3, 5), evenly(7, 1), evenly(0, 4)), (vec![0, 1, 2], vec![6], vec![]));
    }
}

//! What a study answers: for each combination of values, mean and deviation over the random surfaces.

use std::fmt::Write;

use asperity_base::units::format_number_digits;
use asperity_study::parametric::{Axis, Spread, Table};

use super::explorer::Quantity;
use super::html::escaped;
use super::table::{self, Measure};
use super::words;

/// Quantities that stand for a study without an answer, at most.
const WITHOUT: usize = 3;
/// Quantities, at most.
const MOST: usize = 6;

/// The main quantities of a study over the values of its axes.
pub(super) struct Overview<'a> {
    axes: Vec<(usize, &'a Axis)>,
    quantities: Vec<(&'a Quantity, Measure)>,
    /// For each combination of values, a row that has them, the spread of each quantity, and the number of
    /// cases.
    rows: Vec<(usize, Vec<Option<Spread>>, usize)>,
    table: &'a Table,
}

impl<'a> Overview<'a> {
    /// The overview of a table with these quantities, the answers first; `None` without numbers.
    pub(super) fn new(table: &'a Table, quantities: &'a [Quantity]) -> Option<Self> {
        let answers = quantities.iter().take_while(|quantity| quantity.is_answer).count();
        let main = if answers > 0 { answers.min(MOST) } else { WITHOUT };
        let quantities: Vec<_> =
            quantities.iter().take(main).map(|quantity| (quantity, quantity.measure())).collect();
        let spread = |cases: &[usize]| {
            quantities
                .iter()
                .map(|(quantity, _)| Spread::from_values(cases.iter().map(|n| quantity.values[*n])))
                .collect()
        };
        let rows: Vec<_> =
            table.samples().iter().map(|cases| (cases[0], spread(cases), cases.len())).collect();
        let axes = table.axes().iter().enumerate();
        let axes = axes.filter(|(_, axis)| !axis.is_seed() && axis.len() > 1).collect();
        (!quantities.is_empty() && !rows.is_empty()).then_some(Self { axes, quantities, rows, table })
    }

    /// The heads of the columns, each with its unit: the axes, the quantities, and the number of cases if
    /// there are several.
    fn heads(&self) -> Vec<[String; 2]> {
        let axes = self.axes.iter().map(|(_, axis)| [words::of_key(axis.key()), String::new()]);
        let quantities = self.quantities.iter();
        let quantities =
            quantities.map(|(quantity, measure)| [quantity.label.clone(), measure.unit().to_owned()]);
        axes.chain(quantities).chain(self.has_means().then(|| ["cases".to_owned(), String::new()])).collect()
    }

    /// The cells of a row.
    fn cells(&self, (row, spreads, count): &(usize, Vec<Option<Spread>>, usize)) -> Vec<String> {
        let indices = &self.table.rows()[*row].indices;
        let axes =
            self.axes.iter().map(|(n, axis)| indices.get(*n).map_or("", |index| axis.text(*index as usize)));
        let spread = |((_, measure), spread): (&(_, Measure), &Option<Spread>)| match spread {
            None => "–".to_owned(),
            Some(spread) => {
                let mean = measure.text(spread.mean);
                let deviation = spread.deviation.map(|deviation| match measure.difference(deviation) {
                    deviation if mean.contains('e') => format!(" ± {deviation:.1e}"),
                    deviation => format!(" ± {}", format_number_digits(deviation, 2)),
                });
                // A case may not have the number.
                let fewer =
                    if spread.count < *count { format!(" ({})", spread.count) } else { String::new() };
                format!("{mean}{}{fewer}", deviation.unwrap_or_default())
            }
        };
        let spreads = self.quantities.iter().zip(spreads).map(spread);
        axes.map(str::to_owned).chain(spreads).chain(self.has_means().then(|| count.to_string())).collect()
    }

    /// At most so many rows, evenly chosen, and a sentence about those that are left out.
    fn shown(&self, most: usize) -> (Vec<Vec<String>>, String) {
        let shown = table::evenly(self.rows.len(), most);
        let left_out = if shown.len() < self.rows.len() {
            format!(
                "{} of {} combinations, evenly chosen; table.csv has all cases.",
                shown.len(),
                self.rows.len()
            )
        } else {
            String::new()
        };
        (shown.into_iter().map(|n| self.cells(&self.rows[n])).collect(), left_out)
    }

    /// Whether a number is the mean of several cases.
    fn has_means(&self) -> bool {
        self.rows.iter().any(|(.., count)| *count > 1)
    }

    /// The range of each quantity over the values of the axes, as cards.
    pub(super) fn cards(&self) -> String {
        let mut html = String::from("<dl class=\"cards\">");
        for (n, (quantity, measure)) in self.quantities.iter().enumerate() {
            let spreads = || self.rows.iter().filter_map(|(_, spreads, _)| spreads[n]);
            let [least, most] =
                [f64::min, f64::max].map(|pick| spreads().map(|spread| spread.mean).fold(f64::NAN, pick));
            let range = match (measure.text(least), measure.text(most)) {
                (least, most) if least == most => least,
                (least, most) => format!("{least} to {most}"),
            };
            let largest = spreads()
                .filter_map(|spread| Some(spread.deviation? / spread.mean.abs()))
                .fold(f64::NAN, f64::max);
            let about = if largest.is_finite() {
                format!(
                    "Range of the means; their standard deviation is up to {} %.",
                    format_number_digits(100.0 * largest, 2)
                )
            } else {
                quantity.about.to_owned()
            };
            let _ = write!(
                html,
                "<div><dt>{}</dt><dd>{} {}</dd><dd class=\"about\">{}</dd></div>",
                escaped(&quantity.label),
                escaped(&range),
                escaped(measure.unit()),
                escaped(&about)
            );
        }
        html + "</dl>"
    }

    /// The table on the page.
    pub(super) fn html(&self) -> String {
        /// Rows on the page, at most.
        const ROWS: usize = 200;
        let (rows, left_out) = self.shown(ROWS);
        let means = if self.has_means() { "Mean ± standard deviation over the seeds. " } else { "" };
        let mut html = match format!("{means}{left_out}").trim() {
            "" => String::new(),
            remark => format!("<p class=\"remark\">{remark}</p>"),
        };
        html += "<div class=\"scroll whole\" tabindex=\"0\" role=\"region\" aria-label=\"table of answers\"><table><thead><tr>";
        for [head, unit] in self.heads() {
            let unit = if unit.is_empty() { unit } else { format!("<br>{unit}") };
            let _ = write!(html, "<th scope=\"col\">{}{unit}</th>", escaped(&head));
        }
        html += "</tr></thead><tbody>";
        for row in rows {
            let cells: String =
                row.iter().map(|cell| format!("<td>{}</td>", escaped(&super::html::minus(cell)))).collect();
            let _ = write!(html, "<tr>{cells}</tr>");
        }
        html + "</tbody></table></div>"
    }

    /// The table on a terminal.
    pub(super) fn text(&self) -> String {
        /// Rows on a terminal, at most.
        const ROWS: usize = 40;
        /// Characters after which a head goes on in the next line.
        const WIDTH: usize = 16;
        let (rows, left_out) = self.shown(ROWS);
        let heads: Vec<Vec<String>> = self
            .heads()
            .into_iter()
            .map(|[head, unit]| {
                let mut lines = wrapped(&head, WIDTH);
                lines.push(unit);
                lines
            })
            .collect();
        let tallest = heads.iter().map(Vec::len).max().unwrap_or_default();
        let mut lines: Vec<Vec<String>> = (0..tallest)
            // The units stand in one line.
            .map(|n| {
                heads
                    .iter()
                    .map(|head| head.get((n + head.len()).wrapping_sub(tallest)).cloned().unwrap_or_default())
                    .collect()
            })
            .collect();
        // A hyphen is the sign of a terminal.
        lines
            .extend(rows.into_iter().map(|row| row.into_iter().map(|cell| cell.replace('−', "-")).collect()));
        let widths: Vec<usize> = (0..heads.len())
            .map(|n| lines.iter().map(|line| line[n].chars().count()).max().unwrap_or_default())
            .collect();
        let mut text = String::new();
        for line in lines.iter().filter(|line| line.iter().any(|cell| !cell.is_empty())) {
            let cells = line.iter().zip(&widths).map(|(cell, width)| format!("{cell:>width$}"));
            let _ = writeln!(text, "{}", cells.collect::<Vec<_>>().join("  ").trim_end());
        }
        if self.has_means() {
            text += "mean ± standard deviation over the seeds\n";
        }
        if left_out.is_empty() { text } else { text + &left_out + "\n" }
    }
}

/// Splits a text into lines of at most so many characters, if its words allow it. What follows a comma begins
/// a line.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for part in text.split_inclusive(',') {
        let mut is_first = true;
        for word in part.split_whitespace() {
            match lines
                .last_mut()
                .filter(|line| !is_first && line.chars().count() + word.chars().count() < width)
            {
                Some(line) => *line = format!("{line} {word}"),
                None => lines.push(word.to_owned()),
            }
            is_first = false;
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_head_goes_on_in_the_next_line() {
        assert_eq!(
            wrapped("largest f over its limit, lower body", 16),
            ["largest f over", "its limit,", "lower body"]
        );
        assert_eq!(wrapped("load", 16), ["load"]);
    }
}

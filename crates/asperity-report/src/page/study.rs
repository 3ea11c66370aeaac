//! The page of a study: its answers, a chart whose quantity, axis and colours are chosen on the page, and a
//! row per case.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;

use asperity_base::units::format_time;
use asperity_study::io::{self, fs};
use asperity_study::parametric::{Axis, Row, Study, Table};
use serde_json::json;

use super::explorer::{self, Quantity, largest};
use super::html::{escaped, facts, minus, with_code};
use super::overview::Overview;
use super::table::Measure;
use super::{Section, framed, words};
use crate::draw::{Colours, palette};

/// Cases that have a row on the page, at most.
const MAX_ROWS: usize = 20_000;

/// Columns of a study's table that the page shows after the answers, the most important ones first.
const SHOWN: [&str; 28] = [
    "contact_area",
    "mean_contact_area",
    "approach",
    "mean_gap",
    "max_pressure",
    "friction_coefficient",
    "force_ratio",
    "creepage_x",
    "tangential_force_x",
    "stiffness",
    "sq_lower",
    "sq_upper",
    "plastic_volume",
    "plastic_volume_lower",
    "plastic_volume_upper",
    "max_flash_temperature",
    "max_plastic_strain",
    "plastic_work",
    "residual_displacement",
    "max_residual_tension",
    "strain_per_pass",
    "subsurface_max_von_mises",
    "elastic_energy",
    "max_shear",
    "load",
    "mean_load",
    "convolutions",
    "residual",
];

/// What a study answers, as a table for a terminal: mean and deviation over the seeds for each combination of
/// values; empty without numbers.
pub fn answers_of_study(table: &Table) -> String {
    let quantities = explorer::quantities(table, &SHOWN);
    Overview::new(table, &quantities).map_or(String::new(), |overview| overview.text())
}

/// Writes the page of a study whose cases are in `table` to `path`; where that fails the one that is there
/// stays.
pub fn write_study(study: &Study, table: &Table, path: &Path) -> asperity_base::Result<()> {
    let directory = path.parent().unwrap_or(Path::new(""));
    io::replace(path, page(study, table, directory).as_bytes())
}

fn page(study: &Study, table: &Table, directory: &Path) -> String {
    let quantities = explorer::quantities(table, &SHOWN);
    let has_chart = !quantities.is_empty() && table.axes().iter().any(|axis| measure(axis).is_some());
    let overview = Overview::new(table, &quantities);
    let sections: [Section; 4] = [
        ("answers", "Answers", overview.as_ref().map(Overview::html)),
        ("curves", "Chart", has_chart.then(|| "<div id=\"explorer\"></div>".to_owned())),
        ("plan", "Plan", Some(about(study, table))),
        ("cases", "Cases", Some(rows(table, &quantities, directory))),
    ];
    let colours = json!({ "pressure": palette(Colours::Pressure) });
    let data =
        json!({ "colours": colours, "charts": [], "study": explorer::data(table, &quantities, directory) });
    let head = head(study, table, overview.map_or(String::new(), |overview| overview.cards()));
    framed(study.title(), &head, &sections, &data)
}

fn head(study: &Study, table: &Table, cards: String) -> String {
    let failures: Vec<&Row> = table.rows().iter().filter(|row| row.failure.is_some()).collect();
    let cases: BTreeSet<usize> = table.rows().iter().map(|row| row.case).collect();
    let done = cases.len() - failures.len();
    let mut html = format!(
        "<h1>{}</h1><p class=\"verdict\">{done} of {} cases are done, {} have failed.</p>",
        escaped(study.title()),
        study.len(),
        failures.len()
    );
    if !failures.is_empty() {
        const MAX_TOLD: usize = 20;
        html += "<div class=\"warning\"><h2>Failures</h2><ul>";
        for row in failures.iter().take(MAX_TOLD) {
            let message = row.failure.as_deref().unwrap_or_default();
            let _ = write!(html, "<li>case {:04}: {}</li>", row.case, with_code(message));
        }
        if failures.len() > MAX_TOLD {
            let _ = write!(html, "<li>and {} more: see the rows below</li>", failures.len() - MAX_TOLD);
        }
        html += "</ul></div>";
    }
    html + &cards
}

/// The axes of the study, and its numbers as a whole.
fn about(study: &Study, table: &Table) -> String {
    let axes = study.axes().iter().map(|axis| {
        let [first, last] = [0, axis.len() - 1].map(|index| axis.text(index));
        let values = if axis.len() == 1 {
            first.to_owned()
        } else {
            format!("{} values, {first} to {last}", axis.len())
        };
        (words::of_key(axis.key()), escaped(&values))
    });
    // A case with a sweep has several rows.
    let cases = || table.rows().chunk_by(|one, other| one.case == other.case).map(|rows| &rows[0]);
    let time: f64 = cases().map(|row| row.wall_time).sum();
    let warned = cases().filter(|row| row.warnings > 0).count();
    let rest = [
        ("time of all cases".to_owned(), format_time(time)),
        ("cases with warnings".to_owned(), warned.to_string()),
        ("numbers".to_owned(), "<a href=\"table.csv\">table.csv</a>".to_owned()),
    ];
    facts(axes.chain(rest))
}

/// A row per case: its values, its main numbers, each column in one unit. The number of a case leads to its
/// page where that was made.
fn rows(table: &Table, quantities: &[Quantity], directory: &Path) -> String {
    let columns: Vec<Measure> = quantities.iter().map(Quantity::measure).collect();
    let axes: Vec<Option<Measure>> = table.axes().iter().map(measure).collect();
    let mut html = String::from(
        "<p class=\"remark\">A click on the head of a column sorts by it, a click on a row opens the case.</p>\
         <div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"table of cases\"><table><thead><tr><th scope=\"col\">case</th>",
    );
    for (axis, measure) in table.axes().iter().zip(&axes) {
        let words = escaped(&words::of_key(axis.key()));
        html += &match measure {
            Some(measure) => measure.headed(&words, None),
            None => format!("<th scope=\"col\">{words}</th>"),
        };
    }
    for (quantity, measure) in quantities.iter().zip(&columns) {
        html += &measure.headed(&escaped(&quantity.label), Some(quantity.about));
    }
    html += "<th scope=\"col\">warnings</th></tr></thead><tbody>";
    let listed = super::table::evenly(table.rows().len(), MAX_ROWS);
    for n in &listed {
        let row = &table.rows()[*n];
        let page = format!("cases/{:04}/{}", row.case, super::FILE);
        let name = if fs::exists(directory.join(&page)) {
            format!("<a href=\"{page}\">{}</a>", explorer::name_of(row))
        } else {
            explorer::name_of(row)
        };
        let _ = write!(html, "<tr><th scope=\"row\">{name}</th>");
        for (n, (axis, measure)) in table.axes().iter().zip(&axes).enumerate() {
            let text = match (row.indices.get(n).map(|index| *index as usize), measure, axis.numbers()) {
                (None, ..) => "–".to_owned(),
                (Some(index), Some(measure), Some(numbers)) => measure.plain(numbers[index]),
                (Some(index), ..) => minus(axis.text(index)),
            };
            let _ = write!(html, "<td>{}</td>", escaped(&text));
        }
        if let Some(message) = &row.failure {
            let _ = write!(
                html,
                "<td class=\"words\" colspan=\"{}\">{}</td></tr>",
                columns.len() + 1,
                with_code(message)
            );
            continue;
        }
        for (quantity, measure) in quantities.iter().zip(&columns) {
            let _ = write!(html, "<td>{}</td>", measure.text(quantity.values[*n]));
        }
        let _ = write!(html, "<td>{}</td></tr>", row.warnings);
    }
    html += "</tbody></table></div>";
    if listed.len() < table.rows().len() {
        let _ = write!(
            html,
            "<p class=\"remark\">{} of {} cases, evenly chosen; table.csv has all.</p>",
            listed.len(),
            table.rows().len()
        );
    }
    html
}

/// How the numbers of an axis are shown, in the unit that suits the largest; none for seeds and for what is
/// no number.
fn measure(axis: &Axis) -> Option<Measure> {
    let numbers = axis.numbers().filter(|_| !axis.is_seed())?;
    Some(Measure::of_dimension(axis.dimension(), largest(numbers)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_that_are_shown_are_columns_of_records() {
        for name in SHOWN {
            assert!(asperity_study::column(name).is_some(), "{name}");
        }
    }
}

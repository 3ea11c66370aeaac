//! The page of a study: a row per case, and curves over each axis.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use asperity::io;
use asperity::study::many::{Row, Study, Table};
use asperity::units::format_time;
use serde_json::{Value, json};

use super::html::{escaped, facts, minus};
use super::table::Measure;
use super::{Section, curves, framed};
use crate::draw::{self, Chart, Mark, Series, Unit};
use crate::figures::Curves;

/// Cases that have a row on the page, at most.
const MAX_ROWS: usize = 20_000;
/// Quantities that have a curve over each axis, at most.
const MAX_CURVES: usize = 6;
/// Curves on a chart, at most.
const MAX_SERIES: usize = 7;
/// From such a ratio of the largest to the least on numbers are drawn by their logarithm.
const DECADE: f64 = 10.0;

/// Columns of a study's table that the page shows, the most telling ones first, and whether they have curves.
const SHOWN: [(&str, bool); 29] = [
    ("load", false),
    ("mean_load", false),
    ("contact_area", true),
    ("mean_contact_area", true),
    ("approach", true),
    ("mean_gap", true),
    ("max_pressure", true),
    ("friction_coefficient", true),
    ("force_ratio", true),
    ("creepage_x", true),
    ("stiffness", true),
    ("sq_lower", true),
    ("sq_upper", true),
    ("plastic_volume", true),
    ("plastic_volume_lower", true),
    ("plastic_volume_upper", true),
    ("wear_volume_lower", true),
    ("wear_volume_upper", true),
    ("max_flash_temperature", true),
    ("max_plastic_strain", true),
    ("plastic_work", true),
    ("residual_displacement", true),
    ("max_residual_tension", true),
    ("strain_per_pass", true),
    ("subsurface_max_von_mises", true),
    ("elastic_energy", true),
    ("max_shear", true),
    ("convolutions", false),
    ("residual", false),
];

/// Writes the page of a study whose cases are in `table` to `path`; where that fails the one that is there stays.
pub(crate) fn write_study(study: &Study, table: &Table, path: &Path) -> asperity::Result<()> {
    let directory = path.parent().unwrap_or(Path::new(""));
    io::replace(path, page(study, table, directory).as_bytes())
}

fn page(study: &Study, table: &Table, directory: &Path) -> String {
    let mut charts = Vec::new();
    let sections: [Section; 2] = [
        ("curves", "Curves", over_axes(table, &mut charts)),
        ("cases", "Cases", Some(rows(table, directory))),
    ];
    let data = json!({ "colours": {}, "charts": Value::from(charts) });
    framed(study.title(), &head(study, table), &sections, &data)
}

fn head(study: &Study, table: &Table) -> String {
    let failures: Vec<&Row> = table.rows().iter().filter(|row| row.failure.is_some()).collect();
    let done = table.rows().len() - failures.len();
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
            let _ = write!(html, "<li>case {:04}: {}</li>", row.case, escaped(message));
        }
        if failures.len() > MAX_TOLD {
            let _ = write!(html, "<li>and {} more: see the rows below</li>", failures.len() - MAX_TOLD);
        }
        html += "</ul></div>";
    }
    let axes = study.axes().iter().map(|axis| {
        let [first, last] = [0, axis.len() - 1].map(|index| axis.text(index));
        let values = if axis.len() == 1 {
            first.to_owned()
        } else {
            format!("{} values, {first} to {last}", axis.len())
        };
        (axis.key().to_owned(), escaped(&values))
    });
    let time: f64 = table.rows().iter().map(|row| row.wall_time).sum();
    let warned = table.rows().iter().filter(|row| row.warnings > 0).count();
    let rest = [
        ("time of all cases".to_owned(), format_time(time)),
        ("cases with warnings".to_owned(), warned.to_string()),
        (
            "numbers".to_owned(),
            "<a href=\"table.csv\">table.csv</a>, <a href=\"table.h5\">table.h5</a>".to_owned(),
        ),
    ];
    html + &facts(axes.chain(rest))
}

/// A row per case: its values, its main numbers, each column in one unit. It leads to the case's own page where that was made,
/// else to its folder.
fn rows(table: &Table, directory: &Path) -> String {
    let shown = shown(table);
    let columns: Vec<(usize, Measure)> =
        shown.iter().map(|(column, _)| (*column, measure(table, *column))).collect();
    let mut html = String::from(
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"table of cases\"><table><thead><tr><th scope=\"col\">case</th>",
    );
    for axis in table.axes() {
        let _ = write!(html, "<th scope=\"col\">{}</th>", escaped(axis.key()));
    }
    for (column, measure) in &columns {
        html += &measure.head(&table.columns()[*column]);
    }
    html += "<th scope=\"col\">warnings</th></tr></thead><tbody>";
    let listed = super::table::evenly(table.rows().len(), MAX_ROWS);
    for row in listed.iter().map(|n| &table.rows()[*n]) {
        let case = format!("cases/{:04}/", row.case);
        let own = if directory.join(&case).join(super::FILE).exists() { super::FILE } else { "" };
        let _ = write!(html, "<tr><th scope=\"row\"><a href=\"{case}{own}\">{:04}</a></th>", row.case);
        for (axis, index) in table.axes().iter().zip(&row.indices) {
            let _ = write!(html, "<td>{}</td>", escaped(&minus(axis.text(*index as usize))));
        }
        if let Some(message) = &row.failure {
            let _ = write!(
                html,
                "<td class=\"words\" colspan=\"{}\">{}</td></tr>",
                columns.len() + 1,
                escaped(message)
            );
            continue;
        }
        for (column, measure) in &columns {
            let _ = write!(html, "<td>{}</td>", measure.text(row.numbers[*column]));
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

/// Columns that say something, and whether they have curves.
fn shown(table: &Table) -> Vec<(usize, bool)> {
    let column = |name: &str| table.columns().iter().position(|column| column == name);
    let tells = |column: &usize| table.rows().iter().any(|row| row.numbers[*column].abs() > 0.0);
    SHOWN.iter().filter_map(|(name, curve)| Some((column(name).filter(tells)?, *curve))).collect()
}

/// How the numbers of a column are shown: in the unit that suits the largest.
fn measure(table: &Table, column: usize) -> Measure {
    let sizes = table.rows().iter().map(|row| row.numbers[column].abs());
    let largest = sizes.filter(|size| size.is_finite()).fold(0.0, f64::max);
    Measure::of(&table.columns()[column], largest)
}

/// Curves over each axis of numbers that are no seeds; nothing where there is none.
fn over_axes(table: &Table, charts: &mut Vec<Value>) -> Option<String> {
    let mut html = String::new();
    for (n, axis) in table.axes().iter().enumerate() {
        if axis.numbers().is_none() || axis.is_seed() || axis.len() < 2 {
            continue;
        }
        let by = by(table, n);
        let varies = |column: &usize| {
            let numbers =
                || table.rows().iter().map(|row| row.numbers[*column]).filter(|number| number.is_finite());
            let [least, most] = [f64::min, f64::max].map(|pick| numbers().fold(f64::NAN, pick));
            least < most
        };
        let columns = shown(table).into_iter().filter(|(column, curve)| *curve && varies(column));
        let drawn: Vec<Curves> =
            columns.take(MAX_CURVES).map(|(column, _)| chart(table, n, by, column)).collect();
        let made = curves::html(drawn, charts);
        if !made.is_empty() {
            let _ = write!(html, "<h3>over {}</h3>{made}", escaped(axis.key()));
        }
    }
    Some(html).filter(|html| !html.is_empty())
}

/// The axis whose values have a curve each: of those with few values the one with the fewest.
fn by(table: &Table, x: usize) -> Option<usize> {
    let few = |n: &usize| {
        let axis = &table.axes()[*n];
        *n != x && !axis.is_seed() && (2..=MAX_SERIES).contains(&axis.len())
    };
    (0..table.axes().len()).filter(few).min_by_key(|n| table.axes()[*n].len())
}

/// A quantity over an axis: means over all that the curves do not tell apart, and where there are not many all cases.
fn chart(table: &Table, x: usize, by: Option<usize>, column: usize) -> Curves {
    const MANY: usize = 2000;
    let axis = &table.axes()[x];
    let numbers = axis.numbers().expect("it is an axis of numbers");
    let name = table.columns()[column].replace('_', " ");
    let mut means: BTreeMap<u32, BTreeMap<u32, (f64, usize)>> = BTreeMap::new();
    let mut all = Vec::new();
    for row in table.rows().iter().filter(|row| row.failure.is_none() && row.numbers[column].is_finite()) {
        let curve = by.map_or(0, |by| row.indices[by]);
        let mean = means.entry(curve).or_default().entry(row.indices[x]).or_default();
        *mean = (mean.0 + row.numbers[column], mean.1 + 1);
        all.push([numbers[row.indices[x] as usize], row.numbers[column]]);
    }
    let samples = means.values().flat_map(BTreeMap::values).any(|(_, count)| *count > 1);
    let what = if samples { "mean" } else { "" };
    let mut series: Vec<Series> = means
        .iter()
        .map(|(curve, points)| {
            let mut points: Vec<[f64; 2]> = points
                .iter()
                .map(|(index, (sum, count))| [numbers[*index as usize], sum / *count as f64])
                .collect();
            points.sort_by(|a, b| a[0].total_cmp(&b[0]));
            let name = by.map_or(what.to_owned(), |by| table.axes()[by].text(*curve as usize).to_owned());
            Series::new(name, points, Mark::LineAndPoints)
        })
        .collect();
    if samples && by.is_none() && all.len() <= MANY {
        series.push(Series::new("each case", all.clone(), Mark::Points));
    }
    let of_all = |axis: usize| all.iter().map(|point| point[axis]).collect::<Vec<f64>>();
    let horizontal = drawn(axis.key(), axis.dimension().map_or(Unit::Number, Unit::from), &of_all(0));
    let vertical = drawn(&name, Unit::of_column(&table.columns()[column]), &of_all(1));
    let of = match (by.map(|by| table.axes()[by].key()), samples) {
        (Some(key), true) => format!(", means, by {key}"),
        (Some(key), false) => format!(", by {key}"),
        (None, _) => String::new(),
    };
    let title = format!("{name} over {}{of}", axis.key());
    Curves { name: "study", title, charts: Chart::new("", horizontal, vertical, series).into() }
}

/// An axis, by the logarithm where its numbers are above 0 and some decades wide.
fn drawn(label: &str, unit: Unit, numbers: &[f64]) -> draw::Axis {
    let [least, most] = [f64::min, f64::max].map(|pick| numbers.iter().copied().fold(f64::NAN, pick));
    if least > 0.0 && most >= DECADE * least {
        draw::Axis::log(label, unit)
    } else {
        draw::Axis::linear(label, unit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_that_are_shown_are_columns_of_records() {
        for (name, _) in SHOWN {
            assert!(asperity::study::column(name).is_some(), "{name}");
        }
    }
}

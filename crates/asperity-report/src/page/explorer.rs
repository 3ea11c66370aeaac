//! The numbers of a study for its chart: quantities over axes, chosen on the page, and the panel of a case.

use std::path::Path;

use asperity_base::units::{Dimension, Multiple};
use asperity_study::io::fs;
use asperity_study::parametric::{Axis, Row, Table, TableColumn};
use asperity_study::{column, dimension_of_column};
use serde_json::{Value, json};

use super::table::Measure;
use super::words;
use super::{curves, table};
use crate::draw::Unit;

/// Cases on the chart, at most.
const MAX_CASES: usize = 4000;

/// A number of each case.
pub(super) struct Quantity {
    /// Name of its column; that of the contact fraction where it is worked out here.
    pub(super) name: String,
    /// The quantity in words.
    pub(super) label: String,
    /// Its meaning.
    pub(super) about: &'static str,
    /// Whether it answers the question of the user.
    pub(super) is_answer: bool,
    /// In the order of the rows; NaN of cases that failed.
    pub(super) values: Vec<f64>,
}

impl Quantity {
    /// How its numbers are shown.
    pub(super) fn measure(&self) -> Measure {
        Measure::of_column(&self.name, largest(&self.values))
    }
}

/// The quantities of a study: the answers, then the columns that are `shown` in their order, which say
/// something and do not repeat an axis, and the contact fraction.
pub(super) fn quantities(table: &Table, shown: &[&str]) -> Vec<Quantity> {
    let of_column = |name: &str| -> Option<Vec<f64>> {
        let at = table.columns().iter().position(|column| column.name == name)?;
        let value = |row: &Row| row.numbers.get(at).copied().unwrap_or(f64::NAN);
        Some(table.rows().iter().map(value).collect())
    };
    let quantity = |column: &TableColumn| {
        let words = column.answer.clone().unwrap_or_else(|| words::of_column(&column.name));
        Some(Quantity {
            name: column.name.clone(),
            label: if column.of_last_pass { format!("{words}, last pass") } else { words },
            about: self::column(&column.name).map_or("", |column| column.text),
            is_answer: column.answer.is_some(),
            values: of_column(&column.name)?,
        })
    };
    let answers = table.answers().iter().map(|n| &table.columns()[*n]);
    let others = || table.columns().iter().filter(|column| column.answer.is_none());
    let others = shown.iter().filter_map(|name| others().find(|column| column.name == *name));
    let mut all: Vec<Quantity> = answers
        .chain(others)
        .filter_map(quantity)
        .filter(|quantity| quantity.values.iter().any(|value| value.abs() > 0.0))
        .filter(|quantity| !table.axes().iter().any(|axis| repeats(axis, quantity, table)))
        .collect();
    // The share of the grid, or of the overlap of a pass.
    let parts = [
        "contact_fraction",
        "contact_area",
        "apparent_area",
        "mean_contact_area",
        "mean_pressure",
        "mean_load",
    ];
    let parts = parts.map(|name| of_column(name).unwrap_or_else(|| vec![f64::NAN; table.rows().len()]));
    let fraction = |n: usize| {
        let [fraction, area, apparent, mean_area, pressure, load] =
            [0, 1, 2, 3, 4, 5].map(|part: usize| parts[part][n]);
        let known = [fraction, area / apparent, mean_area * pressure / load]
            .into_iter()
            .find(|share| share.is_finite());
        known.unwrap_or(f64::NAN)
    };
    let values: Vec<f64> = (0..table.rows().len()).map(fraction).collect();
    let of_area = all.iter().position(|quantity| quantity.name.ends_with("contact_area"));
    if let Some(at) = of_area.filter(|_| values.iter().any(|value| *value > 0.0)) {
        let (name, about) =
            ("contact_fraction".to_owned(), "Area of contact over the area of the grid, or of the overlap.");
        let label = all[at].label.replace(&words::of_column(&all[at].name), &words::of_column(&name));
        all.insert(at + 1, Quantity { name, label, about, is_answer: false, values });
    }
    all
}

/// Whether a quantity is what an axis prescribes.
fn repeats(axis: &Axis, quantity: &Quantity, table: &Table) -> bool {
    /// Share by which a load that is reached may differ from the one that is prescribed.
    const REACHED: f64 = 1e-3;
    let Some(numbers) = axis.numbers() else { return false };
    let n = table.axes().iter().position(|other| other.key() == axis.key()).unwrap_or_default();
    let is_same_dimension =
        axis.dimension().is_some() && axis.dimension() == dimension_of_column(&quantity.name);
    let mut known = table.rows().iter().zip(&quantity.values).filter(|(_, value)| value.is_finite());
    is_same_dimension
        && known.all(|(row, value)| {
            let prescribed = row.indices.get(n).map_or(f64::NAN, |index| numbers[*index as usize]);
            (value - prescribed).abs() <= REACHED * prescribed.abs()
        })
}

/// The data of the chart and of the panels; `directory` is that of the study.
pub(super) fn data(table: &Table, quantities: &[Quantity], directory: &Path) -> Value {
    let shown = table::evenly(table.rows().len(), MAX_CASES);
    let axes: Vec<Value> =
        table.axes().iter().enumerate().map(|(n, axis)| of_axis(table, n, axis, &shown)).collect();
    let quantities: Vec<Value> = quantities
        .iter()
        .map(|Quantity { name, label, about, values, .. }| {
            let numbers: Vec<f64> = shown.iter().map(|n| values[*n]).collect();
            // The unit is that of the tables; a temperature has an offset there.
            let dimension =
                dimension_of_column(name).filter(|dimension| *dimension != Dimension::Temperature);
            let unit =
                match dimension.map(|dimension| (dimension.multiple(largest(&numbers)), dimension.si())) {
                    Some((Multiple { factor, symbol }, si)) => {
                        json!({ "factor": factor, "symbol": symbol, "si": si })
                    }
                    None => curves::unit(Unit::of_column(name), largest(&numbers)),
                };
            json!({
                "name": name,
                "label": label,
                "about": about,
                "unit": unit,
                "values": numbers,
            })
        })
        .collect();
    let cases: Vec<Value> = shown
        .iter()
        .map(|n| {
            let row = &table.rows()[*n];
            let folder = format!("cases/{:04}", row.case);
            let page = format!("{folder}/{}", super::FILE);
            json!({
                "case": name_of(row),
                "folder": folder,
                "failure": row.failure,
                "page": Some(&page).filter(|page| fs::exists(directory.join(page))),
            })
        })
        .collect();
    json!({
        "folder": directory.display().to_string(),
        "axes": axes,
        "quantities": quantities,
        "cases": cases,
        "all": table.rows().len(),
    })
}

/// The name of a row: the number of its case, and that of its point.
pub(super) fn name_of(row: &Row) -> String {
    let point = row.point.map_or(String::new(), |point| format!("/{point}"));
    format!("{:04}{point}", row.case)
}

fn of_axis(table: &Table, n: usize, axis: &Axis, shown: &[usize]) -> Value {
    let unit = axis.dimension().map_or(Unit::Number, Unit::from);
    let numbers = axis.numbers().filter(|_| !axis.is_seed());
    json!({
        "key": axis.key(),
        "label": words::of_key(axis.key()),
        "unit": curves::unit(unit, largest(numbers.unwrap_or_default())),
        "numbers": numbers,
        "texts": (0..axis.len()).map(|index| axis.text(index)).collect::<Vec<_>>(),
        "seed": axis.is_seed(),
        "indices": shown.iter().map(|row| table.rows()[*row].indices.get(n)).collect::<Vec<_>>(),
    })
}

pub(super) fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().map(|number| number.abs()).filter(|size| size.is_finite()).fold(0.0, f64::max)
}

//! Results of a study: a row per case, with the values of its axes and the numbers of its summary.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::{self, ErrorKind};
use std::path::Path;
use std::slice;

use rayon::prelude::*;

use super::axis::Axis;
use super::folder::Folder;
use super::plan::Study;
use super::points;
use crate::cell::quoted;
use crate::columns::{CASE, MESSAGE, STATE, WARNINGS, declared, headed};
use crate::io::atomic;
use crate::joined::{self, Cell, MARK};
use crate::results::{NO_LOCKS, Results};
use crate::summary::{Outcome, RunningIn, Summary};
use asperity_base::error::{Error, Result};
use asperity_base::record::OverMotion;
use asperity_contact::each;
use asperity_contact::motion::{PassRecord, PlasticRecord, StaticRecord, UpdateRecord};
use asperity_contact::with::{self, Reported};

/// The finished and failed cases of a study.
///
/// It contains no times, so it is the same to the last bit for any number of processes and interruptions.
#[derive(Debug)]
pub struct Table {
    axes: Vec<Axis>,
    /// The numbers of the cases, in the order of the cases that have them.
    columns: Vec<TableColumn>,
    /// The columns that answer the question of the user, the main ones first.
    answers: Vec<usize>,
    rows: Vec<Row>,
}

/// A number of each case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TableColumn {
    /// Name of the number in the results of a case.
    pub name: String,
    /// Whether it is a value of the last pass of a motion, and neither a state after it nor a total of all
    /// passes.
    pub of_last_pass: bool,
    /// Name of the quantity, if it answers the question of the user: "worn volume, lower body".
    pub answer: Option<String>,
}

impl TableColumn {
    /// The head of the column: name, unit, and whether the value is that of the last pass.
    fn head(&self) -> String {
        let pass = if self.of_last_pass { " of the last pass" } else { "" };
        format!("{}{pass}", headed(&self.name))
    }
}

/// A finished or failed case, or a point of the sweep of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Number of the case, from 1.
    pub case: usize,
    /// Number of the point of a sweep, from 1.
    pub point: Option<usize>,
    /// The index of the value of each axis; a failed case has none on the axis of the points.
    pub indices: Vec<u32>,
    /// Numbers, SI, by column of the table; NaN if missing. Empty for a failed case.
    pub numbers: Vec<f64>,
    /// Number of warnings in its summary, without the one about a file system without locks.
    pub warnings: usize,
    /// Time spent by the last process that computed it; 0 for a failed case.
    pub wall_time: f64,
    /// Reason of the failure, if it failed.
    pub failure: Option<String>,
}

impl Table {
    /// Collects the finished and failed cases of a study: a row per case, or per point of the sweep of a
    /// case.
    ///
    /// # Errors
    /// [`asperity_base::Error::File`] if the results or the failure of a case cannot be read.
    pub fn collect(study: &Study, folder: &Folder) -> Result<Self> {
        let found: Result<Vec<Option<CaseData>>> =
            (1..=study.len()).into_par_iter().map(|case| found(folder, case)).collect();
        let found = found?;
        let mut columns: Vec<TableColumn> = Vec::new();
        let mut places = BTreeMap::new();
        for number in found.iter().flatten().flat_map(|found| &found.rows).flatten() {
            places.entry(number.column.name.clone()).or_insert_with(|| {
                columns.push(number.column.clone());
                columns.len() - 1
            });
        }
        let answers = answers(&mut columns);
        let done = found.iter().flatten().filter(|found| found.failure.is_none());
        let points = done
            .map(|found| found.sweep.as_ref())
            .collect::<Option<Vec<_>>>()
            .and_then(|sweeps| points::axis(sweeps.into_iter()));
        let rows = found.into_iter().enumerate().flat_map(|(n, found)| {
            let case = n + 1;
            let Some(CaseData { rows, sweep, warnings, wall_time, failure }) = found else {
                return Vec::new();
            };
            let row = |(at, numbers): (usize, &Vec<Number>)| {
                let mut indices = study.indices(case).to_vec();
                let value = sweep.as_ref().and_then(|(_, values)| values.get(at));
                indices.extend(points.as_ref().zip(value).and_then(|(axis, value)| axis.index(value)));
                let mut of_columns = vec![f64::NAN; if failure.is_some() { 0 } else { columns.len() }];
                numbers.iter().for_each(|number| of_columns[places[&number.column.name]] = number.value);
                let point = sweep.as_ref().map(|_| at + 1);
                let (numbers, failure) = (of_columns, failure.clone());
                Row { case, point, indices, numbers, warnings, wall_time, failure }
            };
            rows.iter().enumerate().map(row).collect::<Vec<_>>()
        });
        let rows = rows.collect();
        Ok(Self { axes: study.axes().iter().cloned().chain(points).collect(), rows, columns, answers })
    }

    /// The axes of the study, and that of the points if its cases have sweeps.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// The numbers.
    pub fn columns(&self) -> &[TableColumn] {
        &self.columns
    }

    /// The indices of the columns that answer the question of the user, the main ones first.
    pub fn answers(&self) -> &[usize] {
        &self.answers
    }

    /// The rows, in the order of the cases and of their points.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Writes the table as CSV, atomically: one line per row. Missing values are empty cells.
    ///
    /// # Errors
    /// [`asperity_base::Error::File`].
    pub fn write_csv(&self, path: &Path) -> Result<()> {
        atomic::replace(path, self.csv().as_bytes())
    }

    fn csv(&self) -> String {
        let labels = self.axes.iter().map(|axis| axis.label());
        let numbers = self.columns.iter().map(TableColumn::head);
        let words = [WARNINGS.name, STATE.name, MESSAGE.name].map(str::to_owned);
        let head = [CASE.name.to_owned()].into_iter().chain(labels).chain(numbers).chain(words);
        let mut csv = String::from(MARK);
        csv += &head.map(|head| quoted(&head)).collect::<Vec<_>>().join(",");
        csv.push('\n');
        for row in &self.rows {
            let _ = write!(csv, "{:04}", row.case);
            for (n, axis) in self.axes.iter().enumerate() {
                let cell =
                    row.indices.get(n).map_or(String::new(), |index| quoted(&axis.cell(*index as usize)));
                let _ = write!(csv, ",{cell}");
            }
            for n in 0..self.columns.len() {
                csv.push(',');
                if let Some(number) = row.numbers.get(n).filter(|number| !number.is_nan()) {
                    let _ = write!(csv, "{number:?}");
                }
            }
            let _ = match &row.failure {
                None => writeln!(csv, ",{},done,", row.warnings),
                Some(message) => writeln!(csv, ",,failed,{}", quoted(message)),
            };
        }
        csv
    }
}

/// Data of a finished or failed case.
struct CaseData {
    /// The numbers of its rows; one row without numbers of a case that failed.
    rows: Vec<Vec<Number>>,
    /// Key of a point of its sweep, and the values of all points.
    sweep: Option<(&'static str, Vec<toml::Value>)>,
    warnings: usize,
    wall_time: f64,
    failure: Option<String>,
}

/// A number in its column.
struct Number {
    column: TableColumn,
    value: f64,
}

impl CaseData {
    fn failed(message: String) -> Self {
        Self { rows: vec![Vec::new()], sweep: None, warnings: 0, wall_time: 0.0, failure: Some(message) }
    }

    fn of(results: &Results) -> Result<Self> {
        let summary = results.summary()?;
        let sweep = match &summary.outcome {
            Outcome::Sweep(_) => points::swept(&summary.case),
            Outcome::Static(_) | Outcome::Passes(_) => None,
        };
        // A table must not depend on where it was computed.
        let warnings = summary.warnings.iter().filter(|warning| *warning != NO_LOCKS).count();
        let wall_time = summary.wall_time_s;
        Ok(Self { rows: rows(results, &summary)?, sweep, warnings, wall_time, failure: None })
    }
}

/// Reads the data of a case. A case with a damaged file counts as failed, so that the others have their rows.
fn found(folder: &Folder, case: usize) -> Result<Option<CaseData>> {
    if !folder.is_done(case) {
        return Ok(folder.failure(case)?.map(CaseData::failed));
    }
    match Results::open(&folder.case(case)).and_then(|results| CaseData::of(&results)) {
        Err(Error::File { path, source }) if is_damage(&source) => {
            let file = path.file_name().unwrap_or_default().display();
            let message = format!(
                "its {file} is damaged; without its summary.json the case is computed again: {source}"
            );
            Ok(Some(CaseData::failed(message)))
        }
        data => data.map(Some),
    }
}

/// Whether an error means that a file is damaged; a row of a table that cannot be read has no kind of its
/// own.
fn is_damage(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::InvalidData | ErrorKind::UnexpectedEof | ErrorKind::Other)
}

/// Returns the numbers of the rows of a case: a row per point of a sweep, else one.
fn rows(results: &Results, summary: &Summary) -> Result<Vec<Vec<Number>>> {
    let rows = match &summary.outcome {
        Outcome::Sweep(_) => joined::of_run(results, summary)?,
        Outcome::Static(_) | Outcome::Passes(_) => vec![whole(summary)],
    };
    Ok(rows.into_iter().map(|row| numbers(summary, row)).collect())
}

/// Returns the numbers of a row, with those of the interface.
fn numbers(summary: &Summary, row: Vec<Cell>) -> Vec<Number> {
    let moves = matches!(summary.outcome, Outcome::Passes(_));
    let interface = summary.interface.record().into_iter().flat_map(|record| joined::cells("", record, &[]));
    let number = |cell: Cell| {
        let value = cell.number();
        let is_of_pass = matches!(cell.over_motion, OverMotion::LastPass | OverMotion::MeanOfPass);
        let of_last_pass = moves && is_of_pass;
        let column = TableColumn { name: cell.name, of_last_pass, answer: cell.answer };
        Some(Number { column, value }).filter(|number| !number.value.is_nan())
    };
    row.into_iter().chain(interface).filter_map(number).collect()
}

/// Returns the columns that answer the question of the user: those of capabilities first, which say so, then
/// those of the interface and of the laws of the bodies, which get their names.
fn answers(columns: &mut [TableColumn]) -> Vec<usize> {
    let known = with::answering_columns();
    let mut ranked = Vec::new();
    for (n, column) in columns.iter_mut().enumerate() {
        let name = column.name.strip_prefix(SLIDING).unwrap_or(&column.name);
        let place = known.iter().position(|(known, _)| known == name);
        // A value of a single pass is no answer about all of them.
        let adds_up =
            declared(PassRecord::COLUMNS, name).is_none_or(|c| c.over_motion != OverMotion::MeanOfPass);
        if let Some(place) = place.filter(|_| column.answer.is_none() && (adds_up || !column.of_last_pass)) {
            column.answer = Some(known[place].1.clone());
        }
        if column.answer.is_some() {
            ranked.push((place.map_or(0, |place| place + 1), n));
        }
    }
    ranked.sort();
    ranked.into_iter().map(|(_, n)| n).collect()
}

/// Prefix of the columns of the last update of a contact that slides in place.
const SLIDING: &str = "sliding_";

/// Returns the row of a case as a whole: the record of a static contact, or the totals and the last states of
/// a motion. Then the values of sliding in place, of running-in, of the residual plastic flow, of the last
/// most stressed point, and of the capabilities.
fn whole(summary: &Summary) -> Vec<Cell> {
    let of_record = |mut cells: Vec<Cell>| {
        cells.iter_mut().for_each(|cell| cell.over_motion = OverMotion::State);
        cells
    };
    let mut row = match &summary.outcome {
        Outcome::Static(record) => joined::cells("", &**record, StaticRecord::COLUMNS),
        Outcome::Passes(passes) => joined::of_motion(passes),
        Outcome::Sweep(_) => Vec::new(),
    };
    if let Some(update) = &summary.sliding {
        row.extend(joined::cells(SLIDING, update, UpdateRecord::COLUMNS));
    }
    if let Some(running_in) = &summary.running_in {
        row.extend(of_record(joined::cells("", running_in, RunningIn::COLUMNS)));
    }
    if let Some(flow) = &summary.plasticity {
        row.extend(of_record(joined::cells("", flow, PlasticRecord::COLUMNS)));
    }
    joined::add_stress(&mut row, summary.subsurface.last());
    // A motion has the mean of each pass, of which the last one counts.
    let mut last = summary.found.clone();
    each!(capability C => {
        let of_last = with::of_last(C::rows(&last)).cloned().collect();
        C::add(&mut last, of_last);
    });
    joined::add_found(slice::from_mut(&mut row), &last, |_, _| Some(0));
    row
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use crate::columns::unit_of_column;

    /// Numbers of a summary by name; each has a unit.
    fn numbers_of(summary: &Summary) -> BTreeMap<String, f64> {
        let numbers = numbers(summary, whole(summary));
        let count = numbers.len();
        let numbers: BTreeMap<_, _> = numbers.into_iter().map(|n| (n.column.name, n.value)).collect();
        assert_eq!(numbers.len(), count, "each name once");
        let without: Vec<_> = numbers.keys().filter(|name| unit_of_column(name).is_none()).collect();
        assert!(without.is_empty(), "no unit of {without:?}");
        numbers
    }

    #[test]
    fn a_contact_of_bodies_that_stick_has_the_numbers_of_its_adhesion() {
        let record = |key: &str, mut record: Value| {
            let contact = json!({
                "load": -1e-9, "approach": 1e-9, "contact_area": 1e-16, "apparent_area": 1e-15, "max_pressure": 1e6, "mean_gap": 1e-9,
                "elastic_energy": 1e-18, "plastic_cells": 0, "plastic_volume": 0.0, "iterations": 9, "convolutions": 12.0,
                "residual": 1e-7, "adhesive_load": 2e-9, "min_pressure": -1e7, "adhesion_energy": -1e-17, "energy_lost": 0.0,
                "jumps": 0,
            });
            record[key] = contact;
            record
        };
        let adhesion = json!({
            "range": 1e-9, "max_tension": 5e7, "process_zone": 2e-9, "process_zone_cells": 2.0, "tabor": 0.7,
            "pastewka_robbins": null, "full_contact_energy": null, "pull_off": -3e-9, "work_of_separation": 1e-17,
        });
        let summary =
            json!({ "version": "", "case": {}, "warnings": [], "wall_time_s": 1.0, "adhesion": adhesion });
        let summary: Summary = serde_json::from_value(record("static", summary)).unwrap();
        let numbers = numbers_of(&summary);
        let of = |name: &str| numbers.get(name).copied();
        assert_eq!([of("adhesive_load"), of("pull_off"), of("tabor")], [Some(2e-9), Some(-3e-9), Some(0.7)]);
        assert_eq!(of("pastewka_robbins"), None);
    }

    #[test]
    fn a_motion_of_bodies_that_flow_has_the_numbers_of_its_plastic_flow() {
        let summary: Summary = serde_json::from_value(json!({
            "version": "", "case": {}, "passes": [], "warnings": [], "wall_time_s": 1.0,
            "plasticity": {
                "max_plastic_strain": 0.02, "max_plastic_strain_position": [1e-6, 2e-6, 3e-6], "yielded_volume": 1e-15,
                "plastic_work": 1e-9, "stored_energy": 1e-11, "displaced_volume": 1e-17, "max_residual_tension": 3e8,
                "residual_displacement": 1e-8, "products": 12, "mismatch": 1e-5, "regime": "ratchets",
                "strain_per_pass": 1e-4, "shift_per_pass": -2e-9,
            },
        }))
        .unwrap();
        let numbers = numbers_of(&summary);
        let of = |name: &str| numbers.get(name).copied();
        assert_eq!(of("max_plastic_strain_position_z"), Some(3e-6));
        assert_eq!([of("shift_per_pass"), of("max_residual_tension")], [Some(-2e-9), Some(3e8)]);
    }

    #[test]
    fn a_contact_that_conducts_and_leaks_has_their_numbers() {
        let conductance = json!({
            "step": 1, "load": 0.1, "mean_pressure": 1e6, "contact_area": 1e-12, "spots": 7.0, "median_spot_cells": 12.0,
            "spot_share": 0.9, "gas_share": 0.1, "film_share": 0.2, "power": 1.5, "convolutions": 20.0, "residual": 1e-7,
            "thermal_conductivity": 46.0, "thermal_conductance": 0.02, "thermal_joint_conductance": 2e4,
            "thermal_resistance": 50.0, "thermal_resistance_full": null, "thermal_resistance_holm_greenwood": null,
            "thermal_joint_correlation": 2.1e4,
        });
        let flow = |along: &str, leakage: f64| {
            json!({
                "step": 1, "along": along, "length": 1e-3, "load": 0.1, "mean_pressure": 1e6, "contact_area": 1e-12,
                "mean_gap": 1e-7, "permeability": 1e-22, "permeability_across": 0.0, "hydraulic_gap": 5e-8,
                "flow_factor": 0.1, "leakage": leakage, "critical_gap": 1e-8, "critical_x": 1e-6, "critical_y": 2e-6,
                "critical_cells": 4, "flowing_share": 0.8, "trapped_volume": 1e-20, "effective_medium": 2e-22,
                "estimate": 0.01, "residual": 1e-14,
            })
        };
        let summary: Summary = serde_json::from_value(json!({
            "version": "", "case": {}, "passes": [], "warnings": [], "wall_time_s": 1.0,
            "conductance": [conductance], "flow": [flow("x", 1e-15), flow("y", 2e-15)],
        }))
        .unwrap();
        let numbers = numbers_of(&summary);
        let of = |name: &str| numbers.get(name).copied();
        assert_eq!([of("flow_x_leakage"), of("flow_y_leakage")], [Some(1e-15), Some(2e-15)]);
        assert_eq!([of("thermal_joint_conductance"), of("conductance_spots")], [Some(2e4), Some(7.0)]);
        // The same residual is another number, and the same load is not.
        assert_eq!([of("conductance_residual"), of("flow_x_residual")], [Some(1e-7), Some(1e-14)]);
    }
}

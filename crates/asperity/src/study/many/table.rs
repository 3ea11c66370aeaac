//! Results of a study: a row per case, with the values of its axes and the numbers of its summary.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::io::{self, ErrorKind};
use std::path::Path;

use rayon::prelude::*;
use serde_json::Value;

use super::axis::Axis;
use super::cell::quoted;
use super::folder::Folder;
use super::plan::Study;
use crate::error::{Error, Result};
use crate::io::atomic;
use crate::io::fields::FieldFile;
use crate::study::columns::{CASE, DONE, MESSAGE, STATE, WARNINGS, unit_of_column};
use crate::study::results::{NO_LOCKS, Results};
use crate::study::summary::{Outcome, Summary};
use crate::study::tables;

/// The finished and failed cases of a study.
///
/// It contains no times, so it is the same to the last bit for any number of processes and interruptions.
#[derive(Debug)]
pub struct Table {
    axes: Vec<Axis>,
    /// Names of the numbers of the summaries, in the order of the cases that have them.
    columns: Vec<String>,
    rows: Vec<Row>,
}

/// A finished or failed case.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Its number, from 1.
    pub case: usize,
    /// The index of the value of each axis.
    pub indices: Vec<u32>,
    /// Numbers of its summary, SI, by column of the table; NaN if missing. Empty for a failed case.
    pub numbers: Vec<f64>,
    /// Number of warnings in its summary, without the one about a file system without locks.
    pub warnings: usize,
    /// Time spent by the last process that computed it; 0 for a failed case.
    pub wall_time: f64,
    /// Reason of the failure, if it failed.
    pub failure: Option<String>,
}

impl Table {
    /// Collects the finished and failed cases of a study.
    ///
    /// # Errors
    /// [`crate::Error::File`] if a summary or a failure cannot be read.
    pub fn collect(study: &Study, folder: &Folder) -> Result<Self> {
        let found: Result<Vec<Option<CaseData>>> =
            (1..=study.len()).into_par_iter().map(|case| found(folder, case)).collect();
        let found = found?;
        let mut columns: Vec<String> = Vec::new();
        let mut known = BTreeSet::new();
        for (column, _) in found.iter().flatten().flat_map(|found| &found.numbers) {
            if known.insert(column.clone()) {
                columns.push(column.clone());
            }
        }
        let rows = found.into_iter().enumerate().filter_map(|(n, found)| {
            let CaseData { numbers, warnings, wall_time, failure } = found?;
            let numbers: BTreeMap<String, f64> = numbers.into_iter().collect();
            let numbers =
                columns.iter().map(|column| numbers.get(column).copied().unwrap_or(f64::NAN)).collect();
            Some(Row {
                case: n + 1,
                indices: study.indices(n + 1).to_vec(),
                numbers,
                warnings,
                wall_time,
                failure,
            })
        });
        Ok(Self { axes: study.axes().to_vec(), rows: rows.collect(), columns })
    }

    /// The axes of the study.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// The names of the numbers.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// The cases, in order.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Writes the table as CSV, atomically: one line per case. Missing values are empty cells.
    ///
    /// # Errors
    /// [`crate::Error::File`].
    pub fn write_csv(&self, path: &Path) -> Result<()> {
        atomic::replace(path, self.csv().as_bytes())
    }

    fn csv(&self) -> String {
        let labels = self.axes.iter().map(|axis| quoted(&axis.label()));
        let head: Vec<String> = [CASE.name.to_owned()].into_iter().chain(labels).collect();
        let mut csv = head.join(",");
        for column in self.columns.iter().map(String::as_str).chain([WARNINGS.name, STATE.name, MESSAGE.name])
        {
            let _ = write!(csv, ",{column}");
        }
        csv.push('\n');
        for row in &self.rows {
            let _ = write!(csv, "{:04}", row.case);
            for (axis, index) in self.axes.iter().zip(&row.indices) {
                let _ = write!(csv, ",{}", quoted(&axis.cell(*index as usize)));
            }
            for number in &row.numbers {
                csv.push(',');
                if !number.is_nan() {
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

    /// Writes the table as HDF5, atomically: one dataset per column, with its unit, along the cases. For values that are
    /// texts, the dataset contains indices, and a file attribute `KEY: words` the texts, one per line.
    ///
    /// # Errors
    /// [`crate::Error::File`].
    pub fn write_hdf5(&self, path: &Path) -> Result<()> {
        let mut file = FieldFile::new(path);
        file.set("version", env!("CARGO_PKG_VERSION"));
        let mut add = |name: &str, unit: &str, value: &dyn Fn(&Row) -> f64| {
            let values: Vec<f64> = self.rows.iter().map(value).collect();
            if !values.is_empty() {
                file.add_series(name, unit, "case", 1.0, 1.0, &values);
            }
        };
        add(CASE.name, CASE.unit, &|row| row.case as f64);
        add(DONE.name, DONE.unit, &|row| f64::from(u8::from(row.failure.is_none())));
        for (n, axis) in self.axes.iter().enumerate() {
            // An index of texts has no unit; a pure number has 1.
            let unit =
                if axis.numbers().is_some() && axis.unit().is_empty() { "1".to_owned() } else { axis.unit() };
            add(axis.key(), &unit, &|row| {
                let index = row.indices[n] as usize;
                axis.numbers().map_or(index as f64, |numbers| numbers[index])
            });
        }
        for (n, column) in self.columns.iter().enumerate() {
            add(column, unit_of_column(column).unwrap_or_default(), &|row| row.numbers[n]);
        }
        for axis in self.axes.iter().filter(|axis| axis.numbers().is_none()) {
            let words: Vec<String> = (0..axis.len()).map(|index| axis.cell(index)).collect();
            file.set(&format!("{}: words", axis.key()), words.join("\n").as_str());
        }
        let failures: Vec<String> = self
            .rows
            .iter()
            .filter_map(|row| Some(format!("{:04}: {}", row.case, row.failure.as_ref()?.replace('\n', " "))))
            .collect();
        if !failures.is_empty() {
            file.set("failures", failures.join("\n").as_str());
        }
        file.write()
    }
}

/// Data of a finished or failed case.
struct CaseData {
    numbers: Vec<(String, f64)>,
    warnings: usize,
    wall_time: f64,
    failure: Option<String>,
}

impl CaseData {
    fn failed(message: String) -> Self {
        Self { numbers: Vec::new(), warnings: 0, wall_time: 0.0, failure: Some(message) }
    }
}

/// Reads the data of a case. A case with a damaged summary counts as failed, so that the others have their rows.
fn found(folder: &Folder, case: usize) -> Result<Option<CaseData>> {
    if !folder.is_done(case) {
        return Ok(folder.failure(case)?.map(CaseData::failed));
    }
    match Results::open(&folder.case(case)).and_then(|results| results.summary()) {
        Ok(summary) => {
            let wall_time = summary.wall_time_s;
            // A table must not depend on where it was computed.
            let warnings = summary.warnings.iter().filter(|warning| *warning != NO_LOCKS).count();
            Ok(Some(CaseData { numbers: numbers(&summary), warnings, wall_time, failure: None }))
        }
        Err(Error::File { source, .. }) if is_damage(&source) => {
            let message =
                format!("its summary.json is damaged; without it the case is computed again: {source}");
            Ok(Some(CaseData::failed(message)))
        }
        Err(error) => Err(error),
    }
}

/// Whether an error means that a file is damaged.
fn is_damage(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::InvalidData | ErrorKind::UnexpectedEof)
}

/// Returns the numbers of a summary: the record of a static contact, or the last point of a sweep, or the last pass of a
/// motion. Then those of wear in place, of running-in, of the residual plastic flow, and of the last most stressed point.
fn numbers(summary: &Summary) -> Vec<(String, f64)> {
    let mut numbers = Vec::new();
    match &summary.outcome {
        Outcome::Static(record) => add(&mut numbers, "", &**record),
        Outcome::Sweep(points) => points.last().into_iter().for_each(|point| add(&mut numbers, "", point)),
        Outcome::Passes(passes) => passes.last().into_iter().for_each(|pass| add(&mut numbers, "", pass)),
    }
    if let Some(update) = &summary.sliding {
        add(&mut numbers, "sliding_", update);
    }
    if let Some(running_in) = &summary.running_in {
        add(&mut numbers, "", running_in);
    }
    if let Some(flow) = &summary.plasticity {
        add(&mut numbers, "", flow);
    }
    if let Some(adhesion) = &summary.adhesion {
        add(&mut numbers, "", adhesion);
    }
    if let Some(stress) = summary.subsurface.last() {
        add(&mut numbers, "subsurface_", stress);
    }
    numbers
}

/// Adds the numbers of a record, in order. Several numbers under one key have one column each.
fn add(numbers: &mut Vec<(String, f64)>, prefix: &str, record: &impl serde::Serialize) {
    for (key, text) in tables::Row::of(record).cells() {
        // Neither is a result.
        if key != "wall_time_s" {
            let value = serde_json::from_str(text).unwrap_or(Value::Null);
            flatten(numbers, format!("{prefix}{key}"), &value);
        }
    }
}

fn flatten(numbers: &mut Vec<(String, f64)>, key: String, value: &Value) {
    const AXES: [&str; 3] = ["x", "y", "z"];
    match value {
        Value::Number(number) => numbers.push((key, number.as_f64().unwrap_or(f64::NAN))),
        Value::Array(items) if items.len() <= AXES.len() => {
            items.iter().zip(AXES).for_each(|(item, axis)| flatten(numbers, format!("{key}_{axis}"), item));
        }
        Value::Object(items) => {
            items.iter().for_each(|(inner, item)| flatten(numbers, format!("{key}_{inner}"), item));
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

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
        let numbers = numbers(&summary);
        let of = |name: &str| numbers.iter().find(|(column, _)| column == name).map(|(_, number)| *number);
        assert_eq!(of("max_plastic_strain_position_z"), Some(3e-6));
        assert_eq!([of("shift_per_pass"), of("max_residual_tension")], [Some(-2e-9), Some(3e8)]);
        let without: Vec<_> = numbers.iter().filter(|(name, _)| unit_of_column(name).is_none()).collect();
        assert!(without.is_empty(), "no unit of {without:?}");
    }
}

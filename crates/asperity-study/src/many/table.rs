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
use crate::columns::{CASE, DONE, MESSAGE, STATE, WARNINGS, unit_of_column};
use crate::io::atomic;
use crate::io::fields::FieldFile;
use crate::results::{NO_LOCKS, Results};
use crate::summary::{Outcome, Summary};
use crate::tables;
use asperity_base::error::{Error, Result};
use asperity_contact::each_capability;
use asperity_contact::with::{Capability, Reported, Row as _};

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
    /// [`asperity_base::Error::File`] if a summary or a failure cannot be read.
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
    /// [`asperity_base::Error::File`].
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
    /// [`asperity_base::Error::File`].
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
            let unit = if axis.numbers().is_some() && axis.unit().is_empty() {
                "1".to_owned()
            } else {
                axis.unit().to_owned()
            };
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
/// motion. Then those of sliding in place, of running-in, of the residual plastic flow, of the interface, of the last most stressed point, and
/// of the capabilities.
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
    if let Some(interface) = summary.interface.record() {
        add(&mut numbers, "", interface);
    }
    if let Some(stress) = summary.subsurface.last() {
        add(&mut numbers, "subsurface_", stress);
    }
    each_capability!(C => {
        let rows = C::rows(&summary.found);
        // A motion has the mean of each pass, of which the last one counts.
        let of_last = rows.iter().filter(|row| row.pass() == rows.last().and_then(|last| last.pass()));
        of_last.for_each(|row| add_beside::<C>(&mut numbers, row));
    });
    numbers
}

/// Adds the numbers of a record, in order. Several numbers under one key have one column each.
fn add(numbers: &mut Vec<(String, f64)>, prefix: &str, record: &impl serde::Serialize) {
    for (key, value) in of_record(record) {
        flatten(numbers, format!("{prefix}{key}"), &value);
    }
}

/// Adds the numbers of a row of a capability. Its contact has some of them too, which have one column.
fn add_beside<C: Capability>(numbers: &mut Vec<(String, f64)>, row: &C::Row) {
    const PLACE: [&str; 2] = ["pass", "step"];
    const OF_CONTACT: [&str; 3] = ["load", "mean_pressure", "contact_area"];
    for (key, value) in of_record(row) {
        let is_there = |key: &str| numbers.iter().any(|(known, _)| known == key);
        if PLACE.contains(&key.as_str()) || OF_CONTACT.contains(&key.as_str()) && is_there(&key) {
            continue;
        }
        flatten(numbers, format!("{}{key}", C::prefix(row, &key)), &value);
    }
}

/// Keys and values of a record that are results.
fn of_record(record: &impl serde::Serialize) -> Vec<(String, Value)> {
    let row = tables::Row::of(record);
    let results = row.cells().iter().filter(|(key, _)| key != "wall_time_s");
    let value = |text: &str| serde_json::from_str(text).unwrap_or(Value::Null);
    results.map(|(key, text)| (key.clone(), value(text))).collect()
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
        let numbers = numbers(&summary);
        let of = |name: &str| numbers.iter().find(|(column, _)| column == name).map(|(_, number)| *number);
        assert_eq!([of("adhesive_load"), of("pull_off"), of("tabor")], [Some(2e-9), Some(-3e-9), Some(0.7)]);
        assert_eq!(of("pastewka_robbins"), None);
        let without: Vec<_> = numbers.iter().filter(|(name, _)| unit_of_column(name).is_none()).collect();
        assert!(without.is_empty(), "no unit of {without:?}");
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
        let numbers = numbers(&summary);
        let of = |name: &str| numbers.iter().find(|(column, _)| column == name).map(|(_, number)| *number);
        assert_eq!(of("max_plastic_strain_position_z"), Some(3e-6));
        assert_eq!([of("shift_per_pass"), of("max_residual_tension")], [Some(-2e-9), Some(3e8)]);
        let without: Vec<_> = numbers.iter().filter(|(name, _)| unit_of_column(name).is_none()).collect();
        assert!(without.is_empty(), "no unit of {without:?}");
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
        let numbers = numbers(&summary);
        let of = |name: &str| numbers.iter().find(|(column, _)| column == name).map(|(_, number)| *number);
        assert_eq!([of("flow_x_leakage"), of("flow_y_leakage")], [Some(1e-15), Some(2e-15)]);
        assert_eq!([of("thermal_joint_conductance"), of("conductance_spots")], [Some(2e4), Some(7.0)]);
        // The same residual is another number, and the same load is not.
        assert_eq!([of("conductance_residual"), of("flow_x_residual")], [Some(1e-7), Some(1e-14)]);
        let mut beside = vec![("contact_area".to_owned(), 1e-12)];
        add_beside::<asperity_contact::flow::Leakage>(&mut beside, &summary.found.flow[0]);
        assert_eq!(beside.iter().filter(|(name, _)| name.ends_with("contact_area")).count(), 1);
        let names: std::collections::BTreeSet<_> = numbers.iter().map(|(name, _)| name).collect();
        assert_eq!(names.len(), numbers.len(), "{numbers:?}");
        let without: Vec<_> = numbers.iter().filter(|(name, _)| unit_of_column(name).is_none()).collect();
        assert!(without.is_empty(), "no unit of {without:?}");
    }
}

//! `steps.csv`, `passes.csv`, `increments.csv`, `sweep.csv`: a row per position, per pass, per increment of a loading, per
//! point of a sweep.
//!
//! A table is always written whole and atomically, after each pass: a killed run leaves the tables of the last
//! finished pass, never half a row. Numbers are written so that they read back to the same bits.

use std::path::Path;
use std::{fmt, io};

use serde::de::{DeserializeOwned, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use crate::error::{Error, Result};
use crate::io::atomic;
use crate::motion::{IncrementRecord, LostVolume, PassRecord, StepRecord, SweepRecord};

/// Columns of `steps.csv`.
pub const STEP_COLUMNS: [&str; 17] = [
    "pass",
    "step",
    "offset",
    "overlap_columns",
    "approach",
    "load",
    "tangential_force",
    "contact_area",
    "contact_area_interior",
    "largest_spot_cells",
    "max_pressure",
    "plastic_cells",
    "plastic_volume",
    "plastic_volume_interior",
    "iterations",
    "convolutions",
    "residual",
];

/// Columns of `passes.csv`.
pub const PASS_COLUMNS: [&str; 23] = [
    "pass",
    "approach",
    "mean_load",
    "mean_tangential_force",
    "friction_coefficient",
    "min_load",
    "max_load",
    "mean_pressure",
    "mean_contact_area",
    "mean_contact_area_interior",
    "largest_spot_cells",
    "max_pressure",
    "plastic_volume_lower",
    "plastic_volume_upper",
    "plastic_volume_lower_interior",
    "plastic_volume_upper_interior",
    "sq_lower",
    "sq_upper",
    "sq_lower_interior",
    "sq_upper_interior",
    "outer_iterations",
    "convolutions",
    "wall_time_s",
];

/// Columns of `increments.csv`.
pub const INCREMENT_COLUMNS: [&str; 18] = [
    "increment",
    "stage",
    "load",
    "approach",
    "tangential_force_x",
    "tangential_force_y",
    "tangential_displacement_x",
    "tangential_displacement_y",
    "contact_area",
    "stick_area",
    "max_pressure",
    "max_shear",
    "plastic_volume",
    "elastic_energy",
    "dissipation",
    "iterations",
    "convolutions",
    "residual",
];

/// Columns of `sweep.csv`.
pub const SWEEP_COLUMNS: [&str; 23] = [
    "point",
    "load",
    "mean_pressure",
    "approach",
    "mean_gap",
    "contact_area",
    "contact_fraction",
    "largest_spot_cells",
    "max_pressure",
    "plastic_area",
    "plastic_volume",
    "elastic_energy",
    "stiffness",
    "creepage_x",
    "creepage_y",
    "tangential_force_x",
    "tangential_force_y",
    "stick_area",
    "max_shear",
    "dissipation",
    "iterations",
    "convolutions",
    "residual",
];

/// Writes `sweep.csv`. A stiffness that there is not is an empty cell.
///
/// # Errors
/// [`Error::File`].
pub(super) fn write_sweep(path: &Path, points: &[SweepRecord]) -> Result<()> {
    write(path, &SWEEP_COLUMNS, points)
}

/// Reads `sweep.csv`.
///
/// # Errors
/// [`Error::File`], with the line where a row is damaged.
pub(super) fn read_sweep(path: &Path) -> Result<Vec<SweepRecord>> {
    read(path)
}

/// Writes `increments.csv`.
///
/// # Errors
/// [`Error::File`].
pub(super) fn write_increments(path: &Path, increments: &[IncrementRecord]) -> Result<()> {
    write(path, &INCREMENT_COLUMNS, increments)
}

/// Reads `increments.csv`.
///
/// # Errors
/// [`Error::File`], with the line where a row is damaged.
pub(super) fn read_increments(path: &Path) -> Result<Vec<IncrementRecord>> {
    read(path)
}

/// Writes `steps.csv`.
///
/// # Errors
/// [`Error::File`].
pub(super) fn write_steps(path: &Path, steps: &[StepRecord]) -> Result<()> {
    let rows: Vec<Row> = steps.iter().map(Row::of).collect();
    let columns = rows.first().map_or(STEP_COLUMNS.to_vec(), Row::columns);
    let values: Vec<_> = rows.iter().map(|row| row.values(&columns)).collect();
    write(path, &columns, &values)
}

/// Reads `steps.csv`, to resume.
///
/// # Errors
/// [`Error::File`]; the message has the line where a row is damaged.
pub(super) fn read_steps(path: &Path) -> Result<Vec<StepRecord>> {
    read(path)
}

/// Writes `passes.csv`.
///
/// # Errors
/// [`Error::File`].
pub(super) fn write_passes(path: &Path, passes: &[PassRecord]) -> Result<()> {
    // What a law takes is told in the rows of all passes, once it has taken something in one.
    let laws: Vec<&LostVolume> = passes.iter().flat_map(|pass| &pass.lost).collect();
    let complete = |pass: &PassRecord| {
        let mut pass = pass.clone();
        for lost in &laws {
            if pass.lost.iter().all(|known| known.law != lost.law) {
                pass.lost.push(LostVolume::nothing(&lost.law));
            }
        }
        Row::of(&pass)
    };
    let rows: Vec<Row> = passes.iter().map(complete).collect();
    let columns = rows.first().map_or(PASS_COLUMNS.to_vec(), Row::columns);
    let values: Vec<_> = rows.iter().map(|row| row.values(&columns)).collect();
    write(path, &columns, &values)
}

/// Reads `passes.csv`, to resume.
///
/// # Errors
/// [`Error::File`]; the message has the line where a row is damaged.
pub(super) fn read_passes(path: &Path) -> Result<Vec<PassRecord>> {
    read(path)
}

/// A record whose columns depend on what is recorded, as text.
struct Row(Vec<(String, String)>);

impl Row {
    fn of(record: &impl Serialize) -> Self {
        let text = serde_json::to_string(record).expect("a record of numbers is JSON");
        serde_json::from_str(&text).expect("a record is an object")
    }

    fn columns(&self) -> Vec<&str> {
        self.0.iter().map(|(column, _)| column.as_str()).collect()
    }

    /// The values in the order of these columns.
    fn values(&self, columns: &[&str]) -> Vec<&str> {
        let value =
            |column: &&str| self.0.iter().find(|(known, _)| known == column).map(|(_, value)| value.as_str());
        columns.iter().map(|column| value(column).unwrap_or_default()).collect()
    }
}

impl<'de> Deserialize<'de> for Row {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        struct InOrder;

        impl<'de> Visitor<'de> for InOrder {
            type Value = Row;

            fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
                formatter.write_str("a record of numbers")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> std::result::Result<Row, A::Error> {
                let mut row = Vec::new();
                while let Some((column, value)) = map.next_entry::<String, serde_json::Value>()? {
                    // JSON has no numbers that are none.
                    row.push((column, if value.is_null() { "NaN".to_owned() } else { value.to_string() }));
                }
                Ok(Row(row))
            }
        }

        deserializer.deserialize_map(InOrder)
    }
}

fn write<T: Serialize>(path: &Path, columns: &[&str], rows: &[T]) -> Result<()> {
    atomic::write_with(path, |file| {
        // The header is written by hand, so that a table without rows has one too.
        let mut table = csv::WriterBuilder::new().has_headers(false).from_writer(file);
        table.write_record(columns)?;
        for row in rows {
            table.serialize(row)?;
        }
        table.flush()
    })
}

fn read<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>> {
    let failed = |source| Error::File { path: path.to_owned(), source };
    let file = std::fs::File::open(path).map_err(failed)?;
    let rows =
        csv::Reader::from_reader(file).into_deserialize().collect::<std::result::Result<_, csv::Error>>();
    rows.map_err(|error| failed(io::Error::from(error)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{HeatRecord, RunningRecord};

    fn step(step: usize) -> StepRecord {
        StepRecord {
            pass: 1,
            step,
            offset: -1.0 / 3.0 * 1e-6,
            overlap_columns: 17,
            approach: f64::MIN_POSITIVE,
            load: 0.1 + 0.2,
            tangential_force: -0.03,
            contact_area: 1e-300,
            contact_area_interior: 0.0,
            largest_spot_cells: 1,
            max_pressure: 4e9,
            heat: None,
            plastic_cells: 0,
            plastic_volume: 0.0,
            plastic_volume_interior: 0.0,
            iterations: 12,
            convolutions: 13.25,
            residual: f64::NAN,
        }
    }

    fn pass() -> PassRecord {
        PassRecord {
            running: None,
            pass: 1,
            approach: 1e-7,
            mean_load: 2.0,
            mean_tangential_force: 0.2,
            friction_coefficient: 0.1,
            min_load: 0.0,
            max_load: 3.0,
            mean_pressure: 2e7,
            mean_contact_area: 1e-10,
            mean_contact_area_interior: 8e-11,
            largest_spot_cells: 7,
            max_pressure: 4e9,
            lost: vec![LostVolume {
                law: "plastic".to_owned(),
                whole: [1e-18, 2e-18],
                interior: [6e-19, 1e-18],
            }],
            sq_lower: 2e-7,
            sq_upper: 1.0 / 7.0,
            sq_lower_interior: 1.9e-7,
            sq_upper_interior: 1.0 / 8.0,
            outer_iterations: 4,
            convolutions: 800.0,
            wall_time_s: 0.25,
        }
    }

    fn point(stiffness: Option<f64>) -> SweepRecord {
        SweepRecord {
            point: 2,
            load: 0.1 + 0.2,
            mean_pressure: 1e6,
            approach: -1.0 / 3.0 * 1e-7,
            mean_gap: 1e-7,
            contact_area: 1e-10,
            contact_fraction: 1.0 / 7.0,
            largest_spot_cells: 7,
            max_pressure: 4e9,
            plastic_area: 0.0,
            plastic_volume: 0.0,
            elastic_energy: 1e-9,
            stiffness,
            creepage_x: 1e-3,
            creepage_y: 0.0,
            tangential_force_x: 0.1,
            tangential_force_y: -0.0,
            stick_area: 1e-11,
            max_shear: 1e9,
            dissipation: 1e-12,
            iterations: 12,
            convolutions: 21.25,
            residual: 1e-7,
        }
    }

    #[test]
    fn the_columns_are_those_promised() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("table.csv");
        for (columns, row) in [
            (&STEP_COLUMNS[..], serde_json::to_value(step(1)).unwrap()),
            (&PASS_COLUMNS[..], serde_json::to_value(pass()).unwrap()),
            (&SWEEP_COLUMNS[..], serde_json::to_value(point(None)).unwrap()),
        ] {
            let mut names: Vec<_> = row.as_object().unwrap().keys().map(String::as_str).collect();
            let mut sorted = columns.to_vec();
            names.sort_unstable();
            sorted.sort_unstable();
            assert_eq!(names, sorted);
        }
        write_steps(&path, &[]).unwrap();
        let header = |columns: &[&str]| columns.join(",") + "\n";
        assert_eq!(std::fs::read_to_string(&path).unwrap(), header(&STEP_COLUMNS));
        assert_eq!(read_steps(&path).unwrap(), []);
        write_passes(&path, &[]).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), header(&PASS_COLUMNS));
    }

    #[test]
    fn numbers_read_back_to_the_same_bits() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("table.csv");
        write_steps(&path, &[step(1), step(2)]).unwrap();
        let steps = read_steps(&path).unwrap();
        assert_eq!(format!("{steps:?}"), format!("{:?}", [step(1), step(2)]), "NaN included");
        assert_eq!(steps[1].load.to_bits(), (0.1f64 + 0.2).to_bits());
        write_passes(&path, &[pass()]).unwrap();
        assert_eq!(read_passes(&path).unwrap(), [pass()]);
        assert!(std::fs::read_to_string(&path).unwrap().starts_with(&PASS_COLUMNS.join(",")));
        let wear = LostVolume { law: "wear".to_owned(), whole: [0.0, 1.0 / 3.0], interior: [0.0, 0.25] };
        let worn = |pass: PassRecord| PassRecord { lost: [pass.lost, vec![wear.clone()]].concat(), ..pass };
        let passes = [worn(pass()), PassRecord { friction_coefficient: f64::NAN, ..worn(pass()) }];
        write_passes(&path, &passes).unwrap();
        assert_eq!(
            format!("{:?}", read_passes(&path).unwrap()),
            format!("{passes:?}"),
            "volumes of two laws"
        );
        let points = [point(None), point(Some(1.0 / 3.0 * 1e7))];
        write_sweep(&path, &points).unwrap();
        assert_eq!(read_sweep(&path).unwrap(), points);
    }

    #[test]
    fn a_pass_of_bodies_that_wear_reads_back_with_what_is_not_known_of_it() {
        let running = RunningRecord {
            represents: 30,
            time: f64::NAN,
            distance: 0.1 + 0.2,
            max_wear_lower: 1e-12,
            max_wear_upper: 0.0,
            mean_film_lower: 0.0,
            mean_film_upper: 1.0 / 3.0,
            friction_work: 0.0,
            max_flash_temperature: f64::NAN,
            error_estimate: 1e-15,
        };
        let worn = PassRecord { running: Some(running), ..pass() };
        let json = serde_json::to_string(&worn).unwrap();
        let read: PassRecord = serde_json::from_str(&json).unwrap();
        assert_eq!(format!("{read:?}"), format!("{worn:?}"));
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("table.csv");
        write_passes(&path, &[worn.clone(), worn.clone()]).unwrap();
        assert_eq!(format!("{:?}", read_passes(&path).unwrap()), format!("{:?}", [worn.clone(), worn]));
        let warm = HeatRecord { friction_power: 0.1, max_flash_temperature: 373.15 };
        let steps = [step(1), step(2)].map(|step| StepRecord { heat: Some(warm), ..step });
        write_steps(&path, &steps).unwrap();
        assert_eq!(format!("{:?}", read_steps(&path).unwrap()), format!("{steps:?}"));
    }

    #[test]
    fn a_damaged_row_is_an_error_with_its_line() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("steps.csv");
        write_steps(&path, &[step(1), step(2)]).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, &text[..text.len() - 40]).unwrap();
        let message = read_steps(&path).unwrap_err().to_string();
        assert!(message.contains("line: 3"), "{message}");
    }
}

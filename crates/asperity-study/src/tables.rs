//! `steps.csv`, `passes.csv`, `increments.csv`, `sweep.csv`: one row per position, pass, increment of a
//! loading, or point of a sweep.
//!
//! A table grows by the rows of each finished step. Only rows with a line end count, so that half a row left
//! by a power cut is ignored. Numbers read back to the same bits.

use std::borrow::Cow;
use std::io::{BufRead, BufReader, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::{fmt, io};

use serde::de::{DeserializeOwned, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use crate::io::fs::{self, File};
use crate::io::{atomic, regular, sha256};
use crate::json;
use asperity_base::error::{Error, Result};
use asperity_base::record::{Presence, Record};
use asperity_contact::motion::{PassRecord, StepRecord, is_volume_of_law};

/// Converts records to rows.
///
/// # Errors
/// [`Error::NotFinite`] for a number that is NaN or infinite, unless it may be unknown.
pub(super) fn checked<T: Record>(records: &[T]) -> Result<Vec<Row>> {
    let row = |record: &T| {
        let row = Row::from_record(record);
        let may_be_unknown =
            |name: &str| T::COLUMNS.iter().any(|c| c.name == name && c.presence == Presence::Unknown);
        let wrong = |(column, value): &&(String, String)| {
            (value.is_empty() || value.contains("null")) && !may_be_unknown(column)
        };
        match row.0.iter().find(wrong) {
            None => Ok(row),
            Some((column, _)) => {
                Err(record.error_at(Error::NotFinite { field: column.clone(), cell: Vec::new() }))
            }
        }
    };
    records.iter().map(row).collect()
}

/// A table to which rows are appended.
pub(super) struct GrowingTable {
    path: PathBuf,
    /// Its columns; empty for a table without rows.
    columns: Vec<String>,
}

impl GrowingTable {
    /// Opens the table at `path` with its first `rows` rows. It must exist unless `rows` is 0. Later rows,
    /// left by a killed run, are removed.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(super) fn open(path: PathBuf, rows: usize) -> Result<Self> {
        let columns = if rows == 0 { Vec::new() } else { keep(&path, rows).map_err(failed(&path))? };
        Ok(Self { path, columns })
    }

    /// Appends some `records`.
    ///
    /// # Errors
    /// [`Error::File`], [`Error::NotFinite`]; the table is then unchanged.
    pub(super) fn add<T: Record>(&mut self, records: &[T]) -> Result<()> {
        let rows = checked(records)?;
        let mut columns = rows.first().map_or(Vec::new(), Row::columns);
        if columns.iter().all(|column| self.columns.contains(column)) {
            return append(&self.path, &lines(&self.columns, &rows)).map_err(failed(&self.path));
        }
        // Once a law has removed volume in one pass, the rows of all passes have its columns.
        let known = self.columns.iter().filter(|column| !columns.contains(column));
        columns.extend(known.cloned().collect::<Vec<_>>());
        let mut before = if self.columns.is_empty() {
            Vec::new()
        } else {
            raw_rows(&self.path).map_err(failed(&self.path))?
        };
        before.extend(rows);
        write_rows(&self.path, &columns, &before)?;
        self.columns = columns;
        Ok(())
    }
}

/// Returns the number of complete rows of the table at `path`; `None` if there is no table.
///
/// # Errors
/// [`Error::File`].
pub(super) fn rows_there(path: &Path) -> Result<usize> {
    if !fs::exists(path) {
        return Ok(0);
    }
    let text = regular::read(path, TABLE, u64::MAX).map_err(failed(path))?;
    Ok(text.iter().filter(|byte| **byte == b'\n').count().saturating_sub(1))
}

/// Counts the first rows of the table at `path` whose number in a `column` is at most `last`; 0 if there is
/// no table.
///
/// # Errors
/// [`Error::File`].
pub(super) fn rows_up_to(path: &Path, column: &str, last: usize) -> Result<usize> {
    if rows_there(path)? == 0 {
        return Ok(0);
    }
    let text = regular::read(path, TABLE, u64::MAX).map_err(failed(path))?;
    let ended = text.iter().rposition(|byte| *byte == b'\n').map_or(0, |last| last + 1);
    let mut table = csv::Reader::from_reader(&text[..ended]);
    let headers = table.headers().map_err(|error| failed(path)(error.into()))?;
    let Some(index) = headers.iter().position(|name| name == column) else { return Ok(0) };
    let number = |row: csv::Result<csv::StringRecord>| row.ok()?.get(index)?.parse::<usize>().ok();
    Ok(table.records().map_while(number).take_while(|number| *number <= last).count())
}

/// Writes a table with these columns.
fn write_rows(path: &Path, columns: &[String], rows: &[Row]) -> Result<()> {
    let text = lines(columns, rows);
    atomic::write_with(path, |file| {
        writeln!(file, "{}", columns.join(","))?;
        file.write_all(text.as_bytes())
    })
}

/// Formats the rows in the order of these `columns`, one line each. A missing volume of a law is 0.
fn lines(columns: &[String], rows: &[Row]) -> String {
    let line = |row: &Row| row.values(columns).into_iter().map(short).collect::<Vec<_>>().join(",") + "\n";
    rows.iter().map(line).collect()
}

/// Writes a number with many zeros after its point with a power of ten: `5.75e-5`.
fn short(number: &str) -> Cow<'_, str> {
    match number.parse::<f64>() {
        Ok(value) if number.contains("0.0000") && value != 0.0 => format!("{value:?}").into(),
        _ => number.into(),
    }
}

/// Truncates a table after its header and `rows` rows; returns its columns.
fn keep(path: &Path, rows: usize) -> io::Result<Vec<String>> {
    let mut reader = BufReader::new(regular::open(path, TABLE)?);
    let mut header = String::new();
    let mut length = reader.read_line(&mut header)? as u64;
    let mut line = Vec::new();
    for _ in 0..rows {
        line.clear();
        length += reader.read_until(b'\n', &mut line)? as u64;
    }
    let file = File::options().write(true).open(path)?;
    if file.metadata()?.len() > length {
        file.set_len(length)?;
        file.sync_data()?;
    }
    Ok(header.trim_end().split(',').map(str::to_owned).collect())
}

/// Appends `text` to a file. If that fails, the file is unchanged.
fn append(path: &Path, text: &str) -> io::Result<()> {
    let mut file = File::options().append(true).open(path)?;
    let length = file.metadata()?.len();
    let written = file.write_all(text.as_bytes()).and_then(|()| file.sync_data());
    if written.is_err() {
        let _ = file.set_len(length);
    }
    written
}

/// Reads the rows of a table as text.
fn raw_rows(path: &Path) -> io::Result<Vec<Row>> {
    let mut table = csv::Reader::from_reader(regular::open(path, TABLE)?);
    let columns: Vec<String> = table.headers()?.iter().map(str::to_owned).collect();
    let row = |record: csv::Result<csv::StringRecord>| {
        Ok(Row(columns.iter().cloned().zip(record?.iter().map(str::to_owned)).collect()))
    };
    table.records().map(row).collect()
}

/// Reads the rows of a table that may be growing: only those with a line end.
///
/// # Errors
/// [`Error::File`], with the line of a damaged row.
pub(super) fn read_growing<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>> {
    let text = regular::read(path, TABLE, u64::MAX).map_err(failed(path))?;
    let ended = text.iter().rposition(|byte| *byte == b'\n').map_or(0, |last| last + 1);
    rows(path, &text[..ended])
}

/// Expected kind of the files of this module.
const TABLE: &str = "a table of results";

/// Computes the digest of rows that follow rows with the digest `before`, which is empty for the first rows.
/// Records, and the same records read back from a table, have equal digests.
pub(super) fn digest<T: Serialize>(before: &str, records: &[T]) -> String {
    records.iter().fold(before.to_owned(), |digest, record| {
        let mut text = digest;
        for (column, value) in Row::from_record(record).cells() {
            // A law without effect so far may have no columns, and times differ in a resumed run.
            let is_nothing = is_volume_of_law(column) && value.parse() == Ok(0.0_f64);
            if !is_nothing && column != "wall_time_s" {
                text += &format!(",{column}={value}");
            }
        }
        sha256(text.as_bytes())
    })
}

/// Computes the digest of finished passes, each after its positions.
pub(super) fn digest_of_passes(passes: &[PassRecord], steps: &[StepRecord]) -> String {
    let mut steps = steps;
    passes.iter().fold(String::new(), |before, pass| {
        let count = steps.iter().take_while(|step| step.pass == pass.pass).count();
        let (of_pass, others) = steps.split_at(count);
        steps = others;
        digest(&digest(&before, of_pass), std::slice::from_ref(pass))
    })
}

/// A record as text, with columns that depend on its content.
pub(super) struct Row(Vec<(String, String)>);

impl Row {
    pub(super) fn from_record(record: &impl Serialize) -> Self {
        serde_json::from_str(&json::to_string(record)).expect("a record is an object")
    }

    fn columns(&self) -> Vec<String> {
        self.0.iter().map(|(column, _)| column.clone()).collect()
    }

    /// Returns columns with their values, which are empty if missing.
    pub(super) fn cells(&self) -> &[(String, String)] {
        &self.0
    }

    /// Returns the values in the order of these columns, 0 for missing ones.
    fn values(&self, columns: &[String]) -> Vec<&str> {
        let value = |column: &String| {
            self.0.iter().find(|(known, _)| known == column).map(|(_, value)| value.as_str())
        };
        columns.iter().map(|column| value(column).unwrap_or("0.0")).collect()
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
                    row.push((column, if value.is_null() { String::new() } else { value.to_string() }));
                }
                Ok(Row(row))
            }
        }

        deserializer.deserialize_map(InOrder)
    }
}

/// Reads a complete table.
///
/// # Errors
/// [`Error::File`], with the line of a damaged row.
pub(super) fn read<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>> {
    let text = regular::read(path, TABLE, u64::MAX).map_err(failed(path))?;
    if text.last() != Some(&b'\n') {
        let damaged = io::Error::new(ErrorKind::InvalidData, "it is damaged: its last row is not whole");
        return Err(failed(path)(damaged));
    }
    rows(path, &text[..])
}

fn rows<T: DeserializeOwned>(path: &Path, table: impl io::Read) -> Result<Vec<T>> {
    let rows =
        csv::Reader::from_reader(table).into_deserialize().collect::<std::result::Result<_, csv::Error>>();
    rows.map_err(|error| failed(path)(io::Error::from(error)))
}

fn failed(path: &Path) -> impl Fn(io::Error) -> Error {
    let path = path.to_owned();
    move |source| Error::File { path: path.clone(), source }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PASS_COLUMNS;
    use asperity_contact::motion::{
        HeatRecord, IncrementRecord, LawsInPass, LostVolume, RunningRecord, SweepRecord,
    };

    fn step(step: usize) -> StepRecord {
        StepRecord {
            pass: 1,
            step,
            offset: -1.0 / 3.0 * 1e-6,
            offset_y: None,
            overlap_columns: 17,
            approach: f64::MIN_POSITIVE,
            load: 0.1 + 0.2,
            tangential_force: -0.03,
            contact_area: 1e-300,
            contact_area_interior: 0.0,
            largest_spot_cells: 1,
            max_pressure: 4e9,
            heat: None,
            interface: None,
            plastic: None,
            film: None,
            drag: None,
            plastic_cells: 0,
            plastic_volume: 0.0,
            plastic_volume_interior: 0.0,
            iterations: 12,
            convolutions: 13.25,
            residual: 1.0 / 3.0 * 1e-7,
        }
    }

    fn pass() -> PassRecord {
        PassRecord {
            running: None,
            interface: None,
            plastic: None,
            film: None,
            drag: None,
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
            contact_area_corrected: 9e-11,
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
            slip_work: 4e-13,
            iterations: 12,
            convolutions: 21.25,
            residual: 1e-7,
            interface: None,
            speed: None,
            steady: None,
            lubrication: None,
            plastic: None,
        }
    }

    fn write_new<T: Record>(path: &Path, records: &[T]) {
        GrowingTable::open(path.to_owned(), 0).unwrap().add(records).unwrap();
    }

    #[test]
    fn small_numbers_have_a_power_of_ten() {
        let numbers = ["0.0000575", "-0.00001", "0.00025", "0.0", "2.5e-9", "", "text"];
        assert_eq!(numbers.map(short), ["5.75e-5", "-1e-5", "0.00025", "0.0", "2.5e-9", "", "text"]);
    }

    #[test]
    fn numbers_read_back_to_the_same_bits() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("table.csv");
        write_new(&path, &[step(1), step(2)]);
        let steps = read_growing::<StepRecord>(&path).unwrap();
        assert_eq!(format!("{steps:?}"), format!("{:?}", [step(1), step(2)]), "to the last digit");
        assert_eq!(steps[1].load.to_bits(), (0.1f64 + 0.2).to_bits());
        write_new(&path, &[pass()]);
        assert_eq!(read_growing::<PassRecord>(&path).unwrap(), [pass()]);
        assert!(std::fs::read_to_string(&path).unwrap().starts_with(&PASS_COLUMNS.join(",")));
        let wear = LostVolume { law: "wear".to_owned(), whole: [0.0, 1.0 / 3.0], interior: [0.0, 0.25] };
        let worn = |pass: PassRecord| PassRecord { lost: [pass.lost, vec![wear.clone()]].concat(), ..pass };
        let passes = [worn(pass()), PassRecord { friction_coefficient: f64::NAN, ..worn(pass()) }];
        write_new(&path, &passes);
        assert_eq!(
            format!("{:?}", read_growing::<PassRecord>(&path).unwrap()),
            format!("{passes:?}"),
            "volumes of two laws"
        );
        let points = [point(None), point(Some(1.0 / 3.0 * 1e7))];
        write_new(&path, &points);
        assert_eq!(read::<SweepRecord>(&path).unwrap(), points);
    }

    #[test]
    fn a_pass_of_bodies_that_wear_reads_back_with_what_is_not_known_of_it() {
        let running = RunningRecord {
            represents: 30,
            time: f64::NAN,
            distance: 0.1 + 0.2,
            laws: LawsInPass {
                max_wear_lower: 1e-12,
                deepest_wear_lower: 3e-12,
                mean_film_upper: 1.0 / 3.0,
                ..LawsInPass::default()
            },
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
        write_new(&path, &[worn.clone(), worn.clone()]);
        assert_eq!(
            format!("{:?}", read_growing::<PassRecord>(&path).unwrap()),
            format!("{:?}", [worn.clone(), worn])
        );
        let warm = HeatRecord { friction_power: 0.1, max_flash_temperature: 373.15 };
        let steps = [step(1), step(2)];
        let steps = steps.map(|step| StepRecord { heat: Some(warm), offset_y: Some(3e-6), ..step });
        write_new(&path, &steps);
        assert_eq!(format!("{:?}", read_growing::<StepRecord>(&path).unwrap()), format!("{steps:?}"));
    }

    #[test]
    fn a_table_grows_from_the_rows_that_are_kept_and_by_columns() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("passes.csv");
        let worn = |pass: usize| {
            let wear = LostVolume { law: "wear".to_owned(), whole: [1.0, 2.0], interior: [0.5, 0.25] };
            PassRecord { pass, lost: vec![wear], ..self::pass() }
        };
        let mut table = GrowingTable::open(path.clone(), 0).unwrap();
        table.add(&[pass()]).unwrap();
        table.add(&[PassRecord { pass: 2, ..pass() }]).unwrap();
        // Half a row from a killed run.
        append(&path, "3,1e-9").unwrap();
        assert_eq!(read_growing::<PassRecord>(&path).unwrap().len(), 2);
        let mut table = GrowingTable::open(path.clone(), 1).unwrap();
        assert_eq!(read_growing::<PassRecord>(&path).unwrap(), [pass()]);
        table.add(&[worn(2)]).unwrap();
        table.add(&[worn(3)]).unwrap();
        let read = read_growing::<PassRecord>(&path).unwrap();
        assert_eq!(read.iter().map(|pass| pass.lost("wear")[1]).collect::<Vec<_>>(), [0.0, 2.0, 2.0]);
        assert_eq!(read.iter().map(|pass| pass.lost("plastic")[1]).collect::<Vec<_>>(), [2e-18, 0.0, 0.0]);
    }

    #[test]
    fn a_number_that_must_be_known_and_is_none_is_refused_and_the_table_stays() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("table.csv");
        let mut table = GrowingTable::open(path.clone(), 0).unwrap();
        table.add(&[pass()]).unwrap();
        let before = std::fs::read(&path).unwrap();
        for value in [f64::NAN, f64::INFINITY] {
            let spoilt = LostVolume { law: "wear".to_owned(), whole: [0.0, value], interior: [0.0; 2] };
            for wrong in [
                PassRecord { pass: 2, approach: value, ..pass() },
                PassRecord { pass: 2, lost: vec![spoilt], ..pass() },
            ] {
                let message = table.add(&[wrong]).unwrap_err().to_string();
                let column = if message.contains("approach") { "approach" } else { "wear_volume_upper" };
                assert_eq!(message, format!("pass 2: `{column}` is not a finite number"));
            }
            let apart = IncrementRecord { approach: f64::NAN, ..IncrementRecord::default() };
            write_new(&directory.path().join("increments.csv"), std::slice::from_ref(&apart));
            assert!(
                read::<IncrementRecord>(&directory.path().join("increments.csv")).unwrap()[0]
                    .approach
                    .is_nan()
            );
            let wrong = IncrementRecord { increment: 7, load: value, ..apart };
            let mut increments = GrowingTable::open(directory.path().join("increments.csv"), 0).unwrap();
            let error = increments.add(&[wrong]).unwrap_err();
            assert_eq!(error.to_string(), "increment 7: `load` is not a finite number");
        }
        assert_eq!(std::fs::read(&path).unwrap(), before);
    }

    #[test]
    fn a_digest_of_rows_stays_when_they_are_read_again_or_gain_columns() {
        let directory = tempfile::tempdir().unwrap();
        let path = |name: &str| directory.path().join(name);
        let passes =
            [1, 2].map(|number| PassRecord { pass: number, friction_coefficient: f64::NAN, ..pass() });
        let steps = [1, 2].map(|number| StepRecord { pass: number, ..step(1) });
        let before = digest_of_passes(&passes, &steps);
        let wear = LostVolume { law: "wear".to_owned(), whole: [1.0, 2.0], interior: [0.5, 0.25] };
        let mut table = GrowingTable::open(path("passes.csv"), 0).unwrap();
        table.add(&passes).unwrap();
        table.add(&[PassRecord { pass: 3, lost: vec![wear], wall_time_s: 9.0, ..pass() }]).unwrap();
        write_new(&path("steps.csv"), &steps);
        let (read, of_steps) = (
            read_growing::<PassRecord>(&path("passes.csv")).unwrap(),
            read_growing::<StepRecord>(&path("steps.csv")).unwrap(),
        );
        assert_eq!(digest_of_passes(&read[..2], &of_steps), before);
        let again = digest(&digest(&digest("", &steps[..1]), &passes[..1]), &steps[1..]);
        assert_eq!(digest(&again, &passes[1..]), before, "pass after pass");
        for changed in [0, 1] {
            let mut steps = steps.clone();
            steps[changed].load += 1e-12;
            assert_ne!(digest_of_passes(&passes, &steps), before);
            let mut passes = passes.clone();
            passes[changed].sq_lower *= 1.0 + 1e-15;
            assert_ne!(digest_of_passes(&passes, &of_steps), before);
        }
        let timed = passes.clone().map(|pass| PassRecord { wall_time_s: 7.0, ..pass });
        assert_eq!(digest_of_passes(&timed, &of_steps), before, "a time is no result");
    }

    #[test]
    fn a_table_that_is_cut_off_anywhere_is_damaged() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("sweep.csv");
        write_new(&path, &[point(None), point(Some(1e7))]);
        let whole = std::fs::read(&path).unwrap();
        let header = whole.iter().position(|byte| *byte == b'\n').unwrap();
        for length in (0..whole.len()).filter(|length| whole[..*length].last() != Some(&b'\n')) {
            std::fs::write(&path, &whole[..length]).unwrap();
            let message = read::<SweepRecord>(&path).unwrap_err().to_string();
            assert!(message.contains("sweep.csv"), "{length} of {header}: {message}");
        }
    }

    #[test]
    fn a_damaged_row_is_an_error_with_its_line() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("steps.csv");
        write_new(&path, &[step(1), step(2), step(3)]);
        let text = std::fs::read_to_string(&path).unwrap();
        let (whole, last) = text.trim_end().rsplit_once('\n').unwrap();
        std::fs::write(&path, format!("{}\n{last}\n", &whole[..whole.len() - 40])).unwrap();
        let message = read_growing::<StepRecord>(&path).unwrap_err().to_string();
        assert!(message.contains("line: 3"), "{message}");
    }
}

//! The steps of a run, each with everything that was found in it: the rows of `results.csv` and of the table
//! of a study.

use std::collections::BTreeMap;
use std::slice;

use serde::Serialize;
use serde_json::Value;

use crate::cell::quoted;
use crate::columns::{declared, headed};
use crate::io::atomic;
use crate::results::{RESULTS_TABLE, Results};
use crate::subsurface::SubsurfaceRecord;
use crate::summary::{Outcome, Summary};
use crate::tables::Row;
use asperity_base::error::Result;
use asperity_base::record::{OverMotion, Record};
use asperity_contact::each;
use asperity_contact::motion::{Column, PassRecord};
use asperity_contact::with::{Capability, Observations, Reported, Row as _};

/// A value under the name of its column.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cell {
    /// Name of the column, with the prefix of its record and the component of a vector.
    pub(super) name: String,
    /// Number or word; `null` if it is unknown.
    pub(super) value: Value,
    /// How the value of a whole motion follows from those of its passes.
    pub(super) over_motion: OverMotion,
    /// Name of the quantity, if it answers the question of the user.
    pub(super) answer: Option<String>,
}

impl Cell {
    /// The number; NaN if it is unknown or a word.
    pub(super) fn number(&self) -> f64 {
        self.value.as_f64().unwrap_or(f64::NAN)
    }
}

/// Byte order mark, without which Excel does not recognise the encoding.
pub(super) const MARK: char = '\u{feff}';

/// Writes `results.csv`, atomically: a row for each pass, point, update or increment of a run, or for its
/// contact.
///
/// # Errors
/// [`asperity_base::Error::File`].
pub(super) fn write(results: &Results, summary: &Summary) -> Result<()> {
    let rows = of_run(results, summary)?;
    let mut columns: Vec<&str> = Vec::new();
    for cell in rows.iter().flatten() {
        if !columns.contains(&cell.name.as_str()) {
            columns.push(&cell.name);
        }
    }
    let line = |cells: Vec<String>| cells.join(",") + "\n";
    let text = |row: &[Cell], column: &str| match row.iter().find(|cell| cell.name == column) {
        Some(Cell { value: Value::String(word), .. }) => quoted(word),
        Some(Cell { value, .. }) if !value.is_null() => value.to_string(),
        _ => String::new(),
    };
    let mut csv = String::from(MARK);
    csv += &line(columns.iter().map(|column| quoted(&headed(column))).collect());
    for row in &rows {
        csv += &line(columns.iter().map(|column| text(row, column)).collect());
    }
    atomic::replace(&results.directory().join(RESULTS_TABLE), csv.as_bytes())
}

/// Returns the rows of a run.
///
/// # Errors
/// [`asperity_base::Error::File`].
pub(super) fn of_run(results: &Results, summary: &Summary) -> Result<Vec<Vec<Cell>>> {
    let found = results.observations()?;
    let mut rows = match &summary.outcome {
        Outcome::Passes(passes) => return Ok(of_passes(passes, found, &summary.subsurface)),
        Outcome::Sweep(points) => of_steps(points, |point| point.point, &found),
        Outcome::Static(record) => {
            let (updates, increments) = (results.updates()?, results.increments()?);
            match (&updates[..], &increments[..]) {
                ([], []) => of_steps(slice::from_ref(&**record), |_| 1, &found),
                ([], increments) => of_steps(increments, |increment| increment.increment, &found),
                (updates, _) => of_steps(updates, |update| update.update, &found),
            }
        }
    };
    if let Some(last) = rows.last_mut() {
        add_stress(last, summary.subsurface.last());
    }
    Ok(rows)
}

/// The rows of the steps of a contact, which have these numbers.
fn of_steps<T: Record>(steps: &[T], number: fn(&T) -> usize, found: &Observations) -> Vec<Vec<Cell>> {
    let mut rows: Vec<_> = steps.iter().map(|step| cells("", step, T::COLUMNS)).collect();
    let places: BTreeMap<usize, usize> = steps.iter().map(number).zip(0..).collect();
    add_found(&mut rows, found, |_, step| places.get(&step?).copied());
    rows
}

/// The rows of passes. A capability that looks at several positions of a pass has their mean.
fn of_passes(
    passes: &[PassRecord],
    mut found: Observations,
    stresses: &[SubsurfaceRecord],
) -> Vec<Vec<Cell>> {
    each!(capability C => {
        let of_passes = C::rows(&found).chunk_by(|one, other| one.pass() == other.pass());
        let means = of_passes.flat_map(C::summary).collect();
        C::add(&mut found, means);
    });
    let places: BTreeMap<usize, usize> = passes.iter().map(|pass| pass.pass).zip(0..).collect();
    let place = |pass: Option<usize>| places.get(&pass?).copied();
    let mut rows: Vec<_> = passes.iter().map(|pass| cells("", pass, PassRecord::COLUMNS)).collect();
    for stress in stresses {
        if let Some(place) = place(stress.pass) {
            add_stress(&mut rows[place], Some(stress));
        }
    }
    add_found(&mut rows, &found, |pass, _| place(pass));
    rows
}

/// Returns the values of a whole motion, from the rows of its passes.
pub(super) fn of_motion(passes: &[PassRecord]) -> Vec<Cell> {
    let rows: Vec<Vec<Cell>> = passes.iter().map(|pass| cells("", pass, PassRecord::COLUMNS)).collect();
    let Some((last, last_pass)) = rows.last().zip(passes.last()) else { return Vec::new() };
    // A law that has removed nothing in a pass may have no columns there.
    let mut of_motion = last.clone();
    for cell in rows.iter().flatten() {
        if cell.over_motion == OverMotion::Sum && of_motion.iter().all(|known| known.name != cell.name) {
            of_motion.push(cell.clone());
        }
    }
    for total in &mut of_motion {
        let value =
            |row: &Vec<Cell>| row.iter().find(|cell| cell.name == total.name).map_or(0.0, Cell::number);
        let weighted = |(row, pass): (&Vec<Cell>, &PassRecord)| pass.represents() as f64 * value(row);
        total.value = match total.over_motion {
            OverMotion::LastPass | OverMotion::State => continue,
            OverMotion::Sum => rows.iter().map(value).sum::<f64>().into(),
            OverMotion::SumOfPasses => rows.iter().zip(passes).map(weighted).sum::<f64>().into(),
            OverMotion::MeanOfPass => (total.number() / last_pass.represents() as f64).into(),
        };
    }
    of_motion
}

/// Returns the cells of a record, one for each component of a vector.
pub(super) fn cells(prefix: &str, record: &impl Serialize, columns: &'static [Column]) -> Vec<Cell> {
    let mut cells = Vec::new();
    for (key, text) in Row::from_record(record).cells().iter().filter(|(key, _)| key != "wall_time_s") {
        let value = serde_json::from_str(text).unwrap_or(Value::Null);
        let column = declared(columns, key);
        let components = column.map_or(&[][..], |column| column.components);
        let over_motion = column.map_or(OverMotion::State, |column| column.over_motion);
        split(format!("{prefix}{key}"), value, components, &mut |name, value| {
            cells.push(Cell { name, value, over_motion, answer: None });
        });
    }
    cells
}

/// Splits a value into its components, and a map by its keys.
fn split(name: String, value: Value, components: &[&str], add: &mut impl FnMut(String, Value)) {
    match value {
        Value::Array(items) => {
            items
                .into_iter()
                .zip(components)
                .for_each(|(item, component)| add(format!("{name}_{component}"), item));
        }
        Value::Object(items) => {
            items.into_iter().for_each(|(key, item)| split(format!("{name}_{key}"), item, components, add));
        }
        value => add(name, value),
    }
}

/// Adds the stress below the surface. For bodies with layers it answers whether they crack and come off.
pub(super) fn add_stress(row: &mut Vec<Cell>, stress: Option<&SubsurfaceRecord>) {
    const PREFIX: &str = "subsurface_";
    const ANSWERS: [(&str, &str); 2] = [
        ("max_surface_tension", "largest tension at the surface"),
        ("max_interface_shear", "largest shear of the interfaces"),
    ];
    let stress = stress.into_iter().flat_map(|stress| cells(PREFIX, stress, SubsurfaceRecord::OWN_COLUMNS));
    row.extend(stress.filter(|cell| !is_place(&cell.name[PREFIX.len()..])).map(|cell| {
        let answer = ANSWERS.iter().find(|(column, _)| cell.name[PREFIX.len()..] == **column);
        Cell { answer: answer.map(|(_, words)| (*words).to_owned()), ..cell }
    }));
}

/// Adds what the capabilities have found to the rows, each to that at the place of its pass and step.
pub(super) fn add_found(
    rows: &mut [Vec<Cell>],
    found: &Observations,
    place: impl Fn(Option<usize>, Option<usize>) -> Option<usize>,
) {
    each!(capability C => for found in C::rows(found) {
        let cells = cells("", found, <<C as Capability>::Row as Record>::COLUMNS);
        let step = cells.iter().find(|cell| cell.name == "step").and_then(|cell| cell.value.as_u64());
        if let Some(place) = place(found.pass(), step.map(|step| step as usize)) {
            add_beside::<C>(&mut rows[place], found, cells);
        }
    });
}

/// Adds the cells of a row of a capability. The row of its contact has some of them too, which stand there
/// once.
fn add_beside<C: Capability>(row: &mut Vec<Cell>, found: &C::Row, cells: Vec<Cell>) {
    const OF_CONTACT: [&str; 3] = ["load", "mean_pressure", "contact_area"];
    // A word says what the prefix does.
    for cell in cells.into_iter().filter(|cell| !is_place(&cell.name) && !cell.value.is_string()) {
        let is_there =
            OF_CONTACT.contains(&cell.name.as_str()) && row.iter().any(|known| known.name == cell.name);
        if !is_there {
            let answer = answer::<C>(found, &cell.name);
            row.push(Cell { name: format!("{}{}", C::prefix(found, &cell.name), cell.name), answer, ..cell });
        }
    }
}

/// Returns what a column of a row of a capability is, if it answers the question of the user: it is that of
/// one of its curves.
fn answer<C: Capability>(row: &C::Row, column: &str) -> Option<String> {
    let curve = C::CURVES.iter().find(|curve| (curve.column)(row) == column)?;
    let main = || curve.series.iter().filter(|series| !series.is_beside);
    let series = main().find(|series| (series.has)(row))?;
    Some(if main().count() == 1 {
        curve.title.to_owned()
    } else {
        format!("{}, {}", curve.title, series.name)
    })
}

/// Whether a column of a part of a row says where it belongs.
fn is_place(column: &str) -> bool {
    ["pass", "step"].contains(&column)
}

#[cfg(test)]
mod tests {
    use serde_json::{Map, json};

    use super::*;

    /// A pass with zeros in all columns but these.
    fn pass(numbers: &[(&str, f64)]) -> PassRecord {
        let zeros = PassRecord::COLUMNS.iter().map(|column| (column.name.to_owned(), json!(0)));
        let given = numbers.iter().map(|(name, number)| ((*name).to_owned(), json!(number)));
        let whole = ["pass", "represents", "outer_iterations", "jumps", "largest_spot_cells"];
        let mut pass: Map<String, Value> = zeros.chain(given).collect();
        for name in whole {
            pass[name] = json!(pass[name].as_f64().unwrap() as u64);
        }
        serde_json::from_value(pass.into()).unwrap()
    }

    #[test]
    fn a_motion_has_sums_of_what_adds_up_last_states_and_values_of_its_last_pass() {
        let values = |name: &str, first: f64, second: f64| {
            let wear = |body: &str, end: &str| format!("wear_volume_{body}{end}");
            let of_wear: Vec<String> =
                [["lower", ""], ["upper", ""], ["lower", "_interior"], ["upper", "_interior"]]
                    .map(|[body, end]| wear(body, end))
                    .to_vec();
            let passes = [(1.0, 3.0, first), (2.0, 5.0, second)].map(|(number, represents, value)| {
                let mut numbers = vec![("pass", number), ("represents", represents)];
                numbers.extend(of_wear.iter().map(|name| (name.as_str(), 0.0)));
                numbers.push((name, value));
                pass(&numbers)
            });
            let of_motion = of_motion(&passes);
            let found: Vec<f64> =
                of_motion.iter().filter(|cell| cell.name == name).map(Cell::number).collect();
            assert_eq!(found.len(), 1, "{name}");
            found[0]
        };
        for (name, expected) in [
            // Volumes and work are those of all passes that a row represents.
            ("wear_volume_lower", 30.0),
            ("wear_volume_upper_interior", 30.0),
            ("plastic_volume_upper", 30.0),
            ("friction_work", 30.0),
            ("plastic_work_lower", 30.0),
            ("surface_shift_upper", 30.0),
            ("error_estimate", 30.0),
            ("convolutions", 30.0),
            // The losses of an attraction are those of a single pass.
            ("energy_lost", 3.0 * 10.0 + 5.0 * 20.0),
            ("jumps", 130.0),
            ("distance", 20.0),
            ("time", 20.0),
            ("sq_upper", 20.0),
            ("mean_film_lower", 20.0),
            ("deepest_wear_lower", 20.0),
            ("max_plastic_strain_lower", 20.0),
            ("residual_displacement_upper", 20.0),
            ("mean_load", 20.0),
            ("max_pressure", 20.0),
            ("max_flash_temperature", 20.0),
            ("drag_coefficient", 20.0),
            // The deepest wear of a single pass.
            ("max_wear_lower", 4.0),
        ] {
            assert_eq!(values(name, 10.0, 20.0), expected, "{name}");
        }
        assert_eq!(values("represents", 3.0, 5.0), 8.0);
        assert_eq!(values("pass", 1.0, 2.0), 2.0);
        assert!(of_motion(&[]).is_empty());
    }

    #[test]
    fn losses_have_their_bodies_and_vectors_their_components() {
        let running_in =
            json!({ "computed": 2, "represented": 8, "error_bound": 0.0, "lost": { "wear": [1.0, 2.0] } });
        let names = |record: Value, columns| -> Vec<(String, f64)> {
            let cells = cells("", &record, columns).into_iter();
            cells
                .map(|cell| {
                    let number = cell.number();
                    (cell.name, number)
                })
                .collect()
        };
        let found = names(running_in, crate::summary::RunningIn::COLUMNS);
        for (name, value) in [("lost_wear_lower", 1.0), ("lost_wear_upper", 2.0)] {
            assert!(found.contains(&(name.to_owned(), value)), "{found:?}");
        }
        let place = names(json!({ "position": [1.0, 2.0, 3.0] }), SubsurfaceRecord::OWN_COLUMNS);
        assert_eq!(
            place.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(),
            ["position_x", "position_y", "position_z"]
        );
    }
}

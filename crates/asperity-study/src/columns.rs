//! The dictionary of columns: every column of a table and every number of a summary, by its name.

use std::sync::LazyLock;

use super::closed_form::ClosedFormRecord;
use super::subsurface::SubsurfaceRecord;
use super::summary::{CONVERGED, RunningIn};
use asperity_base::units::Dimension;
use asperity_contact::each;
use asperity_contact::motion::{
    Column, CreepRecord, DragRecord, ENDINGS, FilmRecord, FrettingRecord, HeatRecord, IncrementRecord,
    LawsInCycles, LawsInPass, LawsInUpdate, LubricationRecord, PassDragRecord, PassPlasticRecord, PassRecord,
    PlasticRecord, PlasticStepRecord, Presence, ResidualRecord, RunningRecord, ShearRecord, StaticRecord,
    SteadyRecord, StepRecord, SweepRecord, UpdateRecord,
};
use asperity_contact::with::{Capability, InterfaceNumbers, Row as _};

/// Returns the records of the results by name, each with its columns.
///
/// `Converged` holds the additional columns of `static` in `summary.json`. `Table` holds the columns of the
/// table of a study other than its axes and the numbers of the records.
pub fn records() -> &'static [(&'static str, &'static [Column])] {
    static RECORDS: LazyLock<Vec<(&str, &[Column])>> = LazyLock::new(|| {
        let mut records: Vec<(&str, &[Column])> = vec![
            ("StaticRecord", StaticRecord::OWN_COLUMNS),
            ("Converged", &[CONVERGED]),
            ("ShearRecord", ShearRecord::OWN_COLUMNS),
            ("PlasticRecord", PlasticRecord::OWN_COLUMNS),
            ("ResidualRecord", ResidualRecord::OWN_COLUMNS),
            ("ClosedFormRecord", ClosedFormRecord::OWN_COLUMNS),
            ("SubsurfaceRecord", SubsurfaceRecord::OWN_COLUMNS),
            ("SweepRecord", SweepRecord::OWN_COLUMNS),
            ("SteadyRecord", SteadyRecord::OWN_COLUMNS),
            ("LubricationRecord", LubricationRecord::OWN_COLUMNS),
            ("FilmRecord", FilmRecord::OWN_COLUMNS),
            ("CreepRecord", CreepRecord::OWN_COLUMNS),
            ("DragRecord", DragRecord::OWN_COLUMNS),
            ("PassDragRecord", PassDragRecord::OWN_COLUMNS),
            ("IncrementRecord", IncrementRecord::OWN_COLUMNS),
            ("PlasticStepRecord", PlasticStepRecord::OWN_COLUMNS),
            ("FrettingRecord", FrettingRecord::OWN_COLUMNS),
            ("LawsInCycles", LawsInCycles::OWN_COLUMNS),
            ("UpdateRecord", UpdateRecord::OWN_COLUMNS),
            ("LawsInUpdate", LawsInUpdate::OWN_COLUMNS),
            ("PassRecord", PassRecord::OWN_COLUMNS),
            ("RunningRecord", RunningRecord::OWN_COLUMNS),
            ("LawsInPass", LawsInPass::OWN_COLUMNS),
            ("PassPlasticRecord", PassPlasticRecord::OWN_COLUMNS),
            ("StepRecord", StepRecord::OWN_COLUMNS),
            ("HeatRecord", HeatRecord::OWN_COLUMNS),
            ("RunningIn", RunningIn::OWN_COLUMNS),
            ("Table", &OF_A_STUDY),
        ];
        records.extend(InterfaceNumbers::GROUPS);
        each!(capability C => records.extend_from_slice(<C as Capability>::Row::GROUPS));
        records
    });
    &RECORDS
}

/// Number of the case.
pub(super) const CASE: Column = Column::new("case", "1", "Number of the case, from 1.");
/// Whether the case is done.
/// Number of warnings of the case.
pub(super) const WARNINGS: Column = Column::new("warnings", "1", "Number of warnings.");
/// State of the case.
pub(super) const STATE: Column = Column::new("state", "", "`done` or `failed`.");
/// Reason why the case failed.
pub(super) const MESSAGE: Column = Column::new("message", "", "Why the case failed.");
/// Columns of the table of a study other than its axes and the numbers of the summaries.
const OF_A_STUDY: [Column; 4] = [CASE, WARNINGS, STATE, MESSAGE];

/// Returns the prefixes that the table of a study adds to the column names of a record, with these columns.
fn prefixes() -> Vec<(&'static str, &'static [Column])> {
    let mut prefixes =
        vec![("sliding_", UpdateRecord::COLUMNS), ("subsurface_", SubsurfaceRecord::OWN_COLUMNS)];
    each!(capability C => prefixes.extend(C::PREFIXES.iter().map(|prefix| (*prefix, <C as Capability>::Row::COLUMNS))));
    prefixes
}

/// Returns the declaration of a column of a table, or of a number of `summary.json`; `None` if no such column
/// is written.
///
/// The volumes removed by any law, such as `NAME_volume_lower`, are declared as those of the law `plastic`.
/// In the table of a study, vector components and prefixed columns are declared without suffix and prefix.
pub fn column(name: &str) -> Option<Column> {
    find(records().iter().flat_map(|(_, columns)| *columns), name).or_else(|| {
        let of_record = |(prefix, columns): (&str, _)| Some((name.strip_prefix(prefix)?, columns));
        let (name, columns): (_, &[Column]) = prefixes().into_iter().find_map(of_record)?;
        declared(columns, name)
    })
}

/// Returns the declaration of a name among the `columns` of a record.
pub(super) fn declared(columns: &[Column], name: &str) -> Option<Column> {
    find(columns.iter(), name)
}

/// Returns the head of a column in a table: its name, and its unit in brackets.
pub(super) fn headed(name: &str) -> String {
    match unit_of_column(name) {
        None | Some("" | "1") => name.to_owned(),
        Some(unit) => format!("{name} ({unit})"),
    }
}

/// Returns the declaration of a name among some columns.
fn find<'a>(columns: impl Iterator<Item = &'a Column> + Clone, name: &str) -> Option<Column> {
    let named = |name: &str| columns.clone().find(|column| column.name == name).copied();
    named(name)
        .or_else(|| named(&format!("plastic{}", ENDINGS.iter().find(|ending| name.ends_with(**ending))?)))
        .or_else(|| {
            let (vector, component) = name.rsplit_once('_')?;
            // Volumes removed from the lower and the upper body by each law.
            let vector = if vector.starts_with("lost_") { "lost" } else { vector };
            named(vector).filter(|vector| vector.components.contains(&component))
        })
}

/// Returns every column under its declared name, each once.
pub fn columns() -> Vec<Column> {
    let mut columns: Vec<Column> = Vec::new();
    for column in records().iter().flat_map(|(_, columns)| *columns) {
        if columns.iter().all(|known| known.name != column.name) {
            columns.push(*column);
        }
    }
    columns
}

/// Returns the SI unit of a [`column()`]: `"1"` for a pure number or a count, an empty text for a text;
/// `None` if no such column is written.
pub fn unit_of_column(name: &str) -> Option<&'static str> {
    column(name).map(|column| column.unit)
}

/// Returns the dimension of a [`column()`]; `None` for pure numbers, for texts, and for moments and spins,
/// which no case file contains.
pub fn dimension_of_column(name: &str) -> Option<Dimension> {
    let unit = unit_of_column(name)?;
    Dimension::ALL.into_iter().find(|dimension| dimension.si() == unit)
}

/// Columns always present in `steps.csv`.
pub const STEP_COLUMNS: [&str; count(StepRecord::OWN_COLUMNS)] = names(StepRecord::OWN_COLUMNS);
/// Columns always present in `passes.csv`.
pub const PASS_COLUMNS: [&str; count(PassRecord::OWN_COLUMNS)] = names(PassRecord::OWN_COLUMNS);
/// Columns always present in `increments.csv`.
pub const INCREMENT_COLUMNS: [&str; count(IncrementRecord::OWN_COLUMNS)] =
    names(IncrementRecord::OWN_COLUMNS);
/// Columns of `sweep.csv`.
pub const SWEEP_COLUMNS: [&str; count(SweepRecord::OWN_COLUMNS)] = names(SweepRecord::OWN_COLUMNS);

/// Counts the columns that are always present.
const fn count(columns: &[Column]) -> usize {
    let (mut count, mut k) = (0, 0);
    while k < columns.len() {
        if !matches!(columns[k].presence, Presence::Optional) {
            count += 1;
        }
        k += 1;
    }
    count
}

/// Returns the names of the `N` columns that are always present.
const fn names<const N: usize>(columns: &'static [Column]) -> [&'static str; N] {
    let mut names = [""; N];
    let (mut count, mut k) = (0, 0);
    while k < columns.len() {
        if !matches!(columns[k].presence, Presence::Optional) {
            names[count] = columns[k].name;
            count += 1;
        }
        k += 1;
    }
    names
}

#[cfg(test)]
mod tests {
    use std::fmt::Debug;

    use serde::Serialize;
    use serde::de::DeserializeOwned;
    use serde_json::{Map, Value, json};

    use asperity_contact::with::adhesion::AdhesionSummary;

    use super::*;
    use crate::tables::Row;

    /// Checks that a serialised record of zeros has exactly these columns, in their order.
    fn has<T: Serialize + DeserializeOwned + Debug>(columns: &[Column]) {
        let value = |column: &Column| match (column.name, column.components) {
            ("regime", _) => json!("elastic"),
            ("lost", _) => json!({"own": [0.0, 0.0]}),
            (_, []) => json!(0),
            (_, components) => json!(vec![0.0; components.len()]),
        };
        let values: Map<String, Value> = columns.iter().map(|c| (c.name.to_owned(), value(c))).collect();
        let record: T = serde_json::from_value(values.into()).unwrap();
        let row = Row::from_record(&record);
        let names: Vec<&str> = row.cells().iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, columns.iter().map(|column| column.name).collect::<Vec<_>>(), "{record:?}");
    }

    #[test]
    fn every_record_has_the_columns_that_it_declares() {
        has::<StaticRecord>(StaticRecord::COLUMNS);
        has::<SweepRecord>(SweepRecord::COLUMNS);
        has::<IncrementRecord>(IncrementRecord::COLUMNS);
        has::<UpdateRecord>(UpdateRecord::COLUMNS);
        has::<PassRecord>(PassRecord::COLUMNS);
        has::<StepRecord>(StepRecord::COLUMNS);
        has::<AdhesionSummary>(AdhesionSummary::COLUMNS);
        has::<RunningIn>(RunningIn::COLUMNS);
        has::<SubsurfaceRecord>(SubsurfaceRecord::COLUMNS);
        // All of them are in the dictionary.
        let whole = [
            StaticRecord::COLUMNS,
            SweepRecord::COLUMNS,
            IncrementRecord::COLUMNS,
            UpdateRecord::COLUMNS,
            PassRecord::COLUMNS,
            StepRecord::COLUMNS,
            RunningIn::COLUMNS,
            SubsurfaceRecord::COLUMNS,
        ];
        for column in whole.concat() {
            assert!(records().iter().any(|(_, columns)| columns.contains(&column)), "{column:?}");
        }
    }

    #[test]
    fn a_column_has_one_unit_in_all_records_and_a_meaning() {
        for column in records().iter().flat_map(|(_, columns)| *columns) {
            assert_eq!(unit_of_column(column.name), Some(column.unit), "{}", column.name);
            assert!(column.text.ends_with('.') && !column.text.contains('|'), "{column:?}");
            // A unit belongs to a dimension, or is one that no case file contains.
            let known = ["1", "", "N m", "1/m"].contains(&column.unit);
            assert!(known || dimension_of_column(column.name).is_some(), "{column:?}");
        }
    }

    #[test]
    fn declarations_follow_components_prefixes_and_laws() {
        for (column, unit) in [
            ("subsurface_max_shear", "Pa"),
            ("subsurface_max_shear_position_z", "m"),
            ("subsurface_position_x", "m"),
            ("conductance_spots", "1"),
            ("thermal_joint_conductance", "W/(m² K)"),
            ("flow_y_permeability", "m³"),
            ("sliding_max_temperature", "K"),
            ("sliding_own_volume_upper", "m³"),
            ("max_plastic_strain_position_y", "m"),
            ("max_plastic_strain", "1"),
            ("own_volume_lower_interior", "m³"),
            ("lost_own_lower", "m³"),
            ("moment", "N m"),
            ("spin", "1/m"),
            ("surface_shift_lower", "m"),
            ("regime", ""),
        ] {
            assert_eq!(unit_of_column(column), Some(unit), "{column}");
        }
        assert_eq!(["nothing", "load_x", "lost_own_x", "_x", "sliding_"].map(unit_of_column), [None; 5]);
        assert_eq!(dimension_of_column("max_shear_position"), Some(Dimension::Length));
        assert_eq!(dimension_of_column("iterations"), None);
        assert_eq!(
            column("subsurface_max_shear").unwrap().text,
            "Largest shear stress on any plane, ½(σ₁ − σ₃)."
        );
        assert_eq!(column("wear_volume_lower"), column("plastic_volume_lower"));
    }
}

//! The columns of all tables and the numbers of a summary, each with its unit.

use crate::units::Dimension;

/// Unit of a pure number or a count.
const NUMBER: &str = "1";
/// Unit of what is no number.
const TEXT: &str = "";

/// Every column of a table and every number of `summary.json`, with its SI unit: `"1"` for a pure number or a count, nothing for a
/// text. Columns for each law, for the components of a vector and those of a study that repeat others with a prefix follow from
/// these by rules, see [`unit_of_column`].
pub const COLUMN_UNITS: [(&str, &str); 119] = [
    // What is counted.
    ("pass", NUMBER),
    ("step", NUMBER),
    ("increment", NUMBER),
    ("stage", NUMBER),
    ("update", NUMBER),
    ("point", NUMBER),
    ("case", NUMBER),
    ("represents", NUMBER),
    ("computed", NUMBER),
    ("represented", NUMBER),
    ("warnings", NUMBER),
    // The place of the bodies.
    ("offset", "m"),
    ("offset_y", "m"),
    ("overlap_columns", NUMBER),
    ("approach", "m"),
    ("mean_gap", "m"),
    ("distance", "m"),
    ("time", "s"),
    // Loads and forces.
    ("load", "N"),
    ("mean_load", "N"),
    ("min_load", "N"),
    ("max_load", "N"),
    ("mean_pressure", "Pa"),
    ("max_pressure", "Pa"),
    ("tangential_force", "N"),
    ("tangential_force_x", "N"),
    ("tangential_force_y", "N"),
    ("mean_tangential_force", "N"),
    ("friction_coefficient", NUMBER),
    ("force_ratio", NUMBER),
    ("tangential_displacement", "m"),
    ("tangential_displacement_x", "m"),
    ("tangential_displacement_y", "m"),
    ("max_shear", "Pa"),
    ("creepage", NUMBER),
    ("creepage_x", NUMBER),
    ("creepage_y", NUMBER),
    ("spin", "1/m"),
    ("moment", "N m"),
    ("stiffness", "N/m"),
    // Areas.
    ("contact_area", "m²"),
    ("contact_area_interior", "m²"),
    ("mean_contact_area", "m²"),
    ("mean_contact_area_interior", "m²"),
    ("apparent_area", "m²"),
    ("plastic_area", "m²"),
    ("stick_area", "m²"),
    ("contact_fraction", NUMBER),
    ("largest_spot_cells", NUMBER),
    ("plastic_cells", NUMBER),
    // What bodies lose and gain.
    ("plastic_volume", "m³"),
    ("plastic_volume_interior", "m³"),
    ("plastic_volume_lower", "m³"),
    ("plastic_volume_upper", "m³"),
    ("plastic_volume_lower_interior", "m³"),
    ("plastic_volume_upper_interior", "m³"),
    ("sq_lower", "m"),
    ("sq_upper", "m"),
    ("sq_lower_interior", "m"),
    ("sq_upper_interior", "m"),
    ("max_wear_lower", "m"),
    ("max_wear_upper", "m"),
    ("mean_film_lower", "m"),
    ("mean_film_upper", "m"),
    ("error_estimate", "m"),
    ("error_bound", "m"),
    // Energy and heat.
    ("elastic_energy", "J"),
    ("dissipation", "J"),
    ("slip_work", "J"),
    ("friction_work", "J"),
    ("friction_power", "W"),
    ("max_flash_temperature", "K"),
    ("max_temperature", "K"),
    // Plastic flow below the surfaces.
    ("max_plastic_strain", NUMBER),
    ("max_plastic_strain_lower", NUMBER),
    ("max_plastic_strain_upper", NUMBER),
    ("max_plastic_strain_position", "m"),
    ("yielded_cells", NUMBER),
    ("yielded_volume", "m³"),
    ("displaced_volume", "m³"),
    ("plastic_work", "J"),
    ("plastic_work_lower", "J"),
    ("plastic_work_upper", "J"),
    ("plastic_work_rim", "J"),
    ("stored_energy", "J"),
    ("max_residual_tension", "Pa"),
    ("residual_displacement", "m"),
    ("residual_displacement_lower", "m"),
    ("residual_displacement_upper", "m"),
    ("surface_shift_lower", "m"),
    ("surface_shift_upper", "m"),
    ("net_strain_lower", NUMBER),
    ("net_strain_upper", NUMBER),
    ("strain_per_pass", NUMBER),
    ("shift_per_pass", "m"),
    ("regime", TEXT),
    ("residual_max_plastic_strain", NUMBER),
    ("residual_yielded_volume", "m³"),
    ("residual_plastic_work", "J"),
    ("residual_stored_energy", "J"),
    ("residual_displaced_volume", "m³"),
    ("residual_max_residual_tension", "Pa"),
    ("residual_residual_displacement", "m"),
    // The stress below the surface.
    ("max_von_mises", "Pa"),
    ("position", "m"),
    ("max_shear_position", "m"),
    // What the solution took and left.
    ("products", NUMBER),
    ("mismatch", NUMBER),
    ("solutions", NUMBER),
    ("iterations", NUMBER),
    ("outer_iterations", NUMBER),
    ("convolutions", NUMBER),
    ("residual", NUMBER),
    ("wall_time_s", "s"),
    // Of the table of a study.
    ("state", TEXT),
    ("message", TEXT),
    ("done", NUMBER),
    ("lost", "m³"),
    ("converged", TEXT),
];

/// What a study's table puts before the names of a contact that slides in place, and of the most stressed point.
const PREFIXES: [&str; 2] = ["sliding_", "subsurface_"];
/// What a study's table puts behind the names of vectors, for their components.
const COMPONENTS: [&str; 3] = ["_x", "_y", "_z"];
/// Numbers of a summary that are vectors.
const VECTORS: [&str; 6] = [
    "tangential_force",
    "tangential_displacement",
    "creepage",
    "position",
    "max_shear_position",
    "max_plastic_strain_position",
];
/// How the names of the columns of a law end.
const OF_LAWS: [&str; 4] =
    ["_volume_lower", "_volume_upper", "_volume_lower_interior", "_volume_upper_interior"];

/// Returns the SI unit of a column of a table or of a number of `summary.json`: `"1"` for a pure number or a count, nothing for a text;
/// none where no such column is written.
///
/// The volumes that a law takes, `wear_volume_lower` and so on, are m³ whatever its name.
pub fn unit_of_column(column: &str) -> Option<&'static str> {
    if let Some((_, unit)) = COLUMN_UNITS.iter().find(|(name, _)| *name == column) {
        return Some(unit);
    }
    if is_volume_of_law(column) {
        return Some("m³");
    }
    if let Some(name) = PREFIXES.iter().find_map(|prefix| column.strip_prefix(prefix)) {
        return unit_of_column(name);
    }
    let vector = COMPONENTS.iter().find_map(|component| column.strip_suffix(component))?;
    // The volumes of each law, of the lower and of the upper body.
    if vector.starts_with("lost_") {
        return unit_of_column("lost");
    }
    VECTORS.contains(&vector).then(|| unit_of_column(vector)).flatten()
}

/// Returns what a column of a table or a number of a summary measures; none for pure numbers, for texts, and for a moment or a spin,
/// which no case file asks for.
pub fn dimension_of_column(column: &str) -> Option<Dimension> {
    let unit = unit_of_column(column)?;
    Dimension::ALL.into_iter().find(|dimension| dimension.si() == unit)
}

/// Whether a column holds the volume that a law has taken from a body.
pub(super) fn is_volume_of_law(column: &str) -> bool {
    OF_LAWS.iter().any(|ending| column.ends_with(ending))
}

#[cfg(test)]
mod tests {
    use std::collections::{BTreeMap, BTreeSet};

    use serde_json::{Value, json};

    use super::*;
    use crate::motion::{
        FlowRecord, FlowStepRecord, HeatRecord, IncrementRecord, LostVolume, PassFlowRecord, PassRecord,
        Regime, ResidualRecord, RunningRecord, ShearRecord, StaticRecord, StepRecord, SweepRecord,
        UpdateRecord,
    };
    use crate::study::summary::RunningIn;
    use crate::study::{INCREMENT_COLUMNS, PASS_COLUMNS, STEP_COLUMNS, SWEEP_COLUMNS, SubsurfaceRecord};

    /// Every record that a course writes, with all of its optional parts.
    fn records() -> Vec<Value> {
        let residual = ResidualRecord {
            residual_max_plastic_strain: 0.0,
            residual_yielded_volume: 0.0,
            residual_plastic_work: 0.0,
            residual_stored_energy: 0.0,
            residual_displaced_volume: 0.0,
            residual_max_residual_tension: 0.0,
            residual_residual_displacement: 0.0,
        };
        let flow = FlowRecord {
            max_plastic_strain: 0.0,
            max_plastic_strain_position: [0.0; 3],
            yielded_volume: 0.0,
            plastic_work: 0.0,
            stored_energy: 0.0,
            displaced_volume: 0.0,
            max_residual_tension: 0.0,
            residual_displacement: 0.0,
            products: 0,
            mismatch: 0.0,
            regime: Regime::Elastic,
            strain_per_pass: Some(0.0),
            shift_per_pass: Some(0.0),
            residual: Some(residual),
        };
        let shear = ShearRecord {
            tangential_force: [0.0; 2],
            force_ratio: 0.0,
            friction_coefficient: Some(0.0),
            tangential_displacement: [0.0; 2],
            stick_area: 0.0,
            max_shear: 0.0,
            dissipation: 0.0,
            slip_work: Some(0.0),
            creepage: Some([0.0; 2]),
            spin: Some(0.0),
            moment: Some(0.0),
        };
        let flow_step = FlowStepRecord {
            yielded_cells: 0,
            max_plastic_strain: 0.0,
            plastic_work: 0.0,
            products: 0,
            mismatch: 0.0,
        };
        let lost = vec![LostVolume::nothing("plastic"), LostVolume::nothing("own")];
        let running = RunningRecord {
            represents: 1,
            time: 0.0,
            distance: 0.0,
            max_wear_lower: 0.0,
            max_wear_upper: 0.0,
            mean_film_lower: 0.0,
            mean_film_upper: 0.0,
            friction_work: 0.0,
            max_flash_temperature: 0.0,
            error_estimate: 0.0,
        };
        vec![
            json!(StaticRecord {
                load: 0.0,
                approach: 0.0,
                contact_area: 0.0,
                apparent_area: 0.0,
                max_pressure: 0.0,
                mean_gap: 0.0,
                elastic_energy: 0.0,
                plastic_cells: 0,
                plastic_volume: 0.0,
                iterations: 0,
                convolutions: 0.0,
                residual: 0.0,
                shear: Some(shear),
                flow: Some(flow),
            }),
            json!(IncrementRecord { flow: Some(flow_step), ..IncrementRecord::default() }),
            json!(UpdateRecord {
                update: 0,
                distance: 0.0,
                time: 0.0,
                load: 0.0,
                approach: 0.0,
                tangential_force: 0.0,
                contact_area: 0.0,
                largest_spot_cells: 0,
                max_pressure: 0.0,
                plastic_cells: 0,
                lost: lost.clone(),
                max_wear_lower: 0.0,
                max_wear_upper: 0.0,
                mean_film_lower: 0.0,
                mean_film_upper: 0.0,
                friction_power: 0.0,
                friction_work: 0.0,
                max_temperature: 0.0,
                solutions: 0,
                iterations: 0,
                convolutions: 0.0,
                residual: 0.0,
            }),
            json!(SweepRecord {
                point: 0,
                load: 0.0,
                mean_pressure: 0.0,
                approach: 0.0,
                mean_gap: 0.0,
                contact_area: 0.0,
                contact_fraction: 0.0,
                largest_spot_cells: 0,
                max_pressure: 0.0,
                plastic_area: 0.0,
                plastic_volume: 0.0,
                elastic_energy: 0.0,
                stiffness: Some(0.0),
                creepage_x: 0.0,
                creepage_y: 0.0,
                tangential_force_x: 0.0,
                tangential_force_y: 0.0,
                stick_area: 0.0,
                max_shear: 0.0,
                dissipation: 0.0,
                slip_work: 0.0,
                iterations: 0,
                convolutions: 0.0,
                residual: 0.0,
            }),
            json!(StepRecord {
                pass: 0,
                step: 0,
                offset: 0.0,
                offset_y: Some(0.0),
                overlap_columns: 0,
                approach: 0.0,
                load: 0.0,
                tangential_force: 0.0,
                contact_area: 0.0,
                contact_area_interior: 0.0,
                largest_spot_cells: 0,
                max_pressure: 0.0,
                plastic_cells: 0,
                plastic_volume: 0.0,
                plastic_volume_interior: 0.0,
                iterations: 0,
                convolutions: 0.0,
                residual: 0.0,
                heat: Some(HeatRecord { friction_power: 0.0, max_flash_temperature: 0.0 }),
                flow: Some(flow_step),
            }),
            json!(PassRecord {
                pass: 0,
                approach: 0.0,
                mean_load: 0.0,
                mean_tangential_force: 0.0,
                friction_coefficient: 0.0,
                min_load: 0.0,
                max_load: 0.0,
                mean_pressure: 0.0,
                mean_contact_area: 0.0,
                mean_contact_area_interior: 0.0,
                largest_spot_cells: 0,
                max_pressure: 0.0,
                lost,
                running: Some(running),
                flow: Some(PassFlowRecord::default()),
                sq_lower: 0.0,
                sq_upper: 0.0,
                sq_lower_interior: 0.0,
                sq_upper_interior: 0.0,
                outer_iterations: 0,
                convolutions: 0.0,
                wall_time_s: 0.0,
            }),
            json!(RunningIn {
                computed: 0,
                represented: 0,
                error_bound: 0.0,
                lost: BTreeMap::from([("wear".to_owned(), [0.0; 2])]),
            }),
            json!(SubsurfaceRecord {
                pass: Some(0),
                step: Some(0),
                max_von_mises: 0.0,
                position: [0.0; 3],
                max_shear: 0.0,
                max_shear_position: [0.0; 3],
            }),
        ]
    }

    /// The names of the numbers of all records, and the columns of all tables.
    fn written() -> BTreeSet<String> {
        let names = records().into_iter().flat_map(|record| record.as_object().unwrap().clone().into_iter());
        let columns = [&PASS_COLUMNS[..], &STEP_COLUMNS, &INCREMENT_COLUMNS, &SWEEP_COLUMNS].concat();
        names.map(|(name, _)| name).chain(columns.into_iter().map(str::to_owned)).collect()
    }

    #[test]
    fn every_number_that_is_written_has_a_unit_and_no_other() {
        let written = written();
        let without: Vec<_> = written.iter().filter(|name| unit_of_column(name).is_none()).collect();
        assert!(without.is_empty(), "no unit of {without:?}");
        // What stands in the tables of a study alone, or beside a record.
        let beside = ["case", "warnings", "state", "message", "done", "converged", "plastic_volume_interior"];
        let stale = COLUMN_UNITS
            .iter()
            .map(|(name, _)| *name)
            .filter(|name| !written.contains(*name) && !beside.contains(name));
        assert_eq!(stale.collect::<Vec<_>>(), Vec::<&str>::new(), "units of what nobody writes");
        let names: BTreeSet<&str> = COLUMN_UNITS.iter().map(|(name, _)| *name).collect();
        assert_eq!(names.len(), COLUMN_UNITS.len(), "a name twice");
    }

    #[test]
    fn units_follow_components_prefixes_and_laws() {
        for (column, unit) in [
            ("subsurface_max_shear", "Pa"),
            ("subsurface_max_shear_position_z", "m"),
            ("subsurface_position_x", "m"),
            ("sliding_max_temperature", "K"),
            ("sliding_own_volume_upper", "m³"),
            ("max_plastic_strain_position_y", "m"),
            ("max_plastic_strain", "1"),
            ("own_volume_lower_interior", "m³"),
            ("lost_own_x", "m³"),
            ("moment", "N m"),
            ("spin", "1/m"),
            ("surface_shift_lower", "m"),
            ("regime", ""),
        ] {
            assert_eq!(unit_of_column(column), Some(unit), "{column}");
        }
        assert_eq!(["nothing", "load_x", "_x", "sliding_"].map(unit_of_column), [None; 4]);
        assert_eq!(dimension_of_column("max_shear_position"), Some(Dimension::Length));
        assert_eq!(dimension_of_column("iterations"), None);
        // A unit is that of a dimension, or one that no case file asks for.
        for (name, unit) in COLUMN_UNITS {
            let known = ["1", "", "N m", "1/m"].contains(&unit);
            assert!(known || dimension_of_column(name).is_some(), "{name} in {unit}");
        }
    }
}

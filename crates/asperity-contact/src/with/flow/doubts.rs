//! Reasons in a flow itself not to trust it.

use super::{Ends, FlowRecord, Leakage};
use crate::surface::Axis;
use crate::units::{self, Dimension, format_number};
use crate::with::Surroundings;

/// A constriction with fewer open cells than this across the flow is not resolved.
const NARROW: usize = 3;
/// Largest estimate of the error of the permeability without a warning.
const ESTIMATE: f64 = 0.1;
/// Largest pressure of the fluid without a warning, over the mean pressure of the contact.
const FLUID_PRESSURE: f64 = 0.1;
/// Largest flow that the moving bodies drag along without a warning, over that of the pressure difference.
const DRAGGED: f64 = 0.1;

/// Returns warnings about the rows of a case.
pub(super) fn of_rows(leakage: &Leakage, rows: &[FlowRecord], surroundings: &Surroundings) -> Vec<String> {
    let boundary = surroundings.boundary;
    let mut warnings = Vec::new();
    let pressure = |value| units::format(value, Dimension::Pressure);
    let least = rows.iter().map(|row| row.mean_pressure).filter(|p| *p > 0.0).fold(f64::INFINITY, f64::min);
    if leakage.pressure > FLUID_PRESSURE * least {
        warnings.push(format!(
            "the pressure difference of the fluid is {}, the mean pressure of the contact {}: the fluid would lift the bodies, which \
             [flow] leaves out; [lubrication] with `inlet_pressure` computes it",
            pressure(leakage.pressure),
            pressure(least),
        ));
    }
    let open = || rows.iter().filter(|row| row.critical_cells > 0 && row.contact_area > 0.0);
    let estimate = rows.iter().map(|row| row.estimate).fold(0.0, f64::max);
    warnings.extend(doubts(open().map(|row| row.critical_cells).min(), estimate));
    let at_rim = |row: &FlowRecord| {
        let axis = usize::from(row.along == Axis::Y);
        leakage.ends_along(axis, boundary) == Ends::Reservoirs && !boundary.repeats(axis)
    };
    if rows.iter().any(at_rim) {
        warnings.push(
            "the reservoirs are at free edges of the grid, where the surfaces end: the gap near them is not that of the middle of larger \
             bodies"
                .to_owned(),
        );
    }
    warnings.extend(of_sliding(leakage, rows, surroundings));
    warnings
}

/// Returns a warning if the bodies drag along more fluid than a small part of the leakage.
fn of_sliding(leakage: &Leakage, rows: &[FlowRecord], surroundings: &Surroundings) -> Option<String> {
    let speed = surroundings.dragging_speed?;
    // 6 η U L/(ḡ² ΔP)
    let dragged = |row: &FlowRecord| {
        6.0 * leakage.viscosity * speed * row.length / (row.mean_gap * row.mean_gap * leakage.pressure)
    };
    let along_x = rows.iter().filter(|row| row.along == Axis::X && row.mean_gap > 0.0);
    let dragged = along_x.map(dragged).fold(0.0, f64::max);
    (dragged > DRAGGED).then(|| {
        let times = if dragged.is_finite() { format_number(dragged) } else { "many".to_owned() };
        format!(
            "the moving bodies drag along {times} times the fluid that the pressure difference drives: dragged and squeezed fluid is left \
             out"
        )
    })
}

/// Returns warnings about flows through contacts: the narrowest critical constriction, in cells, and the
/// largest estimate of the error of the permeability decide. Gaps without contact have no constriction that
/// counts.
pub fn doubts(narrowest: Option<usize>, estimate: f64) -> Vec<String> {
    let mut warnings = Vec::new();
    if let Some(cells) = narrowest.filter(|cells| (1..NARROW).contains(cells)) {
        let cells = if cells == 1 { "one cell".to_owned() } else { format!("{cells} cells") };
        warnings.push(format!(
            "the critical constriction is {cells} wide: the leakage depends on the grid, a finer one resolves it"
        ));
    }
    if estimate > ESTIMATE {
        warnings.push(format!(
            "the permeability is uncertain by about {} %: two ways to average the gap of neighbouring cells differ by so much, a finer grid \
             reduces it",
            format_number((100.0 * estimate).round()),
        ));
    }
    warnings
}

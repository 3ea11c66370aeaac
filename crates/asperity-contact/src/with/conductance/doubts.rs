//! Reasons in a conductance itself not to trust it.

use super::ConductanceRecord;
use crate::units::format_number;

/// A spot with fewer cells than this conducts with an error of some percent.
const FEW_CELLS: f64 = 9.0;
/// Share of the resistance above which the film decides.
const FILM: f64 = 0.5;
/// Relative deviation from Barber's identity without a warning.
const IDENTICAL: f64 = 1e-3;

/// Returns warnings about the rows of a case.
pub(super) fn of_rows(rows: &[ConductanceRecord]) -> Vec<String> {
    let touching = || rows.iter().filter(|row| row.spots > 0.0);
    let fewest = touching().map(|row| row.median_spot_cells).fold(f64::INFINITY, f64::min);
    let film = touching().map(|row| row.film_share).fold(0.0, f64::max);
    let mut warnings = doubts(fewest, film);
    warnings.extend(rows.iter().find_map(off_the_stiffness));
    warnings
}

/// Returns a warning if a conductance is not that of the stiffness of its contact.
fn off_the_stiffness(row: &ConductanceRecord) -> Option<String> {
    let off = row.quantities.off_the_stiffness().filter(|off| off.abs() > IDENTICAL)?;
    Some(format!(
        "the conductance of point {} is {} % off Barber's identity with the stiffness: the tolerance is too coarse",
        row.step.unwrap_or_default(),
        format_number(100.0 * off)
    ))
}

/// Returns warnings about the conductances of contacts: the least median number of cells of a spot, infinite
/// without contact, and the largest share of the resistance that the film has decide.
pub fn doubts(median_cells: f64, film_share: f64) -> Vec<String> {
    let mut warnings = Vec::new();
    if median_cells < FEW_CELLS {
        let cells = match median_cells {
            1.0 => "one cell".to_owned(),
            cells => format!("{} cells", format_number(cells)),
        };
        warnings.push(format!(
            "the median spot of contact has {cells}: the conductance of such small spots is off by some percent, a finer grid resolves them"
        ));
    }
    if film_share > FILM {
        let share = format_number((100.0 * film_share).round());
        warnings
            .push(format!("the film makes {share} % of the resistance: its number decides the conductance"));
    }
    warnings
}

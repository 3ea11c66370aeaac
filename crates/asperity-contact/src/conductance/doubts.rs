//! Reasons in a conductance itself not to trust it.

use crate::units::format_number;

/// A spot with fewer cells than this conducts with an error of some percent.
const FEW_CELLS: f64 = 9.0;
/// Share of the resistance above which the film decides.
const FILM: f64 = 0.5;

/// Returns warnings about the conductances of contacts: the least median number of cells of a spot, infinite without contact, and the
/// largest share of the resistance that the film has decide.
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

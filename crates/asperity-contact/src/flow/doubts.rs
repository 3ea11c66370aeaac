//! Reasons in a flow itself not to trust it.

use crate::units::format_number;

/// A constriction with fewer open cells than this across the flow is not resolved.
const NARROW: usize = 3;
/// Largest estimate of the error of the permeability without a warning.
const ESTIMATE: f64 = 0.1;

/// Returns warnings about flows through contacts: the narrowest critical constriction, in cells, and the largest estimate of the error of
/// the permeability decide. Gaps without contact have no constriction that counts.
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

//! Reasons in a conductance itself not to trust it.

use super::{Bracket, ConductanceRecord, Joint, composite};
use crate::material::Compliances;
use crate::motion::SweepRecord;
use crate::units::format_number;
use crate::with::Surroundings;

/// A spot with fewer cells than this conducts with an error of some percent.
const FEW_CELLS: f64 = 9.0;
/// Share of the resistance above which the film decides.
const FILM: f64 = 0.5;
/// Relative deviation from Barber's bracket without a warning: the load of a sweep is met to about this.
const BRACKET: f64 = 1e-3;

/// Returns warnings about the rows of a case.
pub(super) fn of_rows(
    joint: &Joint,
    rows: &[ConductanceRecord],
    surroundings: &Surroundings,
    points: &[SweepRecord],
) -> Vec<String> {
    let touching = || rows.iter().filter(|row| row.spots > 0.0);
    let fewest = touching().map(|row| row.median_spot_cells).fold(f64::INFINITY, f64::min);
    let film = touching().map(|row| row.film_share).fold(0.0, f64::max);
    let mut warnings = doubts(fewest, film);
    warnings.extend(outside_bracket(joint, rows, surroundings, points));
    warnings
}

/// Returns a warning if the conductance of a point of an elastic sweep lies outside Barber's bracket.
fn outside_bracket(
    joint: &Joint,
    rows: &[ConductanceRecord],
    surroundings: &Surroundings,
    points: &[SweepRecord],
) -> Option<String> {
    let is_elastic = points.iter().all(|point| point.plastic_area == 0.0);
    let [lower, upper] = surroundings.bodies.each_ref().map(|body| body.material);
    let is_coated = [lower, upper].iter().any(|material| material.coating.is_some());
    let is_clean = joint.film.is_none() && joint.gas.is_none();
    // With friction a point may repeat a load with another creepage.
    if surroundings.has_friction || !is_clean || !is_elastic || is_coated || rows.len() != points.len() {
        return None;
    }
    let composite = composite(&surroundings.bodies, joint.kind)?.ok()?;
    let modulus = Compliances::new(&lower, &upper).ok()?.modulus();
    let loads: Vec<_> = points.iter().map(|point| (point.load, point.approach)).collect();
    let brackets = Bracket::of_sweep(&loads, composite, modulus);
    let outside = |(row, bracket): &(&ConductanceRecord, &Bracket)| {
        row.quantities.conductance.is_some_and(|conductance| !bracket.holds(conductance, BRACKET))
    };
    let (row, _) = rows.iter().zip(&brackets).find(outside)?;
    Some(format!(
        "the conductance of point {} lies outside Barber's bracket from load and approach: the grid or the tolerance is too coarse",
        row.step.unwrap_or_default()
    ))
}

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

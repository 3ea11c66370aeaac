//! A static contact whose rows are divided among ranks.

use asperity_base::error::Result;
use asperity_base::ranks::{Largest, Slab};
use asperity_contact::motion::{Pair, StaticRecord};
use asperity_contact::operator::Boundary;
use asperity_contact::solver::{Control, Params, Solution, solve_normal};

use crate::operator::SlabFft;

/// A contact on ranks, as one of them has it.
#[derive(Debug, Clone)]
pub struct SlabContact {
    /// The whole contact in numbers.
    pub record: StaticRecord,
    /// The solution on the rows of this rank.
    pub solution: Solution,
}

/// Presses a pair like [`asperity_contact::motion::press`], with the rows of one `slab` on each rank. All
/// ranks call it together. The record describes the whole contact, the solution the rows of the slab.
///
/// # Errors
/// The errors of [`asperity_contact::solver::solve_normal`]. If one rank fails, the others keep waiting for
/// it.
///
/// # Panics
/// If the shape of the bodies differs from that of the slab.
pub fn press_slab(
    pair: &Pair,
    slab: &Slab,
    boundary: Boundary,
    control: Control,
    params: &Params,
) -> Result<SlabContact> {
    pair.interface().check_combined()?;
    pair.check_line(&slab.whole_grid(), boundary)?;
    let position = pair.at_rest();
    let (gap, bounds) = (pair.initial_gap(&position), pair.bounds(&position));
    let mut operator = SlabFft::new(slab.clone(), pair.response().clone(), boundary);
    let solution = solve_normal(&mut operator, &gap, &bounds, control, None, params)?;
    Ok(SlabContact { record: record_of(&solution, slab), solution })
}

/// Returns the record of a contact without friction whose solution is distributed over the slabs of the
/// ranks.
fn record_of(solution: &Solution, slab: &Slab) -> StaticRecord {
    let own = StaticRecord::new(solution);
    let [load, contact_area, gaps, elastic_energy, plastic_cells, plastic_volume] = slab.merged([
        own.load,
        own.contact_area,
        own.mean_gap * own.apparent_area,
        own.elastic_energy,
        own.plastic_cells as f64,
        own.plastic_volume,
    ]);
    let Largest(max_pressure) = slab.merged(Largest(own.max_pressure));
    let apparent_area = slab.whole_grid().area();
    StaticRecord {
        load,
        contact_area,
        apparent_area,
        max_pressure,
        mean_gap: gaps / apparent_area,
        elastic_energy,
        plastic_cells: plastic_cells as usize,
        plastic_volume,
        ..own
    }
}

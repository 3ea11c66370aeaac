//! A static contact under one load after another, each on virgin bodies.

use crate::error::{Error, Result};
use crate::motion::contact::facing;
use crate::motion::loading::LoadedContact;
use crate::motion::pair::Pair;
use crate::motion::record::{ShearRecord, StaticRecord, SweepRecord};
use crate::motion::spot::largest_spot;
use crate::motion::watch::{AtRest, Progress, Watch};
use crate::operator::{Boundary, Operator};
use crate::solver::{Control, Friction, Params, Rolling, Solution, normal_stiffness};

/// One point of a sweep, as it is prescribed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// What is prescribed in the normal direction.
    pub control: Control,
    /// The rolling of the bodies; none of bodies that do not roll.
    pub rolling: Option<Rolling>,
}

/// Takes the points of a sweep. An output that cannot be written ends the sweep.
pub trait SweepOutput {
    /// Takes the last of the points done so far, and all of them in numbers.
    ///
    /// # Errors
    /// What kept it from being written.
    fn point(&mut self, points: &[SweepRecord], contact: &LoadedContact) -> Result<()>;
}

/// The output of a sweep whose points nobody takes.
impl SweepOutput for () {
    fn point(&mut self, _: &[SweepRecord], _: &LoadedContact) -> Result<()> {
        Ok(())
    }
}

/// Presses a pair, whose bodies face each other with all their columns, together as each of the `points` prescribes, and
/// gives each in numbers and the last as a whole; points `done` are not solved again, but for the last.
///
/// Each point is a contact of its own, of bodies that nothing has flattened before, and is solved from nothing: it has the
/// bits of [`crate::motion::press`] or [`crate::motion::roll`], whatever points stand before it. Pressures of another load
/// would not be a better start than those of coarser grids: from 1.5 times the load up they cost more convolutions.
///
/// # Errors
/// [`Error::AtPoint`] with what [`crate::solver::solve_normal`] or [`crate::solver::solve_rolling`] says;
/// [`Error::Unsupported`] without points; [`Error::Interrupted`]; those of the output.
///
/// # Panics
/// If the bodies have different shapes, or a point rolls without friction.
#[expect(clippy::too_many_arguments, reason = "the contact, its points, and who looks on")]
pub fn sweep(
    pair: &Pair,
    boundary: Boundary,
    friction: Option<&Friction>,
    points: &[Point],
    params: &Params,
    done: Vec<SweepRecord>,
    watch: &dyn Watch,
    output: &mut dyn SweepOutput,
) -> Result<(Vec<SweepRecord>, LoadedContact)> {
    let (operators, gap) = facing(pair, boundary)?;
    let shape = pair.lower_grid().shape;
    let mut normal = operators.on(shape);
    let rolls = points.iter().any(|point| point.rolling.is_some());
    if rolls {
        pair.check_shear()?;
    }
    let mut coupled = rolls.then(|| operators.coupled_on(shape));
    let mut records = done;
    records.truncate(points.len().saturating_sub(1));
    records.iter().for_each(|record| watch.point(record));
    let mut last = None;
    for point in &points[records.len()..] {
        if watch.stop() {
            return Err(Error::Interrupted);
        }
        let index = records.len() + 1;
        let at_rest = AtRest::new(watch, records.len(), points.len(), point.control);
        let mut solve = || {
            let contact = match (point.rolling, &mut coupled) {
                (Some(rolling), Some(operator)) => {
                    let friction = friction.expect("what rolls has friction");
                    let operator = operator.as_mut();
                    LoadedContact::rolling(
                        pair,
                        operator,
                        &gap,
                        friction,
                        point.control,
                        rolling,
                        params,
                        &at_rest,
                    )?
                }
                _ => LoadedContact::pressed(pair, normal.as_mut(), &gap, point.control, params, &at_rest)?,
            };
            Ok((record(boundary, normal.as_mut(), index, &contact, params)?, contact))
        };
        let (record, contact) = solve().map_err(|source| match source {
            Error::Interrupted => source,
            source => Error::AtPoint { point: index, points: points.len(), source: Box::new(source) },
        })?;
        let (solved, positions, load) = (index, points.len(), record.load);
        records.push(record);
        let at = |source| Error::AtPoint { point: index, points: points.len(), source };
        output.point(&records, &contact).map_err(|error| error.if_not_finite(at))?;
        watch.at(&Progress { pass: 1, passes: 1, trial: 1, solved, positions, load, together: None });
        watch.point(&records[index - 1]);
        last = Some(contact);
    }
    let last = last.ok_or(Error::Unsupported("a sweep has at least one point"))?;
    Ok((records, last))
}

/// A contact in numbers, with its stiffness.
fn record(
    boundary: Boundary,
    operator: &mut dyn Operator,
    point: usize,
    contact: &LoadedContact,
    params: &Params,
) -> Result<SweepRecord> {
    let (stiffness, stats) = normal_stiffness(operator, &contact.solution.normal().elastic_cells(), params)?;
    let StaticRecord { load, approach, contact_area, apparent_area, .. } = contact.record;
    let Solution { grid, pressure, bounds, .. } = contact.solution.normal();
    let cells = pressure.iter().enumerate();
    let touching = cells.filter(|(cell, p)| bounds.touches(*cell, **p)).map(|(cell, _)| cell);
    let shear = contact.record.shear.as_ref();
    let of_shear = |value: fn(&ShearRecord) -> f64| shear.map_or(0.0, value);
    Ok(SweepRecord {
        point,
        load,
        mean_pressure: load / apparent_area,
        approach,
        mean_gap: contact.record.mean_gap,
        contact_area,
        contact_fraction: contact_area / apparent_area,
        largest_spot_cells: largest_spot(touching, grid.shape, boundary.wraps()),
        max_pressure: contact.record.max_pressure,
        plastic_area: grid.cell_area() * contact.record.plastic_cells as f64,
        plastic_volume: contact.record.plastic_volume,
        elastic_energy: contact.record.elastic_energy,
        stiffness,
        creepage_x: of_shear(|shear| shear.creepage.unwrap_or_default()[0]),
        creepage_y: of_shear(|shear| shear.creepage.unwrap_or_default()[1]),
        tangential_force_x: of_shear(|shear| shear.tangential_force[0]),
        tangential_force_y: of_shear(|shear| shear.tangential_force[1]),
        stick_area: of_shear(|shear| shear.stick_area),
        max_shear: of_shear(|shear| shear.max_shear),
        dissipation: of_shear(|shear| shear.dissipation),
        slip_work: of_shear(|shear| shear.slip_work.unwrap_or_default()),
        iterations: contact.record.iterations,
        convolutions: contact.record.convolutions + stats.convolutions,
        residual: contact.record.residual,
    })
}

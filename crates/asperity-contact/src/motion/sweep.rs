//! A static contact at several loads, each on virgin bodies.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::motion::contact::facing;
use crate::motion::course::{self, Course, Output, Step, StepRow};
use crate::motion::pair::Pair;
use crate::motion::record::{ShearRecord, StaticRecord, SteadyRecord, SweepRecord};
use crate::motion::spot::largest_spot;
use crate::motion::state::LoadedContact;
use crate::motion::store::{CourseState, StateReader, StateWriter, restore_if};
use crate::motion::watch::{StaticWatch, Watch};
use crate::operator::{Boundary, CoupledOperator, Operator};
use crate::solver::{Control, Friction, Params, Rolling, Solution, Stats, normal_stiffness};
use crate::units::MetrePerSecond;

/// A prescribed point of a load sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Prescribed load or approach.
    pub control: Control,
    /// Rolling of the bodies, if they roll.
    pub rolling: Option<Rolling>,
    /// Speed of viscoelastic bodies that slide steadily.
    pub speed: Option<MetrePerSecond>,
}

/// A sweep under way.
#[derive(Debug, Clone, Default)]
pub struct SweepState {
    /// The finished points.
    pub records: Vec<SweepRecord>,
    /// Pressure of the last one, from which the next one starts, Pa; `None` where it starts anew.
    pub start: Option<Field>,
}

/// Presses a pair at full overlap at each of the `points`. Returns the records of all points, and the contact of the last.
/// Points that are `done` are not solved again, except the last.
///
/// Each point is an independent contact of undeformed bodies, solved from zero. It has the bits of [`crate::motion::press`]
/// or [`crate::motion::roll`], whatever the other points are. The pressures of another load are no better start than
/// those of coarser grids: if the loads differ by a factor of 1.5 or more, they cost more convolutions. Only the steady sliding of
/// viscoelastic bodies starts at a speed from the pressures at the speed before.
///
/// # Errors
/// [`Error::AtPoint`] with the error of [`crate::solver::solve_normal`] or [`crate::solver::solve_rolling`],
/// [`Error::Unsupported`] without points, [`Error::Interrupted`], and the errors of the outputs.
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
    under_way: SweepState,
    watch: &dyn Watch,
    outputs: &mut [&mut dyn Output],
) -> Result<(Vec<SweepRecord>, LoadedContact)> {
    let (operators, gap) = facing(pair, boundary)?;
    let shape = pair.lower_grid().shape;
    let rolls = points.iter().any(|point| point.rolling.is_some());
    if rolls {
        pair.interface().check_combined()?;
        pair.check_elastic()?;
        pair.check_shear()?;
    }
    let mut state = under_way;
    state.records.truncate(points.len().saturating_sub(1));
    state.records.iter().for_each(|record| watch.point(record));
    let mut sweep = Sweep {
        pair,
        boundary,
        friction,
        points,
        params,
        gap,
        normal: params.device.operator(&operators, shape),
        coupled: rolls.then(|| operators.coupled_on(shape)),
        state,
        last: None,
    };
    course::run(&mut sweep, watch, outputs)?;
    let last = sweep.last.ok_or(Error::Unsupported("a sweep needs at least one point"))?;
    Ok((sweep.state.records, last))
}

/// A running load sweep.
struct Sweep<'a> {
    pair: &'a Pair,
    boundary: Boundary,
    friction: Option<&'a Friction>,
    points: &'a [Point],
    params: &'a Params,
    gap: Field,
    normal: Box<dyn Operator>,
    /// The coupled operator of bodies that roll.
    coupled: Option<Box<dyn CoupledOperator>>,
    /// The state after the last finished point.
    state: SweepState,
    /// The contact of the last finished point.
    last: Option<LoadedContact>,
}

impl Sweep<'_> {
    fn contact(
        &mut self,
        point: &Point,
        watch: &StaticWatch<'_>,
    ) -> Result<(LoadedContact, Option<SteadyRecord>)> {
        let Self { pair, boundary, params, gap, .. } = self;
        let control = point.control;
        if let Some(speed) = point.speed {
            let start = self.state.start.as_ref();
            return LoadedContact::steady(pair, *boundary, gap, control, speed, start, params, watch)
                .map(|(contact, steady)| (contact, Some(steady)));
        }
        let contact = match point.rolling.zip(self.coupled.as_mut()) {
            None => LoadedContact::pressed(pair, self.normal.as_mut(), gap, control, params, watch),
            Some((rolling, operator)) => {
                let friction = self.friction.expect("what rolls has friction");
                LoadedContact::rolling(
                    pair,
                    operator.as_mut(),
                    gap,
                    friction,
                    control,
                    rolling,
                    params,
                    watch,
                )
            }
        };
        Ok((contact?, None))
    }
}

/// A solved point.
struct Solved {
    contact: LoadedContact,
    /// The state after it.
    state: SweepState,
}

impl Course for Sweep<'_> {
    type Solved = Solved;

    fn next(&mut self, watch: &dyn Watch) -> Result<Option<Self::Solved>> {
        let done = self.state.records.len();
        let Some(point) = self.points.get(done) else { return Ok(None) };
        if watch.stop() {
            return Err(Error::Interrupted);
        }
        let points = self.points.len();
        let solved = self.contact(point, &StaticWatch::new(watch, done, points, point.control)).and_then(
            |(contact, steady)| {
                let operator = self.normal.as_mut();
                let record = record(self.boundary, operator, done + 1, &contact, steady, self.params)?;
                Ok((record, contact))
            },
        );
        let at = |source| Error::AtPoint { point: done + 1, points, source };
        let (record, contact) = solved.map_err(|error| error.unless_interrupted(at))?;
        let start = record.steady.map(|_| contact.solution.normal().pressure.clone());
        let mut records = std::mem::take(&mut self.state.records);
        records.push(record);
        Ok(Some(Solved { contact, state: SweepState { records, start } }))
    }

    fn report<'a>(&'a self, Solved { contact, state }: &'a Self::Solved) -> Step<'a> {
        let record = state.records.last().expect("the point just done");
        Step {
            contact: Some(contact.solution.normal()),
            state: Some(state),
            ..Step::new(record.point, self.points.len(), StepRow::Point(record))
        }
    }

    fn take(&mut self, Solved { contact, state }: Self::Solved) {
        self.state = state;
        self.last = Some(contact);
    }
}

impl CourseState for SweepState {
    fn store(&self, to: &mut dyn StateWriter) {
        if let Some(start) = &self.start {
            to.field("pressure", "Pa", start);
        }
    }
}

impl SweepState {
    /// Restores a sweep after these points.
    ///
    /// # Errors
    /// The errors of the reader.
    pub fn restore(from: &dyn StateReader, records: Vec<SweepRecord>) -> Result<Self> {
        let start = restore_if(from, "pressure", || from.field("pressure"))?;
        Ok(Self { records, start })
    }
}

/// Creates the record of a contact, with its stiffness.
fn record(
    boundary: Boundary,
    operator: &mut dyn Operator,
    point: usize,
    contact: &LoadedContact,
    steady: Option<SteadyRecord>,
    params: &Params,
) -> Result<SweepRecord> {
    // A tension on open cells changes with the approach, too.
    let (stiffness, stats) = match contact.record.interface.is_some() || steady.is_some() {
        true => (None, Stats::default()),
        false => normal_stiffness(operator, &contact.solution.normal().elastic_cells(), params)?,
    };
    let StaticRecord { load, approach, contact_area, apparent_area, .. } = contact.record;
    let Solution { grid, pressure, bounds, .. } = contact.solution.normal();
    let cells = pressure.iter().enumerate();
    let contact_cells = cells.filter(|(cell, p)| bounds.touches(*cell, **p)).map(|(cell, _)| cell);
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
        largest_spot_cells: largest_spot(contact_cells, grid.shape, boundary.wraps()),
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
        interface: contact.record.interface,
        steady,
    })
}

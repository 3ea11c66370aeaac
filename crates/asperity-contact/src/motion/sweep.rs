//! A static contact at several loads, each on virgin bodies.

use crate::error::{Error, Result};
use crate::grid::{Field, flat};
use crate::lubrication::{Film, SolvedFilm};
use crate::motion::contact::facing;
use crate::motion::course::{self, Course, Output, Step, StepRow};
use crate::motion::elasto_plastic::{PlasticPath, press_elasto_plastic};
use crate::motion::lubricated::LubricatedBodies;
use crate::motion::pair::Pair;
use crate::motion::record::{PlasticStepRecord, ShearRecord, StaticRecord, SweepRecord};
use crate::motion::slip::SlipRegime;
use crate::motion::spot::{corrected_area, largest_spot};
use crate::motion::stage::Stage;
use crate::motion::state::LoadedContact;
use crate::motion::store::{CourseState, StateReader, StateWriter, restore_if};
use crate::motion::watch::{StaticWatch, StopsWith, Watch};
use crate::operator::{Boundary, Operators};
use crate::plasticity::{PlasticBody, PlasticParams};
use crate::solver::{
    ContactProblem, ContactSolver, Control, Loading, Params, Solution, Stats, normal_stiffness,
};
use crate::units::MetrePerSecond;

/// A prescribed point of a load sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Prescribed load or approach.
    pub control: Control,
    /// How the bodies slip on each other.
    pub regime: SlipRegime,
    /// Speed of viscoelastic bodies that slide steadily; of lubricated bodies the mean speed of both surfaces.
    pub speed: Option<MetrePerSecond>,
}

/// A sweep under way.
#[derive(Debug, Clone, Default)]
pub struct SweepState {
    /// The finished points.
    pub records: Vec<SweepRecord>,
    /// Pressure from which the next point starts, Pa; once all are finished, that from which the last one
    /// started, so that it can be solved again. `None` where points start anew.
    pub start: Option<Field>,
    /// The last films of lubricated bodies on all grids, the finest first, from which the next ones start. As
    /// `start`.
    pub films: Vec<SolvedFilm>,
}

/// Presses a pair at full overlap at each of the `points`. Returns the records of all points, and the contact
/// of the last point. Of the points that are `done` only the last one is solved again.
///
/// Each point is an independent contact of undeformed bodies, solved from zero. It has the bits of
/// [`crate::motion::press`], whatever the other points are. A start from the pressures of another load costs
/// more convolutions than one from coarser grids, if the loads differ by a factor of 1.5 or more. Steady
/// sliding of viscoelastic bodies starts from the pressures at the speed before, and so do the films of lubricated
/// bodies.
///
/// # Errors
/// [`Error::AtPoint`] with the error of [`crate::solver::solve_normal`] or [`crate::solver::solve_rolling`],
/// [`Error::Unsupported`] without points, [`Error::Interrupted`], and the errors of the outputs.
///
/// # Panics
/// If the bodies have different shapes.
pub fn sweep(
    pair: &Pair,
    boundary: Boundary,
    points: &[Point],
    params: &Params,
    under_way: SweepState,
    watch: &dyn Watch,
    outputs: &mut [&mut dyn Output],
) -> Result<(Vec<SweepRecord>, LoadedContact)> {
    run(pair, boundary, points, None, params, under_way, watch, outputs)
}

/// Elasto-plastic bodies of a sweep, and how each point loads them.
#[derive(Clone, Copy)]
pub struct YieldingBodies<'a> {
    /// Creates the virgin bodies, lower one first; `None` for one that is not elasto-plastic.
    pub virgin: &'a dyn Fn() -> Result<[Option<PlasticBody>; 2]>,
    /// Number of equal steps in which a point is loaded, ≥ 1.
    pub increments: usize,
    /// Convergence criteria of a step.
    pub plastic: PlasticParams,
}

/// Does a [`sweep`] of elasto-plastic bodies without friction. Each point has the bits of
/// [`press_elasto_plastic`] in one stage, whose load stays.
///
/// # Errors
/// The errors of [`sweep`] and of [`press_elasto_plastic`].
///
/// # Panics
/// If the bodies have different shapes.
#[expect(clippy::too_many_arguments, reason = "the contact, its bodies and points, and who looks on")]
pub fn sweep_elasto_plastic(
    pair: &Pair,
    boundary: Boundary,
    points: &[Point],
    bodies: YieldingBodies<'_>,
    params: &Params,
    under_way: SweepState,
    watch: &dyn Watch,
    outputs: &mut [&mut dyn Output],
) -> Result<(Vec<SweepRecord>, LoadedContact)> {
    run(pair, boundary, points, Some(bodies), params, under_way, watch, outputs)
}

#[expect(clippy::too_many_arguments, reason = "the contact, its bodies and points, and who looks on")]
fn run(
    pair: &Pair,
    boundary: Boundary,
    points: &[Point],
    yielding: Option<YieldingBodies<'_>>,
    params: &Params,
    mut state: SweepState,
    watch: &dyn Watch,
    outputs: &mut [&mut dyn Output],
) -> Result<(Vec<SweepRecord>, LoadedContact)> {
    let (operators, gap) = facing(pair, boundary)?;
    state.records.truncate(points.len().saturating_sub(1));
    state.records.iter().for_each(|record| watch.point(record));
    let mut sweep = Sweep {
        pair,
        boundary,
        points,
        yielding,
        params,
        operators,
        gap,
        solver: None,
        lubricated: None,
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
    points: &'a [Point],
    yielding: Option<YieldingBodies<'a>>,
    params: &'a Params,
    operators: Operators,
    gap: Field,
    /// The solver of the last point, with its regime.
    solver: Option<(SlipRegime, Box<dyn ContactSolver>)>,
    /// The films of lubricated bodies, with what prescribes their load.
    lubricated: Option<(Control, LubricatedBodies)>,
    /// The state after the last finished point.
    state: SweepState,
    /// The contact of the last finished point.
    last: Option<LoadedContact>,
}

impl Sweep<'_> {
    /// Solves a point. Returns its contact and its record.
    fn contact(&mut self, number: usize, watch: &dyn Watch) -> Result<(LoadedContact, SweepRecord)> {
        let Self { pair, boundary, params, gap, .. } = self;
        let Point { control, regime, speed } = self.points[number - 1];
        if let Some(YieldingBodies { virgin, increments, plastic }) = self.yielding {
            let stages = vec![Stage::new(Loading::pressing(control), increments)];
            let path = PlasticPath::new(stages).with_plastic(plastic);
            let stop = || watch.stop();
            let contact = press_elasto_plastic(
                pair,
                *boundary,
                None,
                virgin()?,
                &path,
                params,
                &StopsWith(&stop),
                &mut [],
            )?;
            let plastic = PlasticStepRecord::up_to_last(&contact.increments);
            let record = SweepRecord { plastic, ..record(*boundary, number, &contact) };
            return Ok((contact, record));
        }
        let watch = &StaticWatch::new(watch, number - 1, self.points.len(), control);
        if let Some((lubrication, speed)) = pair.lubrication().zip(speed) {
            let mut lubricated = match self.lubricated.take() {
                Some((last, lubricated)) if last == control => lubricated,
                _ => LubricatedBodies::new(
                    pair,
                    *lubrication,
                    &self.operators,
                    (gap, *boundary),
                    control,
                    self.state.films.clone(),
                )?,
            };
            let (contact, film) = lubricated.contact_at(pair, speed)?;
            let record = SweepRecord {
                speed: Some(speed),
                lubrication: Some(film),
                ..record(*boundary, number, &contact)
            };
            self.lubricated = Some((control, lubricated));
            return Ok((contact, record));
        }
        if let Some(speed) = speed {
            let start = self.state.start.as_ref();
            let (contact, steady) =
                LoadedContact::steady(pair, *boundary, gap, control, speed, start, params, watch)?;
            let record = SweepRecord {
                speed: Some(speed),
                steady: Some(steady),
                ..record(*boundary, number, &contact)
            };
            return Ok((contact, record));
        }
        let mut solver = match self.solver.take() {
            Some((last, solver)) if last == regime => solver,
            _ => regime.solver(pair, &self.operators, pair.lower_grid().shape, params.device)?,
        };
        let bounds = pair.bounds(&pair.at_rest());
        let problem = ContactProblem::new(gap, &bounds, Loading::pressing(control), params, watch);
        let contact = LoadedContact::at_once(pair, solver.solve(&problem)?);
        let record = record(*boundary, number, &contact);
        // A tension on open cells changes with the approach, too.
        let (stiffness, stats) = if pair.interface().is_hard() {
            normal_stiffness(solver.normal(), &contact.solution.normal().elastic_cells(), params)?
        } else {
            (None, Stats::default())
        };
        let convolutions = record.convolutions + stats.convolutions;
        self.solver = Some((regime, solver));
        Ok((contact, SweepRecord { stiffness, convolutions, ..record }))
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
        if done == self.points.len() {
            return Ok(None);
        }
        if watch.stop() {
            return Err(Error::Interrupted);
        }
        let points = self.points.len();
        let at = |source| Error::AtPoint { point: done + 1, points, source };
        let (contact, record) =
            self.contact(done + 1, watch).map_err(|error| error.unless_interrupted(at))?;
        let start = match record.steady {
            Some(_) if done + 1 < points => Some(contact.solution.normal().pressure.clone()),
            _ => self.state.start.take(),
        };
        let films = match &self.lubricated {
            Some((_, lubricated)) if done + 1 < points => lubricated.last_films(),
            _ => std::mem::take(&mut self.state.films),
        };
        let mut records = std::mem::take(&mut self.state.records);
        records.push(record);
        Ok(Some(Solved { contact, state: SweepState { records, start, films } }))
    }

    fn report<'a>(&'a self, Solved { contact, state }: &'a Self::Solved) -> Step<'a> {
        let record = state.records.last().expect("the point just done");
        Step {
            contact: Some(contact.solution.normal()),
            film: contact.film.as_ref(),
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
        for (grid, SolvedFilm { speed, film }) in self.films.iter().enumerate() {
            let name = |part: &str| format!("film_{}_{part}", grid + 1);
            to.number(&name("speed"), *speed);
            to.number(&name("approach"), film.approach);
            to.count(&name("columns"), film.cavity.ncols());
            for (part, unit, values) in film.parts() {
                to.series(&name(part), unit, "cells", flat(values));
            }
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
        let mut films = Vec::new();
        while from.holds(&format!("film_{}_speed", films.len() + 1)) {
            let name = |part: &str| format!("film_{}_{part}", films.len() + 1);
            let columns = from.number(&name("columns"))? as usize;
            let part = |part: &str| {
                let values = from.series(&name(part))?;
                let rows = values.len() / columns.max(1);
                Field::from_shape_vec((rows, columns), values)
                    .map_err(|_| Error::Unsupported("films of another grid"))
            };
            let approach = from.number(&name("approach"))?;
            let film = Film::from_parts(part, approach)?;
            films.push(SolvedFilm { speed: from.number(&name("speed"))?, film });
        }
        Ok(Self { records, start, films })
    }
}

/// Creates the record of a contact, without its stiffness and its drag.
fn record(boundary: Boundary, point: usize, contact: &LoadedContact) -> SweepRecord {
    let StaticRecord { load, approach, contact_area, apparent_area, .. } = contact.record;
    let Solution { grid, pressure, bounds, .. } = contact.solution.normal();
    let touches: Vec<bool> = pressure.iter().enumerate().map(|(cell, p)| bounds.touches(cell, *p)).collect();
    let contact_cells = (0..touches.len()).filter(|cell| touches[*cell]);
    let shear = contact.record.shear.as_ref();
    let of_shear = |value: fn(&ShearRecord) -> f64| shear.map_or(0.0, value);
    SweepRecord {
        point,
        load,
        mean_pressure: load / apparent_area,
        approach,
        mean_gap: contact.record.mean_gap,
        contact_area,
        contact_area_corrected: corrected_area(&touches, grid, boundary.wraps()),
        contact_fraction: contact_area / apparent_area,
        largest_spot_cells: largest_spot(contact_cells, grid.shape, boundary.wraps()),
        max_pressure: contact.record.max_pressure,
        plastic_area: grid.cell_area() * contact.record.plastic_cells as f64,
        plastic_volume: contact.record.plastic_volume,
        elastic_energy: contact.record.elastic_energy,
        stiffness: None,
        creepage_x: of_shear(|shear| shear.creepage.unwrap_or_default()[0]),
        creepage_y: of_shear(|shear| shear.creepage.unwrap_or_default()[1]),
        tangential_force_x: of_shear(|shear| shear.tangential_force[0]),
        tangential_force_y: of_shear(|shear| shear.tangential_force[1]),
        stick_area: of_shear(|shear| shear.stick_area),
        max_shear: of_shear(|shear| shear.max_shear),
        dissipation: of_shear(|shear| shear.dissipation),
        slip_work: of_shear(|shear| shear.slip_work.unwrap_or_default()),
        iterations: contact.record.iterations,
        convolutions: contact.record.convolutions,
        residual: contact.record.residual,
        interface: contact.record.interface,
        speed: None,
        steady: None,
        lubrication: None,
        plastic: None,
    }
}

//! Lubricated bodies in passes: each position is a step of time, and takes the film of the one before.

use std::sync::Arc;

use crate::error::{Error, Result};
use crate::grid::{Field, Grid};
use crate::lubrication::{FilmParams, FilmProblem, FilmSolution, FilmSpeeds, Lubrication};
use crate::motion::contact::Contact;
use crate::motion::kinematics::{Motion, Strategy};
use crate::motion::lubricated_measure::FilmMeasure;
use crate::motion::moving_film::{Frame, HALVINGS, MovingFilm, Place, field_like};
use crate::motion::pair::Pair;
use crate::motion::pass::{Pass, Solver};
use crate::motion::path::Stroke;
use crate::motion::watch::Progress;
use crate::operator::Boundary;
use crate::solver::{Bounds, Control, Params, Solution, Stats, solve_normal};
use crate::subsurface::Tractions;
use crate::units::MetrePerSecond;

/// Checks what lubricated bodies need to pass over each other.
pub(super) fn check(pair: &Pair, boundary: Boundary, motion: &Motion, params: &Params) -> Result<()> {
    if pair.lubrication().is_none() {
        return Ok(());
    }
    pair.check_lubricated()?;
    params.device.only_processor("a device does not solve films of oil")?;
    let speed = Frame::new(motion, pair).mean_speed(motion, Stroke::Forth);
    let refused = if speed.is_nan() {
        "lubricated bodies that pass over each other need a speed"
    } else if speed == 0.0 {
        "lubricated bodies whose speeds cancel entrain no oil"
    } else if boundary.repeats(0) {
        "a film needs a boundary that is free along x, where the oil enters and leaves"
    } else if motion.friction.is_some() {
        "the friction of lubricated bodies is that of their oil and of their solids"
    } else {
        return Ok(());
    };
    Err(Error::Unsupported(refused))
}

impl Solver<'_> {
    /// Solves all positions of a pass of lubricated bodies, one after another. A pass begins with the steady film at its
    /// first position; the passes of a shift after the first with the film of the pass before.
    pub(super) fn solve_lubricated(
        &self,
        pair: &Pair,
        lubrication: &Lubrication,
        boundary: Boundary,
        control: Control,
    ) -> Result<Pass> {
        let pitch = pair.pitch();
        let is_overlap = self.motion.strategy == Strategy::Overlap;
        let frame = Frame::new(self.motion, pair);
        let place = |index: usize| frame.place(self.motion, &self.positions[index]);
        let gap_at = |index: usize| place(index).turned_field(&pair.initial_gap(&self.positions[index]));
        let speed_at = |index: usize| frame.mean_speed(self.motion, self.positions[index].stroke).abs();
        let last = self.positions.len() - 1;
        let mut begins = None;
        let mut operator = self.operators.on([place(0).columns, pair.lower.width()]);
        let before = if self.motion.repeats() { last } else { 0 };
        let kept = MovingFilm::kept(lubrication, control, place(last), gap_at(before), pair);
        let mut moving = match kept.filter(|_| !is_overlap) {
            Some(kept) => kept,
            None => {
                let (gap, speed) = (gap_at(0), speed_at(0));
                let first = FilmProblem { speed, ..lubrication.problem(&gap, control) };
                let films = FilmSpeeds::new(&mut *operator, &first, FilmParams::default());
                let found = films.and_then(|mut films| films.film_at(&mut *operator, speed));
                let solution = found.map_err(|error| self.at_position(0, error))?.solution;
                let moving = MovingFilm::new(lubrication, control, place(0), gap.clone(), &solution);
                begins = Some(solution);
                moving
            }
        };
        let longest = self.positions.iter().map(|position| position.columns).max();
        let mut contacts: Vec<Contact> = Vec::with_capacity(self.positions.len());
        let mut films = Vec::with_capacity(self.positions.len());
        for (index, position) in self.positions.iter().enumerate() {
            if self.watch.stop() {
                return Err(Error::Interrupted);
            }
            let (place, gap, speed) = (place(index), gap_at(index), speed_at(index));
            let grid = pair.grid(place.columns);
            if operator.grid().shape != grid.shape {
                operator = self.operators.on(grid.shape);
            }
            let above = gap.mapv(|gap| gap - lubrication.boundary_film);
            let params = Params::default();
            let dry = solve_normal(&mut *operator, &above, &Bounds::ELASTIC, control, None, &params)
                .map_err(|error| self.at_position(index, error))?;
            let solution = match begins.take() {
                Some(solution) => solution,
                None => {
                    moving.carry(place, &gap, &dry);
                    let cells = self.motion.cells_to_position(index, pair.lower.columns());
                    let motion = (speed, self.motion.time_of(cells, pitch[0]));
                    moving
                        .advance(&mut *operator, &gap, motion, HALVINGS)
                        .map_err(|error| self.at_position(index, error))?
                }
            };
            let problem = FilmProblem { speed, ..lubrication.problem(&gap, control) };
            let measure = FilmMeasure::new(pair, *lubrication, &gap, &dry.pressure, (&grid, boundary));
            let hardness = pair.yields().then(|| place.turned_values(pair.bounds(position).upper()));
            let sliding = self.motion.sliding_speed();
            let (forces, mut film) = measure.record(&problem, &solution, &grid, sliding, hardness.as_ref());
            // A contact that enters or leaves has a short inlet.
            film.inlet_ratio = film.inlet_ratio.filter(|_| longest == Some(place.columns));
            let load = forces.oil_load + forces.solid_load;
            // Bodies that roll have 0, and not −0.
            let direction = position.stroke.sign() * self.motion.strategy.direction() + 0.0;
            let shear = direction * solids_and_oil(lubrication, (&problem, &solution), sliding);
            let borne = &solution.film.oil_pressure + &solution.film.solid_pressure;
            let [pressure, shear] = [borne, shear].map(|traction| place.turned_field(&traction));
            let film_tractions = Some(Arc::new(Tractions { pressure, shear: [Some(shear), None] }));
            let tangential_force = direction * film.traction_coefficient * load;
            let contact = self.lubricated_contact(index, &place, &solution, (&gap, &grid));
            contacts.push(Contact { load, tangential_force, film_tractions, ..contact });
            films.push(film);
            self.watch.position(&Progress { solved: index + 1, load, ..self.progress });
        }
        let mut after = pair.clone();
        if !is_overlap {
            moving.keep(&mut after);
        }
        Ok(Pass { films, ..Pass::new(contacts, after, self.laws) })
    }

    /// Returns the contact of a film at a place: laws see the pressure of the solids.
    fn lubricated_contact(
        &self,
        index: usize,
        place: &Place,
        solution: &FilmSolution,
        (gap, grid): (&Field, &Grid),
    ) -> Contact {
        let FilmSolution { film, thickness, residual, iterations, convolutions, .. } = solution;
        let stats = Stats { iterations: *iterations, convolutions: *convolutions as f64, ..Stats::default() };
        let displacement = thickness - gap + film.approach;
        let solids = Solution {
            grid: *grid,
            initial_gap: place.turned_field(gap),
            bounds: Bounds::ELASTIC,
            pressure: place.turned_field(&film.solid_pressure),
            displacement: place.turned_field(&displacement),
            approach: film.approach,
            residual: *residual,
            stats,
        };
        self.contact(index, &solids)
    }
}

/// Returns the shear stress of a film whose surfaces slide at this speed: that of the oil, and the friction of the solids.
fn solids_and_oil(
    lubrication: &Lubrication,
    (problem, solution): (&FilmProblem<'_>, &FilmSolution),
    sliding: MetrePerSecond,
) -> Field {
    let oil = field_like(problem.gap, &problem.shear_stress(solution, sliding, lubrication.shear));
    oil + lubrication.solid_friction_at(sliding) * &solution.film.solid_pressure
}

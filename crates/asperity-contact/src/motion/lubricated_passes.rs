//! Lubricated bodies in passes: each position is a step of time, and takes the film of the one before.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::lubrication::{
    Film, FilmParams, FilmProblem, FilmSolution, FilmSpeeds, Lubrication, OilStep, solve_film,
};
use crate::motion::body::State;
use crate::motion::contact::Contact;
use crate::motion::control::LoadControl;
use crate::motion::kinematics::{Motion, Strategy};
use crate::motion::lubricated_measure::FilmMeasure;
use crate::motion::pair::Pair;
use crate::motion::pass::{Pass, Solver};
use crate::motion::path::Path;
use crate::motion::watch::Progress;
use crate::operator::{Boundary, Operator};
use crate::solver::{Bounds, Control, Params, Solution, Stats};
use crate::units::{MetrePerSecond, Second};

/// Most times that a step of time is halved.
const HALVINGS: usize = 6;

/// Names of two fields in the state of the lower body, beside those of [`Film::parts`]: the oil in each cell, and the
/// approach. All of them lie in the frame of the contact.
const OIL: &str = "oil_content";
const APPROACH: &str = "oil_approach";

/// Checks what lubricated bodies need to pass over each other.
pub(super) fn check(pair: &Pair, boundary: Boundary, motion: &Motion, params: &Params) -> Result<()> {
    if pair.lubrication().is_none() {
        return Ok(());
    }
    pair.check_lubricated()?;
    params.device.only_processor("a device does not solve films of oil")?;
    let refused = if mean_speed(motion).is_none() {
        "lubricated bodies pass over each other by a shift, and their mean speed is along +x"
    } else if boundary.repeats(0) {
        "a film needs a boundary that is free along x, where the oil enters and leaves"
    } else if matches!(motion.control, Control::Load(_)) && motion.load_control != LoadControl::Step {
        "a load on lubricated bodies holds at every position"
    } else if motion.path != Path::OneWay {
        "lubricated bodies move one way"
    } else if motion.friction.is_some() {
        "the friction of lubricated bodies is that of their oil and of their solids"
    } else {
        return Ok(());
    };
    Err(Error::Unsupported(refused))
}

/// Mean speed of both surfaces of a shift along +x; `None` of other motions.
fn mean_speed(motion: &Motion) -> Option<MetrePerSecond> {
    match motion.strategy {
        Strategy::Shift { speed_lower, speed_upper } => {
            Some(0.5 * (speed_lower + speed_upper)).filter(|v| *v > 0.0)
        }
        Strategy::Overlap => None,
    }
}

/// A film between two bodies that move.
struct MovingFilm<'a> {
    operator: &'a mut dyn Operator,
    lubrication: &'a Lubrication,
    speed: MetrePerSecond,
    control: Control,
    film: Film,
    /// Oil in each cell, m.
    oil: Vec<f64>,
}

impl MovingFilm<'_> {
    /// Advances from the gap `before` to the gap `after` in a time. A step that does not end is halved, up to so many
    /// times: in between the gap changes evenly.
    fn advance(
        &mut self,
        before: &Field,
        after: &Field,
        duration: Second,
        halvings: usize,
    ) -> Result<FilmSolution> {
        let Lubrication { oil, boundary_film, ends, .. } = *self.lubrication;
        let (speed, control) = (self.speed, self.control);
        let step = Some(OilStep { before: &self.oil, duration });
        let problem = FilmProblem { gap: after, oil, speed, boundary_film, control, ends, step };
        match solve_film(self.operator, &problem, &self.film, &FilmParams::default()) {
            Err(Error::NotConverged { .. }) if halvings > 0 => {
                let middle = 0.5 * (before + after);
                let first = self.advance(before, &middle, 0.5 * duration, halvings - 1)?;
                let second = self.advance(&middle, after, 0.5 * duration, halvings - 1)?;
                Ok(FilmSolution {
                    iterations: first.iterations + second.iterations,
                    convolutions: first.convolutions + second.convolutions,
                    ..second
                })
            }
            solution => {
                let solution = solution?;
                (self.film, self.oil) = (solution.film.clone(), solution.oil.clone());
                Ok(solution)
            }
        }
    }

    /// Keeps the film in the state of the lower body.
    fn keep(&self, pair: &mut Pair) {
        let shape = self.film.cavity.raw_dim();
        let oil = Field::from_shape_vec(shape, self.oil.clone()).expect("a value for each cell");
        let approach = Field::from_elem(shape, self.film.approach);
        let mut keep = |name: &str, unit: &str, values: Field| {
            pair.lower.state.insert(name.to_owned(), State { unit: unit.to_owned(), values });
        };
        self.film.parts().into_iter().for_each(|(name, unit, values)| keep(name, unit, values.clone()));
        keep(OIL, "m", oil);
        keep(APPROACH, "m", approach);
    }
}

/// Returns the film that a pass has left in the state of the lower body, with the oil in each cell.
fn kept(pair: &Pair) -> Option<(Film, Vec<f64>)> {
    let field = |name: &str| Some(&pair.lower.state.get(name)?.values);
    let film = Film::from_parts(|name| field(name).cloned().ok_or(()), *field(APPROACH)?.first()?).ok()?;
    Some((film, field(OIL)?.iter().copied().collect()))
}

impl Solver<'_> {
    /// Solves all positions of a pass of lubricated bodies, one after another. The first pass begins with the steady
    /// film at its first position, the others with the film of the pass before.
    pub(super) fn solve_lubricated(
        &self,
        pair: &Pair,
        lubrication: &Lubrication,
        boundary: Boundary,
        control: Control,
    ) -> Result<Pass> {
        let refused = Error::Unsupported("lubricated bodies that pass over each other in an overlap");
        let speed = mean_speed(self.motion).ok_or(refused)?;
        let (grid, pitch, columns) = (pair.lower_grid(), pair.pitch()[0], pair.lower.columns());
        let mut operator = self.operators.on(grid.shape);
        let mut gap = pair.initial_gap(&self.positions[0]);
        let first = FilmProblem { speed, ..lubrication.problem(&gap, control) };
        let mut steady = FilmSpeeds::new(&mut *operator, &first, FilmParams::default())?;
        let measure = FilmMeasure::new(pair, *lubrication, &gap, &steady.dry().solid_pressure, boundary);
        let (mut begins, (film, oil)) = match kept(pair) {
            Some(kept) => (None, kept),
            None => {
                let found =
                    steady.film_at(&mut *operator, speed).map_err(|error| self.at_position(0, error))?;
                let solution = found.solution;
                (Some(solution.clone()), (solution.film, solution.oil))
            }
        };
        let mut moving = MovingFilm { operator: &mut *operator, lubrication, speed, control, film, oil };
        if begins.is_none() && self.motion.repeats() {
            gap = pair.initial_gap(&self.positions[self.positions.len() - 1]);
        }
        let mut contacts: Vec<Contact> = Vec::with_capacity(self.positions.len());
        let mut films = Vec::with_capacity(self.positions.len());
        for (index, position) in self.positions.iter().enumerate() {
            if self.watch.stop() {
                return Err(Error::Interrupted);
            }
            let before = std::mem::replace(&mut gap, pair.initial_gap(position));
            let duration = self.motion.time_of(self.motion.cells_to_position(index, columns), pitch);
            let solution = match begins.take() {
                Some(solution) => solution,
                None => moving
                    .advance(&before, &gap, duration, HALVINGS)
                    .map_err(|error| self.at_position(index, error))?,
            };
            let problem = FilmProblem { speed, ..lubrication.problem(&gap, control) };
            let hardness = pair.yields().then(|| pair.bounds(position));
            let sliding = self.motion.sliding_speed();
            let (forces, film) = measure.record(&problem, &solution, &grid, sliding, hardness.as_ref());
            let load = forces.oil_load + forces.solid_load;
            let borne = [load, film.traction_coefficient];
            contacts.push(self.lubricated_contact(index, pair, &solution, &gap, borne));
            films.push(film);
            self.watch.position(&Progress { solved: index + 1, load, ..self.progress });
        }
        let mut after = pair.clone();
        moving.keep(&mut after);
        Ok(Pass { films, ..Pass::new(contacts, after, self.laws) })
    }

    /// Returns the contact of a film of this load and traction: laws see the pressure of the solids; the load is that of
    /// oil and solids.
    fn lubricated_contact(
        &self,
        index: usize,
        pair: &Pair,
        solution: &FilmSolution,
        gap: &Field,
        [load, traction]: [f64; 2],
    ) -> Contact {
        let FilmSolution { film, thickness, residual, iterations, convolutions, .. } = solution;
        let stats = Stats { iterations: *iterations, convolutions: *convolutions as f64, ..Stats::default() };
        let solids = Solution {
            grid: pair.lower_grid(),
            initial_gap: gap.clone(),
            bounds: Bounds::ELASTIC,
            pressure: film.solid_pressure.clone(),
            displacement: thickness - gap + film.approach,
            approach: film.approach,
            residual: *residual,
            stats,
        };
        // Bodies that roll have 0, and not −0.
        let tangential_force = self.motion.strategy.direction() * traction * load + 0.0;
        Contact { load, tangential_force, ..self.contact(index, &solids) }
    }
}

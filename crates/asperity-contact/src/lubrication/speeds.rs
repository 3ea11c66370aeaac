//! Films at one speed after another.

use super::film::{Film, FilmParams, FilmProblem, FilmSolution, solve_film};
use crate::error::{Error, Result};
use crate::operator::Operator;
use crate::solver::{Bounds, Control, Params, solve_normal};

/// Largest ratio of two speeds at which one solution is tried as the start of the other.
const NEAR: f64 = 10.0;

/// Ratio of the first speed on the way from the dry contact to the one that is wanted.
const SLOW: f64 = 1e-4;

/// Ratio of two speeds on the way to the one that is wanted, at first and at least.
const STRIDES: [f64; 2] = [4.0, 1.05];

/// Thickness of the films that are tried as the start of a fast one, in boundary films.
const THICKNESSES: [f64; 6] = [3.0, 10.0, 30.0, 100.0, 300.0, 1000.0];

/// The films of two bodies at the speeds of a Stribeck curve, in any order.
///
/// A film starts from the one at the nearest speed. Where there is none, or if it fails, it starts from a full
/// film under the pressure of the dry contact, from the dry contact itself, and at last from the films on the way
/// from the slowest speeds.
pub struct FilmSpeeds<'a> {
    problem: FilmProblem<'a>,
    params: FilmParams,
    dry: Film,
    solved: Vec<(f64, Film)>,
}

impl<'a> FilmSpeeds<'a> {
    /// Solves for the dry contact, from which films start. The speed of the problem does not matter.
    ///
    /// # Errors
    /// As [`solve_normal`].
    pub fn new(operator: &mut dyn Operator, problem: FilmProblem<'a>, params: FilmParams) -> Result<Self> {
        let gap = problem.gap.mapv(|gap| gap - problem.boundary_film);
        let dry = solve_normal(operator, &gap, &Bounds::ELASTIC, problem.control, None, &Params::default())?;
        Ok(Self { problem, params, dry: Film::dry(dry.pressure, dry.approach), solved: Vec::new() })
    }

    /// Returns the dry contact, whose solids keep the boundary film between them.
    pub fn dry(&self) -> &Film {
        &self.dry
    }

    /// Solves for the film at a speed > 0.
    ///
    /// # Errors
    /// As [`solve_film`]; [`Error::NotConverged`] if no way leads to it.
    pub fn at(&mut self, operator: &mut dyn Operator, speed: f64) -> Result<FilmSolution> {
        let solution = self.first_found(operator, speed)?;
        self.solved.push((speed, solution.film.clone()));
        Ok(solution)
    }

    fn first_found(&self, operator: &mut dyn Operator, speed: f64) -> Result<FilmSolution> {
        let ratio = |other: f64| (other / speed).max(speed / other);
        let nearest = self.solved.iter().min_by(|a, b| ratio(a.0).total_cmp(&ratio(b.0)));
        if let Some((_, film)) = nearest.filter(|(other, _)| ratio(*other) <= NEAR)
            && let Some(solution) = self.tried(operator, speed, film)?
        {
            return Ok(solution);
        }
        let full = self.full(operator, speed)?;
        for start in [&full, &self.dry] {
            if let Some(solution) = self.tried(operator, speed, start)? {
                return Ok(solution);
            }
        }
        self.approached_from_slow(operator, speed)
    }

    /// Walks from the dry contact to a speed; strides become shorter where one fails.
    fn approached_from_slow(&self, operator: &mut dyn Operator, speed: f64) -> Result<FilmSolution> {
        let [mut stride, least] = STRIDES;
        let mut film = self.dry.clone();
        let mut reached = SLOW * speed / stride;
        loop {
            let next = (reached * stride).min(speed);
            match self.tried(operator, next, &film)? {
                Some(solution) if next == speed => return Ok(solution),
                Some(solution) => (film, reached) = (solution.film, next),
                None => stride = stride.sqrt(),
            }
            if stride < least {
                return self.solve(operator, speed, &film);
            }
        }
    }

    fn solve(&self, operator: &mut dyn Operator, speed: f64, start: &Film) -> Result<FilmSolution> {
        solve_film(operator, &FilmProblem { speed, ..self.problem }, start, &self.params)
    }

    /// Returns the solution from this start; none if it does not converge.
    fn tried(&self, operator: &mut dyn Operator, speed: f64, start: &Film) -> Result<Option<FilmSolution>> {
        match self.solve(operator, speed, start) {
            Err(Error::NotConverged { .. }) => Ok(None),
            solution => solution.map(Some),
        }
    }

    /// Returns a film full of oil under the pressure of the dry contact, of the thickness that leaves the least
    /// residual.
    fn full(&self, operator: &mut dyn Operator, speed: f64) -> Result<Film> {
        let problem = FilmProblem { speed, ..self.problem };
        let mut best: Option<(f64, Film)> = None;
        for thickness in THICKNESSES {
            let least = thickness * problem.boundary_film;
            let film = Film::full(operator, problem.gap, self.dry.solid_pressure.clone(), least);
            let control = match problem.control {
                Control::Approach(_) => Control::Approach(film.approach),
                load @ Control::Load(_) => load,
            };
            let norm = FilmProblem { control, ..problem }.norm(operator, &film)?;
            if best.as_ref().is_none_or(|(best, _)| norm < *best) {
                best = Some((norm, film));
            }
        }
        Ok(best.expect("a thickness was tried").1)
    }
}

//! Films at one speed after another.

use super::film::{Film, FilmParams, FilmProblem, FilmSolution, OilStep, solve_film};
use crate::error::{Error, Result};
use crate::operator::Operator;
use crate::solver::{Bounds, Control, Params, solve_normal};

/// Largest ratio of two speeds at which one solution is tried as the start of the other.
const NEAR: f64 = 10.0;

/// Factor between one step of time and the next on the way to a steady film.
const LONGER: f64 = 3.0;

/// Shortest step of time on that way, in times that a surface needs for a cell.
const SHORTEST: f64 = 1e-3;

/// Thickness of the films that are tried as the start of a fast one, in boundary films.
const THICKNESSES: [f64; 6] = [3.0, 10.0, 30.0, 100.0, 300.0, 1000.0];

/// The films of two bodies at the speeds of a Stribeck curve, in any order.
///
/// A film starts from the one at the nearest speed. Where there is none, or if it fails, it starts from the dry
/// contact or from a full film under its pressure, whichever leaves less residual, then from the other one. At last the film is followed in time
/// from the dry contact.
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
        for start in self.starts(operator, speed)? {
            if let Some(solution) = self.tried(operator, speed, &start)? {
                return Ok(solution);
            }
        }
        self.followed(operator, speed)
    }

    /// Follows the film in time from the dry contact to its steady state. Steps of time become longer while they
    /// succeed.
    fn followed(&self, operator: &mut dyn Operator, speed: f64) -> Result<FilmSolution> {
        let problem = FilmProblem { speed, ..self.problem };
        let transit = operator.grid().pitch[0] / speed;
        let mut duration = transit;
        let mut film = self.dry.clone();
        let mut oil = problem.oil_in(operator, &film);
        loop {
            let step = Some(OilStep { before: &oil, duration });
            match solve_film(operator, &FilmProblem { step, ..problem }, &film, &self.params) {
                Ok(solution) => {
                    (film, oil) = (solution.film, solution.oil);
                    duration *= LONGER;
                    if let Some(solution) = self.tried(operator, speed, &film)? {
                        return Ok(solution);
                    }
                }
                Err(Error::NotConverged { .. }) if duration > SHORTEST * transit => {
                    duration /= LONGER * LONGER
                }
                Err(error) => return Err(error),
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

    /// Returns the dry contact and a film full of oil under its pressure, of the thickness that leaves the least
    /// residual; the one that leaves less comes first.
    fn starts(&self, operator: &mut dyn Operator, speed: f64) -> Result<[Film; 2]> {
        let dry = self.norm(operator, speed, &self.dry)?;
        let mut least: Option<(f64, Film)> = None;
        for thickness in THICKNESSES {
            let thicker = (thickness - 1.0) * self.problem.boundary_film;
            let film = Film {
                oil_pressure: self.dry.solid_pressure.clone(),
                solid_pressure: self.dry.oil_pressure.clone(),
                cavity: self.dry.cavity.clone(),
                approach: self.dry.approach - thicker,
            };
            let norm = self.norm(operator, speed, &film)?;
            if least.as_ref().is_none_or(|(least, _)| norm < *least) {
                least = Some((norm, film));
            }
        }
        let (norm, full) = least.expect("a thickness was tried");
        let dry_film = self.dry.clone();
        Ok(if norm < dry { [full, dry_film] } else { [dry_film, full] })
    }

    /// Returns the norm of all residuals of a film at its own approach, if an approach is prescribed.
    fn norm(&self, operator: &mut dyn Operator, speed: f64, film: &Film) -> Result<f64> {
        let control = match self.problem.control {
            Control::Approach(_) => Control::Approach(film.approach),
            load @ Control::Load(_) => load,
        };
        FilmProblem { speed, control, ..self.problem }.norm(operator, film)
    }
}

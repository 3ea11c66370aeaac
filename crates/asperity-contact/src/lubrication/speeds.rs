//! Films at one speed after another.

use std::borrow::Cow;

use super::film::{Film, FilmParams, FilmProblem, FilmSolution, solve_film};
use super::flow::OilStep;
use crate::error::{Error, Result};
use crate::grid::{Field, Grid, coarse_means};
use crate::operator::Operator;
use crate::solver::{Bounds, Control, Params, solve_normal};

/// Fewest cells along the shorter side of a grid whose films are solved for on half as many first.
const HALVED: usize = 32;

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
/// Each film is solved for on half as many cells along both axes first. It starts from that film or from the one at
/// the nearest speed, without them from the dry contact or from a full film under its pressure: from the one that
/// leaves less residual, and if that fails from the others. At last the film is followed in time.
pub struct FilmSpeeds<'a> {
    /// The problem on the finest grid.
    problem: FilmProblem<'a>,
    params: FilmParams,
    gap: Cow<'a, Field>,
    dry: Film,
    solved: Vec<(f64, Film)>,
    half: Option<Box<Half<'a>>>,
}

/// The same films on half as many cells.
struct Half<'a> {
    operator: Box<dyn Operator>,
    films: FilmSpeeds<'a>,
}

/// The film at a speed.
#[derive(Debug, Clone)]
pub struct FilmAtSpeed {
    /// The film.
    pub solution: FilmSolution,
    /// The film on half as many cells along both axes, with their grid; none if the grid is too coarse to be halved,
    /// or if that film does not converge. Its difference is an estimate of the error, which is large where asperities
    /// carry thin films.
    pub half: Option<(Grid, FilmSolution)>,
}

impl<'a> FilmSpeeds<'a> {
    /// Solves for the dry contact, from which films start. The speed of the problem does not matter.
    ///
    /// # Errors
    /// As [`solve_normal`].
    pub fn new(operator: &mut dyn Operator, problem: FilmProblem<'a>, params: FilmParams) -> Result<Self> {
        Self::on_grid(operator, problem, params, Cow::Borrowed(problem.gap))
    }

    fn on_grid(
        operator: &mut dyn Operator,
        problem: FilmProblem<'a>,
        params: FilmParams,
        gap: Cow<'a, Field>,
    ) -> Result<Self> {
        let above = gap.mapv(|gap| gap - problem.boundary_film);
        let dry =
            solve_normal(operator, &above, &Bounds::ELASTIC, problem.control, None, &Params::default())?;
        let half = if operator.grid().shape.iter().all(|cells| *cells >= HALVED) {
            let mut operator = operator.coarse();
            let gap = Cow::Owned(coarse_means(&gap));
            let films = Self::on_grid(&mut *operator, problem, params, gap)?;
            Some(Box::new(Half { operator, films }))
        } else {
            None
        };
        let dry = Film::dry(dry.pressure, dry.approach);
        Ok(Self { problem, params, gap, dry, solved: Vec::new(), half })
    }

    /// Returns the dry contact, whose solids keep the boundary film between them.
    pub fn dry(&self) -> &Film {
        &self.dry
    }

    /// Solves for the film at a speed > 0.
    ///
    /// # Errors
    /// As [`solve_film`]; [`Error::NotConverged`] if no way leads to it.
    pub fn at(&mut self, operator: &mut dyn Operator, speed: f64) -> Result<FilmAtSpeed> {
        let half = match &mut self.half {
            Some(half) => match half.films.at(&mut *half.operator, speed) {
                Err(Error::NotConverged { .. }) => None,
                found => Some((*half.operator.grid(), found?.solution)),
            },
            None => None,
        };
        let solution =
            self.first_found(operator, speed, half.as_ref().map(|(_, solution)| &solution.film))?;
        self.solved.push((speed, solution.film.clone()));
        Ok(FilmAtSpeed { solution, half })
    }

    fn first_found(
        &self,
        operator: &mut dyn Operator,
        speed: f64,
        half: Option<&Film>,
    ) -> Result<FilmSolution> {
        let ratio = |other: f64| (other / speed).max(speed / other);
        let nearest = self.solved.iter().min_by(|a, b| ratio(a.0).total_cmp(&ratio(b.0)));
        let nearest = nearest.filter(|(other, _)| ratio(*other) <= NEAR).map(|(_, film)| film.clone());
        let known: Vec<Film> =
            nearest.into_iter().chain(half.map(|half| half.on_twice(self.gap.dim()))).collect();
        for starts in [known, self.unknown()] {
            for start in self.by_residual(operator, speed, starts)? {
                if let Some(solution) = self.tried(operator, speed, &start)? {
                    return Ok(solution);
                }
            }
        }
        self.followed(operator, speed)
    }

    /// Follows the film in time from the dry contact to its steady state. Steps of time become longer while they
    /// succeed.
    fn followed(&self, operator: &mut dyn Operator, speed: f64) -> Result<FilmSolution> {
        let problem = self.problem(speed);
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

    fn problem(&self, speed: f64) -> FilmProblem<'_> {
        FilmProblem { gap: &self.gap, speed, ..self.problem }
    }

    /// Returns the solution from this start; none if it does not converge.
    fn tried(&self, operator: &mut dyn Operator, speed: f64, start: &Film) -> Result<Option<FilmSolution>> {
        match solve_film(operator, &self.problem(speed), start, &self.params) {
            Err(Error::NotConverged { .. }) => Ok(None),
            solution => solution.map(Some),
        }
    }

    /// Returns the dry contact, and films full of oil under its pressure.
    fn unknown(&self) -> Vec<Film> {
        let full = THICKNESSES.map(|thickness| Film {
            oil_pressure: self.dry.solid_pressure.clone(),
            solid_pressure: self.dry.oil_pressure.clone(),
            cavity: self.dry.cavity.clone(),
            approach: self.dry.approach - (thickness - 1.0) * self.problem.boundary_film,
        });
        let mut starts = full.to_vec();
        starts.push(self.dry.clone());
        starts
    }

    /// Returns at most two of these films, those that leave the least residual at a speed.
    fn by_residual(&self, operator: &mut dyn Operator, speed: f64, films: Vec<Film>) -> Result<Vec<Film>> {
        let mut sorted = Vec::with_capacity(films.len());
        for film in films {
            let control = match self.problem.control {
                Control::Approach(_) => Control::Approach(film.approach),
                load @ Control::Load(_) => load,
            };
            let norm = FilmProblem { control, ..self.problem(speed) }.norm(operator, &film)?;
            sorted.push((norm, film));
        }
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(sorted.into_iter().take(2).map(|(_, film)| film).collect())
    }
}

impl Film {
    /// Returns the film on about twice as many cells along both axes, by linear interpolation.
    fn on_twice(&self, shape: (usize, usize)) -> Self {
        let twice = |coarse: &Field| {
            // The two nearest coarse cells along an axis; the first one weighs three quarters.
            let nearest = |i: usize, cells: usize| {
                let own = (i / 2).min(cells - 1);
                [own, if i.is_multiple_of(2) { own.saturating_sub(1) } else { (own + 1).min(cells - 1) }]
            };
            let (nx, ny) = coarse.dim();
            Field::from_shape_fn(shape, |(i, j)| {
                let ([i, k], [j, l]) = (nearest(i, nx), nearest(j, ny));
                let along = |j: usize| 0.75 * coarse[(i, j)] + 0.25 * coarse[(k, j)];
                0.75 * along(j) + 0.25 * along(l)
            })
        };
        Self {
            oil_pressure: twice(&self.oil_pressure),
            solid_pressure: twice(&self.solid_pressure),
            cavity: twice(&self.cavity),
            approach: self.approach,
        }
    }
}

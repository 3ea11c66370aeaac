//! Films at one speed after another.

use std::borrow::Cow;

use super::film::{Film, FilmParams, FilmProblem, FilmSolution, solve_film};
use super::flow::OilStep;
use super::oil::Oil;
use crate::error::{Error, Result, check};
use crate::grid::{Field, Grid, coarse_means};
use crate::operator::Operator;
use crate::solver::{Bounds, Control, Params, solve_normal};
use crate::units::{Metre, Pascal};

/// Fewest cells along the shorter side of a grid whose films are solved for on half as many first.
const HALVED: usize = 32;

/// Largest ratio of two speeds at which one solution is tried as the start of the other.
const NEAR: f64 = 10.0;

/// Share of the solids in the load from which on a film starts from the dry contact before speeds between.
const NEAR_DRY: f64 = 0.1;

/// Least logarithm of the ratio of two speeds on the way from one to another.
const LEAST_STRIDE: f64 = 0.05;

/// Factor between one step of time and the next on the way to a steady film.
const LONGER: f64 = 3.0;

/// Shortest step of time on that way, in times that a surface needs for a cell.
const SHORTEST: f64 = 1e-3;

/// Most steps of time on that way.
const MOST_STEPS: usize = 60;

/// Thickness of the films that are tried as the start of a fast one, in boundary films.
const THICKNESSES: [f64; 6] = [3.0, 10.0, 30.0, 100.0, 300.0, 1000.0];

/// The films of two bodies at the speeds of a Stribeck curve, in any order.
///
/// Each film is solved for on half as many cells along both axes first. It starts from the film at the speed before,
/// and if that is full, with the change of the coarse one. If it fails, speeds between are solved for. The first film
/// starts from the coarse one, or from the dry contact, or from a full film under the pressure of the dry contact. At
/// last the film is followed in time.
pub struct FilmSpeeds {
    gap: Field,
    oil: Oil,
    boundary_film: Metre,
    control: Control,
    ends: [Pascal; 2],
    params: FilmParams,
    dry: Film,
    last: Option<SolvedFilm>,
    half: Option<Box<Half>>,
}

/// A film that was solved for, at its speed.
#[derive(Debug, Clone, PartialEq)]
pub struct SolvedFilm {
    /// Mean speed of both surfaces, m/s.
    pub speed: f64,
    /// The film.
    pub film: Film,
}

/// The same films on half as many cells.
struct Half {
    operator: Box<dyn Operator>,
    films: FilmSpeeds,
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

impl FilmSpeeds {
    /// Solves for the dry contact, from which films start. The films are steady: the speed of the problem and its
    /// step of time do not matter.
    ///
    /// # Errors
    /// As [`solve_normal`].
    ///
    /// # Panics
    /// If the gap has another shape than the operator's grid.
    pub fn new(operator: &mut dyn Operator, problem: &FilmProblem<'_>, params: FilmParams) -> Result<Self> {
        let FilmProblem { gap, oil, boundary_film, control, ends, .. } = *problem;
        let above = gap.mapv(|gap| gap - boundary_film);
        let dry = solve_normal(operator, &above, &Bounds::ELASTIC, control, None, &Params::default())?;
        let half = if operator.grid().shape.iter().all(|cells| *cells >= HALVED) {
            let mut operator = operator.coarse();
            let gap = coarse_means(gap);
            let films = Self::new(&mut *operator, &FilmProblem { gap: &gap, ..*problem }, params)?;
            Some(Box::new(Half { operator, films }))
        } else {
            None
        };
        let dry = Film::dry(dry.pressure, dry.approach);
        Ok(Self { gap: gap.clone(), oil, boundary_film, control, ends, params, dry, last: None, half })
    }

    /// Returns the last films on all grids, the finest first: with [`go_on`](Self::go_on), the next film has the
    /// same bits as without a break.
    pub fn last_films(&self) -> Vec<SolvedFilm> {
        let coarser = self.half.iter().flat_map(|half| half.films.last_films());
        self.last.iter().cloned().chain(coarser).collect()
    }

    /// Goes on from the [`last_films`](Self::last_films) of the same bodies.
    pub fn go_on(&mut self, films: Vec<SolvedFilm>) {
        let mut films = films.into_iter().peekable();
        let own = |film: &SolvedFilm| film.film.cavity.dim() == self.gap.dim();
        self.last = films.next_if(own);
        if let Some(half) = &mut self.half {
            half.films.go_on(films.collect());
        }
    }

    /// Returns the dry contact, whose solids keep the boundary film between them.
    pub fn dry(&self) -> &Film {
        &self.dry
    }

    /// Solves for the film at a speed > 0, or at rest between ends with a pressure.
    ///
    /// # Errors
    /// As [`solve_film`]; [`Error::OutOfRange`] for a speed that is not positive, [`Error::FilmNotConverged`] if no way
    /// leads to the film.
    pub fn film_at(&mut self, operator: &mut dyn Operator, speed: f64) -> Result<FilmAtSpeed> {
        let is_driven = speed > 0.0 || speed == 0.0 && self.ends != [0.0; 2];
        check("speed", speed, is_driven && speed.is_finite(), "above 0 m/s")?;
        // The coarse film at the speed of the last one.
        let before = self.last.as_ref().zip(self.half.as_ref()).and_then(|(last, half)| {
            half.films.last.as_ref().filter(|half| half.speed == last.speed).map(|half| half.film.clone())
        });
        let half = match &mut self.half {
            Some(half) => match half.films.film_at(&mut *half.operator, speed) {
                Err(Error::FilmNotConverged { .. }) => None,
                found => Some((*half.operator.grid(), found?.solution)),
            },
            None => None,
        };
        let coarse = half.as_ref().map(|(_, half)| half.film.clone());
        let solution = self.first_found(operator, speed, before.as_ref(), coarse.as_ref())?;
        self.last = Some(SolvedFilm { speed, film: solution.film.clone() });
        Ok(FilmAtSpeed { solution, half })
    }

    fn first_found(
        &self,
        operator: &mut dyn Operator,
        speed: f64,
        before: Option<&Film>,
        half: Option<&Film>,
    ) -> Result<FilmSolution> {
        let is_near = |last: &&SolvedFilm| (last.speed / speed).max(speed / last.speed) <= NEAR;
        let nearest = self.last.as_ref().filter(is_near);
        for start in self.known(nearest, before, half) {
            if let Some(solution) = self.tried(operator, speed, &start)? {
                return Ok(solution);
            }
        }
        // Where solids bear much, the dry contact is nearer than any speed before.
        let is_near_dry = half.is_some_and(|half| half.solid_share() > NEAR_DRY);
        let far = |operator: &mut dyn Operator| -> Result<Option<FilmSolution>> {
            for start in self.unknown(operator, speed)? {
                if let Some(solution) = self.tried(operator, speed, &start)? {
                    return Ok(Some(solution));
                }
            }
            Ok(None)
        };
        if is_near_dry && let Some(solution) = far(operator)? {
            return Ok(solution);
        }
        if let Some(nearest) = nearest
            && let Some(solution) = self.approached(operator, nearest, speed)?
        {
            return Ok(solution);
        }
        if !is_near_dry && let Some(solution) = far(operator)? {
            return Ok(solution);
        }
        self.followed(operator, speed)
    }

    /// Returns what the film may start from, the best first. Where the film is full, the edge of its cavity moves by
    /// many cells from speed to speed, which the films on half as many cells know, now and `before`. Where solids touch,
    /// the film at the speed before knows more.
    fn known(&self, nearest: Option<&SolvedFilm>, before: Option<&Film>, half: Option<&Film>) -> Vec<Film> {
        let Some(SolvedFilm { film, .. }) = nearest else {
            return half.iter().map(|half| half.on_twice(self.gap.dim())).collect();
        };
        let is_full = half.is_some_and(|half| half.solid_pressure.sum() == 0.0);
        let changed = before.zip(half).map(|(before, half)| film.changed_as(before, half));
        let mut starts: Vec<Film> = changed.into_iter().chain([film.clone()]).collect();
        if !is_full {
            starts.reverse();
        }
        starts
    }

    /// Walks from a film to a speed in strides that are half as long, on a logarithmic scale, where one fails.
    fn approached(
        &self,
        operator: &mut dyn Operator,
        from: &SolvedFilm,
        speed: f64,
    ) -> Result<Option<FilmSolution>> {
        let (mut reached, mut film) = (from.speed, Cow::Borrowed(&from.film));
        let mut stride = (speed / reached).sqrt();
        while stride.ln().abs() > LEAST_STRIDE {
            let is_last = (reached * stride / speed).ln() * stride.ln() >= -1e-9;
            let next = if is_last { speed } else { reached * stride };
            match self.tried(operator, next, &film)? {
                Some(solution) if is_last => return Ok(Some(solution)),
                Some(solution) => (reached, film) = (next, Cow::Owned(solution.film)),
                None => stride = stride.sqrt(),
            }
        }
        Ok(None)
    }

    /// Follows the film in time from the dry contact to its steady state. Steps of time become longer while they
    /// succeed.
    fn followed(&self, operator: &mut dyn Operator, speed: f64) -> Result<FilmSolution> {
        let problem = self.problem(speed);
        // At rest the pressure at the ends drives the oil.
        let driven = (10.0 * self.boundary_film).powi(2) * self.ends[0].max(self.ends[1])
            / (12.0 * self.oil.viscosity * operator.grid().extent()[0]);
        let transit = operator.grid().pitch[0] / speed.max(driven);
        let mut duration = transit;
        let mut film = self.dry.clone();
        let mut oil = problem.oil_in(operator, &film);
        for _ in 0..MOST_STEPS {
            let step = Some(OilStep { before: &oil, duration });
            match solve_film(operator, &FilmProblem { step, ..problem }, &film, &self.params) {
                Ok(solution) => {
                    (film, oil) = (solution.film, solution.oil);
                    duration *= LONGER;
                    if let Some(solution) = self.tried(operator, speed, &film)? {
                        return Ok(solution);
                    }
                }
                Err(Error::FilmNotConverged { .. }) if duration > SHORTEST * transit => {
                    duration /= LONGER * LONGER
                }
                Err(error) => return Err(error),
            }
        }
        solve_film(operator, &problem, &film, &self.params)
    }

    /// Returns the problem at a speed.
    pub fn problem(&self, speed: f64) -> FilmProblem<'_> {
        let Self { gap, oil, boundary_film, control, ends, .. } = self;
        let (oil, boundary_film, control, ends) = (*oil, *boundary_film, *control, *ends);
        FilmProblem { gap, oil, speed, boundary_film, control, ends, step: None }
    }

    /// Returns the solution from this start; none if it does not converge.
    fn tried(&self, operator: &mut dyn Operator, speed: f64, start: &Film) -> Result<Option<FilmSolution>> {
        match solve_film(operator, &self.problem(speed), start, &self.params) {
            Err(Error::FilmNotConverged { .. }) => Ok(None),
            solution => solution.map(Some),
        }
    }

    /// Returns the dry contact and the film full of oil under its pressure whose thickness leaves the least residual;
    /// the one that leaves less comes first.
    fn unknown(&self, operator: &mut dyn Operator, speed: f64) -> Result<[Film; 2]> {
        let mut least: Option<(f64, Film)> = None;
        for thickness in THICKNESSES {
            let film = Film {
                oil_pressure: self.dry.solid_pressure.clone(),
                solid_pressure: self.dry.oil_pressure.clone(),
                cavity: self.dry.cavity.clone(),
                approach: self.dry.approach - (thickness - 1.0) * self.boundary_film,
            };
            let norm = self.norm(operator, speed, &film)?;
            if least.as_ref().is_none_or(|(least, _)| norm < *least) {
                least = Some((norm, film));
            }
        }
        let (norm, full) = least.expect("a thickness was tried");
        let dry = self.dry.clone();
        Ok(if norm < self.norm(operator, speed, &dry)? { [full, dry] } else { [dry, full] })
    }

    /// Returns the norm of all residuals of a film, at its own approach if one is prescribed.
    fn norm(&self, operator: &mut dyn Operator, speed: f64, film: &Film) -> Result<f64> {
        let control = match self.control {
            Control::Approach(_) => Control::Approach(film.approach),
            load @ Control::Load(_) => load,
        };
        FilmProblem { control, ..self.problem(speed) }.norm(operator, film)
    }
}

impl Film {
    /// Share of the solids in the load.
    fn solid_share(&self) -> f64 {
        let [oil, solids] = [&self.oil_pressure, &self.solid_pressure].map(|pressure| pressure.sum());
        solids / (oil + solids)
    }

    /// Returns a film that has changed as one on half as many cells did.
    fn changed_as(&self, before: &Self, after: &Self) -> Self {
        let [before, after] = [before, after].map(|film| film.on_twice(self.cavity.dim()));
        let changed = |film: &Field, before: &Field, after: &Field, most: f64| {
            (film + &(after - before)).mapv(|value| value.clamp(0.0, most))
        };
        let pressure =
            |film: &Field, before: &Field, after: &Field| changed(film, before, after, f64::INFINITY);
        Self {
            oil_pressure: pressure(&self.oil_pressure, &before.oil_pressure, &after.oil_pressure),
            solid_pressure: pressure(&self.solid_pressure, &before.solid_pressure, &after.solid_pressure),
            cavity: changed(&self.cavity, &before.cavity, &after.cavity, 1.0),
            approach: self.approach + after.approach - before.approach,
        }
    }

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

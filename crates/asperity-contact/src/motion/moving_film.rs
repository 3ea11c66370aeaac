//! A film between two bodies that move.

use std::cmp::Ordering;

use crate::error::{Error, Result};
use crate::grid::{CellValues, Field, flat};
use crate::lubrication::{Film, FilmParams, FilmProblem, FilmSolution, Lubrication, OilStep, solve_film};
use crate::motion::body::State;
use crate::motion::kinematics::{Motion, Strategy};
use crate::motion::pair::Pair;
use crate::motion::path::{Position, Stroke};
use crate::operator::Operator;
use crate::solver::{Control, Solution};
use crate::units::{MetrePerSecond, Second};

/// Most times that a step of time is halved.
pub(super) const HALVINGS: usize = 6;

/// Names of two fields in the state of the lower body, beside those of [`Film::parts`]: the oil in each cell, and the
/// approach. All of them lie in the frame of the contact, with the inlet at their first column.
const OIL: &str = "oil_content";
const APPROACH: &str = "oil_approach";

/// The frame in which a film of oil stays where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Frame {
    /// The grid, through which both bodies move.
    Grid,
    /// The lower body.
    Lower,
    /// The upper body.
    Upper,
}

impl Frame {
    /// Returns the frame of the film between two bodies.
    ///
    /// In an overlap it is the shorter body, on which the ends of the contact stay where they are as long as the bodies
    /// overlap as far as they can. It is the higher one, such as a ball, if both are as long.
    pub(super) fn new(motion: &Motion, pair: &Pair) -> Self {
        if matches!(motion.strategy, Strategy::Shift { .. }) {
            return Self::Grid;
        }
        let [lower, upper] = [&pair.lower, &pair.upper];
        match lower.columns().cmp(&upper.columns()) {
            Ordering::Less => Self::Lower,
            Ordering::Equal if lower.height_range() > upper.height_range() => Self::Lower,
            Ordering::Equal | Ordering::Greater => Self::Upper,
        }
    }

    /// Returns the mean speed of both surfaces along x in this frame; NaN if it is not known.
    pub(super) fn mean_speed(self, motion: &Motion, stroke: Stroke) -> MetrePerSecond {
        let relative = motion.speed.unwrap_or(f64::NAN);
        let forth = match (self, motion.strategy) {
            (_, Strategy::Shift { speed_lower, speed_upper }) => 0.5 * (speed_lower + speed_upper),
            (Self::Lower, Strategy::Overlap) => 0.5 * relative,
            (_, Strategy::Overlap) => -0.5 * relative,
        };
        stroke.sign() * forth
    }

    /// Returns where the film lies in this frame at a position.
    pub(super) fn place(self, motion: &Motion, position: &Position) -> Place {
        let start = match self {
            Self::Grid => 0,
            Self::Lower => position.lower,
            Self::Upper => position.upper,
        };
        let is_reversed = self.mean_speed(motion, position.stroke) < 0.0;
        Place { columns: position.columns, start, is_reversed }
    }
}

/// Where the columns of a film lie. They are counted from its inlet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// Number of columns.
    pub(super) columns: usize,
    /// First column of the contact in the frame in which the film stays.
    start: usize,
    /// Whether oil enters at the last column of the contact.
    is_reversed: bool,
}

impl Place {
    /// The column of the contact that is this one from the inlet, or the other way round.
    fn turned(&self, column: usize) -> usize {
        if self.is_reversed { self.columns - 1 - column } else { column }
    }

    /// Returns a field of the contact from its inlet on, or the other way round.
    pub(super) fn turned_field(&self, field: &Field) -> Field {
        Field::from_shape_fn(field.raw_dim(), |(i, j)| field[(self.turned(i), j)])
    }

    /// Returns values of the contact from its inlet on.
    pub(super) fn turned_values(&self, values: &CellValues) -> CellValues {
        match values {
            CellValues::Uniform(value) => CellValues::Uniform(*value),
            CellValues::Field(field) => CellValues::Field(self.turned_field(field)),
        }
    }

    /// Returns the column here that is a `column` at another place, or the nearest one, and whether it is that one.
    fn nearest(&self, to: &Self, column: usize) -> (usize, bool) {
        let column = to.start + to.turned(column);
        let own = column.saturating_sub(self.start).min(self.columns - 1);
        (self.turned(own), self.start + own == column)
    }
}

/// A film between two bodies that move, from its inlet on.
pub(super) struct MovingFilm<'a> {
    lubrication: &'a Lubrication,
    control: Control,
    place: Place,
    gap: Field,
    film: Film,
    /// Oil in each cell, m.
    oil: Field,
}

impl<'a> MovingFilm<'a> {
    /// Begins with a solution over a gap.
    pub(super) fn new(
        lubrication: &'a Lubrication,
        control: Control,
        place: Place,
        gap: Field,
        begins: &FilmSolution,
    ) -> Self {
        let oil = field_like(&gap, &begins.oil);
        Self { lubrication, control, place, gap, film: begins.film.clone(), oil }
    }

    /// Goes on with the film that a pass has left in the state of the lower body, if it has left one.
    pub(super) fn kept(
        lubrication: &'a Lubrication,
        control: Control,
        place: Place,
        gap: Field,
        pair: &Pair,
    ) -> Option<Self> {
        let field = |name: &str| Some(&pair.lower.state.get(name)?.values);
        let film =
            Film::from_parts(|name| field(name).cloned().ok_or(()), *field(APPROACH)?.first()?).ok()?;
        Some(Self { lubrication, control, place, gap, film, oil: field(OIL)?.clone() })
    }

    /// Keeps the film in the state of the lower body.
    pub(super) fn keep(&self, pair: &mut Pair) {
        let approach = Field::from_elem(self.oil.raw_dim(), self.film.approach);
        let mut keep = |name: &str, unit: &str, values: Field| {
            pair.lower.state.insert(name.to_owned(), State { unit: unit.to_owned(), values });
        };
        self.film.parts().into_iter().for_each(|(name, unit, values)| keep(name, unit, values.clone()));
        keep(OIL, "m", self.oil.clone());
        keep(APPROACH, "m", approach);
    }

    /// Carries the film to another place, with this `gap`. Oil without pressure fills the columns that were none before,
    /// whose surfaces are displaced as those of the nearest column. A film that bears nothing there starts from the `dry`
    /// contact.
    pub(super) fn carry(&mut self, to: Place, gap: &Field, dry: &Solution) {
        if self.place == to {
            return;
        }
        let Film { oil_pressure, solid_pressure, cavity, approach } = &self.film;
        let at = |of: &dyn Fn((usize, usize)) -> f64,
                  fresh: &dyn Fn((usize, usize), (usize, usize)) -> f64| {
            Field::from_shape_fn(gap.raw_dim(), |(i, j)| match self.place.nearest(&to, i) {
                (column, true) => of((column, j)),
                (column, false) => fresh((column, j), (i, j)),
            })
        };
        let old = |field: &Field| at(&|cell| field[cell], &|_, _| 0.0);
        let thickness = |cell: (usize, usize)| {
            let density = self.lubrication.oil.under(oil_pressure[cell]).density;
            self.oil[cell] / (density * (1.0 - cavity[cell]).max(f64::EPSILON))
        };
        let full = |near: (usize, usize), cell: (usize, usize)| {
            (thickness(near) + gap[cell] - self.gap[near]).max(self.lubrication.boundary_film)
        };
        let mut film = Film {
            oil_pressure: old(oil_pressure),
            solid_pressure: old(solid_pressure),
            cavity: old(cavity),
            approach: *approach,
        };
        if film.oil_pressure.sum() + film.solid_pressure.sum() == 0.0 {
            film = Film::dry(dry.pressure.clone(), dry.approach);
        }
        let oil = at(&|cell| self.oil[cell], &full);
        let before = at(&|cell| self.gap[cell], &|_, cell| gap[cell]);
        *self = Self { place: to, gap: before, film, oil, ..*self };
    }

    /// Advances to a gap in a time at a mean speed. A step that does not end is halved, up to so many times: in between
    /// the gap changes evenly.
    pub(super) fn advance(
        &mut self,
        operator: &mut dyn Operator,
        after: &Field,
        (speed, duration): (MetrePerSecond, Second),
        halvings: usize,
    ) -> Result<FilmSolution> {
        let step = Some(OilStep { before: flat(&self.oil), duration });
        let problem = FilmProblem { speed, step, ..self.lubrication.problem(after, self.control) };
        match solve_film(operator, &problem, &self.film, &FilmParams::default()) {
            Err(Error::FilmNotConverged { .. }) if halvings > 0 => {
                let middle = 0.5 * (&self.gap + after);
                let half = (speed, 0.5 * duration);
                let first = self.advance(operator, &middle, half, halvings - 1)?;
                let second = self.advance(operator, after, half, halvings - 1)?;
                Ok(FilmSolution {
                    iterations: first.iterations + second.iterations,
                    convolutions: first.convolutions + second.convolutions,
                    ..second
                })
            }
            solution => {
                let solution = solution?;
                (self.film, self.oil) = (solution.film.clone(), field_like(after, &solution.oil));
                self.gap = after.clone();
                Ok(solution)
            }
        }
    }
}

/// Returns a field of this shape from its values.
pub(super) fn field_like(field: &Field, values: &[f64]) -> Field {
    Field::from_shape_vec(field.raw_dim(), values.to_vec()).expect("a value for each cell")
}

//! A pair of bodies with an oil between them, in a steady film.

use crate::error::Result;
use crate::grid::{CellValues, Field, Grid};
use crate::lubrication::{FilmAtSpeed, FilmParams, FilmSolution, FilmSpeeds, Lubrication, SolvedFilm};
use crate::motion::lubricated_measure::FilmMeasure;
use crate::motion::pair::Pair;
use crate::motion::record::{FilmRecord, LubricationRecord};
use crate::motion::state::LoadedContact;
use crate::operator::{Boundary, Operator, Operators};
use crate::solver::{Bounds, Control, Equilibrium, Solution, Stats};
use crate::units::MetrePerSecond;

/// The films of a pair under one load or at one approach.
pub(super) struct LubricatedBodies {
    operator: Box<dyn Operator>,
    gap: Field,
    lubrication: Lubrication,
    films: FilmSpeeds,
    measure: FilmMeasure,
}

impl LubricatedBodies {
    /// Solves for the dry contact of a `pair` over the initial `gap`, and goes on from the `last` films, if there are
    /// some.
    pub(super) fn new(
        pair: &Pair,
        lubrication: Lubrication,
        operators: &Operators,
        (gap, boundary): (&Field, Boundary),
        control: Control,
        last: Vec<SolvedFilm>,
    ) -> Result<Self> {
        pair.check_lubricated()?;
        let mut operator = operators.on(pair.lower_grid().shape);
        let problem = lubrication.problem(gap, control);
        let mut films = FilmSpeeds::new(&mut *operator, &problem, FilmParams::default())?;
        films.go_on(last);
        let dry = &films.dry().solid_pressure;
        let measure = FilmMeasure::new(pair, lubrication, gap, dry, (operator.grid(), boundary));
        Ok(Self { operator, gap: gap.clone(), lubrication, films, measure })
    }

    /// The last films on all grids, the finest first.
    pub(super) fn last_films(&self) -> Vec<SolvedFilm> {
        self.films.last_films()
    }

    /// Solves for the film at a speed. Returns the contact, in which the oil bears on the bodies, too, and its record.
    pub(super) fn contact_at(
        &mut self,
        pair: &Pair,
        speed: MetrePerSecond,
    ) -> Result<(LoadedContact, LubricationRecord)> {
        let FilmAtSpeed { solution, half } = self.films.film_at(&mut *self.operator, speed)?;
        let (problem, sliding_speed) = (self.films.problem(speed), self.lubrication.sliding_at(speed));
        let measured = |solution: &FilmSolution, grid: &Grid, hardness: Option<&CellValues>| {
            self.measure.record(&problem, solution, grid, sliding_speed, hardness)
        };
        let grid = *self.operator.grid();
        let hardness = pair.yields().then(|| pair.bounds(&pair.at_rest()));
        let (forces, film) = measured(&solution, &grid, hardness.as_ref().map(Bounds::upper));
        let half = half.map(|(grid, half)| measured(&half, &grid, None).1);
        let off = |value: fn(&FilmRecord) -> f64| half.map(|half| (value(&half) - value(&film)).abs());
        let load = forces.oil_load + forces.solid_load;
        let record = LubricationRecord {
            sliding_speed,
            central_film: self.measure.central_film(&solution, &grid),
            film,
            mean_film_uncertainty: off(|film| film.mean_film),
            solid_share_uncertainty: off(|film| film.solid_share),
            traction_uncertainty: off(|film| film.traction_coefficient),
            rolling_friction: forces.over_load(forces.rolling),
            hamrock_dowson_film: self.measure.hamrock_dowson(speed, load),
        };
        Ok((self.contact(pair, solution), record))
    }

    /// Returns the contact of a film: the bodies bear oil and solids, and touch where the pressure is above that of
    /// the oil.
    fn contact(&self, pair: &Pair, solution: FilmSolution) -> LoadedContact {
        let FilmSolution { film, thickness, residual, iterations, convolutions, .. } = solution;
        let stats = Stats { iterations, convolutions: convolutions as f64, ..Stats::default() };
        let solution = Solution {
            grid: *self.operator.grid(),
            initial_gap: self.gap.clone(),
            bounds: Bounds::ELASTIC.above(film.oil_pressure.clone()),
            pressure: &film.oil_pressure + &film.solid_pressure,
            displacement: thickness - &self.gap + film.approach,
            approach: film.approach,
            residual,
            stats,
        };
        let contact = LoadedContact::at_once(pair, Equilibrium::Frictionless(Box::new(solution)));
        LoadedContact { film: Some(film), ..contact }
    }
}

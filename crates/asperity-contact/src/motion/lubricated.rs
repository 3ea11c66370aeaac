//! A pair of bodies with an oil between them, in a steady film.

use crate::error::Result;
use crate::grid::{Field, Grid, flat};
use crate::lubrication::{
    ContactZone, Film, FilmAtSpeed, FilmForces, FilmParams, FilmSolution, FilmSpeeds, Lubrication, Oil,
    SolvedFilm,
};
use crate::motion::pair::Pair;
use crate::motion::paraboloid::Paraboloid;
use crate::motion::record::LubricationRecord;
use crate::motion::state::LoadedContact;
use crate::operator::{Boundary, Operator, Operators};
use crate::solver::{Bounds, Control, Equilibrium, Solution, Stats};
use crate::units::{Metre, MetrePerSecond, Pascal};

/// The films of a pair under one load or at one approach.
pub(super) struct LubricatedBodies {
    operator: Box<dyn Operator>,
    boundary: Boundary,
    gap: Field,
    lubrication: Lubrication,
    films: FilmSpeeds,
    zone: ContactZone,
    /// Composite rms roughness.
    roughness: Option<Metre>,
    /// Curvatures of the gap along x and y, of a paraboloid with free boundaries.
    curvatures: Option<[f64; 2]>,
    modulus: Pascal,
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
        let grid = pair.lower_grid();
        let zone = ContactZone::new(&films.dry().solid_pressure, &grid, boundary);
        let paraboloid = Paraboloid::fit(gap, grid.pitch).filter(|_| boundary == Boundary::FREE);
        let curvatures = paraboloid.filter(|fit| !fit.is_endless()).map(|fit| {
            let [first, second] = fit.curvatures;
            let [cos2, sin2] = fit.direction.map(|component| component * component);
            [first * cos2 + second * sin2, first * sin2 + second * cos2]
        });
        let roughness = zone.roughness(gap, &grid);
        let (gap, modulus) = (gap.clone(), pair.modulus());
        Ok(Self { operator, boundary, gap, lubrication, films, zone, roughness, curvatures, modulus })
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
        let grid = *self.operator.grid();
        let [film, traction, solids] = self.measured(&solution, &grid, speed);
        let forces = self.forces(&solution, &grid, speed);
        let half = half.map(|(grid, half)| self.measured(&half, &grid, speed));
        let load = forces.oil_load + forces.solid_load;
        let pressure = &solution.film.oil_pressure + &solution.film.solid_pressure;
        let hardness = pair.bounds(&pair.at_rest());
        let share = |(cell, p): (usize, &f64)| p / hardness.upper().value(cell);
        let hardness_share =
            if pair.yields() { pressure.iter().enumerate().map(share).fold(0.0, f64::max) } else { 0.0 };
        let hamrock_dowson_film = self.hamrock_dowson(speed, load);
        let record = LubricationRecord {
            sliding_speed: self.lubrication.sliding_at(speed),
            central_film: mean(&solution.thickness, &self.zone.central().cells(&grid)),
            mean_film: film,
            mean_film_uncertainty: half.map(|half| (half[0] - film).abs()),
            min_film: solution.thickness.iter().copied().fold(f64::INFINITY, f64::min),
            lambda: self.roughness.map(|roughness| film / roughness),
            solid_share: solids,
            solid_share_uncertainty: half.map(|half| (half[2] - solids).abs()),
            traction_coefficient: traction,
            traction_uncertainty: half.map(|half| (half[1] - traction).abs()),
            rolling_friction: forces.rolling / load,
            cavity_share: share_of_cavity(&solution.film),
            max_oil_pressure: solution.film.oil_pressure.iter().copied().fold(0.0, f64::max),
            hardness_share,
            hamrock_dowson_film,
            inlet_ratio: hamrock_dowson_film.and_then(|film| self.inlet_ratio(film)),
        };
        Ok((self.contact(pair, solution, pressure), record))
    }

    /// Mean film, traction coefficient, and share of the solids.
    fn measured(&self, solution: &FilmSolution, grid: &Grid, speed: MetrePerSecond) -> [f64; 3] {
        let forces = self.forces(solution, grid, speed);
        let film = mean(&solution.thickness, &self.zone.cells(grid));
        [film, forces.friction_coefficient(self.lubrication.solid_friction), forces.solid_share()]
    }

    fn forces(&self, solution: &FilmSolution, grid: &Grid, speed: MetrePerSecond) -> FilmForces {
        let Lubrication { shear, .. } = self.lubrication;
        let sliding = self.lubrication.sliding_at(speed);
        FilmForces::new(&self.films.problem(speed), solution, grid, self.boundary, sliding, shear)
    }

    /// Returns the contact of a film: the bodies bear oil and solids, and touch where the pressure is above that of
    /// the oil.
    fn contact(&self, pair: &Pair, solution: FilmSolution, pressure: Field) -> LoadedContact {
        let FilmSolution { film, thickness, residual, iterations, convolutions, .. } = solution;
        let stats = Stats { iterations, convolutions: convolutions as f64, ..Stats::default() };
        let solution = Solution {
            grid: *self.operator.grid(),
            initial_gap: self.gap.clone(),
            bounds: Bounds::ELASTIC.above(film.oil_pressure.clone()),
            pressure,
            displacement: thickness - &self.gap + film.approach,
            approach: film.approach,
            residual,
            stats,
        };
        let contact = LoadedContact::at_once(pair, Equilibrium::Frictionless(Box::new(solution)));
        LoadedContact { film: Some(film), ..contact }
    }

    /// Central film by Hamrock and Dowson (J. Lubr. Technol. 99 (1977) 264), of a paraboloid in the regime of elastic
    /// bodies and rising viscosity.
    fn hamrock_dowson(&self, speed: MetrePerSecond, load: f64) -> Option<Metre> {
        let Oil { viscosity, pressure_viscosity, .. } = self.lubrication.oil;
        let [radius, across] = self.curvatures?.map(f64::recip);
        // Their modulus is that of a body like either of two equal ones, twice the composite one.
        let modulus = 2.0 * self.modulus;
        let u = viscosity * speed / (modulus * radius);
        let g = pressure_viscosity * modulus;
        let w = load / (modulus * radius * radius);
        let ellipticity = 1.03 * (across / radius).powf(0.64);
        let side = 1.0 - 0.61 * (-0.73 * ellipticity).exp();
        let film = 2.69 * u.powf(0.67) * g.powf(0.53) * w.powf(-0.067) * side * radius;
        (film > 0.0 && film.is_finite()).then_some(film)
    }

    /// Returns the distance of the inlet from the centre of the contact, over that of a fully flooded inlet of this
    /// film (Hamrock and Dowson, J. Lubr. Technol. 99 (1977) 15).
    fn inlet_ratio(&self, film: Metre) -> Option<f64> {
        let radius = self.curvatures?[0].recip();
        let half_width = Some(self.zone.half_widths[0]).filter(|width| width.is_finite())?;
        let flooded = half_width * (1.0 + 3.06 * (radius * film / (half_width * half_width)).powf(0.58));
        let ratio = self.zone.centre[0] / flooded;
        ratio.is_finite().then_some(ratio)
    }
}

/// Mean of a field over some cells.
pub(super) fn mean(field: &Field, cells: &[usize]) -> f64 {
    let values = flat(field);
    cells.iter().map(|cell| values[*cell]).sum::<f64>() / cells.len() as f64
}

/// Share of the grid in which a film is broken.
pub(super) fn share_of_cavity(film: &Film) -> f64 {
    film.cavity.iter().filter(|empty| **empty > 0.0).count() as f64 / film.cavity.len() as f64
}

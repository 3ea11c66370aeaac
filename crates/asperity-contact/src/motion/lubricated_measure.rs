//! A film of oil in numbers.

use crate::grid::{CellValues, Field, Grid, flat};
use crate::lubrication::{ContactZone, FilmForces, FilmProblem, FilmSolution, Lubrication, Oil};
use crate::motion::pair::Pair;
use crate::motion::paraboloid::Paraboloid;
use crate::motion::record::FilmRecord;
use crate::operator::Boundary;
use crate::units::{Metre, MetrePerSecond, Newton, Pascal};

/// Where the films of two bodies are measured, and against which lengths.
pub(super) struct FilmMeasure {
    lubrication: Lubrication,
    boundary: Boundary,
    zone: ContactZone,
    /// Composite rms roughness; `None` of smooth bodies.
    roughness: Option<Metre>,
    /// Curvatures of the gap along x and y, of a paraboloid with free boundaries.
    curvatures: Option<[f64; 2]>,
    modulus: Pascal,
}

impl FilmMeasure {
    /// Measures the films of a `pair` over the initial `gap`, whose dry contact has this pressure.
    pub(super) fn new(
        pair: &Pair,
        lubrication: Lubrication,
        gap: &Field,
        dry: &Field,
        (grid, boundary): (&Grid, Boundary),
    ) -> Self {
        let zone = ContactZone::new(dry, grid, boundary);
        let paraboloid = Paraboloid::fit(gap, grid.pitch).filter(|_| boundary == Boundary::FREE);
        let curvatures = paraboloid.filter(|fit| !fit.is_endless()).map(|fit| {
            let [first, second] = fit.curvatures;
            let [cos2, sin2] = fit.direction.map(|component| component * component);
            [first * cos2 + second * sin2, first * sin2 + second * cos2]
        });
        let (roughness, modulus) = (zone.roughness(gap, grid), pair.modulus());
        Self { lubrication, boundary, zone, roughness, curvatures, modulus }
    }

    /// Returns the forces of a film on this grid between surfaces whose speeds differ by `sliding`, and its record. The
    /// pressure is compared with the hardness.
    pub(super) fn record(
        &self,
        problem: &FilmProblem<'_>,
        solution: &FilmSolution,
        grid: &Grid,
        sliding: MetrePerSecond,
        hardness: Option<&CellValues>,
    ) -> (FilmForces, FilmRecord) {
        let shear = self.lubrication.shear;
        let forces = FilmForces::new(problem, solution, grid, self.boundary, sliding, shear);
        let (oil, solids) = (flat(&solution.film.oil_pressure), flat(&solution.film.solid_pressure));
        let borne = oil.iter().zip(solids).map(|(oil, solids)| oil + solids);
        let share = |hardness: &CellValues| {
            let shares = borne.enumerate().map(|(cell, borne)| borne / hardness.value(cell));
            shares.fold(0.0, f64::max)
        };
        let mean_film = mean(&solution.thickness, &self.zone.cells(grid));
        let cavity = &solution.film.cavity;
        let record = FilmRecord {
            mean_film,
            min_film: solution.thickness.iter().copied().fold(f64::INFINITY, f64::min),
            lambda: self.roughness.map(|roughness| mean_film / roughness),
            solid_share: forces.solid_share(),
            traction_coefficient: forces.friction_coefficient(self.lubrication.solid_friction_at(sliding)),
            cavity_share: cavity.iter().filter(|empty| **empty > 0.0).count() as f64 / cavity.len() as f64,
            max_oil_pressure: oil.iter().copied().fold(0.0, f64::max),
            hardness_share: hardness.map_or(0.0, share),
            inlet_ratio: self.inlet_ratio(problem.speed, forces.oil_load + forces.solid_load),
        };
        (forces, record)
    }

    /// Mean film over a tenth of the contact around its centre.
    pub(super) fn central_film(&self, solution: &FilmSolution, grid: &Grid) -> Metre {
        mean(&solution.thickness, &self.zone.central().cells(grid))
    }

    /// Central film by Hamrock and Dowson (J. Lubr. Technol. 99 (1977) 264), of a paraboloid in the regime of elastic
    /// bodies and rising viscosity.
    pub(super) fn hamrock_dowson(&self, speed: MetrePerSecond, load: Newton) -> Option<Metre> {
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

    /// Returns the distance of the inlet from the centre of the contact, over that of a fully flooded inlet (Hamrock
    /// and Dowson, J. Lubr. Technol. 99 (1977) 15).
    fn inlet_ratio(&self, speed: MetrePerSecond, load: Newton) -> Option<f64> {
        let film = self.hamrock_dowson(speed, load)?;
        let radius = self.curvatures?[0].recip();
        let half_width = Some(self.zone.half_widths[0]).filter(|width| width.is_finite())?;
        let flooded = half_width * (1.0 + 3.06 * (radius * film / (half_width * half_width)).powf(0.58));
        let ratio = self.zone.centre[0] / flooded;
        ratio.is_finite().then_some(ratio)
    }
}

/// Mean of a field over some cells.
fn mean(field: &Field, cells: &[usize]) -> f64 {
    let values = flat(field);
    cells.iter().map(|cell| values[*cell]).sum::<f64>() / cells.len() as f64
}

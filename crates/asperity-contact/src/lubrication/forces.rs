//! Forces of a film on the bodies.

use super::film::{FilmProblem, FilmSolution};
use crate::grid::{Grid, flat};
use crate::operator::Boundary;
use crate::units::{Newton, Pascal};

/// Shear stress of an oil.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Shear {
    /// τ = η Δu/h at any stress.
    #[default]
    Newtonian,
    /// At most this part Λ of the pressure (0.02 … 0.1 for oils).
    Limited(f64),
    /// Eyring: τ = τ₀ asinh(η Δu/(h τ₀)) with this stress τ₀.
    Eyring(Pascal),
}

impl Shear {
    /// Returns the stress of a film of this viscosity that is sheared at a rate Δu/h, 1/s, ≥ 0.
    #[inline]
    pub fn stress(self, viscosity: f64, rate: f64, pressure: Pascal) -> Pascal {
        let newtonian = viscosity * rate;
        match self {
            Self::Newtonian => newtonian,
            Self::Limited(share) => newtonian.min(share * pressure),
            Self::Eyring(stress) => stress * (newtonian / stress).asinh(),
        }
    }
}

/// Forces of a film along x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmForces {
    /// Normal force of the oil.
    pub oil_load: Newton,
    /// Normal force of the solids.
    pub solid_load: Newton,
    /// Shear of the oil between surfaces whose speeds differ, ≥ 0.
    pub oil_shear: Newton,
    /// Rolling friction: the oil that is carried against its pressure, Σ H Δp over the faces across x, with the
    /// film H that is carried through a face. Half of it brakes each body.
    pub rolling: Newton,
    /// The horizontal component of the pressure of the oil on the slopes of the film, which the two halves of the
    /// rolling friction balance if the pressures at the ends are 0.
    pub slopes: Newton,
}

impl FilmForces {
    /// Computes the forces of a solution between surfaces whose speeds differ by `sliding` ≥ 0, m/s.
    pub fn new(
        problem: &FilmProblem<'_>,
        solution: &FilmSolution,
        grid: &Grid,
        boundary: Boundary,
        sliding: f64,
        shear: Shear,
    ) -> Self {
        let [dx, dy] = grid.pitch;
        let ny = grid.shape[1];
        let film = &solution.film;
        let (p, h) = (flat(&film.oil_pressure), flat(&solution.thickness));
        let cavity = flat(&film.cavity);
        let stress = problem.shear_stress(solution, sliding, shear);
        let carried = problem.flow(*grid, boundary).entrained_films(p, cavity, h);
        let [inlet, outlet] = problem.ends;
        let behind = |face: usize| face.checked_sub(ny).map_or(inlet, |k| p[k]);
        let ahead = |face: usize| p.get(face).copied().unwrap_or(outlet);
        let rolling: f64 = carried.iter().enumerate().map(|(n, film)| film * (ahead(n) - behind(n))).sum();
        let slopes: f64 = p.iter().enumerate().map(|(k, p)| p * (carried[k] - carried[k + ny])).sum();
        Self {
            oil_load: dx * dy * film.oil_pressure.sum(),
            solid_load: dx * dy * film.solid_pressure.sum(),
            oil_shear: dx * dy * stress.iter().sum::<f64>(),
            rolling: dy * rolling,
            slopes: dy * slopes,
        }
    }

    /// Returns the share of the load that the solids bear; 0 without a load.
    pub fn solid_share(&self) -> f64 {
        self.over_load(self.solid_load)
    }

    /// Returns a force over the load; 0 without a load.
    pub fn over_load(&self, force: Newton) -> f64 {
        let load = self.oil_load + self.solid_load;
        if load > 0.0 { force / load } else { 0.0 }
    }

    /// Returns the friction coefficient of the contact whose solids have the coefficient `solids`: shear of the
    /// oil and friction of the solids over the load; 0 without a load.
    pub fn friction_coefficient(&self, solids: f64) -> f64 {
        self.over_load(self.oil_shear + solids * self.solid_load)
    }
}

impl FilmProblem<'_> {
    /// Returns the shear stress of the oil in each cell of a solution, ≥ 0, between surfaces whose speeds differ by
    /// `sliding` ≥ 0, m/s.
    pub(crate) fn shear_stress(&self, solution: &FilmSolution, sliding: f64, shear: Shear) -> Vec<Pascal> {
        let (p, h) = (flat(&solution.film.oil_pressure), flat(&solution.thickness));
        let cavity = flat(&solution.film.cavity);
        let stress = |k: usize| {
            let viscosity = self.oil.under(p[k]).viscosity;
            let thickness = h[k].max(self.boundary_film);
            (1.0 - cavity[k]) * shear.stress(viscosity, sliding / thickness, p[k])
        };
        (0..p.len()).map(stress).collect()
    }
}

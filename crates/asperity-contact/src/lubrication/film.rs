//! The film of an oil between two bodies.

use super::flow::{Flow, OilStep};
use super::near::Near;
use super::newton::{Newton, Reached};
use super::oil::Oil;
use super::state::{Scales, State};
use crate::error::{Error, Result, check, check_in};
use crate::grid::{Field, Grid, check_finite, in_rows};
use crate::operator::{Boundary, Operator};
use crate::solver::Control;
use crate::units::{Dimension, Metre, Pascal};

/// Names of the fields of a film.
const PARTS: [&str; 3] = ["oil_pressure", "solid_pressure", "cavity"];

/// Unit of film in the residuals, in boundary films.
const LENGTH: f64 = 50.0;

/// An oil between two bodies that press together and entrain it along +x.
///
/// Cells hold the pressure p of the oil, the pressure c of the solids, and the share θ of the film that is empty
/// (cavitation). The bodies bear both: the film is h = g − δ + C(p + c). Oil obeys Reynolds' equation
///
/// ```text
/// −∇·(m ∇p) + u_m ∂(ρh(1 − θ))/∂x + ∂(ρh(1 − θ))/∂t = 0      m = ρh³/12η
/// 0 ≤ p ⊥ θ ≥ 0        0 ≤ c ⊥ h − h_c ≥ 0
/// ```
///
/// in every cell. Where solids touch, the film is h_c, and its flow stays in the balance. Oil fills the inlet.
/// Across y the film ends at ambient pressure, or repeats if the operator does.
#[derive(Debug, Clone, Copy)]
pub struct FilmProblem<'a> {
    /// Undeformed gap g of the bodies.
    pub gap: &'a Field,
    /// The oil.
    pub oil: Oil,
    /// Mean speed u_m of both surfaces along x, m/s, ≥ 0.
    pub speed: f64,
    /// Film h_c > 0 that solids that touch keep between them: the size of a few molecules.
    pub boundary_film: Metre,
    /// Load or approach.
    pub control: Control,
    /// Pressures of the oil at the inlet and at the outlet, above ambient, ≥ 0.
    pub ends: [Pascal; 2],
    /// A step of time; none for a steady film.
    pub step: Option<OilStep<'a>>,
}

/// When the solution of a [`FilmProblem`] ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmParams {
    /// Largest residual of all: the balance of a cell relative to u_m · 50 h_c · pitch, the gap between solids
    /// that touch relative to 50 h_c, and the load relative to itself.
    pub tolerance: f64,
    /// Most steps of Newton's method.
    pub max_iterations: usize,
}

impl Default for FilmParams {
    fn default() -> Self {
        Self { tolerance: 1e-7, max_iterations: 60 }
    }
}

/// Pressures, cavity and approach of a film: a solution, or a guess of one.
#[derive(Debug, Clone, PartialEq)]
pub struct Film {
    /// Pressure p of the oil, ≥ 0.
    pub oil_pressure: Field,
    /// Pressure c of the solids, ≥ 0.
    pub solid_pressure: Field,
    /// Share θ of the film that is empty, 0 ≤ θ ≤ 1.
    pub cavity: Field,
    /// Approach δ of the bodies.
    pub approach: Metre,
}

/// The solution of a [`FilmProblem`].
#[derive(Debug, Clone)]
pub struct FilmSolution {
    /// Pressures, cavity and approach.
    pub film: Film,
    /// Film thickness h.
    pub thickness: Field,
    /// Oil in each cell, ρh(1 − θ)/ρ₀, m, from which a step of time goes on.
    pub oil: Vec<f64>,
    /// Largest residual.
    pub residual: f64,
    /// Steps of Newton's method.
    pub iterations: usize,
    /// Steps of the linear solvers.
    pub krylov: usize,
    /// Applications of the operator.
    pub convolutions: usize,
}

impl Film {
    /// Returns the dry contact of this pressure and approach, with oil at ambient pressure around.
    pub fn dry(solid_pressure: Field, approach: Metre) -> Self {
        let zeros = Field::zeros(solid_pressure.raw_dim());
        Self { oil_pressure: zeros.clone(), solid_pressure, cavity: zeros, approach }
    }

    /// The fields with their names and units.
    pub fn parts(&self) -> [(&'static str, &'static str, &Field); 3] {
        [
            (PARTS[0], "Pa", &self.oil_pressure),
            (PARTS[1], "Pa", &self.solid_pressure),
            (PARTS[2], "1", &self.cavity),
        ]
    }

    /// Creates a film from its fields by their names.
    ///
    /// # Errors
    /// The errors of `part`.
    pub(crate) fn from_parts<E>(
        part: impl Fn(&str) -> std::result::Result<Field, E>,
        approach: Metre,
    ) -> std::result::Result<Self, E> {
        let [oil_pressure, solid_pressure, cavity] = [part(PARTS[0])?, part(PARTS[1])?, part(PARTS[2])?];
        Ok(Self { oil_pressure, solid_pressure, cavity, approach })
    }

    fn state(&self) -> State {
        let values = |field: &Field| field.iter().copied().collect();
        State {
            oil: values(&self.oil_pressure),
            solids: values(&self.solid_pressure),
            cavity: values(&self.cavity),
            approach: self.approach,
        }
    }
}

impl FilmProblem<'_> {
    fn check(&self, operator: &dyn Operator) -> Result<()> {
        self.oil.check()?;
        check("speed", self.speed, self.speed >= 0.0 && self.speed.is_finite(), "at least 0 m/s")?;
        let good = self.boundary_film > 0.0 && self.boundary_film.is_finite();
        check_in(Dimension::Length, "boundary_film", self.boundary_film, good, "above 0")?;
        if let Control::Load(load) = self.control {
            check_in(Dimension::Force, "load", load, load > 0.0 && load.is_finite(), "above 0")?;
        }
        for end in self.ends {
            let good = end >= 0.0 && end.is_finite();
            check_in(Dimension::Pressure, "pressure at an end", end, good, "at least 0")?;
        }
        if let Some(step) = self.step {
            check_in(Dimension::Time, "duration", step.duration, step.duration > 0.0, "above 0")?;
            assert_eq!(step.before.len(), self.gap.len(), "oil before the step in each cell");
        }
        assert_eq!(self.gap.shape(), operator.grid().shape, "a gap on the grid of the operator");
        check_finite("gap", self.gap.shape(), self.gap)?;
        if operator.boundary().repeats(0) {
            return Err(Error::Unsupported("a film that repeats along x, the direction of the flow"));
        }
        Ok(())
    }
}

/// Solves for the film between two bodies, from a `start` that the answer does not depend on. Under a load it needs
/// some pressure: without any, the flow does not depend on the approach.
///
/// # Errors
/// [`Error::OutOfRange`] for numbers without a meaning; [`Error::FilmNotConverged`] if the residual stays above the
/// tolerance. A step of time should then be halved, and a speed approached from its neighbours.
///
/// # Panics
/// If a field has another shape than the operator's grid.
pub fn solve_film(
    operator: &mut dyn Operator,
    problem: &FilmProblem<'_>,
    start: &Film,
    params: &FilmParams,
) -> Result<FilmSolution> {
    problem.check(operator)?;
    let shape = operator.grid().shape;
    let flow = problem.flow(*operator.grid(), operator.boundary());
    let mut newton = problem.newton(operator, &flow, start);
    let reached = newton.solve(problem.state(start), params.tolerance, params.max_iterations);
    let Reached { state, h, residual, iterations } = reached;
    if residual.is_nan() || residual > params.tolerance {
        return Err(Error::FilmNotConverged { iterations, residual, tolerance: params.tolerance });
    }
    let (krylov, convolutions) = (newton.krylov, newton.convolutions);
    let oil = flow.stored(&state.oil, &state.cavity, &h);
    let field = |values| Field::from_shape_vec(shape, values).expect("a value for each cell");
    Ok(FilmSolution {
        film: Film {
            oil_pressure: field(state.oil),
            solid_pressure: field(state.solids),
            cavity: field(state.cavity),
            approach: state.approach,
        },
        thickness: field(h),
        oil,
        residual,
        iterations,
        krylov,
        convolutions,
    })
}

impl<'a> FilmProblem<'a> {
    /// Returns the flow of the oil on a grid with this boundary.
    pub(super) fn flow(&self, grid: Grid, boundary: Boundary) -> Flow<'a> {
        Flow {
            grid,
            repeats: boundary.repeats(1),
            oil: self.oil,
            speed: self.speed,
            boundary_film: self.boundary_film,
            ends: self.ends,
            step: self.step,
        }
    }

    /// Returns the oil in each cell of a film, ρh(1 − θ)/ρ₀.
    pub(super) fn oil_in(&self, operator: &mut dyn Operator, film: &Film) -> Vec<f64> {
        let flow = self.flow(*operator.grid(), operator.boundary());
        let state = self.state(film);
        let h = self.newton(operator, &flow, film).film(&state);
        flow.stored(&state.oil, &state.cavity, &h)
    }

    /// Returns the norm of all residuals of a film.
    ///
    /// # Errors
    /// As [`solve_film`] for numbers without a meaning.
    pub(super) fn norm(&self, operator: &mut dyn Operator, film: &Film) -> Result<f64> {
        self.check(operator)?;
        let flow = self.flow(*operator.grid(), operator.boundary());
        Ok(self.newton(operator, &flow, film).norm(self.state(film)))
    }

    fn state(&self, film: &Film) -> State {
        for field in [&film.oil_pressure, &film.solid_pressure, &film.cavity] {
            assert_eq!(field.dim(), self.gap.dim(), "a start on the grid of the gap");
        }
        let mut state = film.state();
        if let Control::Approach(approach) = self.control {
            state.approach = approach;
        }
        state
    }

    fn newton<'n>(&'n self, operator: &'n mut dyn Operator, flow: &'n Flow<'n>, start: &Film) -> Newton<'n>
    where
        'a: 'n,
    {
        let near = Near::new(operator);
        Newton {
            operator,
            flow,
            gap: in_rows(self.gap),
            control: self.control,
            scales: self.scales(start, flow),
            near,
            convolutions: 0,
            krylov: 0,
        }
    }

    fn scales(&self, start: &Film, flow: &Flow<'_>) -> Scales {
        let ([dx, dy], [along, _]) = (flow.grid.pitch, flow.grid.extent());
        let cells = self.gap.len() as f64;
        let length = LENGTH * self.boundary_film;
        let most_end = self.ends[0].max(self.ends[1]);
        let by_gradient = length.powi(3) * most_end / (12.0 * self.oil.viscosity * along);
        let by_time = self.step.map_or(0.0, |step| length * dx / step.duration);
        let per_width = (self.speed * length).max(by_gradient).max(by_time).max(f64::MIN_POSITIVE);
        let pressure = match self.control {
            Control::Load(load) => load / (cells * dx * dy),
            Control::Approach(approach) => {
                // The pressure that drives the oil through a uniform film.
                let mean = self.gap.sum() / cells - approach;
                let film = mean.max(self.boundary_film);
                let squeezed = self.step.map_or(0.0, |step| {
                    let before = step.before.iter().sum::<f64>() / cells;
                    (before - film).abs() * along / step.duration
                });
                let hydrodynamic =
                    12.0 * self.oil.viscosity * along * (self.speed * film + squeezed) / film.powi(3);
                let mean = (start.oil_pressure.sum() + start.solid_pressure.sum()) / cells;
                hydrodynamic.max(mean).max(most_end).max(f64::MIN_POSITIVE)
            }
        };
        Scales::new(pressure, length, per_width * dy)
    }
}

//! The contact problem: pressures 0 ≤ p ≤ H that close the gap, under a load or at an approach.

mod active_set;
mod bounds;
mod cascade;
mod coarse_correction;
mod direct;
mod friction;
mod polonsky_keer;
mod preconditioner;
mod residual;
mod sets;
mod site;
mod sparse_inverse;
mod stiffness;
mod together;

pub(crate) use friction::solve_sliding;
pub use friction::{
    Coupling, Creep, Friction, FrictionalSolution, Loading, Rolling, Sliding, Tangential, solve_frictional,
    solve_rolling,
};
pub use residual::{Residual, residual};
pub(crate) use site::{Kept, Site, coarse_gap};
pub use stiffness::normal_stiffness;
pub(crate) use together::solve_together;

use std::borrow::Cow;
use std::f64::consts::TAU;

use crate::error::{Error, Result, check, check_in};
use crate::grid::Field;
use crate::operator::Operator;
use crate::units::{CubicMetre, Dimension, Joule, Metre, Newton, Pascal, SquareMetre};

/// What is prescribed in the normal direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Control {
    /// The total normal force W, > 0.
    Load(Newton),
    /// The rigid-body approach δ.
    Approach(Metre),
}

impl Control {
    /// The approach, where it is prescribed.
    fn approach(self) -> Option<Metre> {
        match self {
            Self::Approach(approach) => Some(approach),
            Self::Load(_) => None,
        }
    }
}

/// How the problem is solved. All methods solve the same problem to the same residual.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// The direct method on small grids, the active set elsewhere.
    #[default]
    Auto,
    /// Dense quadratic programming by block principal pivoting: exact to round-off; cost grows with the cube of
    /// the number of cells in contact.
    Direct,
    /// The constrained conjugate gradient method of Polonsky and Keer, Wear 231, 206 (1999), as printed.
    PolonskyKeer,
    /// Preconditioned conjugate gradients on a predicted active set, from a cascade of coarse grids.
    ActiveSet,
}

/// How accurately, and by what method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// The method.
    pub method: Method,
    /// Scale-free complementarity residual η at which the answer is accepted, > 0; see [`residual`].
    pub tolerance: f64,
    /// Operator calls after which the iteration is given up.
    pub max_convolutions: usize,
}

impl Default for Params {
    fn default() -> Self {
        Self { method: Method::Auto, tolerance: 1e-6, max_convolutions: 10_000 }
    }
}

/// What an answer cost.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stats {
    /// Iterations: conjugate gradient steps, or factorisations of the direct method.
    pub iterations: usize,
    /// Operator calls, those on coarser grids counted by their share of cells.
    pub convolutions: f64,
    /// Returns to the last feasible pressure, for lack of progress.
    pub restarts: usize,
}

impl Stats {
    /// Of both.
    pub(crate) fn and(&self, other: &Self) -> Self {
        Self {
            iterations: self.iterations + other.iterations,
            convolutions: self.convolutions + other.convolutions,
            restarts: self.restarts + other.restarts,
        }
    }
}

/// A contact in equilibrium.
#[derive(Debug, Clone)]
pub struct Solution {
    /// Pressure p, Pa; exactly 0 outside the contact, exactly the hardness at capped cells.
    pub pressure: Field,
    /// Composite displacement u = C p, m; to a tenth of the tolerance, as a share of std(u).
    pub displacement: Field,
    /// Rigid-body approach δ.
    pub approach: Metre,
    /// Scale-free complementarity residual η of this very pressure, with what rounding may have left in the displacement.
    pub residual: f64,
    /// What it cost.
    pub stats: Stats,
}

impl Solution {
    /// Load W = ΔA Σ p.
    pub fn load(&self, cell_area: SquareMetre) -> Newton {
        cell_area * self.pressure.sum()
    }

    /// Number of cells in contact, p > 0.
    pub fn contact_cells(&self) -> usize {
        self.pressure.iter().filter(|p| **p > 0.0).count()
    }

    /// Number of cells at the `hardness`.
    pub fn plastic_cells(&self, hardness: Pascal) -> usize {
        self.pressure.iter().filter(|p| **p >= hardness).count()
    }

    /// Largest pressure.
    pub fn max_pressure(&self) -> Pascal {
        self.pressure.iter().copied().fold(0.0, f64::max)
    }

    /// Deformed gap g = h + u − δ. It is negative where interference is left at capped cells.
    pub fn gap(&self, initial_gap: &Field) -> Field {
        initial_gap + &self.displacement - self.approach
    }

    /// Plastic interference w = δ − h − u ≥ 0 at the cells at the `hardness`, 0 elsewhere.
    pub fn plastic_interference(&self, initial_gap: &Field, hardness: Pascal) -> Field {
        let mut interference = -self.gap(initial_gap);
        interference.zip_mut_with(&self.pressure, |w, p| *w = if *p >= hardness { w.max(0.0) } else { 0.0 });
        interference
    }

    /// ΔA Σ w of the [`Solution::plastic_interference`].
    pub fn plastic_volume(
        &self,
        initial_gap: &Field,
        hardness: Pascal,
        cell_area: SquareMetre,
    ) -> CubicMetre {
        cell_area * self.plastic_interference(initial_gap, hardness).sum()
    }

    /// Elastic energy ½ ΔA Σ p u (periodic: without that of the mean displacement, which is free).
    pub fn elastic_energy(&self, cell_area: SquareMetre) -> Joule {
        0.5 * cell_area * (&self.pressure * &self.displacement).sum()
    }
}

/// A box-constrained contact problem, as every method sees it.
#[derive(Clone, Copy)]
struct Problem<'a> {
    initial_gap: &'a Field,
    terms: Terms,
}

/// What is asked of a contact, or of several together.
#[derive(Clone, Copy)]
struct Terms {
    hardness: Pascal,
    control: Control,
    /// Displacement of a cell per unit pressure on itself.
    self_influence: f64,
    cell_area: SquareMetre,
}

impl Terms {
    /// Σ p under load control.
    fn pressure_sum(&self) -> Option<f64> {
        match self.control {
            Control::Load(load) => Some(load / self.cell_area),
            Control::Approach(_) => None,
        }
    }

    /// The residual does not see the load.
    fn check_load(&self, solution: &Solution) -> Result<()> {
        let Some(wanted) = self.pressure_sum() else { return Ok(()) };
        let error = (solution.pressure.sum() / wanted - 1.0).abs();
        if error <= LOAD_TOLERANCE {
            return Ok(());
        }
        let borne = self.cell_area * solution.pressure.sum();
        check_in(
            Dimension::Force,
            "load borne",
            borne,
            false,
            "the load prescribed, to 10 digits in double precision",
        )
    }
}

/// Solves the frictionless contact of a half-space pair: 0 ≤ p ≤ H,
///
/// ```text
/// p = 0 ⇒ g ≥ 0;   0 < p < H ⇒ g = 0;   p = H ⇒ g ≤ 0;   g = h + C p − δ
/// ```
///
/// which minimises ½ pᵀCp − pᵀ(δ − h) over the box. `initial_gap` is h, `hardness` H (infinite: elastic), `start` a
/// pressure near the answer, if one is known.
///
/// # Errors
/// [`Error::OutOfRange`] for input without meaning, [`Error::BeyondPlasticLimit`] for more load than H bears,
/// [`Error::PeriodicFullContact`], [`Error::NotConverged`].
///
/// # Panics
/// If a field has another shape than the operator's grid.
pub fn solve_normal(
    operator: &mut dyn Operator,
    initial_gap: &Field,
    hardness: Pascal,
    control: Control,
    start: Option<&Field>,
    params: &Params,
) -> Result<Solution> {
    let grid = *operator.grid();
    let shape = (grid.shape[0], grid.shape[1]);
    assert_eq!(initial_gap.dim(), shape, "shape of the initial gap");
    assert!(start.is_none_or(|p| p.dim() == shape), "shape of the start");
    validate(operator, initial_gap, hardness, control, params)?;
    let self_influence = self_influence(operator);
    let terms = Terms { hardness, control, self_influence, cell_area: grid.cell_area() };
    let solution = match far_datum(initial_gap, &terms) {
        None => solve_as_given(operator, initial_gap, terms, start, params)?,
        Some(datum) => {
            let near = initial_gap.mapv(|h| h - datum);
            let nearer = match control {
                Control::Approach(approach) => Control::Approach(approach - datum),
                load => load,
            };
            let terms = Terms { control: nearer, ..terms };
            let solution = solve_as_given(operator, &near, terms, start, params)?;
            Solution { approach: control.approach().unwrap_or(solution.approach + datum), ..solution }
        }
    };
    finite("load", solution.load(grid.cell_area()))?;
    finite("approach", solution.approach)?;
    finite("elastic energy", solution.elastic_energy(grid.cell_area()))?;
    Ok(solution)
}

/// Solves by the method of the `params`, with the heights as they are given.
fn solve_as_given(
    operator: &mut dyn Operator,
    initial_gap: &Field,
    terms: Terms,
    start: Option<&Field>,
    params: &Params,
) -> Result<Solution> {
    let problem = Problem { initial_gap, terms };
    if let Some(solution) = no_contact(&problem) {
        return Ok(solution);
    }
    let solution = match params.method {
        Method::Direct => direct::solve(operator, &problem, start, params),
        Method::Auto if initial_gap.len() <= DIRECT_CELLS => direct::solve(operator, &problem, start, params),
        Method::PolonskyKeer => polonsky_keer::solve(operator, &problem, start, params),
        Method::Auto | Method::ActiveSet => {
            let site = Kept::new(operator, Cow::Borrowed(initial_gap));
            let start = start.map(|pressure| vec![pressure.clone()]);
            let found =
                cascade::solve(&[&site], &terms, start, &|_| params.tolerance, params.max_convolutions)?;
            let (pressure, displacement) = found.fields.into_iter().next().expect("one contact");
            let Residual { eta, approach, .. } = found.residual;
            Ok(Solution { pressure, displacement, approach, residual: eta, stats: found.stats })
        }
    }?;
    terms.check_load(&solution)?;
    Ok(solution)
}

/// Displacement of a cell per unit pressure on itself. A single periodic cell has none, its mean being free; that of
/// a wave as long serves, as a measure.
fn self_influence(operator: &dyn Operator) -> f64 {
    match operator.influence(0, 0) {
        c0 if c0 > 0.0 => c0,
        _ => operator.harmonic_displacement(TAU / operator.grid().pitch[0], 0.0),
    }
}

/// The lowest height, where the heights are so far from zero against what they differ by, or against what they are pressed
/// together, that h + u keeps too few digits of u: they are then taken from there, which costs them none.
fn far_datum(initial_gap: &Field, terms: &Terms) -> Option<Metre> {
    let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
    for h in initial_gap {
        (lowest, highest) = (lowest.min(*h), highest.max(*h));
    }
    let depth = match terms.control {
        Control::Approach(approach) => (approach - lowest).max(0.0),
        // No deeper than one cell under all of the load.
        Control::Load(load) => terms.self_influence * (load / terms.cell_area).min(terms.hardness),
    };
    let far = lowest.abs() > FAR * depth.min(highest - lowest);
    far.then_some(lowest)
}

/// Heights are far from zero at so many times what they differ by, or are pressed together.
const FAR: f64 = 1e3;

/// What comes of numbers near the ends of their range is an error.
fn finite(quantity: &'static str, value: f64) -> Result<()> {
    check(
        quantity,
        value,
        value.is_finite(),
        "a number in double precision: check the units of moduli, heights and load",
    )
}

/// Relative error of the load at which an answer is accepted.
const LOAD_TOLERANCE: f64 = 1e-10;

/// Grids of up to so many cells are solved directly by [`Method::Auto`].
const DIRECT_CELLS: usize = 400;

fn validate(
    operator: &dyn Operator,
    initial_gap: &Field,
    hardness: Pascal,
    control: Control,
    params: &Params,
) -> Result<()> {
    check_in(Dimension::Pressure, "hardness", hardness, hardness > 0.0, "a hardness above 0")?;
    check("tolerance", params.tolerance, params.tolerance > 0.0, "a residual above 0")?;
    if let Some(&value) = initial_gap.iter().find(|h| !h.is_finite()) {
        check_in(
            Dimension::Length,
            "initial gap",
            value,
            false,
            "finite heights at every cell: fill missing data first",
        )?;
    }
    match control {
        Control::Load(load) => {
            check_in(
                Dimension::Force,
                "load",
                load,
                load > 0.0 && load.is_finite(),
                "a finite load above 0",
            )?;
            let limit = hardness * operator.grid().area();
            if load >= limit { Err(Error::BeyondPlasticLimit { load, limit }) } else { Ok(()) }
        }
        Control::Approach(approach) => {
            check_in(Dimension::Length, "approach", approach, approach.is_finite(), "a finite approach")?;
            let mean_gap = initial_gap.mean().unwrap_or(0.0);
            if operator.boundary().leaves_mean_free() && hardness.is_infinite() && approach >= mean_gap {
                return Err(Error::PeriodicFullContact { approach, mean_gap });
            }
            Ok(())
        }
    }
}

/// The answer where the bodies do not reach each other.
fn no_contact(problem: &Problem) -> Option<Solution> {
    let Control::Approach(approach) = problem.terms.control else { return None };
    problem.initial_gap.iter().all(|h| *h >= approach).then(|| Solution {
        pressure: Field::zeros(problem.initial_gap.raw_dim()),
        displacement: Field::zeros(problem.initial_gap.raw_dim()),
        approach,
        residual: 0.0,
        stats: Stats::default(),
    })
}

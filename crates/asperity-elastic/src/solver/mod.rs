//! The contact problem: pressures within their bounds that close the gap, under a load or at an approach.

mod active_set;
pub mod adhesion;
mod bounds;
mod cascade;
mod coarse_correction;
mod contact;
mod device;
mod direct;
mod feasible;
mod friction;
mod interface;
#[cfg(test)]
mod near_copies;
mod polonsky_keer;
mod preconditioner;
mod residual;
mod sets;
mod site;
mod stiffness;
mod tangential_stiffness;
mod together;
mod uniform;

use active_set::NearCopies;
pub use adhesion::solve_adhesive;
pub use adhesion::{AdhesionPassRecord as InterfacePassRecord, AdhesionRecord as InterfaceRecord};
pub use asperity_base::watch::Watch;
pub use bounds::Bounds;
pub use contact::{
    ContactProblem, ContactSolver, Equilibrium, Frictionless, GrossSliding, Guess, SteadyRolling, StickSlip,
};
pub use device::{Card, Device, memory_on_device};
pub use friction::{
    Coupling, Creep, Friction, FrictionalSolution, Loading, Rolling, RollingSolution, Sliding, Tangential,
    solve_frictional, solve_rolling,
};
pub use interface::{Before, HardWall, Interface, InterfaceCost, NormalProblem};
pub use residual::{Residual, residual};
pub use site::{OwnedSite, Site, coarse_site};
pub use stiffness::normal_stiffness;
pub use tangential_stiffness::tangential_stiffness;
pub use together::{JointSolution, solve_batch, solve_together};
pub use uniform::{UniformDisplacement, displace_uniformly};

use std::borrow::Cow;
use std::f64::consts::TAU;
use std::ops::Range;

use ndarray::Array2;

use crate::error::{Error, Result, check, check_in};
use crate::grid::{CellValues, Field, Grid, flat, in_rows};
use crate::math::parallel;
use crate::math::sum::sums;
use crate::operator::Operator;
use crate::ranks::{Largest, Merged, Slab};
use crate::units::{CubicMetre, Dimension, Joule, Metre, Newton, Pascal, SquareMetre};
use asperity_base::choice::choice;

/// Prescribed load or approach of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Control {
    /// The total normal force W, > 0.
    Load(Newton),
    /// The rigid-body approach δ.
    Approach(Metre),
}

impl Control {
    /// Returns the prescribed approach; none under load control.
    fn approach(self) -> Option<Metre> {
        match self {
            Self::Approach(approach) => Some(approach),
            Self::Load(_) => None,
        }
    }
}

/// Method of solving a contact problem. All methods solve the same problem to the same residual.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// The direct method on small grids, the active set on larger ones.
    #[default]
    Auto,
    /// Dense quadratic programming by block principal pivoting. It is exact to round-off, and its cost grows
    /// with the cube of the number of cells in contact.
    Direct,
    /// The constrained conjugate gradient method of Polonsky and Keer, Wear 231, 206 (1999), as printed.
    PolonskyKeer,
    /// Preconditioned conjugate gradients on a predicted active set, from a cascade of coarse grids.
    ActiveSet,
}

choice!(Method: "auto" => Auto, "direct" => Direct, "polonsky-keer" => PolonskyKeer, "active-set" => ActiveSet);

/// Parameters of a solution: the method and its accuracy.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Params {
    /// The method of solution.
    pub method: Method,
    /// Scale-free complementarity residual η at which the solution is accepted, > 0; see [`residual`].
    pub tolerance: f64,
    /// Largest number of operator calls.
    pub max_convolutions: usize,
    /// The device that solves the contact.
    pub device: Device,
}

impl Params {
    /// Creates the default parameters: the automatic method, a residual of 10⁻⁶, at most 10 000 operator
    /// calls, and the processor.
    pub const fn new() -> Self {
        Self { method: Method::Auto, tolerance: 1e-6, max_convolutions: 10_000, device: Device::Cpu }
    }

    /// Sets the method.
    #[must_use]
    pub const fn with_method(self, method: Method) -> Self {
        Self { method, ..self }
    }

    /// Sets the residual at which the solution is accepted.
    #[must_use]
    pub const fn with_tolerance(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// Sets the largest number of operator calls.
    #[must_use]
    pub const fn with_max_convolutions(self, max_convolutions: usize) -> Self {
        Self { max_convolutions, ..self }
    }

    /// Sets what solves the contact.
    #[must_use]
    pub const fn with_device(self, device: Device) -> Self {
        Self { device, ..self }
    }
}

impl Default for Params {
    fn default() -> Self {
        Self::new()
    }
}

/// The cost of a solution.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stats {
    /// Iterations: conjugate gradient steps, or factorisations of the direct method.
    pub iterations: usize,
    /// Operator calls; a call on a coarser grid counts by its fraction of cells.
    pub convolutions: f64,
    /// Applications of the near copy of the operator, see [`Operator::apply_near`]; those on a coarser grid
    /// count by its fraction of cells. They are not counted as convolutions.
    pub near_applications: f64,
    /// Number of returns to the last feasible pressure for lack of progress.
    pub restarts: usize,
}

impl Stats {
    /// Adds the costs of two solutions.
    pub fn and(&self, other: &Self) -> Self {
        Self {
            iterations: self.iterations + other.iterations,
            convolutions: self.convolutions + other.convolutions,
            near_applications: self.near_applications + other.near_applications,
            restarts: self.restarts + other.restarts,
        }
    }
}

/// A contact in equilibrium, with the problem that it solves.
#[derive(Debug, Clone)]
pub struct Solution {
    /// Grid of the contact.
    pub grid: Grid,
    /// Undeformed gap h, m.
    pub initial_gap: Field,
    /// Bounds of the pressure.
    pub bounds: Bounds,
    /// Pressure p, Pa. It equals the bound exactly for cells at a bound: it is exactly 0 outside the contact
    /// without attraction.
    pub pressure: Field,
    /// Composite displacement u = C p, m; its error is at most a tenth of the tolerance times std(u).
    pub displacement: Field,
    /// Rigid-body approach δ, m.
    pub approach: Metre,
    /// Scale-free complementarity residual η of this pressure, including the rounding of the displacement.
    pub residual: f64,
    /// Cost of the solution.
    pub stats: Stats,
}

impl Solution {
    /// Returns the load W = ΔA Σ p.
    pub fn load(&self) -> Newton {
        self.grid.cell_area() * self.pressure.sum()
    }

    /// Counts the cells in contact: above their lower bound, that is with p > 0 without attraction.
    pub fn contact_cells(&self) -> usize {
        self.count(|cell, p| self.bounds.touches(cell, p))
    }

    /// Counts the capped cells: at their upper bound, which is the hardness, or less under shear.
    pub fn capped_cells(&self) -> usize {
        self.count(|cell, p| self.bounds.caps(cell, p))
    }

    /// Returns the cells strictly between their bounds, whose gap is closed elastically.
    pub fn elastic_cells(&self) -> Array2<bool> {
        let mut cells = self.pressure.iter().enumerate();
        Array2::from_shape_simple_fn(self.pressure.raw_dim(), || {
            cells.next().is_some_and(|(cell, p)| self.bounds.interval(cell).is_free(*p))
        })
    }

    /// Returns 1 for each cell in contact, above its lower bound, and 0 for the others.
    pub fn contact_field(&self) -> Field {
        let mut contact = self.pressure.clone();
        let cells = contact.iter_mut().enumerate();
        cells.for_each(|(cell, p)| *p = f64::from(u8::from(self.bounds.touches(cell, *p))));
        contact
    }

    fn count(&self, is: impl Fn(usize, Pascal) -> bool + Sync) -> usize {
        let pressure = flat(&self.pressure);
        let [count] = self.merged(|cells| [cells.filter(|cell| is(*cell, pressure[*cell])).count() as f64]);
        count as usize
    }

    /// Merges the results of a function of some consecutive cells.
    fn merged<M: Merged + Send>(&self, of: impl Fn(Range<usize>) -> M + Sync) -> M {
        let [rows, columns] = [self.pressure.nrows(), self.pressure.ncols()];
        parallel::merged([rows, columns], |rows| of(rows.start * columns..rows.end * columns))
    }

    /// Returns the largest pressure, at least 0.
    pub fn max_pressure(&self) -> Pascal {
        let pressure = flat(&self.pressure);
        let Largest(most) = self.merged(|cells| Largest(pressure[cells].iter().copied().fold(0.0, f64::max)));
        most
    }

    /// Returns the largest displacement of a cell, at least 0.
    pub fn max_displacement(&self) -> Metre {
        let displacement = flat(&self.displacement);
        let of = |cells: Range<usize>| displacement[cells].iter().copied().fold(0.0, f64::max);
        let Largest(most) = self.merged(|cells| Largest(of(cells)));
        most
    }

    /// Returns the largest plastic interference of a cell, 0 if none is capped.
    pub fn max_interference(&self) -> Metre {
        let [h, u, p] = [&self.initial_gap, &self.displacement, &self.pressure].map(flat);
        let capped = |cell: &usize| self.bounds.caps(*cell, p[*cell]);
        let interference = |cell: usize| self.approach - h[cell] - u[cell];
        let of = |cells: Range<usize>| cells.filter(capped).map(interference).fold(0.0, f64::max);
        let Largest(most) = self.merged(|cells| Largest(of(cells)));
        most
    }

    /// Returns the deformed gap g = h + u − δ, m. It is negative at capped cells with interference.
    pub fn gap(&self) -> Field {
        &self.initial_gap + &self.displacement - self.approach
    }

    /// Returns the mean of the [`Solution::gap`], m.
    pub fn mean_gap(&self) -> Metre {
        self.mean_gap_over(&self.initial_gap)
    }

    /// Returns the mean of h + u − δ over another initial gap h, m.
    pub fn mean_gap_over(&self, initial_gap: &Field) -> Metre {
        let [gap, displacement] = [initial_gap, &self.displacement].map(flat);
        let [sum] = self.merged(|cells| {
            let displacement = &displacement[cells.clone()];
            sums(&gap[cells], |cell, h| [h + displacement[cell] - self.approach])
        });
        sum / self.pressure.len() as f64
    }

    /// Returns the plastic interference w = δ − h − u ≥ 0 at the capped cells, m; 0 elsewhere.
    pub fn plastic_interference(&self) -> Field {
        if self.capped_cells() == 0 {
            return Field::zeros(self.grid.shape);
        }
        let mut interference = self.gap();
        let cells = interference.iter_mut().zip(&self.pressure).enumerate();
        cells.for_each(|(cell, (w, p))| *w = if self.bounds.caps(cell, *p) { (-*w).max(0.0) } else { 0.0 });
        interference
    }

    /// Returns the volume ΔA Σ w of the [`Solution::plastic_interference`].
    pub fn plastic_volume(&self) -> CubicMetre {
        let [pressure, gap, displacement] = [&self.pressure, &self.initial_gap, &self.displacement].map(flat);
        let [sum] = self.merged(|cells| {
            let capped = cells.filter(|cell| self.bounds.caps(*cell, pressure[*cell]));
            [capped.map(|cell| (self.approach - gap[cell] - displacement[cell]).max(0.0)).sum()]
        });
        self.grid.cell_area() * sum
    }

    /// Returns the elastic energy ½ ΔA Σ p u. Under a periodic boundary it excludes the mean displacement,
    /// which is free.
    pub fn elastic_energy(&self) -> Joule {
        let [pressure, displacement] = [&self.pressure, &self.displacement].map(flat);
        let [work] = self.merged(|cells| {
            let displacement = &displacement[cells.clone()];
            sums(&pressure[cells], |cell, p| [p * displacement[cell]])
        });
        0.5 * self.grid.cell_area() * work
    }
}

/// A box-constrained contact problem, the input of every method.
#[derive(Clone, Copy)]
struct Problem<'a> {
    /// The undeformed gap h.
    initial_gap: &'a Field,
    /// The bounds of the pressure.
    bounds: &'a Bounds,
    /// Control and constants.
    settings: Settings<'a>,
    /// The rows of the grid that this rank holds.
    slab: &'a Slab,
}

/// Solution of a [`Problem`] by a method.
struct Answer {
    pressure: Field,
    displacement: Field,
    approach: Metre,
    residual: f64,
    stats: Stats,
}

/// Control of a contact, or of several contacts together, with constants for the methods and the watch.
#[derive(Clone, Copy)]
struct Settings<'a> {
    control: Control,
    /// Displacement of a cell per unit pressure on itself.
    self_influence: f64,
    cell_area: SquareMetre,
    /// The sum Σ |p| of all cells with negative lower bounds, at these bounds.
    attraction: Pascal,
    watch: &'a dyn Watch,
    /// Contacts that are solved with near copies of their operators.
    near_copies: NearCopies,
}

impl Settings<'_> {
    /// Returns the pressure sum Σ p under load control.
    fn pressure_sum(&self) -> Option<f64> {
        match self.control {
            Control::Load(load) => Some(load / self.cell_area),
            Control::Approach(_) => None,
        }
    }

    /// Returns an error if a pressure misses the load, which the residual does not measure.
    fn check_load(&self, answer: &Answer, slab: &Slab) -> Result<()> {
        let Some(wanted) = self.pressure_sum() else { return Ok(()) };
        let [sum] = slab.merged([answer.pressure.sum()]);
        if (sum - wanted).abs() <= LOAD_TOLERANCE * self.sum_scale(wanted) {
            return Ok(());
        }
        check_in(
            Dimension::Force,
            "load borne",
            self.cell_area * sum,
            false,
            "the load prescribed, to 10 digits in double precision",
        )
    }
}

/// Returns the sum Σ |p| of `cells` cells at their lower bounds, where these are below 0.
fn attraction(bounds: &Bounds, cells: usize) -> Pascal {
    bounds.lower().map(|lower| (-lower).max(0.0)).sum(cells)
}

/// Solves the frictionless contact of a pair of bodies: lower ≤ p ≤ upper in each cell,
///
/// ```text
/// p = lower ⇒ g ≥ 0;   lower < p < upper ⇒ g = 0;   p = upper ⇒ g ≤ 0;   g = h + C p − δ
/// ```
///
/// The solution minimises ½ pᵀCp − pᵀ(δ − h) over the box of the `bounds`. `initial_gap` is h. `start` is a
/// pressure near the solution, if one is known.
///
/// On a grid that is divided among [ranks](crate::ranks), all ranks solve it together by the active set. Each
/// rank passes the gap, the bounds and the start on the rows of its [`Operator::slab`], and the common
/// control. It gets the solution on these rows, with the load of these rows.
///
/// # Errors
/// [`Error::OutOfRange`] for invalid input, [`Error::BeyondPlasticLimit`] if the load exceeds the sum of the
/// upper bounds, [`Error::PeriodicFullContact`], [`Error::NotConverged`], [`Error::Unsupported`] for another
/// method on several ranks.
///
/// # Panics
/// If a field has another shape than the operator's grid.
pub fn solve_normal(
    operator: &mut dyn Operator,
    initial_gap: &Field,
    bounds: &Bounds,
    control: Control,
    start: Option<&Field>,
    params: &Params,
) -> Result<Solution> {
    solve_normal_watched(operator, initial_gap, bounds, control, start, params, &())
}

/// Solves the problem of [`solve_normal`] under a `watch`, which sees each iteration and may interrupt it.
///
/// # Errors
/// The errors of [`solve_normal`], and [`Error::Interrupted`].
///
/// # Panics
/// If a field has another shape than the operator's grid.
pub fn solve_normal_watched(
    operator: &mut dyn Operator,
    initial_gap: &Field,
    bounds: &Bounds,
    control: Control,
    start: Option<&Field>,
    params: &Params,
    watch: &dyn Watch,
) -> Result<Solution> {
    let (initial_gap, start) = (in_rows(initial_gap), start.map(in_rows));
    let how = (watch, NearCopies::Large);
    solve_normal_by(operator, &initial_gap, bounds, control, start.as_deref(), params, how)
}

/// [`solve_normal_watched`] with a choice of the contacts that are solved with near copies.
fn solve_normal_by(
    operator: &mut dyn Operator,
    initial_gap: &Field,
    bounds: &Bounds,
    control: Control,
    start: Option<&Field>,
    params: &Params,
    (watch, near_copies): (&dyn Watch, NearCopies),
) -> Result<Solution> {
    let grid = *operator.grid();
    let shape = (grid.shape[0], grid.shape[1]);
    assert_eq!(initial_gap.dim(), shape, "shape of the initial gap");
    assert!(start.is_none_or(|p| p.dim() == shape), "shape of the start");
    let slab = operator.slab();
    validate(operator, &slab, initial_gap, bounds, control, params)?;
    let self_influence = self_influence(operator);
    let [attraction] = slab.merged([attraction(bounds, grid.cells())]);
    let cell_area = grid.cell_area();
    let settings = Settings { control, self_influence, cell_area, attraction, watch, near_copies };
    let problem = Problem { initial_gap, bounds, settings, slab: &slab };
    let answer = match far_datum(&problem) {
        None => solve_as_given(operator, &problem, start, params)?,
        Some(datum) => {
            let near = initial_gap.mapv(|h| h - datum);
            let nearer = match control {
                Control::Approach(approach) => Control::Approach(approach - datum),
                load => load,
            };
            let settings = Settings { control: nearer, ..settings };
            let near = Problem { initial_gap: &near, bounds, settings, slab: &slab };
            let answer = solve_as_given(operator, &near, start, params)?;
            Answer { approach: control.approach().unwrap_or(answer.approach + datum), ..answer }
        }
    };
    let Answer { pressure, displacement, approach, residual, stats } = answer;
    let (initial_gap, bounds) = (initial_gap.clone(), bounds.clone());
    let solution = Solution { grid, initial_gap, bounds, pressure, displacement, approach, residual, stats };
    finite("load", solution.load())?;
    finite("approach", solution.approach)?;
    finite("elastic energy", solution.elastic_energy())?;
    Ok(solution)
}

/// Solves by the method of the `params`, without shifting the heights.
fn solve_as_given(
    operator: &mut dyn Operator,
    problem: &Problem,
    start: Option<&Field>,
    params: &Params,
) -> Result<Answer> {
    if let Some(answer) = no_contact(problem) {
        return Ok(answer);
    }
    let Problem { initial_gap, bounds, settings, slab } = *problem;
    if let Some(device) = params.device.open()? {
        let answer = device::solve(&device, operator.definition(), problem, start, params)?;
        settings.check_load(&answer, slab)?;
        return Ok(answer);
    }
    let answer = match params.method {
        Method::Direct | Method::PolonskyKeer if !slab.is_whole() => {
            Err(Error::Unsupported("only the active set solves a contact on several ranks"))
        }
        Method::Direct => direct::solve(operator, problem, start, params),
        Method::Auto if slab.is_whole() && initial_gap.len() <= MAX_DIRECT_CELLS => {
            direct::solve(operator, problem, start, params)
        }
        Method::PolonskyKeer => polonsky_keer::solve(operator, problem, start, params),
        Method::Auto | Method::ActiveSet => {
            let site = OwnedSite::new(operator, Cow::Borrowed(initial_gap), Cow::Borrowed(bounds));
            let start = start.map(|pressure| vec![pressure.clone()]);
            let found =
                cascade::solve(&[&site], &settings, start, &|_| params.tolerance, params.max_convolutions)?;
            let (pressure, displacement) = found.fields.into_iter().next().expect("one contact");
            let Residual { eta, approach, .. } = found.residual;
            Ok(Answer { pressure, displacement, approach, residual: eta, stats: found.stats })
        }
    }?;
    settings.check_load(&answer, slab)?;
    Ok(answer)
}

/// Returns the self-influence c₀: displacement of a cell per unit pressure on itself. A single periodic cell
/// has none, because its mean is free; the displacement of a wave of this length then serves as a scale.
fn self_influence(operator: &dyn Operator) -> f64 {
    match operator.influence(0, 0) {
        c0 if c0 > 0.0 => c0,
        _ => operator.harmonic_displacement(TAU / operator.grid().pitch[0], 0.0),
    }
}

/// Returns the lowest height if the heights are far from zero compared with their range or with the depth of
/// the contact, so that h + u would lose digits of u. Heights are then measured from the lowest one without
/// loss.
fn far_datum(problem: &Problem) -> Option<Metre> {
    let Problem { initial_gap, bounds, settings, slab } = problem;
    let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
    for h in *initial_gap {
        (lowest, highest) = (lowest.min(*h), highest.max(*h));
    }
    let most = |value: f64| slab.merged(Largest(value)).0;
    (lowest, highest) = (-most(-lowest), most(highest));
    let depth = match settings.control {
        Control::Approach(approach) => (approach - lowest).max(0.0),
        // The depth is at most the displacement of a single cell under the whole load.
        Control::Load(load) => {
            settings.self_influence
                * (load.abs() / settings.cell_area + settings.attraction).min(most(bounds.upper().max()))
        }
    };
    let far = lowest.abs() > FAR_DATUM * depth.min(highest - lowest);
    far.then_some(lowest)
}

/// Heights are far from zero if they exceed this multiple of their range, or of the depth of the contact.
const FAR_DATUM: f64 = 1e3;

/// Returns an error for a value outside the range of double precision.
fn finite(quantity: &'static str, value: f64) -> Result<()> {
    check(
        quantity,
        value,
        value.is_finite(),
        "a number in double precision: check the units of moduli, heights and load",
    )
}

/// Error of a displacement in single precision, relative to its largest value.
const SINGLE_PRECISION: f64 = 4e-7;
/// Relative error of the load at which a solution is accepted.
const LOAD_TOLERANCE: f64 = 1e-10;

/// Largest number of cells that [`Method::Auto`] solves directly.
const MAX_DIRECT_CELLS: usize = 400;

/// Returns an error if a problem or its parameters are out of range.
fn validate(
    operator: &dyn Operator,
    slab: &Slab,
    initial_gap: &Field,
    bounds: &Bounds,
    control: Control,
    params: &Params,
) -> Result<()> {
    let (grid, whole) = (operator.grid(), slab.whole_grid());
    bounds.validate(grid.shape)?;
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
            let sum = |values: &CellValues| slab.merged([values.sum(grid.cells())])[0];
            let least = grid.cell_area() * sum(bounds.lower());
            let expected = match least {
                0.0 => "a finite load above 0",
                _ => "a finite load above that of all cells at their lower bounds",
            };
            check_in(Dimension::Force, "load", load, load > least && load.is_finite(), expected)?;
            let limit = match bounds.upper().uniform() {
                Some(hardness) => hardness * whole.area(),
                None => grid.cell_area() * sum(bounds.upper()),
            };
            if load >= limit { Err(Error::BeyondPlasticLimit { load, limit }) } else { Ok(()) }
        }
        Control::Approach(approach) => {
            check_in(Dimension::Length, "approach", approach, approach.is_finite(), "a finite approach")?;
            let mean_gap = slab.merged([initial_gap.sum()])[0] / whole.cells() as f64;
            let elastic = !slab.merged(bounds.upper().min().is_finite());
            if operator.leaves_mean_free() && elastic && approach >= mean_gap {
                return Err(Error::PeriodicFullContact { approach, mean_gap });
            }
            Ok(())
        }
    }
}

/// Returns the solution of bodies that neither touch nor attract each other.
fn no_contact(problem: &Problem) -> Option<Answer> {
    let Control::Approach(approach) = problem.settings.control else { return None };
    let attracts = problem.bounds.lower().min() < 0.0;
    let together = attracts || problem.initial_gap.iter().any(|h| *h < approach);
    (!problem.slab.merged(together)).then(|| Answer {
        pressure: Field::zeros(problem.initial_gap.raw_dim()),
        displacement: Field::zeros(problem.initial_gap.raw_dim()),
        approach,
        residual: 0.0,
        stats: Stats::default(),
    })
}

//! The contact with friction: normal and tangential tractions, and where the bodies stick.

mod disc;
mod law;
mod rolling;
mod shear;
mod yielding;

pub use law::{Coupling, Friction};
pub use rolling::{Rolling, solve_rolling};

use crate::error::{Result, check};
use crate::grid::Field;
use crate::material::Compliances;
use crate::operator::CoupledOperator;
use crate::solver::residual::residual_under;
use crate::solver::{Control, Params, Solution, Stats, solve_normal};
use crate::units::{Joule, Metre, Newton, Pascal, SquareMetre};

use shear::{Answer, Rigid, ShearSolver, Task};
use yielding::{AtCaps, caps, solve_capped};

/// What is prescribed in the plane, along x and y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tangential {
    /// Rigid-body displacement D of the upper body against the lower one, from the beginning of the loading.
    Displacement([Metre; 2]),
    /// Force of the upper body on the lower one.
    Force([Newton; 2]),
    /// The upper body slides in this direction, a unit vector, at every cell.
    Sliding([f64; 2]),
}

/// Bodies that slide over each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sliding {
    /// Their friction.
    pub friction: Friction,
    /// Where the upper body slides to, a unit vector.
    pub direction: [f64; 2],
}

impl Sliding {
    /// Shear on the lower body of a cell under `pressure`.
    pub fn shear(&self, pressure: Pascal) -> [Pascal; 2] {
        self.direction.map(|n| n * self.friction.bound(pressure))
    }

    /// Whether the shear displaces these bodies normally.
    pub(crate) fn lifts(&self, compliances: &Compliances) -> bool {
        self.friction.coefficient > 0.0 && self.friction.coupling.lifts(compliances)
    }
}

/// What is prescribed at the end of an increment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loading {
    /// In the normal direction.
    pub normal: Control,
    /// In the plane.
    pub tangential: Tangential,
}

/// A contact with friction in equilibrium, at the end of an increment of its loading.
#[derive(Debug, Clone)]
pub struct FrictionalSolution {
    /// Pressure, approach, and the normal displacement under pressure and shear together; the residual is the larger of
    /// the normal and the tangential one.
    pub normal: Solution,
    /// Most pressure that each cell bears beside its shear, Pa.
    pub cap: Field,
    /// Shear tractions q along x and y on the lower body, Pa.
    pub shear: [Field; 2],
    /// Most shear that each cell bears, Pa.
    pub bound: Field,
    /// Tangential displacement u along x and y, lower minus upper body, m.
    pub displacement: [Field; 2],
    /// Rigid-body displacement D of the upper body against the lower one; from the end of the sliding, after sliding.
    pub shift: [Metre; 2],
    /// Slip of the upper surface over the lower one in this increment along x and y, m; 0 where they do not touch, and in
    /// gross sliding, where it is not bounded.
    pub slip: [Field; 2],
    /// 1 where the bodies touch and stick, |q + Δs/c| ≤ g, else 0.
    pub stick: Field,
}

impl FrictionalSolution {
    /// Tangential force Q = ΔA Σ q of the upper body on the lower one.
    pub fn force(&self, cell_area: SquareMetre) -> [Newton; 2] {
        self.shear.each_ref().map(|q| cell_area * q.sum())
    }

    /// Plastic interference w = δ − h − u ≥ 0 at the cells at their cap, 0 elsewhere.
    pub fn plastic_interference(&self, initial_gap: &Field) -> Field {
        let mut interference = -self.normal.gap(initial_gap);
        ndarray::Zip::from(&mut interference)
            .and(&self.normal.pressure)
            .and(&self.cap)
            .for_each(|w, p, cap| *w = if p >= cap { w.max(0.0) } else { 0.0 });
        interference
    }

    /// Number of cells at their cap.
    pub fn plastic_cells(&self) -> usize {
        self.normal.pressure.iter().zip(&self.cap).filter(|(p, cap)| p >= cap).count()
    }

    /// Largest shear traction |q|.
    pub fn max_shear(&self) -> Pascal {
        self.shear[0].iter().zip(&self.shear[1]).map(|(x, y)| x.hypot(*y)).fold(0.0, f64::max)
    }

    /// Elastic energy ½ ΔA Σ (p u_z + q·u) (periodic: without that of the mean displacements, which are free).
    pub fn elastic_energy(&self, cell_area: SquareMetre) -> Joule {
        let work = |t: &Field, u: &Field| (t * u).sum();
        let tangential: f64 = self.shear.iter().zip(&self.displacement).map(|(q, u)| work(q, u)).sum();
        self.normal.elastic_energy(cell_area) + 0.5 * cell_area * tangential
    }

    /// Energy ΔA Σ ½(q₀ + q)·Δs that friction took in this increment, q₀ the shear `before` it.
    ///
    /// Over a closed cycle of tangential loading this is the area of the hysteresis loop, but for what pressures and gaps
    /// of cells that open and close leave, of second order in the increment.
    pub fn dissipation(&self, before: Option<&Self>, cell_area: SquareMetre) -> Joule {
        let axis = |n: usize| {
            let now = (&self.shear[n] * &self.slip[n]).sum();
            let then = before.map_or(0.0, |before| (&before.shear[n] * &self.slip[n]).sum());
            0.5 * (now + then)
        };
        cell_area * (axis(0) + axis(1))
    }
}

/// Residual of the first round where pressure and shear influence each other.
const FIRST: f64 = 3e-2;
/// Each round is solved to so much of the residual that the last one left.
const SHARPER: f64 = 0.1;
/// The last round is solved to so much of the tolerance.
const LAST: f64 = 0.5;
/// After a round that has not lowered the residual the next one takes up half as much of the change of the normal
/// displacement under shear, but no less than this; after one that has, [`RISE`] times as much.
const LEAST: f64 = 0.2;
const RISE: f64 = 1.2;
/// Rounds after which the iteration is given up.
const MOST_ROUNDS: usize = 200;

/// Solves one increment of a contact with friction, implicitly: the normal contact of [`solve_normal`] together with
///
/// ```text
/// |q| ≤ g = min(μp, τ);   |q| < g ⇒ Δs = 0;   |q| = g ⇒ Δs = λ q, λ ≥ 0
/// s = D − u(q, p),   Δs = s − s₀
/// ```
///
/// s₀ belongs to the solution `before`, of which there is none for bodies that have not touched yet. Normal and tangential
/// problems are solved in turn, each for the tractions of the other (Panagiotopoulos 1975), until both are met: at once
/// where shear neither displaces the surface normally nor softens it. Residuals are η of [`crate::solver::residual()`],
/// with the cap of each cell for the hardness, and its like
///
/// ```text
/// max |c (q − P(q + Δs/c))| / (f std(u_z)),   P onto |q| ≤ g,   f = min(1, Σg/Σp),   c = ½(C^xx + C^yy) of a cell
/// ```
///
/// # Errors
/// Those of [`solve_normal`]; [`crate::Error::BeyondFriction`] for a force that friction cannot hold.
///
/// # Panics
/// If a field has another shape than the operator's grid.
pub fn solve_frictional(
    operator: &mut dyn CoupledOperator,
    initial_gap: &Field,
    hardness: Pascal,
    friction: &Friction,
    loading: Loading,
    before: Option<&FrictionalSolution>,
    params: &Params,
) -> Result<FrictionalSolution> {
    let start = match before {
        Some(before) => Start {
            pressure: Some(before.normal.pressure.clone()),
            cap: Some(before.cap.clone()),
            shear: Some(before.shear.clone()),
            slip: Some([0, 1].map(|axis| before.displacement[axis].mapv(|u| before.shift[axis] - u))),
        },
        None => Start::default(),
    };
    let hardness = match loading.tangential {
        Tangential::Sliding(_) => friction.sliding_cap(hardness),
        _ => hardness,
    };
    alternate(operator, initial_gap, hardness, friction, loading, start, params)
}

/// Where an increment begins.
#[derive(Default)]
struct Start {
    /// Near the answer.
    pressure: Option<Field>,
    cap: Option<Field>,
    shear: Option<[Field; 2]>,
    /// s₀.
    slip: Option<[Field; 2]>,
}

/// Solves the contact of bodies that slide, as [`solve_frictional`] does under [`Tangential::Sliding`], from a pressure
/// near the answer; `hardness` is what the shear leaves of it, [`Friction::sliding_cap`].
pub(crate) fn solve_sliding(
    operator: &mut dyn CoupledOperator,
    initial_gap: &Field,
    hardness: Pascal,
    sliding: &Sliding,
    normal: Control,
    pressure: Option<&Field>,
    params: &Params,
) -> Result<FrictionalSolution> {
    let loading = Loading { normal, tangential: Tangential::Sliding(sliding.direction) };
    let start = Start { pressure: pressure.cloned(), ..Start::default() };
    alternate(operator, initial_gap, hardness, &sliding.friction, loading, start, params)
}

/// Normal and tangential problems in turn.
fn alternate(
    operator: &mut dyn CoupledOperator,
    initial_gap: &Field,
    hardness: Pascal,
    friction: &Friction,
    loading: Loading,
    start: Start,
    params: &Params,
) -> Result<FrictionalSolution> {
    let friction = friction.checked()?;
    validate(&loading.tangential)?;
    let mut bodies = Bodies { operator, coupling: friction.coupling, convolutions: 0.0 };
    let grid = *bodies.operator.grid();
    let Start { mut pressure, cap, shear, slip: slip_before } = start;
    let mut lift = shear.as_ref().and_then(|shear| bodies.lift(shear));
    let mut shear = shear.unwrap_or_else(|| [grid.zeros(), grid.zeros()]);
    let slides = matches!(loading.tangential, Tangential::Sliding(_));
    let softens = friction.softens(hardness) && !slides;
    let friction = if softens { friction.within(hardness) } else { friction };
    let mut cap = cap.unwrap_or_else(|| Field::from_elem(grid.shape, hardness));
    let alternates = bodies.shear_lifts() || softens;
    let mut solver = None;
    let mut stats = Stats::default();
    let mut tolerance = if alternates { FIRST.max(LAST * params.tolerance) } else { params.tolerance };
    let (mut last, mut share) = (f64::INFINITY, 1.0);
    for _ in 0..MOST_ROUNDS {
        let gap = lift.as_ref().map(|lift| initial_gap + lift);
        let params_now = Params { tolerance, ..*params };
        let gap = gap.as_ref().unwrap_or(initial_gap);
        let operator = bodies.operator.normal();
        let mut normal = match &pressure {
            Some(pressure) if softens => {
                let softer = caps(&friction, hardness, pressure, &shear);
                let start = AtCaps::of(pressure, &cap, &softer);
                cap = softer;
                solve_capped(operator, gap, &cap, loading.normal, start, &params_now)?
            }
            start => solve_normal(operator, gap, hardness, loading.normal, start.as_ref(), &params_now)?,
        };
        stats = stats.and(&normal.stats);
        let bound = normal.pressure.mapv(|p| friction.bound(p));
        let scale = shear_scale(&normal, &bound, bodies.operator);
        let mut hold = |control| {
            let free_slip = bodies.free_slip(&normal.pressure, slip_before.as_ref());
            let solver = solver.get_or_insert_with(|| ShearSolver::new(bodies.operator));
            let task = Task { bound: &bound, free_slip: &free_slip, control, scale, tolerance };
            solver.solve(bodies.operator, &task, &shear, params.max_convolutions)
        };
        let answer = match loading.tangential {
            Tangential::Displacement(shift) => hold(Rigid::Shift(shift))?,
            Tangential::Force(force) => hold(Rigid::Force(force))?,
            Tangential::Sliding(direction) => {
                Answer { shear: direction.map(|n| &bound * n), shift: [0.0; 2], residual: 0.0 }
            }
        };
        shear = answer.shear;
        let supposed = lift;
        lift = bodies.lift(&shear);
        if let Some(lift) = &lift {
            normal.displacement += lift;
        }
        if alternates {
            let approach = match softens {
                // Of cells that come off their caps by a little the multiplier of the load knows nothing.
                true => Some(normal.approach),
                false => loading.normal.approach(),
            };
            let caps = match softens {
                true => &caps(&friction, hardness, &normal.pressure, &shear),
                false => &cap,
            };
            let state = residual_under(
                || caps.iter().copied(),
                &normal.pressure,
                &normal.displacement,
                initial_gap,
                bodies.operator.self_influence().zz,
                approach,
            );
            (normal.residual, normal.approach) = (state.eta, state.approach);
        }
        let reached = normal.residual.max(answer.residual);
        if reached <= params.tolerance {
            if let Some(solver) = &solver {
                stats = stats.and(&solver.stats);
            }
            let displacement = bodies.displacement(&shear, &normal.pressure);
            stats.convolutions += bodies.convolutions;
            normal.residual = reached;
            normal.stats = stats;
            let slip =
                slip(loading.tangential, &normal.pressure, answer.shift, &displacement, slip_before.as_ref());
            let shift = answer.shift;
            let stick = match slides {
                true => grid.zeros(),
                false => stick(&shear, &slip, &bound, self_compliance(bodies.operator)),
            };
            return Ok(FrictionalSolution { normal, cap, shear, bound, displacement, shift, slip, stick });
        }
        share = if reached < last { f64::min(RISE * share, 1.0) } else { f64::max(0.5 * share, LEAST) };
        last = reached;
        if let (Some(lift), Some(supposed)) = (&mut lift, supposed) {
            *lift = &supposed + share * (&*lift - &supposed);
        }
        tolerance = (SHARPER * reached).clamp(LAST * params.tolerance, FIRST);
        pressure = Some(normal.pressure);
    }
    Err(crate::Error::NotConverged {
        iterations: stats.iterations,
        residual: tolerance / SHARPER,
        tolerance: params.tolerance,
    })
}

fn validate(tangential: &Tangential) -> Result<()> {
    match *tangential {
        Tangential::Displacement(shift) => shift
            .into_iter()
            .try_for_each(|d| check("tangential displacement", d, d.is_finite(), "a finite length")),
        Tangential::Force(force) => {
            force.into_iter().try_for_each(|f| check("tangential force", f, f.is_finite(), "a finite force"))
        }
        Tangential::Sliding([x, y]) => {
            let length = x.hypot(y);
            check("length of the sliding direction", length, (length - 1.0).abs() < 1e-9, "a unit vector")
        }
    }
}

/// What a residual of the tangential problem is a share of.
fn shear_scale(normal: &Solution, bound: &Field, operator: &dyn CoupledOperator) -> Metre {
    let local = operator.self_influence().zz * normal.max_pressure();
    let deviation = normal.displacement.std(0.0);
    let share = (bound.sum() / normal.pressure.sum()).min(1.0);
    let scale = share * if deviation <= 1e-12 * local { local } else { deviation };
    // Without contact, or without friction, nothing is left to be a share of.
    if scale > 0.0 { scale } else { 1.0 }
}

fn slip(
    tangential: Tangential,
    pressure: &Field,
    shift: [Metre; 2],
    displacement: &[Field; 2],
    before: Option<&[Field; 2]>,
) -> [Field; 2] {
    [0, 1].map(|axis| {
        let mut slip = displacement[axis].mapv(|u| shift[axis] - u);
        if let Some(before) = before {
            slip -= &before[axis];
        }
        let bounded = !matches!(tangential, Tangential::Sliding(_));
        slip.zip_mut_with(pressure, |s, p| *s = if bounded && *p > 0.0 { *s } else { 0.0 });
        slip
    })
}

/// 1 where |q + Δs/c| ≤ g > 0.
fn stick(shear: &[Field; 2], slip: &[Field; 2], bound: &Field, compliance: f64) -> Field {
    let mut stick = bound.clone();
    let predicted = |axis: usize| &shear[axis] + &slip[axis] / compliance;
    ndarray::Zip::from(&mut stick).and(&predicted(0)).and(&predicted(1)).for_each(|g, x, y| {
        *g = if *g > 0.0 && x.hypot(*y) <= *g { 1.0 } else { 0.0 };
    });
    stick
}

/// c, displacement of a cell per unit shear on itself, in the mean of the directions.
fn self_compliance(operator: &dyn CoupledOperator) -> f64 {
    let influence = operator.self_influence();
    0.5 * (influence.xx + influence.yy)
}

/// The two bodies, coupled as is asked for.
struct Bodies<'a> {
    operator: &'a mut dyn CoupledOperator,
    coupling: Coupling,
    /// Of coupling terms and whole displacements.
    convolutions: f64,
}

impl Bodies<'_> {
    fn shear_lifts(&self) -> bool {
        self.coupling.lifts(self.operator.compliances())
    }

    fn pressure_slips(&self) -> bool {
        self.coupling.slips(self.operator.compliances())
    }

    /// Normal displacement under shear.
    fn lift(&mut self, shear: &[Field; 2]) -> Option<Field> {
        if !self.shear_lifts() {
            return None;
        }
        let mut lift = self.operator.grid().zeros();
        self.operator.apply([Some(&shear[0]), Some(&shear[1]), None], [None, None, Some(&mut lift)]);
        self.convolutions += 1.0;
        Some(lift)
    }

    /// The slip that there would be without shear, but for the rigid displacement: −u(0, p) − s₀.
    fn free_slip(&mut self, pressure: &Field, before: Option<&[Field; 2]>) -> [Field; 2] {
        let grid = *self.operator.grid();
        let mut slip = [grid.zeros(), grid.zeros()];
        if self.pressure_slips() {
            let [x, y] = slip.each_mut();
            self.operator.apply([None, None, Some(pressure)], [Some(x), Some(y), None]);
            self.convolutions += 1.0;
        }
        for (axis, slip) in slip.iter_mut().enumerate() {
            match before {
                Some(before) => slip.zip_mut_with(&before[axis], |u, s| *u = -*u - s),
                None => slip.mapv_inplace(|u| -u),
            }
        }
        slip
    }

    /// Tangential displacement under both tractions.
    fn displacement(&mut self, shear: &[Field; 2], pressure: &Field) -> [Field; 2] {
        let grid = *self.operator.grid();
        let mut u = [grid.zeros(), grid.zeros()];
        let pressure = self.pressure_slips().then_some(pressure);
        let [x, y] = u.each_mut();
        self.operator.apply([Some(&shear[0]), Some(&shear[1]), pressure], [Some(x), Some(y), None]);
        self.convolutions += 1.0;
        u
    }
}

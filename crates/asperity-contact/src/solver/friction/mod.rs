//! Contact with friction: normal and tangential tractions, stick and slip.

mod alternate;
mod bodies;
mod disc;
mod law;
mod rolling;
mod shear;
mod transport;
mod yielding;

pub use law::{Coupling, Friction};
pub(crate) use rolling::solve_rolling_watched;
pub use rolling::{Creep, Rolling, RollingSolution, solve_rolling};

use crate::error::{Result, check, check_in};
use crate::grid::{Field, in_rows};
use crate::operator::CoupledOperator;
use crate::solver::{Bounds, Control, Params, Solution, Stats, Watch};
use crate::units::{Dimension, Joule, Metre, Newton, Pascal};

pub(crate) use alternate::Start;
use alternate::alternate;
pub(crate) use transport::History;

/// Prescribed displacement, force or sliding direction in the plane, along x and y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tangential {
    /// Rigid-body displacement D of the upper body relative to the lower one, from the beginning of the loading.
    Displacement([Metre; 2]),
    /// Force of the upper body on the lower one.
    Force([Newton; 2]),
    /// The upper body slides in this direction, a unit vector, and every cell slips.
    Sliding([f64; 2]),
}

/// Gross sliding of two bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sliding {
    /// Friction of the bodies.
    pub friction: Friction,
    /// Direction in which the upper body slides, a unit vector.
    pub direction: [f64; 2],
}

impl Sliding {
    /// Returns the shear on the lower body of a cell under `pressure`.
    pub fn shear(&self, pressure: Pascal) -> [Pascal; 2] {
        self.direction.map(|n| n * self.friction.shear_limit(pressure))
    }

    /// Whether the shear displaces these bodies normally.
    pub fn shear_displaces_normally(&self, couples: bool) -> bool {
        self.friction.coefficient > 0.0 && self.friction.coupling.shear_displaces_normally(couples)
    }
}

/// Prescribed loading of a contact at the end of an increment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loading {
    /// Normal loading.
    pub normal: Control,
    /// Tangential loading.
    pub tangential: Tangential,
}

/// A contact with friction in equilibrium, at the end of an increment of its loading.
#[derive(Debug, Clone)]
pub struct FrictionalSolution {
    /// Pressure, approach, and the normal displacement under pressure and shear together. Its residual is the
    /// larger of the normal and the tangential residual. Its upper bounds include the effect of the shear.
    pub normal: Solution,
    /// Shear tractions q along x and y on the lower body, Pa.
    pub shear: [Field; 2],
    /// Largest shear g of each cell, Pa.
    pub shear_limit: Field,
    /// Tangential displacement u along x and y, lower minus upper body, m.
    pub displacement: [Field; 2],
    /// Rigid-body displacement D of the upper body relative to the lower one; after sliding, from the end of the
    /// sliding.
    pub rigid_displacement: [Metre; 2],
    /// Slip of the upper surface over the lower one in this increment along x and y, m. It is 0 for cells that do
    /// not touch, and in gross sliding, in which it is arbitrary.
    pub slip: [Field; 2],
    /// 1 for cells that touch and stick, |q + Δs/c| ≤ g, else 0.
    pub stick: Field,
}

impl FrictionalSolution {
    /// Returns the tangential force Q = ΔA Σ q of the upper body on the lower one.
    pub fn force(&self) -> [Newton; 2] {
        self.shear.each_ref().map(|q| self.normal.grid.cell_area() * q.sum())
    }

    /// Returns the slip D − u since the first contact of the bodies, m.
    pub(crate) fn whole_slip(&self) -> [Field; 2] {
        [0, 1].map(|axis| self.displacement[axis].mapv(|u| self.rigid_displacement[axis] - u))
    }

    /// Returns the largest shear traction |q|.
    pub fn max_shear(&self) -> Pascal {
        self.shear[0].iter().zip(&self.shear[1]).map(|(x, y)| x.hypot(*y)).fold(0.0, f64::max)
    }

    /// Returns the elastic energy ½ ΔA Σ (p u_z + q·u). Under a periodic boundary it excludes the mean
    /// displacements, which are free.
    pub fn elastic_energy(&self) -> Joule {
        let work = |t: &Field, u: &Field| (t * u).sum();
        let tangential: f64 = self.shear.iter().zip(&self.displacement).map(|(q, u)| work(q, u)).sum();
        self.normal.elastic_energy() + 0.5 * self.normal.grid.cell_area() * tangential
    }

    /// Computes the energy dissipated by friction in this increment, ΔA Σ ½(g₀ + g)|Δs| over the cells that slip.
    /// g₀ and g are the largest shear of a cell `before` and after the increment. Without a state before, g
    /// replaces g₀, as if the load came before the slip.
    ///
    /// A cell slips only at its limit. The energy is therefore exact for increments of any size if pressures are
    /// constant and the slip keeps its direction. If pressures change with the slip, the error is of second order
    /// in the increment, and [`FrictionalSolution::dissipation_error`] bounds it.
    pub fn dissipation(&self, before: Option<&Self>) -> Joule {
        self.over_slips(before, |then, now| 0.5 * (then + now))
    }

    /// Computes the error bound of [`FrictionalSolution::dissipation`], ΔA Σ ½|g − g₀||Δs|, in which all slip
    /// occurs at one of the two limits. It holds if the limit of each cell changes monotonically in the
    /// increment, and its slip keeps its direction.
    pub fn dissipation_error(&self, before: &Self) -> Joule {
        self.over_slips(Some(before), |then, now| 0.5 * (now - then).abs())
    }

    /// Computes ΔA Σ |Δs| · `shear`(g₀, g) over the cells that slip, with the limits before and after the increment.
    fn over_slips(&self, before: Option<&Self>, shear: impl Fn(Pascal, Pascal) -> Pascal) -> Joule {
        let mut sum = 0.0;
        for ((cell, &now), &sticks) in self.shear_limit.indexed_iter().zip(&self.stick) {
            if now > 0.0 && sticks == 0.0 {
                let then = before.map_or(now, |before| before.shear_limit[cell]);
                sum += shear(then, now) * self.slip[0][cell].hypot(self.slip[1][cell]);
            }
        }
        self.normal.grid.cell_area() * sum
    }
}

/// Solves one implicit increment of a contact with friction: the normal contact of [`crate::solver::solve_normal`]
/// together with
///
/// ```text
/// |q| ≤ g = min(μp, τ);   |q| < g ⇒ Δs = 0;   |q| = g ⇒ Δs = λ q, λ ≥ 0
/// s = D − u(q, p),   Δs = s − s₀
/// ```
///
/// s₀ is the slip of the solution `before`; none for bodies that have not touched yet. Normal and tangential problems
/// are solved alternately, each for the tractions of the other (Panagiotopoulos 1975), until both are solved. One
/// round is enough if shear neither displaces the surface normally nor lowers its caps. Residuals are η of
/// [`crate::solver::residual()`] and
///
/// ```text
/// max |c (q − P(q + Δs/c))| / (f std(u_z)),   P onto |q| ≤ g,   f = min(1, Σg/Σp),   c = ½(C^xx + C^yy) of a cell
/// ```
///
/// # Errors
/// Returns the errors of [`crate::solver::solve_normal`]; [`crate::Error::BeyondFriction`] for a force that friction cannot hold.
///
/// # Panics
/// If a field has another shape than the operator's grid.
pub fn solve_frictional(
    operator: &mut dyn CoupledOperator,
    initial_gap: &Field,
    bounds: &Bounds,
    friction: &Friction,
    loading: Loading,
    before: Option<&FrictionalSolution>,
    params: &Params,
) -> Result<FrictionalSolution> {
    solve_frictional_watched(operator, &in_rows(initial_gap), bounds, friction, loading, before, params, &())
}

/// [`solve_frictional`] with a watch.
#[expect(clippy::too_many_arguments, reason = "the contact, where it begins, and who looks on")]
pub(crate) fn solve_frictional_watched(
    operator: &mut dyn CoupledOperator,
    initial_gap: &Field,
    bounds: &Bounds,
    friction: &Friction,
    loading: Loading,
    before: Option<&FrictionalSolution>,
    params: &Params,
    watch: &dyn Watch,
) -> Result<FrictionalSolution> {
    let start = before.map_or_else(Start::default, Start::after);
    let failed = &mut Stats::default();
    solve_frictional_from(operator, initial_gap, bounds, friction, loading, start, params, watch, failed)
}

/// [`solve_frictional`] from a given state, with a watch. If it fails, it adds its cost to `failed`.
#[expect(clippy::too_many_arguments, reason = "the contact, where it begins, and who looks on")]
pub(crate) fn solve_frictional_from(
    operator: &mut dyn CoupledOperator,
    initial_gap: &Field,
    bounds: &Bounds,
    friction: &Friction,
    loading: Loading,
    start: Start,
    params: &Params,
    watch: &dyn Watch,
    failed: &mut Stats,
) -> Result<FrictionalSolution> {
    params.device.only_processor("a device does not solve friction with stick")?;
    let friction = friction.checked()?;
    validate(&loading.tangential)?;
    let bounds = match loading.tangential {
        Tangential::Sliding(_) => friction.sliding_bounds(bounds),
        _ => bounds.clone(),
    };
    alternate(operator, initial_gap, bounds, friction, loading, start, params, watch, failed)
}

/// Solves the contact of sliding bodies, like [`solve_frictional`] with [`Tangential::Sliding`], from a pressure near
/// the solution. The `bounds` include the effect of the shear, see [`Friction::sliding_bounds`].
#[expect(clippy::too_many_arguments, reason = "the contact, where it begins, and who looks on")]
pub(crate) fn solve_sliding(
    operator: &mut dyn CoupledOperator,
    initial_gap: &Field,
    bounds: &Bounds,
    sliding: &Sliding,
    normal: Control,
    pressure: Option<&Field>,
    params: &Params,
    watch: &dyn Watch,
) -> Result<FrictionalSolution> {
    params
        .device
        .only_processor("a device does not solve sliding whose shear displaces the bodies normally")?;
    let loading = Loading { normal, tangential: Tangential::Sliding(sliding.direction) };
    let start = Start { pressure: pressure.cloned(), ..Start::default() };
    let failed = &mut Stats::default();
    alternate(operator, initial_gap, bounds.clone(), sliding.friction, loading, start, params, watch, failed)
}

/// Returns an error if the tangential loading is out of range.
fn validate(tangential: &Tangential) -> Result<()> {
    match *tangential {
        Tangential::Displacement(displacement) => displacement.into_iter().try_for_each(|d| {
            check_in(Dimension::Length, "tangential displacement", d, d.is_finite(), "a finite length")
        }),
        Tangential::Force(force) => force.into_iter().try_for_each(|f| {
            check_in(Dimension::Force, "tangential force", f, f.is_finite(), "a finite force")
        }),
        Tangential::Sliding([x, y]) => {
            let length = x.hypot(y);
            check("length of the sliding direction", length, (length - 1.0).abs() < 1e-9, "a unit vector")
        }
    }
}

/// Returns the displacement c of a cell per unit shear on itself, averaged over the directions, m/Pa.
fn self_compliance(operator: &dyn CoupledOperator) -> f64 {
    let influence = operator.self_influence();
    let compliance = 0.5 * (influence.xx + influence.yy);
    // A periodic contact of one cell does not deform. Any number serves for which a slip exceeds all shear.
    if compliance > 0.0 { compliance } else { 1e-40 }
}

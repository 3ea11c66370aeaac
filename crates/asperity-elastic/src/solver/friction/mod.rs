//! Contact with friction: normal and tangential tractions, stick and slip.

mod alternate;
mod bodies;
mod disc;
mod law;
mod rolling;
mod shear;
mod sliding;
mod stick_slip;
mod transport;
mod yielding;

pub use law::{Coupling, Friction};
pub(super) use rolling::roll;
pub use rolling::{Creep, Rolling, RollingSolution, solve_rolling};
pub use sliding::Sliding;
pub(super) use sliding::solve_sliding;
pub use stick_slip::solve_frictional;
pub(super) use stick_slip::solve_stick_slip;

use crate::grid::{CellValues, Field};
use crate::operator::CoupledOperator;
use crate::solver::{Control, NormalProblem, Solution};
use crate::units::{Joule, Metre, Newton, Pascal};

/// Prescribed displacement, force or sliding direction in the plane, along x and y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tangential {
    /// Rigid-body displacement D of the upper body relative to the lower one, from the beginning of the
    /// loading.
    Displacement([Metre; 2]),
    /// Force of the upper body on the lower one.
    Force([Newton; 2]),
    /// The upper body slides in this direction, a unit vector, and every cell slips.
    Sliding([f64; 2]),
}

/// Prescribed loading of a contact at the end of an increment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loading {
    /// Normal loading.
    pub normal: Control,
    /// Tangential loading.
    pub tangential: Tangential,
}

impl Loading {
    /// Creates a loading without tangential force.
    pub const fn pressing(normal: Control) -> Self {
        Self { normal, tangential: Tangential::Force([0.0; 2]) }
    }
}

/// A contact with friction to be solved.
#[derive(Clone, Copy)]
pub(super) struct FrictionalProblem<'a> {
    /// The normal problem, with the bounds of cells without shear.
    pub(super) normal: NormalProblem<'a>,
    /// The prescribed loading in the plane.
    pub(super) tangential: Tangential,
    /// Additional compliance of each cell under its own pressure, m/Pa.
    pub(super) compliance: Option<&'a CellValues>,
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
    /// Rigid-body displacement D of the upper body relative to the lower one; after sliding, from the end of
    /// the sliding.
    pub rigid_displacement: [Metre; 2],
    /// Slip of the upper surface over the lower one in this increment along x and y, m. It is 0 for cells
    /// that do not touch, and in gross sliding, in which it is arbitrary.
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

    /// Computes the energy dissipated by friction in this increment, ΔA Σ ½(g₀ + g)|Δs| over the cells that
    /// slip. g₀ and g are the largest shear of a cell `before` and after the increment. Without a state
    /// before, g replaces g₀, as if the load came before the slip. Cells that [leave](Self::leaving) the
    /// contact lose ½|q₀||Δs|.
    ///
    /// A cell slips only at its limit. The energy is therefore exact for increments of any size if pressures
    /// are constant and the slip keeps its direction. If pressures change with the slip, the error is of
    /// second order in the increment, and [`FrictionalSolution::dissipation_error`] estimates it.
    pub fn dissipation(&self, before: Option<&Self>) -> Joule {
        self.over_slips(before, |then, now| 0.5 * (then + now))
    }

    /// Estimates the error of [`FrictionalSolution::dissipation`], ΔA Σ ½|g − g₀||Δs|, by letting all slip
    /// occur at one of the two limits. It is no bound: the slip itself depends on the increments.
    pub fn dissipation_error(&self, before: &Self) -> Joule {
        self.over_slips(Some(before), |then, now| 0.5 * (now - then).abs())
    }

    /// Returns the cells that were in contact `before` and are no more, each with the magnitude of its shear
    /// then, Pa, and the distance of its slip in the increment, m. It is empty in gross sliding, in which the
    /// slip is arbitrary.
    pub fn leaving<'a>(&'a self, before: &'a Self) -> impl Iterator<Item = ([usize; 2], Pascal, Metre)> + 'a {
        let touches = self.shear_limit.iter().any(|limit| *limit > 0.0);
        let moves =
            self.stick.iter().any(|stick| *stick > 0.0) || self.slip[0].iter().any(|slip| *slip != 0.0);
        let cells = before.shear_limit.indexed_iter().filter(move |_| moves || !touches);
        let left = cells.filter(|(cell, then)| **then > 0.0 && self.shear_limit[*cell] == 0.0);
        left.map(|(cell, _)| {
            let place =
                |state: &Self, axis: usize| state.rigid_displacement[axis] - state.displacement[axis][cell];
            let [x, y] = [0, 1].map(|axis| place(self, axis) - place(before, axis));
            ([cell.0, cell.1], before.shear[0][cell].hypot(before.shear[1][cell]), x.hypot(y))
        })
    }

    /// Computes ΔA Σ |Δs| · `shear`(g₀, g) over the cells that slip, with the limits before and after the
    /// increment.
    fn over_slips(&self, before: Option<&Self>, shear: impl Fn(Pascal, Pascal) -> Pascal) -> Joule {
        let mut sum = 0.0;
        for ((cell, &now), &sticks) in self.shear_limit.indexed_iter().zip(&self.stick) {
            if now > 0.0 && sticks == 0.0 {
                let then = before.map_or(now, |before| before.shear_limit[cell]);
                sum += shear(then, now) * self.slip[0][cell].hypot(self.slip[1][cell]);
            }
        }
        let left = before.into_iter().flat_map(|before| self.leaving(before));
        sum += left.map(|(_, then, slip)| shear(then, 0.0) * slip).sum::<f64>();
        self.normal.grid.cell_area() * sum
    }
}

/// Returns the displacement c of a cell per unit shear on itself, averaged over the directions, m/Pa.
fn self_compliance(operator: &dyn CoupledOperator) -> f64 {
    let influence = operator.self_influence();
    let compliance = 0.5 * (influence.xx + influence.yy);
    // A periodic contact of one cell does not deform. Any number serves for which a slip exceeds all shear.
    if compliance > 0.0 { compliance } else { 1e-40 }
}

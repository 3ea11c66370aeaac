//! The interface of two bodies: the tension that acts between their surfaces, which are hard walls to each
//! other.

use std::fmt::Debug;

use crate::error::Result;
use crate::grid::{CellValues, Field};
use crate::operator::{Compliant, Operator};
use crate::solver::{Bounds, Control, Params, Solution, Watch, solve_normal_watched};
use crate::units::{JoulePerSquareMetre, Metre, Pascal};

/// Interface of two bodies. Neither surface penetrates the other; a tension σ(g) may act across the gap g
/// between them.
pub trait Interface: Debug + Send + Sync {
    /// Presses bodies together without friction.
    ///
    /// # Errors
    /// The errors of [`solve_normal`](crate::solver::solve_normal), and those of the interface.
    fn solve(&self, operator: &mut dyn Operator, problem: &NormalProblem<'_>) -> Result<Solution>;

    /// Tension σ(g) ≥ 0 at a gap.
    fn tension(&self, gap: Metre) -> Pascal;

    /// Energy v(g) ≤ 0 of an area at a gap, with σ = dv/dg.
    fn energy(&self, gap: Metre) -> JoulePerSquareMetre;

    /// Whether there is no tension. The contact then is the same, whatever contact came before it.
    fn is_hard(&self) -> bool;

    /// Whether the contact at each position of a pass begins with that at the position before.
    fn follows_path(&self) -> bool;

    /// Checks that this interface can be solved together with sliding in place, plastic flow and ranks.
    ///
    /// # Errors
    /// [`Error::Unsupported`](crate::Error::Unsupported).
    fn check_combined(&self) -> Result<()>;

    /// Checks that passes can be solved with this interface: passes by a circular shift or in an overlap,
    /// with a shear that `displaces` the bodies normally or does not.
    ///
    /// # Errors
    /// [`Error::Unsupported`](crate::Error::Unsupported).
    fn check_passes(&self, is_shift: bool, displaces: bool, params: &Params) -> Result<()>;
}

/// A contact without friction that is to be solved.
#[derive(Clone, Copy)]
pub struct NormalProblem<'a> {
    /// The initial gap, m.
    pub gap: &'a Field,
    /// The bounds of the pressure, of which only the upper ones count.
    pub bounds: &'a Bounds,
    /// The prescribed load or approach.
    pub control: Control,
    /// The contact before it.
    pub before: Before<'a>,
    /// The parameters of the solver.
    pub params: &'a Params,
    /// The watch of the computation.
    pub watch: &'a dyn Watch,
}

impl NormalProblem<'_> {
    /// Solves it with an `interface` between bodies with an additional `compliance` of each cell under its
    /// own pressure, m/Pa.
    pub(super) fn solve(
        &self,
        operator: &mut dyn Operator,
        interface: &dyn Interface,
        compliance: Option<&CellValues>,
    ) -> Result<Solution> {
        match compliance {
            None => interface.solve(operator, self),
            Some(compliance) => interface.solve(&mut Compliant::new(operator, compliance.clone())?, self),
        }
    }
}

/// Contact before another one of the same bodies.
#[derive(Debug, Clone, Copy)]
pub enum Before<'a> {
    /// No contact: the bodies come from afar.
    Apart,
    /// No contact, but a pressure near the solution is known. It changes the cost of the solution alone.
    Guess(&'a Field),
    /// The contact from which the bodies come.
    Contact(&'a Solution),
}

impl<'a> Before<'a> {
    /// Returns the pressure that is known; `None` of bodies that come from afar.
    pub fn pressure(self) -> Option<&'a Field> {
        match self {
            Self::Apart => None,
            Self::Guess(pressure) => Some(pressure),
            Self::Contact(last) => Some(&last.pressure),
        }
    }
}

impl<'a> From<Option<&'a Solution>> for Before<'a> {
    fn from(last: Option<&'a Solution>) -> Self {
        last.map_or(Self::Apart, Self::Contact)
    }
}

/// Cost of a contact with an interface other than hard walls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InterfaceCost {
    /// Convolutions to 10⁻⁶ on a small grid.
    pub convolutions: f64,
    /// Work of one with the iteration around it, in units of a convolution with free boundary.
    pub work: f64,
    /// Numbers for each cell in memory, besides those of hard walls.
    pub memory: f64,
}

/// Interface without tension: surfaces that only keep apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HardWall;

impl Interface for HardWall {
    fn solve(&self, operator: &mut dyn Operator, problem: &NormalProblem<'_>) -> Result<Solution> {
        let NormalProblem { gap, bounds, control, before, params, watch } = *problem;
        solve_normal_watched(operator, gap, bounds, control, before.pressure(), params, watch)
    }

    fn tension(&self, _: Metre) -> Pascal {
        0.0
    }

    fn energy(&self, _: Metre) -> JoulePerSquareMetre {
        0.0
    }

    fn is_hard(&self) -> bool {
        true
    }

    fn follows_path(&self) -> bool {
        false
    }

    fn check_combined(&self) -> Result<()> {
        Ok(())
    }

    fn check_passes(&self, _: bool, _: bool, _: &Params) -> Result<()> {
        Ok(())
    }
}

//! The interface of two bodies: the tension that acts between their surfaces, which are hard walls to each other.

use std::fmt::Debug;

use crate::error::Result;
use crate::grid::Field;
use crate::operator::Operator;
use crate::solver::{Bounds, Control, Params, Solution, Watch, solve_normal_watched};
use crate::units::{JoulePerSquareMetre, Metre, Pascal};

/// Interface of two bodies. Neither surface penetrates the other; a tension σ(g) may act across the gap g between them.
pub trait Interface: Debug + Send + Sync {
    /// Presses bodies together without friction, over their initial `gap` and within the upper `bounds` of the pressure, from the
    /// contact `before`.
    ///
    /// # Errors
    /// The errors of [`solve_normal`](crate::solver::solve_normal), and those of the interface.
    #[expect(clippy::too_many_arguments, reason = "the contact, where it begins, and who looks on")]
    fn solve(
        &self,
        operator: &mut dyn Operator,
        gap: &Field,
        bounds: &Bounds,
        control: Control,
        before: Before<'_>,
        params: &Params,
        watch: &dyn Watch,
    ) -> Result<Solution>;

    /// Tension σ(g) ≥ 0 at a gap.
    fn tension(&self, gap: Metre) -> Pascal;

    /// Energy v(g) ≤ 0 of an area at a gap, with σ = dv/dg.
    fn energy(&self, gap: Metre) -> JoulePerSquareMetre;

    /// Whether there is no tension. The contact then is the same, whatever contact came before it.
    fn is_hard(&self) -> bool;

    /// Whether the contact at each position of a pass begins with that at the position before.
    fn follows_path(&self) -> bool;

    /// Checks that this interface can be solved together with friction that sticks, rolling, sliding in place, plastic flow and ranks.
    ///
    /// # Errors
    /// [`Error::Unsupported`](crate::Error::Unsupported).
    fn check_combined(&self) -> Result<()>;

    /// Checks that passes can be solved with this interface: passes by a circular shift or in an overlap, with a shear that `displaces`
    /// the bodies normally or does not.
    ///
    /// # Errors
    /// [`Error::Unsupported`](crate::Error::Unsupported).
    fn check_passes(&self, is_shift: bool, displaces: bool, params: &Params) -> Result<()>;
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
    fn solve(
        &self,
        operator: &mut dyn Operator,
        gap: &Field,
        bounds: &Bounds,
        control: Control,
        before: Before<'_>,
        params: &Params,
        watch: &dyn Watch,
    ) -> Result<Solution> {
        let start = match before {
            Before::Apart => None,
            Before::Guess(pressure) => Some(pressure),
            Before::Contact(last) => Some(&last.pressure),
        };
        solve_normal_watched(operator, gap, bounds, control, start, params, watch)
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

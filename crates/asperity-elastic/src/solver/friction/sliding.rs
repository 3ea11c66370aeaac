//! Gross sliding: every cell slips, in one direction.

use crate::error::Result;
use crate::operator::CoupledOperator;
use crate::solver::friction::alternate::{Start, alternate};
use crate::solver::friction::{Friction, FrictionalProblem, FrictionalSolution, Tangential};
use crate::solver::{Interface, Stats};
use crate::units::Pascal;

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

/// Solves the contact of sliding bodies whose shear displaces them normally. The bounds of the `problem`
/// include the effect of the shear.
pub(in crate::solver) fn solve_sliding(
    operator: &mut dyn CoupledOperator,
    interface: &dyn Interface,
    sliding: &Sliding,
    problem: &FrictionalProblem<'_>,
) -> Result<FrictionalSolution> {
    let words = "a device does not solve sliding whose shear displaces the bodies normally";
    problem.normal.params.device.only_processor(words)?;
    let problem = FrictionalProblem { tangential: Tangential::Sliding(sliding.direction), ..*problem };
    let start = Start { pressure: problem.normal.before.pressure().cloned(), ..Start::default() };
    alternate(operator, interface, sliding.friction, &problem, start, &mut Stats::default())
}

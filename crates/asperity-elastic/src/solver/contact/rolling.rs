//! The solver of bodies in steady rolling.

use std::sync::Arc;

use crate::error::Result;
use crate::grid::Grid;
use crate::operator::{CoupledOperator, Operator};
use crate::solver::Interface;
use crate::solver::contact::{ContactProblem, ContactSolver, Equilibrium};
use crate::solver::friction::{Friction, Rolling, roll};

/// Contact in steady rolling, which does not depend on the contact before.
pub struct SteadyRolling {
    operator: Box<dyn CoupledOperator>,
    interface: Arc<dyn Interface>,
    friction: Friction,
    rolling: Rolling,
}

impl SteadyRolling {
    /// Creates the solver of bodies with this elastic response, interface and friction.
    pub fn new(
        operator: Box<dyn CoupledOperator>,
        interface: Arc<dyn Interface>,
        friction: Friction,
        rolling: Rolling,
    ) -> Self {
        Self { operator, interface, friction, rolling }
    }
}

impl ContactSolver for SteadyRolling {
    fn grid(&self) -> &Grid {
        self.operator.grid()
    }

    fn normal(&mut self) -> &mut dyn Operator {
        self.operator.normal()
    }

    fn solve(&mut self, problem: &ContactProblem<'_>) -> Result<Equilibrium> {
        let (operator, interface) = (self.operator.as_mut(), self.interface.as_ref());
        let problem = problem.frictional(interface, problem.bounds);
        roll(operator, interface, &self.friction, self.rolling, &problem)
            .map(|rolled| Equilibrium::Rolling(Box::new(rolled)))
    }
}

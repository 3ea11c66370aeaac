//! The solver of bodies in gross sliding.

use std::sync::Arc;

use crate::error::Result;
use crate::grid::Grid;
use crate::operator::{CoupledOperator, Operator};
use crate::solver::Interface;
use crate::solver::contact::{ContactProblem, ContactSolver, Equilibrium};
use crate::solver::friction::{Sliding, solve_sliding};

/// Contact in gross sliding.
pub struct GrossSliding {
    response: Response,
    interface: Arc<dyn Interface>,
    sliding: Sliding,
}

/// Elastic response of sliding bodies.
enum Response {
    /// The shear does not displace the surfaces normally: the pressure is that of bodies without friction.
    Normal(Box<dyn Operator>),
    /// The shear displaces the surfaces normally.
    Coupled(Box<dyn CoupledOperator>),
}

impl GrossSliding {
    /// Creates the solver of bodies whose shear does not displace them normally.
    pub fn uncoupled(operator: Box<dyn Operator>, interface: Arc<dyn Interface>, sliding: Sliding) -> Self {
        Self { response: Response::Normal(operator), interface, sliding }
    }

    /// Creates the solver of bodies whose shear displaces them normally.
    pub fn coupled(
        operator: Box<dyn CoupledOperator>,
        interface: Arc<dyn Interface>,
        sliding: Sliding,
    ) -> Self {
        Self { response: Response::Coupled(operator), interface, sliding }
    }
}

impl ContactSolver for GrossSliding {
    fn grid(&self) -> &Grid {
        match &self.response {
            Response::Normal(operator) => operator.grid(),
            Response::Coupled(operator) => operator.grid(),
        }
    }

    fn normal(&mut self) -> &mut dyn Operator {
        match &mut self.response {
            Response::Normal(operator) => operator.as_mut(),
            Response::Coupled(operator) => operator.normal(),
        }
    }

    fn solve(&mut self, problem: &ContactProblem<'_>) -> Result<Equilibrium> {
        let interface = self.interface.as_ref();
        let bounds = self.sliding.friction.sliding_bounds(problem.bounds);
        let solution = match &mut self.response {
            Response::Normal(operator) => {
                problem.normal(interface, &bounds).solve(operator.as_mut(), interface, problem.compliance)?
            }
            Response::Coupled(operator) => {
                let problem = problem.frictional(interface, &bounds);
                solve_sliding(operator.as_mut(), interface, &self.sliding, &problem)?.normal
            }
        };
        Ok(Equilibrium::Sliding(Box::new(solution), self.sliding))
    }
}

//! The solver of bodies that stick and slip.

use std::sync::Arc;

use crate::error::Result;
use crate::grid::Grid;
use crate::operator::{CoupledOperator, Operator};
use crate::solver::Interface;
use crate::solver::contact::{ContactProblem, ContactSolver, Equilibrium, Guess};
use crate::solver::friction::{Friction, solve_stick_slip};

/// Contact whose cells stick or slip.
pub struct StickSlip {
    operator: Box<dyn CoupledOperator>,
    interface: Arc<dyn Interface>,
    friction: Friction,
}

impl StickSlip {
    /// Creates the solver of bodies with this elastic response, interface and friction.
    pub fn new(
        operator: Box<dyn CoupledOperator>,
        interface: Arc<dyn Interface>,
        friction: Friction,
    ) -> Self {
        Self { operator, interface, friction }
    }
}

impl ContactSolver for StickSlip {
    fn grid(&self) -> &Grid {
        self.operator.grid()
    }

    fn normal(&mut self) -> &mut dyn Operator {
        self.operator.normal()
    }

    fn solve(&mut self, problem: &ContactProblem<'_>) -> Result<Equilibrium> {
        let before = problem.before.and_then(Equilibrium::frictional);
        let nearest = match problem.guess {
            Some(Guess::Contact(contact)) => contact.frictional(),
            _ => None,
        };
        let (operator, interface) = (self.operator.as_mut(), self.interface.as_ref());
        let contacts = [before, nearest.or(before)];
        let solution = solve_stick_slip(
            operator,
            interface,
            &self.friction,
            &problem.frictional(interface, problem.bounds),
            contacts,
            problem.drift,
        )?;
        Ok(Equilibrium::Frictional(Box::new(solution)))
    }

    fn sticks(&self) -> bool {
        true
    }
}

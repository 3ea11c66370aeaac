//! A contact of elastic bodies, solved step after step: the interface between them, and how they slip on each
//! other.

mod equilibrium;
mod rolling;
mod sliding;
mod stick_slip;

pub use equilibrium::Equilibrium;
pub use rolling::SteadyRolling;
pub use sliding::GrossSliding;
pub use stick_slip::StickSlip;

use std::sync::Arc;

use crate::error::Result;
use crate::grid::{CellValues, Field, Grid};
use crate::operator::Operator;
use crate::solver::friction::{FrictionalProblem, Loading};
use crate::solver::{Before, Bounds, Interface, NormalProblem, Params, Watch};

/// Solves contacts of two elastic bodies on one grid. Each implementation is one way in which the bodies slip
/// on each other: without friction, in gross sliding, with stick and slip, or in steady rolling.
pub trait ContactSolver: Send {
    /// The grid of the contact.
    fn grid(&self) -> &Grid;

    /// The normal response of the bodies.
    fn normal(&mut self) -> &mut dyn Operator;

    /// Solves a contact.
    ///
    /// # Errors
    /// The errors of [`solve_normal`](crate::solver::solve_normal), of the [`Interface`], and of
    /// [`solve_frictional`](crate::solver::solve_frictional) or
    /// [`solve_rolling`](crate::solver::solve_rolling).
    fn solve(&mut self, problem: &ContactProblem<'_>) -> Result<Equilibrium>;

    /// Whether the surfaces may stick, so that their tangential displacement changes the contact.
    fn sticks(&self) -> bool {
        false
    }
}

/// A contact to be solved.
#[derive(Clone, Copy)]
pub struct ContactProblem<'a> {
    /// The initial gap, m.
    pub gap: &'a Field,
    /// The bounds of the pressure of cells without shear.
    pub bounds: &'a Bounds,
    /// The prescribed loading. Its tangential part counts only for bodies that may stick.
    pub loading: Loading,
    /// The contact from which the bodies come; `None` if they come from afar.
    pub before: Option<&'a Equilibrium>,
    /// A contact or a pressure near the solution. It changes the cost alone.
    pub guess: Option<Guess<'a>>,
    /// Tangential displacement of the lower surface relative to the upper one since the contact before that
    /// is no slip, for example by plastic strain, m.
    pub drift: Option<&'a [Field; 2]>,
    /// Additional compliance of each cell under its own pressure, m/Pa, as of cells that lose height under
    /// it; `None` if there is none.
    pub compliance: Option<&'a CellValues>,
    /// The parameters of the solver.
    pub params: &'a Params,
    /// The watch of the computation.
    pub watch: &'a dyn Watch,
}

/// State near the solution of a contact.
#[derive(Debug, Clone, Copy)]
pub enum Guess<'a> {
    /// A pressure.
    Pressure(&'a Field),
    /// An equilibrium.
    Contact(&'a Equilibrium),
}

impl<'a> ContactProblem<'a> {
    /// Creates the problem of bodies that come from afar.
    pub fn new(
        gap: &'a Field,
        bounds: &'a Bounds,
        loading: Loading,
        params: &'a Params,
        watch: &'a dyn Watch,
    ) -> Self {
        let (before, guess, drift, compliance) = (None, None, None, None);
        Self { gap, bounds, loading, before, guess, drift, compliance, params, watch }
    }

    /// Returns the part without friction, with these bounds.
    fn normal(&self, interface: &dyn Interface, bounds: &'a Bounds) -> NormalProblem<'a> {
        let Self { gap, loading, params, watch, .. } = *self;
        let guess = self.guess.and_then(Guess::pressure).map(Before::Guess);
        let before = self.before.map(|before| Before::Contact(before.normal()));
        // Between hard walls the contact before is no more than a guess.
        let before = if interface.is_hard() { guess.or(before) } else { before.or(guess) };
        let before = before.unwrap_or(Before::Apart);
        NormalProblem { gap, bounds, control: loading.normal, before, params, watch }
    }

    /// Returns the problem with friction, with these bounds.
    fn frictional(&self, interface: &dyn Interface, bounds: &'a Bounds) -> FrictionalProblem<'a> {
        let normal = self.normal(interface, bounds);
        FrictionalProblem { normal, tangential: self.loading.tangential, compliance: self.compliance }
    }
}

impl<'a> Guess<'a> {
    /// Returns the pressure; `None` of a contact in which nothing is pressed.
    pub fn pressure(self) -> Option<&'a Field> {
        match self {
            Self::Pressure(pressure) => Some(pressure),
            Self::Contact(contact) => {
                Some(&contact.normal().pressure).filter(|pressure| pressure.iter().any(|p| *p > 0.0))
            }
        }
    }
}

/// Contact without friction.
pub struct Frictionless {
    operator: Box<dyn Operator>,
    interface: Arc<dyn Interface>,
}

impl Frictionless {
    /// Creates the solver of bodies with this elastic response and this interface.
    pub fn new(operator: Box<dyn Operator>, interface: Arc<dyn Interface>) -> Self {
        Self { operator, interface }
    }
}

impl ContactSolver for Frictionless {
    fn grid(&self) -> &Grid {
        self.operator.grid()
    }

    fn normal(&mut self) -> &mut dyn Operator {
        self.operator.as_mut()
    }

    fn solve(&mut self, problem: &ContactProblem<'_>) -> Result<Equilibrium> {
        let normal = problem.normal(self.interface.as_ref(), problem.bounds);
        let solution = normal.solve(self.operator.as_mut(), self.interface.as_ref(), problem.compliance)?;
        Ok(Equilibrium::Frictionless(Box::new(solution)))
    }
}

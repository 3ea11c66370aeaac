//! A contact in equilibrium, with friction or without.

use crate::solver::{FrictionalSolution, Solution};
use crate::units::Joule;

/// A contact in equilibrium.
#[derive(Debug, Clone)]
pub enum Equilibrium {
    /// The solution of a contact without friction.
    Frictionless(Box<Solution>),
    /// The solution of a contact with friction.
    Frictional(Box<FrictionalSolution>),
}

impl Equilibrium {
    /// Returns the solution of the normal problem: pressure, displacement and approach.
    pub fn normal(&self) -> &Solution {
        match self {
            Self::Frictionless(solution) => solution,
            Self::Frictional(solution) => &solution.normal,
        }
    }

    /// Returns the solution of both problems; none without friction.
    pub fn frictional(&self) -> Option<&FrictionalSolution> {
        match self {
            Self::Frictionless(_) => None,
            Self::Frictional(solution) => Some(solution),
        }
    }

    /// Elastic energy, J.
    pub fn elastic_energy(&self) -> Joule {
        match self {
            Self::Frictionless(solution) => solution.elastic_energy(),
            Self::Frictional(solution) => solution.elastic_energy(),
        }
    }
}

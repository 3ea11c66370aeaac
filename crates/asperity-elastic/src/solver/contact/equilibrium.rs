//! A contact in equilibrium, with friction or without.

use crate::grid::Field;
use crate::solver::{FrictionalSolution, RollingSolution, Sliding, Solution};
use crate::units::{Joule, Metre, Newton, SquareMetre};

/// A contact in equilibrium.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Equilibrium {
    /// A contact without friction.
    Frictionless(Box<Solution>),
    /// A contact in gross sliding.
    Sliding(Box<Solution>, Sliding),
    /// A contact whose cells stick or slip.
    Frictional(Box<FrictionalSolution>),
    /// A contact in steady rolling.
    Rolling(Box<RollingSolution>),
}

impl Equilibrium {
    /// The solution of the normal problem: pressure, displacement and approach.
    pub fn normal(&self) -> &Solution {
        match self {
            Self::Frictionless(solution) | Self::Sliding(solution, _) => solution,
            Self::Frictional(solution) => &solution.normal,
            Self::Rolling(solution) => &solution.contact.normal,
        }
    }

    /// The solution of the normal problem, to be changed.
    pub fn normal_mut(&mut self) -> &mut Solution {
        match self {
            Self::Frictionless(solution) | Self::Sliding(solution, _) => solution,
            Self::Frictional(solution) => &mut solution.normal,
            Self::Rolling(solution) => &mut solution.contact.normal,
        }
    }

    /// Returns the solution of the normal problem alone.
    pub fn into_normal(self) -> Solution {
        self.into_frictional().map_or_else(|solution| *solution, |solution| solution.normal)
    }

    /// Returns the contact with another initial gap.
    pub fn over(mut self, gap: &Field) -> Self {
        self.normal_mut().initial_gap.assign(gap);
        self
    }

    /// Returns the solution of both problems, or that of the normal one alone if no cell may stick.
    pub fn into_frictional(self) -> Result<FrictionalSolution, Box<Solution>> {
        match self {
            Self::Frictionless(solution) | Self::Sliding(solution, _) => Err(solution),
            Self::Frictional(solution) => Ok(*solution),
            Self::Rolling(solution) => Ok(solution.contact),
        }
    }

    /// Returns the solution of both problems; `None` if no cell may stick.
    pub fn frictional(&self) -> Option<&FrictionalSolution> {
        match self {
            Self::Frictionless(_) | Self::Sliding(..) => None,
            Self::Frictional(solution) => Some(solution),
            Self::Rolling(solution) => Some(&solution.contact),
        }
    }

    /// Returns the steady rolling; `None` of bodies that do not roll.
    pub fn rolling(&self) -> Option<&RollingSolution> {
        match self {
            Self::Rolling(solution) => Some(solution),
            _ => None,
        }
    }

    /// Returns the shear tractions along x and y on the lower body, Pa; `None` without friction.
    pub fn shear(&self) -> Option<[Field; 2]> {
        match self {
            Self::Frictionless(_) => None,
            Self::Sliding(solution, sliding) => {
                Some([0, 1].map(|axis| solution.pressure.mapv(|p| sliding.shear(p)[axis])))
            }
            Self::Frictional(_) | Self::Rolling(_) => {
                self.frictional().map(|solution| solution.shear.clone())
            }
        }
    }

    /// Returns the gross sliding; `None` of bodies that do not slide as a whole.
    pub fn sliding(&self) -> Option<&Sliding> {
        match self {
            Self::Sliding(_, sliding) => Some(sliding),
            _ => None,
        }
    }

    /// Returns the tangential force of the upper body on the lower one along x and y.
    pub fn force(&self) -> [Newton; 2] {
        let area = self.normal().grid.cell_area();
        self.shear().map_or([0.0; 2], |shear| shear.map(|q| area * q.sum()))
    }

    /// Rigid-body displacement of the upper body relative to the lower one along x and y; 0 if no cell may
    /// stick.
    pub fn rigid_displacement(&self) -> [Metre; 2] {
        self.frictional().map_or([0.0; 2], |solution| solution.rigid_displacement)
    }

    /// Area of the cells that stick.
    pub fn stick_area(&self) -> SquareMetre {
        let sticking = self.frictional().map_or(0.0, |solution| solution.stick.sum());
        self.normal().grid.cell_area() * sticking
    }

    /// Slip of the upper surface over the lower one along x and y since the contact before, m; `None` if no
    /// cell may stick.
    pub fn slip(&self) -> Option<&[Field; 2]> {
        self.frictional().map(|solution| &solution.slip)
    }

    /// Returns the energy dissipated by friction in a contact whose cells may stick, and the bound of its
    /// error; see [`FrictionalSolution::dissipation`] since the contact `before`, and
    /// [`RollingSolution::dissipation`], whose error is not known. The error of a first contact is not known
    /// either, and is left out.
    pub fn dissipation(&self, before: Option<&Self>) -> [Joule; 2] {
        match self {
            Self::Frictionless(_) | Self::Sliding(..) => [0.0; 2],
            Self::Rolling(rolled) => [rolled.dissipation, 0.0],
            Self::Frictional(solution) => {
                let before = before.and_then(Self::frictional);
                let error = before.map_or(0.0, |before| solution.dissipation_error(before));
                [solution.dissipation(before), error]
            }
        }
    }

    /// Returns the elastic energy, J, without that of the shear of gross sliding.
    pub fn elastic_energy(&self) -> Joule {
        match self.frictional() {
            None => self.normal().elastic_energy(),
            Some(solution) => solution.elastic_energy(),
        }
    }
}

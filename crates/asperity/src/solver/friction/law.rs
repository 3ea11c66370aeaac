//! How much shear a cell bears.

use crate::error::{Result, check};
use crate::material::Compliances;
use crate::units::Pascal;

/// How normal and tangential displacements are coupled where the bodies are dissimilar.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Coupling {
    /// As elasticity has it: pressure displaces tangentially, shear displaces normally.
    #[default]
    Full,
    /// Goodman's approximation: pressure displaces tangentially, shear leaves the pressure alone.
    Goodman,
    /// Neither, as for identical bodies.
    None,
}

impl Coupling {
    /// Whether shear displaces the surface normally.
    pub(super) fn lifts(self, compliances: &Compliances) -> bool {
        self == Self::Full && compliances.coupling != 0.0
    }

    /// Whether pressure displaces the surface tangentially.
    pub(super) fn slips(self, compliances: &Compliances) -> bool {
        self != Self::None && compliances.coupling != 0.0
    }
}

/// Friction in each cell: |q| ≤ min(μp, τ), in any direction of the plane.
///
/// Where |q| is less the bodies stick; where it is that much they may slip, and q on the lower body points where the upper
/// one slips to.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Friction {
    /// Coefficient of friction μ ≥ 0; infinite where the bodies stick wherever they touch.
    pub coefficient: f64,
    /// Shear strength τ > 0 of the interface, as of a boundary film; infinite without.
    pub shear_strength: Pascal,
    /// The coupling of normal and tangential displacements.
    pub coupling: Coupling,
}

impl Friction {
    /// Coulomb's law.
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] for a negative coefficient.
    pub fn coulomb(coefficient: f64) -> Result<Self> {
        Self { coefficient, shear_strength: Pascal::INFINITY, coupling: Coupling::Full }.checked()
    }

    /// The same, if its numbers have a meaning.
    pub(crate) fn checked(self) -> Result<Self> {
        check("friction coefficient", self.coefficient, self.coefficient >= 0.0, "a number of at least 0")?;
        check("shear strength", self.shear_strength, self.shear_strength > 0.0, "a stress above 0")?;
        Ok(self)
    }

    /// The most shear that a cell under `pressure` bears.
    pub fn bound(&self, pressure: Pascal) -> Pascal {
        if pressure > 0.0 { (self.coefficient * pressure).min(self.shear_strength) } else { 0.0 }
    }
}

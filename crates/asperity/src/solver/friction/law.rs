//! The law of friction: the most shear that a cell bears under its pressure.

use crate::choice::choice;
use crate::error::{Result, check, check_in};
use crate::solver::Bounds;
use crate::units::{Dimension, Pascal};

/// How normal and tangential displacements are coupled where the bodies are dissimilar.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Coupling {
    /// As elasticity has it: pressure displaces tangentially, shear displaces normally.
    #[default]
    Full,
    /// Goodman's approximation: pressure displaces tangentially, shear leaves the pressure alone.
    Goodman,
    /// No coupling, as between identical bodies: pressure displaces normally, shear tangentially.
    None,
}

choice!(Coupling: "full" => Full, "goodman" => Goodman, "none" => None);

impl Coupling {
    /// Whether shear displaces the surface normally.
    pub(super) fn shear_displaces_normally(self, couples: bool) -> bool {
        self == Self::Full && couples
    }

    /// Whether pressure displaces the surface tangentially.
    pub(super) fn pressure_displaces_tangentially(self, couples: bool) -> bool {
        self != Self::None && couples
    }
}

/// Friction in each cell: |q| ≤ min(μp, τ), in any direction of the plane.
///
/// Where |q| is less the bodies stick; where it is that much they may slip, and q on the lower body points where the upper
/// one slips to.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Friction {
    /// Coefficient of friction μ ≥ 0; infinite where the bodies stick wherever they touch.
    pub coefficient: f64,
    /// Shear strength τ > 0 of the interface, as of a boundary film; infinite without.
    pub shear_strength: Pascal,
    /// The coupling of normal and tangential displacements.
    pub coupling: Coupling,
    /// Weight α ≥ 0 of the shear in what a plastic cell bears, p² + αq² ≤ H²: under shear it bears less pressure, and the
    /// contact grows. 0: the hardness limits the pressure alone. Tabor, Proc. R. Soc. A 251, 378 (1959), found α near 9
    /// for metals; a criterion after von Mises or Tresca has 27 or 36, where H is three times the yield stress.
    pub junction_growth: f64,
}

impl Friction {
    /// Coulomb's law.
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] for a negative coefficient.
    pub fn coulomb(coefficient: f64) -> Result<Self> {
        let (shear_strength, coupling) = (Pascal::INFINITY, Coupling::Full);
        Self { coefficient, shear_strength, coupling, junction_growth: 0.0 }.checked()
    }

    /// The same with another coefficient of friction μ ≥ 0.
    #[must_use]
    pub const fn with_coefficient(self, coefficient: f64) -> Self {
        Self { coefficient, ..self }
    }

    /// The same with a shear strength τ of the interface, > 0.
    #[must_use]
    pub const fn with_shear_strength(self, shear_strength: Pascal) -> Self {
        Self { shear_strength, ..self }
    }

    /// The same with another coupling of normal and tangential displacements.
    #[must_use]
    pub const fn with_coupling(self, coupling: Coupling) -> Self {
        Self { coupling, ..self }
    }

    /// The same with a weight α ≥ 0 of the shear in what a plastic cell bears.
    #[must_use]
    pub const fn with_junction_growth(self, junction_growth: f64) -> Self {
        Self { junction_growth, ..self }
    }

    /// The same law, if its numbers have a meaning.
    pub(crate) fn checked(self) -> Result<Self> {
        check("friction coefficient", self.coefficient, self.coefficient >= 0.0, "a number of at least 0")?;
        check_in(
            Dimension::Pressure,
            "shear strength",
            self.shear_strength,
            self.shear_strength > 0.0,
            "a stress above 0",
        )?;
        let alpha = self.junction_growth;
        check(
            "junction growth",
            alpha,
            (0.0..f64::INFINITY).contains(&alpha),
            "a finite weight of at least 0",
        )?;
        Ok(self)
    }

    /// The most shear that a cell under `pressure` bears.
    pub fn shear_limit(&self, pressure: Pascal) -> Pascal {
        if pressure > 0.0 { (self.coefficient * pressure).min(self.shear_strength) } else { 0.0 }
    }

    /// Whether the junctions of bodies of that hardness grow: shear makes their plastic cells bear less pressure.
    pub(super) fn grows_junctions(&self, hardness: Pascal) -> bool {
        self.junction_growth > 0.0 && self.coefficient > 0.0 && hardness.is_finite()
    }

    /// The same friction of bodies whose cells bear no more shear than they do without pressure, H/√α.
    pub(super) fn within(self, hardness: Pascal) -> Self {
        let shear_strength = self.shear_strength.min(hardness / self.junction_growth.sqrt());
        Self { shear_strength, ..self }
    }

    /// The most pressure that a cell bears beside its `shear`, where p² + αq² = H²: from a `pressure` that does not meet
    /// this yet, halfway between the answer of a cell whose shear stays and that of one whose shear changes in proportion.
    /// No less than a cell bears that slides.
    pub(super) fn cap(&self, hardness: Pascal, pressure: Pascal, shear: Pascal) -> Pascal {
        let square = self.junction_growth * shear * shear;
        if pressure <= 0.0 || square == 0.0 {
            return hardness;
        }
        let stays = (hardness * hardness - square).max(0.0).sqrt();
        let changes = hardness / (1.0 + square / (pressure * pressure)).sqrt();
        (0.5 * (stays + changes)).max(self.sliding_cap(hardness))
    }

    /// What the shear of bodies that slide leaves of their `bounds`: see [`Friction::sliding_cap`].
    pub fn sliding_bounds(&self, bounds: &Bounds) -> Bounds {
        Bounds::up_to(bounds.upper().map(|hardness| self.sliding_cap(hardness))).above(bounds.lower().clone())
    }

    /// The most pressure that a cell of that hardness bears that slides.
    pub fn sliding_cap(&self, hardness: Pascal) -> Pascal {
        if !self.grows_junctions(hardness) {
            return hardness;
        }
        let coulomb = hardness / (1.0 + self.junction_growth * self.coefficient.powi(2)).sqrt();
        let film = self.shear_strength;
        if self.coefficient * coulomb <= film {
            coulomb
        } else {
            (hardness * hardness - self.junction_growth * film * film).sqrt()
        }
    }
}

//! The law of friction: the largest shear of a cell under its pressure.

use serde::Serialize;

use crate::error::Result;
use crate::solver::Bounds;
use crate::units::{Pascal, or_inf};
use asperity_base::choice::choice;
use asperity_base::exists;
use asperity_base::table::Part as _;
use asperity_derive::Part;

/// Coupling of normal and tangential displacements between dissimilar bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Coupling {
    /// Full elastic coupling: pressure displaces tangentially, and shear displaces normally.
    #[default]
    Full,
    /// Goodman's approximation: pressure displaces tangentially, but shear does not change the pressure.
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
/// A cell with a smaller |q| sticks. A cell at the limit may slip, and q on the lower body points in the
/// direction of the slip of the upper body.
#[derive(Part, Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Friction {
    /// Coefficient of friction μ.
    ///
    /// At least 0; infinite if touching bodies always stick.
    #[key(number = "a number", range = FromZeroOrInfinite("nothing slips"), example = "0.3", exists = exists::FRICTION)]
    #[serde(serialize_with = "or_inf")]
    pub coefficient: f64,
    /// Coupling between dissimilar bodies: `"goodman"`, pressure displaces tangentially, but shear does not
    /// displace normally; `"none"`, neither.
    #[key(choice, default = Coupling::Full, example = "\"none\"")]
    pub coupling: Coupling,
    /// τ, the largest shear stress of the interface under any pressure, for example of a boundary film.
    #[key(
        quantity = Pressure,
        range = AboveZeroOrInfinite("no limit"),
        default = Pascal::INFINITY,
        written = "inf",
        example = "\"20 MPa\"",
        exists = exists::SHEAR_STRENGTH
    )]
    #[serde(serialize_with = "or_inf")]
    pub shear_strength: Pascal,
    /// α in p² + αq² ≤ H²: shear lowers the cap of the pressure, and the contact grows; about 9 for metals.
    ///
    /// The yield condition of a plastic cell. With α = 0 the hardness limits only the pressure. Tabor, Proc.
    /// R. Soc. A 251, 378 (1959), found α near 9 for metals. The criteria of von Mises and Tresca give 27 and
    /// 36 if H is three times the yield stress.
    #[key(number = "a number", range = FromZero, default = 0.0, written = "0", example = "9")]
    pub junction_growth: f64,
}

impl Friction {
    /// Creates Coulomb's law.
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] for a negative coefficient.
    pub fn coulomb(coefficient: f64) -> Result<Self> {
        let (shear_strength, coupling) = (Pascal::INFINITY, Coupling::Full);
        Self { coefficient, shear_strength, coupling, junction_growth: 0.0 }.checked()
    }

    /// Sets the coefficient of friction μ ≥ 0.
    #[must_use]
    pub const fn with_coefficient(self, coefficient: f64) -> Self {
        Self { coefficient, ..self }
    }

    /// Sets the shear strength τ of the interface, > 0.
    #[must_use]
    pub const fn with_shear_strength(self, shear_strength: Pascal) -> Self {
        Self { shear_strength, ..self }
    }

    /// Sets the coupling of normal and tangential displacements.
    #[must_use]
    pub const fn with_coupling(self, coupling: Coupling) -> Self {
        Self { coupling, ..self }
    }

    /// Sets the weight α ≥ 0 of the shear in the yield condition of plastic cells.
    #[must_use]
    pub const fn with_junction_growth(self, junction_growth: f64) -> Self {
        Self { junction_growth, ..self }
    }

    /// Returns the law if its numbers are in range.
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] for a number out of its range.
    pub fn checked(self) -> Result<Self> {
        self.check().map(|()| self)
    }

    /// Returns the largest shear of a cell under `pressure`.
    pub fn shear_limit(&self, pressure: Pascal) -> Pascal {
        if pressure > 0.0 { (self.coefficient * pressure).min(self.shear_strength) } else { 0.0 }
    }

    /// Whether the junctions of bodies with this hardness grow: shear lowers the pressure of their plastic
    /// cells.
    pub(super) fn grows_junctions(&self, hardness: Pascal) -> bool {
        self.junction_growth > 0.0 && self.coefficient > 0.0 && hardness.is_finite()
    }

    /// Returns this friction with the largest shear of plastic cells without pressure, H/√α.
    pub(super) fn within(self, hardness: Pascal) -> Self {
        let shear_strength = self.shear_strength.min(hardness / self.junction_growth.sqrt());
        Self { shear_strength, ..self }
    }

    /// Returns the largest pressure of a cell under `shear`, from p² + αq² = H². For a `pressure` that does
    /// not satisfy this yet, it returns the mean of the solutions at constant shear and at a shear in
    /// proportion to the pressure. The result is at least the cap of a sliding cell.
    pub(super) fn cap(&self, hardness: Pascal, pressure: Pascal, shear: Pascal) -> Pascal {
        let square = self.junction_growth * shear * shear;
        if pressure <= 0.0 || square == 0.0 {
            return hardness;
        }
        let stays = (hardness * hardness - square).max(0.0).sqrt();
        let changes = hardness / (1.0 + square / (pressure * pressure)).sqrt();
        (0.5 * (stays + changes)).max(self.sliding_cap(hardness))
    }

    /// Returns the `bounds` of sliding bodies under their shear, see [`Friction::sliding_cap`].
    pub fn sliding_bounds(&self, bounds: &Bounds) -> Bounds {
        Bounds::up_to(bounds.upper().map(|hardness| self.sliding_cap(hardness))).above(bounds.lower().clone())
    }

    /// Returns the largest pressure of a sliding cell with this hardness.
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

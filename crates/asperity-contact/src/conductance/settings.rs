//! Spots, film and gas between the bodies.

use crate::error::{Error, Result, check_in};
use crate::units::{Dimension, Metre};
use asperity_base::choice::choice;

/// Heat or current through a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Kind {
    /// Heat: conductivities in W/(m K), drops in K, conductances in W/K.
    #[default]
    Thermal,
    /// Current: conductivities in S/m, drops in V, conductances in S.
    Electrical,
}

choice!(Kind: "thermal" => Thermal, "electrical" => Electrical);

impl Kind {
    /// Dimension of a conductivity.
    pub fn conductivity(self) -> Dimension {
        match self {
            Self::Thermal => Dimension::Conductivity,
            Self::Electrical => Dimension::ElectricalConductivity,
        }
    }

    /// Dimension of the resistance of an area.
    pub fn insulance(self) -> Dimension {
        match self {
            Self::Thermal => Dimension::ThermalInsulance,
            Self::Electrical => Dimension::ElectricalInsulance,
        }
    }
}

/// Gas in the gap between the bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gas {
    /// Conductivity κ_g > 0, W/(m K).
    pub conductivity: f64,
    /// Temperature jump distance M ≥ 0 of both surfaces together, m: a gap g of gas has the resistance (g + M)/κ_g of an area.
    pub jump: Metre,
}

/// The joint between the bodies: spots, a film on them, and gas around them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Joint {
    /// Whether heat or current passes.
    pub kind: Kind,
    /// Composite conductivity κ_s > 0 of the bodies, see [`super::composite_conductivity`], W/(m K) or S/m. It enters the
    /// estimate of Holm and Greenwood; the solution has it from the operator.
    pub composite: f64,
    /// Resistance ρ_f ≥ 0 of an area of the film on the spots, m² K/W or Ω m²; 0 without a film.
    pub film: f64,
    /// Gas in the gap, for heat alone; without it open cells do not conduct.
    pub gas: Option<Gas>,
}

impl Joint {
    /// Clean spots between bodies of this composite conductivity κ_s, W/(m K) or S/m, with nothing between them.
    pub const fn new(kind: Kind, composite: f64) -> Self {
        Self { kind, composite, film: 0.0, gas: None }
    }

    /// Covers the spots with a film of this resistance of an area, ≥ 0, m² K/W or Ω m².
    #[must_use]
    pub const fn with_film(self, film: f64) -> Self {
        Self { film, ..self }
    }

    /// Fills the gap with a gas.
    #[must_use]
    pub const fn with_gas(self, gas: Gas) -> Self {
        Self { gas: Some(gas), ..self }
    }

    /// Checks the numbers.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a number outside its range, [`Error::Unsupported`] for gas between electrical conductors.
    pub fn check(&self) -> Result<()> {
        let Self { kind, composite, film, gas } = *self;
        let positive = |value: f64| value > 0.0 && value.is_finite();
        let not_negative = |value: f64| value >= 0.0 && value.is_finite();
        let bulk = kind.conductivity();
        let expected = "a finite conductivity above 0";
        check_in(bulk, "composite conductivity", composite, positive(composite), expected)?;
        let least = "a finite resistance of an area of at least 0";
        check_in(kind.insulance(), "film", film, not_negative(film), least)?;
        let Some(Gas { conductivity, jump }) = gas else { return Ok(()) };
        check_in(bulk, "conductivity of the gas", conductivity, positive(conductivity), expected)?;
        let expected = "a finite temperature jump distance of at least 0";
        check_in(Dimension::Length, "jump", jump, not_negative(jump), expected)?;
        match kind {
            Kind::Thermal => Ok(()),
            Kind::Electrical => Err(Error::Unsupported("gas conducts heat, but no current")),
        }
    }
}

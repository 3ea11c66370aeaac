//! The table `[conductance]`: spots, film and gas between the bodies.

use serde::Serialize;

use crate::error::{Error, Result, check_in};
use crate::units::{Dimension, Metre};
use asperity_base::choice::choice;
use asperity_base::table::Exists;
use asperity_derive::Table;

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

    /// Dimension of a conductance.
    pub fn conductance(self) -> Dimension {
        match self {
            Self::Thermal => Dimension::ThermalConductance,
            Self::Electrical => Dimension::ElectricalConductance,
        }
    }

    /// Dimension of the difference between the bodies.
    pub fn drop(self) -> Dimension {
        match self {
            Self::Thermal => Dimension::TemperatureDifference,
            Self::Electrical => Dimension::Voltage,
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

/// The joint between the bodies: spots, a film on them, and gas around them; and which joints of a case are
/// computed.
#[derive(Table, Debug, Clone, Copy, PartialEq, Serialize)]
#[table("conductance")]
#[non_exhaustive]
pub struct Joint {
    /// Whether heat or current passes: bodies need `conductivity` or `resistivity`.
    #[key(choice, default = Kind::Thermal, example = "\"electrical\"")]
    pub kind: Kind,
    /// Resistance of a film on the spots, of an area.
    ///
    /// ρ_f ≥ 0, m² K/W or Ω m².
    #[key(
        quantity = kind.insulance(),
        form = "resistance of an area ≥ 0, such as \"1e-8 m2 K/W\"; \"1e-12 ohm m2\" with `kind = \"electrical\"`",
        range = FromZero,
        absent = "none",
        example = "\"1e-8 m2 K/W\""
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub film: Option<f64>,
    /// Thermal conductivity of a gas in the gap.
    ///
    /// κ_g > 0, W/(m K); without it open cells do not conduct.
    #[key(
        quantity = Conductivity,
        range = AboveZero,
        absent = "none",
        example = "\"0.026 W/(m K)\"",
        exists = GAS
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gas: Option<f64>,
    /// Temperature jump distance of the gas at both surfaces together, which adds to the gap.
    ///
    /// M ≥ 0: a gap g of gas has the resistance (g + M)/κ_g of an area.
    #[key(quantity = Length, range = FromZero, default = 0.0, example = "\"0.37 um\"", exists = JUMP)]
    #[serde(skip_serializing_if = "is_zero")]
    pub jump: Metre,
    /// Difference between the bodies; it scales flux and power, nothing else.
    ///
    /// > 0, K or V.
    #[key(
        quantity = kind.drop(),
        form = "temperature difference > 0, such as \"10 K\"; \"0.1 V\" with `kind = \"electrical\"`",
        range = AboveZero,
        default = 1.0,
        absent = "1 K, or 1 V",
        example = "\"10 K\""
    )]
    pub drop: f64,
    /// Interval of the positions of a pass, or of the increments, updates or points, whose conductance is
    /// computed; 0: once a pass, where the left edges are flush, or for the last contact alone.
    #[key(count = 0, default = 1, example = "4")]
    pub every: usize,
}

/// Conductivities of gases at atmospheric pressure.
const GAS: Exists =
    Exists::Within { least: 1e-3, most: 1.0, of: "heavy vapours to hydrogen", slips: &["mW/(m K)"] };
/// Temperature jump distances.
const JUMP: Exists =
    Exists::Within { least: 1e-9, most: 1.0, of: "compressed to rarefied gases", slips: &["um", "nm"] };

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

impl Joint {
    /// Clean spots with nothing between them.
    pub const fn new(kind: Kind) -> Self {
        Self { kind, film: None, gas: None, jump: 0.0, drop: 1.0, every: 1 }
    }

    /// Covers the spots with a film of this resistance of an area, ≥ 0, m² K/W or Ω m².
    #[must_use]
    pub const fn with_film(self, film: f64) -> Self {
        Self { film: Some(film), ..self }
    }

    /// Fills the gap with a gas of this conductivity, W/(m K), and this temperature jump distance, m.
    #[must_use]
    pub const fn with_gas(self, conductivity: f64, jump: Metre) -> Self {
        Self { gas: Some(conductivity), jump, ..self }
    }

    /// Checks the numbers.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a number outside its range, [`Error::Unsupported`] for gas between
    /// electrical conductors.
    pub fn check(&self) -> Result<()> {
        let Self { kind, film, gas, jump, .. } = *self;
        let not_negative = |value: f64| value >= 0.0 && value.is_finite();
        let film = film.unwrap_or(0.0);
        let least = "a finite resistance of an area of at least 0";
        check_in(kind.insulance(), "film", film, not_negative(film), least)?;
        let Some(conductivity) = gas else { return Ok(()) };
        let is_good = conductivity > 0.0 && conductivity.is_finite();
        let expected = "a finite conductivity above 0";
        check_in(kind.conductivity(), "conductivity of the gas", conductivity, is_good, expected)?;
        let expected = "a finite temperature jump distance of at least 0";
        check_in(Dimension::Length, "jump", jump, not_negative(jump), expected)?;
        match kind {
            Kind::Thermal => Ok(()),
            Kind::Electrical => Err(Error::Unsupported("gas conducts heat, but no current")),
        }
    }
}

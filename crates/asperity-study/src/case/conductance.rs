//! The table `[conductance]`: requested conductance of the contacts.

use serde::Serialize;

use super::cursor::{Entry, Table};
use super::schema::passage::conductance as keys;
use super::schema::tables::known_in;
use super::{Body, Case};
use asperity_base::error::Result;
use asperity_base::units::{Dimension, Metre};
use asperity_contact::conductance::{Conductor, Gas, Joint, Kind, composite_conductivity};

/// Requested conductance of the contacts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ConductanceSpec {
    /// Whether heat or current passes.
    pub kind: Kind,
    /// Resistance of a film on the spots, of an area, ≥ 0, m² K/W or Ω m²; `None` without a film.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub film: Option<f64>,
    /// Thermal conductivity of the gas in the gap, > 0, W/(m K); `None` without gas.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gas: Option<f64>,
    /// Temperature jump distance of the gas, ≥ 0.
    #[serde(skip_serializing_if = "is_zero")]
    pub jump: Metre,
    /// Difference between the bodies, > 0, K or V.
    pub drop: f64,
    /// Interval of the contacts whose conductance is computed; 0 for one contact of each pass, or the last contact.
    pub every: usize,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// Reads the table.
pub(super) fn conductance(table: &Table<'_>) -> Result<ConductanceSpec> {
    known_in(table)?;
    let kind = keys::KIND.of(table)?;
    let [resistance, difference] = match kind {
        Kind::Thermal => [Dimension::ThermalInsulance, Dimension::TemperatureDifference],
        Kind::Electrical => [Dimension::ElectricalInsulance, Dimension::Voltage],
    };
    let film = keys::FILM.entry(table).map(|entry| resistance_of_film(&entry, resistance)).transpose()?;
    let drop = keys::DROP.entry(table).map(|entry| positive(&entry, difference)).transpose()?;
    Ok(ConductanceSpec {
        kind,
        film,
        gas: keys::GAS.of(table)?,
        jump: keys::JUMP.of(table)?,
        drop: drop.unwrap_or(1.0),
        every: keys::EVERY.of(table)?,
    })
}

fn resistance_of_film(entry: &Entry<'_>, dimension: Dimension) -> Result<f64> {
    let value = entry.quantity(dimension)?;
    let is_valid = value == 0.0 || dimension.range().holds(value);
    let expected = format!("{} of at least 0 such as \"{}\"", dimension.noun(), dimension.example());
    if is_valid { Ok(value) } else { Err(entry.unexpected(&expected, None)) }
}

fn positive(entry: &Entry<'_>, dimension: Dimension) -> Result<f64> {
    let value = entry.quantity(dimension)?;
    let expected = format!("{} above 0 such as \"{}\"", dimension.noun(), dimension.example());
    if dimension.range().holds(value) { Ok(value) } else { Err(entry.unexpected(&expected, None)) }
}

impl ConductanceSpec {
    /// Returns what conducts between bodies of this composite conductivity.
    pub(crate) fn joint(&self, composite: f64) -> Joint {
        let joint = Joint::new(self.kind, composite).with_film(self.film.unwrap_or(0.0));
        match self.gas {
            Some(conductivity) => joint.with_gas(Gas { conductivity, jump: self.jump }),
            None => joint,
        }
    }
}

impl Body {
    /// Conductivity of the body, W/(m K) or S/m; `None` if it is unknown.
    pub fn conductivity_of(&self, kind: Kind) -> Option<f64> {
        match kind {
            Kind::Thermal => self.thermal.map(|thermal| thermal.conductivity).or(self.conductivity),
            Kind::Electrical => self.resistivity.map(f64::recip),
        }
    }

    /// Returns how the body conducts, with its coating; `None` if a conductivity is unknown.
    pub(crate) fn conductor(&self, kind: Kind) -> Option<Result<Conductor>> {
        let base = Conductor::new(self.conductivity_of(kind)?);
        let Some(coating) = self.material.coating else { return Some(base) };
        let conductivity = match kind {
            Kind::Thermal => coating.conductivity?,
            Kind::Electrical => coating.resistivity?.recip(),
        };
        Some(base.and_then(|base| base.coated(coating.thickness, conductivity)))
    }
}

impl Case {
    /// Composite conductivity of the bodies without their coatings, W/(m K) or S/m; `None` if one is unknown.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] if both conduct without limit.
    pub(crate) fn composite_conductivity(&self, kind: Kind) -> Option<Result<f64>> {
        let [lower, upper] = [&self.lower, &self.upper].map(|body| body.conductivity_of(kind));
        Some(composite_conductivity(lower?, upper?))
    }
}

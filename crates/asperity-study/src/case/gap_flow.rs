//! The table `[flow]`: requested flow through the gap.

use serde::Serialize;

use super::cursor::Table;
use super::schema::passage::flow as keys;
use super::schema::tables::known_in;
use asperity_base::error::Result;
use asperity_base::units::{Pascal, PascalSecond};
use asperity_contact::flow::{Along, Ends, Fluid};
use asperity_contact::operator::Boundary;

/// Requested flow through the gap.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct GapFlowSpec {
    /// Viscosity of the fluid, > 0.
    pub viscosity: PascalSecond,
    /// Pressure difference, ≥ 0.
    pub pressure: Pascal,
    /// Directions of the flow.
    pub along: Along,
    /// How the gap goes on beyond the grid along the flow; `None` for what the boundary does along that axis.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ends: Option<Ends>,
    /// Whether the fluid is an ideal gas.
    pub gas: bool,
    /// Absolute pressure of a gas at the outlet; `None` for a liquid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outlet: Option<Pascal>,
    /// Interval of the contacts whose flow is computed; 0 for one contact of each pass, or the last contact.
    pub every: usize,
}

impl GapFlowSpec {
    /// Returns the fluid with the difference of its pressure.
    pub fn fluid(&self) -> Fluid {
        Fluid { viscosity: self.viscosity, drop: self.pressure, outlet: self.outlet }
    }

    /// Returns how the gap of a contact with this boundary goes on beyond the grid, for a flow along `axis`.
    pub fn ends_along(&self, axis: usize, boundary: Boundary) -> Ends {
        let by_boundary = if boundary.repeats(axis) { Ends::Periodic } else { Ends::Reservoirs };
        self.ends.unwrap_or(by_boundary)
    }
}

/// Reads the table.
pub(super) fn flow(table: &Table<'_>) -> Result<GapFlowSpec> {
    known_in(table)?;
    Ok(GapFlowSpec {
        viscosity: keys::VISCOSITY.of(table)?,
        pressure: keys::PRESSURE.of(table)?,
        along: keys::ALONG.of(table)?,
        ends: keys::ENDS.of(table)?,
        gas: keys::GAS.of(table)?,
        outlet: keys::OUTLET.of(table)?,
        every: keys::EVERY.of(table)?,
    })
}

//! The table `[flow]`: requested flow through the gap.

use serde::Serialize;

use super::cursor::Table;
use super::schema::passage::flow as keys;
use super::schema::tables::known_in;
use crate::error::Result;
use crate::flow::{Along, Ends};
use crate::operator::Boundary;
use crate::units::{Pascal, PascalSecond};

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
    /// How the gap goes on beyond the grid along the flow.
    pub ends: Ends,
    /// Whether the fluid is an ideal gas.
    pub gas: bool,
    /// Absolute pressure of a gas at the outlet.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outlet: Option<Pascal>,
    /// Interval of the contacts whose flow is computed; 0 for one contact of each pass, or the last contact.
    pub every: usize,
}

/// Reads the table of a case with this boundary.
pub(super) fn flow(table: &Table<'_>, boundary: Boundary) -> Result<GapFlowSpec> {
    known_in(table)?;
    let periodic = boundary.repeats(0) && boundary.repeats(1);
    let ends = if periodic { Ends::Periodic } else { Ends::Reservoirs };
    Ok(GapFlowSpec {
        viscosity: keys::VISCOSITY.of(table)?,
        pressure: keys::PRESSURE.of(table)?,
        along: keys::ALONG.of(table)?,
        ends: keys::ENDS.of(table)?.unwrap_or(ends),
        gas: keys::GAS.of(table)?,
        outlet: keys::OUTLET.of(table)?,
        every: keys::EVERY.of(table)?,
    })
}

//! Flow of a fluid through the gap of the contacts of a case.

use serde::{Deserialize, Serialize};

use super::{Observer, Place};
use crate::error::{Error, Result};
use crate::flow::{self, FlowAlong, Settings, Sides};
use crate::motion::{Column, ObservedContact, columns};
use crate::study::case::{Case, GapFlowSpec};
use crate::study::fields::NamedField;
use crate::study::tables::Record;
use crate::units::{CubicMetre, CubicMetrePerSecond, Metre, Newton, Pascal, SquareMetre};

/// Axis along which the pressure of the fluid falls.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FlowAxis {
    /// Along x.
    X,
    /// Along y.
    Y,
}

columns! {
    /// The flow through the gap of a contact under a gradient of pressure along one axis, a row of `flow.csv`; in `summary.json` of the
    /// last contact.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct GapFlowRecord {
        /// Pass of a motion, from 1; left out of a static contact.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub pass: Option<usize>,
        /// Position in the pass, increment, point (each from 1) or update (from 0).
        pub step: usize,
        /// Direction of the gradient of pressure: `x` or `y`.
        pub along: FlowAxis,
        /// Length of the contact along this axis.
        pub length: Metre,
        /// Load.
        pub load: Newton,
        /// Mean pressure over the apparent area.
        pub mean_pressure: Pascal,
        /// Real area of contact.
        pub contact_area: SquareMetre,
        /// Mean gap over all cells, 0 in contact.
        pub mean_gap: Metre,
        /// Permeability K: the mean flux per width is K over 12 times the viscosity, times the mean gradient of pressure.
        pub permeability: CubicMetre,
        /// Permeability that gives the mean flux across the gradient; unknown where it is not computed.
        pub permeability_across: Option<CubicMetre>,
        /// Gap between parallel plates of this permeability.
        pub hydraulic_gap: Metre,
        /// Permeability over the cube of the mean gap.
        pub flow_factor: f64,
        /// Volume that leaks in a unit of time under the pressure difference; of a gas at the pressure of the outlet.
        pub leakage: CubicMetrePerSecond,
        /// Critical constriction: the largest gap that all cells of some path reach; 0 without a path.
        pub critical_gap: Metre,
        /// x of the critical constriction; unknown without a path.
        pub critical_x: Option<Metre>,
        /// y of the critical constriction; unknown without a path.
        pub critical_y: Option<Metre>,
        /// Width of the critical constriction across the gradient in cells; 0 without a path.
        pub critical_cells: usize,
        /// Share of the cells that are part of a path.
        pub flowing_share: f64,
        /// Volume in open cells from which no path leads out.
        pub trapped_volume: CubicMetre,
        /// Permeability of the effective medium of Bruggeman with these gaps, a comparison.
        pub effective_medium: CubicMetre,
        /// Estimate of the relative error of the permeability by the grid.
        pub estimate: f64,
        /// Largest relative difference of the flux through a section from the mean of all sections.
        pub residual: f64,
    }
}

impl Record for GapFlowRecord {
    const COLUMNS: &'static [Column] = Self::COLUMNS;

    fn at(&self, error: Error) -> Error {
        match self.pass {
            Some(pass) => error.if_not_finite(|source| Error::AtPass { pass, source }),
            None => error,
        }
    }
}

impl GapFlowRecord {
    /// Returns the rows of the last contact, one for each direction.
    pub fn last(rows: &[Self]) -> &[Self] {
        let last = rows.last().map(|row| (row.pass, row.step));
        let of_last = rows.iter().rev().take_while(|row| Some((row.pass, row.step)) == last).count();
        &rows[rows.len() - of_last..]
    }
}

/// Computes the flow through the gap of each contact.
pub(super) struct FlowObserver {
    spec: GapFlowSpec,
    settings: Settings,
}

impl FlowObserver {
    /// Creates the observer of a `case`; `None` if it wants no flow.
    pub(super) fn of(case: &Case) -> Option<Self> {
        let spec = case.flow?;
        let boundary = case.contact.boundary;
        let periodic = boundary.repeats(0) && boundary.repeats(1);
        let sides = if periodic { Sides::Periodic } else { Sides::Closed };
        let settings = Settings { ends: spec.ends, sides, along: spec.along, ..Settings::default() };
        Some(Self { spec, settings })
    }

    /// Volume that leaks in a unit of time.
    fn leakage(&self, along: &FlowAlong) -> Result<CubicMetrePerSecond> {
        let GapFlowSpec { viscosity, pressure, outlet, .. } = self.spec;
        match outlet.filter(|_| self.spec.gas) {
            Some(outlet) => along.gas_leakage(outlet + pressure, outlet, viscosity),
            None => along.leakage(pressure, viscosity),
        }
    }
}

/// Names of the fields of the flow along x and along y: pressure, and flow per width.
const FIELDS: [[&str; 2]; 2] = [["fluid_pressure_x", "flow_x"], ["fluid_pressure_y", "flow_y"]];

impl Observer for FlowObserver {
    type Record = GapFlowRecord;

    const NAME: &'static str = "flow";

    fn every(&self) -> usize {
        self.spec.every
    }

    fn observe(
        &mut self,
        place: Place,
        contact: &ObservedContact<'_>,
    ) -> Result<(Vec<GapFlowRecord>, Vec<NamedField>)> {
        let grid = contact.grid;
        let found = flow::solve(&contact.gap, &grid, &self.settings)?;
        let touching = contact.touching.iter().filter(|touches| **touches).count();
        let GapFlowSpec { viscosity, pressure, .. } = self.spec;
        let (mut rows, mut fields) = (Vec::new(), Vec::new());
        for (axis, along) in found.along.iter().enumerate() {
            let Some(along) = along else { continue };
            let critical = along.critical_cell;
            let [x, y] =
                [0, 1].map(|axis| critical.map(|cell| contact.corner[axis] + grid.centre(axis, cell[axis])));
            rows.push(GapFlowRecord {
                pass: place.pass,
                step: place.step,
                along: if axis == 0 { FlowAxis::X } else { FlowAxis::Y },
                length: grid.extent()[axis],
                load: contact.load,
                mean_pressure: contact.load / grid.area(),
                contact_area: grid.cell_area() * touching as f64,
                mean_gap: found.mean_gap,
                permeability: along.permeability,
                permeability_across: found.coupling,
                hydraulic_gap: along.hydraulic_gap,
                flow_factor: along.flow_factor,
                leakage: self.leakage(along)?,
                critical_gap: along.critical_gap,
                critical_x: x,
                critical_y: y,
                critical_cells: critical.map_or(0, |cell| width(contact, cell, axis, self.settings.sides)),
                flowing_share: along.flowing_share,
                trapped_volume: along.trapped_volume,
                effective_medium: found.effective_medium,
                estimate: along.estimate,
                residual: along.residual.max(along.dissipation),
            });
            let [name_of_pressure, name_of_flow] = FIELDS[axis];
            let [qx, qy] = along.flux_at_centres();
            let length = grid.extent()[axis];
            let scale = pressure / (12.0 * viscosity * length);
            let mut rate = qx;
            rate.zip_mut_with(&qy, |rate, across| *rate = scale * rate.hypot(*across));
            let values = &along.pressure * pressure;
            fields.push(NamedField { name: name_of_pressure, unit: "Pa", values });
            fields.push(NamedField { name: name_of_flow, unit: "m²/s", values: rate });
        }
        Ok((rows, fields))
    }
}

/// Number of open cells in a row across the gradient along `axis` through a cell.
fn width(contact: &ObservedContact<'_>, cell: [usize; 2], axis: usize, sides: Sides) -> usize {
    let count = contact.grid.shape[1 - axis];
    let is_open = |k: usize| {
        let mut at = cell;
        at[1 - axis] = k;
        contact.gap[at] > 0.0
    };
    let from = cell[1 - axis];
    let wraps = sides == Sides::Periodic;
    let after = (1..count).take_while(|k| (wraps || from + k < count) && is_open((from + k) % count)).count();
    if after + 1 == count {
        return count;
    }
    let before =
        (1..count).take_while(|k| (wraps || *k <= from) && is_open((from + count - k) % count)).count();
    (1 + before + after).min(count)
}

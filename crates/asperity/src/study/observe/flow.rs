//! Flow of a fluid through the gap of the contacts of a case.

use super::{Observer, Place};
use crate::error::Result;
use crate::flow::{self, FlowAlong, Settings, Sides};
use crate::motion::ObservedContact;
use crate::study::case::{Case, GapFlowSpec};
use crate::study::fields::NamedField;
use crate::study::observed::{FlowAxis, GapFlowRecord};
use crate::units::CubicMetrePerSecond;

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

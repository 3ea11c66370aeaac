//! Flow of a fluid through the gap of the contacts of a case.

use super::{
    Faces, FlowAlong, FlowRecord, Leakage, Settings, Sides, shear_flow, sliding_stress_factor, solve,
};
use crate::error::Result;
use crate::motion::{ObservedContact, Position};
use crate::surface::Axis;
use crate::units::Metre;
use crate::with::{Given, NamedField, Observer, Place};

/// Computes the flow through the gap of each contact.
#[derive(Debug)]
pub struct FlowObserver {
    leakage: Leakage,
    /// One for both axes if the gap goes on alike along both, else one for each axis.
    settings: Vec<Settings>,
    /// Rms height of the sum of both surfaces at full overlap.
    rms_height: Metre,
}

/// Least film with a viscous stress, over the rms height.
const LEAST_FILM: f64 = 0.01;

impl FlowObserver {
    pub(super) fn new(leakage: &Leakage, given: &Given<'_>) -> Self {
        let boundary = given.surroundings.boundary;
        let ends = [0, 1].map(|axis| leakage.ends_along(axis, boundary));
        let sides =
            [1, 0].map(|across| if boundary.repeats(across) { Sides::Periodic } else { Sides::Closed });
        let columns = given.pair.lower.columns().min(given.pair.upper.columns());
        Self {
            leakage: *leakage,
            settings: Settings::of_axes(ends, sides, Faces::default(), leakage.along),
            rms_height: given.pair.initial_gap(&Position::flush(columns)).std(0.0),
        }
    }

    /// Fields of the flow along one axis: pressure above that of the outlet, and flow per width.
    fn fields(&self, axis: usize, along: &FlowAlong) -> [NamedField; 2] {
        let fluid = self.leakage.fluid();
        let [pressure, rate] = FIELDS[axis];
        [
            NamedField::new(pressure, "Pa", along.pressure_of(&fluid)),
            NamedField::new(rate, "m²/s", along.rate_of(&fluid)),
        ]
    }
}

/// Names of the fields of the flow along x and along y: pressure, and flow per width.
const FIELDS: [[&str; 2]; 2] = [["fluid_pressure_x", "flow_x"], ["fluid_pressure_y", "flow_y"]];

impl Observer for FlowObserver {
    type Row = FlowRecord;

    fn observe(
        &self,
        place: Place,
        contact: &ObservedContact<'_>,
    ) -> Result<(Vec<FlowRecord>, Vec<NamedField>)> {
        let grid = contact.grid;
        let touching = contact.touching.iter().filter(|touches| **touches).count();
        let (mut rows, mut fields) = (Vec::new(), Vec::new());
        let found = self.settings.iter().map(|settings| solve(&contact.gap, &grid, settings));
        let found = found.collect::<Result<Vec<_>>>()?;
        let each = found.iter().flat_map(|found| {
            let along = found.along.iter().enumerate();
            along.filter_map(move |(axis, along)| Some((found, axis, along.as_ref()?)))
        });
        let shear = self.leakage.shear.then(|| shear_flow(&contact.gap, &grid, Faces::default()));
        let sliding = shear.map(|_| sliding_stress_factor(&contact.gap, LEAST_FILM * self.rms_height));
        for (found, axis, along) in each {
            let critical = along.critical_cell;
            let [x, y] =
                [0, 1].map(|axis| critical.map(|cell| contact.corner[axis] + grid.centre(axis, cell[axis])));
            rows.push(FlowRecord {
                pass: place.pass,
                step: Some(place.step),
                along: if axis == 0 { Axis::X } else { Axis::Y },
                length: grid.extent()[axis],
                load: contact.load,
                mean_pressure: contact.load / grid.area(),
                contact_area: grid.cell_area() * touching as f64,
                mean_gap: found.mean_gap,
                permeability: along.permeability,
                permeability_across: found.coupling,
                hydraulic_gap: along.hydraulic_gap,
                flow_factor: along.flow_factor,
                leakage: along.leakage(&self.leakage.fluid())?,
                critical_gap: along.critical_gap,
                critical_x: x,
                critical_y: y,
                critical_cells: along.critical_cells,
                flowing_share: along.flowing_share,
                trapped_volume: along.trapped_volume,
                shear_flow_factor: shear
                    .map(|shear| shear[axis].carried / self.rms_height)
                    .filter(|factor| factor.is_finite()),
                shear_stress_factor: shear.map(|shear| shear[axis].stress_factor),
                sliding_stress_factor: sliding,
                pressure_stress_factor: shear.map(|_| along.pressure_stress_factor(&contact.gap)),
                effective_medium: found.effective_medium,
                estimate: along.estimate,
                residual: along.residual.max(along.dissipation),
            });
            fields.extend(self.fields(axis, along));
        }
        Ok((rows, fields))
    }
}

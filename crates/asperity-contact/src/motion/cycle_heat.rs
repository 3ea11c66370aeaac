//! Heat of the slip in the cycles of a loading.
//!
//! The surfaces have the steady temperature of the mean heat of the last computed cycle, with both bodies at
//! rest: the contact is warm by then, and in a cycle that is short compared with the time that heat needs to
//! cross a spot, its temperature changes little. The first cycle has the temperatures of the bodies.

use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::motion::law::CyclicSlip;
use crate::operator::Boundary;
use crate::solver::Solution;
use crate::temperature::{SteadyTemperature, Thermal};
use crate::units::{Joule, Kelvin, Second, Watt};

/// Heat of friction in the present cycle, and the temperature by that of the last one.
#[derive(Debug, Clone, PartialEq)]
pub struct CycleHeat {
    /// Energy that friction has taken on each cell in the present cycle, J/m².
    pub taken: Field,
    /// Absolute temperature of the surfaces on the cells in contact, K; 0 where it is not known.
    pub temperature: Field,
    /// Mean power of friction in the last computed cycle.
    pub power: Watt,
}

/// The steady temperature of a contact at rest.
pub(super) struct CyclicTemperature {
    steady: SteadyTemperature,
    bulk: [Kelvin; 2],
}

impl CycleHeat {
    pub(super) fn nothing(grid: &Grid) -> Self {
        Self { taken: grid.zeros(), temperature: grid.zeros(), power: 0.0 }
    }

    /// Adds the energy of an increment.
    pub(super) fn add(&mut self, slip: &CyclicSlip) {
        let taken = self.taken.as_slice_mut().expect("standard layout");
        slip.energies().for_each(|(cell, energy)| taken[cell] += energy);
    }

    /// Largest absolute temperature; `None` before it is known.
    pub(super) fn warmest(&self) -> Option<Kelvin> {
        self.temperature.iter().copied().filter(|kelvin| *kelvin > 0.0).reduce(f64::max)
    }

    /// Returns the temperature of each cell in contact, NaN elsewhere, K.
    pub fn temperature_field(&self) -> Field {
        self.temperature.mapv(|kelvin| if kelvin > 0.0 { kelvin } else { f64::NAN })
    }
}

impl CyclicTemperature {
    pub(super) fn new(
        grid: Grid,
        thermal: [Thermal; 2],
        boundary: Boundary,
        bulk: [Kelvin; 2],
    ) -> Result<Self> {
        Ok(Self { steady: SteadyTemperature::new(grid, thermal, boundary, [0.0; 2], bulk)?, bulk })
    }

    /// Returns the temperatures of these cells of the lower and of the upper body: that of the `heat`, or
    /// else of the bodies.
    pub(super) fn of_cells(&self, heat: &CycleHeat, cells: &[u32]) -> [Vec<Kelvin>; 2] {
        let known = heat.temperature.as_slice().expect("standard layout");
        self.bulk.map(|bulk| {
            let of = |cell: &u32| if known[*cell as usize] > 0.0 { known[*cell as usize] } else { bulk };
            cells.iter().map(of).collect()
        })
    }

    /// Ends a cycle of this `period` with the contact at its end: computes the temperature by its heat.
    pub(super) fn end(&mut self, heat: &mut CycleHeat, contact: &Solution, period: Second) -> Result<()> {
        let both = contact.pressure.iter().zip(&heat.taken).enumerate();
        let cells = both.filter(|(_, (p, energy))| **p > 0.0 || **energy > 0.0).map(|(cell, _)| cell as u32);
        let cells: Vec<u32> = cells.collect();
        let taken = heat.taken.as_slice().expect("standard layout");
        let flux: Vec<f64> = cells.iter().map(|cell| taken[*cell as usize] / period).collect();
        let energy: Joule = contact.grid.cell_area() * heat.taken.sum();
        heat.temperature.fill(0.0);
        if !cells.is_empty() {
            let found = self.steady.solve(&cells, &flux)?.temperature;
            let temperature = heat.temperature.as_slice_mut().expect("standard layout");
            cells.iter().zip(found).for_each(|(cell, kelvin)| temperature[*cell as usize] = kelvin);
        }
        heat.power = energy / period;
        heat.taken.fill(0.0);
        Ok(())
    }
}

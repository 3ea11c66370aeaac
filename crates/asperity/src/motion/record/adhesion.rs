//! Attraction of the bodies.

use serde::{Deserialize, Serialize};

use super::columns::columns;
use crate::adhesion::Adhesion;
use crate::solver::Solution;
use crate::units::{Joule, Newton, Pascal};

columns! {
    /// Attraction of the bodies in a contact with adhesion.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct AdhesionRecord {
        /// Force of the tension on the open cells, ΔA Σ σ(g).
        pub adhesive_load: Newton,
        /// Least pressure; below 0 where the surfaces attract each other.
        pub min_pressure: Pascal,
        /// Energy of the attraction, ΔA Σ v(g): −w for each area in contact, 0 far apart.
        pub adhesion_energy: Joule,
        /// Energy lost in jumps, the work ∫ W dδ minus the energy stored, by the trapezoidal rule; 0 for bodies that come from afar.
        pub energy_lost: Joule,
        /// Number of jumps: increments that lose more than 1 % of the energy.
        pub jumps: usize,
    }
}

/// Energy loss of an increment that counts as a jump, relative to the elastic energy and the energy of the attraction.
const JUMP: f64 = 0.01;

impl AdhesionRecord {
    /// Creates the record of a contact whose bodies come from afar.
    pub(in crate::motion) fn of(adhesion: &Adhesion, solution: &Solution) -> Self {
        let area = solution.grid.cell_area();
        let gap = solution.gap();
        let (mut tension, mut energy) = (0.0, 0.0);
        for (cell, (p, g)) in solution.pressure.iter().zip(&gap).enumerate() {
            energy += adhesion.energy(*g);
            if !solution.bounds.touches(cell, *p) {
                tension += adhesion.tension(*g);
            }
        }
        Self {
            adhesive_load: area * tension,
            min_pressure: solution.pressure.iter().copied().fold(f64::INFINITY, f64::min),
            adhesion_energy: area * energy,
            energy_lost: 0.0,
            jumps: 0,
        }
    }

    /// Adds the energy lost since the contact `before`.
    pub(in crate::motion) fn since(
        self,
        adhesion: &Adhesion,
        solution: &Solution,
        before: &Solution,
    ) -> Self {
        let stored = |solution: &Solution, record: &Self| solution.elastic_energy() + record.adhesion_energy;
        let last = Self::of(adhesion, before);
        let work = 0.5 * (solution.load() + before.load()) * (solution.approach - before.approach);
        let lost = work - (stored(solution, &self) - stored(before, &last));
        let size =
            |solution: &Solution, record: &Self| solution.elastic_energy() + record.adhesion_energy.abs();
        let jumps = lost > JUMP * size(solution, &self).max(size(before, &last));
        Self { energy_lost: if jumps { lost } else { 0.0 }, jumps: usize::from(jumps), ..self }
    }

    /// Adds the losses of earlier increments.
    pub(in crate::motion) fn after<'a>(self, increments: impl Iterator<Item = &'a Self>) -> Self {
        increments.fold(Self { energy_lost: 0.0, jumps: 0, ..self }, |sum, increment| Self {
            energy_lost: sum.energy_lost + increment.energy_lost,
            jumps: sum.jumps + increment.jumps,
            ..sum
        })
    }
}

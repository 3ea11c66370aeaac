//! Attraction of the bodies.

use serde::{Deserialize, Serialize};

use crate::solver::{Interface, Solution};
use crate::units::{Joule, Metre, Newton, Pascal};
use asperity_base::record::columns;

columns! {
    /// Attraction of the bodies in a contact with adhesion.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
    pub struct AdhesionRecord {
        /// Force of the tension on the open cells, ΔA Σ σ(g).
        pub adhesive_load: Newton,
        /// Least pressure; below 0 where the surfaces attract each other.
        pub min_pressure: Pascal,
        /// Energy of the attraction, ΔA Σ v(g): −w for each area in contact, 0 far apart.
        pub adhesion_energy: Joule,
        /// Energy lost in jumps: the work done minus the energy stored, by the trapezoidal rule; 0 for bodies
        /// that come from afar.
        pub energy_lost: Joule,
        /// Number of jumps: increments, or positions, that lose more than 1 % of the energy, and more than
        /// the work of adhesion of a cell.
        pub jumps: usize,
    }
}

columns! {
    /// Attraction of the bodies in a pass.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
    pub struct AdhesionPassRecord {
        /// Mean over the positions of the force of the tension on the open cells.
        pub mean_adhesive_load: Newton,
        /// Energy lost in the jumps of the pass; 0 if the bodies come from afar at each position.
        #[over_motion(SumOfPasses)]
        pub energy_lost: Joule,
        /// Number of positions that jump.
        #[over_motion(SumOfPasses)]
        pub jumps: usize,
        /// Drag by adhesion: the energy lost over the distance slid.
        pub adhesive_drag: Newton,
        /// Largest difference between the load of a position from afar and that of bodies that come from the
        /// position before, over the mean magnitude of the load; of every eighth position. 0, not measured,
        /// with `history = "path"` or `plastic_update = "step"`.
        pub history_difference: f64,
    }
}

/// Energy loss that counts as a jump, relative to the elastic energy and the energy of the attraction.
const JUMP: f64 = 0.01;

/// Energy of a contact with adhesion.
#[derive(Clone, Copy)]
struct Stored {
    /// Elastic energy and energy of the attraction.
    energy: Joule,
    /// The sum of their magnitudes.
    size: Joule,
}

impl Stored {
    fn of(solution: &Solution, record: &AdhesionRecord) -> Self {
        let elastic = solution.elastic_energy();
        Self { energy: elastic + record.adhesion_energy, size: elastic.abs() + record.adhesion_energy.abs() }
    }
}

impl AdhesionRecord {
    /// Creates the record of a contact whose bodies come from the contact `before`, or from afar; `None`
    /// between hard walls.
    pub fn new(interface: &dyn Interface, solution: &Solution, before: Option<&Solution>) -> Option<Self> {
        (!interface.is_hard()).then(|| {
            let record = Self::alone(interface, solution);
            before.map_or(record, |before| record.since(interface, solution, before))
        })
    }

    /// Creates the record of a contact whose bodies come from afar.
    fn alone(interface: &dyn Interface, solution: &Solution) -> Self {
        let area = solution.grid.cell_area();
        let gap = solution.gap();
        let (mut tension, mut energy) = (0.0, 0.0);
        for (cell, (p, g)) in solution.pressure.iter().zip(&gap).enumerate() {
            energy += interface.energy(*g);
            if !solution.bounds.touches(cell, *p) {
                tension += interface.tension(*g);
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

    /// Adds the energy lost since the contact `before` of the same bodies.
    ///
    /// The work is ½(W₀ + W₁)(δ₁ − δ₀), and that of a change of the gap h by the motion, −½ΔA Σ (p₀ + p₁)(h₁
    /// − h₀).
    fn since(self, interface: &dyn Interface, solution: &Solution, before: &Solution) -> Self {
        let moved: Metre = solution.approach - before.approach;
        let mut work = 0.5 * (solution.load() + before.load()) * moved;
        let pressures = solution.pressure.iter().zip(&before.pressure);
        let gaps = solution.initial_gap.iter().zip(&before.initial_gap);
        let of_motion: f64 = pressures.zip(gaps).map(|((p1, p0), (h1, h0))| (p0 + p1) * (h1 - h0)).sum();
        work -= 0.5 * solution.grid.cell_area() * of_motion;
        let now = Stored::of(solution, &self);
        let then = Stored::of(before, &Self::alone(interface, before));
        let lost = work - (now.energy - then.energy);
        // A loss below the work of adhesion of a cell is no jump, however small the energy of separated
        // bodies is.
        let of_a_cell = -interface.energy(0.0) * solution.grid.cell_area();
        let jumps = lost > of_a_cell.max(JUMP * now.size.max(then.size));
        Self { energy_lost: if jumps { lost } else { 0.0 }, jumps: usize::from(jumps), ..self }
    }

    /// Adds the losses of earlier increments.
    pub fn after<'a>(self, increments: impl Iterator<Item = &'a Self>) -> Self {
        increments.fold(Self { energy_lost: 0.0, jumps: 0, ..self }, |sum, increment| Self {
            energy_lost: sum.energy_lost + increment.energy_lost,
            jumps: sum.jumps + increment.jumps,
            ..sum
        })
    }
}

impl AdhesionPassRecord {
    /// Creates the record of a pass of this sliding `distance` from those of its positions.
    pub fn from_positions<'a>(
        positions: impl Iterator<Item = &'a AdhesionRecord>,
        distance: Metre,
        history_difference: f64,
    ) -> Option<Self> {
        let (mut count, mut sum) = (0.0, Self { history_difference, ..Self::default() });
        for position in positions {
            count += 1.0;
            sum.mean_adhesive_load += position.adhesive_load;
            sum.energy_lost += position.energy_lost;
            sum.jumps += position.jumps;
        }
        let adhesive_drag = if distance > 0.0 { sum.energy_lost / distance } else { 0.0 };
        (count > 0.0).then(|| Self {
            mean_adhesive_load: sum.mean_adhesive_load / count,
            adhesive_drag,
            ..sum
        })
    }
}

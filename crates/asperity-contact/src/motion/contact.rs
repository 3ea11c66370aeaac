//! The contact at one position, stored as its cells in contact only.

use std::sync::Arc;

use crate::error::Result;
use crate::grid::{Field, Placement, length_of};
use crate::motion::pair::Pair;
use crate::motion::path::Position;
use crate::motion::record::{StaticRecord, StepRecord};
use crate::motion::rim::Interior;
use crate::motion::slip::SlipRegime;
use crate::motion::spot::largest_spot;
use crate::motion::watch::{OneOfMany, Watch};
use crate::operator::{Boundary, Operators};
use crate::solver::{
    ContactProblem, Control, Equilibrium, Guess, InterfaceRecord, Loading, Params, Sliding, Solution, Stats,
};
use crate::subsurface::Tractions;
use crate::units::{CubicMetre, Kelvin, Metre, Newton, Pascal};

/// The solution at one position: only the cells in contact.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Contact {
    /// The relative position of the bodies.
    pub position: Position,
    /// Flat cells in contact and their pressure, Pa: with p > 0, or with p > −σ(0) where the bodies attract
    /// each other.
    pub pressure: Vec<(u32, Pascal)>,
    /// Flat cells that are open and under tension, and their pressure, Pa, below 0. None between hard walls.
    pub tension: Vec<(u32, Pascal)>,
    /// Flat cells at the hardness and their plastic interference w, m.
    pub plastic: Vec<(u32, Metre)>,
    /// Absolute temperature of the surfaces on each cell in contact, in the order of the pressures; `None` if
    /// it is not computed.
    pub temperature: Option<Vec<Kelvin>>,
    /// Gap of all cells, m, where an output asks for it ([`crate::motion::Simulation::keeping_gaps`]): below
    /// 0 by up to the plastic interference on cells at the hardness.
    pub gap: Option<Arc<Field>>,
    /// Tractions of oil and solids together on the lower surface of lubricated bodies; `None` of dry ones.
    pub film_tractions: Option<Arc<Tractions>>,
    /// Largest elastic displacement of a cell, m; `None` if it is unknown, as for a pass that is solved
    /// together with its removal.
    pub max_displacement: Option<Metre>,
    /// Tension across the gap; `None` between hard walls.
    pub interface: Option<InterfaceRecord>,
    /// Load W = ΔA Σ p, N.
    pub load: Newton,
    /// Friction force Q = ΔA Σ q along x of the upper body on the lower one.
    pub tangential_force: Newton,
    /// Rigid-body approach δ, m.
    pub approach: Metre,
    /// Scale-free complementarity residual η.
    pub residual: f64,
    /// Cost: iterations of this solution, and convolutions of all solutions that led to it.
    pub stats: Stats,
}

impl Contact {
    /// Solves the contact of `pair` at `position` in a slip `regime`, near the pressure `start` or from the
    /// contact `last` on the same grid, if one is given.
    #[expect(clippy::too_many_arguments, reason = "the contact, where it begins, and who looks on")]
    pub(super) fn solve(
        pair: &Pair,
        operators: &Operators,
        position: Position,
        regime: SlipRegime,
        control: Control,
        start: Option<&Field>,
        last: Option<&Equilibrium>,
        params: &Params,
        watch: &dyn Watch,
    ) -> Result<(Self, Equilibrium)> {
        let watch = &OneOfMany(watch);
        let gap = pair.initial_gap(&position);
        let shape = [position.columns, gap.ncols()];
        let bounds = pair.bounds(&position);
        let moved = last.map(|last| last.clone().over(&gap));
        let problem = ContactProblem {
            before: moved.as_ref(),
            guess: start.map(Guess::Pressure),
            ..ContactProblem::new(&gap, &bounds, Loading::pressing(control), params, watch)
        };
        let contact = regime.solver(pair, operators, shape, params.device)?.solve(&problem)?;
        let before = last.map(Equilibrium::normal);
        let interface = InterfaceRecord::new(pair.interface(), contact.normal(), before);
        Ok((Self { interface, ..Self::new(position, contact.sliding(), contact.normal()) }, contact))
    }

    /// Keeps the gap of the `solution`, if it is `wanted`.
    #[must_use]
    pub(super) fn with_gap(self, solution: &Solution, wanted: bool) -> Self {
        Self { gap: wanted.then(|| Arc::new(solution.gap())), ..self }
    }

    /// Returns the same contact at a position of the return stroke, at no further cost.
    pub(super) fn back(&self, position: Position) -> Self {
        // Without friction: 0 as before, not −0.
        let tangential_force = 0.0 - self.tangential_force;
        Self { position, tangential_force, stats: Stats::default(), ..self.clone() }
    }

    /// Creates a contact from its pressure at an approach and its cost alone.
    pub(super) fn from_pressure(
        pair: &Pair,
        position: Position,
        approach: Metre,
        pressure: Vec<(u32, Pascal)>,
        stats: Stats,
    ) -> Self {
        let load = pair.cell_area() * pressure.iter().map(|(_, p)| p).sum::<f64>();
        let residual = f64::NAN;
        Self {
            position,
            pressure,
            tension: Vec::new(),
            plastic: Vec::new(),
            temperature: None,
            gap: None,
            film_tractions: None,
            max_displacement: None,
            interface: None,
            load,
            tangential_force: 0.0,
            approach,
            residual,
            stats,
        }
    }

    /// Creates the contact from a solution.
    pub(super) fn new(position: Position, sliding: Option<&Sliding>, solution: &Solution) -> Self {
        let (mut pressure, mut tension, mut plastic) = (Vec::new(), Vec::new(), Vec::new());
        let cells = solution.pressure.iter().zip(&solution.displacement).zip(&solution.initial_gap);
        for (cell, ((&p, u), h)) in cells.enumerate() {
            if solution.bounds.touches(cell, p) {
                pressure.push((cell as u32, p));
            } else if p < 0.0 {
                tension.push((cell as u32, p));
            }
            if solution.bounds.caps(cell, p) {
                plastic.push((cell as u32, (solution.approach - h - u).max(0.0)));
            }
        }
        let shear = |sliding: &Sliding| pressure.iter().map(|(_, p)| sliding.shear(*p)[0]).sum::<f64>();
        Self {
            position,
            tangential_force: solution.grid.cell_area() * sliding.map_or(0.0, shear),
            pressure,
            tension,
            plastic,
            temperature: None,
            gap: None,
            film_tractions: None,
            max_displacement: Some(solution.max_displacement()),
            interface: None,
            load: solution.load(),
            approach: solution.approach,
            residual: solution.residual,
            stats: solution.stats,
        }
    }

    /// Returns the pressure on all cells of the overlap, `width` across; below 0 under tension.
    pub fn pressure_field(&self, width: usize) -> Field {
        let mut field = Field::zeros([self.position.columns, width]);
        let cells = field.as_slice_mut().expect("standard layout");
        self.pressure.iter().chain(&self.tension).for_each(|(cell, p)| cells[*cell as usize] = *p);
        field
    }

    /// Returns the tractions on the lower surface of the overlap, `width` across, of dry bodies that slide like this, or
    /// of lubricated ones.
    pub fn tractions(&self, width: usize, sliding: Option<&Sliding>) -> Tractions {
        if let Some(tractions) = &self.film_tractions {
            return (**tractions).clone();
        }
        let pressure = self.pressure_field(width);
        let shear = sliding.map(|sliding| pressure.mapv(|p| sliding.shear(p)[0]));
        Tractions { pressure, shear: [shear, None] }
    }

    /// Returns the temperature of the cells in contact, K, NaN elsewhere, `width` across; `None` if it is not
    /// computed.
    pub fn temperature_field(&self, width: usize) -> Option<Field> {
        let temperature = self.temperature.as_ref()?;
        let mut field = Field::from_elem([self.position.columns, width], f64::NAN);
        let cells = field.as_slice_mut().expect("standard layout");
        let of_cells = self.pressure.iter().zip(temperature);
        of_cells.for_each(|((cell, _), temperature)| cells[*cell as usize] = *temperature);
        Some(field)
    }

    /// Returns the plastic interference w of each cell in contact, in the order of the pressures; 0 in cells
    /// that do not yield.
    pub fn interference(&self) -> Vec<Metre> {
        let mut plastic = self.plastic.iter().peekable();
        let of = |(cell, _): &(u32, Pascal)| plastic.next_if(|(at, _)| at == cell).map_or(0.0, |(_, w)| *w);
        self.pressure.iter().map(of).collect()
    }

    /// Largest pressure, Pa.
    pub fn max_pressure(&self) -> Pascal {
        self.pressure.iter().map(|(_, p)| *p).fold(0.0, f64::max)
    }

    /// Plastic volume ΔA Σ w of the contact.
    pub fn plastic_volume(&self, pair: &Pair) -> CubicMetre {
        pair.cell_area() * self.plastic.iter().map(|(_, w)| w).sum::<f64>()
    }

    /// Returns the record of this position: a row of `steps.csv`.
    pub(super) fn record(
        &self,
        pair: &Pair,
        interiors: &[Interior; 2],
        boundary: Boundary,
        [pass, step]: [usize; 2],
    ) -> StepRecord {
        let placements = pair.placements(&self.position);
        let inside = |cell: u32| {
            let within = |(placement, interior): (&Placement, &Interior)| {
                interior.holds(placement.cell(cell as usize))
            };
            placements.iter().zip(interiors).all(within)
        };
        let contact_cells = self.pressure.iter().map(|(cell, _)| *cell as usize);
        let shape = pair.grid(self.position.columns).shape;
        let interference = self.plastic.iter().filter(|(cell, _)| inside(*cell)).map(|(_, w)| w);
        StepRecord {
            pass,
            step,
            offset: length_of(self.position.offset, pair.pitch()[0]),
            offset_y: None,
            overlap_columns: self.position.columns,
            approach: self.approach,
            load: self.load,
            tangential_force: self.tangential_force,
            contact_area: pair.cell_area() * self.pressure.len() as f64,
            contact_area_interior: pair.cell_area()
                * self.pressure.iter().filter(|(cell, _)| inside(*cell)).count() as f64,
            largest_spot_cells: largest_spot(contact_cells, shape, boundary.wraps()),
            max_pressure: self.max_pressure(),
            plastic_cells: self.plastic.len(),
            plastic_volume: self.plastic_volume(pair),
            plastic_volume_interior: pair.cell_area() * interference.sum::<f64>(),
            iterations: self.stats.iterations,
            convolutions: self.stats.convolutions,
            residual: self.residual,
            heat: None,
            interface: self.interface,
            plastic: None,
            film: None,
            drag: None,
        }
    }
}

/// Returns the operators of a pair at full overlap, and the gap between the bodies.
pub(super) fn facing(pair: &Pair, boundary: Boundary) -> Result<(Operators, Field)> {
    assert_eq!(pair.lower.heights.dim(), pair.upper.heights.dim(), "shapes of the bodies");
    Ok((pair.operators(pair.lower_grid(), boundary)?, pair.initial_gap(&pair.at_rest())))
}

impl StaticRecord {
    /// Returns the record of a contact without friction.
    pub fn new(solution: &Solution) -> Self {
        Self {
            load: solution.load(),
            approach: solution.approach,
            contact_area: solution.grid.cell_area() * solution.contact_cells() as f64,
            apparent_area: solution.grid.area(),
            max_pressure: solution.max_pressure(),
            mean_gap: solution.mean_gap(),
            elastic_energy: solution.elastic_energy(),
            plastic_cells: solution.capped_cells(),
            plastic_volume: solution.plastic_volume(),
            iterations: solution.stats.iterations,
            convolutions: solution.stats.convolutions,
            residual: solution.residual,
            shear: None,
            interface: None,
            plastic: None,
            fretting: None,
            heat: None,
        }
    }
}

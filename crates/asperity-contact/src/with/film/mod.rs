//! Tribofilms: films that grow on a rubbed surface and are removed by rubbing.

mod balance;
mod limit;
mod rules;
mod table;
mod views;

pub use table::{Film, FilmLaw, FilmStress};

use self::balance::{Balance, at_least_0, mean_decay};
use self::rules::RULES;
use super::views::{Kept, OfBodies, PassCell};
use super::{BodyLaw, BodyLaws, ChangedSurfaces, LawRule};
use crate::error::{Error, Result};
use crate::grid::{CellValues, Field};
use crate::motion::{
    Body, Contact, ContactCells, FrettingRecord, Law, LawsInCycles, LawsInPass, LawsInUpdate, Pair,
    PassRecord, State, UpdateRecord, largest,
};
use crate::units::{Dimension, Metre, Pascal, format};
use asperity_base::table::Source;

/// Boltzmann's constant, J/K.
const BOLTZMANN: f64 = 1.380_649e-23;
/// Planck's constant, J s.
const PLANCK: f64 = 6.626_070_15e-34;

/// Name of the law, and of the body state that stores the thickness of the film, m.
pub const FILM: &str = "film";
/// Name of the body state that stores the growth by the mechano-chemical law, m.
const GROWN: &str = "film_grown";

/// Largest exponent of Arrhenius' law. A film that grows at e⁵⁰⁰ of the known rate reaches its limit at once.
/// Sums of such rates over positions, passes and time stay finite.
const MAX_EXPONENT: f64 = 500.0;

impl BodyLaw for Film {
    const NAME: &'static str = FILM;
    const MEANING: &'static str = "growing tribofilm, see [below](#running-in)";
    const RULES: &'static [LawRule<Self>] = RULES;
    const EFFORT: f64 = 380.0;
    const KEPT: &'static [Kept] = views::KEPT;
    const CELL: PassCell = views::CELL;
    const OF_PASSES: &'static [OfBodies<PassRecord>] = views::OF_PASSES;
    const OF_UPDATES: &'static [OfBodies<UpdateRecord>] = views::OF_UPDATES;
    const OF_CYCLES: &'static [OfBodies<FrettingRecord>] = views::OF_CYCLES;

    fn on(self, hardness: Option<Pascal>, source: &dyn Source) -> Result<Self> {
        self.softer_than(hardness, source).map(|()| self)
    }

    fn law(bodies: [&BodyLaws; 2], pair: &Pair) -> Result<Option<Box<dyn Law>>> {
        let films = bodies.map(|laws| laws.film);
        if films.iter().all(Option::is_none) {
            Ok(None)
        } else {
            Ok(Some(Box::new(Films::new(films, pair)?)))
        }
    }

    fn limit_in_pass(pass: &PassRecord, surfaces: &ChangedSurfaces) -> [[Metre; 2]; 2] {
        limit::in_pass(pass, surfaces)
    }

    fn limit_in_update(update: &UpdateRecord, surfaces: &ChangedSurfaces) -> [[Metre; 2]; 2] {
        limit::in_update(update, surfaces)
    }

    fn beyond_limit(body: &str, value: Metre, bound: Metre) -> String {
        limit::beyond(body, value, bound)
    }

    fn describe(&self) -> String {
        let law = match self.law {
            FilmLaw::Arrhenius { .. } => "Arrhenius growth up to",
            FilmLaw::MechanoChemical { .. } => "mechano-chemical growth up to",
            FilmLaw::SolidLubricant { .. } => "solid lubricant of",
        };
        let most = format(self.max_thickness, Dimension::Length);
        let hardness = self.hardness.map(|value| {
            format!(", pressure up to {} where it is thickest", format(value, Dimension::Pressure))
        });
        format!("{law} {most}{}", hardness.unwrap_or_default())
    }
}

impl Film {
    /// Adds the rates of growth and removal at a position to their sums on a body, 0 or 1. Arrhenius: ∫G dt
    /// in m and ∫R dt. Mechano-chemical: the exponents of growth and removal. Solid lubricant: nothing, and
    /// the depth worn off, m.
    pub(in crate::with) fn add_rates(&self, body: usize, contact_cells: &ContactCells, sums: &mut [Field]) {
        let [grown, removed] = sums else { unreachable!("two sums") };
        let temperature = contact_cells.temperature[body];
        match self.law {
            FilmLaw::Arrhenius {
                rate,
                at_temperature,
                at_stress,
                activation_energy,
                activation_volume,
                stress,
                removal,
            } => {
                let stress = match stress {
                    FilmStress::Pressure => contact_cells.pressure,
                    FilmStress::Shear => contact_cells.shear,
                };
                contact_cells.add(body, grown, |index| {
                    let (stress, temperature) = (stress[index], temperature[index]);
                    let energy = activation_energy * (1.0 / temperature - 1.0 / at_temperature);
                    let work = activation_volume * (stress / temperature - at_stress / at_temperature);
                    let exponent = (work - energy) / BOLTZMANN;
                    let growth = rate * if exponent > MAX_EXPONENT { MAX_EXPONENT } else { exponent }.exp();
                    growth * contact_cells.time
                });
                contact_cells.add(body, removed, |index| {
                    removal * contact_cells.pressure[index] * contact_cells.sliding_distance(index)
                });
            }
            FilmLaw::MechanoChemical { x, c4, .. } => {
                contact_cells.add(body, grown, |index| {
                    BOLTZMANN * temperature[index] / PLANCK * x * contact_cells.time
                });
                contact_cells.add(body, removed, |_| c4 * contact_cells.time);
            }
            FilmLaw::SolidLubricant { .. } => {
                let rate = self.law.per_pressure();
                contact_cells.add(body, removed, |index| {
                    rate * contact_cells.pressure[index] * contact_cells.sliding_distance(index)
                });
            }
        }
    }

    /// The states of the film on a body.
    pub(in crate::with) fn states<'a>(&self, body: &'a Body) -> FilmStates<'a> {
        let field =
            |name: &str| body.state.get(name).map(|state| state.values.as_slice().expect("standard layout"));
        FilmStates { thickness: field(FILM).unwrap_or_default(), grown: field(GROWN).unwrap_or_default() }
    }

    /// Returns the thickness and growth of a cell after `passes` passes; exact if contact and temperature are
    /// frozen.
    fn after(&self, [thickness, grown]: [Metre; 2], [growth, removal]: [f64; 2], passes: f64) -> [Metre; 2] {
        match self.law {
            FilmLaw::Arrhenius { .. } => {
                let decay = growth / self.max_thickness + removal;
                if decay <= 0.0 {
                    return [thickness, grown];
                }
                let steady = growth / decay;
                [steady + (thickness - steady) * (-decay * passes).exp(), 0.0]
            }
            FilmLaw::MechanoChemical { c3, .. } => {
                let balance = Balance::new([self.max_thickness, c3], [growth, removal], [thickness, grown]);
                let grown = balance.grown(passes);
                [balance.thickness(passes), grown]
            }
            FilmLaw::SolidLubricant { .. } => [at_least_0(thickness - removal * passes), 0.0],
        }
    }

    /// Returns the mean thickness of a cell over `passes` passes; the present thickness for 0 passes.
    pub(in crate::with) fn mean_thickness(&self, states: [Metre; 2], rates: [f64; 2], passes: f64) -> Metre {
        let ([thickness, grown], [growth, removal]) = (states, rates);
        match self.law {
            FilmLaw::Arrhenius { .. } => {
                let decay = growth / self.max_thickness + removal;
                if decay <= 0.0 {
                    return thickness;
                }
                let steady = growth / decay;
                steady + (thickness - steady) * mean_decay(decay * passes)
            }
            FilmLaw::MechanoChemical { c3, .. } => {
                let balance = Balance::new([self.max_thickness, c3], [growth, removal], [thickness, grown]);
                balance.mean_thickness(passes)
            }
            FilmLaw::SolidLubricant { .. } => match removal * passes {
                worn if worn <= thickness => thickness - 0.5 * worn,
                worn => 0.5 * thickness * (thickness / worn),
            },
        }
    }

    /// Prepares a body: sets the initial film if there is none yet. Returns the hardness of the body without
    /// its film.
    fn prepare(&self, body: &mut Body) -> CellValues {
        let (states, begin) = match self.law {
            FilmLaw::Arrhenius { .. } => (&[FILM][..], 0.0),
            FilmLaw::MechanoChemical { .. } => (&[FILM, GROWN][..], 0.0),
            FilmLaw::SolidLubricant { .. } => (&[FILM][..], self.max_thickness),
        };
        let shape = body.heights.raw_dim();
        for name in states {
            let state = || State { unit: "m".to_owned(), values: Field::from_elem(shape, begin) };
            body.state.entry((*name).to_owned()).or_insert_with(state);
        }
        let bare = body.hardness.clone();
        self.set_hardness(body, &bare);
        bare
    }

    /// Sets the hardness of a body under its film, H − (H − H_f) min(f/f_max, 1), from the hardness of the
    /// `bare` body.
    fn set_hardness(&self, body: &mut Body, bare: &CellValues) {
        let Some(soft) = self.hardness else { return };
        let thickness = &body.state[FILM].values;
        let mut hardness = thickness.clone();
        for (cell, value) in hardness.iter_mut().enumerate() {
            let hard = bare.value(cell);
            *value = hard - (hard - soft) * (*value / self.max_thickness).clamp(0.0, 1.0);
        }
        body.hardness = hardness.into();
    }
}

/// The states of a film, by cell.
pub(in crate::with) struct FilmStates<'a> {
    thickness: &'a [Metre],
    grown: &'a [Metre],
}

impl FilmStates<'_> {
    /// Thickness and growth of a flat cell.
    pub(in crate::with) fn state_of(&self, cell: usize) -> [Metre; 2] {
        [&self.thickness, &self.grown].map(|values| values.get(cell).copied().unwrap_or(0.0))
    }
}

/// Sums of growth and removal over a pass, by cell.
pub(in crate::with) struct GrowthSums<'a>([&'a [f64]; 2]);

impl<'a> GrowthSums<'a> {
    /// Number of sums.
    pub(in crate::with) const SUMS: usize = 2;

    pub(in crate::with) fn new(sums: &'a [Field]) -> Self {
        Self([0, 1].map(|index| sums[index].as_slice().expect("standard layout")))
    }

    pub(in crate::with) fn sums_of(&self, cell: usize) -> [f64; 2] {
        self.0.map(|values| values[cell])
    }
}

/// Growth and removal of the films of both bodies. The heights grow with the films, and cells under a soft
/// film carry less.
#[derive(Debug, Clone)]
pub struct Films {
    films: [Option<Film>; 2],
    /// Hardness of each body without its film; known once the bodies are prepared.
    bare: [Option<CellValues>; 2],
}

impl Films {
    /// Creates the films of the lower and of the upper body; `None` for a body without film.
    ///
    /// # Errors
    /// [`Error::OutOfRange`]; [`Error::Unsupported`] if a film is harder than its body, or if a film has a
    /// hardness and its body has none.
    pub fn new(films: [Option<Film>; 2], pair: &Pair) -> Result<Self> {
        films.iter().flatten().try_for_each(Film::checked)?;
        for (film, body) in films.iter().zip([&pair.lower, &pair.upper]) {
            if let Some(soft) = film.as_ref().and_then(|film| film.hardness)
                && (soft > body.hardness.min() || !body.hardness.max().is_finite())
            {
                return Err(Error::Unsupported("a film with a hardness needs a body with a hardness"));
            }
        }
        Ok(Self { films, bare: [None, None] })
    }
}

impl Law for Films {
    fn name(&self) -> &str {
        FILM
    }

    fn prepare(&mut self, pair: &mut Pair) {
        let bodies = [&mut pair.lower, &mut pair.upper];
        for ((film, bare), body) in self.films.iter().zip(&mut self.bare).zip(bodies) {
            *bare = film.as_ref().map(|film| film.prepare(body));
        }
    }

    fn sums(&self) -> usize {
        GrowthSums::SUMS
    }

    fn add(&self, _: &Pair, contact_cells: &ContactCells, sums: &mut [Vec<Field>; 2]) {
        for (body, sums) in sums.iter_mut().enumerate() {
            if let Some(film) = &self.films[body] {
                film.add_rates(body, contact_cells, sums);
            }
        }
    }

    fn advance(&self, pair: &mut Pair, sums: &[Vec<Field>; 2], passes: f64) -> [Field; 2] {
        let Pair { lower, upper, .. } = pair;
        let mut bodies = [lower, upper];
        [0, 1].map(|index| {
            let body = &mut *bodies[index];
            let mut depth = Field::zeros(body.heights.raw_dim());
            let Some(film) = &self.films[index] else { return depth };
            let growing = GrowthSums::new(&sums[index]);
            let states = film.states(body);
            let after: Vec<[Metre; 2]> = (0..depth.len())
                .map(|cell| film.after(states.state_of(cell), growing.sums_of(cell), passes))
                .collect();
            for ((depth, after), before) in depth.iter_mut().zip(&after).zip(&body.state[FILM].values) {
                *depth = before - after[0];
            }
            for (which, name) in [FILM, GROWN].into_iter().enumerate() {
                if let Some(state) = body.state.get_mut(name) {
                    state.values.iter_mut().zip(&after).for_each(|(value, after)| *value = after[which]);
                }
            }
            if let Some(bare) = &self.bare[index] {
                film.set_hardness(body, bare);
            }
            depth
        })
    }

    fn deepest(&self, pair: &Pair) -> [Metre; 2] {
        of_bodies(pair, largest)
    }

    fn record_pass(&self, pair: &Pair, _: &[Field; 2], columns: &mut LawsInPass) {
        let means = of_bodies(pair, |film| film.mean().unwrap_or(0.0));
        [columns.mean_film_lower, columns.mean_film_upper] = means;
    }

    fn record_update(&self, pair: &Pair, contact: &Contact, columns: &mut LawsInUpdate) {
        let cells = contact.pressure.len() as f64;
        if cells > 0.0 {
            let in_contact = of_bodies(pair, |film| {
                let film = film.as_slice().expect("standard layout");
                contact.pressure.iter().map(|(cell, _)| film[*cell as usize]).sum::<f64>() / cells
            });
            [columns.mean_film_lower, columns.mean_film_upper] = in_contact;
        }
    }

    fn record_cycles(&self, pair: &Pair, columns: &mut LawsInCycles) {
        [columns.max_film_lower, columns.max_film_upper] = self.deepest(pair);
    }
}

/// Evaluates the films of the lower and of the upper body; 0 for a body without one.
fn of_bodies(pair: &Pair, value: impl Fn(&Field) -> f64) -> [f64; 2] {
    [&pair.lower, &pair.upper].map(|body| body.state.get(FILM).map_or(0.0, |film| value(&film.values)))
}

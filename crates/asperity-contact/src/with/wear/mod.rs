//! Wear: material removed from a body by sliding.

mod limit;
mod rules;
mod table;
mod views;

pub use table::{WearCoefficient, WearRate};

use self::rules::RULES;
use super::film::{Film, GrowthSums};
use super::views::{Answer, Kept, OfBodies, PassCell};
use super::{BodyLaw, BodyLaws, ChangedSurfaces, LawRule};
use crate::error::{Error, Result};
use crate::grid::{CellValues, Field};
use crate::motion::{
    Body, Contact, ContactCells, FrettingRecord, Law, LawsInCycles, LawsInPass, LawsInUpdate, Pair,
    PassRecord, State, UpdateRecord, largest,
};
use crate::units::{Dimension, Metre, Pascal, PerPascal, format};
use asperity_base::table::Source;

/// Name of the law, and of the body state that stores the depth worn since the beginning, m.
pub const WEAR: &str = "wear";

impl BodyLaw for WearCoefficient {
    const NAME: &'static str = WEAR;
    const MEANING: &'static str = "wear law, see [below](#running-in)";
    const RULES: &'static [LawRule<Self>] = RULES;
    const EFFORT: f64 = 0.0;
    const KEPT: &'static [Kept] = views::KEPT;
    const CELL: PassCell = views::CELL;
    const OF_PASSES: &'static [OfBodies<PassRecord>] = views::OF_PASSES;
    const OF_UPDATES: &'static [OfBodies<UpdateRecord>] = views::OF_UPDATES;
    const OF_CYCLES: &'static [OfBodies<FrettingRecord>] = views::OF_CYCLES;

    fn on(self, hardness: Option<Pascal>, source: &dyn Source) -> Result<Self> {
        self.of_hardness(hardness, source)
    }

    fn law(bodies: [&BodyLaws; 2], _: &Pair) -> Result<Option<Box<dyn Law>>> {
        let coefficients = bodies.map(|laws| laws.wear);
        if coefficients.iter().all(Option::is_none) {
            return Ok(None);
        }
        let wear = Wear::new(coefficients, bodies.map(|laws| laws.film))?;
        Ok(Some(Box::new(wear)))
    }

    fn per_pressure(&self, friction: f64) -> PerPascal {
        self.rate.per_pressure(friction)
    }

    fn limit_in_pass(pass: &PassRecord, surfaces: &ChangedSurfaces) -> [[Metre; 2]; 2] {
        limit::in_pass(pass, surfaces)
    }

    fn beyond_limit(body: &str, value: Metre, bound: Metre) -> String {
        limit::beyond(body, value, bound)
    }

    fn after_passes(passes: &[PassRecord]) -> Option<Answer> {
        views::after_passes(passes)
    }

    fn after_cycles(cycles: &FrettingRecord) -> Option<Answer> {
        views::after_cycles(cycles)
    }

    fn after_sliding(updates: &[UpdateRecord]) -> Option<Answer> {
        views::after_sliding(updates)
    }

    fn describe(&self) -> String {
        let coefficient = |value| format(value, Dimension::VolumePerWork);
        let driver = match self.rate {
            WearRate::Energy(_) => "per energy of friction",
            _ => "per load and distance",
        };
        let under = self.under_film.map(|value| format!(", {} under the film", coefficient(value)));
        format!("{} {driver}{}", coefficient(self.rate.bare()), under.unwrap_or_default())
    }
}

/// Wear of both bodies, reduced by their films.
///
/// At frozen contact, a pass removes the depth k Σ p |Δs| from a cell. In an extrapolation over many passes,
/// k is its mean while the film grows or is removed at the rates of the computed pass.
#[derive(Debug, Clone)]
pub struct Wear {
    coefficients: [Option<WearCoefficient>; 2],
    /// The films that reduce the coefficients.
    films: [Option<Film>; 2],
}

impl Wear {
    /// Creates the wear of the lower and of the upper body, with their `films`; `None` for a body that does
    /// not wear.
    ///
    /// # Errors
    /// [`Error::OutOfRange`]; [`Error::Unsupported`] for a coefficient under a film on a body without film.
    pub fn new(coefficients: [Option<WearCoefficient>; 2], films: [Option<Film>; 2]) -> Result<Self> {
        coefficients.iter().flatten().try_for_each(WearCoefficient::checked)?;
        let lowered = coefficients.map(|coefficient| coefficient.is_some_and(|k| k.is_lowered()));
        if (0..2).any(|body| lowered[body] && films[body].is_none()) {
            return Err(Error::Unsupported("a body without a film has no wear coefficient under one"));
        }
        let [lower, upper] = films;
        Ok(Self { coefficients, films: [lower.filter(|_| lowered[0]), upper.filter(|_| lowered[1])] })
    }

    /// Returns the depths removed in `passes` passes, with the coefficients averaged over them.
    fn depths(&self, pair: &Pair, sums: &[Vec<Field>; 2], passes: f64) -> [Field; 2] {
        [0, 1].map(|body| {
            let work = &sums[body][0];
            let Some(coefficient) = self.coefficients[body] else { return Field::zeros(work.raw_dim()) };
            let depth = |k: PerPascal, work: f64| k * work * passes;
            let Some(film) = &self.films[body] else {
                return work.mapv(|work| depth(coefficient.rate.bare(), work));
            };
            let states = film.states([&pair.lower, &pair.upper][body]);
            let mut depths = work.clone();
            let growing = GrowthSums::new(&sums[body][1..]);
            for (cell, value) in depths.iter_mut().enumerate() {
                let thickness = film.mean_thickness(states.state_of(cell), growing.sums_of(cell), passes);
                *value = depth(coefficient.under(thickness / film.max_thickness), *value);
            }
            depths
        })
    }
}

impl Law for Wear {
    fn name(&self) -> &str {
        WEAR
    }

    fn prepare(&mut self, pair: &mut Pair) {
        for (body, coefficient) in [&mut pair.lower, &mut pair.upper].into_iter().zip(&self.coefficients) {
            if coefficient.is_some() && !body.state.contains_key(WEAR) {
                let values = Field::zeros(body.heights.raw_dim());
                body.state.insert(WEAR.to_owned(), State { unit: "m".to_owned(), values });
            }
        }
    }

    fn sums(&self) -> usize {
        // The sums of films are needed only if films reduce the wear.
        if self.films.iter().any(Option::is_some) { 1 + GrowthSums::SUMS } else { 1 }
    }

    fn add(&self, _: &Pair, contact_cells: &ContactCells, sums: &mut [Vec<Field>; 2]) {
        for (body, sums) in sums.iter_mut().enumerate() {
            if let Some(coefficient) = self.coefficients[body] {
                let driver = match coefficient.rate {
                    WearRate::Energy(_) => contact_cells.shear,
                    _ => contact_cells.pressure,
                };
                contact_cells
                    .add(body, &mut sums[0], |index| driver[index] * contact_cells.sliding_distance(index));
                if let Some(film) = &self.films[body] {
                    film.add_rates(body, contact_cells, &mut sums[1..]);
                }
            }
        }
    }

    fn uncovers(&self) -> bool {
        true
    }

    fn per_pressure(&self, friction: f64) -> [PerPascal; 2] {
        self.coefficients
            .map(|coefficient| coefficient.map_or(0.0, |coefficient| coefficient.rate.per_pressure(friction)))
    }

    fn per_pressure_of_cells(&self, pair: &Pair, sums: &[Vec<Field>; 2], friction: f64) -> [CellValues; 2] {
        let bare = self.per_pressure(friction);
        [0, 1].map(|body| match (&self.coefficients[body], &self.films[body]) {
            (Some(coefficient), Some(film)) => {
                let states = film.states([&pair.lower, &pair.upper][body]);
                let growing = GrowthSums::new(&sums[body][1..]);
                let mut cells = Field::zeros(sums[body][0].raw_dim());
                for (cell, value) in cells.iter_mut().enumerate() {
                    let thickness = film.mean_thickness(states.state_of(cell), growing.sums_of(cell), 1.0);
                    let share = coefficient.under(thickness / film.max_thickness) / coefficient.rate.bare();
                    *value = bare[body] * share;
                }
                cells.into()
            }
            _ => bare[body].into(),
        })
    }

    fn advance(&self, pair: &mut Pair, sums: &[Vec<Field>; 2], passes: f64) -> [Field; 2] {
        let depths = self.depths(pair, sums, passes);
        for (body, depth) in [&mut pair.lower, &mut pair.upper].into_iter().zip(&depths) {
            if let Some(worn) = body.state.get_mut(WEAR) {
                worn.values += depth;
            }
        }
        depths
    }

    fn deepest(&self, pair: &Pair) -> [Metre; 2] {
        of_bodies(pair, largest)
    }

    fn record_pass(&self, pair: &Pair, taken: &[Field; 2], columns: &mut LawsInPass) {
        [columns.max_wear_lower, columns.max_wear_upper] = [largest(&taken[0]), largest(&taken[1])];
        [columns.deepest_wear_lower, columns.deepest_wear_upper] = self.deepest(pair);
    }

    fn record_update(&self, pair: &Pair, _: &Contact, columns: &mut LawsInUpdate) {
        [columns.max_wear_lower, columns.max_wear_upper] = self.deepest(pair);
    }

    fn record_cycles(&self, pair: &Pair, columns: &mut LawsInCycles) {
        let volumes = of_bodies(pair, |worn| pair.cell_area() * worn.sum());
        [columns.worn_volume_lower, columns.worn_volume_upper] = volumes;
        [columns.max_wear_lower, columns.max_wear_upper] = self.deepest(pair);
    }
}

/// Evaluates the depths worn since the beginning of the lower and of the upper body; 0 for a body that does
/// not store them.
fn of_bodies(pair: &Pair, value: impl Fn(&Field) -> f64) -> [f64; 2] {
    [&pair.lower, &pair.upper].map(|body: &Body| body.state.get(WEAR).map_or(0.0, |worn| value(&worn.values)))
}

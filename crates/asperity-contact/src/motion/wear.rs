//! Wear: material removed from a body by sliding.

use crate::error::{Error, Result, check_in};
use crate::grid::{CellValues, Field};
use crate::motion::body::State;
use crate::motion::film::{Film, GrowthSums};
use crate::motion::law::{ContactCells, Law};
use crate::motion::pair::Pair;
use crate::units::{Dimension, PerPascal};

/// Name of the wear law, and of the body state that stores the depth worn since the beginning, m.
pub const WEAR: &str = "wear";

/// Wear coefficient of a body: it gives the depth that a cell loses while it slides by ds.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct WearCoefficient {
    /// The coefficient of the bare body k₀, > 0.
    pub bare: PerPascal,
    /// The coefficient k_f under a film of largest thickness, 0 to k₀; k₀ for a body without film.
    pub under_film: PerPascal,
    /// The quantity to which wear is proportional.
    pub driver: WearDriver,
}

/// Quantity to which wear is proportional.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WearDriver {
    /// The pressure: k p ds, Archard's law.
    Pressure,
    /// The shear traction: α |q| ds, wear proportional to the frictional energy.
    Shear,
}

impl WearCoefficient {
    /// Creates Archard's law with the coefficient k in 1/Pa: volume over load and distance.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn archard(bare: PerPascal) -> Result<Self> {
        Self { bare, under_film: bare, driver: WearDriver::Pressure }.checked()
    }

    /// Creates wear proportional to the frictional energy, with α in 1/Pa, which is m³/J.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn energy(bare: PerPascal) -> Result<Self> {
        Self { bare, under_film: bare, driver: WearDriver::Shear }.checked()
    }

    /// Sets the coefficient under a film of largest thickness.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if it is below 0 or above that of the bare body.
    pub fn with_film(self, under_film: PerPascal) -> Result<Self> {
        Self { under_film, ..self }.checked()
    }

    fn checked(self) -> Result<Self> {
        let dimension = Dimension::WearCoefficient;
        let finite = self.bare > 0.0 && self.bare.is_finite();
        check_in(dimension, "coefficient", self.bare, finite, "a coefficient above 0")?;
        let less = (0.0..=self.bare).contains(&self.under_film);
        check_in(
            dimension,
            "under_film",
            self.under_film,
            less,
            "a coefficient from 0 to that of the bare body",
        )?;
        Ok(self)
    }

    /// Coefficient under a film with the fraction `part` of its largest thickness.
    fn under(&self, part: f64) -> PerPascal {
        self.bare - (self.bare - self.under_film) * part.min(1.0)
    }
}

/// Wear of both bodies, reduced by their films.
///
/// At frozen contact, a pass removes the depth k Σ p |Δs| from a cell. In an extrapolation over many passes, k is its mean
/// while the film grows or is removed at the rates of the computed pass.
#[derive(Debug, Clone)]
pub struct Wear {
    coefficients: [Option<WearCoefficient>; 2],
    /// The films that reduce the coefficients.
    films: [Option<Film>; 2],
}

impl Wear {
    /// Creates the wear of the lower and of the upper body, with their `films`; `None` for a body that does not wear.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for a coefficient under a film on a body without film.
    pub fn new(coefficients: [Option<WearCoefficient>; 2], films: [Option<Film>; 2]) -> Result<Self> {
        let lowered = coefficients.map(|coefficient| coefficient.is_some_and(|k| k.under_film != k.bare));
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
                return work.mapv(|work| depth(coefficient.bare, work));
            };
            let states = film.states([&pair.lower, &pair.upper][body]);
            let mut depths = work.clone();
            let growing = GrowthSums::of(&sums[body][1..]);
            for (cell, value) in depths.iter_mut().enumerate() {
                let thickness = film.mean_thickness(states.at(cell), growing.at(cell), passes);
                *value = depth(coefficient.under(thickness / film.max_thickness()), *value);
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
                let driver = match coefficient.driver {
                    WearDriver::Pressure => contact_cells.pressure,
                    WearDriver::Shear => contact_cells.shear,
                };
                contact_cells
                    .add(body, &mut sums[0], |index| driver[index] * contact_cells.sliding_distance(index));
                if let Some(film) = &self.films[body] {
                    film.add_rates(body, contact_cells, &mut sums[1..]);
                }
            }
        }
    }

    fn per_pressure(&self, friction: f64) -> [PerPascal; 2] {
        self.coefficients.map(|coefficient| match coefficient {
            None => 0.0,
            Some(WearCoefficient { bare, driver: WearDriver::Pressure, .. }) => bare,
            Some(WearCoefficient { bare, driver: WearDriver::Shear, .. }) => bare * friction,
        })
    }

    fn per_pressure_of_cells(&self, pair: &Pair, sums: &[Vec<Field>; 2], friction: f64) -> [CellValues; 2] {
        let bare = self.per_pressure(friction);
        [0, 1].map(|body| match (&self.coefficients[body], &self.films[body]) {
            (Some(coefficient), Some(film)) => {
                let states = film.states([&pair.lower, &pair.upper][body]);
                let growing = GrowthSums::of(&sums[body][1..]);
                let mut cells = Field::zeros(sums[body][0].raw_dim());
                for (cell, value) in cells.iter_mut().enumerate() {
                    let thickness = film.mean_thickness(states.at(cell), growing.at(cell), 1.0);
                    let share = coefficient.under(thickness / film.max_thickness()) / coefficient.bare;
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
}

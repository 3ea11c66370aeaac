//! `[lower.wear]`, `[lower.film]` and `[temperature]`: running-in of the bodies.

use serde::Serialize;

use super::cursor::Table;
use super::schema::body::both as body;
use super::schema::running_in::{arrhenius, film, mechano_chemical, solid_lubricant, temperature, wear};
use super::schema::tables::{known_in, suits_choice};
use super::schema::values::running::LawKind;
use super::{Body, Case, Hardness};
use asperity_base::choice::Choice;
use asperity_base::error::Result;
use asperity_base::units::{Kelvin, Metre, Pascal, PerPascal};
use asperity_contact::motion::{
    Acceleration, Film, FilmLaw, Films, Pair, Simulation, StagedLoading, Wear, WearCoefficient, WearInPlace,
};
use asperity_contact::temperature::Thermal;

/// Wear of a body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct WearSpec {
    /// Volume lost, per load and distance slid or per frictional energy.
    #[serde(flatten)]
    pub coefficient: WearKey,
    /// The coefficient under a film of largest thickness; by default that of the bare body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub under_film: Option<PerPascal>,
}

/// One of the keys `coefficient`, `dimensionless` and `energy`. The second is resolved to the first.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum WearKey {
    /// Per load and distance slid.
    Coefficient(PerPascal),
    /// Per frictional energy.
    Energy(PerPascal),
}

/// A tribofilm on a body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct FilmSpec {
    /// Law of its growth and removal.
    #[serde(flatten)]
    pub law: FilmLaw,
    /// Largest thickness.
    pub max_thickness: Metre,
    /// Hardness of its cells at the largest thickness; by default that of the body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hardness: Option<Pascal>,
}

/// Temperatures of the bodies.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct TemperatureSpec {
    /// Temperatures of the lower and of the upper body far from the contact.
    pub bulk: [Kelvin; 2],
    /// Interval of the computed passes with a computed flash temperature; 0 for none.
    pub every: usize,
}

/// Reads the wear from the table of a body.
pub(super) fn wear(table: &Table<'_>, hardness: &Hardness) -> Result<WearSpec> {
    known_in(table)?;
    let keys = ["coefficient", "dimensionless", "energy"];
    let coefficient = match table.exactly_one(&keys, "for example `coefficient = \"1e-7 mm3/(N m)\"`")? {
        "coefficient" => WearKey::Coefficient(wear::COEFFICIENT.required(table)?),
        "energy" => WearKey::Energy(wear::ENERGY.required(table)?),
        _ => {
            let number = wear::DIMENSIONLESS.required(table)?;
            match hardness {
                Hardness::Uniform(hardness) if hardness.is_finite() => {
                    WearKey::Coefficient(number / hardness)
                }
                _ => {
                    let message = "'dimensionless' needs a 'hardness' of the body";
                    let hint = "give one hardness to this body, or `coefficient = \"1e-7 mm3/(N m)\"`";
                    let entry = wear::DIMENSIONLESS.demand(table)?;
                    return Err(entry.error(message.to_owned(), Some(hint.to_owned())));
                }
            }
        }
    };
    let (WearKey::Coefficient(bare) | WearKey::Energy(bare)) = coefficient;
    let under_film = wear::UNDER_FILM.of(table)?;
    if under_film.is_some_and(|under_film| under_film > bare) {
        let entry = wear::UNDER_FILM.demand(table)?;
        return Err(entry.unexpected("no more than the coefficient of the bare body", None));
    }
    Ok(WearSpec { coefficient, under_film })
}

/// Reads the film from the table of a body.
pub(super) fn film(table: &Table<'_>, body: &Hardness) -> Result<FilmSpec> {
    known_in(table)?;
    let law = film::LAW.of(table)?;
    suits_choice(table, &format!("law = \"{}\"", law.word()))?;
    let max_thickness = film::MAX_THICKNESS.of(table)?;
    let law = match law {
        LawKind::Arrhenius => FilmLaw::Arrhenius {
            rate: arrhenius::RATE.of(table)?,
            at_temperature: arrhenius::AT_TEMPERATURE.of(table)?,
            at_stress: arrhenius::AT_STRESS.of(table)?,
            activation_energy: arrhenius::ACTIVATION_ENERGY.of(table)?,
            activation_volume: arrhenius::ACTIVATION_VOLUME.of(table)?,
            stress: arrhenius::STRESS.of(table)?,
            removal: arrhenius::REMOVAL.of(table)?,
        },
        LawKind::MechanoChemical => {
            let c3 = mechano_chemical::C3.of(table)?;
            if c3 > max_thickness {
                let entry = mechano_chemical::C3.demand(table)?;
                return Err(entry.unexpected("no more than 'max_thickness'", None));
            }
            FilmLaw::MechanoChemical {
                x: mechano_chemical::X.of(table)?,
                c3,
                c4: mechano_chemical::C4.of(table)?,
            }
        }
        LawKind::SolidLubricant => FilmLaw::SolidLubricant { wear: solid_lubricant::WEAR.of(table)? },
    };
    let hardness = film::HARDNESS.of(table)?;
    if let (Some(hardness), Hardness::Uniform(body)) = (hardness, body)
        && hardness > *body
    {
        let hint = "give the body a 'hardness', or leave out the hardness of the film".to_owned();
        return Err(film::HARDNESS
            .demand(table)?
            .unexpected("no more than the hardness of the body", Some(hint)));
    }
    Ok(FilmSpec { law, max_thickness, hardness })
}

/// Reads the thermal constants of a body, all of them or none. The conductivity `is_alone` if the others are not needed.
pub(super) fn thermal(table: &Table<'_>, is_alone: bool) -> Result<Option<Thermal>> {
    let keys = [body::CONDUCTIVITY, body::HEAT_CAPACITY, body::DENSITY];
    if keys[usize::from(is_alone)..].iter().all(|key| key.entry(table).is_none()) {
        return Ok(None);
    }
    let [conductivity, heat_capacity, density] = keys.map(|key| key.required(table));
    Thermal::new(conductivity?, heat_capacity?, density?).map(Some)
}

/// `[temperature]`, with the flash temperature at each position if the bodies are `heated`.
pub(super) fn temperature(table: &Table<'_>, heated: bool) -> Result<TemperatureSpec> {
    known_in(table)?;
    let bulk = temperature::BULK.of(table)?;
    Ok(TemperatureSpec { bulk, every: temperature::EVERY.of(table)?.unwrap_or(usize::from(heated)) })
}

impl Case {
    /// Adds to a motion the laws of wear and film growth of its bodies.
    ///
    /// # Errors
    /// The errors of the library.
    pub(crate) fn running(&self, simulation: Simulation) -> Result<Simulation> {
        let (wear, films) = self.laws(simulation.pair())?;
        let mut simulation = simulation;
        if let Some(wear) = wear {
            simulation = simulation.with_law(wear);
        }
        if let Some(films) = films {
            simulation = simulation.with_law(films);
        }
        if let (Some(thermal), Some(temperature)) = (self.heated(), self.temperature) {
            simulation = simulation.with_heat(thermal, temperature.every)?;
        }
        match self.acceleration {
            Some(acceleration) => simulation.with_acceleration(acceleration),
            None => Ok(simulation),
        }
    }

    /// Adds the same laws to a contact that wears in place.
    ///
    /// # Errors
    /// The errors of the library.
    pub(crate) fn wearing(&self, contact: WearInPlace) -> Result<WearInPlace> {
        let (wear, films) = self.laws(contact.pair())?;
        let mut contact = contact;
        if let Some(wear) = wear {
            contact = contact.with_law(wear);
        }
        if let Some(films) = films {
            contact = contact.with_law(films);
        }
        match self.heated() {
            Some(thermal) => contact.with_heat(thermal),
            None => Ok(contact),
        }
    }

    /// Adds the same laws to a loading in stages.
    ///
    /// # Errors
    /// The errors of the library.
    pub(crate) fn fretting(&self, loading: StagedLoading) -> Result<StagedLoading> {
        let (wear, films) = self.laws(loading.pair())?;
        let mut loading = loading;
        if let Some(wear) = wear {
            loading = loading.with_law(wear);
        }
        if let Some(films) = films {
            loading = loading.with_law(films);
        }
        if let Some(temperature) = self.temperature {
            loading = loading.with_bulk(temperature.bulk);
        }
        Ok(loading.with_acceleration(self.acceleration.unwrap_or(Acceleration::NONE)))
    }

    /// Creates the laws of wear and film growth of the bodies of a `pair`.
    fn laws(&self, pair: &Pair) -> Result<(Option<Wear>, Option<Films>)> {
        let bodies = [&self.lower, &self.upper];
        let films = bodies.map(|body| body.film.as_ref().map(FilmSpec::film).transpose());
        let [lower, upper] = films;
        let films = [lower?, upper?];
        let coefficients = bodies.map(|body| body.wear.as_ref().map(WearSpec::coefficient).transpose());
        let [lower, upper] = coefficients;
        let coefficients = [lower?, upper?];
        let wears = coefficients.iter().any(Option::is_some);
        let wear = wears.then(|| Wear::new(coefficients, films.clone())).transpose()?;
        let grows = films.iter().any(Option::is_some);
        Ok((wear, grows.then(|| Films::new(films, pair)).transpose()?))
    }

    /// Returns the thermal constants of bodies heated by friction; `None` if this is not computed.
    fn heated(&self) -> Option<[Thermal; 2]> {
        let wanted = self.temperature.is_some_and(|temperature| temperature.every > 0);
        Some([self.lower.thermal?, self.upper.thermal?]).filter(|_| wanted)
    }

    /// Whether bodies wear or grow films.
    pub fn runs_in(&self) -> bool {
        [&self.lower, &self.upper].iter().any(|body| body.wear.is_some() || body.film.is_some())
    }
}

impl Body {
    /// Depth that the body loses per pressure and distance slid, 1/Pa, with shear equal to `friction` times the pressure.
    pub(crate) fn wear_per_pressure(&self, friction: f64) -> PerPascal {
        match self.wear {
            None => 0.0,
            Some(WearSpec { coefficient: WearKey::Coefficient(bare), .. }) => bare,
            Some(WearSpec { coefficient: WearKey::Energy(bare), .. }) => bare * friction,
        }
    }
}

impl WearSpec {
    fn coefficient(&self) -> Result<WearCoefficient> {
        let bare = match self.coefficient {
            WearKey::Coefficient(bare) => WearCoefficient::archard(bare),
            WearKey::Energy(bare) => WearCoefficient::energy(bare),
        }?;
        self.under_film.map_or(Ok(bare), |under_film| bare.with_film(under_film))
    }
}

impl FilmSpec {
    fn film(&self) -> Result<Film> {
        Film::new(self.law, self.max_thickness, self.hardness)
    }
}

//! `[lower.wear]`, `[lower.film]`, `[acceleration]` and `[temperature]`: how bodies run in.

use serde::Serialize;

use super::cursor::{Entry, Table};
use super::schema::body::both as body;
use super::schema::tables::{known_in, suits_choice};
use super::schema::wear::{
    acceleration, arrhenius, film, mechano_chemical, solid_lubricant, temperature, wear,
};
use super::{Body, Boundary, Case, CounterBody, Hardness, MotionSpec, SlidingSpec};
use crate::choice::{Choice, choice};
use crate::error::Result;
use crate::motion::{
    Acceleration, Film, FilmLaw, FilmStress, Films, InPlace, Pair, PlasticUpdate, Simulation, Strategy, Wear,
    WearCoefficient,
};
use crate::temperature::Thermal;
use crate::units::{Dimension, Kelvin, Metre, Pascal, PerPascal};

/// Wear of a body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct WearSpec {
    /// Volume lost, per load and distance slid or per energy of friction.
    #[serde(flatten)]
    pub coefficient: WearKey,
    /// The coefficient where the film is at its thickest; that of the bare body if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub under_film: Option<PerPascal>,
}

/// One of the keys `coefficient`, `dimensionless` and `energy`, the second of which is resolved to the first.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum WearKey {
    /// Per load and distance slid.
    Coefficient(PerPascal),
    /// Per energy of friction.
    Energy(PerPascal),
}

/// A tribofilm on a body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct FilmSpec {
    /// How it grows and is removed.
    #[serde(flatten)]
    pub law: FilmLaw,
    /// The thickness that it cannot exceed.
    pub max_thickness: Metre,
    /// What its cells bear where it is at its thickest; what the body bears if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hardness: Option<Pascal>,
}

/// A [`FilmLaw`] without its parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LawKind {
    Arrhenius,
    MechanoChemical,
    SolidLubricant,
}

choice!(LawKind: "arrhenius" => Arrhenius, "mechano-chemical" => MechanoChemical, "solid-lubricant" => SolidLubricant);

/// Temperatures of the bodies.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct TemperatureSpec {
    /// Temperatures of the lower and of the upper body far from the contact.
    pub bulk: [Kelvin; 2],
    /// Computed passes from one of which the flash temperature is computed to the next; 0 if in none.
    pub every: usize,
}

/// Wear in the table of a body.
pub(super) fn wear(table: &Table<'_>, hardness: &Hardness, film: Option<&FilmSpec>) -> Result<WearSpec> {
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
                    let message = "'dimensionless' is multiplied with the load over the 'hardness', of which there is none";
                    let hint = "give one hardness to this body, or `coefficient = \"1e-7 mm3/(N m)\"`";
                    let entry = wear::DIMENSIONLESS.demand(table)?;
                    return Err(entry.error(message.to_owned(), Some(hint.to_owned())));
                }
            }
        }
    };
    let (WearKey::Coefficient(bare) | WearKey::Energy(bare)) = coefficient;
    Ok(WearSpec { coefficient, under_film: under_film(table, bare, film.is_some())? })
}

fn under_film(table: &Table<'_>, bare: PerPascal, has_film: bool) -> Result<Option<PerPascal>> {
    let Some(entry) = wear::UNDER_FILM.entry(table) else { return Ok(None) };
    if !has_film {
        let hint = "give the body a film, or leave 'under_film' out".to_owned();
        return Err(entry.error("'under_film' belongs to a body with a film".to_owned(), Some(hint)));
    }
    let under_film = wear::UNDER_FILM.required(table)?;
    if under_film > bare {
        return Err(entry.unexpected("no more than the coefficient of the bare body", None));
    }
    Ok(Some(under_film))
}

/// The film in the table of a body.
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
    if let (Some(entry), Some(hardness), Hardness::Uniform(body)) =
        (film::HARDNESS.entry(table), hardness, body)
    {
        let hint = Some("a film that bears more than its body is one without a 'hardness'".to_owned());
        if !body.is_finite() {
            return Err(entry.error("a film has a 'hardness' where its body has one".to_owned(), hint));
        }
        if hardness > *body {
            return Err(entry.unexpected("no more than the hardness of the body", hint));
        }
    }
    Ok(FilmSpec { law, max_thickness, hardness })
}

/// `[acceleration]`.
pub(super) fn acceleration(table: &Table<'_>) -> Result<Acceleration> {
    known_in(table)?;
    Ok(Acceleration::default()
        .with_tolerance(acceleration::TOLERANCE.of(table)?)
        .with_max_jump(acceleration::MAX_JUMP.of(table)?)
        .with_max_wear(acceleration::MAX_WEAR.of(table)?))
}

/// The thermal constants of a body, all of them or none.
pub(super) fn thermal(table: &Table<'_>) -> Result<Option<Thermal>> {
    let keys = [body::CONDUCTIVITY, body::HEAT_CAPACITY, body::DENSITY];
    if keys.iter().all(|key| key.entry(table).is_none()) {
        return Ok(None);
    }
    let [conductivity, heat_capacity, density] = keys.map(|key| key.required(table));
    Thermal::new(conductivity?, heat_capacity?, density?).map(Some)
}

/// The temperatures of the lower and of the upper body.
pub(super) fn bulk(entry: &Entry<'_>) -> Result<[Kelvin; 2]> {
    let expected = "a temperature above 0 K such as \"100 °C\", or two: of the lower and of the upper body";
    entry.pair(expected, |item| item.positive(Dimension::Temperature))
}

/// `[temperature]`, with the flash temperature where both bodies have thermal constants.
pub(super) fn temperature(
    root: &Table<'_>,
    bodies: [&Body; 2],
    motion: Option<&MotionSpec>,
    sliding: Option<&SlidingSpec>,
    boundary: Boundary,
) -> Result<Option<TemperatureSpec>> {
    let given = bodies.map(|body| body.thermal.is_some());
    if given[0] != given[1] {
        let [with, without] = if given[0] { ["lower", "upper"] } else { ["upper", "lower"] };
        let hint = Some(format!("heat is divided between both: give them to [{without}], too"));
        let message = format!("[{with}] has thermal constants, [{without}] has none");
        return Err(root.required_table(with)?.required("conductivity", "")?.error(message, hint));
    }
    let Some(table) = root.table("temperature")? else {
        return match given[0] {
            true => {
                let entry = root.required_table("lower")?.required("conductivity", "")?;
                let hint = Some("add `[temperature]` with `bulk = \"100 °C\"`".to_owned());
                Err(entry.error("thermal constants are those of a case with [temperature]".to_owned(), hint))
            }
            false => Ok(None),
        };
    };
    known_in(&table)?;
    if motion.is_none() && sliding.is_none() {
        return Err(table.error("a contact at rest has no [temperature]".to_owned(), None));
    }
    let bulk = temperature::BULK.of(&table)?;
    let every = temperature::EVERY.of(&table)?.unwrap_or(usize::from(given[0]));
    if let (Some(entry), Some(_), 2..) = (table.get("every"), sliding, every) {
        return Err(entry.unexpected("1, the flash temperature of each update, or 0, none", None));
    }
    let is_fresh = motion.is_some_and(|motion| motion.counter == CounterBody::Fresh);
    if let (Some(entry), true, 2..) = (table.get("every"), is_fresh, every) {
        return Err(entry.unexpected("1 or 0: a fresh counter-body has not been warm before", None));
    }
    if every > 0 {
        let place = table.get("every");
        let refused = |message: &str, hint: &str| {
            let (message, hint) = (message.to_owned(), Some(hint.to_owned()));
            Err(place.as_ref().map_or_else(
                || table.error(message.clone(), hint.clone()),
                |entry| entry.error(message.clone(), hint.clone()),
            ))
        };
        if !given[0] {
            let hint = "give both bodies `conductivity`, `heat_capacity` and `density`, or set `every = 0`";
            return refused("a flash temperature needs thermal constants", hint);
        }
        if root.table("friction")?.is_none() {
            return refused(
                "without [friction] nothing is heated",
                "add a [friction] table, or set `every = 0`",
            );
        }
        if sliding.is_some_and(|sliding| sliding.speed.is_none()) {
            let hint = "for example `speed = \"10 mm/s\"` in [sliding]";
            return refused("a flash temperature needs a speed", hint);
        }
        if motion.is_some_and(|motion| motion.strategy == Strategy::Overlap && motion.speed.is_none()) {
            return refused(
                "a flash temperature needs a speed",
                "for example `speed = \"0.5 m/s\"` in [motion]",
            );
        }
        if motion.is_some_and(|motion| motion.strategy != Strategy::Overlap) && !boundary.repeats(0) {
            return refused(
                "the heat of surfaces that go round goes round with them: their boundary is periodic along x",
                "set `boundary = \"periodic\"` in [contact], or `every = 0`",
            );
        }
        if motion.is_some_and(|motion| motion.plastic_update == PlasticUpdate::Step) {
            return refused(
                "a flash temperature is that of bodies that stay as they are in a pass",
                "set `plastic_update = \"pass\"`",
            );
        }
    }
    Ok(Some(TemperatureSpec { bulk, every }))
}

/// An error if what runs in does not move, has no speed or rubs nothing.
pub(super) fn runs_in(
    root: &Table<'_>,
    bodies: [&Body; 2],
    motion: Option<&MotionSpec>,
    sliding: Option<&SlidingSpec>,
) -> Result<()> {
    let has_friction = root.table("friction")?.is_some();
    for (name, body) in ["lower", "upper"].into_iter().zip(bodies) {
        let body_table = root.required_table(name)?;
        for key in ["wear", "film"] {
            let Some(table) = body_table.table(key)? else { continue };
            if let Some(sliding) = sliding {
                if key == "film" && sliding.speed.is_none() {
                    let hint = Some("for example `speed = \"10 mm/s\"` in [sliding]".to_owned());
                    let message = "missing key 'speed' in [sliding]: films take time".to_owned();
                    return Err(root.required_table("sliding")?.error(message, hint));
                }
                continue;
            }
            let Some(motion) = motion else {
                let hint = Some("add a [motion] with its `speed`, or [sliding]".to_owned());
                return Err(table.error(format!("a contact at rest has no {key}"), hint));
            };
            let motion_table = root.required_table("motion")?;
            let has_speed = match motion.strategy {
                Strategy::Overlap => motion.speed.is_some(),
                Strategy::Shift { .. } => {
                    motion_table.get("speed_upper").or(motion_table.get("speed_lower")).is_some()
                }
            };
            if !has_speed {
                let (key, hint) = match motion.strategy {
                    Strategy::Overlap => ("speed", "for example `speed = \"0.5 m/s\"` in [motion]"),
                    Strategy::Shift { .. } => {
                        ("speed_upper", "for example `speed_upper = \"0.5 m/s\"` in [motion]")
                    }
                };
                return Err(motion_table.error(
                    format!("missing key '{key}' in [motion]: wear and films take time"),
                    Some(hint.to_owned()),
                ));
            }
            if key == "wear" && motion.strategy.direction() == 0.0 {
                let hint = Some("give the speeds different values, or leave the wear out".to_owned());
                return Err(table.error("surfaces that roll at equal speeds do not wear".to_owned(), hint));
            }
            if motion.plastic_update == PlasticUpdate::Step {
                let entry = motion_table.required("plastic_update", "\"pass\"")?;
                return Err(entry.unexpected("\"pass\" where bodies wear or grow films", None));
            }
        }
        let needs_friction = match body {
            Body { wear: Some(WearSpec { coefficient: WearKey::Energy(_), .. }), .. } => {
                Some(("wear", "energy"))
            }
            Body {
                film: Some(FilmSpec { law: FilmLaw::Arrhenius { stress: FilmStress::Shear, .. }, .. }),
                ..
            } => Some(("film", "stress")),
            _ => None,
        };
        if let (Some((table, key)), false) = (needs_friction, has_friction) {
            let table = body_table.required_table(table)?;
            let hint = Some("add a [friction] table with its `coefficient`".to_owned());
            return Err(table.required(key, "")?.error(format!("'{key}' needs friction"), hint));
        }
        if body.film.is_some() && root.table("temperature")?.is_none() {
            let hint = Some("add `[temperature]` with `bulk = \"100 °C\"`".to_owned());
            return Err(body_table
                .required_table("film")?
                .error("a film grows at a temperature".to_owned(), hint));
        }
    }
    Ok(())
}

impl Case {
    /// The motion with the laws by which its bodies wear and grow films.
    ///
    /// # Errors
    /// What the library has against them.
    pub(in crate::study) fn running(&self, simulation: Simulation) -> Result<Simulation> {
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

    /// A contact that slides in place with the same laws.
    ///
    /// # Errors
    /// What the library has against them.
    pub(in crate::study) fn wearing(&self, contact: InPlace) -> Result<InPlace> {
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

    /// The laws by which the bodies of a `pair` wear and grow films.
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

    /// The thermal constants of bodies that friction heats; none where that is not computed.
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
    /// The depth that the body loses per pressure and distance slid where shear is `friction` times the pressure, 1/Pa.
    pub(in crate::study) fn wear_per_pressure(&self, friction: f64) -> PerPascal {
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

//! `[lower.wear]`, `[lower.film]`, `[acceleration]` and `[temperature]`: how bodies run in.

use serde::Serialize;

use super::cursor::{Entry, Table};
use super::keys::known_in;
use super::{Body, Boundary, Case, CounterBody, Hardness, MotionSpec, SlidingSpec};
use crate::choice::{Choice, choice};
use crate::error::Result;
use crate::motion::{
    ACTIVATION_ENERGIES, ACTIVATION_VOLUMES, Acceleration, Film, FilmLaw, FilmStress, Films, GROWTH_FACTORS,
    GROWTH_TEMPERATURES, InPlace, Pair, PlasticUpdate, REMOVAL_RATES, Simulation, Strategy, Wear,
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

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum LawKind {
    Arrhenius,
    MechanoChemical,
}

choice!(LawKind: "arrhenius" => Arrhenius, "mechano-chemical" => MechanoChemical);

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
    let positive = |key: &str, example| table.required(key, example)?.positive(Dimension::WearCoefficient);
    let coefficient = match table.exactly_one(&keys, "for example `coefficient = \"1e-7 mm3/(N m)\"`")? {
        "coefficient" => WearKey::Coefficient(positive("coefficient", "\"1e-7 mm3/(N m)\"")?),
        "energy" => WearKey::Energy(positive("energy", "\"1e-6 mm3/J\"")?),
        _ => {
            let entry = table.required("dimensionless", "4e-7")?;
            let number = entry.number(|value| value > 0.0, "a number above 0 such as 4e-7")?;
            match hardness {
                Hardness::Uniform(hardness) if hardness.is_finite() => {
                    WearKey::Coefficient(number / hardness)
                }
                _ => {
                    let message = "'dimensionless' is multiplied with the load over the 'hardness', of which there is none";
                    let hint = "give one hardness to this body, or `coefficient = \"1e-7 mm3/(N m)\"`";
                    return Err(entry.error(message.to_owned(), Some(hint.to_owned())));
                }
            }
        }
    };
    let (WearKey::Coefficient(bare) | WearKey::Energy(bare)) = coefficient;
    let under_film =
        table.get("under_film").map(|entry| under_film(&entry, bare, film.is_some())).transpose()?;
    Ok(WearSpec { coefficient, under_film })
}

fn under_film(entry: &Entry<'_>, bare: PerPascal, has_film: bool) -> Result<PerPascal> {
    if !has_film {
        let hint = "give the body a film, or leave 'under_film' out".to_owned();
        return Err(entry.error("'under_film' belongs to a body with a film".to_owned(), Some(hint)));
    }
    let under_film = entry.positive(Dimension::WearCoefficient)?;
    if under_film > bare {
        return Err(entry.unexpected("no more than the coefficient of the bare body", None));
    }
    Ok(under_film)
}

/// The film in the table of a body.
pub(super) fn film(table: &Table<'_>, body: &Hardness) -> Result<FilmSpec> {
    known_in(table)?;
    let law = table.required("law", "\"arrhenius\"")?.choice::<LawKind>()?;
    let own: &[&str] = match law {
        LawKind::Arrhenius => &["x", "c3", "c4"],
        LawKind::MechanoChemical => &[
            "rate",
            "at_temperature",
            "at_stress",
            "activation_energy",
            "activation_volume",
            "stress",
            "removal",
        ],
    };
    if let Some(entry) = own.iter().find_map(|key| table.get(key)) {
        return Err(
            entry.error(format!("'{}' has no meaning with law = \"{}\"", entry.key(), law.word()), None)
        );
    }
    let positive = |key: &str, example: &str, dimension| table.required(key, example)?.positive(dimension);
    let max_thickness = positive("max_thickness", "\"150 nm\"", Dimension::Length)?;
    let from_0 = |key: &str, example: &str, dimension| {
        let entry = table.required(key, example)?;
        let value = entry.quantity(dimension)?;
        if value >= 0.0 { Ok(value) } else { Err(entry.unexpected("a value of at least 0", None)) }
    };
    let within = |key: &str, example: &str, dimension, range, zero| {
        table.required(key, example)?.within(dimension, range, zero, example)
    };
    let number =
        |key: &str, example: &str, range, zero| table.required(key, example)?.number_within(range, zero);
    let law = match law {
        LawKind::Arrhenius => FilmLaw::Arrhenius {
            rate: positive("rate", "\"20 nm/s\"", Dimension::Speed)?,
            at_temperature: within(
                "at_temperature",
                "\"100 °C\"",
                Dimension::Temperature,
                GROWTH_TEMPERATURES,
                false,
            )?,
            at_stress: from_0("at_stress", "\"3 GPa\"", Dimension::Pressure)?,
            activation_energy: within(
                "activation_energy",
                "\"0.8 eV\"",
                Dimension::Energy,
                ACTIVATION_ENERGIES,
                true,
            )?,
            activation_volume: within(
                "activation_volume",
                "\"3.8e-3 nm3\"",
                Dimension::Volume,
                ACTIVATION_VOLUMES,
                true,
            )?,
            stress: table.choice_or("stress", FilmStress::Pressure)?,
            removal: table
                .get("removal")
                .map_or(Ok(0.0), |_| from_0("removal", "", Dimension::RemovalRate))?,
        },
        LawKind::MechanoChemical => {
            let c3 = from_0("c3", "\"50 nm\"", Dimension::Length)?;
            if c3 > max_thickness {
                return Err(table.required("c3", "")?.unexpected("no more than 'max_thickness'", None));
            }
            FilmLaw::MechanoChemical {
                x: number("x", "1e-16", GROWTH_FACTORS, false)?,
                c3,
                c4: number("c4", "0.01", REMOVAL_RATES, true)?,
            }
        }
    };
    let hardness = match table.get("hardness") {
        None => None,
        Some(entry) => {
            let hardness = entry.positive(Dimension::Pressure)?;
            let hint = || Some("a film that bears more than its body is one without a 'hardness'".to_owned());
            match body {
                Hardness::Uniform(body) if !body.is_finite() => {
                    return Err(
                        entry.error("a film has a 'hardness' where its body has one".to_owned(), hint())
                    );
                }
                Hardness::Uniform(body) if hardness > *body => {
                    return Err(entry.unexpected("no more than the hardness of the body", hint()));
                }
                _ => Some(hardness),
            }
        }
    };
    Ok(FilmSpec { law, max_thickness, hardness })
}

/// `[acceleration]`.
pub(super) fn acceleration(table: &Table<'_>) -> Result<Acceleration> {
    known_in(table)?;
    let default = Acceleration::default();
    let tolerance = table
        .get("tolerance")
        .map(|entry| entry.number(|value| value > 0.0, "a number above 0 such as 0.01"));
    let max_wear = table.get("max_wear").map(|entry| entry.positive(Dimension::Length));
    Ok(default
        .with_tolerance(tolerance.transpose()?.unwrap_or(default.tolerance))
        .with_max_jump(table.get("max_jump").map_or(Ok(default.max_jump), |entry| entry.count(1))?)
        .with_max_wear(max_wear.transpose()?.unwrap_or(default.max_wear)))
}

/// The thermal constants of a body, all of them or none.
pub(super) fn thermal(table: &Table<'_>) -> Result<Option<Thermal>> {
    const KEYS: [&str; 3] = ["conductivity", "heat_capacity", "density"];
    if KEYS.iter().all(|key| table.get(key).is_none()) {
        return Ok(None);
    }
    let conductivity = table.required("conductivity", "\"46 W/(m K)\"")?.positive(Dimension::Conductivity)?;
    let heat_capacity =
        table.required("heat_capacity", "\"460 J/(kg K)\"")?.positive(Dimension::HeatCapacity)?;
    let density = table.required("density", "\"7850 kg/m3\"")?.positive(Dimension::Density)?;
    Thermal::new(conductivity, heat_capacity, density).map(Some)
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
    let entry = table.required("bulk", "\"100 °C\"")?;
    let expected = "a temperature above 0 K such as \"100 °C\", or two: of the lower and of the upper body";
    let bulk = entry.pair(expected, |item| item.positive(Dimension::Temperature))?;
    let every = table.get("every").map_or(Ok(usize::from(given[0])), |entry| entry.count(0))?;
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

//! Keys of running-in: wear, films and temperature.

use super::super::exists;
use super::Bounds::{AboveZero, FromZero, Within};
use super::typed::{
    LENGTH, Optional, PRESSURE, Typed, Value, choice, count, defaulted, number, optional, other, quantity,
    required, section,
};
use super::values::running as read;
use asperity_base::units::Dimension;

const RATE: Value<f64> = quantity(Dimension::WearCoefficient, AboveZero).exists(exists::WEAR);
const FILM: &[&str] = &["lower.film", "upper.film"];
const ONE: &str = "exactly one of the three";

/// `[lower.wear]` and `[upper.wear]`.
pub(crate) mod wear {
    use super::*;

    section! { &["lower.wear", "upper.wear"], "";
        COEFFICIENT: Optional<f64> = optional(
            "coefficient",
            RATE,
            ONE,
            "\"1e-7 mm3/(N m)\"",
            "wear volume per load and sliding distance (Archard)",
        );
        DIMENSIONLESS: Optional<f64> = optional(
            "dimensionless",
            number(AboveZero).exists(exists::WEAR_NUMBER),
            ONE,
            "4e-7",
            "`coefficient` times the `hardness` of the body, which must be a single number",
        );
        ENERGY: Optional<f64> =
            optional("energy", RATE.exists(exists::WEAR_OF_ENERGY), ONE, "\"1e-6 mm3/J\"", "wear volume per frictional energy; requires [friction]");
        UNDER_FILM: Optional<f64> = optional(
            "under_film",
            RATE,
            "the coefficient of the bare body",
            "\"1e-8 mm3/(N m)\"",
            "coefficient under the thickest film, in the unit of `coefficient` or `energy`, also with `dimensionless`, at most \
             the coefficient of the bare body; it decreases linearly with the thickness; the body needs a film",
        );
    }
}

/// `[lower.film]` and `[upper.film]` with any law.
pub(crate) mod film {
    use super::*;

    section! { FILM, "";
        LAW: Typed<read::LawKind> = required(
            "law",
            choice::<read::LawKind>(),
            "\"arrhenius\"",
            "`\"arrhenius\"`: growth activated by stress, removal by sliding; `\"mechano-chemical\"`; `\"solid-lubricant\"`: a film \
             that is there at its thickest in the beginning and is only worn off",
        );
        MAX_THICKNESS: Typed<f64> =
            required("max_thickness", LENGTH.exists(exists::FILM), "\"150 nm\"", "upper limit of the film thickness");
        HARDNESS: Optional<f64> = optional(
            "hardness",
            PRESSURE.exists(exists::HARDNESS),
            "the hardness of the body",
            "\"2 GPa\"",
            "hardness under the thickest film, at most the hardness of the body; interpolated linearly in the thickness",
        );
    }
}

/// A film with `law = "arrhenius"`.
pub(crate) mod arrhenius {
    use super::*;
    use asperity_contact::motion::{
        ACTIVATION_ENERGIES, ACTIVATION_VOLUMES, FilmStress, GROWTH_TEMPERATURES,
    };

    section! { FILM, "law = \"arrhenius\"";
        RATE: Typed<f64> = required(
            "rate",
            quantity(Dimension::Speed, AboveZero).exists(exists::GROWTH),
            "\"20 nm/s\"",
            "initial growth rate, at `at_temperature` and `at_stress`",
        );
        AT_TEMPERATURE: Typed<f64> = required(
            "at_temperature",
            quantity(Dimension::Temperature, Within(GROWTH_TEMPERATURES, false)),
            "\"100 °C\"",
            "temperature at which `rate` holds",
        );
        AT_STRESS: Typed<f64> = required(
            "at_stress",
            quantity(Dimension::Pressure, FromZero).exists(exists::STRESS),
            "\"3 GPa\"",
            "stress at which `rate` holds",
        );
        ACTIVATION_ENERGY: Typed<f64> = required(
            "activation_energy",
            quantity(Dimension::Energy, Within(ACTIVATION_ENERGIES, true)),
            "\"0.8 eV\"",
            "activation energy of the growth",
        );
        ACTIVATION_VOLUME: Typed<f64> = required(
            "activation_volume",
            quantity(Dimension::Volume, Within(ACTIVATION_VOLUMES, true)),
            "\"3.8e-3 nm3\"",
            "activation volume of the growth",
        );
        STRESS: Typed<FilmStress> = defaulted(
            "stress",
            choice::<FilmStress>(),
            "\"pressure\"",
            "\"shear\"",
            "stress that activates the growth; `\"shear\"` requires [friction]",
        );
        REMOVAL: Typed<f64> = defaulted(
            "removal",
            quantity(Dimension::RemovalRate, FromZero).exists(exists::REMOVAL),
            "0",
            "\"1e-11 1/(Pa m)\"",
            "removal per pressure and sliding distance",
        );
    }
}

/// A film with `law = "mechano-chemical"`.
pub(crate) mod mechano_chemical {
    use super::*;
    use crate::case::schema::typed::DEPTH;
    use asperity_contact::motion::{GROWTH_FACTORS, REMOVAL_RATES};

    section! { FILM, "law = \"mechano-chemical\"";
        X: Typed<f64> = required("x", number(Within(GROWTH_FACTORS, false)), "1e-16", "factor x of the growth");
        C3: Typed<f64> = required(
            "c3",
            DEPTH.exists(exists::FILM),
            "\"50 nm\"",
            "final removal C₃ as a thickness, at most `max_thickness`",
        );
        C4: Typed<f64> =
            required("c4", number(Within(REMOVAL_RATES, true)), "0.01", "rate C₄ of the removal, in 1/s");
    }
}

/// A film with `law = "solid-lubricant"`.
pub(crate) mod solid_lubricant {
    use super::*;

    section! { FILM, "law = \"solid-lubricant\"";
        WEAR: Typed<f64> = required(
            "wear",
            RATE,
            "\"1e-6 mm3/(N m)\"",
            "film volume lost per load and sliding distance, until the film is worn off; the heights of the surface include the film",
        );
    }
}

/// `[temperature]`.
pub(crate) mod temperature {
    use super::*;

    section! { &["temperature"], "";
        BULK: Typed<[f64; 2]> = required(
            "bulk",
            other(Some(Dimension::Temperature), "temperature > 0 K, or two: `[lower, upper]`", |_, entry| {
                read::bulk(entry)
            })
            .exists(exists::TEMPERATURE),
            "\"100 °C\"",
            "temperature of the bodies far from the contact; a number without a unit is in kelvin",
        );
        EVERY: Optional<usize> = optional(
            "every",
            count(0),
            "1 with thermal constants, else 0",
            "10",
            "computes the flash temperature at each position of every n-th computed pass, from the first on, for films and results; \
             in other passes each cell has its mean temperature over the contacts of the last of these. It requires the thermal constants \
             of both bodies, [friction] and a speed. 0: the surfaces have the temperatures of the bodies",
        );
    }
}

//! The tables `[lower.film]` and `[upper.film]`.

use serde::Serialize;

use crate::error::{Result, check_in};
use crate::units::{CubicMetre, Dimension, Joule, Kelvin, Metre, MetrePerSecond, Pascal, PerPascal, Range};
use asperity_base::beside::{Beside, Scale};
use asperity_base::choice::choice;
use asperity_base::exists::{HARDNESS, VOLUME_PER_WORK};
use asperity_base::table::{Exists, Source, Table as _, require};
use asperity_derive::{Part, Table};

/// The film of a body: a thickness in each cell, which grows and is removed while the cell is in contact.
#[derive(Table, Debug, Clone, Copy, PartialEq, Serialize)]
#[table("lower.film", "upper.film", check = thinner)]
#[non_exhaustive]
pub struct Film {
    /// Law of growth and removal.
    #[key(part)]
    #[serde(flatten)]
    pub law: FilmLaw,
    /// Upper limit of the film thickness.
    #[key(quantity = Length, range = AboveZero, example = "\"150 nm\"", exists = THICKNESS, beside = [THIN])]
    pub max_thickness: Metre,
    /// Hardness under the thickest film, at most the hardness of the body; interpolated linearly in the
    /// thickness.
    #[key(
        quantity = Pressure,
        range = AboveZero,
        absent = "the hardness of the body",
        example = "\"2 GPa\"",
        exists = HARDNESS,
        beside = [Beside::least(Scale::Hardness, 1e-3, "hardly any film is so soft")]
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hardness: Option<Pascal>,
}

/// Law of growth and removal of a film.
#[derive(Part, Debug, Clone, Copy, PartialEq, Serialize)]
#[part(
    key = "law",
    example = "\"arrhenius\"",
    meaning = "`\"arrhenius\"`: growth activated by stress, removal by sliding; `\"mechano-chemical\"`; `\"solid-lubricant\"`: a film that is there \
               at its thickest in the beginning and is only worn off"
)]
#[serde(tag = "law", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FilmLaw {
    /// df/dt = G (1 − f/f_max) − R f, where G follows Arrhenius under a stress σ and R = r p v.
    Arrhenius {
        /// Initial growth rate, at `at_temperature` and `at_stress`.
        #[key(quantity = Speed, range = AboveZero, example = "\"20 nm/s\"", exists = GROWTH)]
        rate: MetrePerSecond,
        /// Temperature at which `rate` holds.
        #[key(quantity = Temperature, range = Within(TEMPERATURES, false), example = "\"100 °C\"")]
        at_temperature: Kelvin,
        /// Stress at which `rate` holds.
        #[key(quantity = Pressure, range = FromZero, example = "\"3 GPa\"", exists = STRESS)]
        at_stress: Pascal,
        /// Activation energy of the growth.
        #[key(quantity = Energy, range = Within(ENERGIES, true), example = "\"0.8 eV\"", exists = ENERGY)]
        activation_energy: Joule,
        /// Activation volume of the growth.
        #[key(quantity = Volume, range = Within(VOLUMES, true), example = "\"3.8e-3 nm3\"", exists = VOLUME)]
        activation_volume: CubicMetre,
        /// Stress that activates the growth; `"shear"` requires \[friction\].
        #[key(choice, default = FilmStress::Pressure, example = "\"shear\"")]
        stress: FilmStress,
        /// Removal per pressure and sliding distance.
        #[key(quantity = RemovalRate, range = FromZero, default = 0.0, written = "0", example = "\"1e-11 1/(Pa m)\"", exists = REMOVAL)]
        removal: f64,
    },
    /// f = g − l ≥ 0: dg/dt = (k_B T/h_P) x (f_max − g), dl/dt = C₄ (C₃ − l). The film of a
    /// bare cell, f = 0, is removed as fast as it grows while dl/dt would be above dg/dt.
    ///
    /// A. Ghanbarzadeh et al., Tribol. Int. 93, 573 (2016).
    MechanoChemical {
        /// Factor x of the growth.
        #[key(number = "a number", range = Within(FACTORS, false), example = "1e-16")]
        x: f64,
        /// Final removal C₃ as a thickness, at most `max_thickness`.
        #[key(quantity = Length, range = FromZero, example = "\"50 nm\"", exists = THICKNESS)]
        c3: Metre,
        /// Rate C₄ of the removal, in 1/s.
        #[key(number = "a number", range = Within(RATES, true), example = "0.01")]
        c4: f64,
    },
    /// A solid lubricant, such as bonded MoS₂, which begins at its largest thickness and is only worn off: df
    /// = −k p |ds| while f > 0.
    SolidLubricant {
        /// Film volume lost per load and sliding distance, until the film is worn off; the heights of the
        /// surface include the film.
        #[key(quantity = VolumePerWork, range = AboveZero, example = "\"1e-6 mm3/(N m)\"", exists = VOLUME_PER_WORK)]
        wear: PerPascal,
    },
}

/// The stress that drives film growth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilmStress {
    /// The pressure.
    Pressure,
    /// The magnitude of the shear traction.
    Shear,
}

choice!(FilmStress: "pressure" => Pressure, "shear" => Shear);

/// Accepted activation energies, besides 0: up to 60 eV, far above that of any chemical bond. A number in eV
/// without its unit is rejected.
const ENERGIES: Range = Range { least: 1e-24, most: 1e-17, unit: "J" };
/// Accepted activation volumes, besides 0: up to 1 µm³, for soft bodies under small stresses. A number in nm³
/// without its unit is rejected.
const VOLUMES: Range = Range { least: 1e-36, most: 1e-18, unit: "m³" };
/// Accepted temperatures of a known growth rate. A number below 200, in °C without its unit, is rejected.
const TEMPERATURES: Range = Range { least: 200.0, most: 5000.0, unit: "K" };
/// Accepted factors x of the mechano-chemical law.
const FACTORS: Range = Range { least: 1e-45, most: 1.0, unit: "" };
/// Accepted rates C₄ of the mechano-chemical law, besides 0.
const RATES: Range = Range { least: 1e-15, most: 1e15, unit: "1/s" };

/// Tribofilms have 0.5 eV to 1.5 eV and some Å³ to some 10 Å³: N. N. Gosvami et al., Science 348, 102 (2015).
const ENERGY: Exists =
    Exists::Within { least: 5e-21, most: 2e-18, of: "diffusion to chemical bonds", slips: &["eV"] };
const VOLUME: Exists = Exists::Within {
    least: 1e-31,
    most: 1e-27,
    of: "parts of an atom to segments of polymers",
    slips: &["nm3"],
};
const THIN: Beside = Beside::most(Scale::Side, 0.1, "a film is thin beside its body");
const THICKNESS: Exists = Exists::Within {
    least: 2e-10,
    most: 1e-3,
    of: "a layer of atoms to thick coatings",
    slips: &["nm", "um"],
};
const GROWTH: Exists =
    Exists::Within { least: 1e-16, most: 1e-3, of: "slow tribofilms to plating", slips: &["nm/s"] };
const STRESS: Exists =
    Exists::Within { least: 1e5, most: 1e11, of: "soft polymers to diamond", slips: &["GPa", "MPa"] };
const REMOVAL: Exists =
    Exists::Within { least: 1e-22, most: 1e-3, of: "lubricated films to brushes", slips: &[] };

/// Expectation of `c3` in errors.
const THINNER: &str = "no more than 'max_thickness'";

fn thinner(read: &Film, source: &dyn Source) -> Result<()> {
    require(source, "c3", !read.is_removed_beyond(), THINNER, None)
}

impl Film {
    /// Creates a film of thickness at most `max_thickness`, > 0, with a law. At its thickest it can carry at
    /// most the pressure `hardness`, which is below that of the body.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::error::Error::OutOfRange).
    pub fn new(law: FilmLaw, max_thickness: Metre, hardness: Option<Pascal>) -> Result<Self> {
        let this = Self { law, max_thickness, hardness };
        this.checked().map(|()| this)
    }

    pub(super) fn checked(&self) -> Result<()> {
        self.check()?;
        match self.law {
            FilmLaw::MechanoChemical { c3, .. } => {
                check_in(Dimension::Length, "c3", c3, !self.is_removed_beyond(), THINNER)
            }
            _ => Ok(()),
        }
    }

    /// Whether the final removal is above the largest thickness.
    fn is_removed_beyond(&self) -> bool {
        matches!(self.law, FilmLaw::MechanoChemical { c3, .. } if c3 > self.max_thickness)
    }

    /// Checks that the film is no harder than a body of this hardness, if it is one number.
    pub(super) fn softer_than(&self, hardness: Option<Pascal>, source: &dyn Source) -> Result<()> {
        let is_harder = self.hardness.zip(hardness).is_some_and(|(film, body)| film > body);
        let hint = "give the body a 'hardness', or leave out the hardness of the film";
        require(source, "hardness", !is_harder, "no more than the hardness of the body", Some(hint))
    }
}

impl FilmLaw {
    /// Depth that a film of this law loses per pressure and distance slid, 1/Pa, if it loses any without
    /// growing.
    pub(super) fn per_pressure(&self) -> PerPascal {
        match self {
            Self::SolidLubricant { wear } => *wear,
            Self::Arrhenius { .. } | Self::MechanoChemical { .. } => 0.0,
        }
    }

    /// Whether the film changes with time. A solid lubricant changes only with the distance slid.
    pub fn takes_time(&self) -> bool {
        !matches!(self, Self::SolidLubricant { .. })
    }
}

//! The tables `[lower.wear]` and `[upper.wear]`.

use serde::Serialize;

use crate::error::{Error, Result, check_in};
use crate::units::{Dimension, Pascal, PerPascal};
use asperity_base::exists::VOLUME_PER_WORK;
use asperity_base::table::{Exists, Source, Table as _, require};
use asperity_derive::{Part, Table};

/// Wear coefficient of a body: it gives the depth that a cell loses while it slides by ds.
#[derive(Table, Debug, Clone, Copy, PartialEq, Serialize)]
#[table("lower.wear", "upper.wear", check = lowered_by_film)]
#[non_exhaustive]
pub struct WearCoefficient {
    /// Wear of the bare body.
    #[key(part)]
    #[serde(flatten)]
    pub rate: WearRate,
    /// Coefficient under the thickest film, in the unit of `coefficient` or `energy`, also with
    /// `dimensionless`, at most the coefficient of the bare body; it decreases linearly with the thickness;
    /// the body needs a film.
    #[key(
        quantity = VolumePerWork,
        range = AboveZero,
        absent = "the coefficient of the bare body",
        example = "\"1e-8 mm3/(N m)\"",
        exists = VOLUME_PER_WORK
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub under_film: Option<PerPascal>,
}

/// Wear of a bare body, > 0.
#[derive(Part, Debug, Clone, Copy, PartialEq, Serialize)]
#[part(absent = "exactly one of the three", hint = "for example `coefficient = \"1e-7 mm3/(N m)\"`")]
#[serde(rename_all = "snake_case")]
pub enum WearRate {
    /// Wear volume per load and sliding distance (Archard).
    ///
    /// The depth is k p ds.
    #[key(quantity = VolumePerWork, range = AboveZero, example = "\"1e-7 mm3/(N m)\"", exists = VOLUME_PER_WORK)]
    Coefficient(PerPascal),
    /// `coefficient` times the `hardness` of the body, which must be a single number.
    ///
    /// Archard's number. The table of a body turns it into the coefficient.
    #[key(number = "a number", range = AboveZero, example = "4e-7", exists = NUMBER)]
    Dimensionless(f64),
    /// Wear volume per frictional energy; requires \[friction\].
    ///
    /// The depth is α |q| ds, with α in 1/Pa, which is m³/J.
    #[key(quantity = VolumePerWork, range = AboveZero, example = "\"1e-6 mm3/J\"", exists = OF_ENERGY)]
    Energy(PerPascal),
}

const OF_ENERGY: Exists =
    Exists::Within { least: 1e-22, most: 1e-10, of: "lubricated metals to abrasion", slips: &["mm3/J"] };
/// Rabinowicz, Friction and Wear of Materials.
const NUMBER: Exists = Exists::Within {
    least: 1e-11,
    most: 0.3,
    of: "well lubricated bearings to abrasion",
    slips: &["coefficient = \"{} mm3/(N m)\""],
};

/// Expectation of a coefficient under a film in errors.
const LOWER: &str = "no more than the coefficient of the bare body";

fn lowered_by_film(read: &WearCoefficient, source: &dyn Source) -> Result<()> {
    // A dimensionless coefficient is compared once it is known in the unit of the other.
    let is_lower = matches!(read.rate, WearRate::Dimensionless(_)) || read.is_lower_under_film();
    require(source, "under_film", is_lower, LOWER, None)
}

impl WearCoefficient {
    /// Creates Archard's law with the coefficient k in 1/Pa: volume over load and distance.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn archard(bare: PerPascal) -> Result<Self> {
        let this = Self { rate: WearRate::Coefficient(bare), under_film: None };
        this.checked().map(|()| this)
    }

    /// Creates wear proportional to the frictional energy, with α in 1/Pa, which is m³/J.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn energy(bare: PerPascal) -> Result<Self> {
        let this = Self { rate: WearRate::Energy(bare), under_film: None };
        this.checked().map(|()| this)
    }

    /// Sets the coefficient under a film of largest thickness.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if it is not above 0, or above that of the bare body.
    pub fn with_film(self, under_film: PerPascal) -> Result<Self> {
        let this = Self { under_film: Some(under_film), ..self };
        this.checked().map(|()| this)
    }

    pub(super) fn checked(&self) -> Result<()> {
        self.check()?;
        if matches!(self.rate, WearRate::Dimensionless(_)) {
            return Err(Error::Unsupported(
                "a dimensionless wear coefficient needs the hardness of its body",
            ));
        }
        let under = self.under_film.unwrap_or(0.0);
        check_in(Dimension::VolumePerWork, "under_film", under, self.is_lower_under_film(), LOWER)
    }

    /// Replaces a dimensionless coefficient on a body of this hardness, which is one finite number.
    pub(super) fn of_hardness(self, hardness: Option<Pascal>, source: &dyn Source) -> Result<Self> {
        let WearRate::Dimensionless(number) = self.rate else { return Ok(self) };
        let Some(hardness) = hardness else {
            let message = "'dimensionless' needs a 'hardness' of the body";
            let hint = "give one hardness to this body, or `coefficient = \"1e-7 mm3/(N m)\"`";
            let value = source.value("dimensionless").expect("it has been read");
            return Err(value.error(message, Some(hint)));
        };
        let this = Self { rate: WearRate::Coefficient(number / hardness), ..self };
        lowered_by_film(&this, source).map(|()| this)
    }

    /// Whether the coefficient under a film is no more than that of the bare body.
    fn is_lower_under_film(&self) -> bool {
        self.under_film.is_none_or(|under| under <= self.rate.bare())
    }

    /// Whether a film lowers the coefficient.
    pub(super) fn is_lowered(&self) -> bool {
        self.under_film.is_some_and(|under| under != self.rate.bare())
    }

    /// Coefficient under a film with the fraction `part` of its largest thickness.
    pub(super) fn under(&self, part: f64) -> PerPascal {
        let bare = self.rate.bare();
        bare - (bare - self.under_film.unwrap_or(bare)) * part.min(1.0)
    }
}

impl WearRate {
    /// The number itself.
    pub fn bare(self) -> PerPascal {
        match self {
            Self::Coefficient(bare) | Self::Dimensionless(bare) | Self::Energy(bare) => bare,
        }
    }

    /// Depth per pressure and distance slid, 1/Pa, with shear equal to `friction` times the pressure.
    pub(super) fn per_pressure(self, friction: f64) -> PerPascal {
        match self {
            Self::Energy(bare) => bare * friction,
            rate => rate.bare(),
        }
    }
}

//! Viscoelastic bodies and layers of a case: the tables `[lower.viscoelastic]`, `[upper.viscoelastic]`, `viscoelastic` of a layer, and
//! `[steady]`.
//!
//! The laws are in [`crate::viscoelastic`].

mod views;

pub(super) use views::OF_POINTS;
pub use views::{answers, doubts, in_passes, in_time};

use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::error::{Error, Result};
use crate::units::{Kelvin, MetrePerSecond, Pascal, Second, format};
use crate::viscoelastic::{MasterFit, MasterPoint, Relaxation, RelaxationTerm, fit_master_curve};
use crate::with::BodyProperty;
use asperity_base::beside::{self, Beside, Scale};
use asperity_base::exists;
use asperity_base::table::{Bounds, Exists, Key, Kind, Source, Value, list, require};
use asperity_base::units::Dimension;
use asperity_derive::Table;

/// Relaxation of a body, or of one of its layers, whose `young` is the relaxed modulus.
#[derive(Table, Debug, Clone, PartialEq, Serialize)]
#[table(
    "lower.viscoelastic",
    "upper.viscoelastic",
    "lower.coating.viscoelastic",
    "upper.coating.viscoelastic",
    "lower.layers.viscoelastic",
    "upper.layers.viscoelastic",
    check = together
)]
#[non_exhaustive]
pub struct Viscoelasticity {
    /// Moduli that relax, in tension as `young`, which is the modulus that remains.
    #[key(
        special = moduli,
        form = "list of pressures > 0",
        dimension = Pressure,
        default = Vec::new(),
        absent = "those of `file`",
        example = "[\"9 MPa\", \"90 MPa\"]",
        exists = exists::YOUNG,
        beside = [RELAXES]
    )]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub moduli: Vec<Pascal>,
    /// Relaxation times, one for each modulus, all different.
    #[key(
        special = times,
        form = "list of times > 0",
        dimension = Time,
        default = Vec::new(),
        absent = "those of a fit to `file`",
        example = "[\"1 s\", \"20 ms\"]",
        exists = ANY_TIME
    )]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub times: Vec<Second>,
    /// Master curve instead of `moduli` and `times`: a text whose titles name frequency, storage and loss
    /// modulus (or tan δ) with their units, such as `frequency_Hz, storage_MPa, loss_MPa`, or the export of
    /// an instrument.
    #[key(special = path, form = "file name, relative to the case file", absent = "none", example = "\"master.csv\"")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// Relaxation times a decade of the fit to `file`.
    #[key(number = "a number", range = AboveZero, default = 2.0, example = "1")]
    #[serde(skip_serializing_if = "is_two")]
    pub terms_per_decade: f64,
    /// Shift factor a_T: all times are multiplied by it, for another temperature than that of the moduli.
    #[key(number = "a number", range = AboveZero, default = 1.0, example = "0.1")]
    #[serde(skip_serializing_if = "is_one")]
    pub shift: f64,
    /// Constant c₁ of the shift of Williams, Landel and Ferry, log₁₀ a_T = −c₁(T − Tᵣ)/(c₂ + T − Tᵣ), at the
    /// temperature `bulk` of the body in \[temperature\].
    #[key(number = "a number", range = AboveZero, absent = "no such shift", example = "8.9")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wlf_c1: Option<f64>,
    /// Constant c₂ of this shift.
    #[key(quantity = TemperatureDifference, range = AboveZero, absent = "no such shift", example = "\"102 K\"", exists = WLF)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wlf_c2: Option<Kelvin>,
    /// Temperature Tᵣ of the moduli.
    #[key(quantity = Temperature, range = AboveZero, absent = "no such shift", example = "\"20 °C\"", exists = exists::TEMPERATURE)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wlf_at: Option<Kelvin>,
}

/// Ferry, Viscoelastic Properties of Polymers: 20 K to 250 K.
const WLF: Exists = Exists::Within { least: 10.0, most: 500.0, of: "polymers", slips: &[] };
/// Ferry: rubbers of 0.1 MPa and more are glasses of about 1 GPa when they are fast.
const RELAXES: Beside = Beside::within(
    Scale::Young,
    [1e-2, 5e3],
    ["their relaxation changes nothing", "no glass is so much stiffer than its rubber"],
);
const ANY_TIME: Exists = Exists::Any("a body may relax in any time");

fn is_two(value: &f64) -> bool {
    *value == 2.0
}

fn is_one(value: &f64) -> bool {
    *value == 1.0
}

fn moduli(value: &dyn Value, key: &Key) -> Result<Vec<Pascal>> {
    positive(value, key, Dimension::Pressure, "a list of moduli such as [\"9 MPa\", \"90 MPa\"]")
}

fn times(value: &dyn Value, key: &Key) -> Result<Vec<Second>> {
    positive(value, key, Dimension::Time, "a list of times such as [\"1 s\", \"20 ms\"]")
}

/// Reads a list of quantities above 0.
fn positive(value: &dyn Value, key: &Key, dimension: Dimension, expected: &str) -> Result<Vec<f64>> {
    list(value, expected, |item| item.real(key, &Kind::Quantity(dimension, Bounds::AboveZero)))
}

fn path(value: &dyn Value, _key: &Key) -> Result<PathBuf> {
    value.text().map(PathBuf::from)
}

fn together(read: &Viscoelasticity, source: &dyn Source) -> Result<()> {
    let one = source
        .exactly_one(&["moduli", "file"], "for example `moduli = [\"9 MPa\"]` and `times = [\"1 s\"]`")?;
    let (moduli, times) = (read.moduli.len(), read.times.len());
    if one == "file" {
        require(source, "times", times == 0, "no times beside a `file`, whose fit finds them", None)?;
    } else {
        require(source, "moduli", moduli > 0, "at least one modulus", None)?;
        require(source, "moduli", times > 0, "also `times`, one for each modulus", None)?;
        let expected = format!("as many times as moduli, {moduli}");
        require(source, "times", moduli == times, &expected, None)?;
        let mut sorted = read.times.clone();
        sorted.sort_by(f64::total_cmp);
        let differ = sorted.windows(2).all(|pair| pair[0] < pair[1]);
        require(source, "times", differ, "times that are all different", None)?;
    }
    let wlf = [
        ("wlf_c1", read.wlf_c1.is_some()),
        ("wlf_c2", read.wlf_c2.is_some()),
        ("wlf_at", read.wlf_at.is_some()),
    ];
    let all = wlf.iter().all(|(_, given)| *given);
    wlf.iter().try_for_each(|(key, given)| {
        let expected = "all three of `wlf_c1`, `wlf_c2` and `wlf_at`, or none";
        require(source, key, !given || all, expected, None)
    })
}

impl BodyProperty for Viscoelasticity {
    const NAME: &'static str = "viscoelastic";
    const MEANING: &'static str = "relaxation of the body, see [below](#viscoelastic-bodies)";
    const WITHOUT: &'static str = "elastic";

    fn in_folder(self, folder: &Path) -> Self {
        Self { file: self.file.map(|file| folder.join(file)), ..self }
    }
}

impl Viscoelasticity {
    /// Whether its times depend on the temperature of the body.
    pub fn needs_temperature(&self) -> bool {
        self.wlf_c1.is_some()
    }

    /// Returns how far a `temperature` of the body is above Tᵣ − c₂, where the times of Williams, Landel and
    /// Ferry become infinite.
    pub(super) fn above_infinite_times(&self, temperature: Option<Kelvin>) -> Option<Kelvin> {
        Some(temperature? - self.wlf_at? + self.wlf_c2?)
    }

    /// Returns the shift factor a_T: that of all times at a `temperature` of the body.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a temperature at which the times are infinite.
    pub fn shift_factor(&self, temperature: Option<Kelvin>) -> Result<f64> {
        let wlf = self.wlf_c1.zip(self.wlf_c2).zip(self.above_infinite_times(temperature));
        let Some(((c1, c2), above)) = wlf else { return Ok(self.shift) };
        let factor = self.shift * 10f64.powf(c1 * (c2 / above - 1.0));
        if above > 0.0 && factor > 0.0 && factor.is_finite() {
            return Ok(factor);
        }
        let value = temperature.unwrap_or_default();
        let infinite = format(value - above, Dimension::Temperature);
        let expected = format!(
            "a temperature well above Tᵣ − c₂, {infinite}, where the relaxation times become infinite"
        );
        let dimension = Some(Dimension::Temperature);
        Err(Error::OutOfRange { quantity: "bulk", value, dimension, expected: expected.into() })
    }

    /// Returns the relaxation of a body with this `relaxed` modulus at a `temperature`, and the fit if it has
    /// a master `curve`.
    ///
    /// # Errors
    /// The errors of [`Self::shift_factor`], [`Relaxation::new`] and [`fit_master_curve`].
    pub fn relaxation(
        &self,
        relaxed: Pascal,
        temperature: Option<Kelvin>,
        curve: Option<&[MasterPoint]>,
    ) -> Result<(Relaxation, Option<MasterFit>)> {
        let fit = curve.map(|curve| fit_master_curve(curve, relaxed, self.terms_per_decade)).transpose()?;
        let terms: Vec<RelaxationTerm> = match &fit {
            Some(fit) => fit.relaxation.terms().to_vec(),
            None => {
                let terms = self.moduli.iter().zip(&self.times);
                terms.map(|(modulus, time)| RelaxationTerm { modulus: *modulus, time: *time }).collect()
            }
        };
        let factor = self.shift_factor(temperature)?;
        let shifted = terms.into_iter().map(|term| RelaxationTerm { time: factor * term.time, ..term });
        Ok((Relaxation::new(relaxed, shifted)?, fit))
    }
}

/// Steady sliding of viscoelastic bodies, at one speed after another.
#[derive(Table, Debug, Clone, PartialEq, Serialize)]
#[table("steady", check = at_a_speed)]
#[non_exhaustive]
pub struct Steady {
    /// Speed of the contact over the body that is smooth along x.
    #[key(
        quantity = Speed,
        range = AboveZero,
        absent = "exactly one of the two",
        example = "\"1 m/s\"",
        exists = exists::SPEED,
        beside = [beside::SPEED]
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<MetrePerSecond>,
    /// Several speeds, one after the other, each from the contact at the one before.
    #[key(
        quantity = Speed,
        range = AboveZero,
        several = "\"1 mm/s\"",
        form = "list of at least one speed > 0, or a [table](#a-sweep)",
        default = Vec::new(),
        absent = "exactly one of the two",
        example = "[\"1 mm/s\", \"1 m/s\"]",
        exists = exists::SPEED,
        beside = [beside::SPEED]
    )]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub speeds: Vec<MetrePerSecond>,
}

fn at_a_speed(_: &Steady, source: &dyn Source) -> Result<()> {
    source.exactly_one(&["speed", "speeds"], "for example `speed = \"1 m/s\"`").map(|_| ())
}

impl Steady {
    /// The speeds.
    pub fn all(&self) -> Vec<MetrePerSecond> {
        self.speed.into_iter().chain(self.speeds.iter().copied()).collect()
    }
}

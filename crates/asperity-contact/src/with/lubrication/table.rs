//! The table `[lubrication]`.

use serde::{Serialize, Serializer};

use crate::error::{Error, Result};
use crate::lubrication::{FreeVolume, Lubrication, NamedOil, Oil, Shear, ViscosityLaw};
use crate::units::{Kelvin, Metre, MetrePerSecond, Pascal, PascalSecond, PerPascal};
use asperity_base::beside::{Beside, Scale};
use asperity_base::exists;
use asperity_base::table::{Exists, Source, at_most_one, require};
use asperity_derive::Table;

/// An oil between the bodies.
///
/// In a steady film one body is rough and at rest, and a smooth one moves along x; or both are smooth, and each has its
/// speed. In a motion both may be rough.
#[derive(Table, Debug, Clone, PartialEq, Serialize)]
#[table("lubrication", check = known)]
#[non_exhaustive]
pub struct Lubricant {
    /// Oil by name, see [lubricants](#lubricants), at the mean temperature of the bodies in \[temperature\].
    #[key(choice, absent = "exactly one of the two", example = "\"ISO VG 46\"")]
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "by_name")]
    pub oil: Option<&'static NamedOil>,
    /// Viscosity at ambient pressure.
    #[key(
        quantity = Viscosity,
        range = AboveZero,
        absent = "exactly one of the two",
        example = "\"40 mPa s\"",
        exists = VISCOSITY
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub viscosity: Option<PascalSecond>,
    /// Pressure–viscosity coefficient α, the relative rise of the viscosity with pressure at ambient pressure.
    #[key(
        quantity = PerPressure,
        range = AboveZero,
        absent = "must be given with `viscosity`, but for `law = \"constant\"`",
        example = "\"20 1/GPa\"",
        exists = PRESSURE_VISCOSITY
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pressure_viscosity: Option<PerPascal>,
    /// How the viscosity rises with pressure: `"roelands"`; `"barus"`, exponentially, far too stiff above 0.3 GPa;
    /// `"doolittle"`, by the free volume of the oil, which follows measured viscosities to several GPa; or `"constant"`.
    #[key(choice, absent = "`\"roelands\"`, or that of `oil`", example = "\"barus\"")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub law: Option<ViscosityLaw>,
    /// Isothermal bulk modulus of the oil at ambient pressure.
    #[key(
        quantity = Pressure,
        range = AboveZero,
        absent = "must be given with `law = \"doolittle\"`",
        example = "\"1.4 GPa\"",
        exists = BULK_MODULUS
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bulk_modulus: Option<Pascal>,
    /// Share of the volume of the oil at ambient pressure that its molecules occupy, below 1.
    #[key(
        number = "a number",
        range = AboveZero,
        absent = "must be given with `law = \"doolittle\"`",
        example = "0.67"
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub occupied_volume: Option<f64>,
    /// Whether the density rises with pressure, by Dowson and Higginson, or by Tait with `law = "doolittle"`.
    #[key(flag, absent = "true, or that of `oil`", example = "false")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub compressible: Option<bool>,
    /// Largest shear stress of the oil over its pressure, the limiting stress coefficient.
    #[key(number = "a number", range = AboveZero, absent = "no limit", example = "0.05", exists = LIMIT)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limiting_stress: Option<f64>,
    /// Eyring's stress τ₀, above which the oil shears more easily: τ = τ₀ asinh(η Δu/h τ₀).
    #[key(quantity = Pressure, range = AboveZero, absent = "Newtonian", example = "\"5 MPa\"", exists = EYRING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub eyring_stress: Option<Pascal>,
    /// Mean speed of both surfaces along +x, which entrains the oil: half the speed of the one that moves where the
    /// other one is at rest. 0 if a pressure at an end drives it.
    #[key(
        quantity = Speed,
        range = FromZero,
        absent = "exactly one of the two; none in a motion",
        example = "\"0.1 m/s\"",
        exists = exists::SPEED
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<MetrePerSecond>,
    /// Several mean speeds, one after the other: a Stribeck curve.
    #[key(
        quantity = Speed,
        range = AboveZero,
        several = "\"1 mm/s\"",
        form = "list of at least one speed > 0, or a [table](#a-sweep)",
        default = Vec::new(),
        absent = "exactly one of the two; none in a motion",
        example = "[\"1 m/s\", \"1 mm/s\"]",
        exists = exists::SPEED
    )]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub speeds: Vec<MetrePerSecond>,
    /// Difference of the speeds of both surfaces; 0 in pure rolling.
    #[key(
        quantity = Speed,
        range = FromZero,
        absent = "twice the mean speed: one body is at rest",
        example = "\"0.02 m/s\"",
        exists = exists::SPEED
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sliding: Option<MetrePerSecond>,
    /// Film that solids that touch keep between them: a few molecules.
    #[key(quantity = Length, range = AboveZero, default = 2e-9, written = "\"2 nm\"", example = "\"2 nm\"", exists = BOUNDARY_FILM, beside = [THICK])]
    pub boundary_film: Metre,
    /// Friction coefficient of the solids where they touch, with their boundary film.
    #[key(number = "a number", range = FromZero, absent = "0, with a warning where solids bear", example = "0.12", exists = exists::FRICTION)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub boundary_friction: Option<f64>,
    /// Pressure of the oil at the inlet, above that around.
    #[key(quantity = Pressure, range = FromZero, default = 0.0, written = "0", example = "\"1 MPa\"", exists = SUPPLY)]
    #[serde(skip_serializing_if = "is_zero")]
    pub inlet_pressure: Pascal,
    /// Pressure of the oil at the outlet, above that around.
    #[key(quantity = Pressure, range = FromZero, default = 0.0, written = "0", example = "\"1 bar\"", exists = SUPPLY)]
    #[serde(skip_serializing_if = "is_zero")]
    pub outlet_pressure: Pascal,
}

/// Larsson et al., Proc. IMechE J 214 (2000) 17: refrigerants and water to bright stocks; cold gear oils.
const VISCOSITY: Exists =
    Exists::Within { least: 1e-5, most: 300.0, of: "gases to cold bright stock", slips: &["mPa s"] };
/// The same source: water 0.5 to traction fluids 40 1/GPa.
const PRESSURE_VISCOSITY: Exists =
    Exists::Within { least: 1e-10, most: 1e-7, of: "water to traction fluids", slips: &["1/GPa", "1/Pa"] };
/// Bair, High Pressure Rheology for Quantitative EHL: 0.8 to 3 GPa.
const BULK_MODULUS: Exists =
    Exists::Within { least: 3e8, most: 6e9, of: "hot light oils to glycerol", slips: &["GPa", "MPa"] };
/// Bair, High Pressure Rheology for Quantitative EHL: 0.02 to 0.15.
const LIMIT: Exists = Exists::Within { least: 5e-3, most: 0.3, of: "esters to traction fluids", slips: &[] };
/// The same source: 1 to 50 MPa.
const EYRING: Exists =
    Exists::Within { least: 1e5, most: 2e8, of: "polymer solutions to traction fluids", slips: &["MPa"] };
const BOUNDARY_FILM: Exists = Exists::Within {
    least: 1e-10,
    most: 1e-6,
    of: "a layer of molecules to thick reaction layers",
    slips: &["nm"],
};
const SUPPLY: Exists = Exists::Within {
    least: 1.0,
    most: 2e9,
    of: "draughts to the pressures of injection",
    slips: &["bar", "MPa"],
};
const THICK: Beside = Beside::most(Scale::FreeSide, 1e-2, "solids keep no such film");

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

fn by_name<S: Serializer>(
    oil: &Option<&'static NamedOil>,
    serializer: S,
) -> std::result::Result<S::Ok, S::Error> {
    oil.map(|oil| oil.name).serialize(serializer)
}

fn known(read: &Lubricant, source: &dyn Source) -> Result<()> {
    source.exactly_one(&["oil", "viscosity"], "for example `viscosity = \"40 mPa s\"`")?;
    at_most_one(source, &["speed", "speeds"], "for example `speed = \"0.1 m/s\"`")?;
    for key in ["pressure_viscosity", "law", "compressible", "bulk_modulus", "occupied_volume"] {
        require(source, key, read.oil.is_none(), "none beside `oil`, which has its own", None)?;
    }
    let is_constant = read.law == Some(ViscosityLaw::Constant);
    let hint = "for example `pressure_viscosity = \"20 1/GPa\"`, or `law = \"constant\"`";
    let given = read.pressure_viscosity.is_some();
    require(source, "viscosity", is_constant || given, "also `pressure_viscosity`", Some(hint))?;
    require(source, "pressure_viscosity", !is_constant || !given, "none with `law = \"constant\"`", None)?;
    let is_free_volume = read.law == Some(ViscosityLaw::Doolittle);
    for (key, given) in
        [("bulk_modulus", read.bulk_modulus.is_some()), ("occupied_volume", read.occupied_volume.is_some())]
    {
        let expected = "none but with `law = \"doolittle\"`";
        require(source, key, is_free_volume || !given, expected, None)?;
        let hint = "for example `bulk_modulus = \"1.4 GPa\"` and `occupied_volume = 0.67`";
        require(source, "law", !is_free_volume || given, &format!("also `{key}`"), Some(hint))?;
    }
    let one = read.limiting_stress.is_none() || read.eyring_stress.is_none();
    require(source, "eyring_stress", one, "none beside `limiting_stress`", None)?;
    let is_driven = read.speed != Some(0.0) || read.inlet_pressure.max(read.outlet_pressure) > 0.0;
    let expected = "a speed above 0, or an `inlet_pressure`: nothing drives the oil";
    require(source, "speed", is_driven, expected, None)?;
    match read.given_oil().map_or(Ok(()), |oil| oil.check()) {
        Err(Error::OutOfRange { quantity, expected, .. }) => {
            require(source, quantity, false, &expected, None)
        }
        checked => checked,
    }
}

impl Lubricant {
    /// The speeds.
    pub fn all_speeds(&self) -> Vec<MetrePerSecond> {
        self.speed.into_iter().chain(self.speeds.iter().copied()).collect()
    }

    /// The law of the viscosity.
    pub fn viscosity_law(&self) -> ViscosityLaw {
        self.law.or(self.oil.map(|oil| oil.law)).unwrap_or_default()
    }

    /// The oil whose viscosity is given.
    fn given_oil(&self) -> Option<Oil> {
        Some(Oil {
            viscosity: self.viscosity?,
            pressure_viscosity: self.pressure_viscosity.unwrap_or(0.0),
            law: self.viscosity_law(),
            compressible: self.compressible.unwrap_or(true),
            free_volume: self
                .bulk_modulus
                .zip(self.occupied_volume)
                .map(|(bulk_modulus, occupied_volume)| FreeVolume { bulk_modulus, occupied_volume }),
        })
    }

    /// Returns what the contact of bodies at a `temperature` needs to know.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if the temperature is none of an oil by its name, or unknown.
    pub fn between_bodies(&self, temperature: Option<Kelvin>) -> Result<Lubrication> {
        let shear = match (self.limiting_stress, self.eyring_stress) {
            (Some(share), _) => Shear::Limited(share),
            (_, Some(stress)) => Shear::Eyring(stress),
            (None, None) => Shear::Newtonian,
        };
        let oil = match (self.given_oil(), self.oil) {
            (Some(oil), _) => oil,
            (None, named) => named
                .ok_or(Error::Unsupported("an oil without a viscosity"))?
                .oil_at_temperature(temperature.unwrap_or(f64::NAN))?,
        };
        Ok(Lubrication {
            oil,
            shear,
            sliding: self.sliding,
            boundary_film: self.boundary_film,
            ends: [self.inlet_pressure, self.outlet_pressure],
            solid_friction: self.boundary_friction.unwrap_or(0.0),
        })
    }
}

//! Elastic layers on a body.

use super::NamedMaterial;
use crate::error::Result;
use crate::units::{Metre, Pascal};
use asperity_base::beside::{Beside, Scale};
use asperity_base::exists;
use asperity_base::table::{Key, Part, Source};
use asperity_derive::Part;

const THICK: Beside = Beside::most(Scale::Side, 10.0, "contacts do not feel the body under it");

/// An elastic, isotropic layer of uniform thickness, bonded to a body.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Coating {
    /// Thickness of the layer, > 0.
    pub thickness: Metre,
    /// Its Young's modulus, > 0.
    pub young: Pascal,
    /// Its Poisson's ratio, 0 … 0.5.
    pub poisson: f64,
    /// Its thermal conductivity, W/(m K), > 0; unknown if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub conductivity: Option<f64>,
    /// Its electrical resistivity, Ω m, > 0; unknown if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub resistivity: Option<f64>,
}

/// The keys of a layer. A named material gives those that are missing.
#[derive(Part)]
struct Keys {
    /// Thickness of the layer.
    #[key(quantity = Length, range = AboveZero, example = "\"2 um\"", exists = exists::LAYER, beside = [THICK])]
    thickness: Metre,
    /// Material by name, see [materials](#materials): its `young` and `poisson`, and the constants of heat and
    /// current where the case uses them; keys given beside it replace them.
    #[key(choice, absent = "none", example = "\"dlc\"")]
    material: Option<&'static NamedMaterial>,
    /// Its Young's modulus.
    #[key(
        quantity = Pressure,
        range = AboveZero,
        absent = "that of `material`; must be given without one",
        example = "\"300 GPa\"",
        exists = exists::YOUNG
    )]
    young: Option<Pascal>,
    /// Its Poisson's ratio.
    #[key(
        number = "a number",
        range = Between { least: 0.0, most: 0.5, open: [false, false] },
        absent = "that of `material`; must be given without one",
        example = "0.3"
    )]
    poisson: Option<f64>,
    /// Its thermal conductivity, for heat that passes a contact.
    #[key(
        quantity = Conductivity,
        range = AboveZero,
        absent = "unknown",
        example = "\"20 W/(m K)\"",
        exists = exists::CONDUCTIVITY
    )]
    conductivity: Option<f64>,
    /// Its electrical resistivity, for a current that passes a contact.
    #[key(
        quantity = Resistivity,
        range = AboveZero,
        absent = "unknown",
        example = "\"1e-6 ohm m\"",
        exists = exists::RESISTIVITY
    )]
    resistivity: Option<f64>,
}

impl Coating {
    /// Creates a layer with these constants.
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] if a constant has no physical meaning.
    pub fn new(thickness: Metre, young: Pascal, poisson: f64) -> Result<Self> {
        let this = Self { thickness, young, poisson, conductivity: None, resistivity: None };
        this.check().map(|()| this)
    }
}

impl Part for Coating {
    const CHOOSES: bool = false;

    fn keys() -> Vec<Key> {
        Keys::keys()
    }

    fn read(source: &dyn Source) -> Result<Self> {
        let Keys { thickness, material, young, poisson, conductivity, resistivity } = Keys::read(source)?;
        let constant = |name, given, named: fn(&NamedMaterial) -> f64| {
            let keys = Self::keys();
            let key = keys.iter().find(|key| key.name == name).expect("a layer has this key");
            NamedMaterial::constant(source, key, given, material.map(named))
        };
        Ok(Self {
            thickness,
            young: constant("young", young, |named| named.young)?,
            poisson: constant("poisson", poisson, |named| named.poisson)?,
            conductivity: conductivity.or(material.and_then(|named| named.conductivity)),
            resistivity: resistivity.or(material.and_then(|named| named.resistivity)),
        })
    }

    fn check(&self) -> Result<()> {
        let Self { thickness, young, poisson, conductivity, resistivity } = *self;
        let [young, poisson] = [young, poisson].map(Some);
        Keys { thickness, material: None, young, poisson, conductivity, resistivity }.check()
    }
}

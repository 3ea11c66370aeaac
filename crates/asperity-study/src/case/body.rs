//! `[lower]` and `[upper]`: the bodies.

use std::path::Path;

use serde::{Serialize, Serializer};

use super::hardness::{Hardness, hardness};
use super::source::{Source, TopographySpec};
use asperity_base::beside::{Beside, Scale};
use asperity_base::choice::choice;
use asperity_base::error::Result;
use asperity_base::exists;
use asperity_base::table::{self, Key, Table as _};
use asperity_base::units::{Pascal, known_or_inf, or_inf};
use asperity_contact::each;
use asperity_contact::material::{Coating, Material, NamedMaterial};
use asperity_contact::temperature::Thermal;
use asperity_contact::with::plasticity::Yielding;
use asperity_contact::with::viscoelastic::Viscoelasticity;
use asperity_contact::with::{
    BodyConstants, BodyLaw as _, BodyLaws, BodyProperties, BodyProperty as _, Listed as _,
};
use asperity_derive::Table;
use asperity_surface::UNDERSIDE;

/// One of the two bodies.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Body {
    /// Elastic constants of the body. Its hardness is in [`Body::hardness`].
    #[serde(flatten, serialize_with = "elastic")]
    pub material: Material,
    /// Relaxation of each layer of the material, from the surface down; `None` for an elastic one.
    #[serde(skip)]
    pub layers: Vec<Option<Viscoelasticity>>,
    /// Largest pressure that the cells of the body can carry; infinite by default.
    pub hardness: Hardness,
    /// Plastic flow below the surface; elastic if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plasticity: Option<Yielding>,
    /// Properties of the body that contacts do not change, each with its table.
    #[serde(flatten)]
    pub properties: BodyProperties,
    /// Thermal constants of the body; unknown if absent.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub thermal: Option<Thermal>,
    /// Thermal conductivity, W/(m K), of a body that has no other thermal constants, > 0 or infinite; unknown
    /// if absent.
    #[serde(serialize_with = "known_or_inf", skip_serializing_if = "Option::is_none")]
    pub conductivity: Option<f64>,
    /// Electrical resistivity, Ω m, > 0; unknown if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub resistivity: Option<f64>,
    /// Laws by which contacts change the body, each with its table.
    #[serde(flatten)]
    pub laws: BodyLaws,
    /// The body's surface.
    pub topography: TopographySpec,
    /// How the heights are mounted: always [`Mount::AsIs`] for the lower body. `None` leaves the decision to
    /// the file: as they are if it describes an underside, see
    /// [`Scan::is_underside`](asperity_surface::Scan::is_underside), else turned over.
    #[serde(skip)]
    pub mount: Option<Mount>,
}

/// The keys of a body. A named material gives those that are missing.
#[derive(Table, Debug, Clone, PartialEq)]
#[table("lower", "upper")]
pub(super) struct BodyKeys {
    /// Material by name, see [materials](#materials): its `young`, `poisson` and `hardness`, and the
    /// constants of heat and current where the case uses them; keys given beside it replace them.
    #[key(choice, absent = "none", example = "\"steel\"")]
    material: Option<&'static NamedMaterial>,
    /// Young's modulus; for a body with layers, the modulus below them; at most one body without layers may be
    /// rigid.
    #[key(
        quantity = Pressure,
        range = AboveZeroOrInfinite("a rigid body"),
        absent = "that of `material`; must be given without one",
        example = "\"210 GPa\"",
        exists = exists::YOUNG
    )]
    young: Option<Pascal>,
    /// Poisson's ratio; for a body with layers, the ratio below them.
    #[key(
        number = "a number",
        range = Between { least: 0.0, most: 0.5, open: [false, false] },
        absent = "that of `material`; must be given without one",
        example = "0.3"
    )]
    poisson: Option<f64>,
    /// Largest pressure of the body, or a map of it.
    #[key(
        special = hardness,
        form = "pressure > 0, or `inf`: an elastic body, or a table: a [map](#a-map-of-the-hardness)",
        dimension = Pressure,
        written = "inf",
        example = "\"4 GPa\"",
        exists = exists::HARDNESS,
        beside = [Beside::least(Scale::Young, 1e-4, "no solid of this modulus is so soft")]
    )]
    hardness: Option<Hardness>,
    /// Elastic surface layer, see [below](#lowercoating-and-uppercoating).
    #[key(table, absent = "none")]
    coating: Option<LayerKeys>,
    /// Several elastic layers in place of a `coating`, from the surface down, see
    /// [below](#lowercoating-and-uppercoating).
    #[key(tables = LayerKeys::read, default = Vec::new(), absent = "none")]
    layers: Vec<LayerKeys>,
    /// The body below the layers; a rigid one takes neither `young` nor `poisson`.
    #[key(choice, default = Base::HalfSpace, example = "\"rigid\"")]
    base: Base,
    /// Its surface.
    #[key(table)]
    topography: TopographySpec,
    /// Plastic deformation below the surface, see [below](#plasticity).
    #[key(table, absent = "elastic")]
    plasticity: Option<Yielding>,
    /// Thermal conductivity, for the flash temperature and for heat that passes a contact; give it for both
    /// bodies.
    #[key(
        quantity = Conductivity,
        range = AboveZeroOrInfinite("no resistance, only where heat passes a contact"),
        absent = "unknown",
        example = "\"46 W/(m K)\"",
        exists = exists::CONDUCTIVITY
    )]
    conductivity: Option<f64>,
    /// Electrical resistivity, for a current that passes a contact; give it for both bodies.
    #[key(
        quantity = Resistivity,
        range = AboveZero,
        absent = "unknown",
        example = "\"1.7e-8 ohm m\"",
        exists = exists::RESISTIVITY
    )]
    resistivity: Option<f64>,
    /// Heat capacity; required with `conductivity`.
    #[key(
        quantity = HeatCapacity,
        range = AboveZero,
        absent = "unknown",
        example = "\"460 J/(kg K)\"",
        exists = exists::HEAT_CAPACITY
    )]
    heat_capacity: Option<f64>,
    /// Density; required with `conductivity`.
    #[key(
        quantity = Density,
        range = AboveZero,
        absent = "unknown",
        example = "\"7850 kg/m3\"",
        exists = exists::DENSITY
    )]
    density: Option<f64>,
}

/// The keys of a layer.
#[derive(Table, Debug, Clone, PartialEq)]
#[table("lower.coating", "upper.coating", "lower.layers", "upper.layers")]
pub(super) struct LayerKeys {
    #[key(part)]
    elastic: Coating,
    /// Relaxation of the layer, see [viscoelastic layers](#viscoelastic-layers).
    #[key(table, absent = "elastic")]
    viscoelastic: Option<Viscoelasticity>,
}

/// The keys that only the upper body has.
#[derive(Table, Debug, Clone, Copy, PartialEq)]
#[table("upper")]
pub(super) struct UpperKeys {
    /// `[upper]` only: orientation of its heights.
    #[key(choice, absent = "`\"turned-over\"`; `\"as-is\"` for an underside", example = "\"as-is\"")]
    mount: Option<Mount>,
}

/// The body below the layers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Base {
    /// An elastic half-space.
    HalfSpace,
    /// A rigid body, whose constants have no meaning.
    Rigid,
}

choice!(Base: "half-space" => HalfSpace, "rigid" => Rigid);

/// Conversion of the heights of a body to those of the case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mount {
    /// Measured material side up, then turned over about y: mirrored in x, with the sign of the heights
    /// changed.
    TurnedOver,
    /// The heights are already those of the case.
    AsIs,
}

choice!(Mount: "turned-over" => TurnedOver, "as-is" => AsIs);

/// The constants beside the elastic ones that the tables of a case use.
#[derive(Clone, Copy)]
pub(super) struct Used {
    /// Whether bodies are heated by friction as they slide.
    pub(super) flash: bool,
    /// Whether heat or current passes the contact, so that the conductivity may be given without the other
    /// constants of heat.
    pub(super) conduction: bool,
}

impl UpperKeys {
    /// Returns the mount of the upper body with this `source` of its heights.
    pub(super) fn mount(&self, source: &Source) -> Option<Mount> {
        // A results file may contain the underside of a body.
        let may_be_an_underside =
            matches!(source, Source::File { channel: Some(channel), .. } if channel == UNDERSIDE);
        self.mount.or((!may_be_an_underside).then_some(Mount::TurnedOver))
    }
}

impl BodyKeys {
    /// Returns the body, as a lower one, from its table `source`, of which a case uses some constants of a
    /// named material. Files are relative to the `folder` of the case.
    pub(super) fn body(&self, source: &dyn table::Source, folder: &Path, used: Used) -> Result<Body> {
        let named = self.material;
        let [young, poisson] = match self.base {
            Base::HalfSpace => [
                NamedMaterial::constant(source, key("young"), self.young, named.map(|named| named.young))?,
                NamedMaterial::constant(
                    source,
                    key("poisson"),
                    self.poisson,
                    named.map(|named| named.poisson),
                )?,
            ],
            Base::Rigid => [Pascal::INFINITY, 0.0],
        };
        refuse(
            source,
            ["young", "poisson"],
            self.base == Base::Rigid,
            "a rigid base has no '{key}'",
            "leave it out",
        )?;
        refuse(
            source,
            ["layers"],
            self.coating.is_some(),
            "a body has a `coating` or `layers`",
            "write the coating as the first of the layers",
        )?;
        // A body that flows below its surface has no hardness.
        let of_material = named.filter(|_| self.plasticity.is_none()).and_then(|named| named.hardness);
        let hardness = match &self.hardness {
            Some(hardness) => hardness.clone().in_folder(folder),
            None => Hardness::Uniform(of_material.unwrap_or(Pascal::INFINITY)),
        };
        let one_hardness = match hardness {
            Hardness::Uniform(hardness) => Some(hardness).filter(|hardness| hardness.is_finite()),
            Hardness::Map(_) => None,
        };
        let (mut properties, mut laws) = (BodyProperties::default(), BodyLaws::default());
        each!(property P => if let Some(value) = source.value(P::NAME) {
            P::read(value.table()?.as_ref())?.in_folder(folder).give(&mut properties);
        });
        each!(law L => if let Some(value) = source.value(L::NAME) {
            let table = value.table()?;
            L::read(table.as_ref())?.on(one_hardness, table.as_ref())?.give(&mut laws);
        });
        // Checked above, key by key, so this cannot fail.
        let layers = self.coating.as_ref().map_or(&self.layers[..], std::slice::from_ref);
        let material = Material::elastic(young, poisson)?;
        let material = material.layered(layers.iter().map(|layer| layer.elastic).collect());
        let relaxation = |layer: &LayerKeys| Some(layer.viscoelastic.clone()?.in_folder(folder));
        let layers = layers.iter().map(relaxation).collect();
        let thermal = self.thermal(source, used)?;
        let conducts = named.filter(|_| used.conduction);
        let conductivity = match thermal {
            None => self.conductivity.or(conducts.and_then(|named| named.conductivity)),
            Some(_) => None,
        };
        Ok(Body {
            material,
            layers,
            hardness,
            plasticity: self.plasticity.clone().map(Yielding::resolved),
            properties,
            thermal,
            conductivity,
            resistivity: self.resistivity.or(conducts.and_then(|named| named.resistivity)),
            laws,
            topography: self.topography.clone().in_folder(folder),
            mount: Some(Mount::AsIs),
        })
    }

    /// Returns the thermal constants of a body, all of them or none. Those of a named material count where
    /// they are used.
    fn thermal(&self, source: &dyn table::Source, used: Used) -> Result<Option<Thermal>> {
        let named = self.material;
        let of_material = |constant: fn(&NamedMaterial) -> Option<f64>| named.and_then(constant);
        let constants = [
            ("conductivity", self.conductivity, of_material(|named| named.conductivity)),
            ("heat_capacity", self.heat_capacity, of_material(|named| named.heat_capacity)),
            ("density", self.density, of_material(|named| named.density)),
        ];
        let are_named = constants.iter().all(|(.., named)| named.is_some());
        let counts = self.gives_heat(used) || (used.flash && are_named);
        if !counts {
            return Ok(None);
        }
        let constant = |(name, given, named): (&str, Option<f64>, Option<f64>)| {
            given.or(named).ok_or_else(|| source.missing(key(name)))
        };
        let [conductivity, heat_capacity, density] = constants;
        Thermal::new(constant(conductivity)?, constant(heat_capacity)?, constant(density)?).map(Some)
    }

    /// Whether the table gives constants of heat, without a conductivity that may be given alone.
    fn gives_heat(&self, used: Used) -> bool {
        let given = [self.conductivity, self.heat_capacity, self.density];
        given[usize::from(used.conduction)..].iter().any(Option::is_some)
    }

    /// Leaves out the heat of a body that only its material knows, if the other body has none: friction heats
    /// both or neither.
    pub(super) fn heat_together(&self, body: &mut Body, other: &Body, used: Used) {
        if other.thermal.is_none() && !self.gives_heat(used) {
            let thermal = body.thermal.take();
            body.conductivity = body
                .conductivity
                .or_else(|| thermal.filter(|_| used.conduction).map(|thermal| thermal.conductivity));
        }
    }
}

/// A part of a body: one of its layers, or the body below them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Part<'a> {
    /// Number of the layer, from 0 at the surface; `None` for the body below the layers.
    pub(crate) layer: Option<usize>,
    /// Its relaxed modulus.
    pub(crate) young: Pascal,
    pub(crate) poisson: f64,
    /// Its relaxation; `None` if it is elastic.
    pub(crate) viscoelastic: Option<&'a Viscoelasticity>,
}

impl Body {
    /// Returns the parts of the body: its layers from the surface down, then the body below them.
    pub(crate) fn parts(&self) -> impl Iterator<Item = Part<'_>> {
        let Material { young, poisson, ref layers, .. } = self.material;
        let part = |(n, layer): (usize, &Coating)| Part {
            layer: Some(n),
            young: layer.young,
            poisson: layer.poisson,
            viscoelastic: self.layers.get(n).and_then(Option::as_ref),
        };
        let below = Part { layer: None, young, poisson, viscoelastic: self.properties.viscoelastic.as_ref() };
        layers.iter().enumerate().map(part).chain([below])
    }

    /// Whether a part of the body is viscoelastic.
    pub(crate) fn relaxes(&self) -> bool {
        self.parts().any(|part| part.viscoelastic.is_some())
    }

    /// Number of its given relaxation times, 0 if they are fitted; `None` if it is elastic.
    pub(crate) fn relaxation_terms(&self) -> Option<usize> {
        self.properties.viscoelastic.as_ref().map(|body| body.moduli.len())
    }

    /// Returns the constants of the body.
    pub(super) fn constants(&self) -> BodyConstants {
        BodyConstants {
            material: self.material.clone(),
            conductivity: self.thermal.map(|thermal| thermal.conductivity).or(self.conductivity),
            resistivity: self.resistivity,
            properties: self.properties.clone(),
        }
    }
}

/// Returns an error at the first of the `keys` that is given, if `is_meaningless`. The message has the key in place of `{key}`.
fn refuse<const N: usize>(
    source: &dyn table::Source,
    keys: [&str; N],
    is_meaningless: bool,
    message: &str,
    hint: &str,
) -> Result<()> {
    let given = keys.into_iter().filter(|_| is_meaningless).find_map(|key| Some((key, source.value(key)?)));
    given.map_or(Ok(()), |(key, value)| Err(value.error(&message.replace("{key}", key), Some(hint))))
}

/// Returns the declaration of a key of a body.
fn key(name: &str) -> &'static Key {
    BodyKeys::KEYS.iter().find(|key| key.name == name).expect("a body has this key")
}

fn elastic<S: Serializer>(material: &Material, serializer: S) -> std::result::Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Keys {
        #[serde(serialize_with = "or_inf")]
        young: Pascal,
        poisson: f64,
    }
    let Material { young, poisson, .. } = *material;
    Keys { young, poisson }.serialize(serializer)
}

/// The keys of a body as a case file writes them.
#[derive(Serialize)]
pub(super) struct WrittenBody<'a> {
    #[serde(flatten)]
    body: &'a Body,
    #[serde(skip_serializing_if = "Option::is_none")]
    coating: Option<WrittenLayer<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    layers: Vec<WrittenLayer<'a>>,
}

#[derive(Serialize)]
struct WrittenLayer<'a> {
    #[serde(flatten)]
    elastic: &'a Coating,
    #[serde(skip_serializing_if = "Option::is_none")]
    viscoelastic: Option<&'a Viscoelasticity>,
}

impl<'a> WrittenBody<'a> {
    pub(super) fn new(body: &'a Body) -> Self {
        let mut layers: Vec<_> = body
            .material
            .layers
            .iter()
            .zip(body.parts())
            .map(|(elastic, part)| WrittenLayer { elastic, viscoelastic: part.viscoelastic })
            .collect();
        // A single layer is a coating.
        let coating = if layers.len() == 1 { layers.pop() } else { None };
        Self { body, coating, layers }
    }
}

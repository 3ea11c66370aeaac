//! Bodies with layers that relax, and pairs of bodies in steady sliding.

use asperity_transforms::num_complex::Complex64;

use crate::error::{Error, Result};
use crate::kernel::Stack;
use crate::material::Material;
use crate::viscoelastic::series::{Creep, Relaxation};

/// Relaxation of a body and of its layers. A part without one is elastic.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BodyRelaxation {
    /// Relaxation of the body, below its layers if it has any.
    pub body: Option<Relaxation>,
    /// Relaxation of each layer, from the surface down; empty if all of them are elastic.
    pub layers: Vec<Option<Relaxation>>,
}

impl From<Option<Relaxation>> for BodyRelaxation {
    fn from(body: Option<Relaxation>) -> Self {
        Self { body, layers: Vec::new() }
    }
}

impl BodyRelaxation {
    /// Returns the relaxations of the parts that are not elastic, from the surface down.
    pub fn all(&self) -> impl Iterator<Item = &Relaxation> {
        self.layers.iter().chain([&self.body]).flatten()
    }

    /// Whether no part relaxes.
    pub fn is_elastic(&self) -> bool {
        self.all().next().is_none()
    }
}

/// Layers on a body, of which some relax.
#[derive(Debug, Clone, PartialEq)]
pub struct ViscoelasticStack {
    material: Material,
    relaxation: BodyRelaxation,
}

impl ViscoelasticStack {
    /// Creates the layers of a `material`, whose moduli are the relaxed ones.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for relaxations of another number of layers.
    pub fn new(material: &Material, relaxation: BodyRelaxation) -> Result<Self> {
        if ![0, material.layers.len()].contains(&relaxation.layers.len()) {
            return Err(Error::Unsupported("relaxations of another number of layers than the body has"));
        }
        Ok(Self { material: material.clone(), relaxation })
    }

    /// Whether a part relaxes.
    pub fn relaxes(&self) -> bool {
        !self.relaxation.is_elastic()
    }

    /// Returns the layers under a pressure that oscillates at an angular frequency ω, 1/s. Poisson's ratios are constant.
    pub fn at(&self, frequency: f64) -> Stack<Complex64> {
        let Self { material, relaxation } = self;
        let modulus = |relaxation: Option<&Relaxation>, young: f64| {
            relaxation.map_or(young.into(), |relaxation| relaxation.complex(frequency))
        };
        let layers = material
            .layers
            .iter()
            .enumerate()
            .map(|(n, layer)| modulus(relaxation.layers.get(n).and_then(Option::as_ref), layer.young));
        let base = modulus(relaxation.body.as_ref(), material.young);
        Stack::with_moduli(material, &layers.chain([base]).collect::<Vec<_>>())
    }
}

/// Two bodies in steady sliding, as the pressure of their contact sees them.
#[derive(Debug, Clone, PartialEq)]
pub enum SlidingBodies {
    /// Half-spaces with this composite creep compliance; a body that stands still has its relaxed compliance in it.
    HalfSpaces(Creep),
    /// Bodies with layers.
    Layered {
        /// The body that passes through the contact.
        moving: ViscoelasticStack,
        /// The body that stands still in the contact, with its relaxed moduli.
        standing: ViscoelasticStack,
    },
}

impl From<&Creep> for SlidingBodies {
    fn from(creep: &Creep) -> Self {
        Self::HalfSpaces(creep.clone())
    }
}

impl SlidingBodies {
    /// Returns the bodies as waves see them whose pressure oscillates at an angular frequency ω, 1/s, in the moving body.
    pub(super) fn at(&self, frequency: f64) -> BodiesAtFrequency {
        match self {
            Self::HalfSpaces(creep) => BodiesAtFrequency::HalfSpaces(creep.complex(frequency)),
            Self::Layered { moving, standing } => {
                BodiesAtFrequency::Layered([moving.at(frequency), standing.at(0.0)])
            }
        }
    }

    /// Returns the pressure of a wave of wavenumber q > 0 per unit displacement under a load that stays, Pa/m.
    pub(super) fn relaxed_stiffness(&self, q: f64) -> f64 {
        match self {
            Self::HalfSpaces(creep) => 0.5 * q / creep.relaxed(),
            Self::Layered { .. } => self.at(0.0).response(q).re.recip(),
        }
    }
}

/// Two bodies under waves of one frequency.
pub(super) enum BodiesAtFrequency {
    /// The complex compliance 1/E*.
    HalfSpaces(Complex64),
    Layered([Stack<Complex64>; 2]),
}

impl BodiesAtFrequency {
    /// Returns the displacement per unit pressure of a wave of wavenumber q > 0, m/Pa.
    pub(super) fn response(&self, q: f64) -> Complex64 {
        match self {
            Self::HalfSpaces(compliance) => 2.0 / q * compliance,
            Self::Layered([moving, standing]) => moving.normal(q) + standing.normal(q),
        }
    }
}

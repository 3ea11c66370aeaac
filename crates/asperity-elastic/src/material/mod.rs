//! Elastic constants of the bodies and of their pair.

mod coating;
mod named;

pub use coating::Coating;
pub use named::{MATERIALS, NAMES, NamedMaterial};

use crate::error::{Error, Result, check, check_in};
use crate::units::{Dimension, Metre, Pascal};

/// An elastic, or elastic–perfectly plastic, isotropic material.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Young's modulus, > 0; infinite for a rigid body.
    pub young: Pascal,
    /// Poisson's ratio, 0 ≤ ν ≤ 0.5.
    pub poisson: f64,
    /// Hardness, > 0: the largest pressure that the body can carry; infinite for an elastic body.
    pub hardness: Pascal,
    /// Layers on the body, from the surface down. The elastic constants above belong to the body below them.
    /// The hardness caps the pressure, whether a layer or the body yields.
    pub layers: Vec<Coating>,
}

impl Material {
    /// Creates a material that never yields.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a constant has no physical meaning.
    pub fn elastic(young: Pascal, poisson: f64) -> Result<Self> {
        Self::new(young, poisson, Pascal::INFINITY)
    }

    /// Creates an elastic–perfectly plastic material.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a constant has no physical meaning.
    pub fn new(young: Pascal, poisson: f64, hardness: Pascal) -> Result<Self> {
        check_in(
            Dimension::Pressure,
            "young",
            young,
            young > 0.0,
            "a modulus above 0, or inf for a rigid body",
        )?;
        check("poisson", poisson, (0.0..=0.5).contains(&poisson), "Poisson's ratio from 0 to 0.5")?;
        check_in(Dimension::Pressure, "hardness", hardness, hardness > 0.0, "a hardness above 0")?;
        Ok(Self { young, poisson, hardness, layers: Vec::new() })
    }

    /// Sets the layer on a body of this material, a coating.
    pub fn coated(self, coating: Coating) -> Self {
        self.layered(vec![coating])
    }

    /// Sets the layers on a body of this material, from the surface down.
    pub fn layered(self, layers: Vec<Coating>) -> Self {
        Self { layers, ..self }
    }

    /// Whether the body has layers.
    pub fn is_layered(&self) -> bool {
        !self.layers.is_empty()
    }

    /// Thickness of all layers together.
    pub fn thickness(&self) -> Metre {
        self.layers.iter().map(|layer| layer.thickness).sum()
    }

    /// Returns the material at the surface, without layers: that of the first layer, or of the body.
    pub fn at_surface(&self) -> Self {
        let (young, poisson) =
            self.layers.first().map_or((self.young, self.poisson), |layer| (layer.young, layer.poisson));
        Self { young, poisson, hardness: self.hardness, layers: Vec::new() }
    }

    /// Plane-strain modulus E/(1 − ν²), without the layers.
    pub fn plane_strain_modulus(&self) -> Pascal {
        self.young / (1.0 - self.poisson * self.poisson)
    }
}

/// Compliances of a pair of half-spaces, 1/Pa, without their layers.
///
/// ```text
/// 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂                                normal
/// 1/N* = ν₁(1 + ν₁)/E₁ + ν₂(1 + ν₂)/E₂                              lateral
/// 1/G* = (1 + ν₁)(1 − 2ν₁)/2E₁ − (1 + ν₂)(1 − 2ν₂)/2E₂              coupling
/// ```
/// A normal traction acts on 1/E* alone, a tangential one on 1/E* and 1/N*. 1/G* couples normal tractions to
/// tangential displacements, and tangential tractions to normal ones. It vanishes for identical materials and
/// for two incompressible ones, and is negative if the lower body is the stiffer. Johnson (1985), ch. 3 and
/// 5.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compliances {
    /// 1/E* > 0; 0 for rigid bodies if one has layers.
    pub normal: f64,
    /// 1/N* ≥ 0.
    pub lateral: f64,
    /// 1/G*, positive or negative.
    pub coupling: f64,
}

impl Compliances {
    /// Computes the compliances of a pair of bodies.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if both bodies are rigid, and neither has layers.
    pub fn new(lower: &Material, upper: &Material) -> Result<Self> {
        let of = |m: &Material| {
            let (e, nu) = (m.young, m.poisson);
            [(1.0 - nu * nu) / e, nu * (1.0 + nu) / e, 0.5 * (1.0 + nu) * (1.0 - 2.0 * nu) / e]
        };
        let (one, other) = (of(lower), of(upper));
        let this =
            Self { normal: one[0] + other[0], lateral: one[1] + other[1], coupling: one[2] - other[2] };
        if this.normal > 0.0 || lower.is_layered() || upper.is_layered() {
            Ok(this)
        } else {
            Err(Error::OutOfRange {
                quantity: "young of both bodies",
                dimension: None,
                value: Pascal::INFINITY,
                expected: "at least one deformable body".into(),
            })
        }
    }

    /// Composite modulus E*.
    pub fn modulus(&self) -> Pascal {
        1.0 / self.normal
    }

    /// Dundurs' β = E*/G*, from −1/2 to 1/2; positive if the lower body is the softer, 0 if nothing deforms.
    pub fn dundurs(&self) -> f64 {
        if self.normal == 0.0 { 0.0 } else { self.coupling / self.normal }
    }

    /// Returns the compliances without coupling between normal and tangential tractions.
    pub fn uncoupled(&self) -> Self {
        Self { coupling: 0.0, ..*self }
    }
}

/// Composite modulus E* of a pair, see [`Compliances`].
///
/// # Errors
/// [`Error::OutOfRange`] if both bodies are rigid, and neither has layers.
pub fn composite_modulus(lower: &Material, upper: &Material) -> Result<Pascal> {
    Compliances::new(lower, upper).map(|pair| pair.modulus())
}

/// Hardness of the pair: that of the softer body.
pub fn composite_hardness(lower: &Material, upper: &Material) -> Pascal {
    lower.hardness.min(upper.hardness)
}

/// Share of the lower body in the plastic deformation: 1 if it is the softer, 0 if it is the harder, 1/2 if
/// both are equally hard.
pub fn plastic_share(lower: Pascal, upper: Pascal) -> f64 {
    match lower.partial_cmp(&upper) {
        Some(std::cmp::Ordering::Less) => 1.0,
        Some(std::cmp::Ordering::Greater) => 0.0,
        _ => 0.5,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rigid_body_leaves_the_other_ones_plane_strain_modulus() {
        let soft = Material::elastic(3.0, 0.5).unwrap();
        let rigid = Material::elastic(f64::INFINITY, 0.3).unwrap();
        assert_eq!(composite_modulus(&soft, &rigid).unwrap(), 4.0);
        assert!(composite_modulus(&rigid, &rigid).is_err());
    }

    #[test]
    fn identical_bodies_and_incompressible_ones_are_not_coupled() {
        let material = |young, poisson| Material::elastic(young, poisson).unwrap();
        let beta = |a: &Material, b: &Material| Compliances::new(a, b).unwrap().dundurs();
        assert_eq!(beta(&material(3.0, 0.3), &material(3.0, 0.3)), 0.0);
        assert_eq!(beta(&material(1.0, 0.5), &material(7.0, 0.5)), 0.0);
        // Rigid on elastic: (1 − 2ν)/2(1 − ν).
        let (soft, rigid) = (material(2.0, 0.2), material(f64::INFINITY, 0.3));
        assert!((beta(&soft, &rigid) - 0.375).abs() < 1e-15);
        assert_eq!(beta(&soft, &rigid), -beta(&rigid, &soft));
        assert_eq!(Compliances::new(&soft, &rigid).unwrap().lateral, 0.12);
    }

    #[test]
    fn the_softer_body_takes_the_plastic_deformation() {
        let soft = Material::new(1.0, 0.3, 1.0).unwrap();
        let hard = Material::new(1.0, 0.3, 2.0).unwrap();
        assert_eq!(plastic_share(1.0, 2.0), 1.0);
        assert_eq!(plastic_share(2.0, 1.0), 0.0);
        assert_eq!(plastic_share(2.0, 2.0), 0.5);
        assert_eq!(composite_hardness(&hard, &soft), 1.0);
    }

    #[test]
    fn constants_without_meaning_are_refused() {
        assert!(Material::elastic(0.0, 0.3).is_err());
        assert!(Material::elastic(1.0, 0.51).is_err());
        assert!(Material::new(1.0, 0.3, 0.0).is_err());
        assert!(Material::elastic(f64::NAN, 0.3).is_err());
    }
}

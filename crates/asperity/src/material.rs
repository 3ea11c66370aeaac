//! Elastic constants of the bodies and of the pair.

use crate::error::{Error, Result, check};
use crate::units::Pascal;

/// An elastic, or elastic–perfectly plastic, isotropic material.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Material {
    /// Young's modulus, > 0; infinite for a rigid body.
    pub young: Pascal,
    /// Poisson's ratio, 0 ≤ ν ≤ 0.5.
    pub poisson: f64,
    /// Hardness, > 0: the largest pressure that the body bears; infinite for an elastic body.
    pub hardness: Pascal,
}

impl Material {
    /// A material that never yields.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a constant has no physical meaning.
    pub fn elastic(young: Pascal, poisson: f64) -> Result<Self> {
        Self::new(young, poisson, Pascal::INFINITY)
    }

    /// An elastic–perfectly plastic material.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a constant has no physical meaning.
    pub fn new(young: Pascal, poisson: f64, hardness: Pascal) -> Result<Self> {
        check("young", young, young > 0.0, "a modulus above 0, or inf for a rigid body")?;
        check("poisson", poisson, (0.0..=0.5).contains(&poisson), "Poisson's ratio from 0 to 0.5")?;
        check("hardness", hardness, hardness > 0.0, "a hardness above 0")?;
        Ok(Self { young, poisson, hardness })
    }

    /// (1 − ν²)/E, the normal compliance of the body.
    fn compliance(&self) -> f64 {
        (1.0 - self.poisson * self.poisson) / self.young
    }
}

/// Composite modulus E* of a pair: 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂. Johnson (1985), eq. 4.14.
///
/// # Errors
/// [`Error::OutOfRange`] if both bodies are rigid.
pub fn composite_modulus(lower: &Material, upper: &Material) -> Result<Pascal> {
    let compliance = lower.compliance() + upper.compliance();
    if compliance > 0.0 {
        Ok(1.0 / compliance)
    } else {
        Err(Error::OutOfRange {
            quantity: "young of both bodies",
            value: Pascal::INFINITY,
            expected: "at least one deformable body",
        })
    }
}

/// Hardness of the pair: the softer body's.
pub fn composite_hardness(lower: &Material, upper: &Material) -> Pascal {
    lower.hardness.min(upper.hardness)
}

/// The lower body's share of the plastic deformation: all where it is the softer, none where it is the harder,
/// half where both are equally hard.
pub fn plastic_share(lower: &Material, upper: &Material) -> f64 {
    match lower.hardness.partial_cmp(&upper.hardness) {
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
    fn the_softer_body_takes_the_plastic_deformation() {
        let soft = Material::new(1.0, 0.3, 1.0).unwrap();
        let hard = Material::new(1.0, 0.3, 2.0).unwrap();
        assert_eq!(plastic_share(&soft, &hard), 1.0);
        assert_eq!(plastic_share(&hard, &soft), 0.0);
        assert_eq!(plastic_share(&hard, &hard), 0.5);
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

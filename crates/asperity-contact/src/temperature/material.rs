//! Thermal constants of a body.

use crate::error::{Result, check};

/// Thermal constants of a body with isotropic heat conduction, independent of temperature.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[non_exhaustive]
pub struct Thermal {
    /// Conductivity λ, W/(m K), > 0, finite.
    pub conductivity: f64,
    /// Heat capacity c, J/(kg K), > 0, finite.
    pub heat_capacity: f64,
    /// Density ρ, kg/m³, > 0, finite.
    pub density: f64,
}

impl Thermal {
    /// Creates a body with conductivity λ in W/(m K), heat capacity c in J/(kg K) and density ρ in kg/m³.
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] if a constant is not positive and finite.
    pub fn new(conductivity: f64, heat_capacity: f64, density: f64) -> Result<Self> {
        for (name, value) in
            [("conductivity", conductivity), ("heat_capacity", heat_capacity), ("density", density)]
        {
            check(name, value, value > 0.0 && value.is_finite(), "a finite value above 0")?;
        }
        Ok(Self { conductivity, heat_capacity, density })
    }

    /// Diffusivity D = λ/ρc, m²/s.
    pub fn diffusivity(&self) -> f64 {
        self.conductivity / (self.density * self.heat_capacity)
    }

    /// Effusivity β = √(λρc), W √s/(m² K): the flux that heats the surface by ΔT after the time t is β ΔT
    /// √π/(2√t).
    pub fn effusivity(&self) -> f64 {
        (self.conductivity * self.density * self.heat_capacity).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn diffusivity_and_effusivity_of_steel() {
        let steel = Thermal::new(46.0, 460.0, 7850.0).unwrap();
        assert!((steel.diffusivity() - 1.273_885_35e-5).abs() < 1e-13);
        assert!((steel.effusivity() * steel.diffusivity().sqrt() / steel.conductivity - 1.0).abs() < 1e-15);
    }

    #[test]
    fn constants_without_meaning_are_refused() {
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(Thermal::new(value, 1.0, 1.0).is_err());
            assert!(Thermal::new(1.0, value, 1.0).is_err());
            assert!(Thermal::new(1.0, 1.0, value).is_err());
        }
    }
}

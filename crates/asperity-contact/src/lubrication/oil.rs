//! Oils: viscosity and density under pressure.

use crate::error::{Error, Result, check, check_in};
use crate::units::{Dimension, Pascal, PascalSecond};
use asperity_base::choice::choice;

/// How the viscosity of an oil rises with pressure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ViscosityLaw {
    /// It does not.
    Constant,
    /// Barus: η₀ exp(α p). It is far too stiff above some 0.3 GPa.
    Barus,
    /// Roelands: η₀ exp((ln η₀ + 9.67) ((1 + p/p₀)ᶻ − 1)) with p₀ = 0.196 GPa, and z such that the slope at
    /// ambient pressure is α.
    #[default]
    Roelands,
    /// Doolittle: η₀ exp(B R₀ (1/(V/V₀ − R₀) − 1/(1 − R₀))), with the [`FreeVolume`] of the oil and B such that the slope
    /// at ambient pressure is α.
    Doolittle,
}

choice!(ViscosityLaw: "constant" => Constant, "barus" => Barus, "roelands" => Roelands, "doolittle" => Doolittle);

/// The volume of an oil under pressure, by Tait's equation of state with K₀′ = 11, as most oils have (Bair, High
/// Pressure Rheology for Quantitative EHL): V/V₀ = 1 − ln(1 + (1 + K₀′) p/K₀)/(1 + K₀′).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeVolume {
    /// Isothermal bulk modulus K₀ at ambient pressure, > 0; oils have 1 … 2 GPa.
    pub bulk_modulus: Pascal,
    /// Share R₀ of the volume at ambient pressure that its molecules occupy, 0 < R₀ < 1; oils have 0.6 … 0.75.
    pub occupied_volume: f64,
}

/// An oil at one temperature.
///
/// ```
/// use asperity_contact::lubrication::{Oil, ViscosityLaw};
///
/// let oil = Oil::new(0.04, 20e-9)?;
/// let thick = oil.under(1e9);
/// assert!((thick.viscosity / 1.62e4 - 1.0).abs() < 0.01, "{}", thick.viscosity);
/// assert!((thick.density - 1.214).abs() < 1e-3);
/// let barus = Oil { law: ViscosityLaw::Barus, ..oil };
/// assert!((barus.under(0.1e9).viscosity / (0.04 * 2.0_f64.exp()) - 1.0).abs() < 1e-12);
/// # Ok::<(), asperity_contact::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Oil {
    /// Viscosity η₀ at ambient pressure, > 0.
    pub viscosity: PascalSecond,
    /// Pressure–viscosity coefficient α = d ln η/dp at ambient pressure, 1/Pa, ≥ 0.
    pub pressure_viscosity: f64,
    /// How the viscosity rises with pressure.
    pub law: ViscosityLaw,
    /// Whether the density rises with pressure, by Dowson and Higginson: ρ/ρ₀ = (5.9e8 + 1.34 p)/(5.9e8 + p); with
    /// Doolittle's law by Tait.
    pub compressible: bool,
    /// Its volume under pressure, for Doolittle's law alone.
    pub free_volume: Option<FreeVolume>,
}

/// An oil under a pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CompressedOil {
    /// Viscosity η.
    pub viscosity: PascalSecond,
    /// d ln η/dp, 1/Pa.
    pub viscosity_rise: f64,
    /// Density ρ/ρ₀.
    pub density: f64,
    /// Its derivative by pressure, 1/Pa.
    pub density_rise: f64,
}

/// p₀ of Roelands, Pa.
const ROELANDS: Pascal = 1.96e8;

/// Least viscosity of Roelands' law, Pa s: its lines for all oils meet at 6.3e-5 Pa s.
const THINNEST: PascalSecond = 1e-4;

/// Largest ln η/η₀. An oil that is stiffer is a solid to any film, and its viscosity would overflow.
const STIFFEST: f64 = 60.0;

/// Pressure of Dowson and Higginson, Pa.
const DENSITY: Pascal = 5.9e8;

/// K₀′ of Tait's equation of state.
const TAIT: f64 = 11.0;

impl FreeVolume {
    /// Volume V/V₀ under a pressure ≥ 0, with its derivative by pressure.
    fn volume(&self, pressure: Pascal) -> [f64; 2] {
        let slope = (1.0 + TAIT) / self.bulk_modulus;
        [
            1.0 - (slope * pressure).ln_1p() / (1.0 + TAIT),
            -1.0 / (self.bulk_modulus + (1.0 + TAIT) * pressure),
        ]
    }

    /// ln η/η₀ under a pressure ≥ 0 of an oil whose viscosity rises by `alpha` at ambient pressure, with its derivative.
    fn exponent(&self, alpha: f64, pressure: Pascal) -> (f64, f64) {
        let [volume, change] = self.volume(pressure);
        let [free, free_ambient] = [volume, 1.0].map(|volume| volume - self.occupied_volume);
        if free <= 0.0 {
            return (f64::INFINITY, 0.0);
        }
        let factor = alpha * self.bulk_modulus * free_ambient * free_ambient;
        (factor * (free.recip() - free_ambient.recip()), -factor * change / (free * free))
    }
}

impl Oil {
    /// Creates a compressible oil with Roelands' viscosity.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) if the viscosity is not positive, or not above 1e-4 Pa s with
    /// Roelands' law, or if the coefficient is negative or above 1e-6 1/Pa (oils have 5e-9 … 40e-9).
    pub fn new(viscosity: PascalSecond, pressure_viscosity: f64) -> Result<Self> {
        let oil = Self {
            viscosity,
            pressure_viscosity,
            law: ViscosityLaw::Roelands,
            compressible: true,
            free_volume: None,
        };
        oil.check().map(|()| oil)
    }

    /// Checks the numbers.
    ///
    /// # Errors
    /// As [`Oil::new`].
    pub fn check(&self) -> Result<()> {
        let good = Dimension::Viscosity.range().holds(self.viscosity);
        check_in(Dimension::Viscosity, "viscosity", self.viscosity, good, "1e-9 … 1e9 Pa s")?;
        let alpha = self.pressure_viscosity;
        let expected = "a number in 1/Pa from 0 to 1e-6; oils have 5e-9 … 40e-9";
        check("pressure_viscosity", alpha, (0.0..=1e-6).contains(&alpha), expected)?;
        if self.law == ViscosityLaw::Roelands {
            let (good, expected) = (self.viscosity > THINNEST, "above 100 µPa s with Roelands' law");
            check_in(Dimension::Viscosity, "viscosity", self.viscosity, good, expected)?;
        }
        if let Some(FreeVolume { bulk_modulus, occupied_volume }) = self.free_volume {
            let good = bulk_modulus > 0.0 && bulk_modulus.is_finite();
            check_in(
                Dimension::Pressure,
                "bulk_modulus",
                bulk_modulus,
                good,
                "above 0; oils have 1 … 2 GPa",
            )?;
            let good = occupied_volume > 0.0 && occupied_volume < 1.0;
            check("occupied_volume", occupied_volume, good, "a share between 0 and 1; oils have 0.6 … 0.75")?;
        } else if self.law == ViscosityLaw::Doolittle {
            return Err(Error::Unsupported("Doolittle's law of viscosity without the volume of the oil"));
        }
        Ok(())
    }

    /// Returns the oil under a pressure. Under tension it is as at ambient pressure. Its viscosity is at most e⁶⁰ times
    /// that at ambient pressure.
    #[inline]
    pub fn under(&self, pressure: Pascal) -> CompressedOil {
        let p = pressure.max(0.0);
        let (exponent, slope) = match self.law {
            ViscosityLaw::Constant => (0.0, 0.0),
            ViscosityLaw::Barus => (self.pressure_viscosity * p, self.pressure_viscosity),
            ViscosityLaw::Roelands => {
                let a = self.viscosity.ln() + 9.67;
                let z = self.pressure_viscosity * ROELANDS / a;
                let b = 1.0 + p / ROELANDS;
                let power = b.powf(z);
                (a * (power - 1.0), self.pressure_viscosity * power / b)
            }
            ViscosityLaw::Doolittle => {
                self.free_volume.map_or((0.0, 0.0), |volume| volume.exponent(self.pressure_viscosity, p))
            }
        };
        let (exponent, slope) = if exponent < STIFFEST { (exponent, slope) } else { (STIFFEST, 0.0) };
        let (density, rise) = match self.free_volume.filter(|_| self.law == ViscosityLaw::Doolittle) {
            _ if !self.compressible => (1.0, 0.0),
            Some(volume) => {
                let [volume, change] = volume.volume(p);
                (volume.recip(), -change / (volume * volume))
            }
            None => {
                let sum = DENSITY + p;
                ((DENSITY + 1.34 * p) / sum, 0.34 * DENSITY / (sum * sum))
            }
        };
        let compresses = if pressure > 0.0 { 1.0 } else { 0.0 };
        CompressedOil {
            viscosity: self.viscosity * exponent.exp(),
            viscosity_rise: compresses * slope,
            density,
            density_rise: compresses * rise,
        }
    }
}

//! The fluid in a gap: leakage, pressure and flow per width.

use super::FlowAlong;
use crate::error::{Result, check_in};
use crate::grid::Field;
use crate::units::{CubicMetrePerSecond, Dimension, Pascal, PascalSecond};

/// A fluid under a pressure difference along an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fluid {
    /// Viscosity η > 0, constant.
    pub viscosity: PascalSecond,
    /// Pressure difference ΔP ≥ 0 over the length of the gap.
    pub drop: Pascal,
    /// Absolute pressure P₀ > 0 of an ideal gas of constant temperature at the outlet; `None` for a liquid.
    /// The mean free path of the gas must be small compared with the gap.
    pub outlet: Option<Pascal>,
}

impl Fluid {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) if the difference is negative, or if viscosity or
    /// outlet are not positive.
    pub fn check(&self) -> Result<()> {
        let Self { viscosity, drop, outlet } = *self;
        let range = Dimension::Pressure.range();
        let good = drop == 0.0 || range.holds(drop);
        check_in(Dimension::Pressure, "pressure drop", drop, good, "0, or 1e-6 … 1e15 Pa")?;
        let good = Dimension::Viscosity.range().holds(viscosity);
        check_in(Dimension::Viscosity, "viscosity", viscosity, good, "1e-9 … 1e9 Pa s")?;
        let Some(outlet) = outlet else { return Ok(()) };
        let (good, expected) = (range.holds(outlet), "1e-6 … 1e15 Pa");
        check_in(Dimension::Pressure, "pressure of the outlet", outlet, good, expected)?;
        let (inlet, expected) = (outlet + drop, "at most 1e15 Pa");
        check_in(Dimension::Pressure, "pressure of the inlet", inlet, range.holds(inlet), expected)
    }

    /// Returns the difference under which a liquid leaks as much, Pa: ΔP, and (P₁² − P₀²)/2P₀ for a gas at
    /// the pressure of the outlet.
    fn liquid_drop(&self) -> Pascal {
        match self.outlet {
            Some(outlet) => self.drop * (0.5 * (2.0 * outlet + self.drop) / outlet),
            None => self.drop,
        }
    }

    /// Returns the pressure above that of the outlet, where the pressure of a liquid has fallen to this share
    /// of its drop.
    fn pressure(&self, share: f64) -> Pascal {
        match self.outlet {
            // The square of the absolute pressure falls as the pressure of a liquid does. Under a mean
            // gradient a cell may lie outside both pressures.
            Some(outlet) => {
                let inlet = outlet + self.drop;
                (outlet * outlet + share * (inlet * inlet - outlet * outlet)).max(0.0).sqrt() - outlet
            }
            None => share * self.drop,
        }
    }
}

impl FlowAlong {
    /// Returns the volume of a fluid that leaks in a unit of time; of a gas, at the pressure of the outlet.
    ///
    /// Q = K (W/L) ΔP/12η, and for an ideal gas K (W/L) (P₁² − P₀²)/(2P₀)/12η.
    ///
    /// # Errors
    /// The errors of [`Fluid::check`].
    pub fn leakage(&self, fluid: &Fluid) -> Result<CubicMetrePerSecond> {
        fluid.check()?;
        let aspect = self.width / self.length;
        Ok(self.permeability * aspect * fluid.liquid_drop() / (12.0 * fluid.viscosity))
    }

    /// Computes the pressure of a fluid above that of the outlet, Pa; 0 in closed cells, and where no path
    /// leads to an end.
    pub fn pressure_of(&self, fluid: &Fluid) -> Field {
        self.pressure.mapv(|share| fluid.pressure(share))
    }

    /// Computes the flow of a fluid per width at the centres of the cells, m²/s; of a gas, at the pressure of
    /// the outlet.
    pub fn rate_of(&self, fluid: &Fluid) -> Field {
        let scale = fluid.liquid_drop() / (12.0 * fluid.viscosity * self.length);
        let [mut rate, across] = self.flux_at_centres();
        rate.zip_mut_with(&across, |rate, across| *rate = scale * rate.hypot(*across));
        rate
    }
}

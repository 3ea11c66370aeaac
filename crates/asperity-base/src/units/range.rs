//! Limits on the magnitude of input values. They lie far beyond any contact on either side, and no product of
//! such quantities overflows or underflows.

use std::fmt;

use super::Dimension;

/// Accepted magnitudes, besides 0 where zero is allowed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// The smallest, SI.
    pub least: f64,
    /// The largest, SI.
    pub most: f64,
    /// The unit of the magnitudes; empty for pure numbers.
    pub unit: &'static str,
}

/// Accepted magnitudes of numbers without a unit: slopes, factors, coefficients, creepages, tolerances.
pub const NUMBERS: Range = Range { least: 1e-15, most: 1e12, unit: "" };

/// The largest count of passes, increments, cells of a stride, or samples along an axis.
pub const MAX_COUNT: usize = 1_000_000_000;

impl Dimension {
    /// The accepted magnitudes of a quantity.
    pub fn range(self) -> Range {
        let (least, most, unit) = match self {
            Self::Length => (1e-15, 1e6, "m"),
            Self::Area => (1e-30, 1e12, "m²"),
            Self::Volume => (1e-45, 1e18, "m³"),
            Self::Pressure => (1e-6, 1e15, "Pa"),
            Self::Force => (1e-18, 1e15, "N"),
            Self::Energy => (1e-33, 1e21, "J"),
            Self::Speed => (1e-15, 1e9, "m/s"),
            Self::Angle => (1e-15, 1e6, "rad"),
            Self::Time => (1e-15, 1e15, "s"),
            Self::Stiffness => (1e-21, 1e21, "N/m"),
            Self::VolumePerWork => (1e-30, 1e-3, "1/Pa"),
            Self::RemovalRate => (1e-30, 1e9, "1/(Pa m)"),
            Self::PerPressure => (1e-15, 1e-3, "1/Pa"),
            Self::Temperature => (1e-3, 1e5, "K"),
            Self::Conductivity => (1e-6, 1e6, "W/(m K)"),
            Self::ThermalInsulance => (1e-30, 1e9, "m² K/W"),
            Self::ElectricalConductivity => (1e-21, 1e15, "S/m"),
            Self::Resistivity => (1e-15, 1e21, "Ω m"),
            Self::ElectricalInsulance => (1e-30, 1e21, "Ω m²"),
            Self::HeatCapacity => (1e-3, 1e9, "J/(kg K)"),
            Self::Density => (1e-3, 1e6, "kg/m³"),
            Self::Power => (1e-18, 1e15, "W"),
            Self::TemperatureDifference => (1e-6, 1e5, "K"),
            Self::Voltage => (1e-12, 1e9, "V"),
            Self::ThermalResistance => (1e-18, 1e18, "K/W"),
            Self::ElectricalResistance => (1e-18, 1e18, "Ω"),
            Self::ThermalConductance => (1e-18, 1e18, "W/K"),
            Self::ElectricalConductance => (1e-18, 1e18, "S"),
            Self::ThermalConductanceOfArea => (1e-18, 1e18, "W/(m² K)"),
            Self::ElectricalConductanceOfArea => (1e-18, 1e18, "S/m²"),
            Self::Viscosity => (1e-9, 1e9, "Pa s"),
            Self::SurfaceEnergy => (1e-12, 1e6, "J/m²"),
            Self::VolumeFlow => (1e-45, 1e18, "m³/s"),
        };
        Range { least, most, unit }
    }
}

impl Range {
    /// Whether a positive value lies within the range.
    pub fn holds(&self, value: f64) -> bool {
        (self.least..=self.most).contains(&value)
    }

    /// Returns 0 for a value of any sign below the smallest magnitude, as rounding leaves it in place of 0;
    /// otherwise the value.
    pub fn without_dust(&self, value: f64) -> f64 {
        if value.abs() < self.least { 0.0 } else { value }
    }

    /// Whether a value of any sign is 0 or has a magnitude within the range.
    pub fn holds_signed(&self, value: f64) -> bool {
        value == 0.0 || self.holds(value.abs())
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { least, most, unit } = self;
        write!(f, "{least:e} … {most:e}{}{unit}", if unit.is_empty() { "" } else { " " })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_has_both_ends_and_no_nan() {
        let lengths = Dimension::Length.range();
        assert!(lengths.holds(1e-15) && lengths.holds(1e6) && !lengths.holds(0.0) && !lengths.holds(-1.0));
        assert!(lengths.holds_signed(0.0) && lengths.holds_signed(-1e6) && !lengths.holds_signed(-1e-16));
        assert_eq!([-2.2e-16, 1e-15, -1.0].map(|value| lengths.without_dust(value)), [0.0, 1e-15, -1.0]);
        assert!(!lengths.holds(f64::NAN) && !lengths.holds_signed(f64::INFINITY));
        assert_eq!(
            (lengths.to_string(), NUMBERS.to_string()),
            ("1e-15 … 1e6 m".into(), "1e-15 … 1e12".into())
        );
    }
}

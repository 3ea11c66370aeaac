//! Quantities as people write them: `"2.4 GPa"`, `"0.25 um"`, `"10 mm/s"`.

/// Physical dimension of a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// Metres.
    Length,
    /// Square metres.
    Area,
    /// Cubic metres.
    Volume,
    /// Pascals.
    Pressure,
    /// Newtons.
    Force,
    /// Joules.
    Energy,
    /// Metres per second.
    Speed,
    /// Radians.
    Angle,
    /// Seconds.
    Time,
    /// Newtons per metre.
    Stiffness,
    /// Volume lost per load and distance slid, or per energy of friction: 1/Pa, which is m³/(N m) and m³/J.
    VolumePerWork,
    /// Removal rate per pressure and distance slid, 1/(Pa m).
    RemovalRate,
    /// Relative rise per pressure, such as that of a viscosity, 1/Pa.
    PerPressure,
    /// Kelvins; degrees Celsius are also read.
    Temperature,
    /// Watts per metre and kelvin.
    Conductivity,
    /// Thermal resistance of an area, m² K/W.
    ThermalInsulance,
    /// Siemens per metre.
    ElectricalConductivity,
    /// Ohm metres.
    Resistivity,
    /// Electrical resistance of an area, Ω m².
    ElectricalInsulance,
    /// Joules per kilogram and kelvin.
    HeatCapacity,
    /// Kilograms per cubic metre.
    Density,
    /// Watts.
    Power,
    /// Kelvins between two bodies.
    TemperatureDifference,
    /// Volts.
    Voltage,
    /// Kelvins per watt.
    ThermalResistance,
    /// Ohms.
    ElectricalResistance,
    /// Watts per kelvin.
    ThermalConductance,
    /// Siemens.
    ElectricalConductance,
    /// Watts per square metre and kelvin.
    ThermalConductanceOfArea,
    /// Siemens per square metre.
    ElectricalConductanceOfArea,
    /// Pascal seconds.
    Viscosity,
    /// Cubic metres per second.
    VolumeFlow,
    /// Joules per square metre.
    SurfaceEnergy,
}

/// Reason why a text is not a quantity of the expected dimension.
#[derive(Debug, Clone, PartialEq)]
pub enum UnitError {
    /// No dimension has this unit.
    Unknown {
        /// The unit as written.
        unit: String,
        /// The expected dimension.
        expected: Dimension,
        /// The number before it.
        number: f64,
        /// The most similar unit of that dimension.
        suggestion: Option<String>,
    },
    /// The unit belongs to another dimension.
    WrongDimension {
        /// The quantity as written.
        text: String,
        /// The dimension found.
        found: Dimension,
        /// The expected dimension.
        expected: Dimension,
    },
    /// The text does not start with a number.
    NotAQuantity {
        /// The text.
        text: String,
        /// The expected dimension.
        expected: Dimension,
    },
    /// The number is too large, NaN, or infinite where infinity is not accepted.
    NotFinite {
        /// The text.
        text: String,
        /// The expected dimension.
        expected: Dimension,
    },
}

/// Reads a quantity, in SI.
///
/// A number without a unit is in SI already. `inf` is accepted for pressures (a rigid or unyielding body) and
/// for conductivities (a body without resistance of its own). The result is the `f64` nearest to the written
/// value, prefix included: `"0.1 um"` is `1e-7`.
///
/// # Errors
/// [`UnitError`], which also names the expected dimension.
pub fn parse(text: &str, expected: Dimension) -> Result<f64, UnitError> {
    let trimmed = text.trim();
    let bare = trimmed.strip_prefix(['+', '-']).unwrap_or(trimmed);
    if bare == "inf" || bare == "nan" {
        return match trimmed {
            "inf" | "+inf" if matches!(expected, Dimension::Pressure | Dimension::Conductivity) => {
                Ok(f64::INFINITY)
            }
            _ => Err(UnitError::NotFinite { text: text.to_owned(), expected }),
        };
    }
    let not_a_quantity = || UnitError::NotAQuantity { text: text.to_owned(), expected };
    let Number { mantissa, exponent, rest } = split_number(trimmed).ok_or_else(not_a_quantity)?;
    let unit = rest.trim();
    let is_number = unit.starts_with(|c: char| c.is_ascii_digit()) && !unit.starts_with("1/");
    if is_number || unit.starts_with([',', '.', '_', '+', '-']) {
        return Err(not_a_quantity());
    }
    let (power_of_ten, factor) = if unit.is_empty() { (0, 1.0) } else { find_unit(text, unit, expected)? };
    let read = |mantissa: &str, exponent: i32| {
        format!("{mantissa}e{}", exponent.saturating_add(power_of_ten)).parse::<f64>()
    };
    let value = match (times(mantissa, factor), factor.recip().round()) {
        (Some((digits, decimals)), _) => read(&digits.to_string(), exponent - decimals),
        (None, parts) if factor == parts.recip() => read(mantissa, exponent).map(|value| value / parts),
        _ => read(mantissa, exponent).map(|value| value * factor),
    };
    let value = value.map_err(|_| not_a_quantity())?;
    let is_celsius =
        expected == Dimension::Temperature && !unit.is_empty() && unit != "K" && unit.ends_with('C');
    let value = if is_celsius { value + CELSIUS } else { value };
    if value.is_finite() { Ok(value) } else { Err(UnitError::NotFinite { text: text.to_owned(), expected }) }
}

/// Reads the size of a unit, in SI: its name, which means one of it, or a quantity: `nm`, `0.5 um`.
///
/// # Errors
/// The errors of [`parse`].
pub fn parse_unit(text: &str, expected: Dimension) -> Result<f64, UnitError> {
    let is_name = text.trim_start().starts_with(char::is_alphabetic);
    if is_name { parse(&format!("1 {}", text.trim()), expected) } else { parse(text, expected) }
}

/// Returns the digits and the number of decimals of a decimal number times a whole `factor`; `None` if it has
/// too many digits.
fn times(mantissa: &str, factor: f64) -> Option<(i128, i32)> {
    let (whole, decimals) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = format!("{whole}{decimals}").parse::<i128>().ok().filter(|_| factor.fract() == 0.0)?;
    Some((digits.checked_mul(factor as i128)?, i32::try_from(decimals.len()).ok()?))
}

/// Unit in which volumes per load and distance are written.
const MM3_PER_NM: &str = "mm³/(N m)";

/// The unit in which a rise per pressure is written.
const PER_GPA: &str = "1/GPa";

/// 0 °C in kelvins.
pub const CELSIUS: f64 = 273.15;

/// Writes a quantity with four significant digits and a suitable prefix: `2.4 GPa`, `0.25 µm`, `12.3 mN`.
///
/// [`parse`] reads it back. The number is from 1 to 1000, of areas from 0.01 and of volumes from 0.001.
/// Angles are in degrees.
pub fn format(value: f64, dimension: Dimension) -> String {
    format_digits(value, dimension, 4)
}

/// Writes two values with a unit, with enough digits (four to twelve) to show a difference between them.
pub fn format_distinct(values: [f64; 2], dimension: Dimension) -> [String; 2] {
    let shown = |digits| values.map(|value| format_digits(value, dimension, digits));
    (4..12).map(shown).find(|[one, other]| one != other).unwrap_or_else(|| shown(12))
}

/// Writes a pure number with four digits: `0.7`, `1.2e-9`.
pub fn format_number(value: f64) -> String {
    format_number_digits(value, 4)
}

/// [`format_number()`] with another number of significant digits. All digits before the point are written.
pub fn format_number_digits(value: f64, digits: usize) -> String {
    match value.abs() {
        size if size != 0.0 && size.is_finite() && !(1e-4..1e6).contains(&size) => {
            format!("{:e}", round(value, digits))
        }
        size if size.is_finite() => decimal(value, digits),
        _ => format!("{value}"),
    }
}

/// [`format()`] with as many digits, at least four, as [`parse`] needs to come within the relative error
/// `within` of the value.
pub fn format_within(value: f64, dimension: Dimension, within: f64) -> String {
    let close =
        |text: &String| parse(text, dimension).is_ok_and(|read| (read - value).abs() <= within * value.abs());
    let mut texts = (4..17).map(|digits| format_digits(value, dimension, digits));
    texts.find(close).unwrap_or_else(|| format_digits(value, dimension, 17))
}

/// [`format()`] with another number of significant digits.
pub fn format_digits(value: f64, dimension: Dimension, digits: usize) -> String {
    if dimension == Dimension::Angle {
        return format!("{}°", legible(value.to_degrees(), digits));
    }
    if dimension == Dimension::VolumePerWork {
        return format!("{:e} {MM3_PER_NM}", round(value * 1e9, digits));
    }
    if dimension == Dimension::PerPressure {
        return format!("{} {PER_GPA}", format_number_digits(value * 1e9, digits));
    }
    let Scale { base, power, .. } = dimension.scale();
    let suffix = base.suffix();
    if value == 0.0 {
        return format!("0 {}{suffix}", base.symbol());
    }
    if !value.is_finite() {
        return format!("{value}");
    }
    // Rounded first: 999.96 Pa becomes 1 kPa.
    let rounded = round(value, digits);
    match dimension.prefix(rounded) {
        Some((prefix, exponent)) => {
            let number = rounded / 10f64.powi(power * exponent);
            if number.abs() < MAX_FIXED {
                return format!("{} {prefix}{}{suffix}", decimal(number, digits), base.symbol());
            }
            format!("{rounded:e} {}{suffix}", base.symbol())
        }
        None => format!("{rounded:e} {}{suffix}", base.symbol()),
    }
}

/// A multiple of a unit, used for all numbers of a column.
#[derive(Debug, Clone, PartialEq)]
pub struct Multiple {
    /// Size of one multiple in SI.
    pub factor: f64,
    /// The symbol of the multiple: `µm`.
    pub symbol: String,
}

impl Multiple {
    /// Writes a value, SI, with four significant digits.
    pub fn write(&self, value: f64) -> String {
        format!("{} {}", format_number(value / self.factor), self.symbol)
    }
}

impl UnitError {
    /// The message for a known key:
    /// `unknown unit 'GPb' in 'hardness', expected a pressure such as "2.4 GPa"`.
    pub fn for_key(&self, key: &str) -> String {
        self.message(&format!(" in '{key}'"))
    }

    fn message(&self, place: &str) -> String {
        match self {
            Self::Unknown { unit, expected, .. } => {
                format!("unknown unit '{unit}'{place}, expected {}", expected.expectation())
            }
            Self::WrongDimension { text, found, expected } => {
                format!("'{text}'{place} is {}, expected {}", found.noun(), expected.expectation())
            }
            Self::NotAQuantity { text, expected } => {
                format!("'{text}'{place} is not a quantity, expected {}", expected.expectation())
            }
            Self::NotFinite { text, expected } => {
                format!("'{text}'{place} is not finite, expected {}", expected.expectation())
            }
        }
    }
}

impl std::fmt::Display for UnitError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message(""))
    }
}

impl std::error::Error for UnitError {}

impl Dimension {
    /// The name of the dimension with its article: "a pressure".
    pub fn noun(self) -> &'static str {
        match self {
            Self::Length => "a length",
            Self::Area => "an area",
            Self::Volume => "a volume",
            Self::Pressure => "a pressure",
            Self::Force => "a force",
            Self::Energy => "an energy",
            Self::Speed => "a speed",
            Self::Angle => "an angle",
            Self::Time => "a time",
            Self::Stiffness => "a stiffness",
            Self::VolumePerWork => "a volume per load and distance",
            Self::RemovalRate => "a rate per pressure and distance",
            Self::PerPressure => "a rise per pressure",
            Self::Temperature => "a temperature",
            Self::Conductivity => "a thermal conductivity",
            Self::ThermalInsulance => "a thermal resistance of an area",
            Self::ElectricalConductivity => "an electrical conductivity",
            Self::Resistivity => "a resistivity",
            Self::ElectricalInsulance => "an electrical resistance of an area",
            Self::HeatCapacity => "a heat capacity",
            Self::Density => "a density",
            Self::Power => "a power",
            Self::TemperatureDifference => "a temperature difference",
            Self::Voltage => "a voltage",
            Self::ThermalResistance => "a thermal resistance",
            Self::ElectricalResistance => "an electrical resistance",
            Self::ThermalConductance => "a thermal conductance",
            Self::ElectricalConductance => "an electrical conductance",
            Self::ThermalConductanceOfArea => "a thermal conductance of an area",
            Self::ElectricalConductanceOfArea => "an electrical conductance of an area",
            Self::Viscosity => "a viscosity",
            Self::VolumeFlow => "a flow of volume",
            Self::SurfaceEnergy => "an energy of an area",
        }
    }

    /// A sample quantity that [`parse`] reads.
    pub fn example(self) -> &'static str {
        match self {
            Self::Length => "0.25 um",
            Self::Area => "4 um2",
            Self::Volume => "8 um3",
            Self::Pressure => "2.4 GPa",
            Self::Force => "2 N",
            Self::Energy => "3 nJ",
            Self::Speed => "10 mm/s",
            Self::Angle => "5 deg",
            Self::Time => "1 ms",
            Self::Stiffness => "4 MN/m",
            Self::VolumePerWork => "1e-7 mm3/(N m)",
            Self::RemovalRate => "1e-11 1/(Pa m)",
            Self::PerPressure => "20 1/GPa",
            Self::Temperature => "100 °C",
            Self::Conductivity => "46 W/(m K)",
            Self::ThermalInsulance => "1e-8 m2 K/W",
            Self::ElectricalConductivity => "5.9e7 S/m",
            Self::Resistivity => "1.7e-8 ohm m",
            Self::ElectricalInsulance => "1e-12 ohm m2",
            Self::HeatCapacity => "460 J/(kg K)",
            Self::Density => "7850 kg/m3",
            Self::Power => "2 W",
            Self::TemperatureDifference => "10 K",
            Self::Voltage => "0.1 V",
            Self::ThermalResistance => "20 K/W",
            Self::ElectricalResistance => "5 mohm",
            Self::ThermalConductance => "50 mW/K",
            Self::ElectricalConductance => "200 S",
            Self::ThermalConductanceOfArea => "5 kW/(m2 K)",
            Self::ElectricalConductanceOfArea => "1e9 S/m2",
            Self::Viscosity => "80 mPa s",
            Self::VolumeFlow => "2 mm3/s",
            Self::SurfaceEnergy => "50 mJ/m2",
        }
    }

    fn expectation(self) -> String {
        format!("{} such as \"{}\"", self.noun(), self.example())
    }

    /// Symbol of the SI unit, which [`parse`] reads: `Pa`, `m/s`, `rad`.
    pub fn si(self) -> &'static str {
        match self.scale().base {
            Base::Of(symbol) => symbol,
            Base::Squared => "m²",
            Base::Cubed => "m³",
            Base::CubedPerSecond => "m³/s",
            Base::PerSecond => "m/s",
        }
    }

    /// All dimensions.
    pub const ALL: [Self; 33] = [
        Self::Length,
        Self::Area,
        Self::Volume,
        Self::Pressure,
        Self::Force,
        Self::Energy,
        Self::Speed,
        Self::Angle,
        Self::Time,
        Self::Stiffness,
        Self::VolumePerWork,
        Self::RemovalRate,
        Self::PerPressure,
        Self::Temperature,
        Self::Conductivity,
        Self::ThermalInsulance,
        Self::ElectricalConductivity,
        Self::Resistivity,
        Self::ElectricalInsulance,
        Self::HeatCapacity,
        Self::Density,
        Self::Power,
        Self::TemperatureDifference,
        Self::Voltage,
        Self::ThermalResistance,
        Self::ElectricalResistance,
        Self::ThermalConductance,
        Self::ElectricalConductance,
        Self::ThermalConductanceOfArea,
        Self::ElectricalConductanceOfArea,
        Self::Viscosity,
        Self::VolumeFlow,
        Self::SurfaceEnergy,
    ];

    fn scale(self) -> Scale {
        let scale = |base, power, largest| Scale { base, power, largest, smallest: -12 };
        match self {
            Self::Length => scale(Base::Of("m"), 1, 3),
            Self::Area => scale(Base::Squared, 2, 0),
            Self::Volume => scale(Base::Cubed, 3, 0),
            Self::Pressure => scale(Base::Of("Pa"), 1, 12),
            Self::Force => scale(Base::Of("N"), 1, 12),
            Self::Energy => Scale { smallest: -18, ..scale(Base::Of("J"), 1, 12) },
            Self::Speed => scale(Base::PerSecond, 1, 0),
            Self::Angle => scale(Base::Of("rad"), 1, 0),
            Self::Time => scale(Base::Of("s"), 1, 0),
            Self::Stiffness => scale(Base::Of("N/m"), 1, 12),
            Self::VolumePerWork => scale(Base::Of("1/Pa"), 1, 0),
            Self::RemovalRate => scale(Base::Of("1/(Pa m)"), 1, 0),
            Self::PerPressure => scale(Base::Of("1/Pa"), 1, 0),
            Self::Temperature => scale(Base::Of("K"), 1, 0),
            Self::Conductivity => scale(Base::Of("W/(m K)"), 1, 3),
            Self::ThermalInsulance => scale(Base::Of("m² K/W"), 1, 0),
            Self::ElectricalConductivity => scale(Base::Of("S/m"), 1, 6),
            Self::Resistivity => scale(Base::Of("Ω m"), 1, 0),
            Self::ElectricalInsulance => scale(Base::Of("Ω m²"), 1, 0),
            Self::HeatCapacity => scale(Base::Of("J/(kg K)"), 1, 0),
            Self::Density => scale(Base::Of("kg/m³"), 1, 0),
            Self::Power => scale(Base::Of("W"), 1, 12),
            Self::TemperatureDifference => scale(Base::Of("K"), 1, 0),
            Self::Voltage => scale(Base::Of("V"), 1, 3),
            Self::ThermalResistance => scale(Base::Of("K/W"), 1, 12),
            Self::ElectricalResistance => scale(Base::Of("Ω"), 1, 12),
            Self::ThermalConductance => scale(Base::Of("W/K"), 1, 12),
            Self::ElectricalConductance => scale(Base::Of("S"), 1, 12),
            Self::ThermalConductanceOfArea => scale(Base::Of("W/(m² K)"), 1, 12),
            Self::ElectricalConductanceOfArea => scale(Base::Of("S/m²"), 1, 12),
            Self::Viscosity => scale(Base::Of("Pa s"), 1, 3),
            Self::VolumeFlow => scale(Base::CubedPerSecond, 3, 0),
            Self::SurfaceEnergy => scale(Base::Of("J/m²"), 1, 0),
        }
    }

    /// The multiple that suits `value`, SI, as in [`format()`]; the SI unit for 0.
    pub fn multiple(self, value: f64) -> Multiple {
        if self == Self::Angle {
            return Multiple { factor: std::f64::consts::PI / 180.0, symbol: "°".to_owned() };
        }
        if self == Self::VolumePerWork {
            return Multiple { factor: 1e-9, symbol: MM3_PER_NM.to_owned() };
        }
        if self == Self::PerPressure {
            return Multiple { factor: 1e-9, symbol: PER_GPA.to_owned() };
        }
        let Scale { base, power, .. } = self.scale();
        let (prefix, exponent) = self.prefix(round(value, 4)).unwrap_or(("", 0));
        let symbol = format!("{prefix}{}{}", base.symbol(), base.suffix());
        Multiple { factor: 10f64.powi(power * exponent), symbol }
    }

    /// The prefix that suits a value, and its exponent; `None` below the smallest prefix.
    fn prefix(self, value: f64) -> Option<(&'static str, i32)> {
        if !self.takes_prefixes() {
            return (1e-3..1e6).contains(&value.abs()).then_some(("", 0));
        }
        let scale = self.scale();
        let suits =
            |exponent: i32| value.abs() >= 10f64.powi(scale.power * exponent) * self.smallest(exponent);
        scale.prefixes().rev().find(|(_, exponent)| suits(*exponent))
    }

    /// Whether the unit is written with prefixes.
    fn takes_prefixes(self) -> bool {
        !matches!(
            self,
            Self::VolumePerWork
                | Self::RemovalRate
                | Self::PerPressure
                | Self::Temperature
                | Self::Conductivity
                | Self::ThermalInsulance
                | Self::ElectricalConductivity
                | Self::Resistivity
                | Self::ElectricalInsulance
                | Self::HeatCapacity
                | Self::Density
                | Self::TemperatureDifference
        )
    }

    /// The smallest number written with the prefix 10^`exponent`.
    fn smallest(self, exponent: i32) -> f64 {
        match (self, exponent) {
            (Self::Area, _) => 1e-2,
            (Self::Volume | Self::VolumeFlow, _) => 1e-3,
            // A thousandth of the smallest prefix of energies, beside which it is read.
            (Self::Energy, -18) => 1e-3,
            _ => 1.0,
        }
    }

    /// Units without a prefix: power of ten and factor.
    fn special(self) -> &'static [(&'static str, i32, f64)] {
        use std::f64::consts::PI;
        match self {
            Self::Length => &[("Å", -10, 1.0)],
            Self::Volume => &[("Å³", -30, 1.0), ("Å^3", -30, 1.0), ("Å3", -30, 1.0)],
            Self::Pressure => &[("bar", 5, 1.0), ("mbar", 2, 1.0), ("hPa", 2, 1.0)],
            Self::Angle => &[("deg", 0, PI / 180.0), ("°", 0, PI / 180.0)],
            Self::Time => &[("min", 0, 60.0), ("h", 0, 3600.0)],
            Self::Energy => &[("eV", -19, 1.602176634)],
            Self::VolumePerWork => &[
                ("mm3/(N m)", -9, 1.0),
                ("mm³/(N m)", -9, 1.0),
                ("mm^3/(N m)", -9, 1.0),
                ("mm3/Nm", -9, 1.0),
                ("mm³/Nm", -9, 1.0),
                ("mm3/N/m", -9, 1.0),
                ("m3/(N m)", 0, 1.0),
                ("m2/N", 0, 1.0),
                ("m²/N", 0, 1.0),
                ("mm3/J", -9, 1.0),
                ("mm³/J", -9, 1.0),
                ("m3/J", 0, 1.0),
            ],
            Self::RemovalRate => &[("1/Pa/m", 0, 1.0)],
            Self::PerPressure => &[
                ("1/GPa", -9, 1.0),
                ("1/MPa", -6, 1.0),
                ("/Pa", 0, 1.0),
                ("/GPa", -9, 1.0),
                ("/MPa", -6, 1.0),
                ("Pa^-1", 0, 1.0),
                ("GPa^-1", -9, 1.0),
                ("m2/N", 0, 1.0),
                ("mm2/N", -6, 1.0),
                ("m²/N", 0, 1.0),
                ("mm²/N", -6, 1.0),
            ],
            Self::Conductivity => &[
                ("W/m/K", 0, 1.0),
                ("W/mK", 0, 1.0),
                ("W/(mK)", 0, 1.0),
                ("W/(mm K)", 3, 1.0),
                ("W/(cm K)", 2, 1.0),
            ],
            Self::ThermalInsulance => &[("m2 K/W", 0, 1.0), ("m^2 K/W", 0, 1.0), ("m2K/W", 0, 1.0)],
            Self::ElectricalConductivity => &[("MS/m", 6, 1.0), ("S/cm", 2, 1.0)],
            Self::Resistivity => {
                &[("ohm m", 0, 1.0), ("ohm cm", -2, 1.0), ("uohm cm", -8, 1.0), ("µΩ cm", -8, 1.0)]
            }
            Self::ElectricalInsulance => {
                &[("ohm m2", 0, 1.0), ("ohm m^2", 0, 1.0), ("ohm cm2", -4, 1.0), ("Ω cm²", -4, 1.0)]
            }
            Self::HeatCapacity => {
                &[("J/kg/K", 0, 1.0), ("J/(kgK)", 0, 1.0), ("J/kgK", 0, 1.0), ("J/(g K)", 3, 1.0)]
            }
            Self::Density => &[
                ("kg/m3", 0, 1.0),
                ("kg/m^3", 0, 1.0),
                ("g/cm3", 3, 1.0),
                ("g/cm³", 3, 1.0),
                ("g/cm^3", 3, 1.0),
            ],
            Self::Temperature => &[("°C", 0, 1.0), ("degC", 0, 1.0), ("C", 0, 1.0)],
            Self::ThermalConductanceOfArea => &[
                ("W/(m2 K)", 0, 1.0),
                ("kW/(m2 K)", 3, 1.0),
                ("W/(m^2 K)", 0, 1.0),
                ("W/m2/K", 0, 1.0),
                ("W/m2K", 0, 1.0),
            ],
            Self::ElectricalConductanceOfArea => &[("S/m2", 0, 1.0), ("S/m^2", 0, 1.0)],
            Self::ElectricalResistance => {
                &[("ohm", 0, 1.0), ("mohm", -3, 1.0), ("uohm", -6, 1.0), ("kohm", 3, 1.0)]
            }
            Self::Viscosity => &[("Pas", 0, 1.0), ("mPas", -3, 1.0), ("cP", -3, 1.0), ("P", -1, 1.0)],
            Self::VolumeFlow => &[
                ("l/min", -3, 1.0 / 60.0),
                ("ml/min", -6, 1.0 / 60.0),
                ("ul/min", -9, 1.0 / 60.0),
                ("L/min", -3, 1.0 / 60.0),
                ("mL/min", -6, 1.0 / 60.0),
            ],
            Self::SurfaceEnergy => &[
                ("J/m2", 0, 1.0),
                ("mJ/m2", -3, 1.0),
                ("uJ/m2", -6, 1.0),
                ("J/m^2", 0, 1.0),
                ("mJ/m^2", -3, 1.0),
                ("N/m", 0, 1.0),
                ("mN/m", -3, 1.0),
                ("erg/cm2", -3, 1.0),
            ],
            _ => &[],
        }
    }

    /// Power of ten and factor of a unit of this dimension. A pressure may be a force over an area: `N/mm²`.
    pub(super) fn unit(self, unit: &str) -> Option<(i32, f64)> {
        if let Some(&(_, exponent, factor)) = self.special().iter().find(|(name, ..)| *name == unit) {
            return Some((exponent, factor));
        }
        if let (Self::Pressure, Some((force, area))) = (self, unit.split_once('/')) {
            return Some((Self::Force.unit(force)?.0 - Self::Area.unit(area)?.0, 1.0));
        }
        let Scale { base, power, smallest, .. } = self.scale();
        let (stem, factor) = match base {
            Base::Of(_) => (unit, 1.0),
            Base::PerSecond => {
                let (length, time) = unit.split_once('/')?;
                (length, 1.0 / Self::Time.unit(time).filter(|(exponent, _)| *exponent == 0)?.1)
            }
            Base::Squared => (SQUARED.iter().find_map(|end| unit.strip_suffix(end))?, 1.0),
            Base::CubedPerSecond => {
                (["³/s", "^3/s", "3/s"].iter().find_map(|end| unit.strip_suffix(end))?, 1.0)
            }
            Base::Cubed => (["³", "^3", "3"].iter().find_map(|end| unit.strip_suffix(end))?, 1.0),
        };
        let prefix = stem.strip_suffix(base.symbol())?;
        let known = |exponent: i32| exponent >= smallest && (exponent % 3 == 0 || base.symbol() == "m");
        let exponent = match prefix {
            "" => 0,
            _ if !self.takes_prefixes() => return None,
            "u" | "\u{3bc}" => -6,
            _ => PREFIXES.iter().find(|(name, exponent)| *name == prefix && known(*exponent))?.1,
        };
        Some((power * exponent, factor))
    }
}

/// How a dimension uses prefixes.
struct Scale {
    base: Base,
    /// The power of the prefix: 2 for an area.
    power: i32,
    /// Exponent of the largest prefix in use.
    largest: i32,
    /// Exponent of the smallest prefix in use.
    smallest: i32,
}

impl Scale {
    /// The prefixes in which values are written, with their exponents, in ascending order.
    fn prefixes(&self) -> impl DoubleEndedIterator<Item = (&'static str, i32)> {
        let written = self.smallest..=self.largest;
        PREFIXES.into_iter().filter(move |(_, exponent)| written.contains(exponent) && exponent % 3 == 0)
    }
}

#[derive(Clone, Copy)]
enum Base {
    Of(&'static str),
    Squared,
    Cubed,
    CubedPerSecond,
    PerSecond,
}

impl Base {
    fn symbol(self) -> &'static str {
        if let Self::Of(symbol) = self { symbol } else { "m" }
    }

    fn suffix(self) -> &'static str {
        match self {
            Self::Of(_) => "",
            Self::Squared => "²",
            Self::Cubed => "³",
            Self::CubedPerSecond => "³/s",
            Self::PerSecond => "/s",
        }
    }
}

/// How the square of a unit ends.
pub(super) const SQUARED: [&str; 3] = ["²", "^2", "2"];

/// Ascending. The centi- prefix is for metres only, and is read but never written.
const PREFIXES: [(&str, i32); 12] = [
    ("a", -18),
    ("f", -15),
    ("p", -12),
    ("n", -9),
    ("µ", -6),
    ("m", -3),
    ("c", -2),
    ("", 0),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
];

fn find_unit(text: &str, unit: &str, expected: Dimension) -> Result<(i32, f64), UnitError> {
    // Products have a blank, an asterisk or a dot.
    let spaced = unit.replace(['*', '·', '⋅'], " ");
    if let Some(found) = expected.unit(&spaced) {
        return Ok(found);
    }
    if let Some(found) = Dimension::ALL.into_iter().find(|dimension| dimension.unit(&spaced).is_some()) {
        return Err(UnitError::WrongDimension { text: text.to_owned(), found, expected });
    }
    let number = text.trim().strip_suffix(unit).and_then(|number| number.trim().parse().ok());
    Err(UnitError::Unknown {
        unit: unit.to_owned(),
        number: number.unwrap_or(1.0),
        expected,
        suggestion: suggest(unit, expected),
    })
}

/// Suggests a unit that differs by one slip: another case, or one letter added, missing, wrong or swapped.
fn suggest(unit: &str, expected: Dimension) -> Option<String> {
    let scale = expected.scale();
    let base = scale.base;
    let mut candidates: Vec<_> = scale
        .prefixes()
        .filter(|(prefix, _)| prefix.is_empty() || expected.takes_prefixes())
        .map(|(prefix, _)| format!("{prefix}{}{}", base.symbol(), base.suffix()))
        .collect();
    if expected == Dimension::Pressure {
        candidates.reverse(); // `mpa` is a megapascal
    }
    candidates.extend(expected.special().iter().map(|(name, ..)| (*name).to_owned()));
    let other_case = candidates.iter().find(|name| name.to_lowercase() == unit.to_lowercase());
    let one_slip = || candidates.iter().find(|name| name.len() > 1 && strsim::osa_distance(name, unit) == 1);
    other_case.or_else(one_slip).cloned()
}

struct Number<'a> {
    mantissa: &'a str,
    exponent: i32,
    rest: &'a str,
}

/// Splits a number from its unit: `-2.5e3 GPa` is −2.5, 3 and ` GPa`. An `e` without digits after it belongs
/// to the unit.
fn split_number(text: &str) -> Option<Number<'_>> {
    let digits = |from: usize| text[from..].bytes().take_while(u8::is_ascii_digit).count();
    let sign = usize::from(text.starts_with(['+', '-']));
    let whole = digits(sign);
    let mut end = sign + whole;
    let mut fraction = 0;
    if text[end..].starts_with('.') {
        fraction = digits(end + 1);
        end += 1 + fraction;
    }
    if whole + fraction == 0 {
        return None;
    }
    let mantissa = &text[..end];
    let mut exponent = 0;
    if text[end..].starts_with(['e', 'E']) {
        let sign = usize::from(text[end + 1..].starts_with(['+', '-']));
        let length = digits(end + 1 + sign);
        if length > 0 {
            let stop = end + 1 + sign + length;
            let negative = text[end + 1..].starts_with('-');
            let limit = if negative { -100_000 } else { 100_000 };
            exponent = text[end + 1..stop].parse().unwrap_or(limit);
            end = stop;
        }
    }
    Some(Number { mantissa, exponent, rest: &text[end..] })
}

fn round(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.max(1) - 1).parse().unwrap_or(value)
}

/// Numbers from here on are written with a power of ten, because no prefix is large enough.
const MAX_FIXED: f64 = 1e12;

/// Writes in fixed notation, or with a power of ten if fixed notation would have too many digits.
fn legible(value: f64, digits: usize) -> String {
    let size = value.abs();
    let is_fixed = size == 0.0 || !size.is_finite() || (1.0 / MAX_FIXED..MAX_FIXED).contains(&size);
    if is_fixed { decimal(value, digits) } else { format!("{:e}", round(value, digits)) }
}

/// Writes in fixed notation with at most `digits` significant digits and no trailing zeros.
fn decimal(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let magnitude = round(value, digits).abs().log10().floor();
    let decimals = (digits as f64 - 1.0 - magnitude).clamp(0.0, 300.0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::Dimension::{
        Angle, Area, Conductivity, Density, Energy, Force, HeatCapacity, Length, Pressure, RemovalRate,
        Speed, Temperature, Time, Volume, VolumePerWork,
    };
    use super::*;

    #[test]
    fn a_unit_is_a_name_or_a_quantity() {
        for (text, size) in [("nm", 1e-9), (" µm", 1e-6), ("Å", 1e-10), ("0.5 um", 5e-7), ("1nm", 1e-9)] {
            assert_eq!(parse_unit(text, Dimension::Length), Ok(size), "{text}");
        }
        assert!(["inf", "GPa", "", "nmm"].iter().all(|text| parse_unit(text, Dimension::Length).is_err()));
    }

    #[test]
    fn no_magnitude_takes_more_than_some_digits() {
        assert_eq!(format(1e300, Length), "1e300 m");
        assert_eq!(format(-1e300, Area), "-1e300 m²");
        for dimension in Dimension::ALL {
            for exponent in -320..=308 {
                let value = 1.2345678 * 10f64.powi(exponent);
                let text = format(value, dimension);
                assert!(text.chars().count() < 32, "{dimension:?}: {text}");
                assert!(format_number(value).len() < 12, "{}", format_number(value));
            }
        }
        assert_eq!(format(1.2e9, Length), "1200000 km");
    }

    #[test]
    fn as_many_digits_are_written_as_it_takes() {
        let written = |value| format_within(value, Length, 1e-9);
        assert_eq!(written(0.5e-6), "500 nm");
        assert_eq!(written(0.81234e-6), "812.34 nm");
        assert_eq!(written(0.123456789123e-6), "123.456789 nm");
        assert_eq!(written(1e-6 / 6.0), "166.6666667 nm");
        assert_eq!(written(0.0), "0 m");
        arbtest::arbtest(|u| {
            let value = f64::from(u.int_in_range(1..=i32::MAX)?) * 10f64.powi(u.int_in_range(-20..=-3)?);
            let error = parse(&written(value), Length).unwrap() / value - 1.0;
            assert!(error.abs() <= 1e-9, "{value:e}: {}", written(value));
            Ok(())
        });
    }

    #[test]
    fn a_quantity_is_the_double_nearest_to_what_is_written() {
        for (text, dimension, value) in [
            ("210 GPa", Pressure, 210e9),
            ("0.25 um", Length, 0.25e-6),
            ("0.1 µm", Length, 1e-7),
            ("0.3 \u{3bc}m", Length, 0.3e-6),
            ("2 N", Force, 2.0),
            ("10 mm/s", Speed, 0.01),
            ("6 m/min", Speed, 0.1),
            ("1.5e3nm", Length, 1.5e-6),
            ("3 cm", Length, 0.03),
            ("3.e-1 m", Length, 0.3),
            (".5 m", Length, 0.5),
            ("-4 nm", Length, -4e-9),
            ("2e9", Pressure, 2e9),
            ("inf", Pressure, f64::INFINITY),
            ("240 N/mm²", Pressure, 240e6),
            ("5 N/cm2", Pressure, 5e4),
            ("1.2 kN/mm^2", Pressure, 1.2e9),
            ("3 N/m2", Pressure, 3.0),
            ("40 mbar", Pressure, 4e3),
            ("1013 hPa", Pressure, 101_300.0),
            ("50 mN/m", Dimension::SurfaceEnergy, 0.05),
            ("3.8 Å3", Volume, 3.8e-30),
            ("57.5 um", Length, 5.75e-5),
            ("180 deg", Angle, std::f64::consts::PI),
            ("20 mrad", Angle, 0.02),
            ("2 min", Time, 120.0),
            ("0.55 h", Time, 1980.0),
            ("-.1 h", Time, -360.0),
            ("7 m/min", Speed, 7.0 / 60.0),
            ("0.07 ml/min", Dimension::VolumeFlow, 7e-8 / 60.0),
            ("4 um2", Area, 4e-12),
            ("8 µm³", Volume, 8e-18),
            ("3 nJ", Energy, 3e-9),
            ("0.8 eV", Energy, 0.8 * 1.602176634e-19),
            ("3.8e-3 nm3", Volume, 3.8e-30),
            ("1e-7 mm3/(N m)", VolumePerWork, 1e-16),
            ("1e-6 mm3/J", VolumePerWork, 1e-15),
            ("1e-11 1/(Pa m)", RemovalRate, 1e-11),
            ("100 °C", Temperature, 373.15),
            ("300 K", Temperature, 300.0),
            ("46 W/(m K)", Conductivity, 46.0),
            ("1e-8 m2 K/W", Dimension::ThermalInsulance, 1e-8),
            ("59 MS/m", Dimension::ElectricalConductivity, 59e6),
            ("1.7e-8 ohm m", Dimension::Resistivity, 1.7e-8),
            ("1.7 uohm cm", Dimension::Resistivity, 1.7e-8),
            ("1e-12 Ω m²", Dimension::ElectricalInsulance, 1e-12),
            ("1e-8 ohm cm2", Dimension::ElectricalInsulance, 1e-12),
            ("18 uPa*s", Dimension::Viscosity, 18e-6),
            ("46 W/(m*K)", Dimension::Conductivity, 46.0),
            ("46 W/(m·K)", Dimension::Conductivity, 46.0),
            ("1e-7 mm3/(N*m)", Dimension::VolumePerWork, 1e-16),
            ("0.46 J/(g K)", HeatCapacity, 460.0),
            ("7850 kg/m3", Density, 7850.0),
            ("7.85 g/cm3", Density, 7850.0),
        ] {
            assert_eq!(parse(text, dimension), Ok(value), "{text}");
        }
    }

    #[test]
    fn what_is_no_quantity_says_what_was_expected() {
        for (text, dimension, message) in [
            ("2.4 GPb", Pressure, "unknown unit 'GPb' in 'key', expected a pressure such as \"2.4 GPa\""),
            ("2 mm", Pressure, "'2 mm' in 'key' is a length, expected a pressure such as \"2.4 GPa\""),
            (
                "steel",
                Pressure,
                "'steel' in 'key' is not a quantity, expected a pressure such as \"2.4 GPa\"",
            ),
            ("", Length, "'' in 'key' is not a quantity, expected a length such as \"0.25 um\""),
            ("2,4 um", Length, "'2,4 um' in 'key' is not a quantity, expected a length such as \"0.25 um\""),
            (
                "1 000 um",
                Length,
                "'1 000 um' in 'key' is not a quantity, expected a length such as \"0.25 um\"",
            ),
            ("inf", Force, "'inf' in 'key' is not finite, expected a force such as \"2 N\""),
            ("nan", Pressure, "'nan' in 'key' is not finite, expected a pressure such as \"2.4 GPa\""),
            ("1e999 N", Force, "'1e999 N' in 'key' is not finite, expected a force such as \"2 N\""),
            (
                "1e99999999999 N",
                Force,
                "'1e99999999999 N' in 'key' is not finite, expected a force such as \"2 N\"",
            ),
        ] {
            assert_eq!(parse(text, dimension).unwrap_err().for_key("key"), message);
        }
    }

    #[test]
    fn a_slip_in_a_unit_is_named() {
        let hint = |text, dimension| parse(text, dimension).unwrap_err().hint();
        assert_eq!(hint("2.4 GPb", Pressure).as_deref(), Some("did you mean `GPa`?"));
        assert_eq!(hint("2.4 mpa", Pressure).as_deref(), Some("did you mean `MPa`?"));
        assert_eq!(hint("2.4 MM", Length).as_deref(), Some("did you mean `mm`?"));
        assert_eq!(hint("2,4 GPa", Pressure).as_deref(), Some("the decimal mark is a point, as in `2.4`"));
        assert_eq!(hint("3 parsec", Length), None);
    }

    #[test]
    fn a_value_is_written_with_the_prefix_that_suits_it() {
        for (value, dimension, text) in [
            (2.4e9, Pressure, "2.4 GPa"),
            (210e9, Pressure, "210 GPa"),
            (0.25e-6, Length, "250 nm"),
            (0.05e-6, Length, "50 nm"),
            (1.234567e-3, Length, "1.235 mm"),
            (-3e-6, Length, "-3 µm"),
            (12.3e-3, Force, "12.3 mN"),
            (999.96, Pressure, "1 kPa"),
            (0.0, Force, "0 N"),
            (f64::INFINITY, Pressure, "inf"),
            (0.5e-12, Area, "0.5 µm²"),
            (2e-8, Area, "0.02 mm²"),
            (7.5e-18, Volume, "7.5 µm³"),
            (3.21e-9, Energy, "3.21 nJ"),
            (32e-18, Energy, "32 aJ"),
            (4.849e-19, Energy, "0.4849 aJ"),
            (0.01, Speed, "10 mm/s"),
            (0.5, Angle, "28.65°"),
            (7200.0, Time, "7200 s"),
            (1e-20, Length, "1e-20 m"),
        ] {
            assert_eq!(format(value, dimension), text);
        }
        assert_eq!(format_digits(0.123_456_7e-6, Length, 6), "123.457 nm");
    }

    #[test]
    fn what_is_written_reads_back() {
        arbtest::arbtest(|u| {
            let value = f64::from(u.int_in_range(1..=999_999)?) * 10f64.powi(u.int_in_range(-18..=9)?);
            let dimension = *u.choose(&Dimension::ALL)?;
            let back = parse(&format(value, dimension), dimension).unwrap();
            assert!((back / value - 1.0).abs() <= 0.5e-3 + 1e-12, "{value:e} {dimension:?} {back:e}");
            Ok(())
        });
    }

    #[test]
    fn any_text_is_read_without_panic() {
        arbtest::arbtest(|u| {
            let text: String = u.arbitrary()?;
            let dimension = *u.choose(&Dimension::ALL)?;
            let _ = parse(&text, dimension);
            Ok(())
        });
    }

    #[test]
    fn a_multiple_is_that_of_the_value_as_it_is_written() {
        for (value, dimension) in
            [(3e-6, Length), (1.2e9, Pressure), (3.1e-18, Volume), (0.18, Force), (0.5, Time)]
        {
            let Multiple { factor, symbol } = dimension.multiple(value);
            let written = format(value, dimension);
            let (number, unit) = written.split_once(' ').unwrap();
            assert_eq!(unit, symbol);
            assert!((number.parse::<f64>().unwrap() * factor / value - 1.0).abs() < 1e-3, "{written}");
        }
        assert_eq!(Length.multiple(0.0).symbol, "m");
        let flow = Dimension::VolumeFlow.multiple(5.932e-12);
        assert_eq!(
            [5.932e-12, 9.178e-13].map(|value| flow.write(value)),
            ["0.005932 mm³/s", "0.0009178 mm³/s"]
        );
        assert_eq!(Angle.multiple(1.0).symbol, "°");
    }

    #[test]
    fn values_that_differ_are_written_with_the_digits_that_show_it() {
        assert_eq!(format_distinct([5.78, 20.0], Force), ["5.78 N", "20 N"]);
        assert_eq!(format_distinct([5.780_001, 5.78], Force), ["5.780001 N", "5.78 N"]);
        assert_eq!(format_distinct([1e-6, 1e-6], Length), ["1 µm", "1 µm"]);
    }

    #[test]
    fn numbers_have_four_digits() {
        for (value, text) in [(0.7, "0.7"), (-1.0 / 3.0, "-0.3333"), (1.23456e-9, "1.235e-9"), (0.0, "0")] {
            assert_eq!(format_number(value), text);
        }
        assert_eq!(format_number(f64::NAN), "NaN");
        assert_eq!(format_number(1e300), "1e300");
    }
}

//! A parameter as a row of a table, and the families that the rows come from.

use crate::units::{self, Dimension};

/// A roughness parameter with what is needed to print it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Symbol of the standard, `Sq`.
    pub symbol: &'static str,
    /// Value, SI; NaN where it has no meaning.
    pub value: f64,
    /// What it is measured in.
    pub unit: Unit,
    /// The family of the standard that it belongs to, `height`.
    pub family: &'static str,
    /// What it is, in a few words.
    pub meaning: &'static str,
}

/// What a roughness parameter is measured in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// A pure number.
    Number,
    /// A part of one; printed in per cent.
    Share,
    /// Metres.
    Length,
    /// Cubic metres per square metre.
    VolumePerArea,
    /// Square metres.
    Area,
    /// Cubic metres.
    Volume,
    /// Per metre.
    PerLength,
    /// Per square metre.
    PerArea,
    /// Radians; printed in degrees.
    Angle,
}

impl Unit {
    /// The SI unit of the values.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Number | Self::Share => "1",
            Self::Length => "m",
            Self::VolumePerArea => "m³/m²",
            Self::Area => "m²",
            Self::Volume => "m³",
            Self::PerLength => "1/m",
            Self::PerArea => "1/m²",
            Self::Angle => "rad",
        }
    }

    /// Writes a value with four digits, or four decimals, and a unit that suits it: `0.2 µm`, `9.3100 %`; `–` for NaN.
    pub fn format(self, value: f64) -> String {
        let length = || units::format(value, Dimension::Length);
        match self {
            _ if value.is_nan() => "–".to_owned(),
            Self::Number => four_digits(value),
            Self::Share => format!("{} %", four_digits(100.0 * value)),
            Self::Length => length(),
            Self::VolumePerArea => match length().split_once(' ') {
                Some((number, unit)) => format!("{number} {unit}³/{unit}²"),
                None => length(),
            },
            Self::Area => units::format(value, Dimension::Area),
            Self::Volume => units::format(value, Dimension::Volume),
            Self::PerLength => format!("{} /mm", four_digits(1e-3 * value)),
            Self::PerArea => format!("{} /mm²", four_digits(1e-6 * value)),
            Self::Angle => format!("{:.1}°", value.to_degrees()),
        }
    }
}

/// The number with four significant digits, all before the point at the least.
fn four_digits(value: f64) -> String {
    let exponent = if value == 0.0 { 3.0 } else { value.abs().log10().floor() };
    format!("{value:.*}", (3.0 - exponent).clamp(0.0, 12.0) as usize)
}

/// A family of parameters from a list of `field: Unit as "Symbol"`, each below its doc comment: a struct of public
/// `f64`, serialised under the symbols, and its [`Parameter`] rows, whose meaning is the comment's first line.
macro_rules! family {
    (
        $(#[$about:meta])*
        $name:ident: $family:literal {
            $(#[doc = $meaning:literal] $(#[doc = $more:literal])* $field:ident: $unit:ident as $symbol:literal,)*
        }
    ) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
        pub struct $name {
            $(
                #[doc = $meaning]
                $(#[doc = $more])*
                #[serde(rename = $symbol)]
                pub $field: f64,
            )*
        }

        impl $name {
            /// The parameters in their order, with symbols, units and meanings.
            pub fn rows(&self) -> Vec<$crate::surface::Parameter> {
                vec![$(
                    $crate::surface::Parameter {
                        symbol: $symbol,
                        value: self.$field,
                        unit: $crate::surface::Unit::$unit,
                        family: $family,
                        meaning: $meaning.trim().trim_end_matches('.'),
                    },
                )*]
            }

            /// Without meaning: all NaN.
            pub fn undefined() -> Self {
                Self::from_each(|_| f64::NAN)
            }

            /// Each parameter from its place in the family.
            pub(crate) fn from_each(value: impl Fn(fn(&Self) -> f64) -> f64) -> Self {
                Self { $($field: value(|family| family.$field),)* }
            }
        }
    };
}

pub(crate) use family;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_written_in_the_unit_of_its_kind() {
        for (unit, value, text) in [
            (Unit::Number, 0.123_46, "0.1235"),
            (Unit::Share, 0.0931, "9.310 %"),
            (Unit::Length, 2e-7, "0.2 µm"),
            (Unit::VolumePerArea, 3e-8, "30 nm³/nm²"),
            (Unit::PerLength, 12_500.0, "12.50 /mm"),
            (Unit::Angle, std::f64::consts::FRAC_PI_4, "45.0°"),
            (Unit::Length, f64::NAN, "–"),
        ] {
            assert_eq!(unit.format(value), text);
        }
    }
}

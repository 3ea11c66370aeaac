//! A parameter as a row of a table, and the macro for families of such rows.

use asperity_base::units::{Dimension, Multiple, format_number};

/// A roughness parameter with the data needed to print it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Symbol of the standard, `Sq`.
    pub symbol: &'static str,
    /// Value, SI; NaN if undefined.
    pub value: f64,
    /// Unit of the value.
    pub unit: Unit,
    /// Family of the standard, `height`.
    pub family: &'static str,
    /// Meaning, in a few words.
    pub meaning: &'static str,
}

/// Unit of a roughness parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// A pure number.
    Number,
    /// A fraction of one, printed in per cent.
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
    /// SI unit of the values.
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

    /// Returns the multiple for a column of `values`, SI: the one that suits the value a third of the way up
    /// from the smallest.
    pub fn multiple(self, values: impl IntoIterator<Item = f64>) -> Multiple {
        let sizes = values.into_iter().map(f64::abs).filter(|size| size.is_finite() && *size > 0.0);
        let mut sizes: Vec<f64> = sizes.collect();
        sizes.sort_unstable_by(f64::total_cmp);
        let typical = sizes.get(sizes.len() / 3).copied().unwrap_or(0.0);
        let of = |factor: f64, symbol: &str| Multiple { factor, symbol: symbol.to_owned() };
        match self {
            Self::Number => of(1.0, ""),
            Self::Share => of(0.01, "%"),
            Self::Length => Dimension::Length.multiple(typical),
            // As ISO 25178 and instruments have it, which is ml/m².
            Self::VolumePerArea => of(1e-6, "µm³/µm²"),
            Self::Area => Dimension::Area.multiple(typical),
            Self::Volume => Dimension::Volume.multiple(typical),
            Self::PerLength => of(1e3, "/mm"),
            Self::PerArea => of(1e6, "/mm²"),
            Self::Angle => Dimension::Angle.multiple(typical),
        }
    }

    /// Writes a value with four digits and a suitable unit: `0.2 µm`, `9.31 %`; `–` for NaN.
    pub fn format(self, value: f64) -> String {
        let Multiple { factor, symbol } = self.multiple([value]);
        let number = format_number(value / factor);
        match self {
            _ if value.is_nan() => "–".to_owned(),
            Self::Number => number,
            Self::Angle => number + &symbol,
            _ => format!("{number} {symbol}"),
        }
    }
}

/// Defines a family of parameters from a list of `field: Unit as "Symbol"`, each below its doc comment: a
/// struct of public `f64`, serialised under the symbols, and its [`Parameter`] rows, whose meaning is the
/// first line of the comment.
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
            /// Returns the parameters in order, with symbols, units and meanings.
            pub fn rows(&self) -> Vec<$crate::Parameter> {
                vec![$(
                    $crate::Parameter {
                        symbol: $symbol,
                        value: self.$field,
                        unit: $crate::Unit::$unit,
                        family: $family,
                        meaning: $meaning.trim().trim_end_matches('.'),
                    },
                )*]
            }

            /// Returns undefined parameters: all NaN.
            pub fn undefined() -> Self {
                Self::from_each(|_| f64::NAN)
            }

            /// Creates the parameters, each from its getter.
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
            (Unit::Share, 0.0931, "9.31 %"),
            (Unit::Length, 2e-7, "200 nm"),
            (Unit::VolumePerArea, 3e-8, "0.03 µm³/µm²"),
            (Unit::PerLength, 12_500.0, "12.5 /mm"),
            (Unit::Angle, std::f64::consts::FRAC_PI_4, "45°"),
            (Unit::Length, f64::NAN, "–"),
        ] {
            assert_eq!(unit.format(value), text);
        }
    }

    #[test]
    fn values_side_by_side_have_the_unit_of_the_smaller() {
        let multiple = |unit: Unit, values: &[f64]| unit.multiple(values.iter().copied()).symbol;
        assert_eq!(multiple(Unit::Length, &[f64::NAN, -1.2e-6, 3e-9, 8e-9, 0.0]), "nm");
        assert_eq!(multiple(Unit::VolumePerArea, &[3e-9, 4e-9]), "µm³/µm²");
        assert_eq!(multiple(Unit::Length, &[0.0]), "m");
    }
}

//! Hints for quantities that are not read: units that are not, with their sizes, and what they are in a unit
//! that is.

use super::quantity::{Dimension, SQUARED, UnitError, format_digits};

/// Weight of a kilogram under standard gravity, N.
const KILOGRAM: f64 = 9.806_65;
/// Weight of a pound under standard gravity, N.
const POUND: f64 = 0.453_592_37 * KILOGRAM;
/// Length of an inch, m.
const INCH: f64 = 0.0254;
/// Pressure of an atmosphere, Pa.
const ATMOSPHERE: f64 = 101_325.0;
/// Molecules of a mole.
const MOLE: f64 = 6.022_140_76e23;

/// Units of mass, with their weights.
const MASSES: [(&str, f64); 11] = [
    ("ug", 1e-9 * KILOGRAM),
    ("µg", 1e-9 * KILOGRAM),
    ("mg", 1e-6 * KILOGRAM),
    ("g", 1e-3 * KILOGRAM),
    ("kg", KILOGRAM),
    ("t", 1e3 * KILOGRAM),
    ("ton", 1e3 * KILOGRAM),
    ("tons", 1e3 * KILOGRAM),
    ("lb", POUND),
    ("lbs", POUND),
    ("oz", POUND / 16.0),
];

/// Returns the units of a dimension that are not read. The hardness numbers of Vickers, Brinell and Knoop are
/// in kgf/mm².
fn units(dimension: Dimension) -> &'static [(&'static str, f64)] {
    match dimension {
        Dimension::Force => &[
            ("gf", 1e-3 * KILOGRAM),
            ("kgf", KILOGRAM),
            ("kp", KILOGRAM),
            ("tf", 1e3 * KILOGRAM),
            ("ozf", POUND / 16.0),
            ("lbf", POUND),
            ("kip", 1e3 * POUND),
            ("dyn", 1e-5),
        ],
        Dimension::Length => &[
            ("in", INCH),
            ("inch", INCH),
            ("ft", 12.0 * INCH),
            ("mil", 1e-3 * INCH),
            ("thou", 1e-3 * INCH),
            ("uin", 1e-6 * INCH),
            ("µin", 1e-6 * INCH),
            ("micron", 1e-6),
            ("microns", 1e-6),
            ("angstrom", 1e-10),
        ],
        Dimension::Pressure => &[
            ("psi", POUND / (INCH * INCH)),
            ("ksi", 1e3 * POUND / (INCH * INCH)),
            ("Msi", 1e6 * POUND / (INCH * INCH)),
            ("atm", ATMOSPHERE),
            ("at", 1e4 * KILOGRAM),
            ("torr", ATMOSPHERE / 760.0),
            ("Torr", ATMOSPHERE / 760.0),
            ("mmHg", ATMOSPHERE / 760.0),
            ("HV", 1e6 * KILOGRAM),
            ("HB", 1e6 * KILOGRAM),
            ("HBW", 1e6 * KILOGRAM),
            ("HK", 1e6 * KILOGRAM),
        ],
        Dimension::Energy => {
            &[("J/mol", 1.0 / MOLE), ("kJ/mol", 1e3 / MOLE), ("kcal/mol", 4184.0 / MOLE), ("cal", 4.184)]
        }
        _ => &[],
    }
}

/// Returns the size of a unit of `table`.
fn size(table: &[(&str, f64)], unit: &str) -> Option<f64> {
    table.iter().find(|(name, _)| *name == unit).map(|(_, size)| *size)
}

/// Size of a unit of the dimension, read or not, and whether it is one of mass.
fn any(unit: &str, dimension: Dimension) -> Option<(f64, bool)> {
    let read = || dimension.unit(unit).map(|(exponent, factor)| factor * 10f64.powi(exponent));
    let of_dimension = size(units(dimension), unit).or_else(read).map(|size| (size, false));
    let weight = || size(&MASSES, unit).filter(|_| dimension == Dimension::Force).map(|size| (size, true));
    of_dimension.or_else(weight).or_else(|| match dimension {
        Dimension::Pressure => {
            let (force, area) = unit.split_once('/')?;
            let length = SQUARED.iter().find_map(|end| area.strip_suffix(end))?;
            let ((force, is_weight), (length, _)) =
                (any(force.trim(), Dimension::Force)?, any(length.trim(), Dimension::Length)?);
            Some((force / (length * length), is_weight))
        }
        _ => None,
    })
}

impl UnitError {
    /// Returns the quantity that was probably meant, to be shown below the message.
    pub fn hint(&self) -> Option<String> {
        match self {
            Self::Unknown { unit, number, expected, suggestion } => {
                let unit = unit.replace(['*', '·', '⋅'], " ");
                let suggested = || suggestion.as_ref().map(|unit| format!("did you mean `{unit}`?"));
                equal(*number, &unit, *expected).or_else(suggested)
            }
            Self::NotAQuantity { text, .. } if text.contains(',') => {
                Some("the decimal mark is a point, as in `2.4`".to_owned())
            }
            _ => None,
        }
    }
}

/// Returns what `number` of a unit that is not read is in a unit that is.
fn equal(number: f64, unit: &str, dimension: Dimension) -> Option<String> {
    let (size, is_weight) = any(unit, dimension)?;
    let equal = format_digits(number * size, dimension, 6);
    Some(match (is_weight, dimension) {
        (true, Dimension::Force) => {
            format!("a mass is no force: the weight of {number} {unit} is `\"{equal}\"`")
        }
        (true, _) => format!("a mass is no force: the weight makes {number} {unit} `\"{equal}\"`"),
        _ => format!("{number} {unit} is `\"{equal}\"`"),
    })
}

#[cfg(test)]
mod tests {
    use super::Dimension::{Energy, Force, Length, Pressure};
    use super::UnitError;
    use crate::units::parse;

    #[test]
    fn a_quantity_in_a_unit_that_is_not_read_is_given_in_one_that_is() {
        for (text, dimension, hint) in [
            ("1 kg", Force, "a mass is no force: the weight of 1 kg is `\"9.80665 N\"`"),
            ("2e3 g", Force, "a mass is no force: the weight of 2000 g is `\"19.6133 N\"`"),
            ("3 tons", Force, "a mass is no force: the weight of 3 tons is `\"29.4199 kN\"`"),
            ("-1 lb", Force, "a mass is no force: the weight of -1 lb is `\"-4.44822 N\"`"),
            ("1 kgf", Force, "1 kgf is `\"9.80665 N\"`"),
            ("50 gf", Force, "50 gf is `\"490.333 mN\"`"),
            ("2 lbf", Force, "2 lbf is `\"8.89644 N\"`"),
            ("30 psi", Pressure, "30 psi is `\"206.843 kPa\"`"),
            ("100 ksi", Pressure, "100 ksi is `\"689.476 MPa\"`"),
            ("1 kg/cm2", Pressure, "a mass is no force: the weight makes 1 kg/cm2 `\"98.0665 kPa\"`"),
            ("1 kgf/mm²", Pressure, "1 kgf/mm² is `\"9.80665 MPa\"`"),
            ("1 lbf/in^2", Pressure, "1 lbf/in^2 is `\"6.89476 kPa\"`"),
            ("1 N/in2", Pressure, "1 N/in2 is `\"1.55 kPa\"`"),
            ("700 HV", Pressure, "700 HV is `\"6.86466 GPa\"`"),
            ("2 inch", Length, "2 inch is `\"50.8 mm\"`"),
            ("5 microns", Length, "5 microns is `\"5 µm\"`"),
            ("80 kJ/mol", Energy, "80 kJ/mol is `\"0.132843 aJ\"`"),
        ] {
            let error = parse(text, dimension).unwrap_err();
            assert!(matches!(error, UnitError::Unknown { .. }), "{text}: {error}");
            assert_eq!(error.hint().as_deref(), Some(hint), "{text}");
            let given = hint.rsplit('`').nth(1).unwrap().trim_matches('"');
            assert!(parse(given, dimension).is_ok(), "{given}");
        }
    }
}

//! Format of numbers in tables, page and figures: four digits, and a common unit for adjacent numbers.

use asperity_base::units::{Dimension, Multiple};
use asperity_surface::Parameter;

/// Writes a number with four significant digits, including zeros, for columns; `–` for NaN.
pub fn in_column(value: f64) -> String {
    match value.abs() {
        size if size.is_nan() => "–".to_owned(),
        0.0 => "0".to_owned(),
        size if (1e-4..1e7).contains(&size) => format!("{value:.*}", decimals(size)),
        _ => format!("{value:.3e}"),
    }
}

/// Number of decimals of a positive number with four significant digits after rounding.
pub fn decimals(size: f64) -> usize {
    let exponent = format!("{size:.3e}").split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    usize::try_from(3i32 - exponent).unwrap_or(0)
}

/// Writes the quantities `from` and `to`, SI, in a unit for the larger one: `33.80 → 31.25 nm`.
pub fn change([from, to]: [f64; 2], dimension: Dimension) -> String {
    let Multiple { factor, symbol } = dimension.multiple(from.abs().max(to.abs()));
    format!("{} → {} {symbol}", in_column(from / factor), in_column(to / factor))
}

/// The meaning of a surface parameter, or the reason why it is not defined where one of `values` is NaN.
pub fn meaning(of: &Parameter, values: impl IntoIterator<Item = f64>) -> String {
    let reason = match of.symbol {
        "Sal" => "the autocorrelation falls to 0.2 in no direction within half the map",
        "Str" => "in some direction the autocorrelation does not fall to 0.2 within half the map",
        _ => return of.meaning.to_owned(),
    };
    if values.into_iter().any(f64::is_nan) {
        format!("{} (–: {reason})", of.meaning)
    } else {
        of.meaning.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits() {
        for (value, text) in [
            (0.0, "0"),
            (1.0, "1.000"),
            (-14.67, "-14.67"),
            (9.9996, "10.00"),
            (65_795.0, "65795"),
            (0.002_356, "0.002356"),
            (2.758e-6, "2.758e-6"),
            (f64::NAN, "–"),
        ] {
            assert_eq!(in_column(value), text);
        }
    }

    #[test]
    fn a_change_has_one_unit() {
        assert_eq!(change([35e-9, 31.736e-9], Dimension::Length), "35.00 → 31.74 nm");
        assert_eq!(change([9.5e-7, 1.2e-6], Dimension::Length), "0.9500 → 1.200 µm");
    }
}

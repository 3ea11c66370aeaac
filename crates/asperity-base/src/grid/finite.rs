//! Check that all results are finite numbers.

use crate::error::{Error, Result};

/// Values that a field may hold besides finite numbers.
#[derive(Clone, Copy, PartialEq)]
enum NonFinite {
    /// NaN in cells without a value: the contact has no temperature where the surfaces do not touch.
    Missing,
    /// Infinity: in cells that never yield, or that stick under any shear.
    Infinite,
}

/// Fields with such values, by name, without the number of a position or the name of a body.
const FIELDS: [(&str, NonFinite); 4] = [
    ("temperature", NonFinite::Missing),
    ("hardness", NonFinite::Infinite),
    ("cap", NonFinite::Infinite),
    ("shear_limit", NonFinite::Infinite),
];

/// Checks the values of a field of shape `shape`.
///
/// # Errors
/// [`Error::NotFinite`] with the first cell whose value is NaN or infinite, unless the field may hold such a
/// value.
pub fn check_finite<'a>(
    field: &str,
    shape: &[usize],
    values: impl IntoIterator<Item = &'a f64>,
) -> Result<()> {
    let besides = FIELDS.iter().find(|(name, _)| *name == kind(field)).map(|(_, besides)| *besides);
    let good = |value: f64| match besides {
        None => value.is_finite(),
        Some(NonFinite::Missing) => !value.is_infinite(),
        Some(NonFinite::Infinite) => !value.is_nan(),
    };
    let Some(wrong) = values.into_iter().position(|value| !good(*value)) else { return Ok(()) };
    let mut cell = vec![0; shape.len()];
    let mut rest = wrong;
    for (index, size) in cell.iter_mut().zip(shape).rev() {
        (*index, rest) = (rest % size, rest / size);
    }
    Err(Error::NotFinite { field: field.to_owned(), cell })
}

/// Returns the name of a field without the number of a position or the name of a body.
fn kind(field: &str) -> &str {
    let Some((kind, end)) = field.rsplit_once('_') else { return field };
    let of_one = ["lower", "upper"].contains(&end) || end.bytes().all(|byte| byte.is_ascii_digit());
    if of_one { kind } else { field }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_that_is_no_number_is_found_in_its_cell() {
        let with = |value: f64| [1.0, -0.0, 1e300, 0.0, value, 2.0];
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let error = check_finite("film_lower", &[2, 3], &with(value)).unwrap_err();
            assert_eq!(error.to_string(), "`film_lower` is not a finite number in cell [1, 1]");
        }
        check_finite("film_lower", &[2, 3], &with(-1e-300)).unwrap();
    }

    #[test]
    fn only_the_values_that_mean_something_are_let_through() {
        for (field, missing, infinite) in [
            ("temperature", true, false),
            ("temperature_00044", true, false),
            ("flash_temperature_lower", false, false),
            ("hardness_upper", false, true),
            ("cap_00001", false, true),
            ("cap", false, true),
            ("cap_of_mine", false, false),
            ("lower", false, false),
        ] {
            assert_eq!(check_finite(field, &[1], &[f64::NAN]).is_ok(), missing, "{field}");
            assert_eq!(check_finite(field, &[1], &[f64::INFINITY]).is_ok(), infinite, "{field}");
        }
    }
}

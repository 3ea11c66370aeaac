//! Numbers that may be infinite, in formats without infinities.

use serde::Serializer;

/// Serialises a number, with infinity as the word `inf`, as in a case file.
///
/// # Errors
/// The errors of the serialiser.
pub fn or_inf<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    match value.is_finite() {
        true => serializer.serialize_f64(*value),
        false => serializer.serialize_str("inf"),
    }
}

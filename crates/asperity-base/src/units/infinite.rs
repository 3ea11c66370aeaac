//! Numbers that may be infinite, in formats without infinities.

use serde::{Serialize, Serializer};

/// Serialises a number, with infinity as the word `inf`, as in a case file.
///
/// # Errors
/// The errors of the serialiser.
pub fn or_inf<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    OrInf(*value).serialize(serializer)
}

/// Serialises two numbers as [`or_inf`] does.
///
/// # Errors
/// The errors of the serialiser.
pub fn or_infs<S: Serializer>(values: &[f64; 2], serializer: S) -> Result<S::Ok, S::Error> {
    values.map(OrInf).serialize(serializer)
}

/// Serialises a number as [`or_inf`] does, if it is known.
///
/// # Errors
/// The errors of the serialiser.
pub fn known_or_inf<S: Serializer>(value: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    value.map(OrInf).serialize(serializer)
}

struct OrInf(f64);

impl Serialize for OrInf {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.0.is_finite() { serializer.serialize_f64(self.0) } else { serializer.serialize_str("inf") }
    }
}

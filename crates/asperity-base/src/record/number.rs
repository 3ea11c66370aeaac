//! Numbers that may be unknown: NaN in a record, an empty cell in a table, `null` in JSON.

use std::fmt;

use serde::de::{Error, Unexpected, Visitor};
use serde::{Deserialize, Deserializer};

/// Reads a number that may be unknown; an unknown number is NaN.
pub fn number_or_none<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(OptionalNumber::deserialize(deserializer)?.0.unwrap_or(f64::NAN))
}

/// Reads a number that may be unknown.
pub fn known_or_none<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    Ok(OptionalNumber::deserialize(deserializer)?.0)
}

/// A number of a table or of JSON; none for an empty cell or `null`.
pub struct OptionalNumber(pub Option<f64>);

impl<'de> Deserialize<'de> for OptionalNumber {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Number;

        impl Visitor<'_> for Number {
            type Value = OptionalNumber;

            fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
                formatter.write_str("a number, or nothing")
            }

            fn visit_f64<E>(self, value: f64) -> Result<OptionalNumber, E> {
                Ok(OptionalNumber(Some(value)))
            }

            fn visit_u64<E>(self, value: u64) -> Result<OptionalNumber, E> {
                Ok(OptionalNumber(Some(value as f64)))
            }

            fn visit_i64<E>(self, value: i64) -> Result<OptionalNumber, E> {
                Ok(OptionalNumber(Some(value as f64)))
            }

            fn visit_str<E: Error>(self, value: &str) -> Result<OptionalNumber, E> {
                match value {
                    "" => Ok(OptionalNumber(None)),
                    text => Err(E::invalid_value(Unexpected::Str(text), &self)),
                }
            }

            fn visit_unit<E>(self) -> Result<OptionalNumber, E> {
                Ok(OptionalNumber(None))
            }

            fn visit_none<E>(self) -> Result<OptionalNumber, E> {
                Ok(OptionalNumber(None))
            }
        }

        deserializer.deserialize_any(Number)
    }
}

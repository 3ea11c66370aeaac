//! What instruments write in words: units of length, and what a message repeats of them.

use crate::error::Defect;
use crate::units::Metre;

/// A unit of length, as instruments write it.
pub(super) fn unit_of_length(unit: &str) -> Result<Metre, Defect> {
    match unit {
        "m" | "metre" | "metres" | "meter" | "meters" => Ok(1.0),
        "cm" => Ok(1e-2),
        "mm" => Ok(1e-3),
        "µm" | "μm" | "um" | "~m" => Ok(1e-6),
        "nm" => Ok(1e-9),
        "pm" => Ok(1e-12),
        "Å" | "A" => Ok(1e-10),
        "in" => Ok(25.4e-3),
        _ => {
            let found = excerpt(unit);
            Err(Defect::Value { what: "a unit", found, expected: "one of length" })
        }
    }
}

/// The start of what a file says, for a message.
pub(super) fn excerpt(text: &str) -> String {
    text.chars().take(40).collect()
}

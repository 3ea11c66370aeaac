//! Words in files of instruments: units of length, and excerpts for messages.

use asperity_base::error::Defect;
use asperity_base::units::Metre;

/// Returns a unit of length, as written by instruments.
pub(super) fn unit_of_length(unit: &str) -> Result<Metre, Defect> {
    match unit {
        "m" | "metre" | "metres" | "meter" | "meters" => Ok(1.0),
        "cm" => Ok(1e-2),
        "mm" => Ok(1e-3),
        "µm" | "μm" | "um" | "~m" | "micron" | "microns" => Ok(1e-6),
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

/// Returns the start of a text in a file, for a message.
pub(super) fn excerpt(text: &str) -> String {
    text.chars().take(40).collect()
}

//! Words in files of instruments: units of length, and excerpts for messages.

use asperity_base::error::Defect;
use asperity_base::units::Metre;

/// Returns a unit of length, as written by instruments.
pub(super) fn unit_of_length(unit: &str) -> Result<Metre, Defect> {
    match unit {
        "m" => Ok(1.0),
        "cm" => Ok(1e-2),
        "mm" => Ok(1e-3),
        "µm" | "μm" | "um" | "~m" => Ok(1e-6),
        "nm" => Ok(1e-9),
        "pm" => Ok(1e-12),
        "Å" | "A" => Ok(1e-10),
        "in" => Ok(25.4e-3),
        _ => named(unit).ok_or_else(|| {
            let found = excerpt(unit);
            Defect::Value { what: "a unit", found, expected: "one of length" }
        }),
    }
}

/// Returns a unit by its name in full, in any case: `NanoMeters`, `microns`.
fn named(unit: &str) -> Option<Metre> {
    let name = unit.to_lowercase().replace("metre", "meter");
    Some(match name.trim_end_matches('s') {
        "meter" => 1.0,
        "centimeter" => 1e-2,
        "millimeter" => 1e-3,
        "micrometer" | "micron" => 1e-6,
        "nanometer" => 1e-9,
        "picometer" => 1e-12,
        "angstrom" | "ångström" => 1e-10,
        "inch" | "inche" => 25.4e-3,
        "mil" => 25.4e-6,
        "microinch" | "microinche" => 25.4e-9,
        _ => return None,
    })
}

/// Returns the start of a text in a file, for a message.
pub(super) fn excerpt(text: &str) -> String {
    text.chars().take(40).collect()
}

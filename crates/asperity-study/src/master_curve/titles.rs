//! Titles of columns: the quantity, and its unit.

use std::f64::consts::TAU;

use super::cells::Line;
use asperity_base::units::{self, Dimension};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Quantity {
    Frequency,
    Storage,
    Loss,
    /// Magnitude of the complex modulus.
    Complex,
    /// tan δ.
    LossTangent,
    /// δ.
    PhaseAngle,
    Temperature,
    /// A compliance, a viscosity, a logarithm.
    Other,
}

impl Quantity {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Frequency => "frequency",
            Self::Storage => "storage modulus",
            Self::Loss => "loss modulus",
            Self::Complex => "complex modulus",
            Self::LossTangent => "tan δ",
            Self::PhaseAngle => "phase angle",
            Self::Temperature => "temperature",
            Self::Other => "other quantity",
        }
    }

    pub(super) fn is_modulus(self) -> bool {
        matches!(self, Self::Storage | Self::Loss | Self::Complex)
    }
}

/// Deformation of a sample, by a title.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Deformation {
    /// Tension, compression or bending: the modulus is E.
    Tension,
    /// The modulus is G.
    Shear,
}

/// A unit: the factor to SI, or to hertz.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Unit {
    Hertz(f64),
    /// Hertz, or radians a second of an angular frequency.
    PerSecond,
    Pascal(f64),
    Radian(f64),
    Fraction(f64),
}

impl Unit {
    /// Reads a unit; a pressure in any case of its letters.
    pub(super) fn from_text(text: &str) -> Option<Self> {
        let text = text.trim().trim_matches(['(', ')', '[', ']']).trim();
        match text.replace("sec", "s").replace("⁻¹", "-1").replace(['^', '·', '.', '*', ' '], "").as_str()
        {
            "mHz" => return Some(Self::Hertz(1e-3)),
            "Hz" | "hz" | "HZ" => return Some(Self::Hertz(1.0)),
            "kHz" => return Some(Self::Hertz(1e3)),
            "MHz" => return Some(Self::Hertz(1e6)),
            "GHz" => return Some(Self::Hertz(1e9)),
            "rad/s" | "rads-1" => return Some(Self::Hertz(1.0 / TAU)),
            "1/s" | "s-1" | "/s" => return Some(Self::PerSecond),
            "°" | "deg" | "degrees" => return Some(Self::Radian(1f64.to_radians())),
            "%" => return Some(Self::Fraction(0.01)),
            "rad" => return Some(Self::Radian(1.0)),
            "N/m2" | "N/m²" => return Some(Self::Pascal(1.0)),
            "dyn/cm2" | "dyn/cm²" | "dyne/cm2" | "dyne/cm²" => return Some(Self::Pascal(0.1)),
            "psi" => return Some(Self::Pascal(6_894.757_293_168)),
            _ => {}
        }
        if !text.starts_with(char::is_alphabetic) {
            return None;
        }
        let pressure = |text: &str| units::parse(&format!("1 {text}"), Dimension::Pressure).ok();
        let other_case = || {
            let name = ["Pa", "kPa", "MPa", "GPa"].into_iter().find(|name| name.eq_ignore_ascii_case(text));
            name.and_then(pressure)
        };
        pressure(text).or_else(other_case).map(Self::Pascal)
    }
}

/// Title of a column.
pub(super) struct Title {
    pub(super) text: String,
    pub(super) quantity: Option<Quantity>,
    pub(super) unit: Option<Unit>,
    pub(super) deformation: Option<Deformation>,
    /// Whether a frequency is ω.
    pub(super) is_angular: bool,
    /// Whether a frequency is reduced to one temperature.
    pub(super) is_reduced: bool,
}

impl Title {
    pub(super) fn from_text(text: &str) -> Self {
        let (name, unit) = split(text);
        let name = simple(name);
        let words: Vec<&str> = name.split(|c: char| !(c.is_alphanumeric() || "'*".contains(c))).collect();
        let words: Vec<&str> = words.into_iter().filter(|word| !word.is_empty()).collect();
        let has = |parts: &[&str]| parts.iter().any(|part| name.contains(part));
        let is = |symbols: &[&str]| words.iter().any(|word| symbols.contains(word));
        let deformation =
            if is(&["g", "g'", "g''", "g*"]) || has(&["shear", "scher", "schub", "cisaill", "torsion"]) {
                Some(Deformation::Shear)
            } else {
                is(&["e", "e'", "e''", "e*"]).then_some(Deformation::Tension)
            };
        Self {
            text: text.trim().to_owned(),
            quantity: quantity(&words, has, is)
                .or(matches!(unit, Some(Unit::Hertz(_))).then_some(Quantity::Frequency)),
            unit,
            deformation,
            is_angular: has(&["angular", "angulaire", "kreis", "winkel", "pulsation"])
                || is(&["ω", "omega", "w"]),
            is_reduced: has(&["reduced", "shifted", "reduziert", "master"]) || is(&["at"]),
        }
    }

    /// Returns the factor of the numbers to SI, of a frequency to hertz; `None` without a suitable unit.
    pub(super) fn factor(&self) -> Option<f64> {
        match (self.quantity?, self.unit) {
            (Quantity::LossTangent, Some(Unit::Fraction(factor))) => Some(factor),
            (Quantity::Frequency, Some(Unit::Hertz(factor))) => Some(factor),
            (Quantity::Frequency, Some(Unit::PerSecond)) => {
                Some(if self.is_angular { 1.0 / TAU } else { 1.0 })
            }
            (Quantity::PhaseAngle, Some(Unit::Radian(factor))) => Some(factor),
            (quantity, Some(Unit::Pascal(factor))) if quantity.is_modulus() => Some(factor),
            _ => None,
        }
    }
}

/// Splits a title from the unit at its end: `storage_MPa`, `storage (MPa)`, `E' [MPa]`, `E'/MPa`, `G' in Pa`.
fn split(title: &str) -> (&str, Option<Unit>) {
    let bare = title.trim().trim_end_matches([')', ']']);
    // `1/MPa` is no MPa.
    let is_inverse = |at: usize| {
        let before = bare[..at].strip_suffix('1').filter(|_| bare[at..].starts_with('/'));
        before.is_some_and(|before| !before.ends_with(char::is_alphanumeric))
    };
    let places = bare.char_indices().filter(|(at, c)| "_([/, ".contains(*c) && !is_inverse(*at));
    let places = places.map(|(at, c)| (at, at + c.len_utf8()));
    let mut places = [(0, 0)].into_iter().chain(places);
    match places.find_map(|(end, start)| Some((end, Unit::from_text(&bare[start..])?))) {
        Some((end, unit)) => (bare[..end].trim_end().trim_end_matches(" in"), Some(unit)),
        None => (title, None),
    }
}

/// Writes a name in lower case, with straight primes.
fn simple(name: &str) -> String {
    // U+0091 to U+0094 are the quotation marks of Windows in Latin-1.
    let name = name.replace(['’', '‘', '′', '´', '`', 'ʹ', '\u{91}', '\u{92}'], "'");
    let name = name.replace(['″', '”', '“', '"', 'ʺ', '\u{93}', '\u{94}'], "''").to_lowercase();
    let name = name.replace(['_', '-'], " ").replace("double prime", "''").replace("doubleprime", "''");
    name.replace("prime", "'").replace(" '", "'")
}

/// Returns the quantity of a name: with parts and with words.
fn quantity(words: &[&str], has: impl Fn(&[&str]) -> bool, is: impl Fn(&[&str]) -> bool) -> Option<Quantity> {
    const STORAGE: [&str; 7] =
        ["storage", "elastic", "speicher", "conservation", "stockage", "conservativ", "almacen"];
    const LOSS: [&str; 6] = ["loss", "viscous", "verlust", "perte", "dissipati", "rdida"];
    let first = *words.first()?;
    if first.starts_with("log") || first == "lg" || first == "ln" || has(&["compliance", "viscos", "viskos"])
    {
        return Some(Quantity::Other);
    }
    // A name says that it is a modulus, unless it is short: `storage`, `E loss`.
    let is_modulus =
        has(&["modul", "módul"]) || words.iter().all(|word| ["e", "g", "storage", "loss"].contains(word));
    let tangents = ["loss factor", "loss tangent", "verlustfaktor", "damping factor", "facteur de perte"];
    if has(&tangents) || (first.starts_with("tan") && !is_modulus) {
        Some(Quantity::LossTangent)
    } else if has(&["phase", "loss angle", "verlustwinkel"]) || matches!(words, ["δ" | "delta"]) {
        Some(Quantity::PhaseAngle)
    } else if is(&["re", "real", "im", "imag", "imaginary"]) && is(&["e", "g", "e*", "g*"]) {
        Some(if is(&["re", "real"]) { Quantity::Storage } else { Quantity::Loss })
    } else if is(&["e*", "g*"]) || (is_modulus && has(&["complex", "komplex"])) {
        Some(Quantity::Complex)
    } else if is(&["e''", "g''"]) || (is_modulus && has(&LOSS)) {
        Some(Quantity::Loss)
    } else if is(&["e'", "g'"]) || (is_modulus && has(&STORAGE)) {
        Some(Quantity::Storage)
    } else if has(&["freq", "fréq", "frecu", "omega", "pulsation"]) || is(&["f", "ω", "w"]) {
        Some(Quantity::Frequency)
    } else {
        has(&["temp"]).then_some(Quantity::Temperature)
    }
}

/// Titles of the columns.
pub(super) struct Head {
    /// Number of their line; of the last one if each title has a line.
    pub(super) line: usize,
    pub(super) titles: Vec<Title>,
}

impl Head {
    pub(super) fn from_line(line: &Line) -> Self {
        Self { line: line.number, titles: line.cells.iter().map(|cell| Title::from_text(cell)).collect() }
    }

    pub(super) fn names_a_modulus(&self) -> bool {
        let has = |is: fn(Quantity) -> bool| self.titles.iter().any(|title| title.quantity.is_some_and(is));
        has(|quantity| quantity == Quantity::Frequency) && has(Quantity::is_modulus)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_name_quantities_in_the_words_of_instruments() {
        use Quantity::{Complex, Frequency, Loss, LossTangent, PhaseAngle, Storage, Temperature};
        for (quantity, titles) in [
            (
                Frequency,
                &[
                    "frequency_Hz",
                    "f",
                    "Freq. (Hz)",
                    "Frequenz / Hz",
                    "Angular Frequency",
                    "ω [rad/s]",
                    "aT·ω",
                ][..],
            ),
            (
                Storage,
                &[
                    "storage_MPa",
                    "Storage modulus",
                    "Speichermodul G'",
                    "E’ (MPa)",
                    "E'(1,000 Hz)/MPa",
                    "E prime",
                ],
            ),
            (Storage, &["G' in Pa", "E_storage (Pa)", "Module de conservation", "Re(E*)", "E\u{92}"]),
            (
                Loss,
                &[
                    "loss_MPa",
                    "Verlustmodul / MPa",
                    "E\" (MPa)",
                    "G''",
                    "E″",
                    "E´´",
                    "Shear loss modulus",
                    "E double prime",
                ],
            ),
            (Complex, &["|E*| [MPa]", "Complex modulus", "Komplexer Modul", "G*"]),
            (
                LossTangent,
                &["tan delta", "Tan(δ)", "tanδ", "tan d", "tan_delta", "Loss factor", "Verlustfaktor [1]"],
            ),
            (PhaseAngle, &["Phase angle (°)", "Loss angle", "δ / deg", "delta [rad]"]),
            (Temperature, &["Temp./°C", "Temperature", "Probentemperatur"]),
        ] {
            for title in titles {
                assert_eq!(Title::from_text(title).quantity, Some(quantity), "{title}");
            }
        }
        for title in ["Storage compliance (1/MPa)", "log G' (Pa)", "ln E'", "Complex viscosity"] {
            assert_eq!(Title::from_text(title).quantity, Some(Quantity::Other), "{title}");
        }
        for title in ["Time (s)", "Loss energy", "Stress (MPa)", "#"] {
            assert_eq!(Title::from_text(title).quantity, None, "{title}");
        }
        assert_eq!(Title::from_text("x_Hz").quantity, Some(Frequency));
    }

    #[test]
    fn units_stand_behind_titles() {
        for (title, factor) in [
            ("storage_MPa", 1e6),
            ("storage in N/mm²", 1e6),
            ("E' (Mpa)", 1e6),
            ("E'(1,000 Hz)/MPa", 1e6),
            ("Storage modulus [N/mm²]", 1e6),
            ("G' in dyn/cm²", 0.1),
            ("f/kHz", 1e3),
            ("Frequency (1/s)", 1.0),
            ("ω / s^-1", 1.0 / TAU),
            ("Angular frequency, rad/s", 1.0 / TAU),
            ("omega [rad·s⁻¹]", 1.0 / TAU),
            ("δ (°)", TAU / 360.0),
        ] {
            let found = Title::from_text(title).factor().unwrap();
            assert!((found / factor - 1.0).abs() < 1e-12, "{title}: {found}");
        }
        for title in ["Frequency", "E'", "E' (Hz)", "f (MPa)", "δ"] {
            assert_eq!(Title::from_text(title).factor(), None, "{title}");
        }
    }

    #[test]
    fn moduli_are_of_tension_or_of_shear() {
        for (title, deformation) in [
            ("E' (MPa)", Some(Deformation::Tension)),
            ("G''", Some(Deformation::Shear)),
            ("Complex shear modulus", Some(Deformation::Shear)),
            ("Schubspannung", Some(Deformation::Shear)),
            ("Storage modulus", None),
        ] {
            assert_eq!(Title::from_text(title).deformation, deformation, "{title}");
        }
    }
}

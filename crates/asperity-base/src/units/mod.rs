//! SI quantities: type aliases for signatures, and reading and writing with a unit.

mod hint;
mod infinite;
mod quantity;
mod range;

pub use infinite::{known_or_inf, or_inf, or_infs};
pub use quantity::{
    CELSIUS, Dimension, Multiple, UnitError, format, format_digits, format_distinct, format_number,
    format_number_digits, format_within, parse, parse_unit,
};
pub use range::{MAX_COUNT, NUMBERS, Range};

/// Length in metres.
pub type Metre = f64;
/// Area in square metres.
pub type SquareMetre = f64;
/// Volume in cubic metres.
pub type CubicMetre = f64;
/// Wave number 2π/wavelength in radians per metre.
pub type RadianPerMetre = f64;
/// Angle per distance, in 1/m.
pub type PerMetre = f64;
/// Pressure, modulus or hardness in pascals.
pub type Pascal = f64;
/// Force in newtons.
pub type Newton = f64;
/// Stiffness in newtons per metre.
pub type NewtonPerMetre = f64;
/// Moment of a force in newton metres.
pub type NewtonMetre = f64;
/// Energy in joules.
pub type Joule = f64;
/// Energy of an area in joules per square metre.
pub type JoulePerSquareMetre = f64;
/// Speed in metres per second.
pub type MetrePerSecond = f64;
/// Time in seconds.
pub type Second = f64;
/// Volume lost per load and distance slid, or per energy of friction, in 1/Pa.
pub type PerPascal = f64;
/// Absolute temperature or temperature rise in kelvins.
pub type Kelvin = f64;
/// Dynamic viscosity in pascal seconds.
pub type PascalSecond = f64;
/// Heat flow in watts.
pub type Watt = f64;
/// Flow of volume in cubic metres per second.
pub type CubicMetrePerSecond = f64;
/// Heat flux in watts per square metre.
pub type WattPerSquareMetre = f64;

/// Writes an amount of memory, in bytes: `35 kB`, `1.2 GB`.
pub fn bytes(count: f64) -> String {
    match count {
        count if count < 1e6 => std::format!("{:.0} kB", count / 1e3),
        count if count < 1e9 => std::format!("{:.0} MB", count / 1e6),
        count if count < 1e12 => std::format!("{:.1} GB", count / 1e9),
        count => std::format!("{:.1} TB", count / 1e12),
    }
}

/// Writes a time for people: `0.3 s`, `12 s`, `5 min`, `3.2 h`, `40 days`.
pub fn format_time(seconds: Second) -> String {
    match seconds {
        t if t < 10.0 => std::format!("{t:.1} s"),
        t if t < 120.0 => std::format!("{t:.0} s"),
        t if t < 7200.0 => std::format!("{:.0} min", t / 60.0),
        t if t < 48.0 * 3600.0 => std::format!("{:.1} h", t / 3600.0),
        t => std::format!("{:.0} days", t / 86400.0),
    }
}

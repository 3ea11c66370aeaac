//! SI quantities: the aliases that name them in signatures, and their reading and writing with a unit.

mod quantity;

pub use quantity::{Dimension, UnitError, format, format_digits, parse};

/// Length in metres.
pub type Metre = f64;
/// Area in square metres.
pub type SquareMetre = f64;
/// Volume in cubic metres.
pub type CubicMetre = f64;
/// Wave number 2π/wavelength in radians per metre.
pub type RadianPerMetre = f64;
/// Pressure, modulus or hardness in pascals.
pub type Pascal = f64;
/// Force in newtons.
pub type Newton = f64;
/// Energy in joules.
pub type Joule = f64;
/// Speed in metres per second.
pub type MetrePerSecond = f64;
/// Time in seconds.
pub type Second = f64;

//! Influence of harmonic pressures.

use crate::units::Pascal;

/// Displacement per unit pressure of the harmonic of angular wavenumber `(qx, qy)`, m/Pa: 2/(E*|q|), and 0 at
/// q = 0, where the displacement of a periodic half-space is free. Johnson (1985), eq. 13.6.
pub fn harmonic_displacement(qx: f64, qy: f64, modulus: Pascal) -> f64 {
    let q = qx.hypot(qy);
    if q == 0.0 { 0.0 } else { 2.0 / (modulus * q) }
}

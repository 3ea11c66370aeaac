//! Influence of harmonic tractions.

use crate::kernel::Coefficients;
use crate::material::Compliances;
use crate::units::Pascal;

/// Returns the displacement per unit pressure of the harmonic of angular wavenumber `(qx, qy)`, m/Pa:
/// 2/(E*|q|), and 0 at q = 0, where the displacement of a periodic half-space is free. Johnson (1985), eq.
/// 13.6.
pub fn harmonic_displacement(qx: f64, qy: f64, modulus: Pascal) -> f64 {
    let q = qx.hypot(qy);
    if q == 0.0 { 0.0 } else { 2.0 / (modulus * q) }
}

/// Returns the displacements per unit traction of the harmonic exp(i(q_x x + q_y y)), m/Pa, and zeros at q =
/// 0, where the displacement of a periodic half-space is free. zx and zy are the imaginary parts of purely
/// imaginary coefficients.
///
/// ```text
/// xx = 2/(E*q) + 2q_y²/(N*q³)     yy = 2/(E*q) + 2q_x²/(N*q³)     xy = −2q_x q_y/(N*q³)
/// zx = −2i q_x/(G*q²)             zy = −2i q_y/(G*q²)             zz = 2/(E*q)
/// ```
/// The Fourier transforms of the solutions of Boussinesq and Cerruti; Johnson (1985), ch. 3.
pub fn harmonic_displacements(qx: f64, qy: f64, compliances: &Compliances) -> Coefficients {
    let q = qx.hypot(qy);
    if q == 0.0 {
        return Coefficients { xx: 0.0, xy: 0.0, yy: 0.0, zx: 0.0, zy: 0.0, zz: 0.0 };
    }
    let [cos, sin] = [qx / q, qy / q];
    let normal = harmonic_displacement(qx, qy, compliances.normal.recip());
    let [lateral, coupling] = [compliances.lateral, compliances.coupling].map(|c| 2.0 * c / q);
    Coefficients {
        xx: normal + lateral * sin * sin,
        xy: -lateral * cos * sin,
        yy: normal + lateral * cos * cos,
        zx: -coupling * cos,
        zy: -coupling * sin,
        zz: normal,
    }
}

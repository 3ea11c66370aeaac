//! Theories of random rough surfaces: real area of contact, as a fraction of the apparent area; pressure and gap.

use std::f64::consts::{PI, SQRT_2};

use crate::math::integrate;
use crate::units::{Metre, Newton, Pascal, SquareMetre};

/// κ = √(2π) of Bush, Gibson & Thomas, Wear 35, 87 (1975), in A/A₀ = κ p̄/(E* h′).
pub const BGT_COEFFICIENT: f64 = 2.506_628_274_631_000_7;

/// κ = √(8/π) of Persson, the slope at p̄ = 0 of [`persson_area_fraction`].
pub const PERSSON_COEFFICIENT: f64 = 1.595_769_121_605_730_9;

/// Area fraction A/A₀ = κ p̄/(E* h′) of the asperity theory, with the rms `rms_slope` h′ of |∇h| (Sdq) of the
/// gap. It holds for A/A₀ ≪ 1 only, and is not limited to 1. Computations lie between [`PERSSON_COEFFICIENT`]
/// and this, κ ≈ 2.
pub fn bgt_area_fraction(mean_pressure: Pascal, modulus: Pascal, rms_slope: f64) -> f64 {
    BGT_COEFFICIENT * mean_pressure / (modulus * rms_slope)
}

/// Area fraction A/A₀ = erf(√2 p̄/(E* h′)) of Persson's theory, from first touch to full contact, with the
/// rms `rms_slope` h′ of |∇h| (Sdq) of the gap. Persson, J. Chem. Phys. 115, 3840 (2001).
pub fn persson_area_fraction(mean_pressure: Pascal, modulus: Pascal, rms_slope: f64) -> f64 {
    libm::erf(SQRT_2 * mean_pressure / (modulus * rms_slope))
}

/// Length over which the pressure between elastic rough surfaces falls by e with the mean gap, over the rms height σ of
/// the gap: p = β E* exp(−g/γσ), so that the normal stiffness of an area is p/γσ. Persson, Phys. Rev. Lett. 99, 125502
/// (2007).
pub const PERSSON_DECAY: f64 = 0.4;

/// Mean pressure by Greenwood and Williamson: independent spherical peaks, `density` η on an area, of one `radius` R, with
/// normal heights of the standard `deviation` σ_s, against a plane at a `distance` d above their mean height:
///
/// p = (4/3) η E* √R σ_s^(3/2) F(d/σ_s) with F(H) = ∫ (s − H)^(3/2) φ(s) ds over s > H
///
/// Greenwood & Williamson, Proc. R. Soc. Lond. A 295, 300 (1966).
pub fn greenwood_williamson_pressure(
    density: f64,
    radius: Metre,
    deviation: Metre,
    modulus: Pascal,
    distance: Metre,
) -> Pascal {
    let overlap = peaks_beyond(distance / deviation, 1.5);
    4.0 / 3.0 * density * modulus * radius.sqrt() * deviation.powf(1.5) * overlap
}

/// Returns F_n(H) = ∫ (s − H)ⁿ φ(s) ds over s > H, with the normal density φ: peaks that reach beyond a distance of H
/// standard deviations.
pub fn peaks_beyond(distance: f64, power: f64) -> f64 {
    /// Heights beyond this many standard deviations do not count.
    const REACH: f64 = 12.0;
    let normal = |s: f64| (-0.5 * s * s).exp() / (2.0 * PI).sqrt();
    // s = H + t², without the root at the end.
    let end = (REACH.max(distance + 4.0) - distance).sqrt();
    integrate(0.0, end, |t| 2.0 * t * t.powf(2.0 * power) * normal(distance + t * t))
}

/// Area A = W/H if the whole contact yields, the limit for H ≪ E* h′: the smallest area that carries the
/// load. Bowden & Tabor (1950).
pub fn fully_plastic_area(load: Newton, hardness: Pascal) -> SquareMetre {
    load / hardness
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_coefficients_are_the_theories() {
        assert_relative_eq!(BGT_COEFFICIENT, (2.0 * PI).sqrt(), max_relative = 1e-15);
        assert_relative_eq!(PERSSON_COEFFICIENT, (8.0 / PI).sqrt(), max_relative = 1e-15);
    }

    #[test]
    fn perssons_area_starts_linearly_and_ends_full() {
        for mean_pressure in [1e-2_f64, 1e-4] {
            let linear = PERSSON_COEFFICIENT * mean_pressure;
            let bend = 2.0 / 3.0 * mean_pressure.powi(2); // erf x = (2/√π)(x − x³/3 …)
            assert_relative_eq!(
                persson_area_fraction(mean_pressure, 1.0, 1.0),
                linear,
                max_relative = bend + 1e-15
            );
        }
        assert_relative_eq!(persson_area_fraction(10.0, 1.0, 1.0), 1.0, max_relative = 1e-15);
    }

    #[test]
    fn peaks_beyond_a_distance_have_their_moments() {
        // F₀ is the share beyond, F₁ = φ(H) − H F₀; far below all peaks they are 1 and −H. F₅⸝₂(0) = 0.616634.
        for h in [-1.0_f64, 0.0, 1.5, 3.0] {
            let share = 0.5 * libm::erfc(h / SQRT_2);
            let density = (-0.5 * h * h).exp() / (2.0 * PI).sqrt();
            assert_relative_eq!(peaks_beyond(h, 0.0), share, max_relative = 1e-8);
            assert_relative_eq!(peaks_beyond(h, 1.0), density - h * share, max_relative = 1e-8);
        }
        assert_relative_eq!(peaks_beyond(0.0, 2.5), 0.616_634_0, max_relative = 1e-5);
    }

    #[test]
    fn the_asperities_of_bgt_touch_over_half_as_much_again() {
        let ratio = bgt_area_fraction(1e-6, 2.0, 0.1) / persson_area_fraction(1e-6, 2.0, 0.1);
        assert_relative_eq!(ratio, PI / 2.0, max_relative = 1e-9);
    }

    #[test]
    fn twice_the_hardness_needs_half_the_area() {
        assert_eq!(fully_plastic_area(3.0, 2.0), 2.0 * fully_plastic_area(3.0, 4.0));
    }
}

//! Real contact area of random rough surfaces, as a fraction of the apparent area.

use std::f64::consts::SQRT_2;

use crate::units::{Newton, Pascal, SquareMetre};

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

/// Area A = W/H if the whole contact yields, the limit for H ≪ E* h′: the smallest area that carries the
/// load. Bowden & Tabor (1950).
pub fn fully_plastic_area(load: Newton, hardness: Pascal) -> SquareMetre {
    load / hardness
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::PI;

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
    fn the_asperities_of_bgt_touch_over_half_as_much_again() {
        let ratio = bgt_area_fraction(1e-6, 2.0, 0.1) / persson_area_fraction(1e-6, 2.0, 0.1);
        assert_relative_eq!(ratio, PI / 2.0, max_relative = 1e-9);
    }

    #[test]
    fn twice_the_hardness_needs_half_the_area() {
        assert_eq!(fully_plastic_area(3.0, 2.0), 2.0 * fully_plastic_area(3.0, 4.0));
    }
}
